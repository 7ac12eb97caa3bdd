// SPDX-License-Identifier: MIT OR Apache-2.0
//! The page around tables and figures.

use hapticore_run::record::Record;

const STYLE: &str = concat!(include_str!("colours.css"), include_str!("report.css"));

/// Values under the pointer, and a closer look; without it the page reads as before.
const SCRIPT: &str = include_str!("report.js");

/// Text as it may stand in an element or an attribute.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            c if c.is_control() && !c.is_whitespace() => escaped.push('\u{fffd}'),
            c => escaped.push(c),
        }
    }
    escaped
}

/// The document of a title with these contents.
pub fn document(title: &str, main: &str) -> String {
    let title = escape(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\" />\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\" />\n\
         <meta name=\"color-scheme\" content=\"light dark\" />\n\
         <title>{title} – hapticore</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n{main}</main>\n<script>\n//<![CDATA[\n{SCRIPT}//]]>\n</script>\n</body>\n</html>\n"
    )
}

/// Title, what ran, and what it is about.
pub fn heading(record: &Record) -> String {
    let fact = |name: &str, value: &str| format!("<li>{name} <b>{}</b></li>", escape(value));
    let facts =
        [("scene", &record.scene), ("profile", &record.profile), ("core", &record.fidelity)];
    let facts: String = facts.iter().map(|(name, value)| fact(name, value)).collect();
    let (title, summary) = (escape(&record.title), escape(record.summary.trim()));
    let warnings = warnings(&record.warnings);
    format!(
        "<header>\n<h1>{title}</h1>\n<ul class=\"facts\">{facts}</ul>\n{warnings}<p>{summary}</p>\n</header>\n"
    )
}

/// What its reader must know first.
pub fn warnings(warnings: &[String]) -> String {
    warnings.iter().map(|text| format!("<p class=\"warning\">⚠ {}</p>\n", escape(text))).collect()
}

/// A section; nothing where it would be empty.
pub fn section(title: &str, body: &str) -> String {
    if body.is_empty() {
        return String::new();
    }
    format!("<section id=\"{}\">\n<h2>{}</h2>\n{body}</section>\n", anchor(title), escape(title))
}

/// The name by which a title's place in the page is linked.
pub fn anchor(title: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    title.chars().map(plain).collect()
}

/// Links to the sections that are there, and to figures.
pub fn contents(sections: &[(&str, String)], figures: &[&str]) -> String {
    let link =
        |title: &str| format!("<li><a href=\"#{}\">{}</a></li>", anchor(title), escape(title));
    let of_figures: String = figures.iter().map(|title| link(title)).collect();
    let item = |(title, body): &(&str, String)| match *title {
        _ if body.is_empty() => String::new(),
        "Figures" if figures.len() > 1 => {
            link("Figures").replace("</li>", &format!("<ul>{of_figures}</ul></li>"))
        }
        title => link(title),
    };
    let items: String = sections.iter().map(item).collect();
    format!("<nav aria-label=\"Contents\"><ul>{items}</ul></nav>\n")
}
