// SPDX-License-Identifier: MIT OR Apache-2.0
//! Figures as an SVG document of its own, one below the other: for notebooks and for files.
//!
//! ```text
//! title
//! legend: swatch name   swatch name
//! drawing, as in the report
//! note
//! ```
//!
//! Rules of a style sheet name each colour itself. Programs that draw SVG for print know no variables.

use std::fmt::Write;

use super::colours::{Colours, STYLE, modes};
use super::figure::{Figure, Key, Parts, WIDTH};
use super::page::escape;

/// For which readers a document is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Modes {
    /// Colours follow the reader's light or dark mode.
    Both,
    /// Light colours: for print.
    Light,
}

/// Width at which a document is shown first, CSS pixels.
const SHOWN: u32 = 720;
/// Height of a line of text, and of a legend's line.
const LINE: u32 = 40;
/// Width to reserve for a character.
const CHARACTER: u32 = 15;
/// Width of a legend's swatch, and of the spaces beside it.
const SWATCH: [u32; 3] = [56, 12, 30];
/// Between a figure and the next.
const GAP: u32 = 40;

/// The figures of plots, below each other; none where no figure is.
pub fn svg(figures: &[Figure], modes: Modes) -> Option<String> {
    let mut sheet = Sheet::default();
    for figure in figures {
        if let Some(parts) = figure.parts() {
            sheet.figure(figure, parts);
        }
    }
    (sheet.height > 0).then(|| sheet.document(modes))
}

/// A document in the making.
#[derive(Default)]
struct Sheet {
    body: String,
    height: u32,
}

impl Sheet {
    fn figure(&mut self, figure: &Figure, parts: &Parts) {
        if self.height > 0 {
            self.height += GAP;
        }
        self.line(figure.title(), "title f k0");
        self.legend(&parts.keys);
        for drawing in &parts.drawings {
            if !drawing.name.is_empty() {
                self.line(&drawing.name, "f k0");
            }
            self.place(&drawing.svg, [0, WIDTH, drawing.height]);
            self.height += drawing.height;
        }
        for line in wrapped(figure.note(), (WIDTH / CHARACTER) as usize) {
            self.line(&line, "f k1");
        }
    }

    fn line(&mut self, text: &str, class: &str) {
        self.height += LINE;
        self.text([2, self.height - 10], text, class);
    }

    fn text(&mut self, [x, y]: [u32; 2], text: &str, class: &str) {
        let text = escape(text);
        let _ = writeln!(self.body, "<text x=\"{x}\" y=\"{y}\" class=\"{class}\">{text}</text>");
    }

    /// Places an `svg` element below what is there.
    fn place(&mut self, element: &str, [x, width, height]: [u32; 3]) {
        let inner = element.strip_prefix("<svg ").unwrap_or(element);
        let y = self.height;
        let _ = writeln!(
            self.body,
            "<svg x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" {inner}"
        );
    }

    fn legend(&mut self, keys: &[Key]) {
        let (mut x, [swatch, before, behind]) = (0, SWATCH);
        for key in keys {
            let width = swatch + before + CHARACTER * key.name.chars().count() as u32 + behind;
            if x > 0 && x + width > WIDTH {
                (x, self.height) = (0, self.height + LINE);
            }
            self.place(&key.swatch, [x, swatch, swatch / 2]);
            self.text([x + swatch + before, self.height + 24], &key.name, "f k0");
            x += width;
        }
        self.height += if keys.is_empty() { 0 } else { LINE };
    }

    fn document(&self, modes: Modes) -> String {
        let (height, shown) = (self.height, SHOWN * self.height / WIDTH);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"hapticore\" viewBox=\"0 0 {WIDTH} {height}\" width=\"{SHOWN}\" \
             height=\"{shown}\">\n<style>\n{}</style>\n<rect class=\"page\" width=\"{WIDTH}\" height=\"{height}\"/>\n{}</svg>\n",
            style(modes),
            self.body
        )
    }
}

