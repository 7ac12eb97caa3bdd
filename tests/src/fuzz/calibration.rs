// SPDX-License-Identifier: MIT OR Apache-2.0
//! Calibrations of devices: TOML in, words of a core out.

use std::sync::LazyLock;

use hapticore_contract::profile::Profile;
use hapticore_host::DeviceCalibration;

use super::{Planted, TOML, all_hold, planted, refused};

static PROFILE: LazyLock<Profile> =
    LazyLock::new(|| Profile::bundled("small").expect("a bundled profile"));

pub(super) fn check(data: &[u8]) -> bool {
    let Ok(text) = str::from_utf8(data) else { return false };
    match DeviceCalibration::parse(text, TOML) {
        Err(error) => refused(error, TOML),
        Ok(device) => {
            check_text(&device);
            check_words(&device);
            true
        }
    }
}

/// The file of a calibration is read to the same.
pub(super) fn check_text(device: &DeviceCalibration) {
    let again = DeviceCalibration::parse(&written(device), TOML);
    let again = again.unwrap_or_else(|error| panic!("{error} of {}", device.text()));
    assert_eq!(&again, device);
}

fn written(device: &DeviceCalibration) -> String {
    let mut device = device.clone();
    let rows = device.map.places.len() / device.map.columns;
    let is_odd = [device.force.is_some(), device.pads > 4, rows > device.map.columns];
    if planted(Planted::Calibration) && all_hold(&is_odd) {
        device.map.columns = rows;
    }
    device.text()
}

/// A core's words represent it, or it is refused.
fn check_words(device: &DeviceCalibration) {
    let Ok(profile) = device.profile(&PROFILE) else { return };
    let Ok(calibration) = device.for_profile(&profile) else { return };
    assert!(calibration.words(&profile).iter().all(|word| word.is_finite()));
    device.residual(&calibration);
}
