// SPDX-License-Identifier: MIT OR Apache-2.0
//! A lab's measurements: setup, places and loads in, a calibration out; or capacitances under loads in, a gap out.

use std::sync::LazyLock;

use hapticore_contract::profile::Profile;
use hapticore_run::lab::{self, Data, gap};
use hapticore_scene::Scene;

use super::calibration::check_text;

static PROFILE: LazyLock<Profile> =
    LazyLock::new(|| Profile::bundled("small").expect("a bundled profile"));

/// What the files are called; their messages name one of them, or say that one is missing.
const FILES: [&str; 3] = ["setup.toml", "places.csv", "loads.csv"];

pub(super) fn check(data: &[u8]) -> bool {
    let Ok(text) = str::from_utf8(data) else { return false };
    let files: Vec<_> = FILES
        .iter()
        .zip(text.split('\0'))
        .map(|(file, text)| (file.to_string(), text.to_string()))
        .collect();
    let gap = gap::Data::of(&files).and_then(|data| data.map(|data| data.fit()).transpose());
    if let Ok(Some(outcome)) = &gap {
        let scene = format!("title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n{}", outcome.text());
        assert!(outcome.rms_percent.is_finite(), "{outcome:?}");
        // A scene may have narrower limits than a table.
        if let Err(error) = Scene::parse(&scene, "t.toml", &[]) {
            assert!(error.to_string().contains("expected"), "{error}");
        }
        return true;
    }
    if let Err(error) = &gap {
        return refused(error);
    }
    let made = Data::of(&files).and_then(|data| lab::calibrate(&data, &PROFILE));
    match made {
        Err(error) => refused(&error),
        Ok((device, outcome)) => {
            check_text(&device);
            assert!(outcome.own_places.rms_mm.is_finite(), "{outcome:?}");
            true
        }
    }
}

/// What a refusal is: a line that names the place.
fn refused(error: &anyhow::Error) -> bool {
    let line = hapticore::one_line(error);
    assert!(line.contains(": ") && !line.chars().any(char::is_control), "{line:?}");
    false
}
