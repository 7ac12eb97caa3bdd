// SPDX-License-Identifier: MIT OR Apache-2.0
//! What plots and maps are drawn on: `plotters` under our names, and its styles.

use std::error::Error;

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::{Cartesian2d, ChartContext, IntoFont as _, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, ShapeStyle, TextStyle};

use super::page::escape;
use super::paint::{self, Paint};

/// Width of every plot, in its own units.
pub const WIDTH: u32 = 1200;

/// Size of text; `plotters` divides by 1.24.
const TEXT: u32 = 46;

/// What a plot is drawn on.
pub type Area<'a> = plotters::drawing::DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// A drawing area within a plot.
pub type Chart<'a, 'b> =
    ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Whether something was drawn.
pub type Drawn = Result<(), Box<dyn Error>>;

/// A line's style.
pub fn stroke(paint: Paint, width: u32) -> ShapeStyle {
    paint.sentinel().stroke_width(width)
}

/// A text's style.
pub fn text(paint: Paint, horizontal: HPos, vertical: VPos) -> TextStyle<'static> {
    let font = ("sans-serif", TEXT).into_font();
    font.color(&paint.sentinel()).pos(Pos::new(horizontal, vertical))
}

/// A drawing as it stands in the page: classes instead of colours, its size left to the page.
pub fn inline(drawing: &str, about: &str, width: u32, height: u32) -> String {
    let inner = drawing.split_once('\n').map_or("", |(_, rest)| rest);
    let open = format!(
        "<svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{}\">\n",
        escape(about)
    );
    open + &paint::to_classes(inner)
}
