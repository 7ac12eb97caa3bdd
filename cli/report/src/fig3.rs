// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fig. 3: force and capacitance hardly depend on where the pad is. The paper's own form, the sum
//! over position with a line for each load; then spreads, profiles and the position's error; maps in
//! `fig3_maps`.

use super::axis::Axis;
use super::fig3_maps;
use super::fig4::ordinates;
use super::figure::Figure;
use super::number;
use super::paint::Paint;
use super::plot::Plot;
use super::select::{self, Setting, deviation_percent, settings, spread_percent};
use super::series::{Mark, Point, Series};
use super::sweep::{Load, loads};
use hapticore_run::record::{Record, Row, Truth};
use std::collections::BTreeMap;

/// How a value is got from a slot.
type Get = fn(&Row) -> f64;

/// Settings that are drawn.
const SETTINGS: usize = 16;

const CORE: (&str, Get) = ("core", |r| r.measured.force_n);
const EQ6: (&str, Get) = ("eq. 6 alone", |r| r.reference.map_or(f64::NAN, |r| r.force_eq6_n));
const REFERENCE: (&str, Get) =
    ("floating-point reference", |r| r.reference.map_or(f64::NAN, |r| r.quantities.force_n));
const CORE_PF: Get = |r| r.measured.capacitance_pf;
const EQ6_PF: Get = |r| r.reference.map_or(f64::NAN, |r| r.capacitance_eq6_pf);
const REFERENCE_PF: Get = |r| r.reference.map_or(f64::NAN, |r| r.quantities.capacitance_pf);

/// Spreads, maps, profiles, position errors.
pub fn figures(record: &Record) -> Vec<Figure> {
    let mut settings = settings(record);
    let left_out = settings.split_off(settings.len().min(SETTINGS)).len();
    let mut figures = sums(record).unwrap_or_default();
    figures.extend([
        spreads(&settings, "Spread of the force over the sheet", [EQ6.1, CORE.1, REFERENCE.1]),
        spreads(
            &settings,
            "Spread of the capacitance over the sheet",
            [EQ6_PF, CORE_PF, REFERENCE_PF],
        ),
    ]);
    figures.push(fig3_maps::force(&settings, left_out, CORE.1, EQ6.1));
    if let Some(worst) = worst(&settings) {
        figures.extend([profiles(worst), magnified(worst)]);
    }
    figures.push(fig3_maps::position(&settings));
    figures.push(position_errors(record, &settings));
    figures
}

/// As the paper draws it: the sum of the currents over the position, in the middle row, a line for
/// each load; none where no case has several loads.
fn sums(record: &Record) -> Option<Vec<Figure>> {
    let mut by_case: BTreeMap<usize, Vec<Load>> = BTreeMap::new();
    for load in loads(record) {
        let case = load.settings.first()?.rows.first()?.0.case;
        by_case.entry(case).or_default().push(load);
    }
    Some(by_case.values().filter(|loads| loads.len() > 1).map(|loads| sum(loads)).collect())
}

fn sum(loads: &[Load]) -> Figure {
    let mut series = Vec::new();
    for (n, load) in loads.iter().enumerate() {
        let paint = Paint::series(n);
        let tag = format!("{} g", number::fixed(load.load_g, 0));
        let of =
            |get: Get| load.settings.first().map_or(vec![], |setting| middle_row(setting, get));
        let core = of(CORE_PF);
        series.push(Series::line("", paint, of(EQ6_PF)).tagged(&tag));
        series.push(Series::sampled("", paint, core.chunk_by(|a, b| (a.0 - b.0).abs() < 0.1)));
    }
    series.push(Series::line("sum of the currents, as a capacitance by eq. 6", Paint::INK, vec![]));
    series.push(Series::dots("core, corrected for the sheet", Paint::INK, vec![]));
    let x = Axis::linear("x (mm)", series.iter().flat_map(|s| s.points.iter().map(|p| p.0)));
    let y = Axis::with_zero("C (pF)", ordinates(&series));
    let title = "Sum of the currents over position, by load";
    Figure::plot(title, "Along the middle of the sheet.", &Plot::new(title, x, y, series))
}

