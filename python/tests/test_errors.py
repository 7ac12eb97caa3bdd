# SPDX-License-Identifier: MIT OR Apache-2.0
"""Bad input raises documented exceptions alone, and leaves objects as they were."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hapticore as hc

from conftest import ROOT

#: What a file may raise. A panic of Rust would be a BaseException, which is none of them.
OF_FILES = (hc.Error, OSError)

#: What an argument may raise.
OF_ARGUMENTS = (hc.Error, TypeError, OverflowError)

SEEDS = ROOT / "fuzz" / "corpus-seed"
GALLERY = ROOT / "scene" / "gallery"


def test_a_scene_error_names_key_file_and_line(tmp_path: Path) -> None:
    path = tmp_path / "typo.toml"
    path.write_text('title = "typo"\n[[pad]]\nposition_mm = [0, 0]\nload = 50\n')
    with pytest.raises(hc.SceneError) as caught:
        hc.simulate(path)
    error = caught.value
    assert (error.key, error.file, error.line) == ("pad.0.load", str(path), 4)
    assert str(error) == f"{path}:4: pad.0.load: expected load_g, since a key names its unit"


def test_an_error_of_a_set_key_names_the_argument() -> None:
    with pytest.raises(hc.SceneError) as caught:
        hc.simulate("hockey", {"pad.0.load": 50})
    assert (caught.value.key, caught.value.line) == ("pad.0.load", None)
    assert "--set" not in str(caught.value)


@pytest.mark.parametrize(
    ("call", "expected", "words"),
    [
        (lambda: hc.simulate("cricket"), hc.SceneError, "hockey"),
        (lambda: hc.simulate("cricket.toml"), FileNotFoundError, "cricket.toml"),
        (lambda: hc.simulate("hockey", profile="huge"), hc.ProfileError, "standard"),
        (lambda: hc.simulate("hockey", core="exact"), hc.Error, "float, fixed or clock"),
        (lambda: hc.simulate("fig3", case="sleep"), hc.Error, "rest"),
        (lambda: hc.simulate("hockey", 5), TypeError, "dict"),  # type: ignore[arg-type]
        (lambda: hc.simulate("hockey", {"seed": None}), TypeError, "NoneType"),
        (lambda: hc.replay("nothing.csv"), FileNotFoundError, "nothing.csv"),
        (lambda: hc.replay("nothing.txt"), hc.Error, ".csv"),
        (lambda: hc.replay("nothing.csv", pads=0), hc.Error, "pads"),
        (lambda: hc.replay("nothing.csv", pads=257), hc.Error, "256"),
        (lambda: hc.replay("nothing.csv", bits=99), hc.Error, "bits"),
        (lambda: hc.replay("nothing.csv", full_scale_v=math.nan), hc.Error, "full_scale_v"),
        (lambda: hc.replay("nothing.csv", skip=-1), hc.Error, "skip"),
        (lambda: hc.calibrate(), hc.Error, "setup"),
        (lambda: hc.Core("hockey", pads=3), hc.Error, "either"),
        (lambda: hc.Core(pads=300), hc.Error, "256"),
        (lambda: hc.Core("hockey", core="clock"), hc.Error, "float or fixed"),
        (lambda: hc.Display("hockey", case="nine"), hc.Error, "nine"),
        (lambda: hc.live("cricket"), hc.SceneError, "hockey"),
        (lambda: hc.live("hockey", speed=-1), hc.Error, "speed"),
        (lambda: hc.live("hockey", port=70000), hc.Error, "65535"),
    ],
)  # fmt: skip
def test_a_wrong_argument_is_named(
    call: Callable[[], Any], expected: type[Exception], words: str
) -> None:
    with pytest.raises(expected) as caught:
        call()
    assert words in str(caught.value)


def test_an_unstable_loop_is_refused_unless_it_may_be() -> None:
    settings = {
        "control.law": "integral",
        "control.proportional_v": 64,
        "control.integral_v": 1500000,
        "criterion": [],
    }
    case = "square 0.6 N, closed loop"
    with pytest.raises(hc.Error, match="expected a stable loop"):
        hc.simulate("fig9", settings, case=case)
    assert hc.simulate("fig9", settings, case=case, unstable=True).frames.slots > 0


def mutated(data: bytes, chance: random.Random) -> bytes:
    """Bytes with some changed, removed or repeated."""
    changed = bytearray(data)
    for _ in range(chance.randint(1, 8)):
        at = chance.randrange(len(changed) + 1)
        match chance.randrange(3):
            case 0:
                changed[at : at + 1] = bytes([chance.randrange(256)])
            case 1:
                del changed[at : at + chance.randint(1, 20)]
            case _:
                changed[at:at] = changed[at : at + chance.randint(1, 20)]
    return bytes(changed)


def inputs(kind: str) -> list[bytes]:
    """The seeds of a fuzz target, and mutations of them."""
    seeds = [path.read_bytes() for path in sorted((SEEDS / kind).iterdir())]
    if kind == "scene":
        seeds += [path.read_bytes() for path in sorted(GALLERY.glob("minimal-*.toml"))]
    assert seeds
    chance = random.Random(f"hapticore {kind}")
    return seeds + [mutated(chance.choice(seeds), chance) for _ in range(60)]


def take(call: Callable[[], Any]) -> bool:
    """Whether an input is accepted, rather than refused as documented."""
    try:
        call()
    except OF_FILES as error:
        assert str(error)
        return False
    return True


def test_any_scene_runs_or_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    accepted = 0
    for data in inputs("scene"):
        path.write_bytes(data)
        accepted += take(lambda: hc.Display(path).step(2))
    assert accepted > 0


def test_any_profile_runs_or_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "profile.toml"
    for data in inputs("profile"):
        path.write_bytes(data)
        take(lambda: hc.Core(profile=path))
        take(lambda: hc.Display("minimal-sheet", profile=path).step(2))


def test_any_calibration_makes_a_core_or_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "calibration.toml"
    for data in inputs("calibration"):
        path.write_bytes(data)
        take(lambda: hc.Core(calibration=path))


@pytest.mark.parametrize("kind", ["csv", "wav"])
def test_any_capture_is_replayed_or_refused(kind: str, tmp_path: Path) -> None:
    path = tmp_path / f"capture.{kind}"
    for data in inputs(kind):
        # The first byte of a seed chooses options of the fuzz target.
        path.write_bytes(data[1:])
        take(lambda: hc.replay(path))
        take(lambda: hc.replay(path, bits=16, pads=2, truncated=True))


def test_any_sigmf_recording_is_replayed_or_refused(tmp_path: Path) -> None:
    for data in inputs("sigmf"):
        meta, _, samples = data[1:].partition(b"\0")
        (tmp_path / "capture.sigmf-meta").write_bytes(meta)
        (tmp_path / "capture.sigmf-data").write_bytes(samples)
        take(lambda: hc.replay(tmp_path / "capture.sigmf-meta"))


def test_any_lab_data_are_taken_or_refused(tmp_path: Path) -> None:
    for data in inputs("lab"):
        setup, *tables = data.split(b"\0")
        files = [tmp_path / "setup.toml"]
        files[0].write_bytes(setup)
        for index, table in enumerate(tables):
            files.append(tmp_path / f"{index}.csv")
            files[-1].write_bytes(table)
        take(lambda: hc.calibrate(*files))


def test_any_codes_are_measured_or_refused() -> None:
    core = hc.Core(profile="small", pads=2)
    least, most = core.codes
    refused = 0
    for number, data in enumerate(inputs("core")):
        codes = np.resize(np.frombuffer(data + bytes(-len(data) % 4 or 4), dtype="<i4"), core.shape)
        # Any code of 32 bits, and any that the ADC has.
        within = (codes % (most - least + 1) + least).astype(np.int32)
        assert core.slot(number % 2, within).pad == number % 2
        refused += not take(lambda: core.slot(number % 2, codes.astype(np.int32)))
    assert refused > 0


#: Values that no argument of a number expects.
ODD: list[Any] = [
    -1, 99, 2**31, 2**63, 2**70, -(2**70), 1.5, None, "0", b"0", [], math.nan, math.inf, -math.inf, 1e300, True,
    np.int64(7), np.float64("nan"), np.zeros(2), object(),
]  # fmt: skip


def test_odd_codes_are_refused_and_leave_the_core_as_it_was() -> None:
    core, twin = hc.Core("hockey"), hc.Core("hockey")
    window, channels = core.shape
    good = np.random.default_rng(1).integers(-1000, 1000, (4, window, channels), dtype=np.int32)
    most = core.codes[1]
    too_large = good.copy()
    too_large[3, -1, -1] = most + 1
    odd: list[Any] = [
        good[0, :-1], good[0, :, :-1], good[0].T, good[0].astype(np.int64), good[0].astype(float), good[0].tolist(),
        good[0].astype(">i4"), too_large[3], np.zeros(0, np.int32), np.int32(0), None, "codes", good,
    ]  # fmt: skip
    for codes in odd:
        with pytest.raises(OF_ARGUMENTS):
            core.slot(0, codes)
    for pad in ODD:
        if pad is not True:
            with pytest.raises(OF_ARGUMENTS):
                core.slot(pad, good[0])
    for pads in ([0, 1], [0, 1, 2, 9], [0, 1, 2, -1], [0.0] * 4, [[0, 1, 2, 3]], None, "0123"):
        with pytest.raises(OF_ARGUMENTS):
            core.slots(pads, good)  # type: ignore[arg-type]
    # The last slot alone is wrong: none of them may be taken.
    with pytest.raises(hc.Error, match=str(most)):
        core.slots([0, 1, 2, 3], too_large)
    a, b = core.slots([0, 1, 2, 3], good), twin.slots([0, 1, 2, 3], good)
    assert all(a[name].tolist() == b[name].tolist() for name in a)


def test_a_trace_of_wrong_codes_or_signals_is_refused() -> None:
    core = hc.Core(profile="small")
    name = core.signals()[0]
    zeros = np.zeros(core.shape, np.int32)
    for codes in (zeros[1:], zeros.astype(float), zeros + core.codes[1] + 1, None):
        with pytest.raises(hc.Error, match="codes"):
            core.trace(codes, name)  # type: ignore[arg-type]
    with pytest.raises(hc.Error, match="nothing"):
        core.trace(zeros, [name, "nothing"])


def test_a_message_says_shape_and_dtype() -> None:
    core = hc.Core("hockey")
    with pytest.raises(hc.Error) as caught:
        core.slot(0, np.zeros((10, 8)))  # type: ignore[arg-type]
    expected = f"codes: expected int32 of shape {core.shape}, got float64 of shape (10, 8)"
    assert str(caught.value) == expected


def test_codes_need_not_be_contiguous() -> None:
    a, b = hc.Core("hockey"), hc.Core("hockey")
    codes = np.random.default_rng(2).integers(-1000, 1000, a.shape, dtype=np.int32)
    strided = np.asfortranarray(codes)
    strided.flags.writeable = False
    assert a.slot(0, strided) == b.slot(0, codes)


@pytest.mark.parametrize("scene", ["peg", "hockey"])
def test_odd_inputs_are_refused_and_leave_the_display_as_it_was(scene: str) -> None:
    display, twin = hc.Display(scene), hc.Display(scene)
    for odd in ODD:
        calls: list[Callable[[], Any]] = [
            lambda: display.lead(odd, 0, 0),
            lambda: display.press(odd, 20),
            lambda: display.push(odd, 0.1),
            lambda: display.target(odd, 0.1),
            lambda: display.voltage(odd, 10),
            lambda: display.release(odd),
        ]
        for call in calls:
            if odd is not True:
                with pytest.raises(OF_ARGUMENTS):
                    call()
    for odd in (-1, 1.5, None, "0", 2**70):
        with pytest.raises(OF_ARGUMENTS):
            display.step(odd)  # type: ignore[arg-type]
    for number in (math.nan, math.inf, -math.inf, 1e300, -1e300, None, "0"):
        bad: list[Callable[[], Any]] = [
            lambda: display.lead(0, number, 0),  # type: ignore[arg-type]
            lambda: display.lead(0, 0, 0, within_s=number),  # type: ignore[arg-type]
            lambda: display.press(0, number),  # type: ignore[arg-type]
            lambda: display.push(0, number),  # type: ignore[arg-type]
            lambda: display.target(0, number),  # type: ignore[arg-type]
            lambda: display.voltage(0, number),  # type: ignore[arg-type]
        ]
        for call in bad:
            with pytest.raises(OF_ARGUMENTS):
                call()
        if number is not None:
            with pytest.raises(OF_ARGUMENTS):
                display.wall(x_mm=number)  # type: ignore[arg-type]
    with pytest.raises(hc.Error):
        display.wall()
    with pytest.raises(hc.Error):
        display.step(10**9)
    a, b = display.step(40), twin.step(40)
    assert all(a[name].tobytes() == b[name].tobytes() for name in a)


def test_codes_before_the_first_slot_are_an_error() -> None:
    with pytest.raises(hc.Error, match="no slot"):
        hc.Display("hockey").codes()


def test_a_carrier_of_phasors_has_no_codes() -> None:
    display = hc.Display("minimal-sheet", set={"carrier.rung": "phasor"})
    display.step()
    with pytest.raises(hc.Error, match="phasors"):
        display.codes()


def test_an_unknown_column_is_a_key_error() -> None:
    frames = hc.Display("hockey").step(4)
    with pytest.raises(KeyError):
        frames["x_cm"]
    with pytest.raises(KeyError):
        frames.where(x_cm=1)


def test_an_error_can_be_pickled() -> None:
    import pickle

    with pytest.raises(hc.SceneError) as caught:
        hc.simulate("hockey", {"pad.0.load": 50})
    again = pickle.loads(pickle.dumps(caught.value))
    assert (str(again), again.key) == (str(caught.value), caught.value.key)
