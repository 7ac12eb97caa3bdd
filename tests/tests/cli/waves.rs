// SPDX-License-Identifier: MIT OR Apache-2.0
//! Waveforms of a run: another program's reader finds the frames in them, and the bundled view fits
//! the core.

use std::fs;
use std::path::Path;

use hapticore_contract::frame::Field;
use hapticore_contract::profile::Profile;
use hapticore_hdl::probe::variables;
use hapticore_model::blocks::core::Core;
use hapticore_waveforms::pattern::fits;
use hapticore_waveforms::view::View;
use wellen::simple::Waveform;
use wellen::{SignalRef, SignalValueRef};

use crate::{Table, finish};

/// The values of a signal: time-table index and code.
fn values(waves: &mut Waveform, path: &str, signed: bool) -> Vec<(u32, i64)> {
    let signal = signal(waves, path);
    waves.load_signals(&[signal]);
    let signal = waves.get_signal(signal).expect("loaded");
    signal.iter_changes().map(|(time, value)| (time, code(&value, signed))).collect()
}

fn signal(waves: &Waveform, path: &str) -> SignalRef {
    let names: Vec<_> = path.split('.').collect();
    let (name, scopes) = names.split_last().expect("a path");
    let hierarchy = waves.hierarchy();
    hierarchy[hierarchy.lookup_var(scopes, name).unwrap_or_else(|| panic!("no signal {path}"))]
        .signal_ref()
}

fn code(value: &SignalValueRef, signed: bool) -> i64 {
    let bits = value.to_bit_string().expect("bits");
    // Before the window begins nothing is known.
    let Ok(code) = i64::from_str_radix(&bits, 2) else { return i64::MIN };
    if signed && bits.starts_with('1') { code - (1 << bits.len()) } else { code }
}

/// What a signal is at a time.
fn at(values: &[(u32, i64)], time: u32) -> i64 {
    values[values.partition_point(|(when, _)| *when <= time) - 1].1
}

/// The frames in the waves: codes of all fields.
fn frames(waves: &mut Waveform) -> Vec<Vec<i64>> {
    let [valid, index] = ["valid", "index"]
        .map(|name| values(waves, &format!("core.estimator.frames.{name}"), false));
    let word = values(waves, "core.estimator.frames.word", true);
    let mut frames = Vec::new();
    let end = waves.time_table().len() as u32;
    for time in (0..end).filter(|time| at(&valid, *time) == 1) {
        if at(&index, time) == 0 {
            frames.push(Vec::new());
        }
        frames.last_mut().expect("a frame begins with its first word").push(at(&word, time));
    }
    frames
}

fn check(kind: &str, args: &[&str], first: usize) {
    let folder = tempfile::tempdir().unwrap();
    let common = ["simulate", "hockey", "--waves", kind, "--out", "o", "--set", "duration_s=0.03"];
    finish(folder.path(), &[&common, args].concat());
    let out = folder.path().join("o");
    let mut waves =
        wellen::simple::read(out.join(format!("waves.{kind}"))).expect("waves that others read");
    let frames = frames(&mut waves);
    assert!(frames.len() >= 2, "two frames at least");
    compare(&frames, &Table::read(&out.join("frames.csv")), first);
    compare_truth(&mut waves, &Table::read(&out.join("frames.csv")), first);
    let forces = values(&mut waves, "core.estimator.force_estimator.haptic_force", false);
    let force = Profile::bundled("standard").unwrap().formats.force;
    let last = Table::read(&out.join("frames.csv")).numbers("force_n")[first + frames.len() - 1];
    assert!(forces.iter().any(|(_, code)| force.real(*code) == last), "the register held {last} N");
    check_save_file(&out);
}

fn compare(frames: &[Vec<i64>], table: &Table, first: usize) {
    let profile = Profile::bundled("standard").unwrap();
    let fields = [
        (Field::RatioX, "r_x"),
        (Field::RatioY, "r_y"),
        (Field::X, "x_mm"),
        (Field::Y, "y_mm"),
        (Field::Capacitance, "capacitance_pf"),
        (Field::Force, "force_n"),
    ];
    for (field, name) in fields {
        let column = table.numbers(name);
        for (slot, codes) in frames.iter().enumerate() {
            let value = field.format(&profile).real(codes[field as usize]);
            assert_eq!(value, column[first + slot], "{name} of slot {}", first + slot);
        }
    }
}

/// The truth beside a frame is that of the frame's slot.
fn compare_truth(waves: &mut Waveform, table: &Table, first: usize) {
    let valid = values(waves, "core.estimator.frames.valid", false);
    let index = values(waves, "core.estimator.frames.index", false);
    let end = waves.time_table().len() as u32;
    let starts: Vec<u32> =
        (0..end).filter(|time| at(&valid, *time) == 1 && at(&index, *time) == 0).collect();
    for (name, column) in [("x_mm", "true_x_mm"), ("capacitance_pf", "true_capacitance_pf")] {
        let signal = signal(waves, &format!("truth.{name}"));
        waves.load_signals(&[signal]);
        let changes: Vec<_> = waves.get_signal(signal).expect("loaded").iter_changes().collect();
        for (slot, time) in starts.iter().enumerate() {
            let (_, value) = &changes[changes.partition_point(|(when, _)| when <= time) - 1];
            let SignalValueRef::Real(value) = value else { panic!("truth.{name} is a real") };
            assert_eq!(
                *value,
                table.numbers(column)[first + slot],
                "truth.{name} of slot {}",
                first + slot
            );
        }
    }
}

#[test]
fn a_window_that_makes_a_large_file_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let args = [
        "simulate",
        "hockey",
        "--waves",
        "vcd",
        "--waves-window",
        "0..99",
        "--set",
        "duration_s=0.12",
        "--out",
        "o",
    ];
    let output = finish(folder.path(), &args);
    let log = String::from_utf8(output.stderr).unwrap();
    let written = fs::metadata(folder.path().join("o/waves.vcd")).unwrap().len() as f64 / 1e6;
    assert!(
        log.contains("warning: waves: 0 to 0.1190 s, 2975000 clocks, about ")
            && log.contains("--waves fst"),
        "{log}"
    );
    let told: f64 = log.split("about ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((told / written - 1.0).abs() < 0.3, "told {told} MB, written {written} MB");
}

fn check_save_file(out: &Path) {
    let save = fs::read_to_string(out.join("waves.gtkw")).unwrap();
    for shown in [
        "core.estimator.force_estimator.haptic_force[19:0]",
        "truth.force_n",
        "waves.core.estimator.position.surface.txt",
    ] {
        assert!(save.contains(shown), "{shown}");
    }
}

#[test]
fn the_waves_hold_the_frames_of_the_run() {
    check("vcd", &[], 0);
}

#[test]
fn a_window_later_in_the_run_holds_its_frames() {
    // The frames of slots 6 and 7 come after 11.9 and 13.6 ms and the time that an estimate takes,
    // that of slot 5 before the window.
    check("fst", &["--waves-window", "0.0109..0.0145", "--core", "clock"], 6);
}

#[test]
fn every_pattern_of_the_bundled_view_finds_signals_of_the_core() {
    let core = Core::new(&Profile::bundled("standard").unwrap());
    let paths: Vec<_> = variables(&core, "core")
        .iter()
        .map(|v| format!("{}.{}", v.scope.join("."), v.name))
        .collect();
    for group in View::bundled("slot").unwrap().groups {
        for entry in group.signals {
            let pattern = entry.show.get_ref();
            let found =
                pattern.starts_with("truth") || paths.iter().any(|path| fits(pattern, path));
            assert!(found, "no signal fits {pattern}");
        }
    }
}
