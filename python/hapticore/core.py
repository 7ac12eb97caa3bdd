# SPDX-License-Identifier: MIT OR Apache-2.0
"""The core alone: slots of ADC codes in, measurements out."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from hapticore import _core, _values
from hapticore.errors import Error
from hapticore.frames import Frames

_Path = str | os.PathLike[str]


@dataclass(frozen=True)
class Measurement:
    """What a slot measured.

    Attributes
    ----------
    time_s : float
        Middle of the slot's window, counted from the core's first slot.
    pad : int
        The pad.
    r_x, r_y : float
        Current ratios.
    x_mm, y_mm : float
        Position from the centre of the sheet.
    capacitance_pf : float
        Capacitance of the pad.
    sheet_ohm : float
        Resistance of the sheet at the pad, Ω.
    haptic_v_rms : float
        Haptic voltage, V rms.
    force_n : float
        Haptic force.
    direction : float
        Direction of the push, of a split pad.
    flags : frozenset of str
        Flags that are set; with ``invalid`` the other values are those of the last valid slot.
    """

    time_s: float
    pad: int
    r_x: float
    r_y: float
    x_mm: float
    y_mm: float
    capacitance_pf: float
    sheet_ohm: float
    haptic_v_rms: float
    force_n: float
    direction: float
    flags: frozenset[str]


class Core:
    """A core with the calibration of a device.

    Parameters
    ----------
    scene : str or path, optional
        The simulated device of a scene, with the scene's profile.
    set : dict, optional
        Keys of the scene and their values.
    profile : str or path, optional
        The core's profile; by default the scene's, or ``"standard"``.
    calibration : str or path, optional
        A device's calibration file, in place of a scene; by default the nominal device's.
    pads : int, optional
        Pads of that device, 1 to 256.
    core : {"fixed", "float"}
        How exactly the core is run.

    Raises
    ------
    SceneError, ProfileError, Error, OSError
        As `simulate`; also a scene together with a calibration.

    Notes
    -----
    Threads may share a core: a call waits until another one ends. The interpreter's lock is
    released meanwhile. An error leaves the core as it was.

    Examples
    --------
    >>> import hapticore as hc, numpy as np
    >>> core = hc.Core(profile="standard")
    >>> window, channels = core.shape
    >>> measured = core.slot(0, np.zeros(core.shape, dtype=np.int32))
    >>> "invalid" in measured.flags
    True
    """

    def __init__(
        self,
        scene: _Path | None = None,
        set: Mapping[str, Any] | None = None,
        *,
        profile: _Path | None = None,
        calibration: _Path | None = None,
        pads: int | None = None,
        core: str = "fixed",
    ) -> None:
        if scene is not None and (calibration is not None or pads is not None):
            raise Error("expected either a scene, or calibration and pads, got both")
        if scene is None and set:
            raise Error("set: expected a scene whose keys are set, got none")
        self._slots = _core.Slots(
            None if scene is None else _values.name(scene),
            set=_values.settings(set),
            profile=None if profile is None else _values.name(profile),
            calibration=None if calibration is None else _values.name(calibration),
            pads=None if pads is None else _values.count("pads", pads, 1),
            core=core,
        )

    @property
    def shape(self) -> tuple[int, int]:
        """Shape of a slot's codes: (samples of the window, channels)."""
        return self._slots.shape

    @property
    def pads(self) -> int:
        """Pads that the core serves; each part of a split pad is one."""
        return self._slots.pads

    @property
    def codes(self) -> tuple[int, int]:
        """The least and the largest code of the ADC."""
        return self._slots.codes

    @property
    def slot_s(self) -> float:
        """Length of a slot, s."""
        return self._slots.slot_s

    def __repr__(self) -> str:
        window, channels = self.shape
        return f"Core of {self.pads} pads, slots of {window} samples of {channels} channels"

    def slot(self, pad: int, codes: npt.NDArray[np.int32]) -> Measurement:
        """Take a slot; what it measured.

        Parameters
        ----------
        pad : int
            Number of the pad, below `pads`.
        codes : ndarray of int32, shape (window, channels)
            ADC codes of the slot's window (`shape`); channels are the terminals' currents, the
            sensing voltage, the haptic voltage.

        Returns
        -------
        Measurement

        Raises
        ------
        Error
            No such pad; codes of another shape, another dtype, or beyond the ADC's (`codes`).
        """
        codes = self._checked(codes, self.shape)
        frames = self.slots(np.array([_values.count("pad", pad)]), codes[np.newaxis])
        names = (field.name for field in fields(Measurement))
        values = {name: frames[name][0].item() for name in names}
        values["flags"] = frozenset(filter(None, values["flags"].split("+")))
        return Measurement(**values)

    def slots(self, pads: npt.ArrayLike, codes: npt.NDArray[np.int32]) -> Frames:
        """Take slots, one after the other; what they measured.

        Parameters
        ----------
        pads : array of int, shape (n,)
            The pad of each slot.
        codes : ndarray of int32, shape (n, window, channels)
            ADC codes of each slot's window, as for `slot`.

        Returns
        -------
        Frames
            Of shape (n,), without a truth.

        Raises
        ------
        Error
            As `slot`; then none of the slots was taken.
        """
        of_slots = np.asarray(pads)
        if of_slots.ndim != 1 or of_slots.dtype.kind not in "iu":
            raise Error(
                f"pads: expected integers of shape (n,), got {of_slots.dtype} of shape "
                f"{of_slots.shape}"
            )
        codes = self._checked(codes, (len(of_slots), *self.shape))
        numbers = np.ascontiguousarray(of_slots, dtype=np.int64)
        return Frames(self._slots.take(numbers, codes))

    def signals(self) -> list[str]:
        """Names of all signals of the core, with the blocks that they belong to.

        Raises
        ------
        Error
            A calibration that the profile cannot represent.
        """
        return self._slots.signals()

    def trace(
        self, codes: npt.NDArray[np.int32], signals: str | Iterable[str]
    ) -> dict[str, npt.NDArray[np.float64]]:
        """Clock a core through one slot, and keep signals after each clock.

        Another core with the same calibration, after a reset, receives the slot as that of pad 0,
        behind a blanking without current, and is clocked until its frame is finished. This core
        stays as it is.

        Parameters
        ----------
        codes : ndarray of int32, shape (window, channels)
            ADC codes of the slot's window, as for `slot`.
        signals : str or list of str
            Names of signals (`signals`).

        Returns
        -------
        dict of str to ndarray of float64, shape (clocks,)
            Each signal's value: its code times the least significant bit of its format.

        Raises
        ------
        Error
            No such signal; codes as for `slot`.
        """
        return self._slots.trace(self._checked(codes, self.shape), _values.names(signals))

    @staticmethod
    def _checked(codes: Any, shape: tuple[int, ...]) -> npt.NDArray[np.int32]:
        if not isinstance(codes, np.ndarray):
            raise Error(
                f"codes: expected an array of int32 of shape {shape}, got {type(codes).__name__}"
            )
        if codes.dtype != np.int32 or codes.shape != shape:
            raise Error(
                f"codes: expected int32 of shape {shape}, got {codes.dtype} of shape {codes.shape}"
            )
        return np.ascontiguousarray(codes, dtype=np.int32)
