# SPDX-License-Identifier: MIT OR Apache-2.0
"""Air hockey for PettingZoo: checked by PettingZoo, and played."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

pytest.importorskip("pettingzoo")
from pettingzoo.test import parallel_api_test  # noqa: E402

from hapticore.zoo import HALF_MM, AirHockey  # noqa: E402


def at(x_mm: float, y_mm: float) -> Any:
    """The action that leads a finger to a place."""
    return np.array([x_mm / HALF_MM[0], y_mm / HALF_MM[1]], dtype=np.float32)


def test_pettingzoo_finds_no_fault() -> None:
    parallel_api_test(AirHockey(steps=100), num_cycles=150)


def test_a_strike_scores_against_a_mallet_that_stays_away_and_the_puck_is_served_anew() -> None:
    env = AirHockey()
    env.reset(seed=1)
    goals, served = 0.0, False
    for step in range(1500):
        strike = at(-60.0, 0.0) if step > 100 and goals == 0.0 else at(-150.0, 0.0)
        seen, rewards, *_ = env.step({"left": strike, "right": at(140.0, 120.0)})
        assert rewards["left"] == -rewards["right"]
        goals += rewards["left"]
        served = served or (goals > 0.0 and abs(seen["left"][5]) < 100.0)
        if served:
            break
    assert goals == 1.0, f"{goals} goals"
    assert served, "the puck comes back"


def test_a_game_after_a_reset_is_the_same() -> None:
    env = AirHockey()

    def play() -> list[float]:
        env.reset()
        seen = [env.step({"left": at(-60.0, 0.0), "right": at(140.0, 0.0)})[0] for _ in range(150)]
        return [float(value) for frame in seen for value in (*frame["left"], *frame["right"])]

    first = play()
    assert play() == first
