// SPDX-License-Identifier: MIT OR Apache-2.0
//! The page of a tradeoff: errors over bits and over area, what they are made of, and predicted
//! against measured ones.

use super::axis::Axis;
use super::figure::Figure;
use super::number;
use super::page::{self, escape};
use super::paint::Paint;
use super::plot::Plot;
use super::series::{Mark, Series};
use super::tables;
use crate::tradeoff::{
    NEXT_BIT, OF_ONE, SYNTHESISED, front, loop_error, looped, next_bit_rows, prediction,
    synthesised_rows,
};
use hapticore_tradeoff::cost::Family;
use hapticore_tradeoff::errors::Quantity;
use hapticore_tradeoff::knobs::Knob;
use hapticore_tradeoff::loops::LoopErrors;
use hapticore_tradeoff::outcome::Tradeoff;
use hapticore_tradeoff::sweep::Point;

/// The page.
pub fn of_tradeoff(tradeoff: &Tradeoff) -> String {
    let title = format!("What accuracy costs: {}", tradeoff.profile);
    let about = format!(
        "Each point is the profile with one word longer or shorter, or another window, tried on {} slots each of {}. Errors are those of the core against the ideal estimator, RMS; in force loops, and of pads that are served part by part, against the loop that the ideal core closes.",
        tradeoff.slots,
        tradeoff.scenes.join(", ")
    );
    let found = tradeoff.found.as_ref().map_or(String::new(), |found| {
        format!("<p>{}</p>\n", escape(&found.text()).replace('\n', "<br />\n"))
    });
    let figures: String = Quantity::ALL
        .iter()
        .enumerate()
        .flat_map(|(n, quantity)| {
            let error =
                Measured { of: quantity.name(), unit: quantity.unit(), rms: Rms::OfSlots(n) };
            [over_bits(tradeoff, &error), over_area(tradeoff, n, *quantity)]
        })
        .chain(of_loops(tradeoff).iter().map(|error| over_bits(tradeoff, error)))
        .chain([agreement(tradeoff)])
        .map(|figure| figure.html())
        .collect();
    let body = [
        format!("<header>\n<h1>{}</h1>\n<p>{}</p>\n</header>\n", escape(&title), escape(&about)),
        page::section("The cheapest profile", &found),
        page::section("Figures", &format!("<div class=\"figures\">\n{figures}</div>\n")),
        page::section("What one more bit would buy", &next_bits(tradeoff)),
        page::section("What synthesis makes of it", &synthesised(tradeoff)),
        page::section("What the predicted errors are made of", &sources(tradeoff)),
        page::section("All points", &points(tradeoff)),
    ];
    page::document(&title, &body.concat())
}

/// A measured error that is drawn over word lengths.
struct Measured {
    of: &'static str,
    unit: &'static str,
    rms: Rms,
}

/// Which of a point's errors, by its place.
#[derive(Clone, Copy)]
enum Rms {
    OfSlots(usize),
    OfLoops(usize),
}

impl Rms {
    fn of(self, point: &Point) -> Option<f64> {
        match self {
            Rms::OfSlots(n) => Some(point.measured[n].rms),
            Rms::OfLoops(n) => Some(point.looped.all()[n]?.rms),
        }
    }
}

/// Those of force loops and split pads, where there are any.
fn of_loops(tradeoff: &Tradeoff) -> Vec<Measured> {
    let error = |(n, _): (usize, &str)| Measured {
        of: ["force in the loop", "drive", "direction"][n],
        unit: LoopErrors::QUANTITIES[n].1,
        rms: Rms::OfLoops(n),
    };
    looped(&tradeoff.points).into_iter().map(error).collect()
}

/// Errors of one quantity over each knob's values, rising, the profile itself among its neighbours.
fn by_knob(tradeoff: &Tradeoff, error: &Measured) -> Vec<(Knob, Vec<(f64, f64)>)> {
    let curve = |knob: Knob| {
        let place = |point: &Point, value: u64| Some((value as f64, error.rms.of(point)?));
        let own = tradeoff.points.iter().filter(|point| point.knob == knob.key());
        let mut curve: Vec<_> = own.filter_map(|point| place(point, point.value)).collect();
        let itself = tradeoff.points.iter().filter(|point| point.knob.is_empty());
        curve.extend(itself.filter_map(|point| place(point, knob.value(&point.profile))));
        curve.sort_by(|a, b| a.0.total_cmp(&b.0));
        (knob, curve)
    };
    Knob::ALL.into_iter().map(curve).filter(|(_, curve)| curve.len() > 1).collect()
}

