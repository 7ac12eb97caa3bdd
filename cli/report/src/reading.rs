// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a reader of a report may trip over: names with two values, shares beyond the whole, values that vanish, lines that
//! cannot be told apart, limits that are crossed under "passed".

use super::tests::{cells, check, record, row, rows};
use hapticore_run::findings::{Findings, Flagged, Tracking};
use hapticore_run::record::{
    Bounds, Criterion, Driven, Effect, Provenance, Quantities, Record, Row, WallPlace,
};

/// Rows of one case whose quantities are those of `row`, changed.
fn changed(count: usize, change: impl Fn(usize, &mut Row)) -> Vec<Row> {
    let with = |n: usize| {
        let mut row = Row { case: 0, pad: 0, ..row(n) };
        change(n, &mut row);
        row
    };
    (0..count).map(with).collect()
}

/// A record of one case and one pad, drawn as any run is.
fn plain(rows: Vec<Row>) -> Record {
    Record { cases: vec!["main".into()], ..record(None, rows) }
}

/// The figure of a title, as HTML.
fn figure(page: &str, title: &str) -> String {
    let start = page.find(&format!("<figcaption>{title}</figcaption>")).expect("the figure");
    page[start..].split("</figure>").next().expect("its end").into()
}

#[test]
fn shares_of_all_effects_sum_to_the_whole_however_many_threads_made_them() {
    let effect =
        |seconds: f64| Effect { name: "e".into(), level: String::new(), seconds, finer: None };
    let effects = [1.07, 0.405, 0.125].map(effect).to_vec();
    let page = check(&Record { effects, wall_seconds: 0.6, ..plain(rows(10)) });
    let share =
        |row: &Vec<String>| -> f64 { row[4].trim_end_matches(" %").parse().expect("percent") };
    let shares: Vec<f64> = cells(&page, "Effects").iter().map(share).collect();
    assert_eq!(shares, [66.9, 25.3, 7.8]);
}

#[test]
fn a_spread_of_zero_has_a_dot_and_a_word() {
    let constant = |n: usize, row: &mut Row| {
        row.measured.force_n = 0.1;
        row.truth.as_mut().expect("a truth").group = n / 20;
        row.reference.as_mut().expect("one").quantities.force_n = 0.1 + 0.001 * (n % 5) as f64;
    };
    let page = check(&record(Some("fig3"), changed(60, constant)));
    let spreads = figure(&page, "Spread of the force over the sheet");
    assert!(spreads.contains("values of exactly 0 %"), "{spreads:.300}");
    assert_eq!(
        spreads.matches("<circle cx=").count() - 3,
        3 * 3,
        "three kinds of dots of three settings"
    );
}

#[test]
fn a_limit_is_drawn_where_it_bounds_every_slot_and_nowhere_else() {
    let limited = |bounds: Option<Bounds>| {
        let criterion = Criterion {
            name: "force".into(),
            measured: 0.001,
            limit: 0.002,
            pass: true,
            unit: "N".into(),
            baseline: None,
            applicable: true,
            bounds,
        };
        let off = |n: usize, row: &mut Row| row.measured.force_n += 0.004 * (n % 2) as f64;
        let record = Record { figure: Some("hockey".into()), ..plain(changed(50, off)) };
        figure(&check(&Record { criteria: vec![criterion], ..record }), "Force error")
    };
    let of = |of, cases: &[&str]| {
        Some(Bounds { of, cases: cases.iter().map(ToString::to_string).collect() })
    };
    let has_line = |page: &str| page.contains("class=\"s k3 dash\"");
    assert!(has_line(&limited(of("force_n", &[]))) && has_line(&limited(of("force_n", &["main"]))));
    for elsewhere in [None, of("position_mm", &[]), of("force_n", &["another"])] {
        let page = limited(elsewhere);
        assert!(!has_line(&page) && page.contains("are not drawn"), "{page:.300}");
    }
}

