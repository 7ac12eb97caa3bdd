# SPDX-License-Identifier: MIT OR Apache-2.0
"""Gymnasium environments: checked by Gymnasium, fast, and with something to learn."""

from __future__ import annotations

import runpy
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hapticore as hc

gymnasium = pytest.importorskip("gymnasium")
from gymnasium.utils.env_checker import check_env  # noqa: E402

NAMES = ["hapticore/Wall-v0", "hapticore/Track-v0"]
POLICY = Path(__file__).parents[1] / "notebooks" / "5_policy.py"


def finger(x_mm: float) -> Any:
    """The action that leads the finger to a place at y = 10 mm."""
    return np.array([x_mm / 60, 10 / 60], dtype=np.float32)


@pytest.mark.parametrize("name", NAMES)
def test_gymnasium_finds_no_fault(name: str) -> None:
    env = gymnasium.make(name)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env.unwrapped, skip_render_check=True)


@pytest.mark.parametrize("name", NAMES)
def test_a_step_costs_little_more_than_the_display(name: str) -> None:
    env = gymnasium.make(name)
    env.reset(seed=1)
    display = hc.Display("wall-2d")

    def seconds(step: Callable[[], object]) -> float:
        start = time.thread_time()
        for _ in range(100):
            step()
        return time.thread_time() - start

    # In turns, so that what slows the machine slows both.
    pairs = [
        (seconds(lambda: env.step(finger(-20.0))), seconds(lambda: display.step(4))) for _ in range(4)
    ]
    of_env, of_display = (min(times) for times in zip(*pairs))
    print(f"{name}: {100 / of_env:.0f} steps of 1 ms per second, the display alone {100 / of_display:.0f}")
    assert of_env < 2.5 * of_display


@pytest.mark.parametrize("name", NAMES)
def test_an_episode_is_a_second_and_follows_from_its_seed(name: str) -> None:
    env = gymnasium.make(name)

    def episode(seed: int, steps: int) -> list[Any]:
        observed, _ = env.reset(seed=seed)
        env.action_space.seed(seed)
        seen = [observed.tolist()]
        for _ in range(steps):
            observed, reward, *_ = env.step(env.action_space.sample())
            seen.append((observed.tolist(), reward))
        return seen

    assert episode(3, 60) == episode(3, 60)
    env.reset(seed=4)
    ends = [env.step(np.zeros(2, dtype=np.float32))[2:4] for _ in range(1000)]
    assert ends[-2:] == [(False, False), (False, True)]


def test_a_finger_that_stays_away_finds_no_wall() -> None:
    env = gymnasium.make(NAMES[0])
    env.reset(seed=5)
    rewards = [env.step(finger(10)) for _ in range(300)]
    assert not rewards[-1][4]["found"]
    assert sum(step[1] for step in rewards) == 0


@pytest.mark.parametrize("wall_mm", [-3.0, -20.0])
def test_a_finger_that_goes_left_slowly_finds_the_wall_and_a_fast_one_slides_through(
    wall_mm: float,
) -> None:
    env = gymnasium.make(NAMES[0])

    def found(mm_per_step: float) -> bool:
        _, info = env.reset(options={"wall_mm": wall_mm})
        assert info["wall_mm"] == wall_mm
        x_mm, force_n = 10.0, 0.0
        for _ in range(900):
            x_mm -= mm_per_step * max(0.0, 1 - force_n / 0.3)
            observed, _, _, _, info = env.step(finger(x_mm))
            force_n = float(observed[3])
        return bool(info["found"])

    assert found(0.06)
    assert not found(0.3)


def test_a_wall_beyond_the_sheet_is_an_error() -> None:
    env = gymnasium.make(NAMES[0])
    with pytest.raises(hc.Error, match="x_mm"):
        env.reset(options={"wall_mm": 1e4})


@pytest.mark.full
def test_a_policy_that_is_trained_longer_rests_in_the_wall(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HAPTICORE_LONG", "1")
    found = runpy.run_path(str(POLICY))
    assert found["found"] == found["trials"]
    assert found["score"] > 4.0
