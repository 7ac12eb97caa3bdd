// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sheet as a map of coloured tiles.

use std::collections::BTreeMap;
use std::error::Error;

use plotters::prelude::{IntoDrawingArea as _, Rectangle, SVGBackend};
use plotters::style::Color as _;

use super::canvas::{inline, stroke};
use super::paint::Paint;
use hapticore_run::record::Record;

/// Half the sheet of the paper, mm, for a run that does not know its own.
const HALF_SHEET_MM: (f64, f64) = (430.0, 250.0);

/// Half the sheet of a run.
pub fn half_sheet_mm(record: &Record) -> (f64, f64) {
    record.sheet_mm.map_or(HALF_SHEET_MM, |[width, height]| (width / 2.0, height / 2.0))
}

/// Width of a map, in its own units.
const WIDTH: f64 = 860.0;

/// A value at a place: x and y in mm, the value.
pub type Place = (f64, f64, f64);

/// Cells by column and row, counted from the top left, each with its worst value.
type Cells = BTreeMap<(usize, usize), f64>;

/// Boundaries of the cells along an axis, ascending.
type Edges = Vec<f64>;

/// A map of a sheet, given half its size; `most` bounds its tiles, `paint` gives a value's colour.
pub fn map(
    about: &str,
    half: (f64, f64),
    places: &[Place],
    most: usize,
    paint: impl Fn(f64) -> Paint,
) -> String {
    let half = reach(half, places);
    let scale = WIDTH / (2.0 * half.0);
    let height = (2.0 * half.1 * scale) as u32;
    let (columns, rows) = edges(places, half, most);
    let cells = cells(places, &columns, &rows);
    let mut drawing = String::new();
    let pixel = |x: f64, y: f64| {
        (((x + half.0) * scale).round() as i32, ((half.1 - y) * scale).round() as i32)
    };
    let draw = |drawing: &mut String| -> Result<(), Box<dyn Error>> {
        let root = SVGBackend::with_string(drawing, (WIDTH as u32, height)).into_drawing_area();
        for (row, from, to, paint) in runs(&cells, &paint) {
            let corners = [pixel(columns[from], rows[row + 1]), pixel(columns[to + 1], rows[row])];
            root.draw(&Rectangle::new(corners, paint.sentinel().filled()))?;
        }
        root.draw(&Rectangle::new(
            [pixel(-half.0, half.1), pixel(half.0, -half.1)],
            stroke(Paint::MUTED, 3),
        ))?;
        root.present()?;
        Ok(())
    };
    draw(&mut drawing)
        .map_or_else(|e| e.to_string(), |()| inline(&drawing, about, WIDTH as u32, height))
}

/// Half of what is drawn.
fn reach(half: (f64, f64), places: &[Place]) -> (f64, f64) {
    let reach = |values: &mut dyn Iterator<Item = f64>| {
        values.filter(|v| v.is_finite()).fold(0.0, f64::max)
    };
    let x = reach(&mut places.iter().map(|p| p.0.abs()));
    let y = reach(&mut places.iter().map(|p| p.1.abs()));
    (half.0.max(x), half.1.max(y))
}

/// Boundaries between the places where these form a raster of at most `most` tiles, else a raster
/// of that many.
fn edges(places: &[Place], half: (f64, f64), most: usize) -> (Edges, Edges) {
    let xs = distinct(places.iter().map(|p| p.0));
    let ys = distinct(places.iter().map(|p| p.1));
    if xs.len() * ys.len() <= most {
        return (between(&xs, half.0), between(&ys, half.1));
    }
    let columns = (most as f64 * half.0 / half.1).sqrt().max(1.0) as usize;
    (even(columns, half.0), even((most / columns).max(1), half.1))
}

fn distinct(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut rounded: Vec<_> =
        values.filter(|v| v.is_finite()).map(|v| (v * 10.0).round() / 10.0).collect();
    rounded.sort_by(f64::total_cmp);
    rounded.dedup();
    rounded
}

/// The middles between values, and beyond the outer ones half a step more.
fn between(values: &[f64], half: f64) -> Edges {
    let step = |a: usize, b: usize| values.get(b).map_or(20.0, |v| (v - values[a]) / 2.0);
    let (Some(first), Some(last)) = (values.first(), values.last()) else {
        return even(1, half);
    };
    let inner = values.windows(2).map(|pair| (pair[0] + pair[1]) / 2.0);
    let low = (first - step(0, 1)).max(-half);
    let high = (last + values.len().checked_sub(2).map_or(20.0, |n| step(n, n + 1))).min(half);
    [low].into_iter().chain(inner).chain([high]).collect()
}

fn even(count: usize, half: f64) -> Edges {
    (0..=count).map(|n| half * (2.0 * n as f64 / count as f64 - 1.0)).collect()
}

fn cells(places: &[Place], columns: &[f64], rows: &[f64]) -> Cells {
    let index = |edges: &[f64], value: f64| {
        edges.partition_point(|e| *e <= value).saturating_sub(1).min(edges.len() - 2)
    };
    let mut cells = Cells::new();
    for (x, y, value) in
        places.iter().filter(|p| p.0.is_finite() && p.1.is_finite() && p.2.is_finite())
    {
        let worst = cells.entry((index(rows, *y), index(columns, *x))).or_insert(*value);
        if value.abs() > worst.abs() {
            *worst = *value;
        }
    }
    cells
}

/// Row, first and last column of neighbours with one colour.
fn runs(cells: &Cells, paint: &impl Fn(f64) -> Paint) -> Vec<(usize, usize, usize, Paint)> {
    let mut runs: Vec<(usize, usize, usize, Paint)> = Vec::new();
    for ((row, column), value) in cells {
        let paint = paint(*value);
        match runs.last_mut() {
            Some(run) if run.0 == *row && run.2 + 1 == *column && run.3 == paint => run.2 = *column,
            _ => runs.push((*row, *column, *column, paint)),
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_of_one_colour_are_one_tile() {
        let places: Vec<_> = (0..24)
            .flat_map(|x| (0..14).map(move |y| (f64::from(x), f64::from(y), f64::from(x / 12))))
            .collect();
        let svg = map("", HALF_SHEET_MM, &places, 1000, |v| Paint::diverging(v as i32));
        assert_eq!(svg.matches("<rect").count(), 2 * 14 + 1);
    }

    #[test]
    fn a_cell_shows_its_worst_value() {
        let cells = cells(&[(0.0, 0.0, 0.1), (1.0, 0.0, -2.0)], &even(1, 430.0), &even(1, 250.0));
        assert_eq!(cells[&(0, 0)], -2.0);
    }
}
