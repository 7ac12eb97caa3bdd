// SPDX-License-Identifier: MIT OR Apache-2.0
//! Files of version 0.1.0 (`tests/fixtures/0.1.0`) are read.

use std::fs;
use std::path::Path;

use crate::{expect, finish};

/// A file of version 0.1.0, put into a folder.
fn put(folder: &Path, name: &str) {
    let files = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/0.1.0");
    fs::copy(files.join(name), folder.join(name)).unwrap();
}

/// The keys that version 0.1.0 wrote of a calibration.
fn of_0_1_0(calibration: &str) -> String {
    const KEYS: [&str; 13] = [
        "pads",
        "x",
        "y",
        "sample_rate_hz",
        "carrier_hz",
        "current_full_scale_a",
        "sense_full_scale_v",
        "haptic_full_scale_v",
        "force_k",
        "pad_diameter_mm",
        "columns",
        "open_share",
        "places",
    ];
    let known = calibration.split("\n[shares]").next().unwrap().lines();
    let is_old = |line: &&str| line.split_once(" = ").is_none_or(|(key, _)| KEYS.contains(&key));
    known.filter(is_old).map(|line| format!("{line}\n")).collect()
}

#[test]
fn scenes_profiles_and_calibrations_of_version_0_1_0_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for name in ["hockey.toml", "fig7.toml", "standard.toml"] {
        put(at, name);
    }
    let quick = ["--core", "float", "--set", "carrier.rung=phasor", "--out", "fig7"];
    finish(at, &[&["simulate", "fig7.toml"][..], &quick].concat());
    let simulate = ["simulate", "hockey.toml", "--profile", "standard.toml", "--capture", "h.wav"];
    expect(at, &[&simulate[..], &["--out", "simulated"]].concat(), 0);
    let calibration = fs::read_to_string(at.join("h.wav.calibration.toml")).unwrap();
    let old = of_0_1_0(&calibration);
    assert!(calibration.contains("contact_pf") && !old.contains("contact_pf"));
    fs::write(at.join("old.toml"), old).unwrap();
    let replay = ["replay", "h.wav", "--calibration", "old.toml", "--profile", "standard.toml"];
    expect(at, &[&replay[..], &["--out", "replayed"]].concat(), 0);
    let rows =
        |run: &str| fs::read_to_string(at.join(run).join("frames.csv")).unwrap().lines().count();
    assert_eq!(rows("replayed"), rows("simulated"));
}
