// SPDX-License-Identifier: MIT OR Apache-2.0
//! What `[sheet]` says, in SI units: sizes, resistances, and where the terminals are and what they are in series with.

use super::film::Film;
use crate::device::{Device, TERMINALS};
use crate::error::SceneError;
use crate::format::{Limits, Table};

/// Resistance in series with a terminal that is not connected, Ω.
pub(crate) const OPEN: f64 = f64::INFINITY;

/// What `[sheet]` says.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    pub size_m: [f64; 2],
    pub pad_radius_m: f64,
    pub film: Film,
    /// In series with each terminal, Ω; [`OPEN`] where it carries no current.
    pub terminal_ohm: [f64; TERMINALS],
    pub terminal_radius_m: f64,
    /// From the bottom left corner.
    pub terminals_m: [[f64; 2]; TERMINALS],
    /// Columns and rows of a table, where the scene says.
    pub table: [Option<usize>; 2],
}

impl Sheet {
    pub fn read(table: &Table, device: &Device) -> Result<Sheet, SceneError> {
        let size_m = [device.width_mm, device.height_mm].map(|mm| mm * 1e-3);
        let count = |key| Ok(table.whole(key, 8, 2048)?.map(|count| count as usize));
        let widest = Limits::above(0.0, device.pad_diameter_mm / 3.0); // a pad at the edge must not lie on a terminal
        Ok(Sheet {
            size_m,
            pad_radius_m: device.pad_diameter_mm * 0.5e-3,
            film: Film::read(table, size_m)?,
            terminal_ohm: series(table)?,
            terminal_radius_m: 1e-3 * table.number_or("terminal_radius_mm", widest, 1.7)?,
            terminals_m: terminals(table, device)?,
            table: [count("table_columns")?, count("table_rows")?],
        })
    }

    /// Millimetres from the middle to metres from the bottom left corner.
    pub fn place_m(&self, x_mm: f64, y_mm: f64) -> [f64; 2] {
        [self.size_m[0] / 2.0 + x_mm * 1e-3, self.size_m[1] / 2.0 + y_mm * 1e-3]
    }

    /// How far from the middle a pad's centre can be, mm.
    pub fn reach_mm(&self) -> [f64; 2] {
        self.size_m.map(|size| 1e3 * (size / 2.0 - self.pad_radius_m))
    }

    /// R·e^(−1/4): a disc of even current has, on average over itself, the potential of a ring of this radius.
    pub fn disc_m(&self) -> f64 {
        self.pad_radius_m * (-0.25f64).exp()
    }
}

/// Resistance in series with each terminal: `terminal_ohm`, none where shorted, infinite where open or not there.
fn series(table: &Table) -> Result<[f64; TERMINALS], SceneError> {
    let mut ohm = [table.number_or("terminal_ohm", Limits::NOT_NEGATIVE, 0.0)?; TERMINALS];
    let count = table.whole("terminals", 4, 6)?.unwrap_or(TERMINALS as u64) as usize;
    if count == 5 {
        return Err(table.error("terminals", "expected 4 or 6, got 5"));
    }
    ohm[count..].fill(OPEN);
    for (key, value) in [("shorted", 0.0), ("open", OPEN)] {
        for number in table.numbers(key, Limits::within(1.0, count as f64))?.unwrap_or_default() {
            if number.fract() != 0.0 {
                return Err(table.error(key, format!("expected numbers of terminals, 1 to {count}, got {number}")));
            }
            ohm[number as usize - 1] = value;
        }
    }
    match ohm.iter().any(|ohm| ohm.is_finite()) {
        true => Ok(ohm),
        false => Err(table.error("open", "expected a terminal that is not open, since the current has to leave")),
    }
}

/// Places from the bottom left corner, m: the corners, and both others where the scene has them.
fn terminals(table: &Table, device: &Device) -> Result<[[f64; 2]; TERMINALS], SceneError> {
    let half = [device.width_mm / 2.0, device.height_mm / 2.0];
    let [x, y] = half;
    let usual = match table.choice("middles", &["long", "short"])? {
        Some("short") => [[-x, 0.0], [x, 0.0]],
        _ => [[0.0, -y], [0.0, y]],
    };
    let fifth = edge_place(table, "terminal_5_mm", half)?.unwrap_or(usual[0]);
    let sixth = edge_place(table, "terminal_6_mm", half)?.unwrap_or(usual[1]);
    if fifth == sixth {
        return Err(table.error("terminal_6_mm", format!("expected a place other than terminal 5's, got {sixth:?}")));
    }
    let places_mm = [[-x, y], [-x, -y], [x, -y], [x, y], fifth, sixth];
    Ok(places_mm.map(|place| [0, 1].map(|axis| 1e-3 * (place[axis] + half[axis]))))
}

fn edge_place(table: &Table, key: &'static str, half: [f64; 2]) -> Result<Option<[f64; 2]>, SceneError> {
    let Some(place) = table.pair(key, Limits::ANY)? else { return Ok(None) };
    let at_rim = [0, 1].map(|axis| place[axis].abs() == half[axis]);
    let inside = [0, 1].map(|axis| place[axis].abs() < half[axis]);
    if (at_rim[0] && inside[1]) || (at_rim[1] && inside[0]) {
        return Ok(Some(place));
    }
    Err(table.error(
        key,
        format!(
            "expected a place on the sheet's edge between corners, x = ±{} or y = ±{}, got {place:?}",
            half[0], half[1]
        ),
    ))
}
