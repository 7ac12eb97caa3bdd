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
