# SPDX-License-Identifier: MIT OR Apache-2.0
"""Frames: the results of slots as NumPy arrays."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from hapticore import _core

if TYPE_CHECKING:
    import pandas
    import polars
    import pyarrow

#: Ends of columns' names, and the unit that each says.
_UNITS = (
    ("_v_rms", "V"), ("_mm", "mm"), ("_pf", "pF"), ("_ohm", "Ω"), ("_n", "N"), ("_g", "g"), ("_s", "s"),
)  # fmt: skip


def unit(column: str) -> str:
    """The unit of a column, as its name says; empty where it has none."""
    return next((unit for end, unit in _UNITS if column.endswith(end)), "")


class Frames(Mapping[str, np.ndarray]):
    """Results of slots: a mapping from columns to arrays of shape (slots,).

    ======================  =========================================================================
    ``time_s``              middle of the slot's window
    ``pad``                 number of the pad, or of the part of a split pad (int64)
    ``x_mm``, ``y_mm``      position
    ``capacitance_pf``      capacitance of the pad
    ``haptic_v_rms``        haptic voltage
    ``force_n``             haptic force
    ``flags``               names of the flags that are set, joined by ``+`` (str)
    ``true_…``              the same as simulated, of a scene
    ``target_n``, …         what a controller made of it
    ======================  =========================================================================

    ``docs/formats.md`` lists all columns: they are those of ``frames.csv``. Numbers are float64,
    conditions bool. An array is made when its column is first asked for; it is read-only, since
    later uses return the same one. ``attrs`` holds units and where the results come from.

    Examples
    --------
    >>> import hapticore as hc
    >>> frames = hc.simulate("hockey", set={"duration_s": 0.1}).frames
    >>> frames["force_n"].shape == (len(frames["pad"]),)
    True
    >>> frames.where(pad=2)["x_mm"].mean()  # doctest: +SKIP
    """

    def __init__(self, rows: _core.Rows, attrs: Mapping[str, Any] | None = None) -> None:
        self._rows = rows
        self._origin = attrs
        self._arrays: dict[str, np.ndarray] = {}
        self._chosen: np.ndarray | None = None

    @cached_property
    def _names(self) -> list[str]:
        return self._rows.names()

    @cached_property
    def attrs(self) -> dict[str, Any]:
        """``units`` of the columns; of a run also scene, profile, fidelity, version, seed, ``set``."""
        units = {name: unit(name) for name in self._names if unit(name)}
        return {"units": units, **(self._origin or {})}

    @property
    def slots(self) -> int:
        """Number of slots: the length of every column."""
        return len(self._rows) if self._chosen is None else len(self._chosen)

    def __getitem__(self, column: str) -> np.ndarray:
        """A column, shape (slots,).

        Raises
        ------
        KeyError
            No such column.
        """
        if column not in self._arrays:
            array = self._rows.column(column)
            if isinstance(array, tuple):
                numbers, names = array
                array = np.array(names or [""], dtype=np.str_)[numbers]
            array = array if self._chosen is None else array[self._chosen]
            array.flags.writeable = False
            self._arrays[column] = array
        return self._arrays[column]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __contains__(self, column: object) -> bool:
        return column in self._names

    def __repr__(self) -> str:
        columns = ", ".join(self._names[:12]) + (", …" if len(self._names) > 12 else "")
        return f"Frames of {self.slots} slots: {columns}"

    def where(self, **columns: Any) -> Frames:
        """The slots in which columns have these values.

        Parameters
        ----------
        **columns
            Column and value: ``where(pad=1, case="rest")``.

        Returns
        -------
        Frames
            Of the slots for which all hold, in their order.

        Raises
        ------
        KeyError
            No such column.
        """
        chosen = np.ones(self.slots, dtype=np.bool_)
        for column, value in columns.items():
            chosen &= self[column] == value
        found = Frames(self._rows, self._origin)
        before = np.arange(len(self._rows)) if self._chosen is None else self._chosen
        found._chosen = before[chosen]
        return found

    def to_pandas(self) -> pandas.DataFrame:
        """A ``pandas.DataFrame`` of shape (slots, columns), with the same ``attrs``.

        Raises
        ------
        ImportError
            pandas is not installed.
        """
        import pandas

        frame = pandas.DataFrame({name: self[name] for name in self})
        frame.attrs.update(self.attrs)
        return frame

    def to_polars(self) -> polars.DataFrame:
        """A ``polars.DataFrame`` of shape (slots, columns).

        Raises
        ------
        ImportError
            polars is not installed.
        """
        import polars

        return polars.DataFrame({name: self[name] for name in self})

    def to_arrow(self) -> pyarrow.Table:
        """A ``pyarrow.Table`` of shape (slots, columns); units are in its schema's metadata.

        Raises
        ------
        ImportError
            pyarrow is not installed.
        """
        import json

        import pyarrow

        table = pyarrow.table({name: pyarrow.array(self[name]) for name in self})
        return table.replace_schema_metadata({"hapticore": json.dumps(self.attrs)})
