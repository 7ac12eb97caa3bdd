// SPDX-License-Identifier: MIT OR Apache-2.0
//! The page of a plan of many points: errors over area, age and computing time, and the Pareto front.

use std::collections::BTreeMap;

use super::axis::Axis;
use super::figure::Figure;
use super::number;
use super::page::{self, escape};
use super::paint::Paint;
use super::plot::Plot;
use super::series::Series;
use super::tables;
use hapticore_sweep::collect::{Collect, Collected, settings};
use hapticore_sweep::plan::Plan;
use hapticore_sweep::result::{Results, Times};
use hapticore_tradeoff::errors::Quantity;

/// The most dots of a figure that are not on the front: more would only lie on each other.
const MOST_DOTS: usize = 2000;
/// The most rows of the front.
const MOST_ROWS: usize = 200;

/// Heads of the front's table.
pub const FRONT: [&str; 9] = [
    "point",
    "force, mN",
    "capacitance, %",
    "position, µm",
    "force to truth, mN",
    "position to truth, µm",
    "age, µs",
    "LUT4",
    "on the front of",
];

/// Rows of the points that are on some front, by rising error of the force.
pub fn front_rows(
    collected: &Collected,
    most: usize,
    number: fn(f64) -> String,
) -> Vec<Vec<String>> {
    let mut on: Vec<(&Collect, &Results)> =
        ran(collected).filter(|(of, _)| !of.front.is_empty()).collect();
    on.sort_by(|a, b| a.1.measured.force.rms.total_cmp(&b.1.measured.force.rms));
    let row = |(point, of): &(&Collect, &Results)| {
        let names: Vec<_> = point.front.iter().map(|quantity| quantity.name()).collect();
        let mut cells = vec![settings(&point.line)];
        cells.extend(of.measured.all().map(|error| number(error.rms)));
        cells.extend([of.truth.force, of.truth.position].map(|error| number(error.rms)));
        cells.extend([number(of.cost.age_us), format!("{:.0}", of.cost.luts), names.join(" ")]);
        cells
    };
    on.iter().take(most).map(row).collect()
}

/// The page.
pub fn of_sweep(plan: &Plan, collected: &Collected) -> String {
    let title = format!(
        "Sweep of {} points: {}",
        collected.points.len() + collected.missing.len(),
        plan.scene.file
    );
    let about = format!(
        "Case {}, variations of profile {}, core {}, {} slots each. {} points were run, {} are missing, {} cannot be run. Errors are RMS, against the ideal estimator unless a figure says otherwise.",
        plan.case,
        plan.profile.name,
        plan.fidelity,
        plan.slots,
        collected.points.len(),
        collected.missing.len(),
        collected.failed().count()
    );
    let figures: String = Quantity::ALL
        .into_iter()
        .enumerate()
        .flat_map(|(n, quantity)| {
            [over_area(collected, n, quantity), over_time(collected, n, quantity)]
        })
        .chain(levels(collected))
        .chain(agreement(collected))
        .map(|figure| figure.html())
        .collect();
    let rows = front_rows(collected, MOST_ROWS, number::short);
    let body = [
        format!("<header>\n<h1>{}</h1>\n<p>{}</p>\n</header>\n", escape(&title), escape(&about)),
        page::section("Figures", &format!("<div class=\"figures\">\n{figures}</div>\n")),
        page::section("Pareto front of error, area and age", &front_table(&rows)),
    ];
    page::document(&title, &body.concat())
}

fn front_table(rows: &[Vec<String>]) -> String {
    let heads: Vec<String> = (0..FRONT.len())
        .map(|n| {
            if n == 0 || n == FRONT.len() - 1 { FRONT[n].into() } else { format!("#{}", FRONT[n]) }
        })
        .collect();
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    tables::texts("Pareto front", &heads, rows)
}

fn ran(collected: &Collected) -> impl Iterator<Item = (&Collect, &Results)> {
    collected.points.iter().filter_map(|of| Some((of, of.line.results.as_ref()?)))
}

