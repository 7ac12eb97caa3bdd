// SPDX-License-Identifier: MIT OR Apache-2.0
//! What profiles are tried on: slots of a case of a scene, and the device's calibration.

use super::points::{Slot, Which, slots};
use anyhow::Result;
use hapticore_contract::calibration::Calibration;
use hapticore_contract::profile::Profile;
use hapticore_run::case::Case;
use hapticore_scene::Scene;
use std::sync::Arc;
use std::time::Instant;

/// Slots and calibration, which profiles share that differ in words alone.
pub struct Bench {
    /// The profile that it was made for, and as the scene's device and pads have it.
    of: Profile,
    profile: Arc<Profile>,
    calibration: Calibration,
    slots: Vec<Slot>,
    scene: String,
    /// Slots of the case, run or not.
    all: usize,
    slot_s: f64,
    seconds: f64,
}

impl Bench {
    /// Some slots of a case; with `sampled` cores receive samples, else phasors.
    ///
    /// # Errors
    /// A case that cannot be run, as [`slots`].
    pub fn new(
        (scene, index): (&Arc<Scene>, usize),
        profile: &Profile,
        which: Which,
        sampled: bool,
    ) -> Result<Self> {
        let case = Case::new(scene, index, profile, &[])?;
        let calibration = case.calibration()?.clone();
        let start = Instant::now();
        let slots = slots(&case, which, sampled)?;
        Ok(Bench {
            of: profile.clone(),
            profile: case.profile.clone(),
            calibration,
            slots,
            scene: scene.name.clone(),
            all: case.slots,
            slot_s: case.clock.seconds(1),
            seconds: start.elapsed().as_secs_f64(),
        })
    }

    /// Whether another profile can be tried on it.
    pub fn suits(&self, profile: &Profile) -> bool {
        is_same_bench(&self.of, profile)
    }

    /// The profile as the scene's device and pads have it.
    ///
    /// # Errors
    /// A calibration that its words cannot represent.
    pub fn serve(&self, profile: &Profile) -> Result<Arc<Profile>> {
        let of = &self.profile;
        let mut served =
            Profile { terminals: of.terminals.clone(), pads: of.pads, ..profile.clone() };
        // More terminals than the profile's own take more clocks.
        served.clocks_per_sample = served.clocks_per_sample.max(served.least_clocks_per_sample());
        self.calibration.check(&served)?;
        Ok(Arc::new(served))
    }

    /// The name of the scene.
    pub fn scene(&self) -> &str {
        &self.scene
    }

    /// Whether `count` slots leave others between them.
    pub fn has_between(&self, count: usize) -> bool {
        self.all / count.max(1) > 1
    }

    /// The calibration of the device.
    pub fn calibration(&self) -> &Calibration {
        &self.calibration
    }

    /// The slots.
    pub fn slots(&self) -> &[Slot] {
        &self.slots
    }

    /// Some of them, spread evenly: at most `most`.
    pub fn some(&self, most: usize) -> impl ExactSizeIterator<Item = &Slot> {
        self.slots.iter().step_by(self.slots.len().div_ceil(most.max(1)))
    }

    /// Simulated time of the slots, s.
    pub fn simulated_s(&self) -> f64 {
        self.slots.len() as f64 * self.slot_s
    }

    /// What simulating them took, s.
    pub fn seconds(&self) -> f64 {
        self.seconds
    }
}

/// Whether plant, position table and ideal estimator are the same for two profiles, to the bit.
pub fn is_same_bench(one: &Profile, other: &Profile) -> bool {
    let of = |p: &Profile| {
        (
            (p.slot.clone(), p.terminals.clone(), p.pads),
            (p.carrier.method, p.carrier.window, p.carrier.periods),
            (p.position.clone(), p.formats.table, p.formats.position),
            // Gain and force table are counted in the square's gain, that of the window's words.
            (p.capacitance, p.haptic, p.force, p.square_gain().to_bits()),
        )
    };
    of(one) == of(other)
}
