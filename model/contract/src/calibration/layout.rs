// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where the words of the position table lie in its memory, and how its cells divide the sheet.
//!
//! ```text
//! scalars of x │ scalars of y │ r_x: rows of columns │ r_y: likewise │ R: fewer rows and columns
//! ```
//!
//! A quadratic B-spline over n cells has n + 2 coefficients. Those of cell k are k, k + 1 and k +
//! 2; coefficient k + 1 has its centre in the middle of cell k. The number of cells is odd along
//! either axis, so that a coefficient lies in the middle of the table.

use crate::profile::Profile;
use hapticore_hdl::format::Format;

/// A surface over the sheet: one spline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Surface {
    /// The x ratio, normalised.
    RatioX,
    /// The y ratio, normalised.
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

/// A number of the calibration that the table has once for either axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scalar {
    /// The gain of the axis' ratio, by [`Layout::GAIN`].
    Gain,
    /// Half of the ratio that is normalised to zero.
    Centre,
    /// The first guess: less its constant, by four.
    StartConstant,
    /// The first guess: its rise with the normalised r_x, by four.
    StartRatioX,
    /// The first guess: its rise with the normalised r_y, by four.
    StartRatioY,
    /// Half the size of 32 cells, by the range of a position.
    Pitch,
    /// Less the place of the table's middle, by the range of a position.
    Origin,
    /// Of x alone: half the share of the ratios' denominator below which a terminal's current is
    /// that of an open one.
    Open,
}

/// The layout of a profile's position table.
///
/// ```
/// use hapticore_contract::calibration::{Axis, Layout, Scalar, Surface};
/// use hapticore_contract::profile::Profile;
///
/// let layout = Layout::new(&Profile::bundled("small")?);
/// assert_eq!([Axis::X, Axis::Y].map(|axis| layout.coefficients(Surface::RatioX, axis)), [37, 19]);
/// assert_eq!(layout.scalar(Scalar::Centre, Axis::Y), Layout::SCALARS + 1);
/// assert_eq!(layout.surface(Surface::RatioY), 2 * Layout::SCALARS + 37 * 19);
/// assert!(layout.words() > layout.surface(Surface::Resistance));
/// # Ok::<(), hapticore_contract::profile::ProfileError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layout {
    /// Coefficients of the ratios along either axis: columns and rows.
    ratios: [usize; 2],
    /// A cell of the resistance's spline is `2^shift` cells of the ratios' wide and high.
    shift: u8,
}

impl Layout {
    /// Addresses from the scalars of x to those of y, and from there to the coefficients.
    pub const SCALARS: usize = 8;
    /// A ratio's gain is its scalar times this.
    pub const GAIN: f64 = 16.0;
    /// Cells from the table's middle to a place whose fraction is 1.
    pub const CELLS: f64 = 32.0;
    /// Normalised ratios at the place found and measured ones agree within `2^-TOLERANCE_BITS`, or
    /// there is no such place.
    pub const TOLERANCE_BITS: u8 = 9;
    /// The longest Newton step of a look-up, in cells.
    pub const STEP_CELLS: f64 = 4.0;

    /// The layout of a profile.
    pub fn new(profile: &Profile) -> Self {
        let position = &profile.position;
        Layout {
            ratios: [position.columns as usize, position.rows as usize],
            shift: position.resistance_shift,
        }
    }

    /// Cells of a surface along an axis: those of the resistance reach at least as far as the
    /// ratios'.
    pub fn cells(&self, surface: Surface, axis: Axis) -> usize {
        self.wider_cells(if surface == Surface::Resistance { self.shift } else { 0 }, axis)
    }

    /// Cells along an axis of which each is as wide as `2^shift` of the ratios'.
    pub fn wider_cells(&self, shift: u8, axis: Axis) -> usize {
        (self.ratios[axis as usize] - 2).div_ceil(1 << shift) | 1
    }

    /// Coefficients of a surface along an axis.
    pub fn coefficients(&self, surface: Surface, axis: Axis) -> usize {
        self.cells(surface, axis) + 2
    }

    /// A cell of the resistance's spline is `2^shift` cells of the ratios' wide and high.
    pub fn shift(&self) -> u8 {
        self.shift
    }

    /// Where a scalar lies.
    pub fn scalar(&self, scalar: Scalar, axis: Axis) -> usize {
        scalar as usize + axis as usize * Layout::SCALARS
    }

    /// Where the coefficients of a surface begin.
    pub fn surface(&self, surface: Surface) -> usize {
        2 * Layout::SCALARS + surface as usize * self.ratios[0] * self.ratios[1]
    }

    /// Where the first coefficient of the middle cell lies.
    pub fn middle(&self, surface: Surface) -> usize {
        let [column, row] = [Axis::X, Axis::Y].map(|axis| (self.cells(surface, axis) - 1) / 2);
        self.surface(surface) + row * self.coefficients(surface, Axis::X) + column
    }

    /// Words in all.
    pub fn words(&self) -> usize {
        let [columns, rows] =
            [Axis::X, Axis::Y].map(|axis| self.coefficients(Surface::Resistance, axis));
        self.surface(Surface::Resistance) + columns * rows
    }

    /// Fractional bits of a place in cells, of a word of the table's width.
    pub fn place_bits(word: Format) -> u8 {
        word.width - 6
    }
}
