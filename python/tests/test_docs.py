# SPDX-License-Identifier: MIT OR Apache-2.0
"""Stubs, docstrings, the README's example and the notebooks are as the package is."""

from __future__ import annotations

import doctest
import importlib
import inspect
import re
import runpy
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import hapticore as hc

PYTHON = Path(__file__).resolve().parents[1]
CONFIG = str(PYTHON / "pyproject.toml")
MODULES = [
    "", ".board", ".core", ".display", ".errors", ".frames", ".gym", ".page", ".plots", ".runs", ".tradeoffs", ".zoo",
]  # fmt: skip


def test_stubs_are_those_of_the_module() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "hapticore._core", "--mypy-config-file", CONFIG],
        capture_output=True,
        text=True,
        cwd=PYTHON / "tests",
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_types_are_strict() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--config-file", CONFIG, "-p", "hapticore"],
        capture_output=True,
        text=True,
        cwd=PYTHON / "tests",
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("module", MODULES)
def test_examples_give_what_they_show(module: str) -> None:
    if module in (".gym", ".zoo"):
        pytest.importorskip({".gym": "gymnasium", ".zoo": "pettingzoo"}[module])
    result = doctest.testmod(importlib.import_module(f"hapticore{module}"))
    assert result.failed == 0


def public() -> Iterator[tuple[str, Callable[..., Any]]]:
    """Functions and methods of the package that a user calls, by their names."""
    for name in hc.__all__:
        of = getattr(hc, name)
        if inspect.isclass(of) and of.__module__.startswith("hapticore"):
            yield name, of
            for key, method in vars(of).items():
                if inspect.isfunction(method) and not key.startswith("_"):
                    yield f"{name}.{key}", method
        elif inspect.isfunction(of):
            yield name, of


@pytest.mark.parametrize(("name", "of"), list(public()))
def test_a_docstring_names_parameters_and_errors(name: str, of: Callable[..., Any]) -> None:
    text = inspect.getdoc(of) or ""
    assert text, name
    if inspect.isclass(of):
        return
    for parameter in set(inspect.signature(of).parameters) - {"self"}:
        assert re.search(rf"\b{parameter}\b", text), (name, parameter)
    if name not in ("Live.close", "Display.reset", "Board.close"):
        assert "Raises\n------" in text, name


def test_the_readmes_example_gives_figure_6(capsys: pytest.CaptureFixture[str]) -> None:
    readme = (PYTHON / "README.md").read_text(encoding="utf-8")
    (code,) = re.findall(r"```python\n(.*?)```", readme, re.S)[:1]
    assert len(code.strip().splitlines()) == 5
    exec(compile(code, "README.md", "exec"), {})
    printed = capsys.readouterr().out.strip()
    shown = re.findall(r"```text\n(.*?)```", readme, re.S)[0].strip()
    assert printed == shown


def test_the_readmes_other_examples_print_what_they_show(capsys: pytest.CaptureFixture[str]) -> None:
    readme = (PYTHON / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```\n+```text\n(.*?)```", readme, re.S)[1:]
    assert blocks
    for code, shown in blocks:
        exec(compile(code, "README.md", "exec"), {})
        assert capsys.readouterr().out.strip() == shown.strip()


@pytest.mark.parametrize("notebook", sorted((PYTHON / "notebooks").glob("*.py")), ids=lambda path: path.stem)
def test_a_notebook_runs(
    notebook: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if notebook.stem.startswith("5"):
        pytest.importorskip("gymnasium")
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("HAPTICORE_LONG", raising=False)
    found = runpy.run_path(str(notebook))
    # Each ends with what it shows.
    assert found["shown"] is True
