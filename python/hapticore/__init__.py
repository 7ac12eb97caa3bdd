# SPDX-License-Identifier: MIT OR Apache-2.0
"""Simulation and sensing core of an electrostatic visuo-haptic display.

The same Rust code as the command ``hapticore``: results are equal to the bit.

==================================  ==========================================================
`simulate`, `replay`, `calibrate`   whole runs: a scene, a capture, a lab's data
`Core`                              the core alone: slots of ADC codes in, measurements out
`Display`                           a scene that is stepped, with inputs between slots
`connect`                           a board, real or virtual
`live`                              a scene in the browser
`tradeoff`                          what accuracy costs: errors, latency and area of profiles
`hapticore.gym`                     Gymnasium environments, registered where Gymnasium is there
`hapticore.zoo`                     air hockey of two policies, for PettingZoo
==================================  ==========================================================

Names end with their unit: ``_mm``, ``_n`` (N), ``_g``, ``_pf``, ``_v_rms`` (V rms), ``_s``.
Places are from the centre of the sheet. Pads are numbered from 0.

Examples
--------
>>> import hapticore as hc
>>> run = hc.simulate("fig6", set={"pad.0.load_g": 50})
>>> force_n = run.frames["force_n"]          # shape (slots,)
"""

from hapticore._core import __version__, profiles, scenes
from hapticore.board import Board, connect
from hapticore.core import Core, Measurement
from hapticore.display import Display
from hapticore.errors import BoardError, Error, ProfileError, SceneError
from hapticore.frames import Frames, Table
from hapticore.page import Live, live
from hapticore.plots import Plot
from hapticore.runs import Calibration, Run, calibrate, replay, simulate
from hapticore.tradeoffs import Tradeoff, tradeoff

__all__ = [
    "Board",
    "BoardError",
    "Calibration",
    "Core",
    "Display",
    "Error",
    "Frames",
    "Live",
    "Measurement",
    "Plot",
    "ProfileError",
    "Run",
    "SceneError",
    "Table",
    "Tradeoff",
    "__version__",
    "calibrate",
    "connect",
    "live",
    "profiles",
    "replay",
    "scenes",
    "simulate",
    "tradeoff",
]


def _register() -> None:
    from importlib.util import find_spec

    if find_spec("gymnasium") is None:
        return
    from gymnasium.envs.registration import register

    register(id="hapticore/Wall-v0", entry_point="hapticore.gym:Wall", max_episode_steps=1000)
    register(id="hapticore/Track-v0", entry_point="hapticore.gym:Track", max_episode_steps=1000)


_register()
