// SPDX-License-Identifier: MIT OR Apache-2.0
//! Position and sheet resistance from the ratios: the measured splines, inverted by Newton steps of rounded words.
//!
//! ```text
//! along a line, coefficients a, b, c and the place f in their cell; W bits a word, [·]n: to n fractional bits, held at the rails
//!   e = [(c − b) − (b − a)],   s = [(b − a) + f·e]ₙ₊₁,   t = [(b − a) + s],   value = [½((a + b) + f·t)]ₙ₊₂
//! surface:  rows 0, 1, 2 along u; their values [·]ₙ and slopes along v
//! det = ⌊X_u Y_v⌋ − ⌊X_v Y_u⌋,   Δu = [|⌊Y_v e_x⌋ − ⌊X_v e_y⌋| / |det|],   Δv likewise       (⌊·⌋ to W + 10 fractional bits)
//! x = [origin + (u − middle)·pitch]
//! ```

use super::{Exact, round, round_quotient};
use crate::format::Format;
use crate::profile::Profile;

/// A place on the sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Millimetres along the long edges.
    pub x: Exact,
    /// Millimetres along the short edges.
    pub y: Exact,
    /// The sheet's resistance.
    pub sheet: Exact,
    /// Whether the table has no place with these ratios.
    pub invalid: bool,
    /// Whether a position is held at a rail.
    pub saturated: bool,
}

/// A table of coefficients.
#[derive(Debug, Clone)]
struct Coefficients {
    columns: usize,
    words: Vec<Exact>,
}

/// The position table of a profile.
#[derive(Debug, Clone)]
pub struct Position {
    ratios: [Coefficients; 2],
    resistance: Coefficients,
    /// Of either axis: the place of the middle and the size of a cell, in mm.
    geometry: [[Exact; 2]; 2],
    cells: [i128; 2],
    shift: u8,
    steps: u64,
    width: u8,
    position: Format,
    sheet: Format,
}

/// A surface at a place: its value, and its slopes along u and v.
struct Surface {
    value: Exact,
    along: [Exact; 2],
}

/// Ratios agree to within 2^-TOLERANCE.
const TOLERANCE: i32 = 10;
/// Units of the middle's place and of a cell's size: 2^10 mm and 2^6 mm.
const UNITS: [i8; 2] = [10, 6];
/// A step is shorter than 2^2 cells.
const STEP: u8 = 2;

impl Position {
    /// The position table of a profile with these words, in their order in the memory.
    pub fn new(profile: &Profile, words: &[Exact]) -> Self {
        let position = &profile.position;
        let (columns, rows) = (position.columns as usize, position.rows as usize);
        let mut words = words.iter().copied();
        let mut take = |count: usize| words.by_ref().take(count).collect::<Vec<_>>();
        let geometry = take(4);
        let axis = |k: usize| [geometry[2 * k].scaled(UNITS[0]), geometry[2 * k + 1].scaled(UNITS[1])];
        let coarse = |side: usize| (side - 2).div_ceil(1 << position.resistance_shift) + 2;
        let geometry = [axis(0), axis(1)];
        let ratios = [0, 1].map(|_| Coefficients { columns, words: take(columns * rows) });
        let resistance = Coefficients { columns: coarse(columns), words: take(coarse(columns) * coarse(rows)) };
        Position {
            ratios,
            resistance,
            geometry,
            cells: [columns as i128 - 2, rows as i128 - 2],
            shift: position.resistance_shift,
            steps: position.steps,
            width: profile.formats.table.width,
            position: profile.formats.position,
            sheet: Format::unsigned(profile.formats.table.width - 1, profile.formats.table.frac),
        }
    }

    /// The place for a pair of ratios.
    pub fn place(&self, ratios: [Exact; 2]) -> Place {
        let mut place = self.nearest(ratios);
        for _ in 0..self.steps {
            place = self.step(place, ratios);
        }
        let beyond = |k: usize| {
            let left = ratios[k] - self.surface(&self.ratios[k], place, 0).value;
            left.magnitude() > Exact::new(1, -TOLERANCE)
        };
        let invalid = beyond(0) | beyond(1);
        let sheet = round(self.surface(&self.resistance, place, self.shift).value, self.sheet).value;
        let [x, y] = [0, 1].map(|axis| {
            let [middle, pitch] = self.geometry[axis];
            let from_middle = place[axis] - Exact::new(self.cells[axis], -1);
            round(middle + from_middle * pitch, self.position)
        });
        Place { x: x.value, y: y.value, sheet, invalid, saturated: x.held | y.held }
    }

