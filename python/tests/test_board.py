# SPDX-License-Identifier: MIT OR Apache-2.0
"""Boards: frames, a drive that is off unless a living program has armed it, errors in words.

Virtual boards run in real time. A machine that is too busy leaves time out, and an armed drive may miss its signs of life:
then it is off, which is safe, and these tests arm it again.
"""

from __future__ import annotations

import _thread
import gc
import os
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hapticore as hc

from conftest import ROOT

CALIBRATION = ROOT / "host" / "recordings" / "hockey.calibration.toml"
PATIENCE_S = 60.0


def measured(display: hc.Display) -> list[str]:
    """Columns of a display that a board has, too."""
    others = ("true_", "set_", "case", "point")
    return [name for name in display.step() if not name.startswith(others)]


def until(what: str, holds: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE_S
    while not holds():
        assert time.monotonic() < end, what
        time.sleep(0.01)


def drive(board: hc.Board) -> None:
    """Arms a board, until its pad is driven."""

    def is_driven() -> bool:
        try:
            board.arm()
            board.target(0, 0.2)
        except hc.BoardError:
            return False
        frames = board.read(seconds=0.05)
        return bool(frames.slots and frames["drive_v_rms"][-1] > 1)

    until("driven", is_driven)


def is_off(board: hc.Board) -> bool:
    frames = board.read(frames=8)
    return board.phase == "measuring" and not frames["drive_v_rms"].any()


def test_frames_have_the_columns_of_a_display_without_its_truth() -> None:
    with hc.connect("virtual") as board:
        frames = board.read(frames=100)
        again = board.read(frames=100)
        assert board.identity is not None and board.identity.startswith("protocol 3, digest ")
        assert repr(board) == "Board at virtual, measuring"
        assert len(board.pads) == 4 and board.slot_s == pytest.approx(0.0017, rel=0.2)
        counts = board.statistics
    assert list(frames) == measured(hc.Display("hockey"))
    assert (frames.slots, again.slots) == (100, 100)
    times = np.concatenate([frames["time_s"], again["time_s"]])
    assert (np.diff(times) > 0).all()
    assert set(frames["pad"]) == {0, 1, 2, 3}
    assert frames.attrs["port"] == "virtual"
    assert counts["frames"] >= 200 and counts["lost"] == counts["damaged"] == 0


def test_a_board_with_a_drive_has_its_columns_and_no_voltage_until_it_is_armed() -> None:
    with hc.connect("virtual:fig9") as board:
        frames = board.read(frames=40)
        assert list(frames) == measured(hc.Display("fig9"))
        assert not frames["drive_v_rms"].any()
        with pytest.raises(hc.BoardError, match="armed drive"):
            board.target(0, 0.2)
        drive(board)
        board.disarm()
        until("off", lambda: is_off(board))


def test_a_program_that_hangs_loses_the_drive() -> None:
    with hc.connect("virtual:fig9") as board:
        drive(board)
        assert board.phase in ("armed", "measuring")
        time.sleep(1.5)
        assert board.phase == "measuring"
        assert any("made no call for 1 s" in note or "silent" in note for note in board.notes)
        board.read()
        until("off", lambda: is_off(board))


def test_a_program_that_reads_keeps_the_drive() -> None:
    with hc.connect("virtual:fig9") as board:
        # A machine that is too busy may take it away: then once more.
        for _ in range(5):
            drive(board)
            frames = board.read(seconds=1.6)
            board.alive()
            if frames["drive_v_rms"][-20:].all():
                break
        assert frames["drive_v_rms"][-20:].all()
        assert not any("made no call" in note for note in board.notes)


def test_an_exception_closes_the_board() -> None:
    with pytest.raises(RuntimeError), hc.connect("virtual:fig9") as board:
        drive(board)
        raise RuntimeError
    assert board.phase == "closed"
    board.close()
    calls: list[Callable[[], Any]] = [board.read, board.arm, board.alive, board.check]
    for call in calls:
        with pytest.raises(hc.BoardError, match="closed"):
            call()


def test_a_board_that_is_collected_is_closed() -> None:
    board = hc.connect("virtual")
    link = board._link
    del board
    gc.collect()
    assert link.phase == "closed"


@pytest.fixture
def served() -> Iterator[str]:
    """The address of a virtual board in another process."""
    command = os.environ.get("HAPTICORE")
    if not command:
        pytest.skip("HAPTICORE names no command")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{free.getsockname()[1]}"
    words = [command, "host", "virtual", "--profile", "small", "--serve", address]
    with subprocess.Popen(words, stderr=subprocess.DEVNULL) as board:
        host, port = address.split(":")

        def listens() -> bool:
            try:
                socket.create_connection((host, int(port))).close()
            except OSError:
                return False
            return True

        until("served", listens)
        yield address
        board.terminate()


END = """
import os, signal, sys, time, hapticore as hc
board = hc.connect(sys.argv[1], profile="small", calibration=sys.argv[2], timeout_s=0)
while board.phase != "identifying":
    time.sleep(0.005)
if sys.argv[3] == "killed":
    os.kill(os.getpid(), signal.SIGKILL)
"""


def sent_by_a_process(how: str) -> bytes:
    """What a board receives of a process that connects and ends."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = f"tcp:127.0.0.1:{server.getsockname()[1]}"
        words = [sys.executable, "-c", END, port, str(CALIBRATION), how]
        # Not in the folder of the package's sources, which have no extension module.
        with subprocess.Popen(words, cwd=Path(__file__).parent):
            line, _ = server.accept()
            with line:
                line.settimeout(PATIENCE_S)
                parts = []
                try:
                    while part := line.recv(4096):
                        parts.append(part)
                except ConnectionResetError:
                    pass
    return b"".join(parts)


def test_the_end_of_the_interpreter_disables_the_board() -> None:
    # A session begins with the command that disables; a process that is killed sends nothing more.
    disables = sent_by_a_process("killed")
    assert disables
    assert sent_by_a_process("ends") == 2 * disables


@pytest.mark.full
def test_a_check_finds_nothing_wrong_with_a_sound_board_and_brings_it_up_again() -> None:
    with hc.connect("virtual:minimal-sheet") as board:
        assert board.check() == []
        assert board.read(frames=8, timeout_s=PATIENCE_S).slots == 8
        assert any(note.startswith("step 1 of 3") for note in board.notes)


@pytest.mark.full
def test_a_check_names_the_fault_of_a_virtual_board() -> None:
    with hc.connect("virtual:minimal-sheet", faults=["open=3"]) as board:
        assert board.check() == ["terminal 3: open; check its wire to the ADC"]


@pytest.mark.parametrize("fault", ["burnt=1", "open=0", "open=99"])
def test_a_fault_that_is_none_is_refused(fault: str) -> None:
    with pytest.raises(hc.Error, match=f"fault.*: expected.*{fault.split('=')[1]}"):
        hc.connect("virtual", faults=[fault])


def test_what_a_check_asks_for_may_be_refused(served: str) -> None:
    asked: list[str] = []

    def refuse(what: str) -> None:
        asked.append(what)
        raise LookupError

    port = f"tcp:{served}"
    with hc.connect(port, profile="small", calibration=CALIBRATION) as board:
        with pytest.raises(LookupError):
            board.check(refuse)
        assert asked[0].startswith("put pad 0 at x = ")
        assert board.read(frames=8, timeout_s=PATIENCE_S).slots == 8


def test_pads_of_a_virtual_board_are_led() -> None:
    with hc.connect("virtual:minimal-sheet") as board:
        board.lead(0, 40.0, -30.0, within_s=0.05)

        def is_there() -> bool:
            frames = board.read(frames=4)
            return abs(frames["x_mm"][-1] - 40) < 3 and abs(frames["y_mm"][-1] + 30) < 3

        until("there", is_there)
        with pytest.raises(hc.BoardError):
            board.lead(0, 1e4, 0.0)
        with pytest.raises(hc.BoardError):
            board.lead(9, 0.0, 0.0)


def test_walls_are_set_where_there_are_some() -> None:
    with hc.connect("virtual:wall-2d") as board:
        board.wall(x_mm=-5.0)
        board.wall(off=True)
        assert "released" in board.read()
        with pytest.raises(hc.BoardError, match="along y"):
            board.wall(y_mm=5.0)
        for bad in ({}, {"x_mm": 1.0, "off": True}):
            with pytest.raises(hc.Error, match="either a place or off"):
                board.wall(**bad)  # type: ignore[arg-type]
    with hc.connect("virtual") as board, pytest.raises(hc.BoardError, match="walls"):
        board.wall(x_mm=0.0)


def test_what_a_board_cannot_do_is_refused_in_words() -> None:
    with hc.connect("virtual") as board:
        with pytest.raises(hc.BoardError, match="no drive") as caught:
            board.arm()
        assert "--" not in str(caught.value)
        for bad in ({"frames": -1}, {"frames": 10**7}, {"seconds": -1.0}, {"seconds": float("nan")}):
            with pytest.raises(hc.Error):
                board.read(**bad)  # type: ignore[arg-type]
        with pytest.raises(hc.Error, match="either"):
            board.read(1, 1.0)
    with hc.connect("virtual:fig9") as board:
        for pad, newtons in ((99, 0.1), (0, 1e6), (0, float("nan")), (0, -1.0)):
            with pytest.raises(hc.BoardError, match="expected"):
                board.target(pad, newtons)
        for odd in (-1, "0", None):
            with pytest.raises((hc.Error, TypeError)):
                board.target(odd, 0.1)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("port", "keywords", "error", "words"),
    [
        ("virtual:none", {}, hc.SceneError, "expected a file or a scene"),
        ("virtual", {"set": {"pad.0.load": 1}}, hc.SceneError, "load"),
        ("virtual", {"profile": "none"}, hc.ProfileError, "none"),
        ("virtual", {"control": "inverse"}, hc.Error, "control: expected none with a virtual"),
        ("virtual", {"wave": "dc"}, hc.Error, "wave: expected"),
        ("virtual", {"baud": 5}, hc.Error, "baud: expected 1200"),
        ("virtual", {"full_scale_v": 0}, hc.Error, "full_scale_v: expected 1"),
        ("virtual", {"full_scale_v": 10**6}, hc.Error, "full_scale_v"),
        ("virtual", {"timeout_s": -1}, hc.Error, "timeout_s"),
        ("virtual", {"timeout_s": float("nan")}, hc.Error, "timeout_s"),
        ("virtual", {"calibration": "none.toml"}, OSError, "none.toml"),
        ("/no/such/port", {}, hc.Error, "calibration: expected the device's"),
        ("/no/such/port", {"set": {"a": 1}}, hc.Error, "set: expected none"),
        ("/no/such/port", {"calibration": CALIBRATION}, hc.BoardError, "/no/such/port: "),
        ("tcp:nowhere", {"calibration": CALIBRATION}, hc.Error, "expected tcp:ADDRESS:PORT"),
        ("tcp:127.0.0.1:1", {"calibration": CALIBRATION}, hc.BoardError, "tcp:127.0.0.1:1: "),
        ("/dev/null", {"calibration": CALIBRATION, "dac": "ad5664r"}, hc.Error, "dac: expected"),
    ],
)
def test_what_connect_cannot_use_is_an_error_in_words(
    port: str, keywords: dict[str, Any], error: type[Exception], words: str
) -> None:
    begun = time.monotonic()
    with pytest.raises(error) as caught:
        hc.connect(port, **keywords)
    assert words in str(caught.value)
    assert "--" not in str(caught.value)
    assert time.monotonic() - begun < 20, "well before the time for a start-up"


@pytest.fixture
def mute() -> Iterator[str]:
    """A line on which nobody says anything."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield f"tcp:127.0.0.1:{server.getsockname()[1]}"


def test_a_silent_board_is_given_up(mute: str) -> None:
    with pytest.raises(hc.BoardError, match=r"within 1\.5 s, it is identifying; no bytes come"):
        hc.connect(mute, calibration=CALIBRATION, profile="small", timeout_s=1.5)
    with hc.connect(mute, calibration=CALIBRATION, profile="small", timeout_s=0) as board:
        with pytest.raises(hc.BoardError, match="expected a frame within 0.3 s"):
            board.read(frames=1, timeout_s=0.3)


def interrupted(call: Callable[[], Any]) -> float:
    """How long a call goes on after Ctrl-C, s."""
    at: list[float] = []

    def press() -> None:
        at.append(time.monotonic())
        _thread.interrupt_main()

    timer = threading.Timer(0.3, press)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        call()
    took = time.monotonic() - at[0]
    timer.join()
    return took


@pytest.mark.usefixtures("heard")
def test_ctrl_c_ends_a_call_that_waits(mute: str) -> None:
    with hc.connect("virtual") as board:
        waits = [interrupted(lambda: board.read(frames=100_000)) for _ in range(3)]
        assert min(waits) < 0.2
        assert board.read(frames=8).slots == 8
    quiet = {"calibration": CALIBRATION, "profile": "small"}
    assert min(interrupted(lambda: hc.connect(mute, **quiet)) for _ in range(3)) < 0.2  # type: ignore[arg-type]


def test_threads_share_a_board_and_each_frame_is_read_once() -> None:
    with hc.connect("virtual") as board:
        found: list[hc.Frames] = []
        readers = [threading.Thread(target=lambda: found.append(board.read(frames=25))) for _ in range(4)]
        for reader in readers:
            reader.start()
        for reader in readers:
            reader.join()
    times = np.concatenate([frames["time_s"] for frames in found])
    assert len(set(times)) == len(times) == 100
