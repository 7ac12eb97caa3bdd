// SPDX-License-Identifier: MIT OR Apache-2.0
//! Waveforms of a run: another program's reader finds the frames in them, and the bundled views fit
//! the core and the force loop.

use std::fs;
use std::path::Path;

use hapticore_contract::control::{Control, Law};
use hapticore_contract::frame::Field;
use hapticore_contract::profile::{Profile, Wall};
use hapticore_hdl::probe::Signals;
use hapticore_model::blocks::core::Core;
use hapticore_model::blocks::force_loop::ForceLoop;
use hapticore_rtl::netlist;
use hapticore_waveforms::declarations::{Declarations, Signal};
use hapticore_waveforms::pattern::fits;
use hapticore_waveforms::timebase::Timebase;
use hapticore_waveforms::view::View;
use wellen::simple::Waveform;
use wellen::{SignalRef, SignalValueRef};

use crate::{Table, finish};

/// The drive's full scale in `fig9`, V RMS.
const FULL_SCALE_V: f64 = 500.0;

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

/// The times of clocks: half a clock later nothing but the clock changes.
fn clocks(waves: &mut Waveform, core: &str) -> Vec<u32> {
    let root: Vec<_> = core.split('.').take(2).collect();
    let clock = values(waves, &format!("{}.clock", root.join(".")), false);
    clock.iter().filter(|(_, code)| *code == 1).map(|(time, _)| *time).collect()
}

