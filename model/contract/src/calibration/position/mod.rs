// SPDX-License-Identifier: MIT OR Apache-2.0
//! The position table: splines of what is read over the sheet, and the place for a pair of ratios,
//! by Newton steps.

mod fit;
mod spline;

pub use fit::{Point, PositionError};

use super::layout::{Axis, Layout, Scalar, Surface};
use num_traits::{Float, FromPrimitive};

/// From ratios to place: the words of the core's table ([`Layout`]), and what they were made from.
#[derive(Debug, Clone, PartialEq)]
pub struct PositionTable {
    /// The words in their order in the memory, as fractions.
    pub words: Vec<f64>,
    layout: Layout,
    /// Coefficients of both ratios, as they were measured.
    ratios: [Vec<f64>; 2],
    /// Coefficients of the resistance.
    resistance: Vec<f64>,
    /// Of either axis: the place of the table's middle and the size of a cell, in mm.
    geometry: [[f64; 2]; 2],
    /// Of either ratio: what is normalised to zero, and the gain.
    scales: [[f64; 2]; 2],
    /// Of either axis: the first guess in cells, a constant and the rise with either ratio.
    start: [[f64; 3]; 2],
    open_share: f64,
}

/// A place that was looked up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found<T = f64> {
    /// Millimetres from the middle, along the long edges.
    pub x: T,
    /// Millimetres from the middle, along the short edges.
    pub y: T,
    /// The sheet's resistance, in full scales of voltage per current.
    pub sheet: T,
    /// What the larger of the normalised ratios differs by from that of the place.
    pub residual: T,
}

impl<T: Real> Found<T> {
    /// Whether the ratios are those of a place on the table.
    pub fn is_valid(&self) -> bool {
        self.residual <= real(2f64.powi(-i32::from(Layout::TOLERANCE_BITS)))
    }
}

/// How what is looked up depends on the ratios, to first order: what an error of a ratio makes of
/// it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Condition {
    /// Millimetres per unit of r_x and of r_y: those of x, then those of y.
    pub place: [[f64; 2]; 2],
    /// Full scales of voltage per current, per unit of r_x and of r_y.
    pub sheet: [f64; 2],
}

/// What a look-up can be done in: `f32`, `f64`, or a type with more bits.
pub trait Real: Float + FromPrimitive {}

impl<T: Float + FromPrimitive> Real for T {}

/// Newton steps of a look-up in floating point.
const STEPS: usize = 12;

/// Either ratio and its slopes along u and v.
type Slopes<T> = [[T; 3]; 2];

/// A coefficient's number, its weight in the value, and in the slopes along u and v.
type Term<T> = (usize, T, [T; 2]);

impl PositionTable {
    /// The table, with the share of the ratios' denominator below which a terminal's current counts
    /// as that of an open one; of a table as it is fitted none does.
    #[must_use]
    pub fn with_open_share(mut self, share: f64) -> Self {
        self.open_share = share;
        self.words[self.layout.scalar(Scalar::Open, Axis::X)] = share / 2.0;
        self
    }

    /// The share of the ratios' denominator below which a terminal's current counts as that of an
    /// open one.
    pub fn open_share(&self) -> f64 {
        self.open_share
    }

    fn cells(&self, axis: Axis) -> f64 {
        self.layout.cells(Surface::RatioX, axis) as f64
    }

    fn normalised<T: Real>(&self, ratios: [T; 2]) -> [T; 2] {
        [0, 1].map(|k| (ratios[k] - real(self.scales[k][0])) * real(self.scales[k][1]))
    }

    fn size(&self, surface: Surface) -> [usize; 2] {
        [Axis::X, Axis::Y].map(|axis| self.layout.coefficients(surface, axis))
    }

    /// What a cell of the ratios' splines is of one of the surface's.
    fn cell(&self, surface: Surface) -> f64 {
        if surface == Surface::Resistance {
            2f64.powi(-i32::from(self.layout.shift()))
        } else {
            1.0
        }
    }

    /// The nine coefficients about a place: each one's number, and its weight in the value and in
    /// the slopes along u and v, in cells of the surface.
    fn terms<T: Real>(&self, surface: Surface, place: [T; 2]) -> [Term<T>; 9] {
        let size = self.size(surface);
        let [(column, across), (row, down)] = [Axis::X, Axis::Y].map(|axis| {
            let cells = self.layout.cells(surface, axis);
            let from_middle = place[axis as usize] - real(self.cells(axis) / 2.0);
            basis(real::<T>(self.cell(surface)) * from_middle + real(cells as f64 / 2.0), cells)
        });
        std::array::from_fn(|k| {
            let ([a, slope_a], [b, slope_b]) = (across[k % 3], down[k / 3]);
            ((row + k / 3) * size[0] + column + k % 3, a * b, [slope_a * b, a * slope_b])
        })
    }