#[test]
fn every_voltage_of_every_case_is_drawn_and_named() {
    let of = |n: usize, row: &mut Row| {
        row.case = n / 40;
        let truth = row.truth.as_mut().expect("a truth");
        (truth.part, truth.set.haptic_v_rms) = (1, 100.0 * (n % 5) as f64);
    };
    let names: Vec<String> = (0..4).map(|n| format!("case {n}")).collect();
    let page = check(&Record { cases: names.clone(), ..record(Some("fig13"), changed(160, of)) });
    let drawn = figure(&page, "Direction of the push");
    assert_eq!(drawn.matches("<li>").count(), 5 + 1, "five voltages, and what a line is");
    for name in names {
        assert!(drawn.contains(&format!("<p>{name}</p>")), "{name}");
    }
    for series in 10..15 {
        let dots = drawn.matches(&format!("r=\"6\" class=\"f k{series}\"")).count();
        assert_eq!(dots, 4 * 8, "series {series}");
    }
}

#[test]
fn no_colour_stands_for_two_lines_of_one_legend() {
    let page = check(&record(Some("fig15"), rows(600)));
    let legend = figure(&page, "At the wall");
    let legend = legend.split("</ul>").next().expect("a legend");
    let mut colours: Vec<&str> = legend
        .split("class=\"small s ")
        .skip(1)
        .map(|rest| rest.split('"').next().unwrap())
        .collect();
    let count = colours.len();
    colours.sort_unstable();
    colours.dedup();
    assert_eq!((count, colours.len()), (8, 8), "{colours:?}");
}

#[test]
fn a_pads_line_is_seen_on_top_of_the_truth() {
    let page = check(&plain(changed(2000, |_, _| {})));
    let drawn = figure(&page, "Haptic force");
    let [truth, pad] = ["s k1\" stroke-width=\"9\"", "s k10\" stroke-width=\"4\""]
        .map(|line| drawn.find(line).expect("a line"));
    assert!(truth < pad && !drawn.contains("<polyline class=\"s k0"));
}

#[test]
fn each_case_has_a_panel_and_starts_at_zero() {
    let two = |n: usize, row: &mut Row| {
        row.case = n / 100;
        row.measured.haptic_v_rms = 150.0 + n as f64;
        row.time_s = 0.01 * n as f64;
    };
    let page = check(&record(None, changed(200, two)));
    let drawn = figure(&page, "Haptic voltage");
    assert_eq!(drawn.matches("<svg data-x=").count(), 2);
    assert!(drawn.contains("<p>&lt;case 0&gt;</p>") && drawn.contains("axes of its own"));
    let ends: Vec<f64> = drawn
        .split("data-x=\"")
        .skip(1)
        .map(|rest| rest.split(' ').nth(1).expect("an end").parse().expect("a number"))
        .collect();
    assert!(ends.iter().all(|end| (0.99..1.05).contains(end)), "{ends:?}");
}

#[test]
fn steps_of_one_code_are_explained() {
    let stepped = |code: f64, fidelity: &str| {
        let change =
            |n: usize, row: &mut Row| row.measured.capacitance_pf = 318.0 + 0.0625 * (n % 3) as f64;
        let codes = Quantities { capacitance_pf: code, ..Quantities::default() };
        let record = Record { codes, fidelity: fidelity.into(), ..plain(changed(60, change)) };
        figure(&check(&record), "Capacitance")
    };
    assert!(stepped(0.0625, "fixed").contains("steps: one code of the core is 0.0625 pF"));
    for (code, fidelity) in [(0.001, "fixed"), (0.0, "fixed"), (0.0625, "float")] {
        assert!(!stepped(code, fidelity).contains("one code"), "{code} {fidelity}");
    }
}

#[test]
fn what_is_read_is_compared_with_what_is_true() {
    let off = |_: usize, row: &mut Row| {
        row.measured.force_n = 0.087;
        row.truth.as_mut().expect("a truth").quantities.force_n = 0.032;
    };
    let drawn = figure(&check(&plain(changed(60, off))), "Haptic force");
    assert!(drawn.contains("Measured and true value differ by 0.0550 N at most"), "{drawn}");
}

#[test]
fn walls_targets_and_depths_are_drawn_in_any_scene_that_has_them() {
    let walled = |n: usize, row: &mut Row| {
        let depth_mm = n as f64 / 30.0 - 1.0;
        let wall = Some(WallPlace { surface_mm: 5.0, depth_mm });
        row.driven = Some(Driven { target_n: 0.4 * depth_mm.max(0.0), wall, ..Driven::default() });
        row.truth.as_mut().expect("a truth").part = 0;
    };
    for figure_name in [None, Some("hockey")] {
        let page =
            check(&Record { figure: figure_name.map(Into::into), ..plain(changed(60, walled)) });
        assert!(figure(&page, "True force and its target").contains("target</li>"));
        assert!(figure(&page, "Depth in the wall").contains("<polyline class=\"s k10\""));
    }
    let page = check(&plain(changed(60, walled)));
    assert!(figure(&page, "Position along x").contains("wall&#39;s surface</li>"));
    assert!(!check(&plain(changed(60, |_, row| row.driven = None))).contains("Depth in the wall"));
}

