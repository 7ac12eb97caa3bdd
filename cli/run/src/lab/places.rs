// SPDX-License-Identifier: MIT OR Apache-2.0
//! Places: what the terminals read of a pad at known places.
//!
//! | columns | are |
//! | --- | --- |
//! | `x_mm`, `y_mm` | the place, from the sheet's middle |
//! | `i1` … `iN` | amplitudes of the terminals' currents, A; or `i1_re`, `i1_im` … in phase with the sensing voltage and a quarter turn ahead |
//! | `i1_deg` … `iN_deg` | with amplitudes: their phases, degrees ahead of the sensing voltage |
//! | `v_sense` | the sensing voltage, V, peak as the currents |
//! | `sheet_ohm` | the sheet's resistance there, where it was measured |

use std::f64::consts::TAU;

use anyhow::{Result, bail, ensure};
use hapticore_scene::{Complex, LEAST_TERMINALS, MOST_TERMINALS};

use super::table::{Row, Table};
use hapticore_host::device::OPEN;

/// Places at least: fewer leave no word of the position table between edges to tell.
const LEAST: usize = 16;

/// Different x and y of places at least.
const LEAST_ALONG: usize = 4;

/// What the terminals read of a pad at a known place.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    /// From the sheet's middle, mm.
    pub at_mm: [f64; 2],
    /// Each terminal's current per volt of sensing, S; real where no phases are known.
    pub siemens: Vec<Complex>,
    /// Amplitude of the sensing voltage, V.
    pub sense_v: f64,
    /// The sheet's resistance, where it was measured.
    pub sheet_ohm: Option<f64>,
}

/// The places of a file.
#[derive(Debug, Clone)]
pub struct Places {
    /// Name of the file, for messages.
    pub file: String,
    /// Measured positions, those at the same position averaged.
    pub places: Vec<Place>,
    /// Whether phases are known.
    pub phases: bool,
}

/// How currents stand in the columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    Amplitudes,
    Polar,
    Rectangular,
}

/// Column numbers of the table.
struct Columns {
    place: [usize; 2],
    currents: Vec<(usize, Option<usize>)>,
    sense: usize,
    sheet: Option<usize>,
    form: Form,
}

/// Whether a table is one of places.
pub fn is(table: &Table) -> bool {
    table.has("x_mm")
        && table.has("y_mm")
        && (table.has("i1") || table.has("i1_re"))
        && !table.has("haptic_v_rms")
}

impl Columns {
    fn of(table: &Table) -> Result<Columns> {
        let counts = [table.count("i", ""), table.count("i", "_re")];
        let form = match (counts[0], table.has("i1_deg")) {
            (0, _) => Form::Rectangular,
            (_, true) => Form::Polar,
            (_, false) => Form::Amplitudes,
        };
        let terminals = counts[0].max(counts[1]);
        let expected = LEAST_TERMINALS..=MOST_TERMINALS;
        ensure!(
            expected.contains(&terminals),
            "{}:1: expected i1 to i3 at least and i{MOST_TERMINALS} at most, got {terminals} currents",
            table.file
        );
        let pair = |k: usize| {
            Ok(match form {
                Form::Amplitudes => (table.column(&format!("i{k}"))?, None),
                Form::Polar => {
                    (table.column(&format!("i{k}"))?, Some(table.column(&format!("i{k}_deg"))?))
                }
                Form::Rectangular => {
                    (table.column(&format!("i{k}_re"))?, Some(table.column(&format!("i{k}_im"))?))
                }
            })
        };
        Ok(Columns {
            place: [table.column("x_mm")?, table.column("y_mm")?],
            currents: (1..=terminals).map(pair).collect::<Result<_>>()?,
            sense: table.column("v_sense")?,
            sheet: table.has("sheet_ohm").then(|| table.column("sheet_ohm")).transpose()?,
            form,
        })
    }

    fn current(&self, row: &Row, k: usize) -> Complex {
        let (first, second) = self.currents[k];
        let second = second.map_or(0.0, |column| row.at(column));
        match self.form {
            Form::Polar => Complex::from_polar(row.at(first), second.to_radians()),
            Form::Amplitudes | Form::Rectangular => Complex::new(row.at(first), second),
        }
    }

