# SPDX-License-Identifier: MIT OR Apache-2.0
"""The interpreter's lock is released while Rust computes; objects may be shared; Ctrl-C ends a run."""

from __future__ import annotations

import _thread
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import hapticore as hc


def test_two_displays_in_two_threads_give_the_frames_of_one_after_the_other() -> None:
    def run(scene: str) -> bytes:
        display = hc.Display(scene)
        frames = [display.step(60) for _ in range(5)]
        return b"".join(f[name].tobytes() for f in frames for name in ("x_mm", "force_n"))

    scenes = ["peg", "wall-2d"]
    alone = [run(scene) for scene in scenes]
    with ThreadPoolExecutor(2) as pool:
        assert list(pool.map(run, scenes)) == alone


def test_other_threads_go_on_while_a_display_steps() -> None:
    display = hc.Display("wall-2d")
    display.step(8)
    ended = threading.Event()

    def step() -> None:
        display.step(2000)
        ended.set()

    worker = threading.Thread(target=step)
    worker.start()
    turns = 0
    while not ended.is_set():
        turns += 1
        time.sleep(0.001)
    worker.join()
    # With the lock held, this thread would get no turn until the end.
    assert turns > 10


def test_a_display_that_threads_share_runs_each_slot_once() -> None:
    shared, alone = hc.Display("hockey"), hc.Display("hockey")
    with ThreadPoolExecutor(4) as pool:
        frames = list(pool.map(lambda _: shared.step(5), range(20)))
    times = np.sort(np.concatenate([of["time_s"] for of in frames]))
    assert times.tolist() == alone.step(100)["time_s"].tolist()


def test_frames_that_threads_share_give_each_the_same_column() -> None:
    frames = hc.Display("hockey").step(200)
    with ThreadPoolExecutor(4) as pool:
        arrays = list(pool.map(lambda _: frames["x_mm"].sum(), range(16)))
    assert len(set(arrays)) == 1


def test_two_runs_at_a_time_give_the_frames_of_one() -> None:
    def run(_: int) -> bytes:
        return hc.simulate("hockey", {"duration_s": 0.1}).frames["force_n"].tobytes()

    alone = run(0)
    with ThreadPoolExecutor(2) as pool:
        assert set(pool.map(run, range(4))) == {alone}


@pytest.mark.usefixtures("heard")
@pytest.mark.parametrize("what", ["simulate", "step"])
def test_ctrl_c_ends_a_run_and_later_ones_go_on(what: str) -> None:
    display = hc.Display("hockey")
    display.step(4)
    timer = threading.Timer(0.4, _thread.interrupt_main)
    start = time.monotonic()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        if what == "simulate":
            hc.simulate("hockey", {"duration_s": 300})
        else:
            display.step(200_000)
    assert time.monotonic() - start < 20
    timer.join()
    assert hc.simulate("hockey", {"duration_s": 0.02}).frames.slots > 0
    assert display.step(8).slots == 8
