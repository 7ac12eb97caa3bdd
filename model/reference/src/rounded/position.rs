// SPDX-License-Identifier: MIT OR Apache-2.0
//! Position and sheet resistance from the ratios: the measured splines, inverted by Newton steps of
//! rounded words.
//!
//! ```text
//! [·]: to a word's W − 1 fractional bits, halves upwards, saturated
//! r = [32·gain·[⌊r/2⌋ − centre] + 32·[gain·rest]],       ⌊·⌋ to a word, rest·2^(1 − W) what it cuts
//! u = [4·(constant + rise_x·r_x + rise_y·r_y)]            a place: 32 cells are one
//! t = 64·u, modulo 2:  weights a = [⅛(1 − t)²], 1 − a − b, b = [⅛(1 + t)²] and [½(t − 1)], [−t], [½(t + 1)] of [t²]
//! surface: [three rows along u], of their words the value, [the slope along u], [the slope along v]
//! det = [4·(X_u·Y_v − X_v·Y_u)],  u += ⌊(Y_v·e_x − X_v·e_y)/det + ½⌋ to so many digits,  v likewise,  e = −[value − r]
//! x = [2·pitch·u + origin],  open where ⌊share/2⌋ < open/2
//! ```

use super::{Exact, floor_quotient, round};
use hapticore_contract::format::Format;
use hapticore_contract::profile::Profile;

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
    /// Whether a position is saturated.
    pub saturated: bool,
}

/// A table of coefficients.
#[derive(Debug, Clone)]
struct Coefficients {
    columns: usize,
    cells: [i128; 2],
    words: Vec<Exact>,
}

/// What the table says of an axis beside its coefficients.
#[derive(Debug, Clone)]
struct Axis {
    gain: Exact,
    centre: Exact,
    /// Less the constant, then the rise with either ratio.
    start: [Exact; 3],
    pitch: Exact,
    /// Origin of the axis, subtracted from the ratio.
    origin: Exact,
}

/// The position table of a profile.
#[derive(Debug, Clone)]
pub struct Position {
    axes: [Axis; 2],
    ratios: [Coefficients; 2],
    resistance: Coefficients,
    shift: u8,
    steps: u64,
    word: Format,
    position: Format,
    /// Half the share below which a terminal counts as open.
    open: Exact,
}

/// Along one axis: the cell, counted from the middle one, and three weights of the value and of the
/// slope.
struct Along {
    cell: i128,
    value: [Exact; 3],
    slope: [Exact; 3],
}

/// Two to the power of `exponent`.
fn power(exponent: i32) -> Exact {
    Exact::new(1, exponent)
}

/// Words of an axis before those of the next.
const SCALARS: usize = 8;
/// Where the share of an open terminal lies.
const OPEN: usize = 7;
/// Ratios agree to within 2^-TOLERANCE.
const TOLERANCE: i32 = 9;

impl Position {
    /// The position table of a profile with these words, in their order in the memory.
    pub fn new(profile: &Profile, words: &[Exact]) -> Self {
        let position = &profile.position;
        let sides = [position.columns as usize, position.rows as usize];
        let coarse =
            sides.map(|side| ((side - 2).div_ceil(1 << position.resistance_shift) | 1) + 2);
        let axis = |k: usize| {
            let of = &words[k * SCALARS..];
            Axis {
                gain: of[0],
                centre: of[1],
                start: [of[2], of[3], of[4]],
                pitch: of[5],
                origin: of[6],
            }
        };
        let mut rest = words[2 * SCALARS..].iter().copied();
        let mut take = |[columns, rows]: [usize; 2]| Coefficients {
            columns,
            cells: [columns as i128 - 2, rows as i128 - 2],
            words: rest.by_ref().take(columns * rows).collect(),
        };
        Position {
            axes: [axis(0), axis(1)],
            ratios: [take(sides), take(sides)],
            resistance: take(coarse),
            shift: position.resistance_shift,
            steps: position.steps,
            word: profile.formats.table,
            position: profile.formats.position,
            open: words[OPEN],
        }
    }

    /// Fractional bits of a word.
    fn bits(&self) -> i32 {
        i32::from(self.word.frac)
    }

    /// A number as a word: to the nearest, halves upwards.
    fn word(&self, x: Exact) -> Exact {
        let nearest = (x + power(-self.bits() - 1)).scaled(self.word.frac).floor();
        round(Exact::new(nearest, -self.bits()), self.word).value
    }

    /// The place for a pair of ratios.
    pub fn place(&self, ratios: [Exact; 2]) -> Place {
        let ratios = [0, 1].map(|k| self.normalise(&self.axes[k], ratios[k]));
        let mut place = [0, 1].map(|k| self.clamp(self.start(&self.axes[k], ratios), k));
        let mut invalid = false;
        for _ in 0..self.steps {
            (place, invalid) = self.step(place, ratios);
        }
        let [x, y] = [0, 1].map(|k| self.millimetres(&self.axes[k], place[k]));
        let coarse = place.map(|u| self.word(u.scaled(-(self.shift as i8))));
        let along = coarse.map(|u| self.along(u));
        let sheet = self.word(self.rows(&self.resistance, &along)[0]);
        let sheet = if sheet < Exact::ZERO { Exact::ZERO } else { sheet };
        Place { x: x.value, y: y.value, sheet, invalid, saturated: x.held | y.held }
    }

