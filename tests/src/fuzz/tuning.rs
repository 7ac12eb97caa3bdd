// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tunings of force controllers: TOML in, words of the printed loop's ports out.

use std::sync::LazyLock;

use hapticore::control_words;
use hapticore_contract::profile::Profile;
use hapticore_run::tuning_file::TuningFile;

use super::{TOML, refused, seeds};

static PROFILE: LazyLock<Profile> = LazyLock::new(seeds::walled);

pub(super) fn check(data: &[u8]) -> bool {
    let Ok(text) = str::from_utf8(data) else { return false };
    match TuningFile::parse(text, TOML, &PROFILE) {
        Err(error) => refused(error, TOML),
        Ok(file) => {
            let written = file.text("a test").expect("plain data");
            let again = TuningFile::parse(&written, TOML, &PROFILE);
            assert_eq!(again.expect("as written"), file, "{written}");
            check_curve(&file);
            true
        }
    }
}

/// The words of the curve are its numbers, to a step of their format.
fn check_curve(file: &TuningFile) {
    let words = control_words::of(&PROFILE, file).expect("a profile with a controller");
    let curve = words.tables.iter().find(|table| table.name == "curve_word").expect("a curve");
    for (&code, &number) in curve.codes.iter().zip(&file.curve) {
        let real = curve.format.real(code);
        assert!((real - number).abs() <= curve.format.lsb(), "{number} became {real}");
    }
}
