// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes: TOML in, a plant out.

use std::ops::RangeInclusive;

use hapticore_scene::{Case, Plant, Scene, Timing};

use super::{TOML, refused};

/// Sheets that are quick to make: a fuzzer's time is not for meshes and large tables.
const QUICK: [&str; 4] = ["distance", "analytic", "bilinear 8 × 8", "bicubic 8 × 8"];

pub(super) fn check(data: &[u8]) -> bool {
    let Ok(text) = str::from_utf8(data) else { return false };
    match Scene::parse(text, TOML, &[]) {
        Err(error) => refused(error, TOML),
        Ok(scene) => {
            scene.cases.iter().take(8).for_each(check_document);
            if scene.cases.iter().all(is_quick) {
                run(scene);
            }
            true
        }
    }
}

/// The document of a case is a scene of this case alone.
fn check_document(case: &Case) {
    let again = Scene::parse(&case.document, TOML, &[]);
    let again = again.unwrap_or_else(|error| panic!("{error} of {}", case.document));
    assert_eq!(again.cases.len(), 1);
    let again = &again.cases[0];
    assert_eq!(again.document, case.document);
    assert_eq!((again.effects(), again.pad_names()), (case.effects(), case.pad_names()));
}

fn is_quick(case: &Case) -> bool {
    let mut sheets = case.effects().into_iter().filter(|(name, _)| *name == "sheet");
    sheets.all(|(_, level)| QUICK.contains(&level))
}

/// Numbers of slots of a case for which levels are not chosen here: that evaluates each slot. More are refused.
const MANY_SLOTS: RangeInclusive<usize> = 100_000..=1_000_000;

/// A slot of each pad, of a few samples.
fn run(scene: Scene) {
    let timing = Timing {
        pads: 1,
        slot_samples: 24,
        window_start: 4,
        window_samples: 20,
        samples_per_period: 5.0,
        signs: None,
    };
    if scene.cases.iter().any(|case| MANY_SLOTS.contains(&case.slots(&timing))) {
        return;
    }
    let Ok(scene) = scene.within_budget(&timing).map_err(|error| refused(error, TOML)) else {
        return;
    };
    match Plant::new(&scene, 0, &timing) {
        Err(error) => assert_eq!(error.to_string().lines().count(), 1, "{error}"),
        Ok(mut plant) => (0..plant.slots().min(plant.served())).for_each(|slot| {
            let mut samples = Vec::new();
            plant.truth(slot);
            plant.samples(slot, 4..24, &mut samples);
            assert_eq!(samples.len(), 20 * plant.channels());
        }),
    }
}