    fn place(&self, table: &Table, row: &Row, full_scale_a: f64) -> Result<Place> {
        let (sense_v, place) = (row.at(self.sense), format!("{}:{}", table.file, row.line));
        ensure!(sense_v > 0.0, "{place}: v_sense: expected volts above 0, got {sense_v}");
        let mut siemens = Vec::new();
        for k in 0..self.currents.len() {
            let (number, current) = (k + 1, self.current(row, k));
            if self.form != Form::Rectangular && row.at(self.currents[k].0) < 0.0 {
                bail!(
                    "{place}: i{number}: expected an amplitude, not below 0, got {}",
                    row.at(self.currents[k].0)
                );
            }
            let got = current.norm();
            ensure!(
                got <= full_scale_a,
                "{place}: i{number}: expected at most current_full_scale_a = {full_scale_a} A, got {got}"
            );
            siemens.push(current / sense_v);
        }
        let sheet_ohm = self.sheet.map(|column| row.at(column));
        Ok(Place { at_mm: self.place.map(|column| row.at(column)), siemens, sense_v, sheet_ohm })
    }
}

impl Places {
    /// The capacitance of the pad at the places, pF: the median of their currents over the sensing voltage, without the sheet's
    /// resistance, which takes about a percent of it.
    pub fn capacitance_pf(&self, carrier_hz: f64) -> f64 {
        let siemens = |place: &Place| place.siemens.iter().map(|current| current.norm()).sum();
        let mut all: Vec<f64> = self.places.iter().map(siemens).collect();
        all.sort_by(f64::total_cmp);
        1e12 * all[all.len() / 2] / (TAU * carrier_hz)
    }

    /// The places of a table.
    ///
    /// # Errors
    /// Columns or numbers that are not as above; data that no table of positions can be made from.
    pub fn of(table: &Table, full_scale_a: f64) -> Result<Places> {
        let columns = Columns::of(table)?;
        let places = table
            .rows()
            .iter()
            .map(|row| columns.place(table, row, full_scale_a))
            .collect::<Result<_>>()?;
        let places = Places {
            file: table.file.clone(),
            places: averaged(places),
            phases: columns.form != Form::Amplitudes,
        };
        places.check()?;
        Ok(places)
    }

    /// Number of terminals.
    pub fn terminals(&self) -> usize {
        self.places[0].siemens.len()
    }

    fn check(&self) -> Result<()> {
        let (file, count) = (&self.file, self.places.len());
        ensure!(
            count >= LEAST,
            "{file}: too few places: expected {LEAST} different ones at least, better a raster of 20 × 12 or more, got {count}"
        );
        for (axis, name) in ["x_mm", "y_mm"].into_iter().enumerate() {
            let along = apart(self.places.iter().map(|place| place.at_mm[axis]));
            ensure!(
                along >= LEAST_ALONG,
                "{file}: {name}: expected places at {LEAST_ALONG} different {name} at least, which span the sheet, got {along}"
            );
        }
        let share = |place: &Place, k: usize| place.siemens[k].norm() / total(place);
        for k in 0..self.terminals() {
            let most = self.places.iter().map(|place| share(place, k)).fold(0.0, f64::max);
            let number = k + 1;
            ensure!(
                most >= OPEN,
                "{file}: i{number}: terminal {number} has no current at any place (at most {most:.0e} of the total): it is open, or its column is wrong"
            );
        }
        Ok(())
    }

    /// The ratios of currents, with these signs.
    pub fn ratios(siemens: &[Complex], signs: [&[i8]; 2]) -> [f64; 2] {
        let currents =
            || siemens.iter().map(|siemens| siemens.norm()).zip(signs[0].iter().zip(signs[1]));
        let sum = Places::denominator(siemens, signs);
        [0, 1].map(|axis| {
            currents().map(|(current, (x, y))| current * f64::from([*x, *y][axis])).sum::<f64>()
                / sum
        })
    }

