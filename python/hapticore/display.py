# SPDX-License-Identifier: MIT OR Apache-2.0
"""A simulated display that is stepped slot by slot."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from hapticore import _core, _values
from hapticore.errors import Error
from hapticore.frames import Frames

_Path = str | os.PathLike[str]


class Display:
    """A case of a scene with its core, stepped slot by slot, with inputs between slots.

    Stepped without inputs it gives the frames of `simulate` for that case, to the bit. Slots go on
    after the end of the case: timelines hold their last value, sweeps begin again.

    Parameters
    ----------
    scene : str or path
        A bundled name or a TOML file.
    core : {"fixed", "float", "clock"}
        How exactly the core is run; ``"clock"`` finishes a slot's row while the next one runs.
    set : dict, optional
        Keys of the scene and their values.
    case : str, optional
        Name of the case; by default the first.
    profile : str or path, optional
        The core's profile; by default the scene's.

    Raises
    ------
    SceneError, ProfileError, Error, OSError
        As `simulate`.

    Notes
    -----
    An input holds until the next of its kind, from the beginning of the next slot on. An error of
    an input changes nothing. Threads may share a display: a call waits until another one ends. The
    interpreter's lock is released meanwhile, so that displays of several threads run side by side.

    Examples
    --------
    >>> import hapticore as hc
    >>> display = hc.Display("wall-2d")
    >>> display.lead(0, x_mm=-2.0, y_mm=12.0, within_s=0.1)
    >>> display.step(slots=80).slots
    80
    """

    def __init__(
        self,
        scene: _Path,
        core: str = "fixed",
        set: Mapping[str, Any] | None = None,
        *,
        case: str | None = None,
        profile: _Path | None = None,
    ) -> None:
        self._stepped = _core.Stepped(
            _values.name(scene),
            set=_values.settings(set),
            core=core,
            case=case,
            profile=None if profile is None else _values.name(profile),
        )
        self._name = f"{_values.name(scene)}, core {core}"

    def __repr__(self) -> str:
        return f"Display of {self._name}, at {self.time_s:.6g} s"

    @property
    def slot(self) -> int:
        """Number of the next slot."""
        return self._stepped.slot

    @property
    def time_s(self) -> float:
        """When the next slot begins, s."""
        return self._stepped.time_s

    @property
    def slot_s(self) -> float:
        """Length of a slot, s."""
        return self._stepped.slot_s

    @property
    def pads(self) -> list[str]:
        """Names of the pads."""
        return self._stepped.pads

    @property
    def parts_mm(self) -> list[tuple[float, float]]:
        """Centres of a pad's parts relative to its own, mm; one part for a whole pad.

        Part ``k`` of pad ``p`` has the rows of pad number ``p * len(parts_mm) + k``.
        """
        return self._stepped.parts_mm

    @property
    def sheet_mm(self) -> tuple[float, float]:
        """Width and height of the sheet, mm."""
        return self._stepped.sheet_mm

    @property
    def walls_mm(self) -> tuple[float | None, float | None]:
        """Where the walls along x and y begin now, mm; None where there is none, or it is off."""
        return self._stepped.walls_mm

    def reset(self) -> None:
        """Begin the case anew, without inputs; calibration and tuning are kept.

        Raises
        ------
        Error
            The plant cannot be made again; the display stays as it was.
        """
        self._stepped.reset()

    def step(self, slots: int = 1) -> Frames:
        """Run slots.

        Parameters
        ----------
        slots : int
            How many, 0 to 1,000,000.

        Returns
        -------
        Frames
            Of the slots that were finished, shape (slots,), with their truth.

        Raises
        ------
        Error
            A number of slots out of its range. A result that is not finite: every later step
            raises the same until `reset`.
        KeyboardInterrupt
            The slots before it were run; their rows are lost.
        """
        return Frames(self._stepped.step(_values.count("slots", slots)))

    def codes(self) -> npt.NDArray[np.int32]:
        """ADC codes of the last slot's window, int32 of shape (window, channels).

        Raises
        ------
        Error
            No slot was run yet, or the scene's carrier has phasors only
            (``set={"carrier.rung": "samples"}``).
        """
        codes = self._stepped.codes()
        if codes is None:
            why = "no slot was run yet" if self.slot == 0 else "the carrier has phasors only"
            raise Error(f'codes: expected a slot with samples, but {why}; set carrier.rung "samples"')
        return codes

    def lead(self, pad: int, x_mm: float, y_mm: float, within_s: float = 0.012) -> None:
        """Lead the finger, or the pad itself where it hangs on none, on a line to a place.

        Parameters
        ----------
        pad : int
            Number of the pad.
        x_mm, y_mm : float
            The place, mm from the centre of the sheet.
        within_s : float
            After how long it is there, 0.0001 to 3600 s.

        Raises
        ------
        Error
            No such pad, a place beyond the sheet, a value out of its range.
        """
        self._stepped.lead(self._pad(pad), x_mm, y_mm, within_s)

    def release(self, pad: int) -> None:
        """Let the finger follow the scene again, after a line of 12 ms.

        Parameters
        ----------
        pad : int
            Number of the pad.

        Raises
        ------
        Error
            No such pad.
        """
        self._stepped.release(self._pad(pad))

    def press(self, pad: int, load_g: float) -> None:
        """Set the load on a pad.

        Parameters
        ----------
        pad : int
            Number of the pad.
        load_g : float
            The load, g.

        Raises
        ------
        Error
            No such pad, a load out of its range.
        """
        self._stepped.press(self._pad(pad), load_g)

    def push(self, pad: int, x_n: float = 0.0, y_n: float = 0.0) -> None:
        """Push a pad besides its finger, in a scene with a ``[hand]``.

        Parameters
        ----------
        pad : int
            Number of the pad.
        x_n, y_n : float
            The force along x and y, N.

        Raises
        ------
        Error
            No such pad, no hand, a force out of its range.
        """
        self._stepped.push(self._pad(pad), x_n, y_n)

    def target(self, pad: int, target_n: float) -> None:
        """Set the force that the controller gives a pad.

        Parameters
        ----------
        pad : int
            Number of the pad.
        target_n : float
            The force, N.

        Raises
        ------
        Error
            No such pad, no controller, a force out of its range.
        """
        self._stepped.target(self._pad(pad), target_n)

    def serve(self) -> None:
        """Serve a new puck, in a scene with an ``[arena]``.

        Raises
        ------
        Error
            The case has no arena.
        """
        self._stepped.serve()

    def wall(self, x_mm: float | None = None, y_mm: float | None = None, *, off: bool = False) -> None:
        """Move the walls, or take them away.

        Parameters
        ----------
        x_mm, y_mm : float, optional
            Where the wall along x or y begins, mm from the centre of the sheet; one that is not
            named stays.
        off : bool
            There is no wall until one gets a place again.

        Raises
        ------
        Error
            The case has no such wall, a place beyond the sheet, neither or both of place and off.
        """
        self._stepped.wall(x_mm, y_mm, off)

    def voltage(self, pad: int, v_rms: float) -> None:
        """Set the haptic voltage at a pad's source, in a case without a controller.

        Parameters
        ----------
        pad : int
            Number of the pad.
        v_rms : float
            The voltage, V rms.

        Raises
        ------
        Error
            No such pad, a controller that sets the voltage, a voltage out of its range.
        """
        self._stepped.voltage(self._pad(pad), v_rms)

    @staticmethod
    def _pad(pad: int) -> int:
        return _values.count("pad", pad)
