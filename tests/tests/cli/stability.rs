// SPDX-License-Identifier: MIT OR Apache-2.0
//! How stable a force loop is predicted to be, and measured: what is refused, what is warned of,
//! and what is written.

use std::fs;

use serde_json::Value;

use crate::{expect, fields, refuse};

/// The integral law on one case of `fig9`.
fn fig9(integral_v: &str) -> Vec<String> {
    let set = [
        "control.law=integral".to_string(),
        "control.proportional_v=64".into(),
        format!("control.integral_v={integral_v}"),
        "control.force=\"eq8\"".into(),
        "supply=false".into(),
        "criterion=[]".into(),
    ];
    let set = set.into_iter().flat_map(|set| ["--set".to_string(), set]);
    let of = ["simulate", "fig9", "--case", "square 0.6 N, closed loop"].map(String::from);
    of.into_iter().chain(set).collect()
}

#[test]
fn an_unstable_loop_is_refused_unless_it_may_be() {
    let folder = tempfile::tempdir().expect("a folder");
    let args = fig9("1500000");
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    refuse(folder.path(), &args, &["control", "stable loop", "gain margin of 0.", "--unstable"]);
    let args = [&args[..], &["--unstable", "--out", "o"]].concat();
    expect(folder.path(), &args, 0);
}

/// The rail is what the haptic channel reads of a sine: 600 V are 424 V RMS. While the spots of a light pad are open, the
/// proportional law asks for more than that.
#[test]
fn gains_by_default_reach_the_target_under_any_load() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut rng = fastrand::Rng::with_seed(48);
    for law in ["inverse", "integral", "proportional"] {
        for decade in [2.0, 20.0, 200.0] {
            let load_g = decade * (1.0 + 1.5 * rng.f64());
            let scene = format!(
                "title = \"loaded\"\nduration_s = 0.3\n[control]\nlaw = \"{law}\"\nrail_v = 420\n[sheet]\n[gap]\n[friction]\n\
                 [[pad]]\nposition_mm = [0, 0]\nload_g = {load_g}\n\
                 target_n = {{ timeline = [[0.05, 0], [0.05, 0.3]] }}\n"
            );
            fs::write(folder.path().join("loaded.toml"), scene).expect("written");
            expect(folder.path(), &["simulate", "loaded.toml", "--waves", "none", "--out", "o"], 0);
            let summary = fs::read_to_string(folder.path().join("o/summary.json")).expect("one");
            let summary: Value = serde_json::from_str(&summary).expect("JSON");
            let settled = &summary["findings"]["tracking"][0]["settled"];
            let read_n = settled["read_n"].as_f64().unwrap_or_else(|| panic!("{summary}"));
            assert!((read_n - 0.3).abs() < 0.03, "{law}, {load_g} g: {read_n} N");
        }
    }
}

#[test]
fn little_phase_margin_is_warned_of_in_three_places() {
    let folder = tempfile::tempdir().expect("a folder");
    for (integral_v, warned) in [("740000", true), ("300000", false)] {
        let args = fig9(integral_v);
        let args: Vec<&str> = args.iter().map(String::as_str).chain(["--out", "o"]).collect();
        let output = expect(folder.path(), &args, 0);
        let [log, summary, report] = [
            String::from_utf8(output.stderr).expect("text"),
            fs::read_to_string(folder.path().join("o/summary.json")).expect("a summary"),
            fs::read_to_string(folder.path().join("o/report.html")).expect("a report"),
        ];
        for text in [&log, &summary, &report] {
            assert_eq!(text.contains("phase margin of"), warned, "{integral_v}: {text:.300}");
        }
        assert!(report.contains("Predicted stability of force loops"));
        let summary: Value = serde_json::from_str(&summary).expect("JSON");
        let of = &summary["stability"]["square 0.6 N, closed loop"];
        let of = |key: &str| of[key].as_f64().unwrap_or_else(|| panic!("{key} in {of}"));
        assert_eq!(of("frame_s"), 1e-3);
        assert_eq!(of("phase_margin_deg") < 45.0, warned);
        assert!(of("gain_margin") > 1.0 && of("crossover_hz") > 50.0);
        // Half of the window of 600 µs, the drive word's latency, half a frame.
        assert!((of("delay_s") - 820e-6).abs() < 1e-6, "{}", of("delay_s"));
    }
}

#[test]
#[cfg_attr(not(optimised), ignore = "33 runs: run with --release")]
fn a_loop_is_measured_beside_its_prediction() {
    let folder = tempfile::tempdir().expect("a folder");
    let args = fig9("500000");
    let args = args.iter().map(String::as_str).chain(["--bode", "0.3", "--out", "o"]);
    expect(folder.path(), &args.collect::<Vec<_>>(), 0);
    let text = fs::read_to_string(folder.path().join("o/bode.csv")).expect("bode.csv");
    let mut lines = text.lines();
    let head = "case,frequency_hz,gain_db,phase_deg,predicted_gain_db,predicted_phase_deg,target_to_force_db";
    assert_eq!(lines.next(), Some(head));
    let rows: Vec<Vec<f64>> = lines
        .map(|line| fields(line)[1..].iter().map(|text| text.parse().expect("a number")).collect())
        .collect();
    assert!((12..=20).contains(&rows.len()), "{} frequencies", rows.len());
    for row in &rows {
        let [hz, gain, phase, predicted_gain, predicted_phase] = row[..5] else {
            panic!("five numbers")
        };
        assert!((gain - predicted_gain).abs() < 1.0, "{hz} Hz: {gain} dB, {predicted_gain} dB");
        assert!((phase - predicted_phase).abs() < 6.0, "{hz} Hz: {phase}°, {predicted_phase}°");
    }
    let report = fs::read_to_string(folder.path().join("o/report.html")).expect("a report");
    assert!(report.contains("about 0.3") && report.contains("target to true force"));
}

/// Beyond the rail, and below the smallest step of a drive, nothing moves that could be measured.
#[test]
fn a_force_that_no_loop_follows_is_not_measured() {
    let folder = tempfile::tempdir().expect("a folder");
    for force_n in ["100", "1e300", "5e-324"] {
        let run = ["simulate", "fig9", "--set", "duration_s=0.01", "--bode", force_n];
        refuse(folder.path(), &run, &["--bode", "a force that the loop of case", "moves nothing"]);
    }
}
