# SPDX-License-Identifier: MIT OR Apache-2.0
"""What the tests share: the option --full, and the command that results are compared with."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--full", action="store_true", help="run long tests, too")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if config.getoption("--full"):
        return
    for item in items:
        if "full" in item.keywords:
            item.add_marker(pytest.mark.skip(reason="long: --full runs it"))


@pytest.fixture(scope="session")
def command() -> Callable[..., str]:
    """Runs the command ``hapticore`` with arguments; its standard output.

    The environment's HAPTICORE names it, otherwise that of a release build is taken.
    """
    found = Path(os.environ.get("HAPTICORE") or ROOT / "target" / "release" / "hapticore")
    if not found.is_file():
        if os.environ.get("CI") == "true":
            pytest.fail(f"{found}: expected the command; HAPTICORE names it")
        pytest.skip(f"{found} is not there: cargo build --release")

    def run(*words: str | Path) -> str:
        done = subprocess.run([found, *words], capture_output=True, text=True)
        # Status 1: a criterion does not hold, as of a shortened scene.
        assert done.returncode in (0, 1), done.stderr
        return done.stdout

    return run


@pytest.fixture
def heard() -> Iterator[None]:
    """Ctrl-C is heard: a shell's background job ignores it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)
