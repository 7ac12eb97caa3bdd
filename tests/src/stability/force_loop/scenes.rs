// SPDX-License-Identifier: MIT OR Apache-2.0
//! The whole loop of a scene at fidelity `fixed`, slot by slot: the core is calibrated and tuned to one
//! device and drives another, which may be the same.

use std::sync::Arc;

use hapticore_contract::control::Drive;
use hapticore_model::fidelity::force_loop::FixedLoop;
use hapticore_run::case::Case;
use hapticore_run::inputs;
use hapticore_run::maker::Maker;
use hapticore_scene::{Scene, Truth, gallery};

/// A slot of a loop.
pub struct Slot {
    /// What was true in it.
    pub truth: Truth,
    /// The drive word behind it; none behind a part of a pad that is not the last.
    pub drive: Option<Drive>,
}

/// A bundled scene with these settings.
///
/// # Panics
/// Where there is no such scene, or it does not take them.
pub fn scene(name: &str, set: &[(String, String)]) -> Arc<Scene> {
    let toml = gallery::find(name).expect("bundled");
    let scene = Scene::parse(toml, &format!("{name}.toml"), set);
    Arc::new(scene.unwrap_or_else(|error| panic!("{error}")))
}

/// A case of a scene, by its name, for a bundled profile.
///
/// # Panics
/// Where there is no such case or profile.
pub fn case(scene: &Arc<Scene>, name: &str, profile: &str) -> Case {
    let profile = inputs::profile(profile).expect("bundled");
    let profile = inputs::windowed(profile, scene).expect("a window");
    let index = scene.cases.iter().position(|case| case.name == name).expect("a case");
    Case::new(scene, index, &profile, &[]).expect("a case")
}

/// The slots of a loop that is made for `tuned` around the device of `driven`; those for which `is_lost`
/// holds reach the core as zeros.
///
/// # Panics
/// Where the loop cannot be.
pub fn run(tuned: &Case, driven: &Case, is_lost: impl Fn(usize, &Truth) -> bool) -> Vec<Slot> {
    let tuning = tuned.plant().and_then(|plant| tuned.tuning(&plant)).expect("gains that fit");
    let calibration = tuned.calibration().expect("a calibration");
    let mut core = FixedLoop::new(&tuned.profile, calibration, &tuning.expect("a controller"))
        .expect("a force loop");
    let maker = Maker::new(driven.plant().expect("a plant"), &driven.profile, true, false);
    let mut plant = driven.loop_plant(maker).expect("a loop");
    let slot = |number: usize| {
        let made = plant.slot(number);
        core.set_target(made.slot.pad, made.target_n);
        if let Some(surface) = made.surface {
            core.set_surface(made.slot.pad, surface);
        }
        let zeros = vec![0; made.slot.window().len()];
        let codes = if is_lost(number, &made.truth) { &zeros[..] } else { made.slot.window() };
        let (_, drive) = core.slot(|core| core.slot(made.slot.pad, codes));
        plant.drive(&made, drive).expect("a drive that the plant takes");
        Slot { truth: made.truth, drive }
    };
    (0..driven.slots).map(slot).collect()
}
