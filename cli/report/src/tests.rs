// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every figure on awkward runs: none, one row, no numbers, several cases, no truth, a great many
//! rows.

use super::*;
use hapticore_run::record::{
    Criterion, Driven, Effect, Laws, Quantities, Reference, Row, SignalError, Truth, WallPlace,
};
use hapticore_scene::Setpoint;

const FIGURES: [Option<&str>; 10] = [
    Some("fig3"),
    Some("fig4"),
    Some("fig6"),
    Some("fig7"),
    Some("fig9"),
    Some("fig13"),
    Some("fig15"),
    Some("hockey"),
    Some("fig99"),
    None,
];

/// A report may be this large, bytes.
const MOST_BYTES: usize = 1_500_000;

pub(super) fn record(figure: Option<&str>, rows: Vec<Row>) -> Record {
    Record {
        scene: "a <b> & \"c\"".into(),
        title: "<script>alert('x')</script>".into(),
        summary: "d < e".into(),
        figure: figure.map(String::from),
        profile: "p&q".into(),
        fidelity: "fixed".into(),
        cases: vec!["<case 0>".into(), "case & 1".into()],
        pads: vec!["<pad>".into()],
        effects: vec![Effect {
            name: "<effect>".into(),
            level: "<rung>".into(),
            seconds: 0.1,
            finer: Some(("<finer>".into(), 0.5)),
        }],
        criteria: vec![criterion(0.1), criterion(f64::NAN)],
        errors: vec![SignalError {
            signal: "<s>".into(),
            format: "u1.0".into(),
            max_error: 1e-9,
            max_codes: 0.5,
        }],
        simulated_seconds: 1.0,
        wall_seconds: 0.0,
        rows: rows.into_iter().collect(),
        ..Record::default()
    }
}

fn criterion(measured: f64) -> Criterion {
    let baseline = Some(("<eq. 6>".into(), f64::INFINITY));
    Criterion {
        name: "<force>".into(),
        measured,
        limit: 0.2,
        pass: measured < 0.2,
        unit: "N".into(),
        baseline,
        applicable: true,
        bounds: None,
    }
}

/// Row `n` of a made-up run: a pad that wanders, a voltage that rises, three loads, two cases.
pub(super) fn row(n: usize) -> Row {
    let t = n as f64;
    let quantities = Quantities {
        x_mm: 400.0 * (t * 0.7).sin(),
        y_mm: 240.0 * (t * 0.31).cos(),
        capacitance_pf: 318.0 + (t * 12.9).sin(),
        haptic_v_rms: (t * 7.0) % 350.0,
        force_n: 0.1 + 0.01 * (t * 3.1).sin(),
        direction: 1e-3 * (t * 1.7).sin(),
        ..Quantities::default()
    };
    let set = Setpoint { eccentricity_mm: 0.1 * (n % 40) as f64 - 2.0, ..Setpoint::default() };
    let (load_g, point, group) = (20.0 * (n % 3) as f64, n, n % 48);
    let part = n % 3;
    let truth = Truth { quantities, load_g, point, group, part, set, ..Truth::default() };
    let reference =
        Reference { quantities, capacitance_eq6_pf: 317.0 - (t * 0.1).sin(), force_eq6_n: 0.09 };
    let measured = Quantities { x_mm: quantities.x_mm + (t * 5.3).sin(), ..quantities };
    let (truth, reference) = (Some(truth), Some(reference));
    let (limited, fault) = (n.is_multiple_of(7), n.is_multiple_of(11));
    let free = Some(n.is_multiple_of(5));
    let wall = Some(WallPlace { surface_mm: 100.0, depth_mm: 100.0 - quantities.x_mm });
    let driven = Some(Driven {
        target_n: 0.1,
        drive_v_rms: t % 300.0,
        limited,
        fault,
        free,
        core_n: None,
        wall,
    });
    Row {
        case: n % 97 / 60,
        time_s: t * 1e-3,
        pad: n % 4,
        measured,
        flags: String::new(),
        laws: Some(Laws { eq8_n: 0.11, table_n: measured.force_n }),
        truth,
        driven,
        game: None,
        reference,
    }
}