    /// Whether the least current, as a share, is that of an open terminal.
    pub fn any_open(&self, share: Exact) -> bool {
        self.halved(share) < self.open
    }

    /// Half of a ratio, as a word.
    fn halved(&self, ratio: Exact) -> Exact {
        Exact::new(ratio.scaled(self.word.frac - 1).floor(), -self.bits())
    }

    fn normalise(&self, axis: &Axis, ratio: Exact) -> Exact {
        let (half, floor) = (ratio.scaled(-1), self.halved(ratio));
        let rest = self.word((half - floor).scaled(self.word.frac) * axis.gain);
        let from_centre = self.word(floor - axis.centre);
        self.word((axis.gain * from_centre).scaled(5) + rest.scaled(5 - self.word.frac))
    }

    fn start(&self, axis: &Axis, [r_x, r_y]: [Exact; 2]) -> Exact {
        let [constant, rise_x, rise_y] = axis.start;
        self.word((rise_x * r_x + rise_y * r_y - constant).scaled(2))
    }

    /// A place within the table's cells.
    fn clamp(&self, place: Exact, axis: usize) -> Exact {
        let most = Exact::new(self.ratios[0].cells[axis], -6);
        let last = most - power(-self.bits());
        if place < -most {
            -most
        } else if last < place {
            last
        } else {
            place
        }
    }

    fn along(&self, place: Exact) -> Along {
        let one = power(0);
        let word = |x: Exact| self.word(x);
        let cell = (place.scaled(5) + power(-1)).floor();
        let t = place.scaled(6) - Exact::new(2 * cell, 0);
        let (square, turn) = (word(t * t), word(-t));
        let eighth = power(-3);
        let [before, after] = [turn, t].map(|t| word(eighth + t.scaled(-2) + square.scaled(-3)));
        Along {
            cell,
            value: [before, one - before - after, after],
            slope: [word((t - one).scaled(-1)), turn, word((t + one).scaled(-1))],
        }
    }

    /// Of a surface the value, not rounded, and the rounded slopes along u and v.
    fn rows(&self, table: &Coefficients, [u, v]: &[Along; 2]) -> [Exact; 3] {
        let first = [(u.cell, 0), (v.cell, 1)]
            .map(|(cell, axis)| (cell + (table.cells[axis] - 1) / 2) as usize);
        let dot = |a: &[Exact], b: &[Exact; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let rows = [0, 1, 2].map(|k| {
            let at = (first[1] + k) * table.columns + first[0];
            &table.words[at..at + 3]
        });
        let values = rows.map(|row| self.word(dot(row, &u.value)));
        let slopes = rows.map(|row| self.word(dot(row, &u.slope)));
        [
            dot(&values, &v.value),
            self.word(dot(&slopes, &v.value)),
            self.word(dot(&values, &v.slope)),
        ]
    }

    /// A Newton step from a place, and whether that place's ratios are others than those measured.
    fn step(&self, place: [Exact; 2], ratios: [Exact; 2]) -> ([Exact; 2], bool) {
        let along = place.map(|u| self.along(u));
        let [x, y] = self.ratios.each_ref().map(|table| self.rows(table, &along));
        let off = [self.word(x[0] - ratios[0]), self.word(y[0] - ratios[1])];
        let beyond = |off: Exact| off < -power(-TOLERANCE) || off >= power(-TOLERANCE);
        let [e_x, e_y] = off.map(|off| self.word(-off));
        // Stored with the other sign, or less it.
        let negative = |x: Exact| self.word(-x);
        let ([x_u, x_v], [y_u, y_v]) = ([x[1], negative(x[2])], [negative(y[1]), y[2]]);
        let determinant = self.word((x_u * y_v + x_v * negative(y_u)).scaled(2));
        let moves = [y_v * e_x + x_v * e_y, y_u * e_x + x_u * e_y];
        let stepped = [0, 1]
            .map(|k| self.clamp(self.word(place[k] + self.quotient(moves[k], determinant)), k));
        (stepped, beyond(off[0]) | beyond(off[1]))
    }

    /// Over a positive determinant the quotient, to `digits` digits; else the most negative or most
    /// positive code, by the sign.
    fn quotient(&self, by: Exact, determinant: Exact) -> Exact {
        let digits = (i32::from(self.word.width) - 3).min(16);
        let (half, most) = (determinant * power(-digits), 1i128 << (digits - 1));
        let code = if determinant > Exact::ZERO {
            floor_quotient((by + half) * power(digits - 1), determinant).clamp(-most, most - 1)
        } else if by + half < Exact::ZERO {
            -most
        } else {
            most - 1
        };
        // Codes span ±4 cells, of 32 to one, in 2^digits steps.
        Exact::new(code, 1 - digits - 3)
    }

    fn millimetres(&self, axis: &Axis, place: Exact) -> super::Rounded {
        let as_word = (axis.pitch * place).scaled(1) - axis.origin;
        let nearest = (as_word + power(-self.bits() - 1)).scaled(self.word.frac).floor();
        round(Exact::new(nearest, -i32::from(self.position.frac)), self.position)
    }
}
