# SPDX-License-Identifier: MIT OR Apache-2.0
from collections.abc import Callable
from typing import final

import numpy as np
import numpy.typing as npt

__all__ = [
    "Link",
    "Page",
    "Rows",
    "Slots",
    "Stepped",
    "__version__",
    "calibrate",
    "profiles",
    "replay",
    "scenes",
    "simulate",
    "tradeoff",
]

__version__: str

def scenes() -> list[str]:
    """Names of the bundled scenes."""

def profiles() -> list[str]:
    """Names of the bundled profiles."""

def simulate(
    scene: str,
    *,
    set: list[tuple[str, str]],
    core: str,
    case: list[str],
    profile: str | None,
    errors: bool,
    unstable: bool,
) -> tuple[Rows, str]: ...
def replay(
    capture: str,
    *,
    calibration: str | None,
    profile: str | None,
    core: str,
    pads: int | None,
    channels: list[str] | None,
    bits: int | None,
    full_scale_v: float | None,
    skip: int,
    truncated: bool,
) -> tuple[Rows, str]: ...
def calibrate(data: list[str], *, profile: str) -> tuple[str, str]: ...
def tradeoff(
    scenes: list[str],
    *,
    profile: str | None,
    slots: int,
    target: tuple[float | None, float | None, float | None] | None,
    family: str | None,
    explain: bool,
) -> tuple[tuple[str, str, str | None], list[str]]: ...
@final
class Rows:
    def __len__(self) -> int: ...
    def names(self) -> list[str]: ...
    def plot(
        self, names: list[str], chosen: npt.NDArray[np.int64] | None
    ) -> tuple[list[str], str, str]: ...
    def column(self, name: str) -> npt.NDArray[np.generic] | tuple[npt.NDArray[np.int64], list[str]]: ...

@final
class Slots:
    def __new__(
        cls,
        scene: str | None,
        *,
        set: list[tuple[str, str]],
        profile: str | None,
        calibration: str | None,
        pads: int | None,
        core: str,
    ) -> Slots: ...
    @property
    def shape(self) -> tuple[int, int]: ...
    @property
    def pads(self) -> int: ...
    @property
    def codes(self) -> tuple[int, int]: ...
    @property
    def slot_s(self) -> float: ...
    def signals(self) -> list[str]: ...
    def trace(
        self, codes: npt.NDArray[np.int32], signals: list[str]
    ) -> dict[str, npt.NDArray[np.float64]]: ...
    def take(self, pads: npt.NDArray[np.int64], codes: npt.NDArray[np.int32]) -> Rows: ...

@final
class Stepped:
    def __new__(
        cls,
        scene: str,
        *,
        set: list[tuple[str, str]],
        core: str,
        case: str | None,
        profile: str | None,
    ) -> Stepped: ...
    def reset(self) -> None: ...
    def step(self, slots: int) -> Rows: ...
    def lead(self, pad: int, x_mm: float, y_mm: float, within_s: float) -> None: ...
    def release(self, pad: int) -> None: ...
    def press(self, pad: int, load_g: float) -> None: ...
    def push(self, pad: int, x_n: float, y_n: float) -> None: ...
    def target(self, pad: int, target_n: float) -> None: ...
    def serve(self) -> None: ...
    def wall(self, x_mm: float | None, y_mm: float | None, off: bool) -> None: ...
    def voltage(self, pad: int, v_rms: float) -> None: ...
    def codes(self) -> npt.NDArray[np.int32] | None: ...
    @property
    def slot(self) -> int: ...
    @property
    def time_s(self) -> float: ...
    @property
    def walls_mm(self) -> tuple[float | None, float | None]: ...
    @property
    def slot_s(self) -> float: ...
    @property
    def pads(self) -> list[str]: ...
    @property
    def parts_mm(self) -> list[tuple[float, float]]: ...
    @property
    def sheet_mm(self) -> tuple[float, float]: ...

@final
class Page:
    def __new__(
        cls,
        scene: str,
        *,
        set: list[tuple[str, str]],
        core: str,
        case: str | None,
        profile: str | None,
        port: int,
        speed: float,
    ) -> Page: ...
    @property
    def url(self) -> str: ...
    def close(self) -> None: ...

@final
class Link:
    def __new__(
        cls,
        port: str,
        *,
        set: list[tuple[str, str]],
        faults: list[str],
        calibration: str | None,
        profile: str | None,
        baud: int | None,
        control: str | None,
        dac: str | None,
        wave: str | None,
        full_scale_v: int | None,
        tuning: str | None,
        timeout_s: float,
    ) -> Link: ...
    def read(self, frames: int | None, seconds: float | None, timeout_s: float) -> Rows: ...
    def alive(self) -> None: ...
    def arm(self) -> None: ...
    def disarm(self) -> None: ...
    def target(self, pad: int, newtons: float) -> None: ...
    def wall(self, x_mm: float | None, y_mm: float | None, off: bool) -> None: ...
    def lead(self, pad: int, x_mm: float, y_mm: float, within_s: float) -> None: ...
    def check(self, ask: Callable[[str], object]) -> list[str]: ...
    def close(self) -> None: ...
    @property
    def phase(self) -> str: ...
    @property
    def identity(self) -> str | None: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def statistics(self) -> list[tuple[str, int]]: ...
    @property
    def title(self) -> str: ...
    @property
    def slot_s(self) -> float: ...
    @property
    def pads(self) -> list[str]: ...
    @property
    def parts_mm(self) -> list[tuple[float, float]]: ...
    @property
    def sheet_mm(self) -> tuple[float, float]: ...
