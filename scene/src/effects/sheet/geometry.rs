// SPDX-License-Identifier: MIT OR Apache-2.0
//! What `[sheet]` says, in SI units: sizes, resistances, and where the terminals are and what they
//! are in series with.

use super::film::Film;
use crate::device::Device;
use crate::effects::pad::FilmChange;
use crate::error::SceneError;
use crate::format::{Key, Limits, Node, Table, Value, keys};

pub(crate) use hapticore_sheet::uniform::OPEN;

keys! { KEYS:
    /// Resistance in series with each terminal: a number, or a list of one for each.
    TERMINAL_OHM: Option<Vec<f64>> = Key::one_or_several("terminal_ohm", Limits::within(0.0, 1e9)).usually("0");
    /// Terminals without a resistance, by their numbers from 1.
    SHORTED: Option<Vec<f64>> = Key::numbers("shorted", Limits::within(1.0, 16.0));
    /// Terminals without a current, by their numbers from 1.
    OPEN_TERMINALS: Option<Vec<f64>> = Key::numbers("open", Limits::within(1.0, 16.0));
    /// Radius of the terminals, at most a third of the pad's diameter.
    TERMINAL_RADIUS_MM: f64 = Key::number("terminal_radius_mm", Limits::within(1e-3, 3.4e3)).or(1.7);
    /// Columns of the levels that are tables.
    TABLE_COLUMNS: Option<u64> = Key::whole("table_columns", 8, 2048).usually("the level's");
    /// Rows of the levels that are tables.
    TABLE_ROWS: Option<u64> = Key::whole("table_rows", 8, 2048).usually("the level's");
}

/// What `[sheet]` says.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    pub size_m: [f64; 2],
    pub pad_radius_m: f64,
    pub film: Film,
    /// In series with each terminal, Ω; [`OPEN`] where it carries no current.
    pub terminal_ohm: Vec<f64>,
    pub terminal_radius_m: f64,
    /// From the bottom left corner.
    pub terminals_m: Vec<[f64; 2]>,
    /// Columns and rows of a table, where the scene says.
    pub table: [Option<usize>; 2],
}

impl Sheet {
    pub fn read(table: &Table, device: &Device) -> Result<Sheet, SceneError> {
        let size_m = [device.width_mm, device.height_mm].map(|mm| mm * 1e-3);
        let widest = Limits::within(1e-3, device.pad_diameter_mm / 3.0); // a pad at the edge must not lie on a terminal
        Ok(Sheet {
            size_m,
            pad_radius_m: device.pad_diameter_mm * 0.5e-3,
            film: Film::read(table, size_m)?,
            terminal_ohm: series(table, device.terminals())?,
            terminal_radius_m: 1e-3 * table.get(&TERMINAL_RADIUS_MM.within(widest))?,
            terminals_m: terminals_m(device),
            table: [table.get(&TABLE_COLUMNS)?, table.get(&TABLE_ROWS)?]
                .map(|count| count.map(|count| count as usize)),
        })
    }

    /// The same sheet after a change of its film.
    pub fn changed(&self, film: FilmChange) -> Sheet {
        Sheet { film: self.film.changed(film, self.size_m), ..self.clone() }
    }

    pub fn terminals(&self) -> usize {
        self.terminals_m.len()
    }

    /// Millimetres from the middle to metres from the bottom left corner.
    pub fn place_m(&self, x_mm: f64, y_mm: f64) -> [f64; 2] {
        [self.size_m[0] / 2.0 + x_mm * 1e-3, self.size_m[1] / 2.0 + y_mm * 1e-3]
    }

    /// Where patches of the film begin and end along an axis, mm from the middle.
    pub fn breaks_mm(&self, axis: usize) -> Vec<f64> {
        let middle_m = self.size_m[axis] / 2.0;
        self.film.breaks_m[axis].iter().map(|at| 1e3 * (at - middle_m)).collect()
    }

    /// How far from the middle a pad's centre can be, mm.
    pub fn reach_mm(&self) -> [f64; 2] {
        self.size_m.map(|size| 1e3 * (size / 2.0 - self.pad_radius_m))
    }

    /// R·e^(−1/4): a disc of even current has, on average over itself, the potential of a ring of
    /// this radius.
    pub fn disc_m(&self) -> f64 {
        self.pad_radius_m * (-0.25f64).exp()
    }
}

/// The device's terminals from the bottom left corner.
fn terminals_m(device: &Device) -> Vec<[f64; 2]> {
    let half = [device.width_mm / 2.0, device.height_mm / 2.0];
    let place = |place: &[f64; 2]| [0, 1].map(|axis| 1e-3 * (place[axis] + half[axis]));
    device.terminals_mm.iter().map(place).collect()
}

/// Resistance in series with each of `count` terminals: `terminal_ohm`, none where shorted,
/// infinite where open.
fn series(table: &Table, count: usize) -> Result<Vec<f64>, SceneError> {
    let mut ohm = each(table, count)?;
    let numbers = Limits::within(1.0, count as f64);
    for (key, value) in [(SHORTED, 0.0), (OPEN_TERMINALS, OPEN)] {
        let key = key.within(numbers);
        for number in table.get(&key)?.unwrap_or_default() {
            if number.fract() != 0.0 {
                return Err(table.error(
                    key.about.name,
                    format!("expected numbers of terminals, 1 to {count}, got {number}"),
                ));
            }
            ohm[number as usize - 1] = value;
        }
    }
    match ohm.iter().any(|ohm| ohm.is_finite()) {
        true => Ok(ohm),
        false => Err(table
            .error("open", "expected a terminal that is not open, since the current has to leave")),
    }
}

/// `terminal_ohm`: a number for all terminals, or a list of one for each.
fn each(table: &Table, count: usize) -> Result<Vec<f64>, SceneError> {
    let (key, limits) = (TERMINAL_OHM.about.name, TERMINAL_OHM.about.limits());
    if !matches!(table.node(key), Some(Node { value: Value::List(_), .. })) {
        return Ok(vec![table.number(key, limits)?.unwrap_or(0.0); count]);
    }
    let list = table.numbers(key, limits)?.unwrap_or_default();
    match list.len() == count {
        true => Ok(list),
        false => {
            let got = list.len();
            Err(table.error(
                key,
                format!(
                    "expected a number, or one for each of {count} terminals, got a list of {got}"
                ),
            ))
        }
    }
}
