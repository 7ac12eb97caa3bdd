// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fitting a position table to points of known place.
//!
//! Splines by least squares ([`Spline::fit`]).

use super::PositionTable;
use super::spline::Spline;
use crate::calibration::layout::{Axis, Layout, Scalar, Surface};
use crate::calibration::least_squares::Moments;
use crate::profile::Profile;
use hapticore_hdl::format::Format;

/// A place on the sheet and what is read there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Millimetres from the middle, along the long edges.
    pub x: f64,
    /// Millimetres from the middle, along the short edges.
    pub y: f64,
    /// Ratio of eq. 2 that is read at the place.
    pub r_x: f64,
    /// Ratio of eq. 3 that is read at the place.
    pub r_y: f64,
    /// The sheet's resistance at the place, in full scales of voltage per current.
    pub sheet: f64,
}

/// Points that no position table can be made from.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PositionError {
    /// They do not span an area.
    #[error("expected places that span an area, got {points} places over {width} × {height} mm")]
    Area {
        /// Number of positions.
        points: usize,
        /// Their extent along the long edges, mm.
        width: f64,
        /// Their extent along the short edges, mm.
        height: f64,
    },
    /// The area is larger than the table's words can say, or too far off.
    #[error("expected places within ± {most} mm of the origin, got x or y = {got} mm")]
    Range {
        /// The largest coordinate that the format can represent, mm.
        most: f64,
        /// The coordinate, mm.
        got: f64,
    },
    /// The table's cells are larger than its words can say.
    #[error(
        "expected cells of less than {most} mm, got {got:.0} mm: choose a table with more columns or rows"
    )]
    Coarse {
        /// The table's words represent cells smaller than this, mm.
        most: f64,
        /// Size of the cells over these positions, mm.
        got: f64,
    },
    /// Ratios do not tell places apart.
    #[error(
        "expected ratios that tell the places apart: finite, and different wherever the places are"
    )]
    Ambiguous,
}

/// By how much of a cell the table reaches beyond the points, so that noise at their edge does not
/// end at the table's.
const BEYOND: f64 = 0.25;
/// The largest coefficient of a normalised ratio.
const FULL: f64 = 0.97;

impl PositionTable {
    /// Fits points, which may lie anywhere; the table spans the rectangle about them and a little
    /// more.
    ///
    /// Ratios are fitted by least squares, a point counting as much as its place depends on them
    /// (the norm of J⁻¹, from a first fit in which all count alike).
    ///
    /// ```
    /// use hapticore_contract::calibration::{Point, PositionError, PositionTable};
    /// use hapticore_contract::profile::Profile;
    ///
    /// // All places on one line.
    /// let point = |k: i32| Point { x: f64::from(k), y: 0.0, r_x: f64::from(k) / 10.0, r_y: 0.0, sheet: 0.0 };
    /// let line: Vec<_> = (-5..=5).map(point).collect();
    /// let error = PositionTable::fit(&Profile::bundled("small")?, &line).unwrap_err();
    /// assert_eq!(error, PositionError::Area { points: 11, width: 10.0, height: 0.0 });
    /// # Ok::<(), hapticore_contract::profile::ProfileError>(())
    /// ```
    ///
    /// # Errors
    /// Where the points span no area or one beyond the words' range, or their ratios do not tell
    /// places apart.
    pub fn fit(profile: &Profile, points: &[Point]) -> Result<PositionTable, PositionError> {
        let finite = |point: &Point| {
            [point.x, point.y, point.r_x, point.r_y, point.sheet].iter().all(|x| x.is_finite())
        };
        if !points.iter().all(finite) {
            return Err(PositionError::Ambiguous);
        }
        let layout = Layout::new(profile);
        let mut table = PositionTable {
            words: vec![0.0; layout.words()],
            layout,
            ratios: [Vec::new(), Vec::new()],
            resistance: Vec::new(),
            geometry: [[0.0; 2]; 2],
            scales: [[0.0, 1.0]; 2],
            start: [[0.0; 3]; 2],
            open_share: 0.0,
        };
        table.span(profile, points)?;
        let places: Vec<_> = points.iter().map(|point| table.place([point.x, point.y])).collect();
        table.fit_surfaces(&places, points).ok_or(PositionError::Ambiguous)?;
        table.scale(profile.formats.table);
        table.fit_start(&places, points)?;
        table.set_words(profile);
        if table.words.iter().all(|word| word.is_finite()) {
            Ok(table)
        } else {
            Err(PositionError::Ambiguous)
        }
    }

