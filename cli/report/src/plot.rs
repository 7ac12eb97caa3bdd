// SPDX-License-Identifier: MIT OR Apache-2.0
//! A plot of series over two axes, drawn by `plotters`.
//!
//! Drawn 1200 units wide, so that its text stays legible when a phone shows it at a third of that;
//! the style sheet makes the text smaller where there is room.

use std::error::Error;

use plotters::element::{Circle, PathElement, Polygon, Text};
use plotters::prelude::{ChartBuilder, IntoDrawingArea as _, SVGBackend};
use plotters::style::Color as _;
use plotters::style::text_anchor::{HPos, VPos};

use super::axis::Axis;
use super::canvas::{Area, Chart, Drawn, WIDTH, inline, stroke, text};
use super::frame::{self, Frame};
use super::page::escape;
use super::series::{Mark, Point, Series, thin_dots, thin_line};

/// Width to reserve for a character.
const CHARACTER: usize = 21;

/// Dots that all series of a plot share.
const DOTS: usize = 2400;

/// How much of its colour a band has.
const BAND: f64 = 0.3;

/// Half the width of an error bar's ends.
const END: i32 = 7;

/// Columns that all lines of a plot share.
const COLUMNS: usize = 2400;

/// A plot: axes, series, legend and title.
#[derive(Clone, Debug)]
pub struct Plot {
    /// What it shows, for readers who do not see it.
    pub about: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What is drawn, from back to front.
    pub series: Vec<Series>,
    /// Values of y that deserve a line of their own: limits.
    pub limits: Vec<f64>,
    /// Values of x where something ends and something else begins.
    pub breaks: Vec<f64>,
    /// Height where the width is 1200.
    pub height: u32,
    /// Plots that share what one of them may draw, so that a page of many stays small.
    pub share: usize,
    /// Characters that the labels of the vertical axis have room for at least, so that plots above
    /// each other line up.
    pub label_characters: usize,
}

impl Plot {
    /// A plot without limits and breaks, of the usual height.
    pub fn new(about: &str, x: Axis, y: Axis, series: Vec<Series>) -> Plot {
        Plot {
            about: about.into(),
            x,
            y,
            series,
            limits: Vec::new(),
            breaks: Vec::new(),
            height: 720,
            share: 1,
            label_characters: 0,
        }
    }

    /// Whether any limit lies within what is drawn.
    pub fn shows_limits(&self) -> bool {
        let (low, high) = self.y.range();
        self.limits.iter().any(|v| (low..=high).contains(&self.y.place(*v)))
    }

    /// The drawing, or why there is none.
    pub fn svg(&self) -> String {
        let mut drawing = String::new();
        match self.draw(&mut drawing) {
            Ok(places) => {
                inline(&drawing, &self.about, WIDTH, self.height).replacen("<svg ", &places, 1)
            }
            Err(error) => {
                format!("<p class=\"note\">Not drawn: {}</p>\n", escape(&error.to_string()))
            }
        }
    }

    /// Draws; the start of the `svg` element, with what a script needs to read values off it.
    fn draw(&self, drawing: &mut String) -> Result<String, Box<dyn Error>> {
        let root = SVGBackend::with_string(drawing, (WIDTH, self.height)).into_drawing_area();
        let chart = self.chart(&root)?;
        frame::draw(&root, &chart, &self.frame())?;
        for series in &self.series {
            self.series(&root, &chart, series)?;
        }
        self.tags(&root, &chart)?;
        root.present()?;
        Ok(self.places(&chart))
    }

    /// The `svg` element's start: of each axis its title, its least and largest value and where these lie.
    fn places(&self, chart: &Chart) -> String {
        let (x, y) = (self.x.range(), self.y.range());
        let [start, end] = [(x.0, y.0), (x.1, y.1)].map(|at| chart.backend_coord(&at));
        let logs = [(&self.x, "x"), (&self.y, "y")]
            .map(|(axis, name)| if axis.is_log() { name } else { "" });
        let [x_title, y_title] = [&self.x, &self.y].map(|axis| escape(&axis.title));
        format!(
            "<svg data-x=\"{} {} {} {}\" data-y=\"{} {} {} {}\" data-log=\"{}\" data-x-title=\"{x_title}\" \
             data-y-title=\"{y_title}\" ",
            x.0,
            x.1,
            start.0,
            end.0,
            y.0,
            y.1,
            start.1,
            end.1,
            logs.concat()
        )
    }