pub(super) fn rows(count: usize) -> Vec<Row> {
    let mut rows: Vec<_> = (0..count).map(row).collect();
    rows.sort_by_key(|r| r.case);
    rows
}

fn without_numbers(mut row: Row) -> Row {
    let nan = f64::NAN;
    row.measured = Quantities {
        x_mm: nan,
        y_mm: f64::INFINITY,
        capacitance_pf: nan,
        force_n: nan,
        ..row.measured
    };
    row.driven = row.driven.map(|driven| Driven { drive_v_rms: nan, ..driven });
    row.truth = row.truth.map(|t| Truth { quantities: row.measured, load_g: nan, ..t });
    row
}

fn without_truth(row: Row) -> Row {
    Row { truth: None, driven: None, reference: None, ..row }
}

/// The page is well-formed, holds no address and no script but its own, bounds its size, and draws with classes
/// alone.
pub(super) fn check(record: &Record) -> String {
    let page = html(record, &["frames & more.csv".into()]);
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    let document = roxmltree::Document::parse_with_options(&page, options).expect("well-formed");
    let drawn = document.descendants().filter(|n| n.has_tag_name("svg"));
    for node in drawn.flat_map(|svg| svg.descendants()) {
        assert!(node.attribute("fill").or(node.attribute("stroke")).is_none(), "{node:?}");
        assert!(
            !node.attributes().any(|a| a.value().contains("NaN") || a.value().contains("inf")),
            "{node:?}"
        );
    }
    for absent in ["http", "url(", "@import", "src=", "A5\""] {
        assert!(!page.contains(absent), "{absent}");
    }
    assert_eq!(page.matches("<script").count(), 1);
    assert!(page.len() < MOST_BYTES, "{} bytes of {:?}", page.len(), record.figure);
    page
}

fn check_all(rows: impl Fn() -> Vec<Row>) {
    for figure in FIGURES {
        check(&record(figure, rows()));
    }
}

#[test]
fn no_rows() {
    check_all(Vec::new);
    assert!(check(&record(Some("fig3"), vec![])).contains("nothing to draw"));
}

#[test]
fn one_row() {
    check_all(|| rows(1));
}

#[test]
fn no_numbers_in_any_row() {
    check_all(|| rows(100).into_iter().map(without_numbers).collect());
}

#[test]
fn no_numbers_in_some_rows() {
    let some = |row: Row| {
        if row.time_s > 0.05 { without_numbers(row) } else { row }
    };
    check_all(|| rows(100).into_iter().map(some).collect());
}

#[test]
fn several_cases() {
    check_all(|| rows(600));
}

#[test]
fn a_capture_has_no_truth_and_still_figures() {
    check_all(|| rows(600).into_iter().map(without_truth).collect());
    let rows = rows(600).into_iter().map(without_truth).collect();
    assert!(check(&record(Some("hockey"), rows)).contains("Haptic force"));
}

#[test]
fn a_great_many_rows_stay_small() {
    check_all(|| rows(20_000));
}

#[test]
fn a_great_many_pads_and_cases_stay_small() {
    let spread = |(n, r): (usize, Row)| Row { pad: n % 16, case: n / 300, ..r };
    check_all(|| rows(12_000).into_iter().enumerate().map(spread).collect());
}

#[test]
fn names_are_escaped() {
    let page = check(&record(Some("hockey"), rows(50)));
    for escaped in [
        "&lt;script&gt;",
        "a &lt;b&gt; &amp; &quot;c&quot;",
        "&lt;pad&gt;",
        "&lt;effect&gt;",
        "&lt;eq. 6&gt;",
    ] {
        assert!(page.contains(escaped), "{escaped}");
    }
}

#[test]
fn a_criterion_that_fails_is_told_in_words() {
    let page = check(&record(None, rows(1)));
    assert!(
        page.contains("1 of 2 criteria passed")
            && page.contains("✗ fail")
            && page.contains("✓ pass")
    );
}

/// A reference far beyond what is measured, as it is where a core saturates.
fn with_reference_far_off(row: Row) -> Row {
    let far = |q: Quantities| Quantities {
        capacitance_pf: 9.0 * q.capacitance_pf,
        force_n: 9.0 * q.force_n,
        ..q
    };
    Row {
        reference: row.reference.map(|r| Reference { quantities: far(r.quantities), ..r }),
        ..row
    }
}

