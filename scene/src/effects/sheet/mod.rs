// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[sheet]`: how the resistive sheet splits a pad's current among the terminals, and its
//! resistance R_p at the pad.
//!
//! Three to sixteen terminals are where `terminals_mm` says. Without it terminals 1 to 4 are the
//! corners top left, bottom left, bottom right, top right (the signs of eqs. 2 and 3). Terminals 5
//! and 6 are the middles of the bottom and the top edge, of the left and the right one with
//! `middles = "short"`, or where `terminal_5_mm` and `terminal_6_mm` say. `terminals = 4` leaves
//! both away. Each is a patch of radius `terminal_radius_mm` behind `terminal_ohm`, a number or a
//! list of one for each; those listed in `shorted` have no resistance, those in `open` no current.
//! The radius is not the paper's: 1.7 mm gives the R_p of docs/physics.md §1, 73 to 190 Ω, mean 143
//! Ω, for pads 20 mm off the edges.
//!
//! | level | what | look-up | error of the split, rms / max | build |
//! | --- | --- | --- | --- | --- |
//! | `distance` | R_i ∝ distance, the paper's picture | 50 ns | 5.0e-2 / 2.5e-1 | – |
//! | `bilinear` | table of the analytic solution, 64 × 37 | 20 ns | 5.4e-5 / 2.4e-3 | 0.8 ms |
//! | `bicubic` | spline of the same, 128 × 75 | 40 ns | 7e-7 / 6e-5 | 4 ms |
//! | `bicubic-fine` | 512 × 297 | 70 ns | 5e-9 / 1e-6 | 90 ms |
//! | `analytic` | Neumann function of the rectangle | 360 ns | 5e-11 max | – |
//! | `grid-20-mm` | finite differences | 60 ns | 2.8e-4 / 7e-3 | 12 ms |
//! | `grid-10-mm` | | 70 ns | 6.9e-5 / 3.9e-3 | 20 ms |
//! | `grid-5-mm` | | 90 ns | 1.7e-5 / 1.0e-3 | 70 ms |
//! | `grid-2.5-mm` | | 100 ns | 3.9e-6 / 1.9e-4 | 0.25 s |
//! | `grid-1.25-mm` | | 170 ns | 9.7e-7 / 4.7e-5 | 1.1 s |
//!
//! A table may have `table_columns` × `table_rows` of its own. Grids are the only levels for a
//! non-uniform film; patches of the film make them take up to four times as long to build. Errors are over pads 20 mm off the edges; at the edges, in front of terminals
//! 5 and 6, the table's reach 2e-4.
//!
//! Without the table the sheet is ideal: no resistance, and corner currents that are bilinear in
//! the position.

pub(crate) mod analytic;
mod disc;
mod distance;
mod factor;
pub(crate) mod film;
mod following;
pub(crate) mod geometry;
mod grid;
pub(crate) mod ideal;
mod lattice;
mod lines;
pub(super) mod mesh;
pub(super) mod network;
pub(super) mod nodes;
mod own;
pub(crate) mod spline;
mod split;
mod table;

pub(super) use following::{Following, OfSheet};
pub(super) use geometry::Sheet;
pub(super) use hapticore_sheet::{linear, neumann};
pub(crate) use split::{Solver, Split};

use num_complex::Complex64;

use mesh::Mesh;

use super::effect::{Effect, PadEffect};
use super::pad::Pad;
use super::spec::{Level, Rung, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::{Table, keys};

/// Levels of a uniform sheet, and what a look-up costs with its share of the build, ns.
const UNIFORM_LEVELS: [(&str, f64); 5] = [
    ("distance", 70.0),
    ("bilinear", 30.0),
    ("bicubic", 100.0),
    ("bicubic-fine", 660.0),
    ("analytic", 400.0),
];

/// Levels of any sheet: their spacing in mm, and what a look-up costs with its share of the build,
/// ns.
const GRID_LEVELS: [(&str, f64, f64); 5] = [
    ("grid-20-mm", 20.0, 120.0),
    ("grid-10-mm", 10.0, 400.0),
    ("grid-5-mm", 5.0, 650.0),
    ("grid-2.5-mm", 2.5, 1.3e3),
    ("grid-1.25-mm", 1.25, 5.7e3),
];

/// The most nodes of a grid: its factors take a kilobyte each.
const MOST_NODES: usize = 600_000;

/// The level where a scene names none, on a sheet that is not too large for it.
const USUAL_MM: f64 = 5.0;

keys! { KEYS:
    /// How the sheet splits a current: by distances, by tables of the analytic solution, by the solution itself, or by finite
    /// differences of a spacing, which alone take a film that is not uniform.
    RUNG: Option<&'static str> = Rung::choice("rung", || words(true)).usually("bicubic; of a film that is not uniform grid-5-mm");
}

/// The words of `rung`, for a film that is uniform or not.
fn words(uniform: bool) -> Vec<&'static str> {
    let exact = UNIFORM_LEVELS.iter().filter(|_| uniform).map(|level| level.0);
    exact.chain(GRID_LEVELS.map(|level| level.0)).collect()
}

