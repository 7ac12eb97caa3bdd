// SPDX-License-Identifier: MIT OR Apache-2.0
//! The recording that `hapticore-host` is tested and shown with: what the host of a simulated
//! iCEBreaker heard of `hockey`.
//!
//! Made anew by `RECORD=write cargo test --profile checked -p hapticore-tests --test board
//! icebreaker_returns`.

use super::SLOTS;
use hapticore_contract::profile::Profile;
use hapticore_host::{COLUMNS, DeviceCalibration, Raster};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// This many bytes of the end: heartbeats, the first of them from its middle on, then the frames.
pub const BYTES: usize = 400;

/// Of the calibration's raster every tenth place along either axis: what reads frames needs its
/// ends only.
const THINNED: usize = 10;

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../host/recordings").join(name)
}

/// Checks that the committed recording is what the board sends, or writes it.
pub fn check(bytes: &[u8], profile: &Profile, device: &DeviceCalibration) {
    assert_eq!(profile.name, "small");
    compare("hockey.bin", bytes);
    compare("hockey.frames.csv", frames(profile).as_bytes());
    compare("hockey.calibration.toml", thinned(device).text().as_bytes());
}

fn compare(name: &str, fresh: &[u8]) {
    if std::env::var("RECORD").is_ok_and(|what| what == "write") {
        fs::write(file(name), fresh).expect("written");
    }
    let committed = fs::read(file(name)).expect("a recording");
    assert!(
        committed == fresh,
        "host/recordings/{name} is not fresh: record it anew as tests/tests/board/recording.rs says"
    );
}

/// The frames of the recorded slots, as the command writes them.
fn frames(profile: &Profile) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = Command::new(env!("CARGO_BIN_EXE_hapticore-command"));
    command.args(["simulate", "hockey", "--profile", &profile.name, "--out"]).arg(folder.path());
    assert!(command.output().expect("a run").status.success());
    let text = fs::read_to_string(folder.path().join("frames.csv")).expect("frames");
    let columns =
        |line: &str| line.split(',').take(COLUMNS.len()).collect::<Vec<_>>().join(",") + "\n";
    text.lines().take(1 + SLOTS).map(columns).collect()
}

fn thinned(device: &DeviceCalibration) -> DeviceCalibration {
    let columns = device.map.columns;
    let is_kept =
        |k: usize| (k % columns).is_multiple_of(THINNED) && (k / columns).is_multiple_of(THINNED);
    let places =
        device.map.places.iter().enumerate().filter(|(k, _)| is_kept(*k)).map(|(_, place)| *place);
    let map = Raster {
        columns: columns.div_ceil(THINNED),
        places: places.collect(),
        ..device.map.clone()
    };
    DeviceCalibration { map, ..device.clone() }
}
