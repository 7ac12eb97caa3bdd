# SPDX-License-Identifier: MIT OR Apache-2.0
"""Values of Python as the text that the scene's parser reads."""

from __future__ import annotations

import json
import operator
import os
from collections.abc import Iterable, Mapping
from typing import Any


def toml(value: Any) -> str:
    """A value as TOML: bool, int, float, str, or a list, tuple, array or mapping of such."""
    value = value.tolist() if hasattr(value, "tolist") else value
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(str(k))} = {toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(toml, value)) + "]"
    raise TypeError(f"set: expected bool, int, float, str, list or dict, got {type(value).__name__}")


def settings(of: Mapping[str, Any] | None) -> list[tuple[str, str]]:
    """Keys of a scene and their values as text; a str is passed as it is, as the command's."""
    if of is not None and not isinstance(of, Mapping):
        raise TypeError(f"set: expected a dict, got {type(of).__name__}")
    pairs = (of or {}).items()
    return [(str(key), v if isinstance(v, str) else toml(v)) for key, v in pairs]


def name(of: str | os.PathLike[str]) -> str:
    """A bundled name or a path as text."""
    text = os.fspath(of)
    if not isinstance(text, str):
        raise TypeError(f"expected a name or a path, got {type(of).__name__}")
    return text


def names(of: str | Iterable[str] | None) -> list[str]:
    """No name, one, or some."""
    if of is None:
        return []
    return [of] if isinstance(of, str) else list(of)


def count(key: str, value: Any, least: int = 0) -> int:
    """An integer that is not below a least one."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{key}: expected an int, got {type(value).__name__}") from None
    if number < least or number >= 1 << 63:
        from hapticore.errors import Error

        raise Error(f"{key}: expected {least} or more, got {number}")
    return number
