# SPDX-License-Identifier: MIT OR Apache-2.0
"""Exceptions of the package.

All others that its functions raise are Python's own: ``OSError`` for a file that cannot be read
or written, ``TypeError`` for an argument of the wrong kind, ``OverflowError`` for an integer
beyond any range, ``KeyError`` for a column that is not there, ``KeyboardInterrupt``.
"""

from __future__ import annotations


class Error(ValueError):
    """An input that cannot be used; the message names what was expected and what was found."""


class SceneError(Error):
    """A scene that is not there or cannot be run.

    Attributes
    ----------
    key : str
        The key in dotted form, ``pad.0.load_g``; empty where none is at fault.
    file : str
        The scene's file, or NAME.toml for a bundled scene; empty where there is no such scene.
    line : int or None
        Line of the file, from 1; None where `set` or the file as a whole is at fault.
    """

    def __init__(
        self, message: str, key: str = "", file: str = "", line: int | None = None
    ) -> None:
        super().__init__(message, key, file, line)
        self.key = key
        self.file = file
        self.line = line

    def __str__(self) -> str:
        return str(self.args[0])


class ProfileError(Error):
    """A profile that is not there, or that no core can have; the message names the field."""


class BoardError(Error):
    """A board that does not do what is asked; the message names cause and cure.

    No line, no board behind it, a board that refuses its start-up, a drive that is off, a target
    beyond the cap, a board that was closed.
    """
