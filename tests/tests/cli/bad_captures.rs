// SPDX-License-Identifier: MIT OR Apache-2.0
//! Captures that are none: one line that says where and why, exit code 2, and nothing left behind.

use std::fs;

use crate::{finish, refuse};

const HEADER: &str = "i1,i2,i3,i4,i5,i6,v_sense,v_haptic,pad";
const ROW: &str = "1,2,3,4,5,6,7,8,0";

fn csv(text: &str, words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bad.csv"), text).unwrap();
    let bits: &[&str] = if text.contains("bits") { &[] } else { &["--bits", "18"] };
    refuse(folder.path(), &[&["replay", "bad.csv"], bits].concat(), words);
}

#[test]
fn integer_codes_without_their_bits() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bad.csv"), format!("{HEADER}\n{ROW}\n")).unwrap();
    refuse(folder.path(), &["replay", "bad.csv"], &["bad.csv:2: i1", "# bits = N", "--bits N"]);
}

#[test]
fn times_of_another_rate() {
    let row = |n: usize, step: f64| format!("{:.7},1,2,3,4,5,6,7,8\n", n as f64 * step);
    for step in [2e-6, 5e-7] {
        let rows: String = (0..20).map(|n| row(n, step)).collect();
        let header = HEADER.trim_end_matches(",pad");
        csv(
            &format!("Time,{header}\n{rows}"),
            &["bad.csv:", "time: expected a sample each 1e-6 s", "resample"],
        );
    }
    csv(
        "Time (us),i1,i2,i3,i4,i5,i6,v_sense,v_haptic\n5,1,2,3,4,5,6,7,8\n4,1,2,3,4,5,6,7,8\n",
        &["bad.csv:3: time: ", "after"],
    );
}

#[test]
fn an_empty_file() {
    csv("", &["bad.csv:1", "header", "i1", "empty"]);
    csv("# bits = 18\n\n", &["bad.csv", "header"]);
    csv(&format!("{HEADER}\n"), &["bad.csv", "expected samples of one slot"]);
}

#[test]
fn a_header_that_is_wrong() {
    csv("i1,i2,i3,i4,i5,i6,v_sense\n1,2,3,4,5,6,7\n", &["bad.csv:1", "v_haptic", "missing"]);
    csv("i1,i2,i3,i4,i5,i6,v_sense,v_haptic,volume\n", &["bad.csv:1", "\"volume\""]);
    csv("i1,i1,i3,i4,i5,i6,v_sense,v_haptic\n", &["bad.csv:1", "i1", "twice"]);
    csv(&format!("{ROW}\n"), &["bad.csv:1", "columns i1", "\"1\""]);
    csv(&format!("# bits = 33\n{HEADER}\n"), &["bad.csv:1", "bits", "2 to 32", "\"33\""]);
    csv(
        &format!("# sample_rate_hz = fast\n{HEADER}\n"),
        &["bad.csv:1", "sample_rate_hz", "\"fast\""],
    );
    csv(
        &format!("# sample_rate_hz = 500000\n{HEADER}\n{ROW}\n"),
        &["bad.csv", "sample_rate_hz", "1000000", "500000"],
    );
}

#[test]
fn numbers_that_are_none() {
    for bad in ["NaN", "1.5", "", "99999999999999999999", "131072", "-131073", "0x10"] {
        let row = ROW.replace('3', bad);
        csv(
            &format!("{HEADER}\n{ROW}\n{row}\n"),
            &["bad.csv:3", "i3", "integer code", &format!("\"{bad}\"")],
        );
    }
    csv(
        &format!("# bits = 8\n{HEADER}\n{}\n", ROW.replace('2', "128")),
        &["bad.csv:3", "i2", "-128 to 127"],
    );
    csv(&format!("{HEADER}\n{}\n", ROW.replace(",0", ",x")), &["bad.csv:2", "pad", "\"x\""]);
}