/// The rules of a document.
fn style(of: Modes) -> String {
    let [light, dark] = modes();
    let classes = STYLE.rsplit_once("fill: none;").expect("strokes").1;
    let (caps, dashes) = classes.split_once('}').expect("a rule's end");
    let mut style = format!(
        ".hapticore {{ font-family: system-ui, \"Segoe UI\", Roboto, \"Helvetica Neue\", Arial, sans-serif }}\n\
         .hapticore text {{ font-size: 28px }}\n.hapticore .title {{ font-weight: 600 }}\n.hapticore .s {{ fill: none;{caps}}}"
    );
    for rule in dashes.lines().filter(|rule| rule.starts_with('.')) {
        let _ = write!(style, "\n.hapticore {rule}");
    }
    style += "\n";
    style += &colours(&light);
    if of == Modes::Both {
        let _ = writeln!(style, "@media (prefers-color-scheme: dark) {{\n{}}}", colours(&dark));
    }
    style
}

/// Rules of all colours.
fn colours(of: &Colours) -> String {
    let mut rules = format!(".hapticore .page {{ fill: #{} }}\n", of["page"]);
    let classes = of.iter().filter(|(name, _)| name.starts_with('k'));
    for (name, colour) in classes {
        let _ = writeln!(
            rules,
            ".hapticore .f.{name} {{ fill: #{colour} }} .hapticore .s.{name} {{ stroke: #{colour} }}"
        );
    }
    rules
}

/// Lines of at most so many characters, broken between words.
fn wrapped(text: &str, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + word.chars().count() < most => {
                *line += " ";
                *line += word;
            }
            _ => lines.push(word.into()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Axis;
    use crate::paint::Paint;
    use crate::plot::Plot;
    use crate::series::Series;

    fn figure(title: &str) -> Figure {
        let points = vec![(0.0, 1.0), (1.0, 2.0)];
        let axis = |title| Axis::linear(title, [0.0, 2.0]);
        let series = vec![Series::line("a & b", Paint::series(1).dashed(), points)];
        let mut plot = Plot::new("about", axis("time (s)"), axis("F (N)"), series);
        plot.limits = vec![1.5];
        Figure::plot(title, "What to see.", &plot)
    }

    #[test]
    fn a_document_is_well_formed_and_has_title_legend_drawing_and_note() {
        let figures = [figure("one <1>"), figure("two")];
        let text = svg(&figures, Modes::Both).expect("plots");
        let document = roxmltree::Document::parse(&text).expect("well-formed");
        let texts: Vec<_> = document.descendants().filter_map(|node| node.text()).collect();
        for part in ["one <1>", "two", "a & b", "limit", "What to see."] {
            assert!(texts.iter().any(|text| text.trim() == part), "{part}");
        }
        assert!(text.contains("stroke: #f2440f") && text.contains("prefers-color-scheme: dark"));
        let drawing = &figures[0].parts().expect("a plot").drawings[0].svg;
        let lines = |text: &str| text.lines().filter(|of| of.contains("<polyline")).count();
        assert_eq!(lines(&text), 2 * lines(drawing));
    }

    #[test]
    fn a_document_for_print_has_neither_variables_nor_a_dark_mode() {
        let text = svg(&[figure("one")], Modes::Light).expect("a plot");
        assert!(!text.contains("var(") && !text.contains("@media"), "{text}");
        assert!(text.contains(".hapticore .dash { stroke-dasharray: 14 12"), "{text}");
    }

    #[test]
    fn figures_without_a_plot_make_no_document() {
        let table = Figure::wide("table", "", String::new(), "<p>x</p>".into());
        assert_eq!(svg(&[table], Modes::Both), None);
        assert_eq!(svg(&[], Modes::Both), None);
    }

    #[test]
    fn notes_break_between_words() {
        assert_eq!(wrapped("one two three", 8), ["one two", "three"]);
        assert_eq!(wrapped("", 8), Vec::<String>::new());
    }
}
