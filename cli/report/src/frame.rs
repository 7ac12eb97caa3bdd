// SPDX-License-Identifier: MIT OR Apache-2.0
//! What stands around a plot's series: grid, ticks, titles, limits, breaks.

use plotters::element::{PathElement, Text};
use plotters::style::text_anchor::{HPos, VPos};

use super::axis::Axis;
use super::canvas::{Area, Chart, Drawn, WIDTH, stroke, text};
use super::paint::Paint;

/// Between an axis and its labels.
const GAP: i32 = 10;

/// What is drawn around series.
pub struct Frame<'a> {
    /// The horizontal axis.
    pub x: &'a Axis,
    /// The vertical axis.
    pub y: &'a Axis,
    /// Values of y with a line of their own.
    pub limits: &'a [f64],
    /// Values of x with a line of their own.
    pub breaks: &'a [f64],
    /// Height where the width is [`WIDTH`].
    pub height: u32,
}

/// Draws all of it.
pub fn draw(root: &Area, chart: &Chart, plot: &Frame) -> Drawn {
    let (x, y) = (plot.x.range(), plot.y.range());
    let (left, bottom) = chart.backend_coord(&(x.0, y.0));
    let (right, top) = chart.backend_coord(&(x.1, y.1));
    for (value, label) in plot.y.ticks() {
        let at = chart.backend_coord(&(x.0, value)).1;
        line(root, [(left, at), (right, at)], Paint::GRID, 2)?;
        root.draw(&Text::new(
            label,
            (left - GAP, at),
            text(Paint::MUTED, HPos::Right, VPos::Center),
        ))?;
    }
    for (value, label) in plot.x.ticks() {
        let at = chart.backend_coord(&(value, y.0)).0;
        line(root, [(at, bottom), (at, bottom + 8)], Paint::MUTED, 2)?;
        root.draw(&Text::new(
            label,
            (at, bottom + GAP),
            text(Paint::MUTED, HPos::Center, VPos::Top),
        ))?;
    }
    line(root, [(left, bottom), (right, bottom)], Paint::MUTED, 2)?;
    for at in inside(plot.limits.iter().map(|v| plot.y.place(*v)), y) {
        let at = chart.backend_coord(&(x.0, at)).1;
        line(root, [(left, at), (right, at)], Paint::LIMIT, 3)?;
    }
    for at in inside(plot.breaks.iter().map(|v| plot.x.place(*v)), x) {
        let at = chart.backend_coord(&(at, y.0)).0;
        line(root, [(at, top), (at, bottom)], Paint::MUTED.dotted(), 3)?;
    }
    titles(root, plot)
}

fn titles(root: &Area, plot: &Frame) -> Drawn {
    let end = (i32::try_from(WIDTH)? - 2, i32::try_from(plot.height)? - 4);
    root.draw(&Text::new(plot.y.title.clone(), (2, 2), text(Paint::INK, HPos::Left, VPos::Top)))?;
    root.draw(&Text::new(plot.x.title.clone(), end, text(Paint::INK, HPos::Right, VPos::Bottom)))?;
    Ok(())
}

fn inside(values: impl Iterator<Item = f64>, range: (f64, f64)) -> Vec<f64> {
    values.filter(|v| (range.0..=range.1).contains(v)).collect()
}

fn line(root: &Area, ends: [(i32, i32); 2], paint: Paint, width: u32) -> Drawn {
    Ok(root.draw(&PathElement::new(ends.to_vec(), stroke(paint, width)))?)
}
