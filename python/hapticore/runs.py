# SPDX-License-Identifier: MIT OR Apache-2.0
"""Whole runs: scenes, captures, a lab's data."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from hapticore import _core, _values
from hapticore.frames import Frames
from hapticore.plots import Plot

_Path = str | os.PathLike[str]


@dataclass(frozen=True, repr=False)
class Run:
    """What a run leaves.

    Attributes
    ----------
    frames : Frames
        A row for each slot, equal to those of ``frames.csv``.
    criteria : list of dict
        What the scene claims: ``name``, ``measured``, ``limit``, ``pass``, ``unit``; of a capture
        none.
    warnings : list of str
        What a user must know before using the results.
    resolved_scene : dict of str
        Each case as a scene of its own in TOML, with everything that was set.
    summary : dict
        All of ``summary.json`` (docs/formats.md).
    """

    frames: Frames
    summary: dict[str, Any]

    @property
    def criteria(self) -> list[dict[str, Any]]:
        """Criteria of the scene with their measurements."""
        return list(self.summary["criteria"])

    @property
    def warnings(self) -> list[str]:
        """What a user must know before using the results."""
        return list(self.summary["warnings"])

    @property
    def resolved_scene(self) -> dict[str, str]:
        """Each case as a scene of its own, in TOML."""
        return dict(self.summary["resolved_scene"])

    @property
    def passed(self) -> bool:
        """Whether all criteria hold."""
        return all(criterion["pass"] for criterion in self.criteria)

    def __repr__(self) -> str:
        scene, profile = self.summary["scene"], self.summary["profile"]
        criteria = self.criteria
        passed = sum(criterion["pass"] for criterion in criteria)
        judged = f", {passed} of {len(criteria)} criteria pass" if criteria else ""
        return f"Run of {scene}, profile {profile}: {self.frames.slots} slots{judged}"

    def plot(self, *columns: str) -> Plot:
        """Draw the figures of the run's report, or columns over time.

        Parameters
        ----------
        *columns : str
            Columns as for `Frames.plot`; without one the figures that ``report.html`` of the command
            has over two axes. Its maps of the sheet, panels and tables are only there.

        Returns
        -------
        Plot
            It shows itself in a notebook; ``save`` writes it.

        Raises
        ------
        KeyError
            No such column.
        Error
            A column of names; no slots.

        Examples
        --------
        >>> import hapticore as hc
        >>> hc.simulate("fig6").plot().titles[0]
        'Friction over the haptic voltage'
        """
        if columns:
            return self.frames.plot(*columns)
        return self.frames._report()


def _run(result: tuple[_core.Rows, str]) -> Run:
    rows, text = result
    summary: dict[str, Any] = json.loads(text)
    keys = ("scene", "profile", "fidelity", "version", "commit", "seed", "set", "resolved_scene")
    return Run(Frames(rows, {key: summary.get(key) for key in keys}), summary)


def simulate(
    scene: _Path,
    set: Mapping[str, Any] | None = None,
    core: str = "fixed",
    case: str | Iterable[str] | None = None,
    profile: _Path | None = None,
    *,
    errors: bool = False,
    unstable: bool = False,
) -> Run:
    """Run a scene through the core, as ``hapticore simulate`` does.

    The interpreter's lock is released; cases and slots use all processors. Ctrl-C ends a run.

    Parameters
    ----------
    scene : str or path
        A bundled name (`scenes`) or a TOML file.
    set : dict, optional
        Keys of the scene and their values: ``{"pad.0.load_g": 50, "carrier.rung": "samples"}``.
    core : {"fixed", "float", "clock"}
        How exactly the core is run: to the bit, in floating point, or every clock.
    case : str or list of str, optional
        Run only these cases.
    profile : str or path, optional
        The core's profile: a bundled name (`profiles`) or a TOML file; by default the scene's.
    errors : bool
        Whether to find the rounding error of every signal (``summary["errors"]``).
    unstable : bool
        Run a force loop that is predicted to be unstable.

    Returns
    -------
    Run
        Its frames are equal to those of the command, to the bit.

    Raises
    ------
    SceneError
        No such scene, or one that cannot be run; it names key, file and line.
    ProfileError
        No such profile, or one that no core can have.
    Error
        Any other input that cannot be used: no such case or fidelity, an unstable loop.
    OSError
        A file that cannot be read.

    Examples
    --------
    >>> import hapticore as hc
    >>> run = hc.simulate("hockey", set={"duration_s": 0.1})
    >>> frames = run.frames
    >>> error_mm = frames["x_mm"] - frames["true_x_mm"]
    >>> bool(abs(error_mm).max() < 3)
    True
    """
    return _run(
        _core.simulate(
            _values.name(scene),
            set=_values.settings(set),
            core=core,
            case=_values.names(case),
            profile=None if profile is None else _values.name(profile),
            errors=errors,
            unstable=unstable,
        )
    )


def replay(
    capture: _Path,
    *,
    calibration: _Path | None = None,
    profile: _Path | None = None,
    core: str = "fixed",
    pads: int | None = None,
    channels: Iterable[str] | None = None,
    bits: int | None = None,
    full_scale_v: float | None = None,
    skip: int = 0,
    truncated: bool = False,
) -> Run:
    """Replay recorded ADC samples through the core, as ``hapticore replay`` does.

    Parameters
    ----------
    capture : str or path
        NAME.csv, NAME.wav or NAME.sigmf-meta (docs/formats.md).
    calibration : str or path, optional
        The device's; by default CAPTURE.calibration.toml where there is one, else the nominal
        device's, with a warning.
    profile : str or path, optional
        The core's profile; by default ``"standard"``.
    core : {"fixed", "float", "clock"}
        How exactly the core is run.
    pads : int, optional
        Pads that are selected in turn, 1 to 256; by default the calibration's.
    channels : list of str, optional
        What the capture's channels are, in their order; ``_`` leaves one out.
    bits : int, optional
        Bits of integer codes, 2 to 32, where they are at the bottom of wider samples.
    full_scale_v : float, optional
        The samples are volts at the ADC, this many at the end of its range.
    skip : int
        Samples left out at the beginning.
    truncated : bool
        Take what is there of a file that is cut short.

    Returns
    -------
    Run
        Frames of all slots, equal to those of the command, to the bit; without a truth.

    Raises
    ------
    ProfileError
        No such profile, or one that no core can have.
    Error
        A capture or calibration that cannot be used; the message names file, line or sample.
    OSError
        A file that cannot be read.
    """
    return _run(
        _core.replay(
            _values.name(capture),
            calibration=None if calibration is None else _values.name(calibration),
            profile=None if profile is None else _values.name(profile),
            core=core,
            pads=None if pads is None else _values.count("pads", pads, 1),
            channels=None if channels is None else _values.names(channels),
            bits=None if bits is None else min(_values.count("bits", bits), 255),
            full_scale_v=full_scale_v,
            skip=_values.count("skip", skip),
            truncated=truncated,
        )
    )


@dataclass(frozen=True)
class Calibration:
    """A device's calibration.

    Attributes
    ----------
    text : str
        The calibration file, TOML.
    outcome : dict
        What it was made from and how good it is: ``places``, ``own_places``, ``held_out``,
        ``force`` (docs/calibrate.md).
    warnings : list of str
        What a user must know.
    """

    text: str = field(repr=False)
    outcome: dict[str, Any]

    @property
    def warnings(self) -> list[str]:
        """What a user must know."""
        return list(self.outcome["warnings"])

    def write(self, path: _Path) -> None:
        """Write the calibration file, for `replay`, `Core` and the command.

        Parameters
        ----------
        path : str or path
            The file, by custom NAME.toml; one of this name is replaced.

        Raises
        ------
        OSError
            It cannot be written.
        """
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.text)


def calibrate(*data: _Path, profile: _Path = "standard") -> Calibration:
    """Make a device's calibration from what a lab measured, as ``hapticore calibrate`` does.

    Parameters
    ----------
    *data : str or path
        Files, each known by its content: places and loads as CSV, a setup as TOML
        (docs/calibrate.md).
    profile : str or path
        The profile whose position table is tried on the places.

    Returns
    -------
    Calibration

    Raises
    ------
    ProfileError
        No such profile.
    Error
        Data that make no calibration; the message names what is missing or wrong.
    OSError
        A file that cannot be read.
    """
    files = [_values.name(file) for file in data]
    text, outcome = _core.calibrate(files, profile=_values.name(profile))
    return Calibration(text, json.loads(outcome))
