# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tables of NumPy arrays; frames: the results of slots."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from hapticore import _core
from hapticore.errors import Error
from hapticore.plots import Plot

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


class Table(Mapping[str, np.ndarray]):
    """A mapping from columns to arrays of one length, in their order.

    ``attrs`` holds where the numbers come from, and the ``units`` of the columns. Arrays are
    read-only.
    """

    def __init__(self, columns: Mapping[str, np.ndarray], attrs: Mapping[str, Any] | None = None) -> None:
        self._arrays = dict(columns)
        for array in self._arrays.values():
            array.flags.writeable = False
        self._origin = attrs

    @cached_property
    def attrs(self) -> dict[str, Any]:
        """``units`` of the columns, and where the numbers come from."""
        units = {name: unit(name) for name in self if unit(name)}
        return {"units": units, **(self._origin or {})}

    @property
    def rows(self) -> int:
        """Number of rows: the length of every column."""
        return len(next(iter(self._arrays.values()), ()))

    def __getitem__(self, column: str) -> np.ndarray:
        """A column, shape (rows,).

        Raises
        ------
        KeyError
            No such column.
        """
        return self._arrays[column]

    def __iter__(self) -> Iterator[str]:
        return iter(self._arrays)

    def __len__(self) -> int:
        return len(self._arrays)

    def __repr__(self) -> str:
        return f"Table of {self.rows} rows: {_listed(list(self))}"

    def to_pandas(self) -> pandas.DataFrame:
        """A ``pandas.DataFrame`` of shape (rows, columns), with the same ``attrs``.

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
        """A ``polars.DataFrame`` of shape (rows, columns).

        Raises
        ------
        ImportError
            polars is not installed.
        """
        import polars

        return polars.DataFrame({name: self[name] for name in self})

    def to_arrow(self) -> pyarrow.Table:
        """A ``pyarrow.Table`` of shape (rows, columns); units are in its schema's metadata.

        Raises
        ------
        ImportError
            pyarrow is not installed.
        """
        import json

        import pyarrow

        table = pyarrow.table({name: pyarrow.array(self[name]) for name in self})
        return table.replace_schema_metadata({"hapticore": json.dumps(self.attrs)})


def _listed(names: list[str]) -> str:
    return ", ".join(names[:12]) + (", …" if len(names) > 12 else "")


class Frames(Table):
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

    @property
    def rows(self) -> int:
        """Number of slots, as `slots`."""
        return self.slots

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
        return f"Frames of {self.slots} slots: {_listed(self._names)}"

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

    def plot(self, *columns: str) -> Plot:
        """Draw columns over time, a colour per pad.

        A quantity is drawn as in a report of the command: what was measured, with its truth where
        there is one. Of many slots a line shows means, a band the range around them.

        Parameters
        ----------
        *columns : str
            Columns of numbers: ``plot("force_n", "x_mm")``; one figure each, below each other.

        Returns
        -------
        Plot
            It shows itself in a notebook; ``save`` writes it.

        Raises
        ------
        KeyError
            No such column.
        Error
            No column, or one of names; no slots.

        Examples
        --------
        >>> import hapticore as hc
        >>> hc.simulate("hockey", set={"duration_s": 0.1}).frames.plot("force_n")
        Plot of Haptic force
        """
        if not columns:
            raise Error("plot: expected the name of a column")
        if not self.slots:
            raise Error("plot: expected slots, got none")
        return Plot(*self._rows.plot(list(columns), self._chosen))

    def _report(self) -> Plot:
        return Plot(*self._rows.plot([], self._chosen))