    fn frame(&self) -> Frame<'_> {
        let Plot { x, y, limits, breaks, height, .. } = self;
        Frame { x, y, limits, breaks, height: *height }
    }

    fn chart<'a, 'b>(&self, root: &'a Area<'b>) -> Result<Chart<'a, 'b>, Box<dyn Error>> {
        let (x, y) = (self.x.range(), self.y.range());
        let mut builder = ChartBuilder::on(root);
        builder
            .margin_top(if self.y.title.is_empty() { 12 } else { 64 })
            .margin_right(self.tag_width())
            .margin_bottom(48);
        builder.x_label_area_size(56).y_label_area_size(self.label_width());
        Ok(builder.build_cartesian_2d(x.0..x.1, y.0..y.1)?)
    }

    fn label_width(&self) -> u32 {
        let longest = self.y.longest_label().max(self.label_characters);
        u32::try_from(longest * CHARACTER + 24).unwrap_or(200)
    }

    fn tag_width(&self) -> u32 {
        let tags = self.series.iter().filter_map(|s| s.tag.as_ref());
        let longest = tags.map(|t| t.chars().count()).max().unwrap_or(0);
        u32::try_from(longest * CHARACTER + 30).unwrap_or(200)
    }

    fn series(&self, root: &Area, chart: &Chart, series: &Series) -> Drawn {
        let runs = self.runs(chart, &series.points);

        match series.mark {
            Mark::Line(width) => {
                for run in runs {
                    root.draw(&PathElement::new(
                        thin_line(&run, self.column()),
                        stroke(series.paint, width),
                    ))?;
                }
            }
            Mark::Band => {
                for run in runs {
                    root.draw(&Polygon::new(run, series.paint.sentinel().mix(BAND)))?;
                }
            }
            Mark::Dots(radius) | Mark::Rings(radius) => {
                let rings = matches!(series.mark, Mark::Rings(_));
                let style =
                    if rings { stroke(series.paint, 3) } else { series.paint.sentinel().filled() };
                let dots = thin_dots(&runs.concat(), self.dots_each());
                self.bars(root, chart, series, &dots)?;
                for at in dots {
                    root.draw(&Circle::new(at, radius, style))?;
                }
            }
        }
        Ok(())
    }

    /// The error bars of the dots that are drawn, as far as they lie within the axes; with ends where
    /// they are longer than the dots.
    fn bars(&self, root: &Area, chart: &Chart, series: &Series, dots: &[(i32, i32)]) -> Drawn {
        let (low, high) = self.y.range();
        for (point, bar) in series.points.iter().zip(&series.bars) {
            let x = self.x.place(point.0);
            let at = |y: f64| chart.backend_coord(&(x, self.y.place(y).clamp(low, high)));
            let drawn = self.runs(chart, &[*point]).concat().iter().any(|at| dots.contains(at));
            let (below, above) = (at(point.1 - bar), at(point.1 + bar));
            if !drawn || below == above {
                continue;
            }
            let end = |(x, y): (i32, i32)| vec![(x - END, y), (x + END, y)];
            let ends =
                if below.1 - above.1 > 3 * END { vec![end(below), end(above)] } else { vec![] };
            for line in [vec![below, above]].into_iter().chain(ends) {
                root.draw(&PathElement::new(line, stroke(series.paint, 2)))?;
            }
        }
        Ok(())
    }

    /// Width of a column in which a line keeps its extremes.
    fn column(&self) -> i32 {
        let lines = self.series.iter().filter(|s| matches!(s.mark, Mark::Line(_))).count();
        i32::try_from(WIDTH as usize * lines * self.share / COLUMNS).unwrap_or(2).max(2)
    }

    /// Dots that each series may have.
    fn dots_each(&self) -> usize {
        let dotted = |s: &&Series| matches!(s.mark, Mark::Dots(_) | Mark::Rings(_));
        let series = self.series.iter().filter(dotted).count();
        (DOTS / (series.max(1) * self.share)).min(900)
    }

    /// The points in units of the drawing, in runs between those that have no place within the
    /// axes.
    fn runs(&self, chart: &Chart, points: &[Point]) -> Vec<Vec<(i32, i32)>> {
        let places: Vec<_> =
            points.iter().map(|(x, y)| (self.x.place(*x), self.y.place(*y))).collect();
        let within = |(x, y): &(f64, f64)| self.x.shows(*x) && self.y.shows(*y);
        let runs = places.split(|place| !within(place)).filter(|run| !run.is_empty());
        runs.map(|run| run.iter().map(|place| chart.backend_coord(place)).collect()).collect()
    }

    /// Labels at the series' ends, moved apart where they would overlap.
    fn tags(&self, root: &Area, chart: &Chart) -> Drawn {
        let mut ends = Vec::new();
        for series in &self.series {
            let last = self.runs(chart, &series.points).last().and_then(|run| run.last().copied());
            if let (Some(tag), Some(at)) = (&series.tag, last) {
                ends.push((at, tag, series.paint));
            }
        }
        ends.sort_by_key(|((_, y), _, _)| *y);
        let heights: Vec<_> = ends.iter().map(|((_, y), _, _)| *y).collect();
        for (((x, _), tag, paint), y) in
            ends.into_iter().zip(apart(&heights, i32::try_from(self.height)?))
        {
            root.draw(&Text::new(tag.clone(), (x + 22, y), text(paint, HPos::Left, VPos::Center)))?;
        }
        Ok(())
    }
}

/// Heights at least a line apart, in the same order, above the bottom.
fn apart(heights: &[i32], bottom: i32) -> Vec<i32> {
    const LINE: i32 = 40;
    let mut placed: Vec<i32> = Vec::new();
    for height in heights {
        placed.push(placed.last().map_or(*height, |above| (*height).max(above + LINE)));
    }
    let mut floor = bottom - 130;
    for height in placed.iter_mut().rev() {
        *height = (*height).min(floor);
        floor = *height - LINE;
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::apart;

    #[test]
    fn labels_do_not_overlap() {
        assert_eq!(apart(&[100, 105, 300], 720), [100, 140, 300]);
        assert_eq!(apart(&[600, 610, 615], 720), [510, 550, 590]);
    }
}