    /// The currents, as shares of the ratios' denominator.
    pub fn shares(siemens: &[Complex], signs: [&[i8]; 2]) -> Vec<f64> {
        let denominator = Places::denominator(siemens, signs);
        siemens.iter().map(|siemens| siemens.norm() / denominator).collect()
    }

    /// The sum of the currents that have a sign.
    fn denominator(siemens: &[Complex], signs: [&[i8]; 2]) -> f64 {
        let currents =
            siemens.iter().map(|siemens| siemens.norm()).zip(signs[0].iter().zip(signs[1]));
        currents.filter(|(_, (x, y))| (**x, **y) != (0, 0)).map(|(current, _)| current).sum()
    }

    /// Brings the places into the order of a raster, row by row; places in a row, or none where
    /// they are no raster.
    pub fn raster(&mut self) -> Option<usize> {
        let [xs, ys] =
            [0, 1].map(|axis| distinct(self.places.iter().map(|place| place.at_mm[axis])));
        if xs.len() * ys.len() != self.places.len() {
            return None;
        }
        let index = |values: &[f64], value: f64| {
            values.iter().rposition(|first| *first <= value).unwrap_or(0)
        };
        let cell =
            |place: &Place| index(&ys, place.at_mm[1]) * xs.len() + index(&xs, place.at_mm[0]);
        self.places.sort_by_key(cell);
        let whole = self.places.iter().enumerate().all(|(number, place)| cell(place) == number);
        whole.then_some(xs.len())
    }
}

/// The sum of the amplitudes.
pub fn total(place: &Place) -> f64 {
    place.siemens.iter().map(|siemens| siemens.norm()).sum()
}

/// The first of each run of values that a raster's line has, ascending: nearer ones than a
/// thousandth of all are one.
fn distinct(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let (mut values, near) = ascending(values);
    let mut last = f64::NEG_INFINITY;
    values.retain(|value| {
        let is_new = value - last > near;
        last = *value;
        is_new
    });
    values
}

/// How many values there are with more than a thousandth of all between each and the next, however densely others lie.
fn apart(values: impl Iterator<Item = f64>) -> usize {
    let (values, near) = ascending(values);
    let mut last = f64::NEG_INFINITY;
    let mut is_counted = |value: &f64| {
        let is_new = value - last > near;
        last = if is_new { *value } else { last };
        is_new
    };
    values.iter().filter(|value| is_counted(value)).count()
}

/// The values in order, and a thousandth of what they span.
fn ascending(values: impl Iterator<Item = f64>) -> (Vec<f64>, f64) {
    let mut values: Vec<_> = values.collect();
    values.sort_by(f64::total_cmp);
    let near = 1e-3 * (values[values.len() - 1] - values[0]);
    (values, near)
}

/// Measurements of the very same place as one.
fn averaged(mut places: Vec<Place>) -> Vec<Place> {
    let key = |place: &Place| place.at_mm;
    places.sort_by(|a, b| key(a)[1].total_cmp(&key(b)[1]).then(key(a)[0].total_cmp(&key(b)[0])));
    let mean = |same: &[Place]| {
        let count = same.len() as f64;
        let siemens = |k: usize| same.iter().map(|place| place.siemens[k]).sum::<Complex>() / count;
        Place {
            at_mm: same[0].at_mm,
            siemens: (0..same[0].siemens.len()).map(siemens).collect(),
            sense_v: same.iter().map(|place| place.sense_v).sum::<f64>() / count,
            sheet_ohm: same
                .iter()
                .map(|place| place.sheet_ohm)
                .sum::<Option<f64>>()
                .map(|sum| sum / count),
        }
    };
    places.chunk_by(|a, b| key(a) == key(b)).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_count_however_densely_they_lie() {
        let scattered = |n: i32| (f64::from(n) * 3f64.sqrt()).fract();
        assert!(apart((0..5000).map(scattered)) > 400);
        assert_eq!(apart((0..5000).map(|n| f64::from(n % 3))), 3);
        assert_eq!(apart([7.0; 20].into_iter()), 1);
        let lines = (0..60).map(|n| f64::from(n / 20) + 1e-4 * scattered(n));
        assert_eq!(distinct(lines).len(), 3, "those of a raster");
    }
}
