# SPDX-License-Identifier: MIT OR Apache-2.0
"""The live page: a scene in the browser."""

from __future__ import annotations

import os
from collections.abc import Mapping
from types import TracebackType
from typing import Any

from hapticore import _core, _values

_Path = str | os.PathLike[str]


class Live:
    """A server of the live page, from `live`; as a context manager it ends with its block."""

    def __init__(self, page: _core.Page) -> None:
        self._page = page

    @property
    def url(self) -> str:
        """The page's address, for a browser on this machine."""
        return self._page.url

    def close(self) -> None:
        """End the server; later calls do nothing."""
        self._page.close()

    def __enter__(self) -> Live:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"Live at {self.url}"


def live(
    scene: _Path = "peg",
    set: Mapping[str, Any] | None = None,
    core: str = "fixed",
    case: str | None = None,
    profile: _Path | None = None,
    *,
    port: int = 0,
    speed: float = 1.0,
) -> Live:
    """Serve a scene to a browser on this machine, as ``hapticore live`` does (docs/live.md).

    Parameters
    ----------
    scene, set, core, case, profile
        As for `Display`.
    port : int
        0 takes a free one.
    speed : float
        Device time by wall time; 0 begins paused.

    Returns
    -------
    Live
        Its ``url`` is the page's address. It serves until it is closed.

    Raises
    ------
    SceneError, Error, OSError
        As `simulate`; a port in use, a speed out of its range.

    Examples
    --------
    >>> import hapticore as hc
    >>> with hc.live("hockey") as page:
    ...     page.url.startswith("http://127.0.0.1:")
    True
    """
    number = min(_values.count("port", port), 1 << 16)
    if number > 65535:
        from hapticore.errors import Error

        raise Error(f"port: expected 0 to 65535, got {port}")
    return Live(
        _core.Page(
            _values.name(scene),
            set=_values.settings(set),
            core=core,
            case=case,
            profile=None if profile is None else _values.name(profile),
            port=number,
            speed=float(speed),
        )
    )
