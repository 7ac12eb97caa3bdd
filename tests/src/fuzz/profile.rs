// SPDX-License-Identifier: MIT OR Apache-2.0
//! Profiles: TOML in, a core that can be built out.

use hapticore_contract::profile::{Profile, Window};
use hapticore_model::parse_profile;

use super::{Planted, all_hold, planted};

pub(super) fn check(data: &[u8]) -> bool {
    let Ok(text) = str::from_utf8(data) else { return false };
    match parse_profile(text) {
        Err(error) => {
            let message = error.to_string();
            assert_eq!(message.lines().count(), 1, "{message:?}");
            assert!(message.contains(": "), "neither line nor key in {message:?}");
            false
        }
        Ok(profile) => {
            let written = toml::to_string(&profile).expect("plain data");
            assert_eq!(parse_profile(&written).as_ref(), Ok(&profile), "{written}");
            odd(&profile);
            true
        }
    }
}

/// The planted panic: a corner of four ranges.
fn odd(profile: &Profile) {
    let is_odd = [
        profile.pads > 4,
        profile.haptic.windows > 2,
        profile.slot.open % 2 == 1,
        profile.carrier.window == Window::Rectangular,
    ];
    assert!(!(planted(Planted::Profile) && all_hold(&is_odd)), "planted");
}
