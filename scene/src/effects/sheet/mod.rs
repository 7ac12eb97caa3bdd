// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[sheet]`: how the resistive sheet splits a pad's current among the terminals, and its resistance R_p at the pad.
//!
//! Terminals 1 to 4 are the corners top left, bottom left, bottom right, top right (the signs of eqs. 2 and 3); 5 and 6 are
//! the middles of the bottom and the top edge, or where `terminal_5_mm` and `terminal_6_mm` say. Each is a patch of radius
//! `terminal_radius_mm` behind `terminal_ohm`. The radius is not the paper's: 1.7 mm gives the R_p of PHYSICS §1, 73 to
//! 190 Ω, mean 143 Ω, for pads 20 mm off the edges.
//!
//! | rung | what | look-up | error of the split, rms / max | build |
//! | --- | --- | --- | --- | --- |
//! | `distance` | R_i ∝ distance, the paper's picture | 70 ns | 5.0e-2 / 2.5e-1 | – |
//! | `bicubic` | table of the analytic solution, `table_columns` × `table_rows` = 128 × 75 | 60 ns | 7e-7 / 6e-5 | 4.5 ms |
//! | `analytic` | Neumann function of the rectangle | 400 ns | 5e-11 max | – |
//!
//! Errors are over pads 20 mm off the edges; at the edges, in front of terminals 5 and 6, the table's reach 2e-4.
//!
//! Without the table the sheet is ideal: no resistance, and corner currents that are bilinear in the position.

mod analytic;
mod bicubic;
mod distance;
mod neumann;

use super::{Effect, Pad, PadEffect, Rung, Spec};
use crate::device::{Device, TERMINALS};
use crate::error::SceneError;
use crate::format::{Limits, Table};

/// The sheet as a pad at one place sees it.
#[derive(Clone, Copy, Debug)]
struct Split {
    share: [f64; TERMINALS],
    ohm: f64,
}

/// One way to get the split at a place, x and y in mm from the centre.
trait Solver: Send {
    fn split(&self, x_mm: f64, y_mm: f64) -> Split;
}

/// What `[sheet]` says, in SI units.
#[derive(Clone, Debug)]
struct Sheet {
    size_m: [f64; 2],
    pad_radius_m: f64,
    ohm_per_square: f64,
    terminal_ohm: f64,
    terminal_radius_m: f64,
    /// From the bottom left corner.
    terminals_m: [[f64; 2]; TERMINALS],
    /// Columns and rows of the bicubic table.
    table: [usize; 2],
}

pub(super) fn read(root: &Table, device: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("sheet")? else { return Ok(None) };
    let sheet = read_sheet(table, device)?;
    let rung = |(word, cost_ns): (&'static str, f64)| {
        let sheet = sheet.clone();
        Rung::new(word, cost_ns, move |_| Effect::Pad(Box::new(OnSheet { solver: build(word, &sheet) })))
    };
    let [columns, rows] = sheet.table;
    let [distance, bicubic, analytic] = [("distance", 70.0), ("bicubic", 60.0), ("analytic", 400.0)].map(rung);
    let bicubic = bicubic.labelled(format!("bicubic {columns} × {rows}"));
    Spec::ladder("sheet", Some(table), vec![distance, bicubic, analytic], "bicubic")
}

fn read_sheet(table: &Table, device: &Device) -> Result<Sheet, SceneError> {
    let size_m = [device.width_mm, device.height_mm].map(|mm| mm * 1e-3);
    let count = |key, default| Ok(table.whole(key, 8, 2048)?.unwrap_or(default) as usize);
    let widest = Limits::above(0.0, device.pad_diameter_mm / 3.0); // a pad at the edge must not lie on a terminal
    Ok(Sheet {
        size_m,
        pad_radius_m: device.pad_diameter_mm * 0.5e-3,
        ohm_per_square: table.number_or("ohm_per_square", Limits::POSITIVE, 150.0)?,
        terminal_ohm: table.number_or("terminal_ohm", Limits::NOT_NEGATIVE, 0.0)?,
        terminal_radius_m: 1e-3 * table.number_or("terminal_radius_mm", widest, 1.7)?,
        terminals_m: terminals(table, device)?,
        table: [count("table_columns", 128)?, count("table_rows", 75)?],
    })
}

/// Places from the bottom left corner, m: the corners, and both others where the scene has them.
fn terminals(table: &Table, device: &Device) -> Result<[[f64; 2]; TERMINALS], SceneError> {
    let half = [device.width_mm / 2.0, device.height_mm / 2.0];
    let [x, y] = half;
    let fifth = edge_place(table, "terminal_5_mm", half)?.unwrap_or([0.0, -y]);
    let sixth = edge_place(table, "terminal_6_mm", half)?.unwrap_or([0.0, y]);
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

fn build(rung: &str, sheet: &Sheet) -> Box<dyn Solver> {
    match rung {
        "distance" => Box::new(distance::Distance::new(sheet)),
        "bicubic" => Box::new(bicubic::Bicubic::new(sheet)),
        _ => Box::new(analytic::Analytic::new(sheet)),
    }
}

struct OnSheet {
    solver: Box<dyn Solver>,
}

impl PadEffect for OnSheet {
    fn act(&mut self, pad: &mut Pad) {
        let split = self.solver.split(pad.x_mm, pad.y_mm);
        pad.split = split.share;
        pad.sheet_ohm = split.ohm;
    }
}

/// The split of an ideal sheet: corner currents bilinear in the position, so that r_x and r_y are proportional to x and y.
pub(crate) fn ideal_split(x_mm: f64, y_mm: f64, device: &Device) -> [f64; TERMINALS] {
    let (u, v) = (x_mm / device.width_mm + 0.5, y_mm / device.height_mm + 0.5);
    [(1.0 - u) * v, (1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, 0.0, 0.0]
}

#[cfg(test)]
mod tests;