/// A value along x, in the row nearest to the middle of the sheet.
fn middle_row(setting: &Setting, get: Get) -> Vec<Point> {
    let y = |t: &Truth| t.quantities.y_mm.abs();
    let nearest = setting.rows.iter().map(|(_, t)| y(t)).fold(f64::INFINITY, f64::min);
    let first = setting.rows.iter().find(|(_, t)| y(t) <= nearest + 0.1);
    let Some((_, first)) = first else { return vec![] };
    let row = first.quantities.y_mm;
    let same = |t: &Truth| (t.quantities.y_mm - row).abs() < 0.1;
    let at = setting.rows.iter().filter(|(_, t)| same(t));
    let mut points: Vec<Point> = at.map(|(r, t)| (t.quantities.x_mm, get(r))).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}

fn values(setting: &Setting, get: Get) -> Vec<f64> {
    setting.rows.iter().map(|(row, _)| get(row)).collect()
}

/// A row of dots for each setting.
fn spreads(settings: &[Setting], title: &str, [eq6, core, reference]: [Get; 3]) -> Figure {
    let row =
        |get: Get| move |(n, s): (usize, &Setting)| (spread_percent(&values(s, get)), -(n as f64));
    let points = |get: Get| settings.iter().enumerate().map(row(get)).collect::<Vec<_>>();
    let all = [
        Series::dots(EQ6.0, Paint::series(1), points(eq6)).mark(Mark::Dots(11)),
        Series::rings(REFERENCE.0, Paint::INK, points(reference)).mark(Mark::Rings(15)),
        Series::dots(CORE.0, Paint::series(0), points(core)).mark(Mark::Dots(11)),
    ];
    let series: Vec<_> =
        all.into_iter().filter(|s| s.points.iter().any(|p| p.0.is_finite())).collect();
    let x = Axis::log(
        "(largest − smallest) / mean (%)",
        series.iter().flat_map(|s| s.points.iter().map(|p| p.0)),
    );
    let names = settings.iter().map(|s| s.name.clone()).collect();
    let mut plot = Plot::new(title, x, Axis::categories("", names), series);
    plot.height = 150 + 66 * u32::try_from(settings.len()).unwrap_or(8).clamp(2, 40);
    let mut note =
        String::from("A point further left means less dependence on the pad's position.");
    if plot.series.iter().any(|s| s.points.iter().any(|p| p.0 == 0.0)) {
        note += " A logarithmic axis has no zero: values of exactly 0 % stand at its left end, at the tick 0.";
    }
    Figure::plot(title, &note, &plot)
}

/// The setting that needs the core most.
fn worst<'a, 'b>(settings: &'a [Setting<'b>]) -> Option<&'a Setting<'b>> {
    let need =
        |s: &Setting| spread_percent(&values(s, EQ6.1)).max(spread_percent(&values(s, CORE.1)));
    settings.iter().max_by(|a, b| need(a).total_cmp(&need(b)))
}