#[test]
fn every_cell_of_a_phones_list_has_its_head() {
    let page = check(&plain(rows(10)));
    for head in ["measured", "limit (at most)", "for comparison", "share of all effects"] {
        assert!(page.contains(&format!("<td data-head=\"{head}\"")), "{head}");
    }
}

#[test]
fn contents_lead_to_what_is_there() {
    let page = check(&record(Some("hockey"), rows(100)));
    let nav = page.split("</nav>").next().expect("contents");
    let targets: Vec<&str> =
        nav.split("href=\"#").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
    assert!(targets.len() > 10, "{targets:?}");
    for target in targets {
        assert_eq!(page.matches(&format!(" id=\"{target}\"")).count(), 1, "{target}");
    }
    assert!(page.contains("<a href=\"frames &amp; more.csv\">"));
}

#[test]
fn a_report_says_how_to_repeat_its_run() {
    let provenance = Provenance {
        version: "1.2.3".into(),
        commit: Some("0123abcd".into()),
        command: ["hapticore", "simulate", "fig6"].map(Into::into).to_vec(),
        seed: Some(77),
        set: vec![("a.b".into(), "1".into()), ("c".into(), "2".into())],
        ..Provenance::default()
    };
    let date = "2026-11-30T01:02:03Z".into();
    let page = check(&Record { provenance, date, ..plain(rows(10)) });
    let known: Vec<_> = cells(&page, "Provenance").into_iter().map(|row| row[1].clone()).collect();
    let expected = ["1.2.3", "0123abcd", "hapticore simulate fig6", "77", "a.b=1", "c=2"];
    assert_eq!(known, expected);
    assert!(page.contains("<td>date</td><td class=\"code\">2026-11-30T01:02:03Z</td>"));
}

#[test]
fn flags_and_tracking_are_tables_by_kind_case_and_pad() {
    let flagged = Flagged {
        flag: "clipped".into(),
        case: "main".into(),
        pad: "left".into(),
        frames: 3,
        of: 147,
        force_percent: Some(-14.88),
    };
    let tracking = Tracking {
        case: "main".into(),
        pad: "left".into(),
        target_n: 0.5,
        sticking_n: Some(0.02),
        ..Tracking::default()
    };
    let findings =
        Findings { flagged: vec![flagged], tracking: vec![tracking], ..Findings::default() };
    let page = check(&Record { findings, ..plain(rows(10)) });
    assert_eq!(cells(&page, "Flags"), [["clipped", "main", "left", "3", "147", "−14.9 %"]]);
    assert_eq!(
        cells(&page, "Tracking")[0][..6],
        ["main", "left", "0.500 N", "0 N", "0 N", "0.0200 N"]
    );
    assert!(check(&plain(rows(10))).contains("No frame carries a flag."));
}

#[test]
fn a_plot_tells_a_script_where_its_values_lie() {
    let page = check(&plain(changed(60, |_, _| {})));
    let drawn = figure(&page, "Capacitance");
    assert!(drawn.contains("data-log=\"\" data-x-title=\"time (s)\" data-y-title=\"C (pF)\""));
    let numbers = |of: &str| -> Vec<f64> {
        let text =
            drawn.split(&format!("data-{of}=\"")).nth(1).and_then(|rest| rest.split('"').next());
        text.expect("a range").split(' ').map(|n| n.parse().expect("a number")).collect()
    };
    let dot = drawn.split("<circle cx=\"").nth(2).expect("a dot").split('"').next().expect("x");
    let [low, high, start, end] = numbers("x")[..] else { panic!("four numbers") };
    let time_s = low + (high - low) * (dot.parse::<f64>().expect("x") - start) / (end - start);
    assert!(time_s.abs() < 1e-4, "the first dot lies at 0 s: {time_s}");
}
