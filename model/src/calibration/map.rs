// SPDX-License-Identifier: MIT OR Apache-2.0
//! The map's curves and tables, fitted to points of known place.

use super::least_squares::Fit;
use crate::blocks::map::{Curve, Layout, Map as Block};
use crate::profile::Profile;

/// A place on the sheet and what is read there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Millimetres from the middle, along the long edges.
    pub x: f64,
    /// Millimetres from the middle, along the short edges.
    pub y: f64,
    /// Eq. 2.
    pub r_x: f64,
    /// Eq. 3.
    pub r_y: f64,
    /// The sheet's resistance at the place, in full scales of voltage per current.
    pub sheet: f64,
}

/// From ratios to place: the numbers of [`crate::blocks::map`].
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// The ratios in the middle of their box.
    pub origin: [f64; 2],
    /// One over half the box.
    pub scale: [f64; 2],
    /// The words of curves and tables, as fractions.
    pub words: Vec<f64>,
    layout: Layout,
}

/// Points that no map can be made from.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MapError {
    /// They are no raster.
    #[error("expected two or more whole rows of two or more places, got {points} places in rows of {columns}")]
    Raster {
        /// Places in a row.
        columns: usize,
        /// Places.
        points: usize,
    },
    /// Ratios do not tell places apart.
    #[error("expected ratios that tell the places apart: finite, and rising with x and with y")]
    Ambiguous,
}

/// What the box is wider than the points, so that noise at an edge stays within.
const MARGIN: f64 = 1.0 + 1.0 / 64.0;
/// What straightened and evened coordinates leave at either end, for noise and for the corners between two nodes.
const ROOM: f64 = 1.0 + 1.0 / 24.0;
/// How much smoothness counts against nearness.
const SMOOTHNESS: f64 = 1e-3;

impl Map {
    /// Fits a raster of points: `columns` to a row, the first and last rows and columns being the edges of the area.
    ///
    /// # Errors
    /// Where the points are not two or more whole rows of two or more, or their ratios do not tell places apart.
    pub fn fit(profile: &Profile, columns: usize, points: &[Point]) -> Result<Map, MapError> {
        let rows = points.len().checked_div(columns).unwrap_or(0);
        if columns < 2 || rows < 2 || rows * columns != points.len() {
            return Err(MapError::Raster { columns, points: points.len() });
        }
        let layout = Layout::new(profile);
        let mut map = Map::boxed(layout, points);
        let boxed: Vec<[f64; 2]> = points.iter().map(|point| map.in_box(point.r_x, point.r_y)).collect();
        let row = |row: usize| (0..columns).map(|k| boxed[row * columns + k]).collect::<Vec<_>>();
        map.straighten(Curve::MiddleY, Curve::StretchY, &row(0), &row(rows - 1));
        let span = half_span(points.iter().map(|point| point.y));
        let t: Vec<_> = boxed.iter().map(|&p| map.straight(Curve::MiddleY, Curve::StretchY, p[0], p[1])).collect();
        let column = |first: usize| (first..points.len()).step_by(columns);
        let even = |first: usize| column(first).map(|k| [t[k], points[k].y / span]).collect::<Vec<_>>();
        map.space(Curve::SpacingY, &(0..columns).map(even).collect::<Vec<_>>());
        let v: Vec<_> = t.iter().map(|&t| map.curve(Curve::SpacingY, t)).collect();
        let edge = |first: usize| column(first).map(|k| [v[k], boxed[k][0]]).collect::<Vec<_>>();
        map.straighten(Curve::MiddleX, Curve::StretchX, &edge(0), &edge(columns - 1));
        let span = half_span(points.iter().map(|point| point.x));
        let straight = |k: usize| map.straight(Curve::MiddleX, Curve::StretchX, v[k], boxed[k][0]);
        let q: Vec<_> = (0..points.len()).map(straight).collect();
        let even =
            |row: usize| (row * columns..(row + 1) * columns).map(|k| [q[k], points[k].x / span]).collect::<Vec<_>>();
        map.space(Curve::SpacingX, &(0..rows).map(even).collect::<Vec<_>>());
        let uv: Vec<_> = q.iter().zip(v).map(|(&q, v)| [map.curve(Curve::SpacingX, q), v]).collect();
        map.tabulate(&uv, points)?;
        if map.words.iter().chain(&map.scale).all(|word| word.is_finite()) { Ok(map) } else { Err(MapError::Ambiguous) }
    }

