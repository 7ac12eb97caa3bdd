# SPDX-License-Identifier: MIT OR Apache-2.0
"""What accuracy costs: errors, latency and area of profiles."""

from __future__ import annotations

import csv
import io
import json
import math
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from hapticore import _core, _values
from hapticore.errors import Error
from hapticore.frames import Table

_Path = str | os.PathLike[str]

#: What may be asked for, and how many of the command's units (mN, %, µm) one of it is.
_TARGETS = {"force_n": 1e3, "capacitance_percent": 1.0, "position_mm": 1e3}


@dataclass(frozen=True, repr=False)
class Tradeoff:
    """A profile and its neighbours: what each is off, and what it costs.

    Attributes
    ----------
    points : Table
        A row for the profile itself (``knob`` is empty), then one for each word that is longer or
        shorter and each other window. Columns are those of ``tradeoff.csv`` (docs/tradeoff.md),
        shape (profiles,): ``knob`` (str), ``value`` (bits or samples), latency, ``age_us``, area,
        ``predicted_force_rms`` and so on. Errors are mN (force), % (capacitance), µm (position),
        V (drive), ppm (direction); NaN where there is none.
    found : dict or None
        The cheapest profile for the target, where there was one: ``bits``, ``predicted``,
        ``judged`` on unseen slots, ``cost``, ``before``, ``limit``, ``missed``.
    profile : str or None
        That profile as TOML, for ``profile=`` of other functions once it is written to a file.
    next_bits : list of dict
        What one more bit of each word would buy, where it was asked for.
    warnings : list of str
        What a user must know.
    summary : dict
        All of ``tradeoff.json``.
    """

    points: Table
    profile: str | None
    warnings: list[str]
    summary: dict[str, Any]

    @property
    def found(self) -> dict[str, Any] | None:
        """The cheapest profile for the target."""
        found: dict[str, Any] | None = self.summary["found"]
        return found

    @property
    def next_bits(self) -> list[dict[str, Any]]:
        """What one more bit of each word would buy."""
        return list(self.summary["next_bits"])

    def __repr__(self) -> str:
        scenes = ", ".join(self.summary["scenes"])
        found = "" if self.found is None else ", a profile found"
        name = self.summary["profile"]
        return f"Tradeoff of profile {name} on {scenes}: {self.points.rows} profiles{found}"


def tradeoff(
    scene: _Path | Iterable[_Path] | None = None,
    profile: _Path | None = None,
    *,
    slots: int = 96,
    target: Mapping[str, float] | None = None,
    family: str | None = None,
    explain: bool = False,
) -> Tradeoff:
    """Vary each word of a profile, and the window, as ``hapticore tradeoff`` does.

    The interpreter's lock is released; profiles use all processors. Ctrl-C ends it.

    Parameters
    ----------
    scene : str, path or list of such, optional
        Scenes that profiles are tried on; by default fig3, fig6 and hockey.
    profile : str or path, optional
        The profile that is varied: a bundled name (`profiles`) or a TOML file; by default
        ``"standard"``.
    slots : int
        Slots of each scene; of force loops and split pads twenty times as many.
    target : dict, optional
        Search the cheapest profile with these RMS errors at most: ``force_n`` (N),
        ``position_mm`` (mm), ``capacitance_percent`` (%).
    family : {"ecp5", "ice40"}, optional
        The FPGA family whose LUT4 a search saves; by default that of the profile's multipliers.
    explain : bool
        Whether to find what one more bit of each word would buy.

    Returns
    -------
    Tradeoff
        Its points are equal to those of the command, to the digit.

    Raises
    ------
    SceneError, ProfileError, OSError
        As `simulate`.
    Error
        A target that is none, another family, no slots.

    Examples
    --------
    >>> import hapticore as hc
    >>> points = hc.tradeoff("fig6", slots=2).points  # doctest: +SKIP
    >>> points["luts_ecp5"][points["knob"] == ""]  # doctest: +SKIP
    """
    scenes = [] if scene is None else [scene] if isinstance(scene, (str, os.PathLike)) else list(scene)
    (text, summary, found), warnings = _core.tradeoff(
        [_values.name(name) for name in scenes],
        profile=None if profile is None else _values.name(profile),
        slots=_values.count("slots", slots, 1),
        target=None if target is None else _target(target),
        family=family,
        explain=explain,
    )
    of_run: dict[str, Any] = json.loads(summary)
    attrs = {key: of_run[key] for key in ("profile", "scenes", "slots")}
    return Tradeoff(Table(_columns(text), attrs), found, warnings, of_run)


def _target(of: Mapping[str, float]) -> tuple[float | None, float | None, float | None]:
    if not isinstance(of, Mapping) or not of:
        raise Error(f"target: expected a dict with {', '.join(_TARGETS)}")
    for name, value in of.items():
        if name not in _TARGETS:
            raise Error(f"target: expected {', '.join(_TARGETS)}, got {name!r}")
        if not 0 < float(value) < math.inf:
            raise Error(f"target: {name}: expected above 0, got {value}")
    force, capacitance, position = (
        float(of[name]) * factor if name in of else None for name, factor in _TARGETS.items()
    )
    return force, capacitance, position


def _columns(text: str) -> dict[str, np.ndarray]:
    head, *rows = csv.reader(io.StringIO(text))
    return {name: _column(name, [row[n] for row in rows]) for n, name in enumerate(head)}


def _column(name: str, texts: list[str]) -> np.ndarray:
    if name == "knob":
        return np.array(texts, dtype=np.str_)
    if name in ("value", "latency_clocks"):
        return np.array([int(text) for text in texts])
    return np.array([float(text) if text else math.nan for text in texts])