/// Every point of every drawing, with the drawing's size.
fn drawn(page: &str) -> Vec<([f64; 2], [f64; 2])> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    let document = roxmltree::Document::parse_with_options(page, options).expect("well-formed");
    let numbers =
        |text: &str| text.split([',', ' ']).filter_map(|n| n.parse().ok()).collect::<Vec<f64>>();
    let mut points = Vec::new();
    for svg in document
        .descendants()
        .filter(|n| n.attribute("aria-label").is_some() && n.has_tag_name("svg"))
    {
        let size = numbers(svg.attribute("viewBox").expect("a size"));
        for node in svg.descendants() {
            let circle =
                ["cx", "cy"].map(|at| node.attribute(at).map_or(Vec::new(), numbers)).concat();
            let line = node.attribute("points").map_or(Vec::new(), numbers);
            points.extend(
                circle.chunks(2).chain(line.chunks(2)).map(|p| ([p[0], p[1]], [size[2], size[3]])),
            );
        }
    }
    points
}

#[test]
fn nothing_is_drawn_outside_of_its_plot() {
    for figure in FIGURES {
        let rows = rows(400).into_iter().map(with_reference_far_off).collect();
        let points = drawn(&check(&record(figure, rows)));
        assert!(points.len() > 100, "{figure:?}: {}", points.len());
        for (point, size) in points {
            let within = |axis: usize| (0.0..=size[axis]).contains(&point[axis]);
            assert!(within(0) && within(1), "{figure:?}: {point:?} of {size:?}");
        }
    }
}

/// Dots, and lines that lead straight up through a dot, with their lengths: x, y and length.
fn dots_and_bars(page: &str) -> (Vec<[f64; 2]>, Vec<[f64; 3]>) {
    let document = roxmltree::Document::parse_with_options(
        page,
        roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() },
    );
    let document = document.expect("well-formed");
    let (mut dots, mut bars) = (Vec::new(), Vec::new());
    for svg in document.descendants().filter(|n| n.has_attribute("aria-label")) {
        let all = |tag: &'static str| svg.descendants().filter(move |n| n.has_tag_name(tag));
        let here: Vec<[f64; 2]> = all("circle")
            .map(|n| ["cx", "cy"].map(|key| n.attribute(key).unwrap().parse().unwrap()))
            .collect();
        for line in all("polyline").filter_map(|n| n.attribute("points")) {
            let at: Vec<f64> =
                line.split([',', ' ']).filter_map(|number| number.parse().ok()).collect();
            let &[x, above, x1, below] = at.as_slice() else { continue };
            let (above, below) = (above.min(below), above.max(below));
            if let Some(dot) =
                here.iter().find(|dot| dot[0] == x && (above..=below).contains(&dot[1]))
                && x == x1
            {
                bars.push([x, dot[1], below - above]);
            }
        }
        dots.extend(here);
    }
    (dots, bars)
}

#[test]
fn a_point_with_spread_has_a_bar_of_twice_the_standard_deviation_and_another_has_none() {
    // Means of 20, 60 and 40; standard deviations of 10 and none.
    let samples: [&[(f64, f64)]; 3] =
        [&[(1.0, 10.0), (1.0, 20.0), (1.0, 30.0)], &[(2.0, 60.0)], &[(3.0, 40.0), (3.0, 40.0)]];
    let series = series::Series::sampled("", paint::Paint::INK, samples);
    let [x, y] = [axis::Axis::exact("x", 0.0, 4.0), axis::Axis::exact("y", 0.0, 100.0)];
    let (dots, bars) = dots_and_bars(&plot::Plot::new("p", x, y, vec![series]).svg());
    let unit = (dots[0][1] - dots[1][1]) / 40.0;
    assert_eq!((dots.len(), bars.len()), (3, 1), "{bars:?}");
    assert_eq!(bars[0][..2], dots[0]);
    assert!((bars[0][2] - 20.0 * unit).abs() <= 2.0, "{bars:?}, {unit} a unit");
}