    /// The table's rectangle, in numbers that its words hold.
    fn span(&mut self, profile: &Profile, points: &[Point]) -> Result<(), PositionError> {
        let extents = [|point: &Point| point.x, |point: &Point| point.y]
            .map(|of| extent(points.iter().map(of)));
        let [width, height] = extents.map(|[low, high]| high - low);
        let area = width > 0.0 && height > 0.0 && points.len() >= 4;
        if !area {
            return Err(PositionError::Area { points: points.len(), width, height });
        }
        let (word, most) = (profile.formats.table, range(profile));
        let unit = most * 2.0 / Layout::CELLS * word.lsb();
        for (axis, [low, high]) in [Axis::X, Axis::Y].into_iter().zip(extents) {
            let cells = self.layout.cells(Surface::RatioX, axis) as f64;
            let (pitch, got) = ((high - low) / (cells - 2.0 * BEYOND), low.abs().max(high.abs()));
            if got + BEYOND * pitch > most {
                return Err(PositionError::Range { most, got });
            }
            let widest = 2.0 * most / Layout::CELLS;
            if pitch >= widest {
                return Err(PositionError::Coarse { most: widest, got: pitch });
            }
            let origin = ((low + high) / 2.0 / (most * word.lsb())).round() * most * word.lsb();
            self.geometry[axis as usize] = [origin, (pitch / unit).ceil() * unit];
        }
        Ok(())
    }

    /// The coefficients of all surfaces; none where the points do not settle them, or do not depend on
    /// the ratios.
    fn fit_surfaces(&mut self, places: &[[f64; 2]], points: &[Point]) -> Option<()> {
        let [narrow, wide] = [0, self.layout.shift()].map(|shift| Spline::new(&self.layout, shift));
        let read = |point: usize| [points[point].r_x, points[point].r_y];
        let pitch = self.geometry.map(|[_, pitch]| pitch);
        let alike = narrow.fit(places, |point| (read(point), 1.0))?;
        let importance = narrow.sensitivities(&alike, pitch, places)?;
        let ratios = narrow.fit(places, |point| (read(point), importance[point]))?;
        let [resistance] = wide.fit(places, |point| ([points[point].sheet], 1.0))?;
        (self.ratios, self.resistance) = (ratios, resistance);
        Some(())
    }

    /// Centres and gains that take the coefficients into the words' range, as words of the table
    /// hold them.
    fn scale(&mut self, word: Format) {
        let rounded = |x: f64| word.real(word.code_saturating(x));
        for (ratio, scale) in self.ratios.iter().zip(&mut self.scales) {
            let [low, high] = extent(ratio.iter().copied());
            let gain = (FULL / ((high - low) / 2.0)).min(Layout::GAIN) / Layout::GAIN;
            *scale = [2.0 * rounded((low + high) / 4.0), Layout::GAIN * rounded(gain)];
        }
    }

    /// The first guess, by least squares over all points.
    fn fit_start(&mut self, places: &[[f64; 2]], points: &[Point]) -> Result<(), PositionError> {
        let mut guess = Moments::NONE;
        for (place, point) in places.iter().zip(points) {
            let [r_x, r_y] = self.normalised([point.r_x, point.r_y]);
            let from_middle =
                [place[0] - self.cells(Axis::X) / 2.0, place[1] - self.cells(Axis::Y) / 2.0];
            guess.add([1.0, r_x, r_y], from_middle, 1.0);
        }
        self.start = guess.solve().ok_or(PositionError::Ambiguous)?;
        Ok(())
    }

