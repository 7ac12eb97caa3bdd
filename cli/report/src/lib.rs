// SPDX-License-Identifier: MIT OR Apache-2.0
//! The report of a run: one HTML page, with every figure inside it. One script tells values under the pointer; without it
//! the page reads as before. Its figures over two axes are also SVG
//! documents of their own.
//!
//! | module | what it makes |
//! | --- | --- |
//! | [`page`], [`tables`], [`words`] | the page, its tables, lines that the terminal shows, too |
//! | [`figure`], [`plot`], `frame`, [`map`](mod@map) | a figure, a plot over two axes and what stands around it, a map of the sheet |
//! | [`sheet`] | figures as an SVG document of its own |
//! | [`columns`] | any column of numbers over time |
//! | [`axis`], [`series`], [`paint`], `colours`, [`number`] | ticks, points, colours of both modes, numbers as text |
//! | `select`, `sweep` | rows by case, setting and pad; settings by load and voltage |
//! | `control`, `driven` | pads with a target force, and how far each is off it; targets and depths in walls over time |
//! | `fig3`, `fig4`, `fig6`, `fig7`, `fig9`, `fig13`, `fig15`, `hockey` | the figures of a scene |
//! | [`fig3_maps`] | maps of the sheet |
//! | `general`, `swept` | figures of any other run: over time, over what is swept |

pub mod axis;
mod bode;
mod canvas;
mod colours;
pub mod columns;
#[cfg(test)]
mod contrast;
mod control;
mod driven;
mod fig13;
mod fig15;
mod fig3;
pub mod fig3_maps;
mod fig4;
mod fig6;
mod fig7;
mod fig9;
pub mod figure;
mod frame;
mod general;
mod hockey;
mod laws;
pub mod map;
pub mod number;
mod over_time;
pub mod page;
pub mod paint;
pub mod plot;
#[cfg(test)]
mod reading;
mod select;
pub mod series;
pub mod sheet;
mod sweep;
mod swept;
pub mod tables;
#[cfg(test)]
mod tests;
pub mod words;

use figure::Figure;
use hapticore_run::record::Record;

/// The report of a run as a self-contained HTML page; `files` are those beside it.
pub fn html(record: &Record, files: &[String]) -> String {
    let drawn = if record.rows.is_empty() { Vec::new() } else { all_figures(record) };
    let findings = &record.findings;
    let found = [
        tables::flags(&findings.flagged, record.rows.len()),
        tables::tracking(&findings.tracking),
        tables::loops(record),
    ];
    let sections = [
        ("Criteria", tables::criteria(&record.criteria)),
        ("Flags and tracking", found.concat()),
        ("Figures", figures(&drawn)),
        ("Force loops", bode::table(record)),
        ("Effects: fidelity levels and computing time", tables::effects(&record.effects)),
        ("Rounding errors of the core's signals", tables::errors(&record.errors)),
        ("The run", tables::run(record)),
        ("Provenance", tables::provenance(record)),
        ("Files", tables::files(files)),
    ];
    let titles: Vec<_> = drawn.iter().map(Figure::title).collect();
    let body = sections.iter().map(|(title, body)| page::section(title, body));
    let head = page::heading(record) + &page::contents(&sections, &titles);
    page::document(&record.title, &(head + &body.collect::<String>()))
}

fn figures(drawn: &[Figure]) -> String {
    if drawn.is_empty() {
        return "<p class=\"note\">No slot was finished, so there is nothing to draw.</p>\n".into();
    }
    let figures: String = drawn.iter().map(Figure::html).collect();
    format!("<div class=\"figures\">\n{figures}</div>\n")
}

/// All figures of a run's report, in its order.
pub fn all_figures(record: &Record) -> Vec<Figure> {
    // A sweep goes from setting to setting, not on in time.
    let own = ["fig9", "fig15"].map(Some).contains(&record.figure.as_deref());
    let driven = if own || !record.swept.is_empty() { Vec::new() } else { driven::figures(record) };
    chosen(record).into_iter().chain(driven).chain(bode::figures(record)).collect()
}

/// The figures of the scene; where it names none, or a capture left no truth to compare with, every
/// quantity over what is swept or over time.
fn chosen(record: &Record) -> Vec<Figure> {
    let truth = record.rows.iter().any(|row| row.truth.is_some());
    match record.figure.as_deref().filter(|_| truth) {
        Some("fig3") => fig3::figures(record),
        Some("fig4") => fig4::figures(record),
        Some("fig6") => fig6::figures(record),
        Some("fig7") => fig7::figures(record),
        Some("fig9") => fig9::figures(record),
        Some("fig13") => fig13::figures(record),
        Some("fig15") => fig15::figures(record),
        Some("hockey") => hockey::figures(record),
        _ if truth && !record.swept.is_empty() => swept::figures(record),
        _ => general::figures(record),
    }
}