#[test]
fn figures_have_bars_where_settings_have_several_slots() {
    let bars = |figure, slots: usize| {
        let of = |n: usize| {
            let mut row = row(n / slots);
            row.measured.capacitance_pf += (n % slots) as f64;
            row.measured.force_n += 0.01 * (n % slots) as f64;
            row.truth = row.truth.map(|truth| Truth { group: n / slots, ..truth });
            Row { case: 0, ..row }
        };
        dots_and_bars(&check(&record(Some(figure), (0..12 * slots).map(of).collect()))).1.len()
    };
    for figure in ["fig3", "fig4", "fig6"] {
        assert_eq!(bars(figure, 1), 0, "{figure}");
    }
    assert!(
        bars("fig4", 3) > 12 && bars("fig6", 3) > 24,
        "{} {}",
        bars("fig4", 3),
        bars("fig6", 3)
    );
    assert!(bars("fig3", 3) > 0, "{}", bars("fig3", 3));
}

#[test]
fn a_sweep_is_drawn_over_what_is_swept() {
    let swept =
        |keys: &[&'static str]| check(&Record { swept: keys.to_vec(), ..record(None, rows(90)) });
    let page = swept(&["load_g", "haptic_v_rms"]);
    assert!(page.contains("over haptic voltage (V RMS)") && !page.contains("over time"));
    let page = swept(&["x_mm", "y_mm"]);
    assert!(page.contains("Position error over the sheet") && !page.contains("over time"));
    assert!(swept(&[]).contains("over time"));
}

#[test]
fn many_slots_are_a_line_and_a_band() {
    let [few, many] = [200, 5000].map(|count| check(&record(Some("hockey"), rows(count))));
    assert!(
        !few.contains("<polygon")
            && many.contains("<polygon")
            && many.contains("each band the range")
    );
}

#[test]
fn a_direction_that_nothing_measures_is_not_drawn() {
    let pushed = |measured: f64| {
        let mut rows = rows(50);
        for row in &mut rows {
            row.measured.direction = measured;
            row.truth.as_mut().expect("a truth").quantities.direction = 0.5;
        }
        check(&record(None, rows)).contains("Direction of the push")
    };
    assert!(!pushed(0.0) && pushed(0.4));
}

#[test]
fn a_map_has_the_size_of_the_sheet() {
    let small = Record { sheet_mm: Some([1000.0, 1000.0]), ..record(Some("fig3"), rows(100)) };
    assert!(check(&small).contains("viewBox=\"0 0 860 860\""));
    assert!(check(&record(Some("fig3"), rows(100))).contains("viewBox=\"0 0 860 500\""));
}

/// A run of a controller: cases of ten slots of 1 ms, each with a law, a target and the forces that
/// come of it.
fn controlled(cases: &[(&'static str, f64, [f64; 10])]) -> Record {
    let rows = cases.iter().enumerate().flat_map(|(case, (_, target_n, forces))| {
        forces.iter().enumerate().map(move |(n, force_n)| {
            let mut row = Row { case, pad: 0, time_s: 1e-3 * (10 * case + n) as f64, ..row(n) };
            let truth = row.truth.as_mut().expect("a truth");
            (truth.set.target_n, truth.quantities.force_n) = (*target_n, *force_n);
            row.measured.force_n = *force_n;
            row.driven =
                Some(Driven { target_n: *target_n, drive_v_rms: 200.0, ..Driven::default() });
            row
        })
    });
    let names: Vec<_> = (0..cases.len()).map(|n| format!("case {n}")).collect();
    let laws = names.iter().cloned().zip(cases.iter().map(|(law, ..)| *law)).collect();
    Record { laws, cases: names, ..record(Some("fig9"), rows.collect()) }
}

/// The texts of the rows of the table with this label.
pub(super) fn cells(page: &str, label: &str) -> Vec<Vec<String>> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    let document = roxmltree::Document::parse_with_options(page, options).expect("well-formed");
    let table = document.descendants().find(|n| n.attribute("aria-label") == Some(label));
    let rows = table.expect("the table").descendants().filter(|n| n.has_tag_name("tr"));
    let texts = |row: roxmltree::Node| {
        row.children().map(|cell| cell.text().unwrap_or("").into()).collect()
    };
    rows.skip(1).map(texts).collect()
}

/// Off by this much in every slot but the last, and by twice as much in that.
fn off(target_n: f64, off_n: f64) -> [f64; 10] {
    let mut forces = [target_n + off_n; 10];
    forces[9] += off_n;
    forces
}

#[test]
fn a_case_is_compared_with_the_open_loop_of_the_same_target() {
    let cases = [
        ("inverse", 0.6, off(0.6, 0.01)),
        ("open", 0.3, off(0.3, 0.2)),
        ("inverse", 0.3, off(0.3, 0.02)),
        ("open", 0.6, off(0.6, 0.04)),
        ("inverse", 0.5, off(0.5, 0.1)),
    ];
    // Those of a target together. RMS: √((9·1 + 4)/10) times what most are off.
    let expected = [
        ["case 0", "inverse", "0.600 N", "0.0114 N", "0.250", "0.0200 N", "0.250"],
        ["case 3", "open", "0.600 N", "0.0456 N", "1.00", "0.0800 N", "1.00"],
        ["case 1", "open", "0.300 N", "0.228 N", "1.00", "0.400 N", "1.00"],
        ["case 2", "inverse", "0.300 N", "0.0228 N", "0.100", "0.0400 N", "0.100"],
        ["case 4", "inverse", "0.500 N", "0.114 N", "–", "0.200 N", "–"],
    ];
    let page = check(&controlled(&cases));
    let rows: Vec<_> = cells(&page, "Off target").iter().map(|row| row[..7].to_vec()).collect();
    assert_eq!(rows, expected);
    assert_eq!(page.matches("<div class=\"panels\">").count(), 3, "a figure for each target");
}

/// The texts of every drawing that is about this, each with its place across.
fn texts(page: &str, about: &str) -> Vec<Vec<(String, String)>> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    let document = roxmltree::Document::parse_with_options(page, options).expect("well-formed");
    let is_it =
        |n: &roxmltree::Node| n.attribute("aria-label").is_some_and(|a| a.starts_with(about));
    let text = |n: roxmltree::Node| {
        (n.attribute("x").unwrap_or("").into(), n.text().unwrap_or("").trim().into())
    };
    let all = |svg: roxmltree::Node| {
        svg.descendants().filter(|n| n.has_tag_name("text")).map(text).collect()
    };
    document.descendants().filter(is_it).map(all).collect()
}

#[test]
fn panels_have_the_same_axes_and_line_up() {
    let page = check(&controlled(&[("open", 0.3, off(0.3, 2.0)), ("inverse", 0.6, off(0.6, 0.0))]));
    let [force, drive] = ["Force over time", "Drive over time"].map(|about| texts(&page, about));
    assert_eq!((force.len(), drive.len()), (2, 2));
    assert_eq!((&force[0], &drive[0]), (&force[1], &drive[1]));
    let times = |texts: &[(String, String)]| -> Vec<(String, String)> {
        texts.iter().filter(|(_, text)| text.starts_with("0.00")).cloned().collect()
    };
    assert!(times(&force[0]).len() > 3, "{force:?}");
    assert_eq!(times(&force[0]), times(&drive[0]));
}

#[test]
fn limits_and_faults_are_marked_where_there_are_any() {
    let mut record = controlled(&[("open", 0.3, off(0.3, 0.0))]);
    let plain = check(&record);
    assert!(!plain.contains("drive limited") && !plain.contains("off by a fault"));
    let mut rows: Vec<Row> = record.rows.iter().cloned().collect();
    for (row, limited, fault) in [(2, true, false), (3, true, false), (7, false, true)] {
        let driven = rows[row].driven.as_mut().expect("driven");
        (driven.limited, driven.fault) = (limited, fault);
    }
    record.rows = rows.into_iter().collect();
    let page = check(&record);
    assert!(page.contains("limited in 2 of 10 slots; fault in 1 of 10 slots"));
    assert!(page.contains("drive limited") && page.contains("drives off by a fault"));
    let marks = |class: &str| {
        page.matches(&format!("<polyline class=\"s {class}\" stroke-width=\"10\"")).count()
    };
    assert_eq!((marks("k13"), marks("k3 dash")), (1, 1));
    assert_eq!(cells(&page, "Off target")[0][7..], ["2", "1"]);
}
