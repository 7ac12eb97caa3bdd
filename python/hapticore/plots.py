# SPDX-License-Identifier: MIT OR Apache-2.0
"""Plots: figures of the command's reports as SVG."""

from __future__ import annotations

import os
from dataclasses import dataclass, field

from hapticore.errors import Error

_Path = str | os.PathLike[str]


@dataclass(frozen=True, repr=False)
class Plot:
    """Figures, below each other, in one SVG document.

    In a notebook it shows itself, in light or dark colours as the reader's system asks for.

    Attributes
    ----------
    titles : list of str
        The title of each figure.
    svg : str
        The document that a notebook shows.
    """

    titles: list[str]
    svg: str
    _light: str = field(repr=False)

    def _repr_svg_(self) -> str:
        return self.svg

    def __repr__(self) -> str:
        return f"Plot of {', '.join(self.titles)}"

    def save(self, path: _Path) -> None:
        """Write the document, in light colours: for print.

        Parameters
        ----------
        path : str or path
            NAME.svg; a file of this name is replaced.

        Raises
        ------
        Error
            A name with another ending.
        OSError
            It cannot be written.
        """
        if not os.fspath(path).endswith(".svg"):
            raise Error(f"path: expected NAME.svg, got {os.fspath(path)!r}")
        with open(path, "w", encoding="utf-8") as file:
            file.write(self._light)