    /// Both ratios at a place, with their slopes.
    fn at<T: Real>(&self, place: [T; 2]) -> Slopes<T> {
        let terms = self.terms(Surface::RatioX, place);
        self.ratios.each_ref().map(|ratio| slopes(&terms, ratio))
    }

    /// The place for a pair of ratios: r_x and r_y as eqs. 2 and 3 give them.
    ///
    /// ```
    /// # use hapticore_contract::{calibration::{Point, PositionTable}, profile::Profile};
    /// let profile = Profile::bundled("standard")?;
    /// // A sheet of 200 × 100 mm on which each ratio rises by 0.006 a millimetre.
    /// let at = |k: i32| (f64::from(k % 11 - 5) * 20.0, f64::from(k / 11 - 5) * 10.0);
    /// let point = |(x, y)| Point { x, y, r_x: 0.006 * x, r_y: 0.006 * y, sheet: 0.04 };
    /// let table = PositionTable::fit(&profile, &(0..121).map(at).map(point).collect::<Vec<_>>())?;
    ///
    /// let found = table.look_up(0.3f64, -0.12);
    /// assert!(found.is_valid() && (found.x - 50.0).abs() < 1e-5 && (found.y + 20.0).abs() < 1e-5);
    /// assert!(!table.look_up(0.9f64, 0.0).is_valid(), "150 mm is beyond the sheet's edge");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn look_up<T: Real>(&self, r_x: T, r_y: T) -> Found<T> {
        let mut place = self.first_guess([r_x, r_y]);
        for _ in 0..STEPS {
            let next = self.step(place, [r_x, r_y]);
            // From here on every step would be the same.
            if next == place {
                break;
            }
            place = next;
        }
        let [[x, ..], [y, ..]] = self.at(place);
        let scale = |k: usize| real::<T>(self.scales[k][1]);
        let residual = ((r_x - x) * scale(0)).abs().max(((r_y - y) * scale(1)).abs());
        let [sheet, ..] = slopes(&self.terms(Surface::Resistance, place), &self.resistance);
        let [x, y] = [Axis::X, Axis::Y].map(|axis| {
            let [origin, pitch] = self.geometry[axis as usize].map(real::<T>);
            origin + (place[axis as usize] - real(self.cells(axis) / 2.0)) * pitch
        });
        Found { x, y, sheet, residual }
    }

    /// How what is found at a place depends on the ratios; None where the ratios do not tell places
    /// apart.
    pub fn condition(&self, x_mm: f64, y_mm: f64) -> Option<Condition> {
        let place = self.place([x_mm, y_mm]);
        let [[_, xu, xv], [_, yu, yv]] = self.at(place);
        let determinant = xu * yv - xv * yu;
        let cells = [[yv, -xv], [-yu, xu]].map(|row| row.map(|slope| slope / determinant));
        let scale = self.cell(Surface::Resistance);
        let [_, along, across] = slopes(&self.terms(Surface::Resistance, place), &self.resistance);
        let sheet = [0, 1].map(|k| scale * (along * cells[0][k] + across * cells[1][k]));
        let place = [0, 1].map(|axis| cells[axis].map(|cells| cells * self.geometry[axis][1]));
        let finite = place.as_flattened().iter().chain(&sheet).all(|x| x.is_finite());
        finite.then_some(Condition { place, sheet })
    }

    /// A place in millimetres, in cells from the table's first edge.
    fn place(&self, millimetres: [f64; 2]) -> [f64; 2] {
        [Axis::X, Axis::Y].map(|axis| {
            let ([origin, pitch], cells) = (self.geometry[axis as usize], self.cells(axis));
            ((millimetres[axis as usize] - origin) / pitch + cells / 2.0).clamp(0.0, cells)
        })
    }

    fn first_guess<T: Real>(&self, ratios: [T; 2]) -> [T; 2] {
        let [r_x, r_y] = self.normalised(ratios);
        [Axis::X, Axis::Y].map(|axis| {
            let ([constant, of_x, of_y], cells) =
                (self.start[axis as usize].map(real::<T>), self.cells(axis));
            clamp(constant + of_x * r_x + of_y * r_y + real(cells / 2.0), 0.0, cells)
        })
    }

    fn step<T: Real>(&self, place: [T; 2], ratios: [T; 2]) -> [T; 2] {
        let [[x, xu, xv], [y, yu, yv]] = self.at(place);
        let [e_x, e_y] = [ratios[0] - x, ratios[1] - y];
        let determinant = xu * yv - xv * yu;
        let by = [(yv * e_x - xv * e_y) / determinant, (xu * e_y - yu * e_x) / determinant];
        let most = Layout::STEP_CELLS;
        let held = |place: T, by: T, axis| {
            let by = if by.is_finite() { clamp(by, -most, most) } else { T::zero() };
            clamp(place + by, 0.0, self.cells(axis))
        };
        [held(place[0], by[0], Axis::X), held(place[1], by[1], Axis::Y)]
    }
}

