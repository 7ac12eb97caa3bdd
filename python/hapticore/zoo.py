# SPDX-License-Identifier: MIT OR Apache-2.0
"""PettingZoo environment: air hockey of two policies, whose mallets the arena's walls and impacts brake.

====================================== ======================================================
``hapticore.zoo.AirHockey()``          parallel environment of the agents ``left`` and ``right``
====================================== ======================================================

The scene is ``air-hockey``: two pads in four parts on hands, the core with its wall controller, and a
puck that the host plays on the measured places. A step is 2 ms: one frame of each pad.
"""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt
import pettingzoo

from hapticore.display import Display
from hapticore.frames import Frames

_Array = npt.NDArray[np.float32]

#: Half of the table's length and height, mm: an action of 1.
HALF_MM = (300.0, 180.0)

#: How far a finger goes in a step of 2 ms, mm: 800 mm/s.
_STEP_MM = 1.6

#: Where the fingers begin, mm.
_START_MM = {"left": (-150.0, 0.0), "right": (140.0, 0.0)}

#: Largest measured |x|, |y| (mm), force (N); the other mallet's x, y; the puck's x, y (mm), speed (mm/s).
_MOST = (430.0, 250.0, 10.0, 430.0, 250.0, 430.0, 250.0, 10000.0)

#: What the puck may do after a goal before it is served anew, steps.
_SERVE_STEPS = 250


class AirHockey(pettingzoo.ParallelEnv[str, _Array, _Array]):  # type: ignore[misc]
    """Two policies play; each sees what the core measures, the other's place and the puck.

    Parameters
    ----------
    set : dict, optional
        Keys of the scene and their values: ``{"arena.goal_half_mm": 90}``.
    core : {"fixed", "float"}
        How exactly the core is run.
    steps : int
        Length of an episode, steps of 2 ms.

    Notes
    -----
    Action, shape (2,): where the finger goes by half the table's size, within ±1. Observation, shape
    (8,): own x, y (mm) and force (N), the other's x, y (mm), the puck's x, y (mm) and speed (mm/s), as
    measured. The reward of a step is 1 for a goal, −1 for one of the other. The core keeps each mallet
    in its half by force alone: a finger that pulls harder than the wall leaves it.
    """

    metadata: dict[str, Any] = {"name": "hapticore_air_hockey_v0", "render_modes": []}

    def __init__(
        self, set: dict[str, Any] | None = None, core: str = "fixed", steps: int = 5000
    ) -> None:
        self.possible_agents = ["left", "right"]
        self.agents: list[str] = []
        self.steps = steps
        # Fingers stay where they begin; the scene's own motion is for its criteria.
        places = {f"pad.{name}.position_mm": list(at) for name, at in _START_MM.items()}
        self.display = Display("air-hockey", core, {"duration_s": 1000, **places, **(set or {})})
        self._slots = round(2e-3 / self.display.slot_s)
        most = np.array(_MOST, dtype=np.float32)
        self.observation_spaces = {
            name: gymnasium.spaces.Box(-most, most, dtype=np.float32) for name in self.possible_agents
        }
        self.action_spaces = {
            name: gymnasium.spaces.Box(-1.0, 1.0, (2,), dtype=np.float32)
            for name in self.possible_agents
        }
        self._fingers_mm: dict[str, npt.NDArray[np.float64]] = {}
        self._score = np.zeros(2)
        self._done = 0
        self._serve_in: int | None = None

    def observation_space(self, agent: str) -> gymnasium.Space[_Array]:
        """What an agent sees."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> gymnasium.Space[_Array]:
        """What an agent does."""
        return self.action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, _Array], dict[str, dict[str, Any]]]:
        """Begin a game at 0 : 0, the puck served to the left.

        Parameters
        ----------
        seed : int, optional
            Not used: the noise is the scene's, by its key ``seed``.
        options : dict, optional
            Not used.

        Returns
        -------
        observations, infos : dict
            Of each agent.
        """
        self.display.reset()
        self.agents = list(self.possible_agents)
        self._fingers_mm = {name: np.array(at) for name, at in _START_MM.items()}
        self._score, self._done, self._serve_in = np.zeros(2), 0, None
        frames = self.display.step(2 * self._slots)
        return self._observed(frames), self._infos()

    def step(
        self, actions: dict[str, _Array]
    ) -> tuple[
        dict[str, _Array],
        dict[str, float],
        dict[str, bool],
        dict[str, bool],
        dict[str, dict[str, Any]],
    ]:
        """Step 2 ms.

        Parameters
        ----------
        actions : dict of ndarray, shape (2,)
            Where each finger goes, by half the table's size.

        Returns
        -------
        observations, rewards, terminations, truncations, infos : dict
            Of each agent.
        """
        for pad, name in enumerate(self.possible_agents):
            if name in actions:
                self._lead(pad, name, actions[name])
        frames = self.display.step(self._slots)
        observed = self._observed(frames)
        score = np.array([frames["score_left"][-1], frames["score_right"][-1]])
        left = float((score - self._score) @ (1, -1))
        self._score = score
        self._serve(left != 0.0)
        self._done += 1
        over = self._done >= self.steps
        agents, infos = self.agents, self._infos()
        if over:
            self.agents = []
        return (
            observed,
            dict(zip(agents, (left, -left))),
            dict.fromkeys(agents, False),
            dict.fromkeys(agents, over),
            infos,
        )

    def _lead(self, pad: int, name: str, action: npt.ArrayLike) -> None:
        to_mm = np.array(HALF_MM) * np.clip(np.asarray(action, dtype=float), -1.0, 1.0)
        way_mm = to_mm - self._fingers_mm[name]
        share = min(1.0, _STEP_MM / max(float(np.hypot(*way_mm)), 1e-9))
        self._fingers_mm[name] = self._fingers_mm[name] + way_mm * share
        x_mm, y_mm = self._fingers_mm[name].tolist()
        self.display.lead(pad, x_mm, y_mm, within_s=2e-3)

    def _serve(self, is_goal: bool) -> None:
        if is_goal:
            self._serve_in = _SERVE_STEPS
        elif self._serve_in is not None:
            self._serve_in -= 1
            if self._serve_in == 0:
                self.display.serve()
                self._serve_in = None

    def _observed(self, frames: Frames) -> dict[str, _Array]:
        """Of the last frame of each part: mean place and force of each pad."""
        parts = len(self.display.parts_mm)
        last = {pad: frames["pad"] // parts == pad for pad in (0, 1)}
        places = [
            (float(frames["x_mm"][of].mean()), float(frames["y_mm"][of].mean())) for of in last.values()
        ]
        forces = [float(frames["force_n"][of].mean()) for of in last.values()]
        puck = [float(frames[column][-1]) for column in ("puck_x_mm", "puck_y_mm", "puck_mm_s")]
        observed = {}
        for pad, name in enumerate(self.possible_agents):
            values = (*places[pad], forces[pad], *places[1 - pad], *puck)
            most = np.array(_MOST)
            observed[name] = np.clip(values, -most, most).astype(np.float32)
        return observed

    def _infos(self) -> dict[str, dict[str, Any]]:
        score = [int(goals) for goals in self._score]
        return {name: {"score": score} for name in self.agents}
