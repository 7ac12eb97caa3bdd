// SPDX-License-Identifier: MIT OR Apache-2.0
//! Captures: what `simulate` saved, `replay` reads to the same frames; what another program wrote
//! is read as meant.

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::{Table, expect, finish};

/// The columns that a replay has.
fn measured(path: &Path) -> Vec<Vec<String>> {
    let table = Table::read(path);
    table.rows.into_iter().map(|row| row[..12].to_vec()).collect()
}

/// Simulates with `args`, saving `capture`; replays it; the frames must be the same.
fn check(scene: &str, capture: &str, args: &[&str], replay: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let simulate = [&["simulate", scene, "--capture", capture, "--out", "sim"], args].concat();
    finish(folder.path(), &simulate);
    expect(folder.path(), &[&["replay", capture, "--out", "rep"], replay].concat(), 0);
    let [sim, rep] =
        ["sim", "rep"].map(|name| measured(&folder.path().join(name).join("frames.csv")));
    assert!(!sim.is_empty());
    assert!(sim == rep, "{scene}, {capture}: the same frames");
}

const SHORT: [&str; 2] = ["--set", "duration_s=0.05"];

#[test]
fn a_csv_capture_replays_to_the_frames_of_the_simulation() {
    check("hockey", "hockey.csv", &SHORT, &[]);
}

#[test]
fn a_wav_capture_replays_to_the_frames_of_the_simulation() {
    check("hockey", "hockey.wav", &SHORT, &["--core", "clock"]);
}

#[test]
fn a_capture_of_another_profile_and_one_case_replays() {
    let raster =
        ["--case", "500-ohm", "--profile", "small", "--set", "pad.0.position_mm.raster.nx=2"];
    check("fig3", "edge.wav", &raster, &["--profile", "small"]);
}

#[test]
fn samples_after_the_last_whole_slot_are_reported_and_left_out() {
    let folder = tempfile::tempdir().unwrap();
    finish(
        folder.path(),
        &["simulate", "hockey", "--capture", "h.csv", "--set", "duration_s=0.02"],
    );
    let text = fs::read_to_string(folder.path().join("h.csv")).unwrap();
    let kept = 3 + 2 * 1700 + 77;
    let cut: String = text.split_inclusive('\n').take(kept).collect();
    fs::write(folder.path().join("h.csv"), cut).unwrap();
    let log = String::from_utf8(expect(folder.path(), &["replay", "h.csv"], 0).stdout).unwrap();
    assert!(log.contains("77 samples at the end"), "{log}");
    assert_eq!(Table::read(&folder.path().join("out/replay-h.csv/frames.csv")).rows.len(), 2);
}

#[test]
fn any_number_of_pads_is_served_and_one_that_is_not_the_calibrations_is_said() {
    let folder = tempfile::tempdir().unwrap();
    finish(
        folder.path(),
        &["simulate", "hockey", "--capture", "h.wav", "--set", "duration_s=0.03"],
    );
    for pads in ["1", "5", "256"] {
        let output = expect(folder.path(), &["replay", "h.wav", "--pads", pads], 0);
        let log = String::from_utf8(output.stderr).unwrap();
        assert!(log.contains(&format!("--pads {pads}: the calibration is of ")), "{log}");
    }
}

#[test]
fn what_changes_the_samples_changes_the_folder() {
    let folder = tempfile::tempdir().unwrap();
    finish(
        folder.path(),
        &["simulate", "hockey", "--capture", "h.csv", "--set", "duration_s=0.03", "--out", "sim"],
    );
    let names = "i1,i2,i3,i4,i5,i6,v_sense,v_haptic,pad";
    let runs: [&[&str]; 5] = [
        &[],
        &["--channels", names],
        &["--full-scale-v", "131072"],
        &["--skip", "1700"],
        &["--truncated"],
    ];
    for run in runs {
        expect(folder.path(), &[&["replay", "h.csv"], run].concat(), 0);
    }
    assert_eq!(fs::read_dir(folder.path().join("out")).unwrap().count(), runs.len());
}