/// A number of the calibration, as it is.
#[inline(always)]
fn real<T: Real>(x: f64) -> T {
    T::from_f64(x).expect("a floating-point type takes every f64")
}

/// As [`f64::clamp`]: what is not a number stays so.
#[inline(always)]
fn clamp<T: Real>(x: T, low: f64, high: f64) -> T {
    let (low, high) = (real(low), real(high));
    if x < low {
        low
    } else if x > high {
        high
    } else {
        x
    }
}

/// The value and both slopes of a surface with these coefficients.
#[inline(always)]
fn slopes<T: Real>(terms: &[Term<T>; 9], coefficients: &[f64]) -> [T; 3] {
    let sum = |weight: fn(&Term<T>) -> T| {
        terms.iter().fold(T::zero(), |sum, term| sum + weight(term) * real(coefficients[term.0]))
    };
    [sum(|term| term.1), sum(|term| term.2[0]), sum(|term| term.2[1])]
}

/// The cell of a place, and of its three coefficients the weight in the value and in the slope.
fn basis<T: Real>(place: T, cells: usize) -> (usize, [[T; 2]; 3]) {
    // Of a number that is not negative, the integer is its floor.
    let cell = clamp(place, 0.0, cells as f64 - 1.0).to_usize().unwrap_or(0);
    let (f, one, two, half) = (place - real(cell as f64), T::one(), real::<T>(2.0), real::<T>(0.5));
    let weights = [
        [(one - f) * (one - f) / two, f - one],
        [half + f * (one - f), one - two * f],
        [f * f / two, f],
    ];
    (cell, weights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::Profile;

    /// A sheet whose ratios rise less towards its edges, and whose resistance is not the same
    /// everywhere.
    fn table() -> PositionTable {
        let profile = Profile::bundled("standard").expect("bundled");
        let point = |k: usize| {
            let (u, v) = ((k % 41) as f64 / 20.0 - 1.0, (k / 41) as f64 / 12.0 - 1.0);
            let (r_x, r_y) = ((1.2 * u).sin() * (1.0 - 0.1 * v * v), 0.8 * v.sin());
            Point { x: 400.0 * u, y: 220.0 * v, r_x, r_y, sheet: 0.05 + 0.02 * u * u + 0.01 * v }
        };
        PositionTable::fit(&profile, &(0..41 * 25).map(point).collect::<Vec<_>>())
            .expect("a raster")
    }

    #[test]
    fn conditions_are_the_slopes_of_a_look_up() {
        let (table, h) = (table(), 1e-6);
        for [r_x, r_y] in [[0.1, 0.2], [-0.6, 0.3], [0.7, -0.5]] {
            let at = table.look_up(r_x, r_y);
            let moved = [table.look_up(r_x + h, r_y), table.look_up(r_x, r_y + h)];
            let condition = table.condition(at.x, at.y).expect("a place");
            let near = |got: f64, expected: f64| (got - expected).abs() < 1e-4 * got.abs().max(1.0);
            for (k, moved) in moved.iter().enumerate() {
                assert!(
                    near(condition.place[0][k], (moved.x - at.x) / h),
                    "{condition:?}, {moved:?}"
                );
                assert!(
                    near(condition.place[1][k], (moved.y - at.y) / h),
                    "{condition:?}, {moved:?}"
                );
                assert!(
                    near(condition.sheet[k], (moved.sheet - at.sheet) / h),
                    "{condition:?}, {moved:?}"
                );
            }
        }
    }

    #[test]
    fn what_is_no_number_is_no_place() {
        assert!(!table().look_up(f64::NAN, f64::NAN).is_valid());
        assert!(!table().look_up(5.0, 5.0).is_valid());
    }
}