/// A setting's deviations along x at three heights: bottom, middle, top.
fn along_x(setting: &Setting, get: Get) -> Vec<(f64, Vec<Point>)> {
    let deviations = deviation_percent(&values(setting, get));
    let row_of = |y: f64| (y * 10.0).round() as i64;
    let mut rows: Vec<i64> = setting.rows.iter().map(|(_, t)| row_of(t.quantities.y_mm)).collect();
    rows.sort_unstable();
    rows.dedup();
    let mut chosen = vec![0, rows.len() / 2, rows.len().saturating_sub(1)];
    chosen.dedup();
    let profile = |row: i64| {
        let at = setting
            .rows
            .iter()
            .zip(&deviations)
            .filter(|((_, t), _)| row_of(t.quantities.y_mm) == row);
        let mut points: Vec<Point> = at.map(|((_, t), d)| (t.quantities.x_mm, *d)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        (row as f64 / 10.0, points)
    };
    chosen.into_iter().filter_map(|n| rows.get(n).copied()).map(profile).collect()
}

fn profiles(setting: &Setting) -> Figure {
    let mut series = Vec::new();
    for ((name, get), paint) in [(EQ6, Paint::series(1)), (CORE, Paint::series(0))] {
        for (n, (y, points)) in along_x(setting, get).into_iter().enumerate() {
            let tag = if name == EQ6.0 { Some(height(y)) } else { None };
            let name = if n == 0 { name } else { "" };
            series.push(Series { tag, ..Series::line(name, paint, points) });
        }
    }
    let series = series.into_iter().filter(|s| s.points.iter().any(|p| p.1.is_finite())).collect();
    let title = titled("Force along x", setting);
    Figure::plot(
        &title,
        "Deviation of the force from its mean over the sheet, for three positions along y.",
        &deviations(&title, series),
    )
}

fn magnified(setting: &Setting) -> Figure {
    let mut series = Vec::new();
    for (n, (y, points)) in along_x(setting, CORE.1).into_iter().enumerate() {
        series.push(Series::dots(
            &format!("core, {}", height(y)),
            Paint::series([0, 2, 3][n % 3]),
            points,
        ));
    }
    for (n, (_, points)) in along_x(setting, REFERENCE.1).into_iter().enumerate() {
        series.push(Series::line("", Paint::series([0, 2, 3][n % 3]), points).mark(Mark::Line(3)));
    }
    if series
        .iter()
        .any(|s| matches!(s.mark, Mark::Line(_)) && s.points.iter().any(|p| p.1.is_finite()))
    {
        series.push(Series::line(REFERENCE.0, Paint::INK, vec![]));
    }
    let title = titled("Force along x, core only", setting);
    Figure::plot(
        &title,
        "Deviation from the mean over the sheet, at three heights, on a finer scale than the figure with eq. 6.",
        &deviations(&title, series),
    )
}

fn height(y: f64) -> String {
    format!("y = {} mm", number::fixed(y, 0))
}

fn titled(what: &str, setting: &Setting) -> String {
    if setting.name.is_empty() { what.into() } else { format!("{what}: {}", setting.name) }
}

fn deviations(about: &str, series: Vec<Series>) -> Plot {
    let points = || series.iter().flat_map(|s| s.points.iter());
    let x = Axis::linear("x (mm)", points().map(|p| p.0));
    let y = Axis::with_zero("ΔF (%)", points().map(|p| p.1));
    Plot::new(about, x, y, series)
}

/// Which share of the slots stays below an error.
fn position_errors(record: &Record, settings: &[Setting]) -> Figure {
    let series: Vec<_> = settings
        .iter()
        .enumerate()
        .map(|(n, s)| Series::line(&s.name, Paint::series(n), cumulative(s)))
        .collect();
    let errors = series.iter().flat_map(|s| s.points.iter().map(|p| p.0));
    let limit = select::bound(record, "position_mm");
    let x = Axis::log("|Δ position| (mm)", errors.chain(limit));
    let y = Axis::exact("slots with a smaller error (%)", 0.0, 100.0);
    let mut plot = Plot::new("Share of the slots with a smaller position error", x, y, series);
    plot.breaks = limit.into_iter().collect();
    let rms = select::rms(settings.iter().flat_map(fig3_maps::position_errors));
    let limit = limit.map_or(select::limits_note(record, "position_mm", "mm").into(), |l| {
        format!(" The dotted line is the limit of every slot, {} mm.", number::short(l))
    });
    Figure::plot(
        "Distribution of the position error",
        &format!("{} mm RMS over all settings.{limit}", number::short(rms)),
        &plot,
    )
}

fn cumulative(setting: &Setting) -> Vec<Point> {
    let mut errors: Vec<_> =
        fig3_maps::position_errors(setting).into_iter().filter(|e| e.is_finite()).collect();
    errors.sort_by(f64::total_cmp);
    let count = errors.len() as f64;
    errors.into_iter().enumerate().map(|(n, e)| (e, 100.0 * (n + 1) as f64 / count)).collect()
}
