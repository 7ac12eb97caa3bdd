# SPDX-License-Identifier: MIT OR Apache-2.0
"""A tradeoff is that of the command, to the digit."""

from __future__ import annotations

import csv
import json
import math
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import _thread
import pytest

import hapticore as hc

SCENE, PROFILE = "minimal-sheet", "small"
WORDS = ["--scene", SCENE, "--profile", PROFILE, "--slots", "1"]


def check(tradeoff: hc.Tradeoff, folder: Path) -> None:
    """Everything is that of the command's files: numbers to the digit."""
    with (folder / "tradeoff.csv").open(newline="") as file:
        head, *rows = csv.reader(file)
    points = tradeoff.points
    assert list(points) == head
    assert points.rows == len(rows) > 20
    for n, name in enumerate(head):
        texts = [row[n] for row in rows]
        if name == "knob":
            assert points[name].tolist() == texts
            continue
        written = [float(text) if text else math.nan for text in texts]
        assert points[name].shape == (len(rows),)
        assert repr(points[name].astype(float).tolist()) == repr(written), name
    summary = json.loads((folder / "tradeoff.json").read_text())
    kept = [{k: v for k, v in of.items() if k != "provenance"} for of in (summary, tradeoff.summary)]
    assert kept[0] == kept[1]


def test_points_are_those_of_the_command(command: Callable[..., str], tmp_path: Path) -> None:
    command("tradeoff", *WORDS, "--out", tmp_path)
    tradeoff = hc.tradeoff(SCENE, PROFILE, slots=1)
    check(tradeoff, tmp_path)
    rows = tradeoff.points.rows
    assert (tradeoff.points["knob"] == "").tolist() == [True] + [False] * (rows - 1)
    assert (tradeoff.found, tradeoff.profile, tradeoff.next_bits) == (None, None, [])
    assert repr(tradeoff) == f"Tradeoff of profile small on minimal-sheet: {rows} profiles"
    assert not tradeoff.points["value"].flags.writeable


@pytest.mark.full
def test_the_profile_that_is_found_is_that_of_the_command(
    command: Callable[..., str], tmp_path: Path
) -> None:
    command("tradeoff", *WORDS, "--explain", "--target", "force=5mN,position=0.5mm", "--out", tmp_path)
    target = {"force_n": 5e-3, "position_mm": 0.5}
    tradeoff = hc.tradeoff(SCENE, PROFILE, slots=1, target=target, explain=True)
    check(tradeoff, tmp_path)
    assert tradeoff.profile == (tmp_path / "profile.toml").read_text()
    assert tradeoff.found is not None and tradeoff.found["target"] == [5.0, None, 500.0]
    assert len(tradeoff.next_bits) > 5


@pytest.mark.usefixtures("heard")
def test_ctrl_c_ends_a_tradeoff_within_a_second() -> None:
    at: list[float] = []

    def press() -> None:
        at.append(time.monotonic())
        _thread.interrupt_main()

    timer = threading.Timer(0.5, press)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        hc.tradeoff("fig6", slots=400)
    took = time.monotonic() - at[0]
    timer.join()
    print(f"ended {took:.2f} s after Ctrl-C")
    # Within a second of processor time; other programs may share the machine.
    assert took < 5


@pytest.mark.parametrize(
    ("keywords", "error", "words"),
    [
        ({"scene": "none"}, hc.SceneError, "expected a file or a scene"),
        ({"profile": "none"}, hc.ProfileError, "none"),
        ({"slots": 0}, hc.Error, "slots: expected 1"),
        ({"family": "asic"}, hc.Error, "family: expected ice40 or ecp5"),
        ({"target": {}}, hc.Error, "target: expected a dict"),
        ({"target": {"force": 1}}, hc.Error, "target: expected force_n"),
        ({"target": {"force_n": 0}}, hc.Error, "above 0"),
        ({"target": {"force_n": math.nan}}, hc.Error, "above 0"),
    ],
)
def test_what_cannot_be_used_is_an_error_in_words(
    keywords: dict[str, Any], error: type[Exception], words: str
) -> None:
    with pytest.raises(error) as caught:
        hc.tradeoff(**{"scene": SCENE, "slots": 1, **keywords})
    assert words in str(caught.value) and "--" not in str(caught.value)
