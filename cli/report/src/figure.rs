// SPDX-License-Identifier: MIT OR Apache-2.0
//! A figure: a title, a legend, drawings, and a sentence on what to see in them.

pub use super::canvas::WIDTH;
use super::page::{anchor, escape};
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
    parts: Option<Parts>,
}

/// What a figure of plots consists of.
#[derive(Clone, Debug, Default)]
pub struct Parts {
    /// Entries of its legend.
    pub keys: Vec<Key>,
    /// The plots.
    pub drawings: Vec<Drawing>,
}

/// A plot of a figure.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    /// What sets it apart from the figure's others; empty where it is the only one.
    pub name: String,
    /// An `svg` element.
    pub svg: String,
    /// Its height, where its width is [`WIDTH`].
    pub height: u32,
}

/// An entry of a legend.
#[derive(Clone, Debug, Default)]
pub struct Key {
    /// What it names.
    pub name: String,
    /// An `svg` element, 28 wide and 14 high.
    pub swatch: String,
}

impl Figure {
    /// One plot; its legend follows from its series.
    pub fn plot(title: &str, note: &str, plot: &Plot) -> Figure {
        let figure = Figure::plots(title, note, &[(String::new(), plot.clone())]);
        Figure { body: plot.svg(), wide: false, ..figure }
    }

    /// Named plots beside each other, with one legend.
    pub fn plots(title: &str, note: &str, plots: &[(String, Plot)]) -> Figure {
        let mut keys: Vec<Key> = Vec::new();
        for (_, plot) in plots {
            let limit = plot.shows_limits().then(limit_key);
            for key in entries(&plot.series).into_iter().chain(limit) {
                if keys.iter().all(|known| known.name != key.name) {
                    keys.push(key);
                }
            }
        }
        let drawn = |(name, plot): &(String, Plot)| Drawing {
            name: name.clone(),
            svg: plot.svg(),
            height: plot.height,
        };
        let drawings: Vec<Drawing> = plots.iter().map(drawn).collect();
        let panel =
            |of: &Drawing| format!("<div>\n<p>{}</p>\n{}</div>\n", escape(&of.name), of.svg);
        let panels: String = drawings.iter().map(panel).collect();
        let body = format!("<div class=\"panels\">\n{panels}</div>\n");
        let legend = keys.iter().map(|of| key(&of.name, &of.swatch)).collect();
        Figure { parts: Some(Parts { keys, drawings }), ..Figure::wide(title, note, legend, body) }
    }

    /// Anything else, over the whole width; `legend` and `body` are HTML.
    pub fn wide(title: &str, note: &str, legend: String, body: String) -> Figure {
        Figure { title: title.into(), note: note.into(), legend, body, wide: true, parts: None }
    }

    /// Its title.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The sentence on what to see in it; empty where there is none.
    pub fn note(&self) -> &str {
        &self.note
    }

    /// What it consists of where all of it are plots; none of maps and tables.
    pub fn parts(&self) -> Option<&Parts> {
        self.parts.as_ref()
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
            "<figure id=\"{}\"{class}>\n<figcaption>{title}</figcaption>\n{legend}{}{note}</figure>\n",
            anchor(&self.title),
            self.body
        )
    }
}

fn limit_key() -> Key {
    Key { name: "limit".into(), swatch: line_swatch(&super::paint::Paint::LIMIT.stroke_class()) }
}

/// The legend of named series.
pub fn keys(series: &[Series]) -> String {
    entries(series).iter().map(|of| key(&of.name, &of.swatch)).collect()
}

fn entries(series: &[Series]) -> Vec<Key> {
    let named = series.iter().filter(|s| !s.name.is_empty());
    named.map(|s| Key { name: s.name.clone(), swatch: swatch(s) }).collect()
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
