// SPDX-License-Identifier: MIT OR Apache-2.0
//! Series of points, thinned to what the eye can tell apart.

use std::collections::HashSet;

use super::paint::Paint;
use super::select::mean;

/// A point in the axes' units; not finite where there is none.
pub type Point = (f64, f64);

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mark {
    /// A line of this width.
    Line(u32),
    /// Filled circles of this radius.
    Dots(u32),
    /// Open circles of this radius.
    Rings(u32),
    /// The area that the points enclose, lightly.
    Band,
}

/// Points that share a name, a colour and a mark.
#[derive(Clone, Debug)]
pub struct Series {
    /// Its name in the legend; none where another series stands for it.
    pub name: String,
    /// Colour and line style.
    pub paint: Paint,
    /// How it is drawn.
    pub mark: Mark,
    /// Points in the units of the axes.
    pub points: Vec<Point>,
    /// Half the length of each point's error bar, in units of the vertical axis; empty where no point
    /// has one.
    pub bars: Vec<f64>,
    /// A label at its last point.
    pub tag: Option<String>,
}

impl Series {
    /// A thin line.
    pub fn line(name: &str, paint: Paint, points: Vec<Point>) -> Series {
        Series {
            name: name.into(),
            paint,
            mark: Mark::Line(4),
            points,
            bars: Vec::new(),
            tag: None,
        }
    }

    /// A series drawn as dots.
    pub fn dots(name: &str, paint: Paint, points: Vec<Point>) -> Series {
        Series {
            name: name.into(),
            paint,
            mark: Mark::Dots(7),
            points,
            bars: Vec::new(),
            tag: None,
        }
    }

    /// Rings, which let a dot at the same place be seen.
    pub fn rings(name: &str, paint: Paint, points: Vec<Point>) -> Series {
        Series {
            name: name.into(),
            paint,
            mark: Mark::Rings(12),
            points,
            bars: Vec::new(),
            tag: None,
        }
    }

    /// The area that the points enclose.
    pub fn band(paint: Paint, points: Vec<Point>) -> Series {
        Series { name: String::new(), paint, mark: Mark::Band, points, bars: Vec::new(), tag: None }
    }

    /// With another mark.
    pub fn mark(self, mark: Mark) -> Series {
        Series { mark, ..self }
    }

    /// Each of some samples of a value as dots at their means, with a bar of ± one standard deviation
    /// where there are several.
    pub fn sampled<'a>(
        name: &str,
        paint: Paint,
        samples: impl IntoIterator<Item = &'a [Point]>,
    ) -> Series {
        let (points, bars) = samples.into_iter().map(mean_and_deviation).unzip();
        Series { bars, ..Series::dots(name, paint, points) }
    }

    /// With a label at its last point.
    pub fn tagged(self, tag: &str) -> Series {
        Series { tag: Some(tag.into()), ..self }
    }
}

/// The mean of a sample, and the standard deviation of its ordinates; none of a single one.
fn mean_and_deviation(sample: &[Point]) -> (Point, f64) {
    let y = || sample.iter().map(|p| p.1);
    let centre = (mean(sample.iter().map(|p| p.0)), mean(y()));
    let count = y().filter(|y| y.is_finite()).count();
    if count < 2 {
        return (centre, 0.0);
    }
    let square = mean(y().map(|y| (y - centre.1).powi(2)));
    (centre, (square * count as f64 / (count - 1) as f64).sqrt())
}

/// At most about `most` of the points, on a raster of `width` × `height`: one per cell, the cells
/// as fine as that allows.
pub fn thin_dots(points: &[(i32, i32)], most: usize) -> Vec<(i32, i32)> {
    let mut cell = 2;
    loop {
        let mut taken = HashSet::new();
        let kept: Vec<_> =
            points.iter().copied().filter(|(x, y)| taken.insert((x / cell, y / cell))).collect();
        if kept.len() <= most.max(1) {
            return kept;
        }
        cell += 1 + cell / 2;
    }
}

/// A line without the points that hardly show: its ends, and of neighbours that share a column of `width` the least and the
/// largest.
pub fn thin_line(points: &[(i32, i32)], width: i32) -> Vec<(i32, i32)> {
    let mut kept: Vec<(i32, i32)> = points.first().copied().into_iter().collect();
    for column in points.chunk_by(|a, b| a.0 / width == b.0 / width) {
        kept.extend(extremes(column));
    }
    kept.extend(points.last());
    kept.dedup();
    kept
}

/// Least and largest of a column, in their order.
fn extremes(column: &[(i32, i32)]) -> [(i32, i32); 2] {
    let height = |&i: &usize| column[i].1;
    let least = (0..column.len()).min_by_key(height).unwrap_or(0);
    let largest = (0..column.len()).max_by_key(height).unwrap_or(0);
    [least.min(largest), least.max(largest)].map(|index| column[index])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_keeps_its_peaks() {
        let points: Vec<_> =
            (0..100_000).map(|i| (i / 100, if i == 50_050 { 900 } else { i % 7 })).collect();
        let thin = thin_line(&points, 2);
        assert!(thin.len() <= 2000 + 4, "{}", thin.len());
        assert!(thin.contains(&(500, 900)));
        assert_eq!((thin[0], thin.last()), (points[0], points.last()));
    }

    #[test]
    fn a_bar_is_the_standard_deviation_of_a_sample() {
        let samples: [&[Point]; 3] =
            [&[(1.0, 2.0), (1.0, 4.0), (1.0, 6.0)], &[(2.0, 5.0)], &[(3.0, 1.0), (3.0, f64::NAN)]];
        let series = Series::sampled("", Paint::INK, samples);
        assert_eq!(series.points, [(1.0, 4.0), (2.0, 5.0), (3.0, 1.0)]);
        assert_eq!(series.bars, [2.0, 0.0, 0.0]);
    }

    #[test]
    fn dots_are_few_and_spread() {
        let points: Vec<_> = (0..100_000).map(|i| (i % 1000, i / 100)).collect();
        let thin = thin_dots(&points, 500);
        assert!((100..=500).contains(&thin.len()), "{}", thin.len());
        assert_eq!(thin_dots(&points[..5], 500).len(), 3, "one per two pixels");
    }
}