    fn boxed(layout: Layout, points: &[Point]) -> Map {
        let of = |ratio: fn(&Point) -> f64| {
            let (low, high) = points.iter().map(ratio).fold((f64::MAX, f64::MIN), |(l, h), r| (l.min(r), h.max(r)));
            ((low + high) / 2.0, 2.0 / (high - low) / MARGIN)
        };
        let (x, y) = (of(|point| point.r_x), of(|point| point.r_y));
        Map { origin: [x.0, y.0], scale: [x.1, y.1], words: vec![0.0; layout.words()], layout }
    }

    fn in_box(&self, r_x: f64, r_y: f64) -> [f64; 2] {
        [(r_x - self.origin[0]) * self.scale[0], (r_y - self.origin[1]) * self.scale[1]]
    }

    /// Curves that take two opposite edges, each points of (along, across), to −1 and 1.
    fn straighten(&mut self, middle: Curve, stretch: Curve, one: &[[f64; 2]], other: &[[f64; 2]]) {
        let entries = self.layout.entries(middle);
        let (one, other) = (sorted(one), sorted(other));
        for k in 0..entries {
            let along = 2.0 * k as f64 / (entries - 1) as f64 - 1.0;
            let (a, b) = (across(&one, along), across(&other, along));
            self.words[self.layout.curve(middle) + k] = (a + b) / 2.0;
            let unit = 2f64.powi(Block::STRETCH_BITS.into());
            self.words[self.layout.curve(stretch) + k] = (2.0 / (a - b).abs() / ROOM / unit).min(1.0);
        }
    }

    /// A curve that takes straightened coordinates to evenly spaced ones: the mean over lines of points from one edge to the
    /// other, each (straightened, even). Lines are averaged, not points fitted, because points lie in rows and columns, and a
    /// curve finer than those would follow their steps.
    fn space(&mut self, curve: Curve, lines: &[Vec<[f64; 2]>]) {
        let lines: Vec<_> = lines.iter().map(|line| sorted(line)).collect();
        let (offset, entries) = (self.layout.curve(curve), self.layout.entries(curve));
        for k in 0..entries {
            let t = 2.0 * k as f64 / (entries - 1) as f64 - 1.0;
            let mean = lines.iter().map(|line| across(line, t)).sum::<f64>() / lines.len() as f64;
            self.words[offset + k] = (mean / ROOM).clamp(-1.0, 1.0);
        }
    }

    /// Tables of x, y and the sheet's resistance over evenly spaced coordinates.
    fn tabulate(&mut self, uv: &[[f64; 2]], points: &[Point]) -> Result<(), MapError> {
        let side = self.layout.side();
        let mut fit = Fit::new(side * side, 3);
        let full = 2f64.powi(Profile::POSITION_BITS.into());
        for ([u, v], point) in uv.iter().zip(points) {
            let values = [point.x / full, point.y / full, point.sheet];
            fit.ask(&corners(*u, *v, side), &values, 1.0);
        }
        let importance = SMOOTHNESS * points.len() as f64 / (side * side) as f64;
        for line in 0..side {
            for k in 1..side - 1 {
                for (start, step) in [(line * side, 1), (line, side)] {
                    let at = |k: usize| start + k * step;
                    fit.ask(&[(at(k - 1), 1.0), (at(k), -2.0), (at(k + 1), 1.0)], &[0.0; 3], importance);
                }
            }
        }
        let offset = self.layout.table(0);
        self.words[offset..].copy_from_slice(fit.solve().ok_or(MapError::Ambiguous)?.as_slice());
        Ok(())
    }