    /// The middle of the cell whose middle coefficients are nearest, of about every eighth along either axis.
    fn nearest(&self, ratios: [Exact; 2]) -> [Exact; 2] {
        let guesses = self.cells.map(|cells| {
            let stride = ((cells + 4) / 8).max(1);
            let most = (cells - 1) / stride;
            let first = (cells - 1 - most * stride) / 2;
            (0..=most).map(move |k| first + k * stride).collect::<Vec<_>>()
        });
        let mut nearest: Option<(Exact, [i128; 2])> = None;
        for &v in &guesses[1] {
            for &u in &guesses[0] {
                let off = |k: usize| {
                    let table = &self.ratios[k];
                    (ratios[k] - table.words[(v as usize + 1) * table.columns + u as usize + 1]).magnitude()
                };
                let distance = off(0) + off(1);
                if nearest.is_none_or(|(least, _)| distance < least) {
                    nearest = Some((distance, [u, v]));
                }
            }
        }
        nearest.expect("a table has cells").1.map(|cell| Exact::new(2 * cell + 1, -1))
    }

    /// Fractional bits of a place.
    fn fraction(&self) -> u8 {
        let most = self.cells[0].max(self.cells[1]);
        self.width - (128 - most.leading_zeros()) as u8
    }

    fn step(&self, place: [Exact; 2], ratios: [Exact; 2]) -> [Exact; 2] {
        let half = self.half();
        let [x, y] = [0, 1].map(|k| self.surface(&self.ratios[k], place, 0));
        let [e_x, e_y] = [(&x, 0), (&y, 1)].map(|(surface, k)| round(ratios[k] - surface.value, half).value);
        let minor = |a: Exact, b: Exact, c: Exact, d: Exact| self.cut(a * b) - self.cut(c * d);
        let determinant = minor(x.along[0], y.along[1], x.along[1], y.along[0]);
        let along_u = minor(y.along[1], e_x, x.along[1], e_y);
        let along_v = minor(x.along[0], e_y, y.along[0], e_x);
        let fraction = self.fraction();
        let to = Format::unsigned(STEP + fraction, fraction as i8);
        let moved = |axis: usize, minor: Exact| {
            let by = round_quotient(minor.magnitude(), determinant.magnitude(), to).value;
            let backwards = (minor < Exact::ZERO) != (determinant < Exact::ZERO);
            let moved = if backwards { place[axis] - by } else { place[axis] + by };
            let last = Exact::new((self.cells[axis] << fraction) - 1, -i32::from(fraction));
            if moved < Exact::ZERO {
                Exact::ZERO
            } else if last < moved {
                last
            } else {
                moved
            }
        };
        [moved(0, along_u), moved(1, along_v)]
    }

    /// Low bits of a product of slopes are cut.
    fn cut(&self, product: Exact) -> Exact {
        let frac = self.width as i8 + 10;
        Exact::new(product.scaled(frac).floor(), -i32::from(frac))
    }

    fn word(&self) -> Format {
        Format::signed(self.width, self.width as i8 - 1)
    }

    /// Of slopes and residuals.
    fn half(&self) -> Format {
        Format::signed(self.width, self.width as i8)
    }

    /// The value and the slope along a line, of coefficients whose words have `frac` fractional bits.
    fn line(&self, [a, b, c]: [Exact; 3], f: Exact, frac: i8) -> [Exact; 2] {
        let word = Format::signed(self.width, frac);
        let (difference, second) = (b - a, round((c - b) - (b - a), word).value);
        let level = Format::signed(self.width + 2, frac + 1);
        let slope = round(difference + f * second, level).value;
        let slope = round(slope, Format::signed(self.width, frac + 1)).value;
        let both = round(difference + slope, word).value;
        let value = (a + b + f * both).scaled(-1);
        [round(value, Format::signed(self.width + 2, frac + 2)).value, slope]
    }

    fn surface(&self, table: &Coefficients, place: [Exact; 2], shift: u8) -> Surface {
        let fraction = self.fraction();
        let [(column, f_u), (row, f_v)] = place.map(|place| {
            let cells = place.scaled(-(shift as i8));
            let cell = cells.floor();
            let rest = (cells - Exact::new(cell, 0)).scaled(fraction as i8).floor();
            (cell as usize, Exact::new(rest, -i32::from(fraction)))
        });
        let (word, half) = (self.word(), self.half());
        let rows = [0, 1, 2].map(|k| {
            let at = (row + k) * table.columns + column;
            let [value, slope] = self.line([table.words[at], table.words[at + 1], table.words[at + 2]], f_u, word.frac);
            [round(value, word).value, slope]
        });
        let [value, along_v] = self.line(rows.map(|[value, _]| value), f_v, word.frac);
        let [along_u, _] = self.line(rows.map(|[_, slope]| slope), f_v, half.frac);
        Surface { value, along: [round(along_u, half).value, along_v] }
    }
}
