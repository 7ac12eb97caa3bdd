// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[shunt]`: the capacitance between the sheet and the panel behind it, which takes a part of the
//! current and turns the terminals' phases: 9 nF/m² by −12°, 22 nF/m² by −28° (docs/physics.md §1).
//!
//! `panel_noise_mv` adds the panel's own voltage: see `panel`.
//!
//! | level | what | error | look-up | build |
//! | --- | --- | --- | --- | --- |
//! | `table` | the exact solution with a spline of its series, 32 × 19 | 3e-6 of the current | 0.8 µs | 40 ms |
//! | `series` | the exact solution, 100 modes | 3e-7 | 28 µs | – |
//!
//! The change against the sheet alone is added to what `[sheet]` says, at any of its levels; it is
//! that of a uniform film, so no other is accepted.

pub(crate) mod panel;
mod screen;
#[cfg(test)]
mod tests;

use num_complex::Complex64;

use screen::Screens;
pub(super) use screen::{Screened, Source};

use super::effect::{Effect, PadEffect};
use super::pad::Pad;
use super::sheet::analytic::Analytic;
use super::sheet::nodes::Values;
use super::sheet::spline::{AS_IT_IS, Axis, Spline};
use super::sheet::{Following, OfSheet, Sheet, Solver, Split};
use super::spec::{Level, Rung, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::{Key, Limits, Table, keys};
use crate::terminals::PerTerminal;

/// The levels as a scene writes them.
const WORDS: [&str; 2] = ["table", "series"];

keys! { KEYS:
    /// How the exact solution is evaluated: by a spline of its series, or by the series.
    RUNG: Option<&'static str> = Rung::choice("rung", || WORDS.to_vec()).usually("table");
    /// Capacitance from the sheet to the panel behind it.
    NANOFARAD_PER_M2: f64 = Key::number("nanofarad_per_m2", Limits::within(0.0, 1e4)).required("a number from 0 to 10000");
}

/// Columns and rows of the table.
const NODES: [usize; 2] = [32, 19];

pub(super) fn read(root: &Table, device: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(sheet) = screened(root, device)? else { return Ok(None) };
    let level = |word, cost_ns, nodes| {
        let (sheet, siemens_per_m2) = sheet.clone();
        let reach_mm = sheet.reach_mm();
        let screening =
            OfSheet::new(sheet, move |sheet| Screening::new(sheet, siemens_per_m2, nodes));
        Level::new(word, cost_ns, move |_| {
            Effect::Pad(Box::new(Shunt { screening: Following::new(&screening), reach_mm }))
        })
    };
    let levels = vec![level(WORDS[0], 1.0e3, Some(NODES)), level(WORDS[1], 2.8e4, None)];
    Spec::with_levels("shunt", root.table("shunt")?, &RUNG, levels, "table")
}

/// Below this a capacitance is none, nF/m²: it turns no current by 1e-5°, and its waves would be too long for numbers.
const LEAST_NANOFARAD: f64 = 1e-6;

/// The sheet and ωc, S/m², where there is a shunt: a capacitance of zero is none.
pub(super) fn screened(root: &Table, device: &Device) -> Result<Option<(Sheet, f64)>, SceneError> {
    let Some(table) = root.table("shunt")? else { return Ok(None) };
    let nanofarad = table.get(&NANOFARAD_PER_M2)?;
    let Some(sheet) = root.table("sheet")? else {
        return Err(table
            .error("", "expected a [sheet] too, since that is what the capacitance lies across"));
    };
    if nanofarad < LEAST_NANOFARAD {
        table.get(&RUNG)?;
        return Ok(None);
    }
    let sheet = Sheet::read(sheet, device)?;
    match sheet.film.is_uniform() {
        true => Ok(Some((sheet, 1e-9 * nanofarad * device.carrier_rad_s))),
        false => {
            Err(table
                .error("", "expected a uniform film, without sheet.slope_percent and sheet.patch"))
        }
    }
}

struct Shunt {
    screening: Following<Screening>,
    reach_mm: [f64; 2],
}

/// What a shunt does on one sheet.
struct Screening {
    with: Screened,
    without: Analytic,
    table: Option<Spline>,
}

impl Screening {
    /// With a table of `nodes` columns and rows, or none.
    fn new(sheet: &Sheet, siemens_per_m2: f64, nodes: Option<[usize; 2]>) -> Self {
        let (with, reach_mm) = (Screened::new(sheet, siemens_per_m2), sheet.reach_mm());
        let table = nodes.map(|nodes| {
            let axes = [0, 1].map(|axis| Axis::symmetric(reach_mm[axis], nodes[axis]));
            Spline::of(axes, 2 * (sheet.terminals() + 1), AS_IT_IS, |&x, &y| {
                node(&with.screens(x, y))
            })
        });
        Screening { with, without: Analytic::new(sheet), table }
    }

    /// What the shunt changes of the shares and of the impedance.
    fn change(&self, x_mm: f64, y_mm: f64) -> (PerTerminal<Complex64>, Complex64) {
        let screens = match &self.table {
            Some(table) => screens(&table.at(x_mm, y_mm)),
            None => self.with.screens(x_mm, y_mm),
        };
        let source = self.with.source_of(x_mm, y_mm, &screens);
        let Split { share, ohm } = self.without.split(x_mm, y_mm);
        let change = source.share.iter().zip(share).map(|(with, without)| with - without).collect();
        (change, self.with.own(&source, &screens) - ohm)
    }
}

impl PadEffect for Shunt {
    fn act(&mut self, pad: &mut Pad) {
        let [x, y] = self.reach_mm;
        let screening = self.screening.at(pad.film);
        let (shares, ohm) = screening.change(pad.x_mm.clamp(-x, x), pad.y_mm.clamp(-y, y));
        pad.split.iter_mut().zip(shares).for_each(|(share, change)| *share += change);
        pad.sheet_ohm += ohm;
    }
}

/// Real parts of the functions D, then imaginary ones.
fn node(screens: &Screens) -> Values {
    screens.iter().map(|screen| screen.re).chain(screens.iter().map(|screen| screen.im)).collect()
}

fn screens(node: &Values) -> Screens {
    let (re, im) = node.split_at(node.len() / 2);
    re.iter().zip(im).map(|(re, im)| Complex64::new(*re, *im)).collect()
}
