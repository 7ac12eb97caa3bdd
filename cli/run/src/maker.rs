// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a plant gives the core of its slots: ADC codes or amplitudes.

use hapticore_contract::profile::Profile;
use hapticore_scene::{Complex, Plant, Slot};

use crate::digitiser::Digitiser;
use crate::engine::Signals;

/// Produces the samples or amplitudes of slots in order.
pub struct Maker {
    plant: Plant,
    digitiser: Digitiser,
    sampled: bool,
    blanking: usize,
    samples: usize,
    whole: bool,
    fractions: Vec<f64>,
    /// Codes of an earlier slot, whose memory the next one's take.
    spare: Vec<i32>,
}

impl Maker {
    /// A maker of slots from a plant: with the samples of the blanking where `whole`.
    pub fn new(plant: Plant, profile: &Profile, sampled: bool, whole: bool) -> Self {
        let (blanking, samples) =
            (profile.slot.blanking() as usize, profile.slot.samples() as usize);
        let digitiser = Digitiser::new(profile.formats.adc);
        Maker {
            plant,
            digitiser,
            sampled,
            blanking,
            samples,
            whole,
            fractions: Vec::new(),
            spare: Vec::new(),
        }
    }

    /// What the core receives of a slot, and the largest sample.
    pub fn signals(&mut self, slot: usize) -> (Signals, f64) {
        let slot = self.plant.slot(slot);
        self.generate(&slot)
    }

    /// The samples of a slot, and the largest.
    pub fn sample(&mut self, slot: usize) -> (Signals, f64) {
        let slot = self.plant.slot(slot);
        self.samples(&slot)
    }

    /// What the core receives of a slot that a plant of the case has evaluated, and the largest sample.
    pub(crate) fn generate(&mut self, slot: &Slot) -> (Signals, f64) {
        if self.sampled { self.samples(slot) } else { self.phasors(slot) }
    }

    fn samples(&mut self, slot: &Slot) -> (Signals, f64) {
        let first = if self.whole { 0 } else { self.blanking };
        let channels = self.plant.channels();
        self.fractions.resize((self.samples - first) * channels, 0.0);
        let (blanking, window) = self.fractions.split_at_mut((self.blanking - first) * channels);
        if self.whole {
            self.plant.samples_of(slot, 0..self.blanking, blanking);
        }
        self.plant.samples_of(slot, self.blanking..self.samples, window);
        let blanking = blanking.len();
        let mut codes = std::mem::take(&mut self.spare);
        let peak = self.digitiser.codes(&self.fractions, &mut codes);
        (Signals::Samples { codes, blanking }, peak)
    }

    /// Takes back the signals of a slot that are needed no longer.
    pub(crate) fn reuse(&mut self, signals: Signals) {
        if let Signals::Samples { codes, .. } = signals {
            self.spare = codes;
        }
    }

    /// The same, to be asked what its evaluations do not change.
    pub(crate) fn device(&self) -> &Plant {
        &self.plant
    }

    /// Simulated device of the case.
    pub fn plant(&mut self) -> &mut Plant {
        &mut self.plant
    }

    fn phasors(&mut self, slot: &Slot) -> (Signals, f64) {
        let mut found = vec![Complex::default(); self.plant.channels() - 1];
        let mean_square = self.plant.phasors_of(slot, &mut found);
        let largest =
            found.iter().map(|phasor| phasor.norm()).fold((2.0 * mean_square).sqrt(), f64::max);
        let amplitudes = found.iter().map(|phasor| (phasor.re, phasor.im)).collect();
        (Signals::Phasors { amplitudes, mean_square }, largest)
    }
}
