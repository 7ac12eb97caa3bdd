// SPDX-License-Identifier: MIT OR Apache-2.0
//! Splines over the table's rectangle, fitted to points by least squares with a little smoothness, which
//! settles coefficients that no point does.
//!
//! Points mostly come line by line, several to a cell. What those of a line and a cell ask is added up along
//! x, three coefficients wide, before it is spread over the cell's nine.

use std::ops::Range;

use super::basis;
use crate::calibration::layout::{Axis, Layout};
use crate::calibration::least_squares::{Moments, RasterFit};

/// How much smoothness counts against nearness.
const SMOOTHNESS: f64 = 1e-7;

/// The cells of quadratic B-splines over the table's rectangle. Places are in cells of the ratios, from the
/// rectangle's corner.
pub(super) struct Spline {
    /// Cells along either axis.
    cells: [usize; 2],
    /// The middle of the table.
    middle: [f64; 2],
    /// What a cell of the ratios is of one of these.
    share: f64,
}

/// Points one after the other, on a line along x and within one cell.
struct Stretch {
    points: Range<usize>,
    /// The first of the cell's coefficients.
    first: usize,
    /// Of each of their three rows: the weight in the value and in the slope along y.
    rows: [[f64; 2]; 3],
}

impl Spline {
    /// Cells that are each as wide and high as `2^shift` of the ratios'.
    pub fn new(layout: &Layout, shift: u8) -> Self {
        let cells = |shift| [Axis::X, Axis::Y].map(|axis| layout.wider_cells(shift, axis));
        Spline {
            cells: cells(shift),
            middle: cells(0).map(|cells| cells as f64 / 2.0),
            share: 2f64.powi(-i32::from(shift)),
        }
    }

    /// Coefficients along either axis: columns and rows.
    fn size(&self) -> [usize; 2] {
        self.cells.map(|cells| cells + 2)
    }

    /// The coefficients that come nearest to points at these places; their values and how much each counts are
    /// asked for by their number. None where they do not settle all coefficients.
    pub fn fit<const LAYERS: usize>(
        &self,
        places: &[[f64; 2]],
        ask: impl Fn(usize) -> ([f64; LAYERS], f64),
    ) -> Option<[Vec<f64>; LAYERS]> {
        let (mut fit, mut total) = (RasterFit::<LAYERS>::new(self.size()), 0.0);
        for stretch in self.stretches(places) {
            let mut across = Moments::NONE;
            for point in stretch.points {
                let (values, importance) = ask(point);
                let (_, weights) = self.basis(Axis::X, places[point]);
                across.add(weights.map(|[weight, _]| weight), values, importance);
                total += importance;
            }
            fit.ask_square(stretch.first, stretch.rows.map(|[weight, _]| weight), &across);
        }
        let [columns, rows] = self.size();
        smooth(&mut fit, [columns, rows], SMOOTHNESS * total / (columns * rows) as f64);
        fit.solve()
    }

    /// How far each place moves with two surfaces of these coefficients, per unit of theirs: the norm of J⁻¹, in
    /// the unit in which `pitch` is the size of the ratios' cells. None where a place does not depend on them.
    pub fn sensitivities(
        &self,
        surfaces: &[Vec<f64>; 2],
        pitch: [f64; 2],
        places: &[[f64; 2]],
    ) -> Option<Vec<f64>> {
        let ([columns, _], pitch) = (self.size(), pitch.map(|pitch| pitch / self.share));
        let mut norms = Vec::with_capacity(places.len());
        for Stretch { points, first, rows } in self.stretches(places) {
            // Value and slope along y of the cell's columns of coefficients.
            let surfaces = surfaces.each_ref().map(|surface| {
                [0, 1, 2].map(|column| {
                    let at = |row: usize| surface[first + row * columns + column];
                    [0, 1].map(|kind| (0..3).map(|row| rows[row][kind] * at(row)).sum::<f64>())
                })
            });
            norms.extend(points.map(|point| {
                let (_, weights) = self.basis(Axis::X, places[point]);
                norm_of_inverse(surfaces.map(|columns| slopes(&columns, &weights)), pitch)
            }));
        }
        norms.iter().all(|norm| norm.is_finite()).then_some(norms)
    }

    /// The cell of a place along an axis; of its three coefficients the weight in the value and in the slope.
    #[inline(always)]
    fn basis(&self, axis: Axis, place: [f64; 2]) -> (usize, [[f64; 2]; 3]) {
        let axis = axis as usize;
        let cells = self.cells[axis];
        basis(self.share * (place[axis] - self.middle[axis]) + cells as f64 / 2.0, cells)
    }

    fn stretches<'a>(&'a self, places: &'a [[f64; 2]]) -> impl Iterator<Item = Stretch> + 'a {
        let column = |place: &[f64; 2]| self.basis(Axis::X, *place).0;
        let [columns, _] = self.size();
        let mut next = 0;
        std::iter::from_fn(move || {
            let start = next;
            let place = places.get(start)?;
            let (first, (row, rows)) = (column(place), self.basis(Axis::Y, *place));
            let goes_on = |at: &&[f64; 2]| at[1] == place[1] && column(at) == first;
            next += 1 + places[start + 1..].iter().take_while(goes_on).count();
            Some(Stretch { points: start..next, first: row * columns + first, rows })
        })
    }
}