pub(super) fn read(root: &Table, device: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("sheet")? else { return Ok(None) };
    let sheet = Sheet::read(table, device)?;
    let uniform = sheet.film.is_uniform();
    let word = table.choice(RUNG.about.name, &words(uniform))?;
    if !uniform || word.is_some_and(|word| word.starts_with("grid")) {
        let grids = grids(table, &sheet, word)?;
        let usual = grids.iter().rev().find(|(_, mm, _)| *mm >= USUAL_MM).unwrap_or(&grids[0]).0;
        let levels = grids.iter().map(|&(word, mm, cost_ns)| {
            level(&sheet, word, cost_ns, move |sheet| grid(sheet, mm)).slow_to_build()
        });
        Spec::with_levels("sheet", Some(table), &RUNG, levels.collect(), usual)
    } else {
        let levels = UNIFORM_LEVELS.map(|(word, cost_ns)| {
            level(&sheet, word, cost_ns, move |sheet| exact_or_table(word, sheet))
                .against("analytic")
        });
        Spec::with_levels("sheet", Some(table), &RUNG, levels.into(), "bicubic")
    }
}

/// The levels whose grid over the sheet has few enough nodes: the coarsest always has.
fn grids(
    table: &Table,
    sheet: &Sheet,
    word: Option<&str>,
) -> Result<Vec<(&'static str, f64, f64)>, SceneError> {
    let nodes = |mm: f64| Mesh::new(sheet.size_m, 1e-3 * mm).nodes();
    let (fit, large): (Vec<_>, Vec<_>) =
        GRID_LEVELS.into_iter().partition(|(_, mm, _)| nodes(*mm) <= MOST_NODES);
    match large.iter().find(|(level, ..)| Some(*level) == word) {
        Some((_, mm, _)) => Err(table.error(
            "rung",
            format!(
                "expected a grid of at most {MOST_NODES} nodes, a coarser one, got {}",
                nodes(*mm)
            ),
        )),
        None => Ok(fit),
    }
}

fn level(
    sheet: &Sheet,
    word: &'static str,
    cost_ns: f64,
    build: impl Fn(&Sheet) -> AnySolver + Send + Sync + 'static,
) -> Level {
    let sheet = sheet.clone();
    let label = match table_of(word) {
        Some([columns, rows]) => {
            format!(
                "{word} {} × {}",
                sheet.table[0].unwrap_or(columns),
                sheet.table[1].unwrap_or(rows)
            )
        }
        None => word.to_string(),
    };
    let reach_mm = sheet.reach_mm();
    let solver = OfSheet::new(sheet, build);
    Level::new(word, cost_ns, move |_| {
        Effect::Pad(Box::new(OnSheet { solver: Following::new(&solver), reach_mm }))
    })
    .labelled(label)
}

/// Columns and rows of a level that is a table of the analytic solution.
fn table_of(word: &str) -> Option<[usize; 2]> {
    match word {
        "bilinear" => Some([64, 37]),
        "bicubic" => Some([128, 75]),
        "bicubic-fine" => Some([512, 297]),
        _ => None,
    }
}

fn exact_or_table(word: &str, sheet: &Sheet) -> AnySolver {
    match (word, table_of(word)) {
        ("bilinear", Some(nodes)) => Box::new(table::Bilinear::new(sheet, nodes)),
        (_, Some(nodes)) => Box::new(table::Bicubic::new(sheet, nodes)),
        ("distance", None) => Box::new(distance::Distance::new(sheet)),
        (_, None) => Box::new(analytic::Analytic::new(sheet)),
    }
}

fn grid(sheet: &Sheet, spacing_mm: f64) -> AnySolver {
    Box::new(grid::Grid::new(sheet, spacing_mm * 1e-3))
}

/// A solver at one of the levels, as plants share it.
type AnySolver = Box<dyn Solver + Sync>;

struct OnSheet {
    solver: Following<AnySolver>,
    reach_mm: [f64; 2],
}

impl PadEffect for OnSheet {
    fn act(&mut self, pad: &mut Pad) {
        let [x, y] = self.reach_mm;
        let split = self.solver.at(pad.film).split(pad.x_mm.clamp(-x, x), pad.y_mm.clamp(-y, y));
        pad.split = split.share.map(Complex64::from);
        pad.sheet_ohm = split.ohm.into();
    }
}

#[cfg(test)]
mod device_tests;
#[cfg(test)]
mod grid_tests;
#[cfg(test)]
mod stripes;
#[cfg(test)]
mod terminal_tests;
#[cfg(test)]
pub(crate) mod tests;
