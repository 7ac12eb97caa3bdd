// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a plant gives the core of its slots: ADC codes or amplitudes.

use std::sync::mpsc::SyncSender;

use hapticore_contract::profile::Profile;
use hapticore_scene::{Complex, Plant, Truth};

use crate::digitiser::Digitiser;
use crate::engine::{Signals, Slot};

/// A slot on its way to the core.
pub(crate) struct Made {
    /// What the core is given.
    pub slot: Slot,
    /// What the plant knows.
    pub truth: Truth,
    /// The largest sample, as a fraction of full scale.
    pub peak: f64,
}

/// Produces the samples or amplitudes of slots in order.
pub struct Maker {
    plant: Plant,
    digitiser: Digitiser,
    sampled: bool,
    blanking: usize,
    samples: usize,
    whole: bool,
    fractions: Vec<f64>,
}

impl Maker {
    /// A maker of slots from a plant: with the samples of the blanking where `whole`.
    pub fn new(plant: Plant, profile: &Profile, sampled: bool, whole: bool) -> Self {
        let (blanking, samples) =
            (profile.slot.blanking() as usize, profile.slot.samples() as usize);
        let digitiser = Digitiser::new(profile.formats.adc);
        Maker { plant, digitiser, sampled, blanking, samples, whole, fractions: Vec::new() }
    }

    /// Slots from the first on, so many at a time, as far as they are taken.
    pub(crate) fn make(&mut self, slots: usize, at_a_time: usize, to: &SyncSender<Vec<Made>>) {
        for first in (0..slots).step_by(at_a_time) {
            let some = (first..slots.min(first + at_a_time)).map(|slot| self.slot(slot)).collect();
            if to.send(some).is_err() {
                return; // The core has stopped: it tells why.
            }
        }
    }

    fn slot(&mut self, slot: usize) -> Made {
        let truth = self.plant.truth(slot);
        let (signals, peak) = self.signals(slot);
        Made { slot: Slot { pad: truth.pad, signals }, truth, peak }
    }

    /// What the core is given of a slot, and the largest sample.
    pub fn signals(&mut self, slot: usize) -> (Signals, f64) {
        if self.sampled { self.sample(slot) } else { self.phasors(slot) }
    }

    /// The samples of a slot, and the largest.
    pub fn sample(&mut self, slot: usize) -> (Signals, f64) {
        let first = if self.whole { 0 } else { self.blanking };
        self.fractions.clear();
        if self.whole {
            self.plant.samples(slot, 0..self.blanking, &mut self.fractions);
        }
        self.plant.samples(slot, self.blanking..self.samples, &mut self.fractions);
        let mut codes = Vec::with_capacity(self.fractions.len());
        let peak = self.digitiser.codes(&self.fractions, &mut codes);
        let blanking = (self.blanking - first) * self.plant.channels();
        (Signals::Samples { codes, blanking }, peak)
    }

    /// Simulated device of the case.
    pub fn plant(&mut self) -> &mut Plant {
        &mut self.plant
    }

    fn phasors(&mut self, slot: usize) -> (Signals, f64) {
        let mut found = vec![Complex::default(); self.plant.channels() - 1];
        let mean_square = self.plant.phasors(slot, &mut found);
        let largest =
            found.iter().map(|phasor| phasor.norm()).fold((2.0 * mean_square).sqrt(), f64::max);
        let amplitudes = found.iter().map(|phasor| (phasor.re, phasor.im)).collect();
        (Signals::Phasors { amplitudes, mean_square }, largest)
    }
}