/// The slopes along x and y, from value and slope along y of three columns and what the columns weigh.
fn slopes(columns: &[[f64; 2]; 3], weights: &[[f64; 2]; 3]) -> [f64; 2] {
    let sum = |kind: usize, of_weight: usize| {
        (0..3).map(|n| columns[n][kind] * weights[n][of_weight]).sum::<f64>()
    };
    [sum(0, 1), sum(1, 0)]
}

/// The norm of J⁻¹, from the slopes of two surfaces along x and y in cells, and the size of a cell.
fn norm_of_inverse([[ax, ay], [bx, by]]: [[f64; 2]; 2], [along, across]: [f64; 2]) -> f64 {
    let parts = [along * by, along * ay, across * ax, across * bx];
    let squares: f64 = parts.map(|part| part * part).iter().sum();
    squares.sqrt() / (ax * by - ay * bx).abs()
}

/// Asks that second differences along rows and columns be small.
fn smooth<const LAYERS: usize>(
    fit: &mut RasterFit<LAYERS>,
    [columns, rows]: [usize; 2],
    importance: f64,
) {
    let mut bend = |first: usize, step: usize| {
        fit.ask_line(first, step, [1.0, -2.0, 1.0], importance);
    };
    for first in 0..columns * rows {
        if first % columns + 2 < columns {
            bend(first, 1);
        }
        if first / columns + 2 < rows {
            bend(first, columns);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::Profile;

    /// Columns and rows of a raster.
    const PLACES: [usize; 2] = [91, 47];

    fn spline(shift: u8) -> Spline {
        Spline::new(&Layout::new(&Profile::bundled("small").expect("bundled")), shift)
    }

    fn places(spline: &Spline) -> Vec<[f64; 2]> {
        let [columns, rows] = PLACES;
        let place = |k: usize| {
            let at = [k % columns, k / columns];
            [0, 1]
                .map(|axis| 2.0 * spline.middle[axis] * at[axis] as f64 / (PLACES[axis] - 1) as f64)
        };
        (0..columns * rows).map(place).collect()
    }

    /// Two surfaces that such splines can be: one rises with x, one with y.
    fn values([x, y]: [f64; 2]) -> [f64; 2] {
        [0.02 * x - 1e-4 * x * y, 0.03 * y + 2e-4 * x * x]
    }

    #[test]
    fn surfaces_that_are_splines_come_back_whatever_the_order_of_points() {
        for shift in [0, 1, 2] {
            let spline = spline(shift);
            let mut places = places(&spline);
            let in_lines = spline.fit(&places, |k| (values(places[k]), 1.0)).expect("settled");
            // Points of a line and a cell are then no longer one after the other.
            places.sort_by_key(|place| (place[0] * 7919.0 + place[1] * 104_729.0) as u64 % 1009);
            let scattered = spline.fit(&places, |k| (values(places[k]), 1.0)).expect("settled");
            for (a, b) in in_lines.iter().flatten().zip(scattered.iter().flatten()) {
                assert!((a - b).abs() < 1e-9, "{shift}: {a}, {b}");
            }
            for (k, &place) in places.iter().enumerate().step_by(37) {
                let (column, across) = spline.basis(Axis::X, place);
                let (row, down) = spline.basis(Axis::Y, place);
                let first = row * spline.size()[0] + column;
                let at = |surface: &[f64]| -> f64 {
                    let term = |n: usize| {
                        let entry = first + n / 3 * spline.size()[0] + n % 3;
                        across[n % 3][0] * down[n / 3][0] * surface[entry]
                    };
                    (0..9).map(term).sum()
                };
                let read = in_lines.each_ref().map(|surface| at(surface));
                let off = (0..2).map(|n| (read[n] - values(place)[n]).abs()).fold(0.0, f64::max);
                assert!(off < 2e-5, "{shift}, {k}: {read:?}");
            }
        }
    }

    #[test]
    fn sensitivities_are_norms_of_the_inverse_whatever_the_cells() {
        for shift in [0, 1, 2] {
            let spline = spline(shift);
            let places = places(&spline);
            let surfaces = spline.fit(&places, |k| (values(places[k]), 1.0)).expect("settled");
            let pitch = [14.0, 11.0];
            let norms = spline.sensitivities(&surfaces, pitch, &places).expect("they differ");
            for (norm, [x, y]) in norms.iter().zip(&places).step_by(29) {
                let [ax, ay, bx, by] = [0.02 - 1e-4 * y, -1e-4 * x, 4e-4 * x, 0.03];
                let inverse = [pitch[0] * by, pitch[0] * ay, pitch[1] * bx, pitch[1] * ax];
                let exact = inverse.map(|part| part * part).iter().sum::<f64>().sqrt()
                    / (ax * by - ay * bx).abs();
                assert!((norm / exact - 1.0).abs() < 5e-3, "{shift}: {norm} for {exact}");
            }
        }
    }
}
