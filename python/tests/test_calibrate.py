# SPDX-License-Identifier: MIT OR Apache-2.0
"""A lab's data make the calibration of the command, with which a core measures."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import hapticore as hc

HZ, VOLTS, FARADS = 101e3, 5.0, 500e-12
WIDTH_MM, HEIGHT_MM = 400.0, 300.0
FORCE_K = 1.8e13


@pytest.fixture
def lab(tmp_path: Path) -> list[Path]:
    """Files of a device with four terminals at its corners, whose shares are bilinear."""
    current = 2 * math.pi * HZ * FARADS * VOLTS
    rows = ["x_mm,y_mm,v_sense,i1,i2,i3,i4"]
    for x_mm in np.linspace(-150, 150, 13):
        for y_mm in np.linspace(-100, 100, 9):
            u, v = 2 * x_mm / WIDTH_MM, 2 * y_mm / HEIGHT_MM
            shares = [(1 + sx * u) * (1 + sy * v) / 4 for sx, sy in ((-1, -1), (1, -1), (-1, 1), (1, 1))]
            numbers = [x_mm, y_mm, VOLTS, *(current * share for share in shares)]
            rows.append(",".join(f"{number:.9g}" for number in numbers))
    places = tmp_path / "places.csv"
    places.write_text("\n".join(rows) + "\n")
    rows = ["haptic_v_rms,force_n,capacitance_pf"]
    rows += [f"{v},{FORCE_K * (FARADS * v) ** 2:.9g},{FARADS * 1e12}" for v in range(0, 350, 25)]
    loads = tmp_path / "loads.csv"
    loads.write_text("\n".join(rows) + "\n")
    setup = tmp_path / "device.toml"
    setup.write_text(
        "pads = 2\nsample_rate_hz = 1e6\ncarrier_hz = 101e3\ncurrent_full_scale_a = 0.004\n"
        "sense_full_scale_v = 8\nhaptic_full_scale_v = 500\n"
        "[terminals]\nx = [-1, 1, -1, 1]\ny = [-1, -1, 1, 1]\n"
    )
    return [places, loads, setup]


def test_a_labs_data_make_the_calibration_of_the_command(
    lab: list[Path], command: Callable[..., str], tmp_path: Path
) -> None:
    calibration = hc.calibrate(*lab)
    command("calibrate", *lab, "--out", tmp_path / "command.toml")
    lines = (tmp_path / "command.toml").read_text().splitlines()
    body = [line for line in lines if not line.startswith("# ")]
    ours = [line for line in calibration.text.splitlines() if not line.startswith("# ")]
    assert ours == body
    assert calibration.outcome["force"]["force_k"]["value"] == pytest.approx(FORCE_K, rel=1e-3)
    assert any("resistance" in warning for warning in calibration.warnings)


def test_a_core_measures_with_a_labs_calibration(lab: list[Path], tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    hc.calibrate(*lab).write(path)
    core = hc.Core(calibration=path)
    window, channels = core.shape
    assert (core.pads, channels) == (2, 6)
    # A pad at (60, -45) mm: currents a quarter turn ahead of the sensing voltage.
    phase = 2 * math.pi * HZ / 1e6 * np.arange(window)
    u, v = 120 / WIDTH_MM, -90 / HEIGHT_MM
    current = 2 * math.pi * HZ * FARADS * VOLTS / 0.004
    shares = [(1 + sx * u) * (1 + sy * v) / 4 for sx, sy in ((-1, -1), (1, -1), (-1, 1), (1, 1))]
    waves = [share * current * -np.sin(phase) for share in shares]
    waves += [VOLTS / 8 * np.cos(phase), np.zeros(window)]
    codes = np.rint(np.array(waves).T * (core.codes[1] + 1)).astype(np.int32)
    measured = core.slot(1, codes)
    assert (measured.x_mm, measured.y_mm) == pytest.approx((60, -45), abs=0.5)
    assert measured.capacitance_pf == pytest.approx(500, rel=0.02)
    assert measured.force_n == 0
    assert "invalid" not in measured.flags


def test_data_without_a_setup_are_refused(lab: list[Path]) -> None:
    with pytest.raises(hc.Error, match="setup"):
        hc.calibrate(*lab[:2])
