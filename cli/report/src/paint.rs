// SPDX-License-Identifier: MIT OR Apache-2.0
//! Colours that follow the reader's light or dark mode.
//!
//! `plotters` writes colours into every element. So the report passes sentinels, which carry an
//! index instead of a colour. Afterwards each becomes a class, and `colours.css` defines the index's
//! colour in either mode.

use plotters::style::RGBColor;

/// Marks a colour as a sentinel.
const SENTINEL: u8 = 0xA5;

/// Colours that tell series apart; beyond them, lines differ by their dashes.
pub const SERIES: usize = 8;

/// Steps of the diverging scale on either side of its middle.
pub const DIVERGING: i32 = 5;

/// Steps of the sequential scale.
pub const SEQUENTIAL: usize = 6;

/// How a line is interrupted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dash {
    /// Without dashes.
    Solid,
    /// Dashed line.
    Dashed,
    /// Dotted line.
    Dotted,
}

/// A colour of the style sheet and a dash.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Paint {
    index: u8,
    dash: Dash,
}

impl Paint {
    /// Text and the truth.
    pub const INK: Paint = Paint::solid(0);
    /// Colour of tick labels.
    pub const MUTED: Paint = Paint::solid(1);
    /// Colour of grid lines.
    pub const GRID: Paint = Paint::solid(2);
    /// What a criterion allows.
    pub const LIMIT: Paint = Paint::solid(3).dashed();

    const fn solid(index: u8) -> Paint {
        Paint { index, dash: Dash::Solid }
    }

    /// The colour of the n-th series.
    pub fn series(n: usize) -> Paint {
        let paint = Paint::solid(index(10, n % SERIES));
        match n / SERIES {
            0 => paint,
            1 => paint.dashed(),
            _ => paint.dotted(),
        }
    }

    /// A step of the scale around zero.
    pub fn diverging(step: i32) -> Paint {
        let step = step.clamp(-DIVERGING, DIVERGING) + DIVERGING;
        Paint::solid(index(30, usize::try_from(step).unwrap_or(0)))
    }

    /// A step of the scale from nothing to much.
    pub fn sequential(step: usize) -> Paint {
        Paint::solid(index(50, step.min(SEQUENTIAL - 1)))
    }

    /// The n-th of `count` lines in an order, from light to dark.
    pub fn ramp(n: usize, count: usize) -> Paint {
        let steps = SEQUENTIAL - 1;
        Paint::solid(index(
            60,
            (n * steps).checked_div(count.saturating_sub(1)).unwrap_or(steps).min(steps),
        ))
    }

    /// The same, dashed.
    pub const fn dashed(self) -> Paint {
        Paint { dash: Dash::Dashed, ..self }
    }

    /// The same, dotted.
    pub const fn dotted(self) -> Paint {
        Paint { dash: Dash::Dotted, ..self }
    }

    /// The colour to hand to `plotters`.
    pub fn sentinel(self) -> RGBColor {
        RGBColor(self.index, self.dash as u8, SENTINEL)
    }

    /// Classes of a stroke.
    pub fn stroke_class(self) -> String {
        format!("s k{}{}", self.index, dash_class(self.dash as u8))
    }

    /// Classes of a filled shape.
    pub fn fill_class(self) -> String {
        format!("f k{}", self.index)
    }
}

fn index(first: u8, offset: usize) -> u8 {
    first + u8::try_from(offset).expect("scales are short")
}

fn dash_class(dash: u8) -> &'static str {
    ["", " dash", " dot"][usize::from(dash).min(2)]
}

/// Turns the sentinels of a drawing into classes, and drops attributes that say nothing.
pub fn to_classes(svg: &str) -> String {
    svg.lines().map(|line| element(line) + "\n").collect()
}

fn element(line: &str) -> String {
    let mut line = line.replace(" opacity=\"1\"", "");
    for noise in [" fill=\"none\"", " stroke=\"none\"", " font-family=\"sans-serif\""] {
        line = line.replace(noise, "");
    }
    if let Some((range, index, _)) = sentinel(&line, " fill=\"#") {
        line.replace_range(range, &format!(" class=\"f k{index}\""));
        line = line.replace(" stroke-width=\"1\"", "");
    }
    if let Some((range, index, dash)) = sentinel(&line, " stroke=\"#") {
        line.replace_range(range, &format!(" class=\"s k{index}{}\"", dash_class(dash)));
    }
    line
}

/// Where an attribute holds a sentinel, and what it carries.
fn sentinel(line: &str, attribute: &str) -> Option<(std::ops::Range<usize>, u8, u8)> {
    let start = line.find(attribute)?;
    let digits = start + attribute.len();
    let colour = line.get(digits..digits + 6)?;
    let byte = |at: usize| u8::from_str_radix(colour.get(at..at + 2)?, 16).ok();
    (byte(4)? == SENTINEL).then_some(())?;
    Some((start..digits + 7, byte(0)?, byte(2)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentinels_become_classes() {
        let line = "<polyline fill=\"none\" opacity=\"1\" stroke=\"#0B01A5\" stroke-width=\"4\" points=\"1,2 \"/>";
        assert_eq!(
            to_classes(line),
            "<polyline class=\"s k11 dash\" stroke-width=\"4\" points=\"1,2 \"/>\n"
        );
        let text = "<text fill=\"#0000A5\">\n#ff0000\n</text>";
        assert_eq!(to_classes(text), "<text class=\"f k0\">\n#ff0000\n</text>\n");
    }

    #[test]
    fn the_classes_of_a_legend_are_those_of_the_drawing() {
        assert_eq!(Paint::series(9).stroke_class(), "s k11 dash");
        assert_eq!(Paint::diverging(-9).fill_class(), "f k30");
    }
}
