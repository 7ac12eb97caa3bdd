# SPDX-License-Identifier: MIT OR Apache-2.0
"""Plots are those of the command's report, as SVG that every program can read."""

from __future__ import annotations

import re
import xml.etree.ElementTree as xml
from collections.abc import Callable
from pathlib import Path

import pytest

import hapticore as hc

SVG = "{http://www.w3.org/2000/svg}"


def lines(text: str) -> list[str]:
    """What a drawing consists of."""
    return re.findall(r"<(?:polyline|circle|polygon) [^>]*/>", text)


def test_a_run_is_drawn_as_in_the_commands_report(
    command: Callable[..., str], tmp_path: Path
) -> None:
    command("simulate", "fig6", "--out", tmp_path)
    report = (tmp_path / "report.html").read_text(encoding="utf-8")
    plot = hc.simulate("fig6").plot()
    assert len(plot.titles) >= 5
    drawn = [line for line in lines(plot.svg) if "stroke-width=\"1.6\"" not in line]
    assert len(drawn) > 50
    of_report = set(lines(report))
    assert all(line in of_report for line in drawn)
    for title in plot.titles:
        assert f"<figcaption>{title}</figcaption>" in report


def test_columns_are_drawn_over_time() -> None:
    frames = hc.simulate("hockey", {"duration_s": 0.2}).frames
    plot = frames.plot("force_n", "true_load_g")
    assert plot.titles == ["Haptic force", "true_load_g"]
    assert repr(plot) == "Plot of Haptic force, true_load_g"
    root = xml.fromstring(plot._repr_svg_())
    assert root.tag == f"{SVG}svg"
    texts = {"".join(text.itertext()).strip() for text in root.iter(f"{SVG}text")}
    assert {"Haptic force", "true value", "time (s)", "F (N)"} <= texts
    of_one = frames.where(pad=2).plot("force_n")
    assert 0 < len(lines(of_one.svg)) < len(lines(frames.plot("force_n").svg))


def test_frames_of_a_display_and_of_a_core_are_drawn() -> None:
    display, core = hc.Display("hockey"), hc.Core("hockey")
    frames = display.step(40)
    assert frames.plot("x_mm").titles == ["Position along x"]
    assert "true value" in frames.plot("x_mm").svg
    taken = core.slots([0], display.codes()[None])
    assert "true value" not in taken.plot("x_mm").svg


def test_a_file_is_for_print(tmp_path: Path) -> None:
    path = tmp_path / "force.svg"
    frames = hc.Display("hockey").step(40)
    frames.plot("force_n").save(path)
    text = path.read_text(encoding="utf-8")
    xml.fromstring(text)
    assert "var(" not in text and "@media" not in text and "#2654bc" in text
    with pytest.raises(hc.Error, match=r"NAME\.svg"):
        frames.plot("force_n").save(tmp_path / "force.png")


def test_what_cannot_be_drawn_is_an_error() -> None:
    frames = hc.Display("hockey").step(8)
    with pytest.raises(hc.Error, match="name of a column"):
        frames.plot()
    with pytest.raises(hc.Error, match="flags: expected a column of numbers"):
        frames.plot("flags")
    with pytest.raises(KeyError):
        frames.plot("x_cm")
    with pytest.raises(hc.Error, match="slots, got none"):
        frames.where(pad=99).plot("x_mm")