/// The frames in the waves of a core: codes of all fields.
fn frames(waves: &mut Waveform, core: &str) -> Vec<Vec<i64>> {
    let clocks = clocks(waves, core);
    let [valid, index] = ["valid", "index"]
        .map(|name| values(waves, &format!("{core}.u_estimator.u_frames.{name}"), false));
    let word = values(waves, &format!("{core}.u_estimator.u_frames.word"), true);
    let mut frames = Vec::new();
    for time in clocks.into_iter().filter(|time| at(&valid, *time) == 1) {
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
    let frames = frames(&mut waves, "bench.core");
    assert!(frames.len() >= 2, "two frames at least");
    compare(&frames, &Table::read(&out.join("frames.csv")), first);
    compare_truth(&mut waves, "bench.core", &Table::read(&out.join("frames.csv")), first);
    let forces = values(&mut waves, "bench.core.u_estimator.u_force_estimator.haptic_force", false);
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
fn compare_truth(waves: &mut Waveform, core: &str, table: &Table, first: usize) {
    let valid = values(waves, &format!("{core}.u_estimator.u_frames.valid"), false);
    let index = values(waves, &format!("{core}.u_estimator.u_frames.index"), false);
    let first_word = |time: &u32| at(&valid, *time) == 1 && at(&index, *time) == 0;
    let starts: Vec<u32> = clocks(waves, core).into_iter().filter(first_word).collect();
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
    let expected = [
        "bench.core.u_estimator.u_force_estimator.haptic_force[19:0]",
        "truth.force_n",
        "waves.bench.core.u_estimator.u_position.surface.txt",
    ];
    check_shown(out, &expected);
}

fn check_shown(out: &Path, expected: &[&str]) {
    let save = fs::read_to_string(out.join("waves.gtkw")).unwrap();
    for shown in expected {
        assert!(save.contains(shown), "{shown}");
    }
}

/// A force loop in the waves: frames, truth and drive words are those of the run, which changes the
/// drive with every slot.
fn check_loop(args: &[&str], first: usize) {
    let folder = tempfile::tempdir().unwrap();
    // The curve is far above what the measured capacitance asks for, so that the loop is closed.
    let set = [
        ["--set", "duration_s=0.008"],
        ["--set", "control.curve_factor=1.5"],
        ["--set", "pad.0.target_n={ timeline = [[0, 0.1], [0.008, 0.3]] }"],
    ];
    let common = ["simulate", "fig9", "--core", "clock", "--waves", "vcd", "--out", "o"];
    let case = ["--case", "square 0.6 N, closed loop"];
    finish(folder.path(), &[&common, &case[..], &set.concat(), args].concat());
    let out = folder.path().join("o");
    let mut waves = wellen::simple::read(out.join("waves.vcd")).expect("waves that others read");
    let frames = frames(&mut waves, "bench.force_loop.u_core");
    assert!(frames.len() >= 2, "two frames at least");
    let table = Table::read(&out.join("frames.csv"));
    compare(&frames, &table, first);
    compare_truth(&mut waves, "bench.force_loop.u_core", &table, first);
    compare_drives(&mut waves, &table, first);
    check_truth_times(&mut waves);
    let task = "waves.bench.force_loop.u_drives.u_controller.task_q.txt";
    check_shown(
        &out,
        &["bench.force_loop.u_drives.u_controller.drive_q[", "truth.haptic_v_rms", task],
    );
    let names = fs::read_to_string(out.join(task)).unwrap();
    assert!(names.contains("inverse_root"), "{names}");
}

/// The truth changes at ends of slots, which are of 1 ms; first it is what the window begins with.
fn check_truth_times(waves: &mut Waveform) {
    let signal = signal(waves, "truth.force_n");
    waves.load_signals(&[signal]);
    let changes = waves.get_signal(signal).expect("loaded").iter_changes();
    let times: Vec<u64> = changes.skip(1).map(|(at, _)| waves.time_table()[at as usize]).collect();
    let timescale = waves.hierarchy().timescale().expect("a timescale");
    let exponent = timescale.unit.to_exponent().expect("a unit of time");
    let ticks_per_slot = 10u64.pow((-3 - i32::from(exponent)) as u32) / u64::from(timescale.factor);
    assert!(!times.is_empty());
    assert!(times.iter().all(|time| time.is_multiple_of(ticks_per_slot)), "{times:?}");
}

/// Drive words and targets at each `done`, in volts and newtons.
fn compare_drives(waves: &mut Waveform, table: &Table, first: usize) {
    let control = Control::of(&Profile::bundled("standard").unwrap(), Law::Inverse);
    let done = values(waves, "bench.force_loop.u_drives.u_controller.done", false);
    let drive = values(waves, "bench.force_loop.u_drives.u_controller.drive_q", false);
    let target = values(waves, "bench.force_loop.u_drives.target", false);
    let (volts, targets) = (table.numbers("drive_v_rms"), table.numbers("target_n"));
    let given: Vec<u32> = done.iter().filter(|(_, code)| *code == 1).map(|(at, _)| *at).collect();
    assert!(given.len() >= 2 && volts[first] != volts[first + 1], "{volts:?}");
    for (slot, time) in (first..).zip(given) {
        assert_eq!(FULL_SCALE_V * control.drive.real(at(&drive, time)), volts[slot], "{slot}");
        let off_n = control.target.real(at(&target, time)) - targets[slot];
        assert!(off_n.abs() <= control.target.lsb() / 2.0, "slot {slot}: {off_n} N");
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
fn the_waves_of_a_force_loop_hold_its_frames_and_drives() {
    check_loop(&[], 0);
}

#[test]
fn a_later_window_of_a_force_loop_holds_what_led_to_it() {
    // The drive words of slots 3 to 5 and their frames, which come 4 to 6 ms after the start.
    check_loop(&["--waves-window", "0.0037..0.0064"], 3);
}

#[test]
fn every_pattern_of_a_bundled_view_finds_signals() {
    let standard = Profile::bundled("standard").unwrap();
    let control = Some(Control::of(&standard, Law::Inverse));
    let controlled = Profile { control, ..standard.clone() };
    let walled = Profile { wall: Some(Wall::A), pads: Wall::A.parts, ..controlled.clone() };
    check_patterns("slot", &paths(netlist::signals_of_core(&Core::new(&standard))));
    let of_loop = |profile: &Profile| {
        let force_loop = ForceLoop::try_new(profile).expect("a controller");
        paths(netlist::signals_of_force_loop(&force_loop))
    };
    // Of a split pad others ask for a drive word.
    check_patterns("force_loop", &[of_loop(&controlled), of_loop(&walled)].concat());
}

fn paths(signals: Signals) -> Vec<String> {
    let timebase = Timebase::of_clock(25_000_000).unwrap();
    let declarations = Declarations::new(signals, &[], true, timebase).unwrap();
    declarations.signals().iter().map(Signal::path).collect()
}

fn check_patterns(view: &str, paths: &[String]) {
    let groups = View::bundled(view).unwrap().groups;
    let patterns = groups.iter().flat_map(|group| &group.signals).map(|entry| entry.show.get_ref());
    let of_core = patterns.filter(|pattern| !pattern.starts_with("truth"));
    let unknown: Vec<_> =
        of_core.filter(|pattern| !paths.iter().any(|path| fits(pattern, path))).collect();
    assert_eq!(unknown, [""; 0], "{view}");
}

#[test]
fn the_default_window_of_a_loop_has_its_first_target_and_marks_its_results() {
    let folder = tempfile::tempdir().unwrap();
    let case = "square 0.6 N, closed loop";
    let args = ["simulate", "fig9", "--case", case, "--set", "duration_s=0.06", "--waves", "fst"];
    finish(folder.path(), &[&args[..], &["--out", "o"]].concat());
    let out = folder.path().join("o");
    let mut waves = wellen::simple::read(out.join("waves.fst")).expect("waves that others read");
    let target = values(&mut waves, "bench.force_loop.u_drives.target", false);
    let moves = target.windows(2).any(|pair| pair[0].1 == 0 && pair[1].1 > 0);
    assert!(moves, "the target of 0.6 N begins after 50 ms: {target:?}");
    let view = fs::read_to_string(out.join("waves.results.gtkw")).unwrap();
    let line = |start: &str| view.lines().find(|line| line.starts_with(start)).unwrap().to_owned();
    let numbers = |line: &str| -> Vec<f64> {
        line.split([' ', '*']).filter_map(|word| word.parse().ok()).collect()
    };
    let [start] = numbers(&line("[timestart]"))[..] else { panic!("a start: {view}") };
    // Ticks of nanoseconds: the target comes with the end of a slot of 1 ms.
    let marks = numbers(&line("*"))[2..].to_vec();
    let names: Vec<_> =
        view.lines().filter_map(|line| line.strip_prefix("[markername] ")).collect();
    assert_eq!(names, ["Awindow end", "Bdrive word", "Cframe"]);
    assert_eq!(marks[0], 50e6);
    assert!(start < marks[0] && marks.is_sorted() && marks[2] < 50.5e6, "{start}, {marks:?}");
}
