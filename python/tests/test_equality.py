# SPDX-License-Identifier: MIT OR Apache-2.0
"""Results equal those of the command, to the bit."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hapticore as hc

Command = Callable[..., str]

#: Scenes whose whole run is long, shortened.
SHORT: dict[str, dict[str, Any]] = {
    "wall-2d": {"duration_s": 0.4},
    "peg": {"duration_s": 0.3},
}


def read(path: Path) -> dict[str, list[str]]:
    with path.open(newline="") as file:
        head, *rows = csv.reader(file)
    return {name: [row[index] for row in rows] for index, name in enumerate(head)}


def check(frames: hc.Frames, path: Path) -> None:
    """Every column of a file is that of the frames: numbers to the bit."""
    columns = read(path)
    assert list(frames) == list(columns)
    assert frames.slots > 0
    for name, texts in columns.items():
        array = frames[name]
        assert array.shape == (len(texts),), name
        if array.dtype.kind == "U":
            assert array.tolist() == texts, name
        elif array.dtype.kind in "ib":
            assert array.astype(int).tolist() == [int(text) for text in texts], name
        else:
            written = np.array([float(text) for text in texts])
            both_none = np.isnan(array) & np.isnan(written)
            same = (array.view(np.int64) == written.view(np.int64)) | both_none
            assert same.all(), (name, array[~same][:3], written[~same][:3])


def words(settings: dict[str, Any]) -> list[str]:
    return [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]


def of_results(summary: dict[str, Any]) -> dict[str, Any]:
    """A summary without what tells one run or build from another."""
    others = ("wall_seconds", "command", "commit", "date")
    kept = {key: value for key, value in summary.items() if key not in others}
    for effect in kept.get("effects", []):
        effect["seconds"] = 0
    return kept


@pytest.mark.parametrize("scene", hc.scenes())
def test_a_scene_gives_the_frames_of_the_command(
    scene: str, command: Command, tmp_path: Path
) -> None:
    settings = SHORT.get(scene, {})
    command("simulate", scene, *words(settings), "--out", tmp_path)
    run = hc.simulate(scene, settings)
    check(run.frames, tmp_path / "frames.csv")
    written = json.loads((tmp_path / "summary.json").read_text())
    assert of_results(run.summary) == of_results(written)


@pytest.mark.parametrize("core", ["float", "clock"])
def test_other_fidelities_give_the_frames_of_the_command(
    core: str, command: Command, tmp_path: Path
) -> None:
    settings = {"duration_s": 0.05}
    command("simulate", "hockey", *words(settings), "--core", core, "--waves", "none", "--out", tmp_path)
    check(hc.simulate("hockey", settings, core).frames, tmp_path / "frames.csv")


def test_a_case_and_a_profile_give_the_frames_of_the_command(
    command: Command, tmp_path: Path
) -> None:
    command("simulate", "fig3", "--case", "rest", "--profile", "small", "--out", tmp_path)
    check(hc.simulate("fig3", case="rest", profile="small").frames, tmp_path / "frames.csv")


def test_a_replay_gives_the_frames_of_the_command(command: Command, tmp_path: Path) -> None:
    capture = tmp_path / "hockey.wav"
    settings = {"duration_s": 0.1}
    command("simulate", "hockey", *words(settings), "--waves", "none", "--capture", capture, "--out", tmp_path / "s")
    command("replay", capture, "--out", tmp_path / "r")
    run = hc.replay(capture)
    check(run.frames, tmp_path / "r" / "frames.csv")
    simulated = hc.simulate("hockey", settings).frames
    assert run.frames.slots == simulated.slots


@pytest.mark.parametrize("scene", ["hockey", "peg", "wall-2d", "fig9", "four-pads"])
def test_a_display_that_is_stepped_gives_the_frames_of_its_run(scene: str) -> None:
    settings = {"duration_s": 0.05} if scene in ("hockey", "peg", "wall-2d") else {}
    first_case = hc.simulate(scene, settings).summary["cases"][0]
    whole = hc.simulate(scene, settings, case=first_case).frames
    display = hc.Display(scene, set=settings)
    slots = min(whole.slots, 300)
    first = display.step(slots // 3)
    rest = display.step(slots - first.slots)
    for name in first:
        if not name.startswith("set_"):
            stepped = np.concatenate([first[name], rest[name]])
            assert stepped.tobytes() == whole[name][:slots].tobytes(), name


@pytest.mark.parametrize("scene", ["hockey", "peg", "wall-2d"])
def test_a_core_that_receives_a_displays_codes_gives_its_frames(scene: str) -> None:
    display, core = hc.Display(scene), hc.Core(scene)
    rows, codes = [], []
    for _ in range(24):
        rows.append(display.step())
        codes.append(display.codes())
    pads = [int(row["pad"][0]) for row in rows]
    frames = core.slots(pads, np.array(codes))
    for name in frames:
        stepped = np.concatenate([row[name] for row in rows])
        assert stepped.tolist() == frames[name].tolist(), name


def test_a_slot_alone_gives_the_row_of_many() -> None:
    display = hc.Display("hockey")
    one, many = hc.Core("hockey"), hc.Core("hockey")
    codes = []
    for _ in range(8):
        display.step()
        codes.append(display.codes())
    pads = [slot % 4 for slot in range(8)]
    frames = many.slots(pads, np.array(codes))
    for slot, pad in enumerate(pads):
        measurement = one.slot(pad, codes[slot])
        assert measurement.pad == pad
        assert (measurement.x_mm, measurement.force_n) == (
            frames["x_mm"][slot],
            frames["force_n"][slot],
        )


def test_a_trace_ends_with_what_the_slot_measures() -> None:
    display, core = hc.Display("hockey"), hc.Core("hockey")
    display.step()
    names = core.signals()
    assert len(set(names)) == len(names) > 50
    force, count = "estimator.force_estimator.haptic_force", "multiplexer.count"
    traced = core.trace(display.codes(), [force, count])
    assert list(traced) == [force, count]
    assert traced[force].shape == traced[count].shape
    assert len(traced[force]) > core.shape[0] * 10
    assert len(set(traced[count])) > 1
    measured = core.slot(0, display.codes())
    assert (traced[force][0], traced[force][-1]) == (0.0, measured.force_n)


def test_a_display_after_a_reset_gives_its_first_frames_again() -> None:
    display = hc.Display("wall-2d")
    first = display.step(40)
    display.lead(0, 5, 5)
    display.step(40)
    display.reset()
    again = display.step(40)
    assert all(first[name].tobytes() == again[name].tobytes() for name in first)


def test_a_resolved_scene_gives_the_same_frames(tmp_path: Path) -> None:
    run = hc.simulate("hockey", {"duration_s": 0.1, "pad.2.load_g": 35})
    (text,) = run.resolved_scene.values()
    path = tmp_path / "hockey.toml"
    path.write_text(text)
    again = hc.simulate(path)
    assert again.frames["force_n"].tobytes() == run.frames["force_n"].tobytes()
