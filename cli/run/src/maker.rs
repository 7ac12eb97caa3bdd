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
}

impl Maker {
    /// A maker of slots from a plant: with the samples of the blanking where `whole`.
    pub fn new(plant: Plant, profile: &Profile, sampled: bool, whole: bool) -> Self {
        let (blanking, samples) =
            (profile.slot.blanking() as usize, profile.slot.samples() as usize);
        let digitiser = Digitiser::new(profile.formats.adc);
        Maker { plant, digitiser, sampled, blanking, samples, whole, fractions: Vec::new() }
    }

    /// What the core is given of a slot, and the largest sample.
    pub fn signals(&mut self, slot: usize) -> (Signals, f64) {
        let slot = self.plant.slot(slot);
        let mut signals = Signals::NONE;
        let peak = self.make(&slot, &mut signals);
        (signals, peak)
    }

    /// The samples of a slot, and the largest.
    pub fn sample(&mut self, slot: usize) -> (Signals, f64) {
        let (slot, mut codes) = (self.plant.slot(slot), Vec::new());
        let (blanking, peak) = self.samples(&slot, &mut codes);
        (Signals::Samples { codes, blanking }, peak)
    }

    /// What the core is given of a slot that a plant of the case has looked at, in place of the signals of
    /// another, whose memory is used again; the largest sample.
    pub(crate) fn make(&mut self, slot: &Slot, signals: &mut Signals) -> f64 {
        if !self.sampled {
            let (amplitudes, mean_square, peak) = self.phasors(slot);
            *signals = Signals::Phasors { amplitudes, mean_square };
            return peak;
        }
        let mut codes = match signals {
            Signals::Samples { codes, .. } => std::mem::take(codes),
            Signals::Phasors { .. } => Vec::new(),
        };
        let (blanking, peak) = self.samples(slot, &mut codes);
        *signals = Signals::Samples { codes, blanking };
        peak
    }

    /// The codes of a slot in place of others: how many of the blanking are among them, and the largest sample.
    fn samples(&mut self, slot: &Slot, codes: &mut Vec<i32>) -> (usize, f64) {
        let first = if self.whole { 0 } else { self.blanking };
        let channels = self.plant.channels();
        self.fractions.resize((self.samples - first) * channels, 0.0);
        let (blanking, window) = self.fractions.split_at_mut((self.blanking - first) * channels);
        if self.whole {
            self.plant.samples_of(slot, 0..self.blanking, blanking);
        }
        self.plant.samples_of(slot, self.blanking..self.samples, window);
        let blanking = blanking.len();
        (blanking, self.digitiser.codes(&self.fractions, codes))
    }

    /// Simulated device of the case.
    pub fn plant(&mut self) -> &mut Plant {
        &mut self.plant
    }

    fn phasors(&mut self, slot: &Slot) -> (Vec<(f64, f64)>, f64, f64) {
        let mut found = vec![Complex::default(); self.plant.channels() - 1];
        let mean_square = self.plant.phasors_of(slot, &mut found);
        let largest =
            found.iter().map(|phasor| phasor.norm()).fold((2.0 * mean_square).sqrt(), f64::max);
        let amplitudes = found.iter().map(|phasor| (phasor.re, phasor.im)).collect();
        (amplitudes, mean_square, largest)
    }
}
