// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where the words of the position table lie in its memory, and how its cells divide the sheet.
//!
//! ```text
//! origin_x, pitch_x, origin_y, pitch_y │ r_x: rows of columns │ r_y: likewise │ R: fewer rows and columns
//! ```
//!
//! A quadratic B-spline over n cells has n + 2 coefficients; those of cell k are k, k + 1 and k + 2, and coefficient k + 1 has
//! its centre in the middle of cell k.

use crate::format::Format;
use crate::profile::Profile;

/// A surface over the sheet: one spline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Surface {
    /// The x ratio.
    RatioX,
    /// The y ratio.
    RatioY,
    /// The sheet's resistance.
    Resistance,
}

/// The two axes of the sheet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// Along the long edges.
    X,
    /// Along the short ones.
    Y,
}

/// The layout of a profile's position table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layout {
    /// Coefficients of the ratios along either axis: columns and rows.
    ratios: [usize; 2],
    /// A cell of the resistance's spline is `2^shift` cells of the ratios' wide and high.
    shift: u8,
}

/// The cells of the first guess along an axis: every `stride`-th from `first` on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Guesses {
    /// The first cell.
    pub first: usize,
    /// Cells from one to the next.
    pub stride: usize,
    /// How many.
    pub count: usize,
}

/// Words before the coefficients: the place of the table's middle and the size of its cells, x before y.
const GEOMETRY: usize = 4;

impl Layout {
    /// The layout of a profile.
    pub fn new(profile: &Profile) -> Self {
        let position = &profile.position;
        Layout { ratios: [position.columns as usize, position.rows as usize], shift: position.resistance_shift }
    }

    /// Cells of the ratios' splines along an axis.
    pub fn cells(&self, axis: Axis) -> usize {
        self.ratios[axis as usize] - 2
    }

    /// Coefficients of a surface along an axis.
    pub fn coefficients(&self, surface: Surface, axis: Axis) -> usize {
        match surface {
            Surface::Resistance => self.cells(axis).div_ceil(1 << self.shift) + 2,
            _ => self.ratios[axis as usize],
        }
    }

    /// A cell of the resistance's spline is `2^shift` cells of the ratios' wide and high.
    pub fn shift(&self) -> u8 {
        self.shift
    }

    /// Where the place of the table's middle lies; the size of a cell follows it.
    pub fn geometry(&self, axis: Axis) -> usize {
        2 * axis as usize
    }

    /// Where the coefficients of a surface begin.
    pub fn surface(&self, surface: Surface) -> usize {
        GEOMETRY + surface as usize * self.ratios[0] * self.ratios[1]
    }

    /// Words in all.
    pub fn words(&self) -> usize {
        let [columns, rows] = [Axis::X, Axis::Y].map(|axis| self.coefficients(Surface::Resistance, axis));
        self.surface(Surface::Resistance) + columns * rows
    }

    /// The cells of the first guess: about every eighth of the side, in the middle of the axis.
    pub fn guesses(&self, axis: Axis) -> Guesses {
        let cells = self.cells(axis);
        let stride = ((cells + 4) / 8).max(1);
        let count = (cells - 1) / stride + 1;
        Guesses { first: (cells - 1 - (count - 1) * stride) / 2, stride, count }
    }

    /// The format of a place along an axis, in cells from the table's edge: as wide as a word of the table.
    pub fn place(&self, word: Format) -> Format {
        let cells = self.cells(Axis::X).max(self.cells(Axis::Y));
        Format::unsigned(word.width, (word.width - Format::counter(cells as u64).width) as i8)
    }
}