    /// The words, in their order in the memory.
    fn set_words(&mut self, profile: &Profile) {
        let range = range(profile);
        for axis in [Axis::X, Axis::Y] {
            let ([origin, pitch], [centre, gain]) =
                (self.geometry[axis as usize], self.scales[axis as usize]);
            let [constant, of_x, of_y] =
                self.start[axis as usize].map(|guess| guess / Layout::CELLS / 4.0);
            let scalars = [
                (Scalar::Gain, gain / Layout::GAIN),
                (Scalar::Centre, centre / 2.0),
                (Scalar::StartConstant, -constant),
                (Scalar::StartRatioX, of_x),
                (Scalar::StartRatioY, of_y),
                (Scalar::Pitch, pitch * Layout::CELLS / 2.0 / range),
                (Scalar::Origin, -origin / range),
            ];
            scalars
                .into_iter()
                .for_each(|(scalar, word)| self.words[self.layout.scalar(scalar, axis)] = word);
        }
        for (surface, k) in [(Surface::RatioX, 0), (Surface::RatioY, 1)] {
            let [centre, gain] = self.scales[k];
            let words = self.ratios[k].iter().map(|ratio| (ratio - centre) * gain);
            self.words.splice(
                range_of(self.layout.surface(surface), self.ratios[k].len()),
                words.collect::<Vec<_>>(),
            );
        }
        let from = self.layout.surface(Surface::Resistance);
        self.words[from..].copy_from_slice(&self.resistance);
    }

    /// Each point's distance from where the table finds it, in mm; infinite where it finds none.
    pub fn errors<'a>(&'a self, points: &'a [Point]) -> impl Iterator<Item = f64> + 'a {
        points.iter().map(|point| {
            let found = self.look_up(point.r_x, point.r_y);
            if found.is_valid() {
                (found.x - point.x).hypot(found.y - point.y)
            } else {
                f64::INFINITY
            }
        })
    }
}

/// The largest magnitude of a position, mm.
fn range(profile: &Profile) -> f64 {
    let position = profile.formats.position;
    position.real(position.max_code() as i64 + 1)
}

fn range_of(from: usize, count: usize) -> std::ops::Range<usize> {
    from..from + count
}

/// The least and the greatest.
fn extent(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn raster(columns: usize, rows: usize, r: f64) -> Vec<Point> {
        let place = |k: usize| ((k % columns) as f64, (k / columns) as f64);
        let point = |(x, y): (f64, f64)| Point { x, y, r_x: r * x, r_y: r * y, sheet: 0.0 };
        (0..columns * rows).map(place).map(point).collect()
    }

    fn fit(points: &[Point]) -> Result<PositionTable, PositionError> {
        PositionTable::fit(&Profile::bundled("small").expect("bundled"), points)
    }

    #[test]
    fn points_that_make_no_table_are_refused() {
        assert!(fit(&raster(9, 9, 0.1)).is_ok());
        assert!(matches!(fit(&raster(9, 1, 0.1)), Err(PositionError::Area { .. })));
        assert!(matches!(fit(&[]), Err(PositionError::Area { .. })));
        let far: Vec<_> = raster(9, 9, 0.1)
            .into_iter()
            .map(|point| Point { x: point.x + 2000.0, ..point })
            .collect();
        assert!(matches!(fit(&far), Err(PositionError::Range { .. })));
        assert_eq!(
            fit(&raster(9, 9, 0.0)),
            Err(PositionError::Ambiguous),
            "the same ratios everywhere"
        );
        assert_eq!(fit(&raster(9, 9, f64::NAN)), Err(PositionError::Ambiguous));
    }

    /// Terminals with large resistances in series leave ratios that hardly differ, and others that
    /// do not have their middle at zero.
    #[test]
    fn words_span_their_range_whatever_the_ratios_span() {
        for (r, offset) in [(0.1, 0.0), (0.01, 0.3), (0.005, -0.6)] {
            let shifted =
                |point: Point| Point { r_x: point.r_x + offset, r_y: point.r_y - offset, ..point };
            let points: Vec<_> = raster(9, 9, r).into_iter().map(shifted).collect();
            let table = fit(&points).expect("a table");
            let coefficients =
                &table.words[table.layout.surface(Surface::RatioX)..][..table.ratios[0].len()];
            let [low, high] = extent(coefficients.iter().copied());
            assert!(
                low > -1.0 && high < 1.0 && high - low > 0.3,
                "{low} to {high} of ratios rising by {r}"
            );
            let worst = table.errors(&points).fold(0.0, f64::max);
            assert!(worst < 1e-5, "{worst} mm");
        }
    }

    #[test]
    fn a_linear_sheet_is_found_exactly() {
        let points = raster(9, 9, 0.1);
        let table = fit(&points).expect("a table");
        let worst = table.errors(&points).fold(0.0, f64::max);
        assert!(worst < 1e-5, "{worst} mm");
    }
}
