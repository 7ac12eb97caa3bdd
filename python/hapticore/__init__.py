# SPDX-License-Identifier: MIT OR Apache-2.0
"""Simulation and sensing core of an electrostatic visuo-haptic display.

The same Rust code as the command ``hapticore``: results are equal to the bit.

==================================  ==========================================================
`simulate`, `replay`, `calibrate`   whole runs: a scene, a capture, a lab's data
`Core`                              the core alone: slots of ADC codes in, measurements out
`Display`                           a scene that is stepped, with inputs between slots
`live`                              a scene in the browser
`hapticore.gym`                     Gymnasium environments, registered where Gymnasium is there
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
from hapticore.core import Core, Measurement
from hapticore.display import Display
from hapticore.errors import Error, ProfileError, SceneError
from hapticore.frames import Frames
from hapticore.page import Live, live
from hapticore.runs import Calibration, Run, calibrate, replay, simulate

__all__ = [
    "Calibration",
    "Core",
    "Display",
    "Error",
    "Frames",
    "Live",
    "Measurement",
    "ProfileError",
    "Run",
    "SceneError",
    "__version__",
    "calibrate",
    "live",
    "profiles",
    "replay",
    "scenes",
    "simulate",
]


def _register() -> None:
    from importlib.util import find_spec

    if find_spec("gymnasium") is None:
        return
    from gymnasium.envs.registration import register

    register(id="hapticore/Wall-v0", entry_point="hapticore.gym:Wall", max_episode_steps=1000)
    register(id="hapticore/Track-v0", entry_point="hapticore.gym:Track", max_episode_steps=1000)


_register()