#[test]
fn samples_that_are_lost_break_one_frame_and_leave_the_others_alone() {
    let folder = tempfile::tempdir().unwrap();
    finish(
        folder.path(),
        &["simulate", "hockey", "--capture", "h.csv", "--set", "duration_s=0.05", "--out", "sim"],
    );
    let text = fs::read_to_string(folder.path().join("h.csv")).unwrap();
    let without_pad =
        |line: &str| line.rsplit_once(',').map_or(line.into(), |(row, _)| format!("{row}\n"));
    let lines: Vec<String> = text.lines().map(without_pad).collect();
    let head = |line: &String| {
        if line.starts_with('#') { format!("{}\n", line.trim_end()) } else { line.clone() }
    };
    let lost = 3 + 9 * 1700 + 500..3 + 9 * 1700 + 800;
    let kept =
        lines.iter().enumerate().filter(|(n, _)| !lost.contains(n)).map(|(_, line)| head(line));
    fs::write(folder.path().join("lost.csv"), kept.collect::<String>()).unwrap();
    let args = ["replay", "lost.csv", "--calibration", "h.csv.calibration.toml", "--out", "rep"];
    let output = expect(folder.path(), &args, 0);
    let log = String::from_utf8(output.stderr).unwrap();
    assert!(log.contains("1 of ") && log.contains("the first at sample 15300"), "{log}");
    let [sim, rep] =
        ["sim", "rep"].map(|name| measured(&folder.path().join(name).join("frames.csv")));
    assert_eq!(sim.len(), rep.len());
    let off: Vec<usize> = (0..sim.len()).filter(|n| sim[*n] != rep[*n]).collect();
    assert_eq!(off, [9]);
    assert!(rep[9][11].contains("broken"), "{:?}", rep[9]);
}

/// Amplitudes of the currents, the sensing and the haptic voltage, as fractions of full scale.
const CURRENTS: [f64; 6] = [0.05, 0.06, 0.08, 0.07, 0.04, 0.03];
const SENSE: f64 = 0.625;
const HAPTIC: f64 = 0.5;

/// Writes three slots of sines, currents a quarter turn ahead of the voltage, as CSV of 18 bits and
/// as WAV of 16 bits.
const SCRIPT: &str = "
import math, struct, wave
currents, sense, haptic = [CURRENTS], SENSE, HAPTIC
def rows(full):
    for n in range(3 * 1700):
        turn = math.tau * (n % 1700) * 101 / 1000 # the carrier of `standard`, which begins with each slot
        row = [-a * math.sin(turn) for a in currents] + [sense * math.cos(turn), haptic * math.sin(math.tau * n / 1000)]
        yield [round(full * x) for x in row]
with open('sine.csv', 'w') as f:
    f.write('# bits = 18\\n# written by another program\\nv_sense, v_haptic, i6, i5, i4, i3, i2, i1\\n')
    for r in rows(2**17):
        f.write(', '.join(str(x) for x in [r[6], r[7]] + r[5::-1]) + '\\n')
with wave.open('sine.wav', 'wb') as f:
    f.setnchannels(8); f.setsampwidth(2); f.setframerate(1000000)
    f.writeframes(b''.join(struct.pack('<8h', *r) for r in rows(2**15)))
";

#[test]
#[cfg_attr(not(tool = "python3"), ignore = "needs python3: ./test fetches what is missing")]
fn captures_written_by_another_program_are_read_as_meant() {
    let folder = tempfile::tempdir().unwrap();
    let script = SCRIPT
        .replace("CURRENTS", &CURRENTS.map(|a| a.to_string()).join(", "))
        .replace("SENSE", &SENSE.to_string())
        .replace("HAPTIC", &HAPTIC.to_string());
    let mut python = Command::new("python3");
    let status = python.args(["-c", &script]).current_dir(folder.path()).status();
    assert!(status.expect("Python runs").success());
    for (capture, out) in [("sine.csv", "csv"), ("sine.wav", "wav")] {
        expect(folder.path(), &["replay", capture, "--out", out], 0);
        check_sines(&Table::read(&folder.path().join(out).join("frames.csv")));
    }
}

/// Against the equations, worked out here; the nominal device has 4 mA, 8 V and 600 V at full
/// scale.
fn check_sines(frames: &Table) {
    let near = |name: &str, expected: f64, tolerance: f64| {
        for got in frames.numbers(name) {
            assert!((got - expected).abs() < tolerance, "{name}: {got}, expected {expected}");
        }
    };
    assert_eq!(frames.column("pad"), ["0", "1", "2"]);
    // The middles of the long edges count as the corners do: the ratios are the currents' centroid.
    let [a, b, c, d, bottom, top] = CURRENTS;
    let total: f64 = CURRENTS.iter().sum();
    near("r_x", (c + d - a - b) / total, 2e-4);
    near("r_y", (a + d + top - b - c - bottom) / total, 2e-4);
    near("haptic_v_rms", 600.0 * HAPTIC / 2f64.sqrt(), 0.05);
    let (current, voltage, sheet) =
        (4e-3 * CURRENTS.iter().sum::<f64>(), 8.0 * SENSE, frames.numbers("sheet_ohm")[0]);
    let drop = current * sheet;
    near(
        "capacitance_pf",
        1e12 * current / (TAU * 101e3 * (voltage * voltage - drop * drop).sqrt()),
        0.1,
    );
}