    fn curve(&self, curve: Curve, at: f64) -> f64 {
        let terms = pair(self.layout.curve(curve), at, self.layout.entries(curve));
        terms.iter().map(|&(k, weight)| weight * self.words[k]).sum()
    }

    fn straight(&self, middle: Curve, stretch: Curve, along: f64, across: f64) -> f64 {
        let unit = 2f64.powi(Block::STRETCH_BITS.into());
        (across - self.curve(middle, along)) * self.curve(stretch, along) * unit
    }

    /// The place and the sheet's resistance for a pair of ratios, in floating point.
    pub fn look_up(&self, r_x: f64, r_y: f64) -> [f64; 3] {
        let [p_x, p_y] = self.in_box(r_x, r_y);
        let v = self.curve(Curve::SpacingY, self.straight(Curve::MiddleY, Curve::StretchY, p_x, p_y));
        let u = self.curve(Curve::SpacingX, self.straight(Curve::MiddleX, Curve::StretchX, v, p_x));
        let terms = corners(u, v, self.layout.side());
        let layer = |layer: usize| {
            let offset = self.layout.table(layer);
            terms.iter().map(|&(k, weight)| weight * self.words[offset + k]).sum::<f64>()
        };
        let full = 2f64.powi(Profile::POSITION_BITS.into());
        [layer(0) * full, layer(1) * full, layer(2)]
    }
}

fn half_span(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |span, value| value.abs().max(span))
}

/// An edge's points from one end to the other.
fn sorted(edge: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut edge = edge.to_vec();
    edge.sort_by(|a, b| a[0].total_cmp(&b[0]));
    edge
}

/// The edge's place across: linear between its points and, by the outermost two, beyond.
fn across(edge: &[[f64; 2]], along: f64) -> f64 {
    let next = edge.partition_point(|point| point[0] < along).clamp(1, edge.len() - 1);
    let ([x0, y0], [x1, y1]) = (edge[next - 1], edge[next]);
    y0 + (y1 - y0) * (along - x0) / (x1 - x0)
}

/// The two entries of a table over −1 … 1 about a coordinate, with their weights.
fn pair(offset: usize, at: f64, entries: usize) -> [(usize, f64); 2] {
    let place = (at + 1.0) / 2.0 * (entries - 1) as f64;
    let cell = place.floor().clamp(0.0, (entries - 2) as f64);
    let weight = (place - cell).clamp(0.0, 1.0);
    [(offset + cell as usize, 1.0 - weight), (offset + cell as usize + 1, weight)]
}

/// The four nodes about a place, with their weights.
fn corners(u: f64, v: f64, side: usize) -> [(usize, f64); 4] {
    let ([left, right], [above, below]) = (pair(0, u, side), pair(0, v, side));
    let node = |(row, a): (usize, f64), (column, b): (usize, f64)| (row * side + column, a * b);
    [node(above, left), node(above, right), node(below, left), node(below, right)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fit(columns: usize, points: usize, r: f64) -> Result<Map, MapError> {
        let place = |k: usize| ((k % columns.max(1)) as f64, (k / columns.max(1)) as f64);
        let point = |(x, y): (f64, f64)| Point { x, y, r_x: r * x, r_y: r * y, sheet: 0.0 };
        let points: Vec<_> = (0..points).map(place).map(point).collect();
        Map::fit(&Profile::bundled("small").expect("bundled"), columns, &points)
    }

    #[test]
    fn points_that_make_no_map_are_refused() {
        assert!(fit(9, 81, 0.1).is_ok());
        for (columns, points) in [(0, 0), (1, 5), (9, 80), (9, 9)] {
            assert_eq!(fit(columns, points, 0.1), Err(MapError::Raster { columns, points }));
        }
        assert_eq!(fit(9, 81, 0.0), Err(MapError::Ambiguous), "the same ratios everywhere");
        assert_eq!(fit(9, 81, f64::NAN), Err(MapError::Ambiguous));
    }
}
