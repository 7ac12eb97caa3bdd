// SPDX-License-Identifier: MIT OR Apache-2.0
//! The page of a device's calibration: what the position table leaves of its places, and eq. 8 of
//! the forces.

use super::axis::Axis;
use super::fig3_maps::{error_legend, error_paint, grid, titled};
use super::figure::Figure;
use super::map::map;
use super::number;
use super::page::{self, escape};
use super::paint::Paint;
use super::plot::Plot;
use super::series::Series;
use crate::print;
use hapticore_host::Found;
use hapticore_host::Residual;
use hapticore_run::lab::Outcome;
use hapticore_run::lab::loads::{Force, Point};

/// Tiles of a map.
const TILES: usize = 7000;

/// (F·V)² to the (nF·V)² of an axis.
const NANO: f64 = 1e18;

/// The page of a calibration.
pub fn of_calibration(outcome: &Outcome) -> String {
    let lines: String = print::calibration_lines(outcome)
        .iter()
        .map(|line| format!("<li>{}</li>", escape(line)))
        .collect();
    let heading = format!(
        "<header>\n<h1>{TITLE}</h1>\n{}<ul>{lines}</ul>\n</header>\n",
        page::warnings(&outcome.warnings)
    );
    let figures: Vec<_> =
        [positions(outcome)].into_iter().chain(outcome.force.iter().flat_map(forces)).collect();
    let figures: String = figures.iter().map(Figure::html).collect();
    let body = page::section("Figures", &format!("<div class=\"figures\">\n{figures}</div>\n"));
    page::document(TITLE, &(heading + &body))
}

const TITLE: &str = "Calibration";

fn positions(outcome: &Outcome) -> Figure {
    let [own, held_out] = &outcome.found;
    let maps = error_map("positions that the table was made from", own, &outcome.own_places)
        + &error_map("every other position held out of the table", held_out, &outcome.held_out);
    let note = "Distance of each measured position from the one that the position table computes. RMS and largest distance stand above each map.";
    Figure::wide("Error of the position table", note, error_legend(), grid(&maps))
}

fn error_map(name: &str, found: &[Found], residual: &Residual) -> String {
    let error = |&([x, y], [a, b]): &Found| (x, y, (a - x).hypot(b - y));
    let places: Vec<_> = found
        .iter()
        .map(error)
        .map(|(x, y, error)| (x, y, if error.is_finite() { error } else { f64::MAX }))
        .collect();
    let what = format!(
        "{} mm RMS, {} mm at most",
        number::short(residual.rms_mm),
        number::short(residual.worst_mm)
    );
    titled(name, &what, |about| map(about, (0.0, 0.0), &places, TILES, error_paint))
}

fn forces(force: &Force) -> [Figure; 2] {
    let loads = loads(force);
    let of = |load: Option<f64>| force.points.iter().filter(move |point| point.load_g == load);
    let series = |get: fn(&Point) -> (f64, f64)| {
        let dots = |(n, load): (usize, &Option<f64>)| {
            let name =
                load.map_or("measurements".into(), |load| format!("{} g", number::chosen(load)));
            Series::dots(&name, Paint::series(n), of(*load).map(get).collect())
        };
        loads.iter().enumerate().map(dots).collect::<Vec<_>>()
    };
    [
        law(force, series(|point| (NANO * point.square, point.force_n))),
        residuals(force, series(|point| (point.haptic_v_rms, 1e3 * point.residual_n))),
    ]
}

fn loads(force: &Force) -> Vec<Option<f64>> {
    let mut loads: Vec<_> = force.points.iter().map(|point| point.load_g).collect();
    loads.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
    loads.dedup();
    loads
}

fn law(force: &Force, mut series: Vec<Series>) -> Figure {
    let most = force.points.iter().map(|point| NANO * point.square).fold(0.0, f64::max);
    let line = |k: f64| vec![(0.0, 0.0), (most, k * most / NANO)];
    let [low, high] = force.force_k.interval;
    series.push(Series::line("eq. 8", Paint::INK, line(force.force_k.value)));
    series.push(Series::line("ends of the 95 % interval", Paint::MUTED, line(low)));
    series.push(Series::line("", Paint::MUTED, line(high)));
    let values = force.points.iter().map(|point| point.force_n);
    let plot = Plot::new(
        "Haptic force over the square of capacitance times voltage",
        Axis::with_zero("(C·V)² ((nF·V)²)", [most]),
        Axis::with_zero("F (N)", values),
        series,
    );
    Figure::plot(
        "Force and eq. 8",
        "The line is force_k times (C·V)², with the ends of its 95 % interval.",
        &plot,
    )
}

fn residuals(force: &Force, series: Vec<Series>) -> Figure {
    let noise_mn = 1e3 * force.noise_n;
    let values =
        force.points.iter().map(|point| 1e3 * point.residual_n).chain([-noise_mn, noise_mn]);
    let x = Axis::with_zero(
        "haptic voltage (V RMS)",
        force.points.iter().map(|point| point.haptic_v_rms),
    );
    let plot =
        Plot::new("Measured force minus eq. 8", x, Axis::with_zero("ΔF (mN)", values), series);
    let note = format!(
        "Measured force minus eq. 8. Standard deviation of the noise, estimated from these residuals: {} mN. A bend or step shows that eq. 8 does not apply there; the 95 % intervals are then too narrow.",
        number::short(noise_mn)
    );
    Figure::plot("Residuals of the force", &note, &plot)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hapticore_run::lab::least_squares::Estimate;
    use hapticore_run::record::Provenance;

    fn outcome(points: Vec<Point>, found: Vec<Found>) -> Outcome {
        let estimate = |value: f64| Estimate { value, interval: [0.9 * value, 1.1 * value] };
        let residual = Residual::of(found.iter().copied());
        Outcome {
            profile: "p&q".into(),
            places: found.len(),
            columns: None,
            terminals: 4,
            own_places: residual,
            held_out: residual,
            force: Some(Force {
                force_k: estimate(9.6e12),
                mu: Some(estimate(0.1)),
                current_scale: None,
                noise_n: 0.0,
                table: None,
                table_residual_n: None,
                points,
            }),
            warnings: vec!["<a> & b".into()],
            found: [found, Vec::new()],
            provenance: Provenance::default(),
        }
    }

    #[test]
    fn the_page_is_well_formed_whatever_was_found() {
        let point = Point {
            square: 1e-14,
            force_n: 0.1,
            residual_n: 1e-3,
            haptic_v_rms: 300.0,
            load_g: None,
        };
        let lost = [([0.0, 0.0], [f64::NAN, 0.0]), ([9.0, 5.0], [9.1, 5.0])];
        for (points, found) in [(Vec::new(), Vec::new()), (vec![point], lost.to_vec())] {
            let page = of_calibration(&outcome(points, found));
            let text = page.split_once('\n').expect("lines").1;
            roxmltree::Document::parse(text).unwrap_or_else(|error| panic!("{error}"));
            assert!(page.contains("&lt;a&gt; &amp; b"));
        }
    }
}