/// Dots on the front of a quantity, and some of the others.
fn dots(
    collected: &Collected,
    quantity: Quantity,
    place: impl Fn(&Collect, &Results) -> Option<(f64, f64)>,
) -> Vec<Series> {
    let chosen = |on: bool| {
        let of = ran(collected).filter(|(point, _)| point.front.contains(&quantity) == on);
        of.filter_map(|(point, results)| place(point, results)).collect::<Vec<_>>()
    };
    let others = chosen(false);
    let few = others.len().div_ceil(MOST_DOTS).max(1);
    vec![
        Series::dots("beaten by another", Paint::MUTED, others.into_iter().step_by(few).collect()),
        Series::dots("Pareto front of error, area and age", Paint::series(0), chosen(true)),
    ]
}

fn over_area(collected: &Collected, n: usize, quantity: Quantity) -> Figure {
    let place = |_: &Collect, of: &Results| Some((of.cost.luts, of.measured.all()[n].rms));
    let title = format!("Error of the {} over area", quantity.name());
    figure(&title, ("LUT4, estimated", false), quantity, dots(collected, quantity, place))
}

/// The error against the scene's truth over what a simulated second takes.
fn over_time(collected: &Collected, n: usize, quantity: Quantity) -> Figure {
    let times: &BTreeMap<String, Times> = &collected.times;
    let place = |point: &Collect, of: &Results| {
        let times = times.get(&point.line.key)?;
        Some((times.plant + times.core, of.truth.all()[n].rms))
    };
    let title = format!("Error of the {} to the truth over computing time", quantity.name());
    let what = ("seconds per simulated second, plant and core", true);
    figure(&title, what, quantity, dots(collected, quantity, place))
}

/// What the plant's levels are off finer ones, over what they take.
fn levels(collected: &Collected) -> Option<Figure> {
    let place = |(point, of): (&Collect, &Results)| {
        let percent = of.plant_percent().filter(|percent| *percent > 0.0)?;
        Some((collected.times.get(&point.line.key)?.plant, percent))
    };
    let places: Vec<_> = ran(collected).filter_map(place).collect();
    places.first()?;
    let few = places.len().div_ceil(MOST_DOTS).max(1);
    let title = "Levels of the simulated device: difference from finer ones over computing time";
    let plot = Plot::new(
        title,
        Axis::log("seconds per simulated second, plant", places.iter().map(|place| place.0)),
        Axis::log("largest difference (%)", places.iter().map(|place| place.1)),
        vec![Series::dots(
            "points",
            Paint::series(0),
            places.iter().step_by(few).copied().collect(),
        )],
    );
    Some(Figure::plot(title, "The largest difference over all that a user reads.", &plot))
}

fn figure(
    title: &str,
    (what, log): (&str, bool),
    quantity: Quantity,
    series: Vec<Series>,
) -> Figure {
    let all = || series.iter().flat_map(|series| series.points.iter());
    let x = all().map(|point| point.0);
    let plot = Plot::new(
        title,
        if log { Axis::log(what, x) } else { Axis::linear(what, x) },
        Axis::log(&format!("RMS error ({})", quantity.unit()), all().map(|point| point.1)),
        series.clone(),
    );
    Figure::plot(title, "Measured.", &plot)
}

/// Predicted over measured, where errors were predicted.
fn agreement(collected: &Collected) -> Option<Figure> {
    let of = |(n, quantity): (usize, Quantity)| {
        let place = |_: &Collect, of: &Results| {
            let measured = of.measured.all()[n].rms;
            Some((measured, of.predicted.as_ref()?.errors.all()[n].rms / measured))
        };
        let points = dots(collected, quantity, place).into_iter().flat_map(|of| of.points);
        let label = format!("{} ({})", quantity.name(), quantity.unit());
        Series::dots(&label, Paint::series(n), points.collect())
    };
    let series: Vec<_> = Quantity::ALL.into_iter().enumerate().map(of).collect();
    let all = || series.iter().flat_map(|series| series.points.iter());
    all().next()?;
    let title = "Predicted over measured RMS error";
    let plot = Plot {
        limits: vec![1.0],
        ..Plot::new(
            title,
            Axis::log("measured RMS error, each in its unit", all().map(|point| point.0)),
            Axis::log("predicted / measured", all().map(|point| point.1)),
            series.clone(),
        )
    };
    Some(Figure::plot(title, "1 is a perfect prediction.", &plot))
}
