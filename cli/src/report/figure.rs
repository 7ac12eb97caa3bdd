// SPDX-License-Identifier: MIT OR Apache-2.0
//! A figure: a title, a legend, drawings, and a sentence on what to see in them.

use super::page::escape;
use super::plot::Plot;
use super::series::{Mark, Series};

/// A figure, its body as HTML.
#[derive(Clone, Debug, Default)]
pub struct Figure {
    title: String,
    note: String,
    legend: String,
    body: String,
    wide: bool,
}

impl Figure {
    /// One plot; its legend follows from its series.
    pub fn plot(title: &str, note: &str, plot: &Plot) -> Figure {
        let mut legend = keys(&plot.series);
        if plot.shows_limits() {
            legend += &key("limit", &line_swatch(&super::paint::Paint::LIMIT.stroke_class()));
        }
        Figure { title: title.into(), note: note.into(), legend, body: plot.svg(), wide: false }
    }

    /// Anything else, over the whole width; `legend` and `body` are HTML.
    pub fn wide(title: &str, note: &str, legend: String, body: String) -> Figure {
        Figure { title: title.into(), note: note.into(), legend, body, wide: true }
    }

    /// The figure as HTML.
    pub fn html(&self) -> String {
        let class = if self.wide { " class=\"wide\"" } else { "" };
        let (title, note) = (escape(&self.title), escape(&self.note));
        let legend = if self.legend.is_empty() {
            String::new()
        } else {
            format!("<ul class=\"legend\">{}</ul>\n", self.legend)
        };
        let note =
            if note.is_empty() { String::new() } else { format!("<p class=\"note\">{note}</p>\n") };
        format!(
            "<figure{class}>\n<figcaption>{title}</figcaption>\n{legend}{}{note}</figure>\n",
            self.body
        )
    }
}

/// The legend of named series.
pub fn keys(series: &[Series]) -> String {
    let named = series.iter().filter(|s| !s.name.is_empty());
    named.map(|s| key(&s.name, &swatch(s))).collect()
}

/// An entry of a legend.
pub fn key(name: &str, swatch: &str) -> String {
    format!("<li>{swatch}{}</li>", escape(name))
}

fn swatch(series: &Series) -> String {
    match series.mark {
        Mark::Line(_) => line_swatch(&series.paint.stroke_class()),
        Mark::Dots(_) | Mark::Band => svg(&format!(
            "<circle cx=\"14\" cy=\"7\" r=\"4\" class=\"{}\"/>",
            series.paint.fill_class()
        )),
        Mark::Rings(_) => {
            let class = series.paint.stroke_class();
            svg(&format!(
                "<circle cx=\"14\" cy=\"7\" r=\"5\" stroke-width=\"1.6\" class=\"{class}\"/>"
            ))
        }
    }
}

fn line_swatch(class: &str) -> String {
    svg(&format!(
        "<line x1=\"1\" y1=\"7\" x2=\"27\" y2=\"7\" stroke-width=\"2.4\" class=\"small {class}\"/>"
    ))
}

/// A filled square for a step of a scale.
pub fn box_swatch(class: &str) -> String {
    svg(&format!("<rect x=\"4\" y=\"0\" width=\"20\" height=\"14\" class=\"{class}\"/>"))
}

fn svg(inner: &str) -> String {
    format!("<svg class=\"key\" viewBox=\"0 0 28 14\" aria-hidden=\"true\">{inner}</svg>")
}