#[test]
fn rows_that_are_cut_short() {
    csv(&format!("{HEADER}\n{ROW}\n1,2,3\n"), &["bad.csv:3", "expected 9 columns, got 3"]);
    csv(&format!("{HEADER}\n{ROW}\n1,2,3"), &["bad.csv:3", "expected 9 columns, got 3"]);
    csv(&format!("{HEADER}\n{ROW}\n{ROW}"), &["bad.csv:3", "cut short"]);
    csv(&format!("{HEADER}\n{ROW}\n{ROW},9\n"), &["bad.csv:3", "expected 9 columns, got 10"]);
    csv(&format!("{HEADER}\n{ROW}\n\u{0}\u{1}\n"), &["bad.csv:3"]);
}

#[test]
fn a_pad_out_of_turn() {
    let slot = format!("{ROW}\n").repeat(1700);
    csv(
        &format!("{HEADER}\n{slot}{ROW}\n"),
        &["bad.csv:", "sample 1700: pad", "expected 1", "got 0"],
    );
}

#[test]
fn bytes_that_are_no_text() {
    let folder = tempfile::tempdir().unwrap();
    for bytes in [&[0xc3, 0x28, b'\n'][..], b"i\x001\x00\n\x00"] {
        fs::write(folder.path().join("bad.csv"), bytes).unwrap();
        refuse(folder.path(), &["replay", "bad.csv"], &["bad.csv:1"]);
    }
}

#[test]
fn files_that_are_not_there_or_of_another_kind() {
    let folder = tempfile::tempdir().unwrap();
    refuse(folder.path(), &["replay", "none.csv"], &["none.csv"]);
    refuse(folder.path(), &["replay", "none.mp3"], &["none.mp3", ".csv or .wav"]);
    for name in ["bad.wav", "empty.wav"] {
        fs::write(
            folder.path().join(name),
            if name == "bad.wav" { "no waves here, only text" } else { "" },
        )
        .unwrap();
        refuse(folder.path(), &["replay", name], &[name, "expected a WAV file"]);
    }
}

#[test]
fn wav_files_that_are_cut_short_or_too_fine() {
    let folder = tempfile::tempdir().unwrap();
    finish(
        folder.path(),
        &["simulate", "hockey", "--capture", "h.wav", "--set", "duration_s=0.01"],
    );
    let whole = fs::read(folder.path().join("h.wav")).unwrap();
    for length in [20, 60, 1000, whole.len() / 2, whole.len() - 1] {
        fs::write(folder.path().join("h.wav"), &whole[..length]).unwrap();
        refuse(folder.path(), &["replay", "h.wav"], &["h.wav"]);
    }
    fs::write(folder.path().join("h.wav"), &whole).unwrap();
    refuse(
        folder.path(),
        &["replay", "h.wav", "--profile", "small"],
        &["--profile small", "samples per period", "9.9"],
    );
}

#[test]
fn calibrations_that_are_none() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("c.csv"), format!("{HEADER}\n{ROW}\n")).unwrap();
    let calibration = |text: &str, words: &[&str]| {
        fs::write(folder.path().join("c.toml"), text).unwrap();
        refuse(folder.path(), &["replay", "c.csv", "--calibration", "c.toml"], words);
    };
    const DEVICE: &str = "[device]\nsample_rate_hz = 1e6\ncarrier_hz = 1e5\ncurrent_full_scale_a = 0.004\n\
        sense_full_scale_v = 8\nhaptic_full_scale_v = 600\nforce_k = 9.6e12\n[map]\n";
    calibration("", &["c.toml:1", "missing field"]);
    calibration("pads = 1\ncolour = 3\n", &["c.toml:2: colour"]);
    calibration(
        &format!("pads = 0\n{DEVICE}columns = 2\nplaces = []\n"),
        &["c.toml", "pads", "1 to 256", "0"],
    );
    calibration(
        &format!("pads = 1\n{DEVICE}columns = 2\nplaces = []\n"),
        &["c.toml", "map.columns"],
    );
    let nan = "[nan, 0.0, 0.0, 0.0, 0.0], ".repeat(4);
    calibration(
        &format!("pads = 1\n{DEVICE}columns = 2\nplaces = [{nan}]\n"),
        &["c.toml", "map.places", "finite"],
    );
    refuse(folder.path(), &["replay", "c.csv", "--calibration", "none.toml"], &["none.toml"]);
}
