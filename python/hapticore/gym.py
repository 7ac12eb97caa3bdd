# SPDX-License-Identifier: MIT OR Apache-2.0
"""Gymnasium environments: a finger leads a pad, and sees only what the core measures.

===================== ================================================ ==============================
``hapticore/Wall-v0``  find a hidden wall and rest in it at 0.3 N       1 s, 1000 steps
``hapticore/Track-v0`` keep the pad at a moving place                   1 s, 1000 steps
===================== ================================================ ==============================

Both are of the scene ``wall-2d``: a pad in four parts under 80 g on a hand of 300 N/m, friction,
noise, and the core with its wall controller. A step is 1 ms: one frame of the pad. Importing
`hapticore` registers them where Gymnasium is installed.

An action is the place of the finger by 60 mm (`REACH_MM`); the finger goes there at 300 mm/s at most.
"""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt

from hapticore.display import Display
from hapticore.frames import Frames

_Array = npt.NDArray[np.float32]

#: Where the finger may go, mm on each side of the sheet's centre: an action of 1.
REACH_MM = 60.0

#: How far the finger goes in a step, mm.
_STEP_MM = 0.3

#: Least and largest of the measured x and y (mm), capacitance (pF), force (N), voltage (V rms),
#: direction.
_LEAST = (-430.0, -250.0, 0.0, -10.0, 0.0, -1.0)
_MOST = (430.0, 250.0, 5000.0, 10.0, 1000.0, 1.0)

#: In free air the core learns what the direction reads without a push.
_STIR = {
    "timeline": {
        "x_mm": [[0, 14], [0.05, 8], [0.1, 14], [0.15, 10]],
        "y_mm": [[0, 14], [0.05, 8], [0.1, 14], [0.15, 10]],
    }
}
_STIR_S = 0.16
_START_MM = (10.0, 10.0)

#: A wall that no finger reaches, mm.
_AWAY_MM = -200.0


class _Env(gymnasium.Env[_Array, _Array]):
    """What both environments share: the display, and a finger of limited speed.

    Parameters
    ----------
    set : dict, optional
        Keys of the scene and their values: ``{"pad.0.load_g": 40}``.
    core : {"fixed", "float"}
        How exactly the core is run.
    """

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(self, set: dict[str, Any] | None = None, core: str = "fixed") -> None:
        keys = {"pad.0.position_mm": _STIR, **(set or {})}
        self.display = Display("wall-2d", core, keys)
        self._slots = round(1e-3 / self.display.slot_s)
        self._finger_mm = np.array(_START_MM)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (2,), dtype=np.float32)
        self.observation_space = gymnasium.spaces.Box(
            np.array(_LEAST, dtype=np.float32), np.array(_MOST, dtype=np.float32), dtype=np.float32
        )

    def _begin(self) -> Frames:
        """The display after its stir, with all walls away."""
        self.display.reset()
        self.display.wall(x_mm=_AWAY_MM, y_mm=_AWAY_MM)
        self.display.step(round(_STIR_S / self.display.slot_s))
        self._finger_mm = np.array(_START_MM)
        return self._advance(self._finger_mm / REACH_MM)

    def _advance(self, action: npt.ArrayLike) -> Frames:
        """A step of 1 ms with the finger on its way to a place."""
        to_mm = REACH_MM * np.clip(np.asarray(action, dtype=float), -1.0, 1.0)
        way_mm = to_mm - self._finger_mm
        length_mm = float(np.hypot(*way_mm))
        self._finger_mm = self._finger_mm + way_mm * min(1.0, _STEP_MM / max(length_mm, 1e-9))
        x_mm, y_mm = self._finger_mm.tolist()
        self.display.lead(0, x_mm, y_mm, within_s=1e-3)
        return self.display.step(self._slots)

    @staticmethod
    def _measured(frames: Frames) -> _Array:
        """Of a frame of all parts: mean place, whole capacitance, mean force, voltage, direction."""
        of_pad = (
            frames["x_mm"].mean(),
            frames["y_mm"].mean(),
            frames["capacitance_pf"].sum(),
            frames["force_n"].mean(),
            frames["haptic_v_rms"][-1],
            frames["direction"][-1],
        )
        measured: _Array = np.clip(of_pad, _LEAST, _MOST).astype(np.float32)
        return measured