fn over_bits(tradeoff: &Tradeoff, error: &Measured) -> Figure {
    let words = by_knob(tradeoff, error).into_iter().filter(|(knob, _)| *knob != Knob::Window);
    let line = |(at, (knob, curve)): (usize, (Knob, Vec<_>))| {
        Series::line(knob.key(), Paint::series(at), curve)
    };
    // Words that hardly matter would only hide the others.
    let matters = |(_, curve): &(Knob, Vec<(f64, f64)>)| {
        let rms = || curve.iter().map(|point| point.1);
        rms().fold(0.0, f64::max) > 1.5 * rms().fold(f64::INFINITY, f64::min)
    };
    let series: Vec<_> = words.filter(matters).enumerate().map(line).collect();
    let all = || series.iter().flat_map(|series| series.points.iter());
    let title = format!("Error of the {} over word lengths", error.of);
    let plot = Plot::new(
        &title,
        Axis::linear("bits of the word", all().map(|point| point.0)),
        Axis::log(&format!("RMS error ({})", error.unit), all().map(|point| point.1)),
        series.clone(),
    );
    let note = "Measured. Words that change the error by less than half of it are left out. A word whose error halves with every bit limits; where its line is flat, it is longer than it need be.";
    Figure::plot(&title, note, &plot)
}

fn over_area(tradeoff: &Tradeoff, n: usize, quantity: Quantity) -> Figure {
    let place = |point: &Point| (point.cost.luts, point.measured[n].rms);
    let chosen = |on: bool| -> Vec<(f64, f64)> {
        let of = tradeoff.points.iter().filter(|point| point.front[n] == on);
        of.map(place).collect()
    };
    let itself: Vec<_> =
        tradeoff.points.iter().filter(|point| point.knob.is_empty()).map(place).collect();
    let series = vec![
        Series::dots("beaten by another", Paint::MUTED, chosen(false)),
        Series::dots("Pareto front of error, area and age", Paint::series(0), chosen(true)),
        Series::dots(&tradeoff.profile, Paint::INK, itself).mark(Mark::Rings(14)),
    ];
    let all = || tradeoff.points.iter().map(place);
    let title = format!("Error of the {} over area", quantity.name());
    let plot = Plot::new(
        &title,
        Axis::linear("LUT4, estimated", all().map(|point| point.0)),
        Axis::log(&format!("RMS error ({})", quantity.unit()), all().map(|point| point.1)),
        series,
    );
    Figure::plot(&title, "Measured errors.", &plot)
}

fn agreement(tradeoff: &Tradeoff) -> Figure {
    let of = |(n, quantity): (usize, &Quantity)| {
        let places = tradeoff.points.iter().map(|point| {
            let measured = point.measured[n].rms;
            (measured, point.predicted[n].rms / measured)
        });
        let label = format!("{} ({})", quantity.name(), quantity.unit());
        Series::dots(&label, Paint::series(n), places.collect())
    };
    let series: Vec<_> = Quantity::ALL.iter().enumerate().map(of).collect();
    let all = || series.iter().flat_map(|series| series.points.iter());
    let plot = Plot {
        limits: vec![1.0],
        ..Plot::new(
            "Predicted over measured RMS error",
            Axis::log("measured RMS error, each in its unit", all().map(|point| point.0)),
            Axis::log("predicted / measured", all().map(|point| point.1)),
            series.clone(),
        )
    };
    let note = "1 is a perfect prediction. A position's is far off where a table's words are so short that its steps are no longer small.";
    Figure::plot("Predicted against measured", note, &plot)
}

