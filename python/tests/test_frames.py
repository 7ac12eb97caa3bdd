# SPDX-License-Identifier: MIT OR Apache-2.0
"""Frames as a mapping of arrays, and as tables of other packages."""

from __future__ import annotations

import json

import numpy as np
import pytest

import hapticore as hc


@pytest.fixture(scope="module")
def run() -> hc.Run:
    return hc.simulate("hockey", {"duration_s": 0.1})


def test_columns_are_arrays_of_one_length(run: hc.Run) -> None:
    frames = run.frames
    kinds = {"time_s": "f", "pad": "i", "flags": "U", "true_touching": "b", "case": "U"}
    assert {name: frames[name].dtype.kind for name in kinds} == kinds
    assert {frames[name].shape for name in frames} == {(frames.slots,)}
    assert not frames["x_mm"].flags.writeable
    assert frames["x_mm"] is frames["x_mm"]


def test_attributes_name_units_and_origin(run: hc.Run) -> None:
    attrs = run.frames.attrs
    assert attrs["units"]["force_n"] == "N"
    assert attrs["units"]["true_capacitance_pf"] == "pF"
    assert attrs["units"]["haptic_v_rms"] == "V"
    assert "flags" not in attrs["units"]
    assert (attrs["scene"], attrs["seed"], attrs["fidelity"]) == ("hockey", 11, "fixed")
    assert attrs["set"] == [["duration_s", "0.1"]]


def test_slots_can_be_chosen(run: hc.Run) -> None:
    puck = run.frames.where(pad=2)
    assert set(puck["pad"]) == {2}
    assert puck.slots == (run.frames["pad"] == 2).sum()
    assert puck.where(pad=1).slots == 0
    assert puck.where(pad=1)["flags"].shape == (0,)


def test_a_repr_names_slots_and_columns(run: hc.Run) -> None:
    assert repr(run.frames).startswith(f"Frames of {run.frames.slots} slots: time_s, pad, ")
    assert "summary" not in repr(run)


def test_no_slots_have_columns_of_length_zero() -> None:
    frames = hc.Display("hockey").step(0)
    assert (frames.slots, frames["x_mm"].shape, frames["flags"].shape) == (0, (0,), (0,))


def test_tables_hold_the_same_numbers(run: hc.Run) -> None:
    pandas = pytest.importorskip("pandas")
    polars = pytest.importorskip("polars")
    pyarrow = pytest.importorskip("pyarrow")
    frames = run.frames
    tables = [frames.to_pandas(), frames.to_polars(), frames.to_arrow()]
    assert isinstance(tables[0], pandas.DataFrame)
    assert isinstance(tables[1], polars.DataFrame)
    assert isinstance(tables[2], pyarrow.Table)
    for table in tables:
        assert np.asarray(table["force_n"]).tolist() == frames["force_n"].tolist()
        assert list(table["flags"].to_numpy()) == frames["flags"].tolist()
    assert tables[0].attrs["units"] == frames.attrs["units"]
    assert json.loads(tables[2].schema.metadata[b"hapticore"])["scene"] == "hockey"


def test_values_of_any_kind_can_be_set() -> None:
    settings = {
        "duration_s": np.float64(0.02),
        "pad.0.position_mm": (10, -5.5),
        "pad.1.position_mm": {"timeline": {"x_mm": [[0, 1], [0.01, 2]]}},
        "pad.2.load_g": np.int64(33),
        "sensor.haptic_leakage": False,
        "carrier.rung": "samples",
    }
    frames = hc.simulate("hockey", settings).frames
    assert set(frames.where(pad=2)["true_load_g"]) == {33.0}
    assert set(frames.where(pad=0)["true_y_mm"]) == {-5.5}
