// SPDX-License-Identifier: MIT OR Apache-2.0
//! The report of a run: one HTML page without scripts, with every figure inside it.
//!
//! | module | what it makes |
//! | --- | --- |
//! | `page`, `tables` | the page, its tables |
//! | `figure`, `plot`, `frame`, `map` | a figure, a plot over two axes and what stands around it, a map of the sheet |
//! | `axis`, `series`, `paint`, `number` | ticks, points, colours of both modes, numbers as text |
//! | `select`, `sweep` | rows by case, setting and pad; settings by load and voltage |
//! | `control` | pads with a target force, and how far each is off it |
//! | `fig3`, `fig4`, `fig6`, `fig7`, `fig9`, `fig13`, `fig15`, `hockey` | the figures of a scene |
//! | `calibration` | the page of a device's calibration |
//! | `tradeoff` | the page of what accuracy costs |
//! | `sweep_plan` | the page of a plan of many points |
//! | `general`, `swept` | those of any other: over time, over what is swept |

mod axis;
mod bode;
mod calibration;
mod canvas;
#[cfg(test)]
mod contrast;
mod control;
mod fig13;
mod fig15;
mod fig3;
mod fig3_maps;
mod fig4;
mod fig6;
mod fig7;
mod fig9;
mod figure;
mod frame;
mod general;
mod hockey;
mod laws;
mod map;
mod number;
mod page;
mod paint;
mod plot;
mod select;
mod series;
mod sweep;
pub mod sweep_plan;
mod swept;
mod tables;
#[cfg(test)]
mod tests;
mod tradeoff;

pub use calibration::of_calibration;
use figure::Figure;
use hapticore_run::record::Record;
pub use sweep_plan::of_sweep;
pub use tradeoff::of_tradeoff;

/// The report of a run as a self-contained HTML page.
pub fn html(record: &Record) -> String {
    let figures = figures(record);
    let cost = tables::effects(&record.effects, record.wall_seconds);
    let body = [
        page::heading(record),
        page::section("Criteria", &tables::criteria(&record.criteria)),
        page::section("Flags and tracking", &tables::findings(record)),
        page::section("Figures", &figures),
        page::section("Force loops", &bode::table(record)),
        page::section("Effects: fidelity levels and computing time", &cost),
        page::section("Rounding errors of the core's signals", &tables::errors(&record.errors)),
        page::section("The run", &tables::run(record)),
    ];
    page::document(&record.title, &body.concat())
}

fn figures(record: &Record) -> String {
    if record.rows.is_empty() {
        return "<p class=\"note\">No slot was finished, so there is nothing to draw.</p>\n".into();
    }
    let figures: String =
        chosen(record).iter().chain(&bode::figures(record)).map(Figure::html).collect();
    format!("<div class=\"figures\">\n{figures}</div>\n")
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