class Wall(_Env):
    """``hapticore/Wall-v0``: find a hidden wall and rest in it at 0.3 N.

    The wall lies left of the pad, from 0 to 40 mm left of the sheet's centre by chance; nothing
    but its force tells of it (0.5 N/mm). The pad begins at (10, 10) mm.

    Parameters
    ----------
    set : dict, optional
        Keys of the scene and their values.
    core : {"fixed", "float"}
        How exactly the core is run.

    Attributes
    ----------
    action_space : Box, shape (2,), float32
        Where the finger goes: x and y from the sheet's centre, by 60 mm, within ±1.
    observation_space : Box, shape (6,), float32
        As measured: x (mm), y (mm), capacitance (pF), force (N), voltage (V rms), direction.

    Notes
    -----
    The reward of a step is 0.01 at a measured force of 0.3 N and falls linearly to 0 at 0 and at
    0.6 N. ``info["found"]`` is True once the force was 0.1 to 0.5 N for 100 ms;
    ``info["wall_mm"]`` is where the wall lies. An episode is truncated after 1000 steps.
    ``options={"wall_mm": -12.5}`` of `reset` puts the wall to a place.
    """

    #: The force to rest at, N.
    TARGET_N = 0.3

    #: A wall is found at forces between these, N, for this number of steps.
    FOUND_N = (0.1, 0.5)
    FOUND_STEPS = 100

    def __init__(self, set: dict[str, Any] | None = None, core: str = "fixed") -> None:
        super().__init__(set, core)
        self._wall_mm = 0.0
        self._felt = 0
        self._found = False

    def _info(self) -> dict[str, Any]:
        return {"found": self._found, "wall_mm": self._wall_mm}

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[_Array, dict[str, Any]]:
        """Begin an episode with the wall at another place.

        Parameters
        ----------
        seed : int, optional
            Of the wall's place.
        options : dict, optional
            ``wall_mm``: the wall's place, −50 to 5 mm.

        Returns
        -------
        observation : ndarray of float32, shape (6,)
        info : dict

        Raises
        ------
        Error
            A place of the wall beyond the sheet.
        """
        super().reset(seed=seed)
        by_chance = float(self.np_random.uniform(-40.0, 0.0))
        self._wall_mm = float((options or {}).get("wall_mm", by_chance))
        self._felt, self._found = 0, False
        frames = self._begin()
        self.display.wall(x_mm=self._wall_mm)
        return self._measured(frames), self._info()

    def step(self, action: _Array) -> tuple[_Array, float, bool, bool, dict[str, Any]]:
        """Step 1 ms.

        Parameters
        ----------
        action : ndarray of float32, shape (2,)
            Where the finger goes, by 60 mm.

        Returns
        -------
        observation : ndarray of float32, shape (6,)
        reward : float
        terminated, truncated : bool
        info : dict
        """
        measured = self._measured(self._advance(action))
        force_n = float(measured[3])
        least_n, most_n = self.FOUND_N
        self._felt = self._felt + 1 if least_n <= force_n <= most_n else 0
        self._found = self._found or self._felt >= self.FOUND_STEPS
        off = min(1.0, abs(force_n - self.TARGET_N) / self.TARGET_N)
        return measured, 0.01 * (1.0 - off), False, False, self._info()


class Track(_Env):
    """``hapticore/Track-v0``: keep the pad at a place that moves on a Lissajous curve.

    Walls are away; friction and the hand's spring hold the pad back.

    Parameters
    ----------
    set : dict, optional
        Keys of the scene and their values.
    core : {"fixed", "float"}
        How exactly the core is run.

    Attributes
    ----------
    action_space : Box, shape (2,), float32
        Where the finger goes: x and y from the sheet's centre, by 60 mm, within ±1.
    observation_space : Box, shape (8,), float32
        As measured: x (mm), y (mm), capacitance (pF), force (N), voltage (V rms), direction; then
        the place to be at, x and y (mm).

    Notes
    -----
    The reward of a step is −0.001 for each mm between the pad, as simulated, and its place.
    ``info["error_mm"]`` is that distance. An episode is truncated after 1000 steps.
    """

    def __init__(self, set: dict[str, Any] | None = None, core: str = "fixed") -> None:
        super().__init__(set, core)
        reach = (REACH_MM, REACH_MM)
        self.observation_space = gymnasium.spaces.Box(
            np.array((*_LEAST, -REACH_MM, -REACH_MM), dtype=np.float32),
            np.array((*_MOST, *reach), dtype=np.float32),
            dtype=np.float32,
        )
        self._phase = np.zeros(2)
        self._hz = np.zeros(2)
        self._steps = 0

    def _place_mm(self) -> npt.NDArray[np.float64]:
        turns = self._hz * self._steps * 1e-3
        start = np.sin(2 * np.pi * self._phase)
        return np.array(_START_MM) + 15.0 * (np.sin(2 * np.pi * (turns + self._phase)) - start)

    def _observed(self, frames: Frames) -> tuple[_Array, dict[str, Any]]:
        place_mm = self._place_mm()
        pad_mm = np.array([frames["true_x_mm"].mean(), frames["true_y_mm"].mean()])
        observed = np.concatenate([self._measured(frames), place_mm]).astype(np.float32)
        return observed, {"error_mm": float(np.hypot(*(pad_mm - place_mm)))}

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[_Array, dict[str, Any]]:
        """Begin an episode with another curve.

        Parameters
        ----------
        seed : int, optional
            Of the curve: frequencies of 0.5 to 1 Hz and phases.
        options : dict, optional
            Not used.

        Returns
        -------
        observation : ndarray of float32, shape (8,)
        info : dict
        """
        super().reset(seed=seed)
        self._phase = self.np_random.uniform(0.0, 1.0, 2)
        self._hz = self.np_random.uniform(0.5, 1.0, 2)
        self._steps = 0
        return self._observed(self._begin())

    def step(self, action: _Array) -> tuple[_Array, float, bool, bool, dict[str, Any]]:
        """Step 1 ms.

        Parameters
        ----------
        action : ndarray of float32, shape (2,)
            Where the finger goes, by 60 mm.

        Returns
        -------
        observation : ndarray of float32, shape (8,)
        reward : float
        terminated, truncated : bool
        info : dict
        """
        self._steps += 1
        observed, info = self._observed(self._advance(action))
        return observed, -1e-3 * info["error_mm"], False, False, info
