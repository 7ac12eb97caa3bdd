// SPDX-License-Identifier: MIT OR Apache-2.0
//! The same hands with the whole loop between pad and drive: sheet, carrier, sensor noise and ADC of
//! a scene, and the core with its controller and wall. The core has fidelity `fixed` and measures the
//! parts of the pad slot by slot.

use std::ops::Range;
use std::sync::Arc;

use hapticore_contract::profile::Profile;
use hapticore_reference::wall::Direction;
use hapticore_run::case::{Case, Settings};
use hapticore_run::engine::Fidelity;
use hapticore_run::record::Row as Record;
use hapticore_scene::Scene;
use rayon::prelude::*;

use super::device::{Pad, scene_of};
use super::hand::Hand;
use super::measures::{Measures, Row};
use super::trial::Seen;

/// A wall in the core.
#[derive(Clone, Debug)]
pub struct InCore {
    /// How the pad is split: strips meet rule A, halves rule B.
    pub pad: Pad,
    /// The core's profile, bundled.
    pub profile: &'static str,
    /// Stiffness of the wall, N/mm.
    pub n_per_mm: f64,
    /// Play of the position, mm.
    pub play_mm: f64,
    /// Noise of each current, ppm of full scale rms.
    pub noise_ppm: f64,
}

impl InCore {
    fn scene(&self, hand: &Hand, mismatch_percent: f64, seed: u64) -> Scene {
        let InCore { pad, n_per_mm, play_mm, noise_ppm, .. } = self;
        let text = format!(
            "seed = {seed}\n{}\
             [sheet]\n[carrier]\nrung = \"samples\"\nhaptic_wave = \"square\"\n[sensor]\n\
             haptic_full_scale_v = 600\nnoise_ppm_rms = {noise_ppm}\nquantisation_bits = 18\n\
             [control]\nrail_v = 500\nnominal_load_g = 80\n\
             [wall]\nstiffness_n_per_mm = {n_per_mm}\nplay_mm = {play_mm}\n",
            scene_of(*pad, hand, mismatch_percent, "senses = \"each\"\n")
        );
        Scene::parse(&text, "hand.toml", &[]).unwrap_or_else(|error| panic!("{error}"))
    }

    /// The frames of a hand, and how long each is, ms.
    ///
    /// # Panics
    /// Where the profile cannot be.
    pub fn run(&self, hand: &Hand, mismatch_percent: f64, seed: u64) -> (Vec<Seen>, f64) {
        let scene = self.scene(hand, mismatch_percent, seed);
        let profile = Profile::bundled(self.profile).expect("bundled");
        let case = Case::new(&Arc::new(scene), 0, &profile, &[]).expect("a case");
        let settings = Settings { fidelity: Fidelity::Fixed, errors: false };
        let outcome = case.run(&settings, None, &|| ()).expect("a run");
        let parts = case.plant().expect("a plant").parts();
        let [last_mm, _] = case.plant().expect("a plant").parts_mm()[parts - 1];
        let frames = outcome.rows.iter().filter(|row| row.pad == parts - 1);
        (frames.map(|row| seen(row, hand, last_mm)).collect(), 1e3 * case.clock.seconds(parts))
    }

    /// What hands of these seeds feel; the mismatch of every other one has the other sign.
    pub fn hands(&self, seeds: Range<u64>, mismatch_percent: f64) -> Row {
        let trial = |seed: u64| {
            let sign = if seed.is_multiple_of(2) { 1.0 } else { -1.0 };
            let hand = Hand::draw(seed, self.n_per_mm);
            let (frames, frame_ms) = self.run(&hand, sign * mismatch_percent, 1000 + seed);
            Measures::of(&frames, frame_ms)
        };
        Row::of(&seeds.into_par_iter().map(trial).collect::<Vec<_>>())
    }
}

fn seen(row: &Record, hand: &Hand, last_mm: f64) -> Seen {
    let truth = row.truth.expect("a scene has truth");
    let free = row.driven.and_then(|driven| driven.free) == Some(true);
    Seen {
        time_s: row.time_s,
        part: hand.phase(row.time_s),
        x_mm: truth.quantities.x_mm - last_mm,
        hand_n: truth.hand_x_n,
        force_n: truth.quantities.force_n,
        felt_n: truth.haptic_friction_n,
        direction: if free { Direction::Free } else { Direction::Push },
        haptic_v: truth.quantities.haptic_v_rms,
    }
}