/// Each source's share of the variance of the profile itself.
fn sources(tradeoff: &Tradeoff) -> String {
    let Some(itself) = tradeoff.points.first() else { return String::new() };
    let mut names: Vec<&String> = itself.sources.iter().flat_map(|of| of.keys()).collect();
    names.sort();
    names.dedup();
    let share = |n: usize, name: &String| {
        let total: f64 = itself.sources[n].values().map(|rms| rms * rms).sum();
        itself.sources[n].get(name).map_or(0.0, |rms| rms * rms / total)
    };
    let mut rows: Vec<(f64, Vec<String>)> = Vec::new();
    for name in names {
        let shares = [0, 1, 2].map(|n| share(n, name));
        let largest = shares.into_iter().fold(0.0, f64::max);
        let cell = |share: f64| format!("{:.1} %", 100.0 * share);
        rows.push((largest, [name.clone()].into_iter().chain(shares.map(cell)).collect()));
    }
    rows.retain(|(largest, _)| *largest > 5e-4);
    rows.sort_by(|a, b| b.0.total_cmp(&a.0));
    let rows: Vec<_> = rows.into_iter().map(|(_, cells)| cells).collect();
    let note = "<p class=\"note\">Shares of the mean square by the block that rounds; adc is the converter's rounding and what the oscillator's words do, calibration what the words of gains and tables are off.</p>\n";
    let heads = ["source", "#force", "#capacitance", "#position"];
    tables::texts("Sources of the predicted errors", &heads, &rows) + note
}

fn next_bits(tradeoff: &Tradeoff) -> String {
    printed("What one more bit would buy", &NEXT_BIT, &next_bit_rows(&tradeoff.next_bits))
}

fn synthesised(tradeoff: &Tradeoff) -> String {
    let rows = synthesised_rows(&tradeoff.synthesised);
    printed("What synthesis makes of it", &SYNTHESISED, &rows)
}

/// A table as it is printed, whose columns are numbers but for those that name something; nothing where
/// it has no rows.
fn printed(label: &str, heads: &[&str], rows: &[Vec<String>]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let is_name = |head: &str| ["knob", "profile", "part"].contains(&head);
    let heads: Vec<String> = heads
        .iter()
        .map(|head| if is_name(head) { head.to_string() } else { format!("#{head}") })
        .collect();
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    tables::texts(label, &heads, rows)
}

fn points(tradeoff: &Tradeoff) -> String {
    let loops = looped(&tradeoff.points);
    let cells = |point: &Point| {
        let knob = if point.knob.is_empty() { &tradeoff.profile } else { &point.knob };
        let value = if point.knob.is_empty() { String::new() } else { point.value.to_string() };
        let mut cells = vec![knob.clone(), value];
        for (n, measured) in point.measured.iter().enumerate() {
            cells.extend([number::short(measured.rms), prediction(point, n)]);
        }
        cells.extend(loops.iter().map(|(n, _)| loop_error(point, *n)));
        let cost = &point.cost;
        cells.extend([
            number::short(cost.age_us),
            format!("{:.0}", cost.luts),
            format!("{:.0}", cost.flip_flops_of(Family::Ecp5)),
            format!("{:.0}", cost.multipliers),
            format!("{:.0}", cost.memory_bits / 1024.0),
            format!("{:.0}", cost.block_rams),
            format!("{:.0}", cost.block_rams_ice40),
            front(point),
        ]);
        cells
    };
    let mut head = vec![
        "knob",
        "#bits",
        "#force, mN",
        "#predicted",
        "#capacitance, %",
        "#predicted",
        "#position, µm",
        "#predicted",
    ];
    head.extend(
        loops.iter().map(|(n, _)| ["#force in the loop, mN", "#drive, V", "#direction, ppm"][*n]),
    );
    head.extend([
        "#age, µs",
        "#LUT4",
        "#flip-flops",
        "#multipliers",
        "#memory, Kbit",
        "#block RAM, ECP5",
        "#block RAM, iCE40",
        "on the front of",
    ]);
    let marked = tradeoff.points.iter().any(|point| point.is_of_one.contains(&true));
    let note = if marked { format!("<p class=\"note\">{OF_ONE}</p>\n") } else { String::new() };
    tables::texts("All points", &head, &tradeoff.points.iter().map(cells).collect::<Vec<_>>())
        + &note
}
