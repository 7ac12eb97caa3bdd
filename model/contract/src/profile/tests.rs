// SPDX-License-Identifier: MIT OR Apache-2.0
//! Profiles whose keys are refused with a reason of their own.

use super::{BUNDLED, Profile};
use crate::control::{Control, Law};

/// A profile with a controller, as text, and this behind it.
fn with(key: &str) -> String {
    let mut profile = Profile::parse(BUNDLED[0].1).expect("bundled");
    profile.control = Some(Control::of(&profile, Law::Inverse));
    let text = toml::to_string(&profile).expect("plain data");
    text.replace("[control]\n", &format!("[control]\n{key}\n"))
}

#[test]
fn silent_frames_are_refused_with_what_takes_their_place() {
    let message = Profile::parse(&with("silent_frames = 4096")).unwrap_err().to_string();
    assert!(message.contains("control.silent_frames: expected control.silent_ms"), "{message}");
    for (ms, holds) in [(1, false), (2, true), (1000, true), (1001, false)] {
        let text = with("").replace("silent_ms = 100", &format!("silent_ms = {ms}"));
        let parsed = Profile::parse(&text).map(|of| of.control.unwrap().silent_ms);
        match holds {
            true => assert_eq!(parsed.unwrap(), ms),
            false => assert_eq!(
                parsed.unwrap_err().to_string(),
                format!("control.silent_ms: expected 2 to 1000, got {ms}")
            ),
        }
    }
    let without = with("").replace("silent_ms = 100\n", "");
    let control = Profile::parse(&without).unwrap().control.unwrap();
    assert!(!without.contains("silent_ms") && control.silent_ms <= 100);
}

#[test]
fn a_folded_controller_is_refused_with_the_reason() {
    assert!(Profile::parse(&with("")).is_ok());
    for value in [true, false] {
        let text = with(&format!("folded = {value}"));
        let line = 1 + text.lines().position(|line| line.starts_with("folded")).expect("a line");
        let message = Profile::parse(&text).unwrap_err().to_string();
        assert!(message.starts_with(&format!("{line}: control.folded: expected")), "{message}");
        assert!(message.contains("iCEBreaker has no pins"), "{message}");
    }
}
