// SPDX-License-Identifier: MIT OR Apache-2.0
//! Errors of a profile's core on slots of a scene: predicted from its own blocks, and measured.
//!
//! | quantity | unit | of a slot |
//! | --- | --- | --- |
//! | force | mN | core − ideal |
//! | capacitance | % | (core − ideal)/ideal |
//! | position | µm | distance of the core's place from the ideal one |
//!
//! Predicted are mean, variance and bound for each slot's samples, which then are averaged over the
//! slots as measured errors are.

use super::points::{Signals, Slot, Values, digitised, is_flagged};
use anyhow::Result;
use hapticore_contract::calibration::Calibration;
use hapticore_contract::profile::Profile;
use hapticore_model::fidelity::noise::{Expected, Prediction, Predictor, Signals as Given};
use hapticore_run::engine::{Fidelity, engine};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What errors are asked of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Quantity {
    /// Haptic force, mN.
    Force,
    /// Capacitance, %.
    Capacitance,
    /// Position, µm.
    Position,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Quantity; 3] = [Quantity::Force, Quantity::Capacitance, Quantity::Position];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Force => "force",
            Quantity::Capacitance => "capacitance",
            Quantity::Position => "position",
        }
    }

    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Quantity::Force => "mN",
            Quantity::Capacitance => "%",
            Quantity::Position => "µm",
        }
    }
}

/// An error over many slots.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Error {
    /// Root of the mean square.
    pub rms: f64,
    /// Mean; of the position, of its x.
    pub mean: f64,
    /// Largest magnitude; of a prediction, what none exceeds.
    pub largest: f64,
}

/// Errors of force, capacitance and position.
pub type Errors = [Error; 3];

/// What the errors of a profile are made of: each source's rms, by the path of the instance that
/// rounds.
pub type Sources = [BTreeMap<String, f64>; 3];

/// Sums over slots.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Sum {
    mean: f64,
    square: f64,
    largest: f64,
    count: f64,
}

impl Sum {
    pub(crate) fn add(&mut self, mean: f64, square: f64, largest: f64) {
        self.mean += mean;
        self.square += square;
        self.largest = self.largest.max(largest);
        self.count += 1.0;
    }

    pub(crate) fn error(self) -> Error {
        let count = self.count.max(1.0);
        Error { rms: (self.square / count).sqrt(), mean: self.mean / count, largest: self.largest }
    }
}

/// One slot in so many, or a single one of fewer, does not stand for others.
const ONE_IN: usize = 24;

/// Whether one slot, of many one in [`ONE_IN`], makes most of the mean square: that of others may have any size.
fn is_of_few(mut squares: Vec<f64>) -> bool {
    squares.sort_by(|a, b| b.total_cmp(a));
    let few = squares.len().div_ceil(ONE_IN);
    squares.len() > 2 && squares[..few].iter().sum::<f64>() > 0.5 * squares.iter().sum::<f64>()
}

/// Errors over scenes of the same weight.
pub fn pooled(of_scenes: &[Error]) -> Error {
    let count = of_scenes.len() as f64;
    let sum = of_scenes.iter().fold(Error::default(), |sum, of| Error {
        rms: sum.rms + of.rms * of.rms / count,
        mean: sum.mean + of.mean / count,
        largest: sum.largest.max(of.largest),
    });
    Error { rms: sum.rms.sqrt(), ..sum }
}

/// What is expected of a profile's core.
#[derive(Debug, Clone)]
pub struct Expectation {
    /// What it is off.
    pub errors: Errors,
    /// By which rounding.
    pub sources: Sources,
    /// The least amplitude in steps of the ADC.
    pub least_codes: f64,
    /// Whether one slot makes most of an error, or a slot's frame is flagged, so that errors are not those of rounding.
    pub is_of_one: [bool; 3],
}

/// What a profile's core is expected to be off on slots.
///
/// # Errors
/// A core that cannot be.
pub fn predicted<'a>(
    profile: &Profile,
    calibration: &Calibration,
    slots: impl ExactSizeIterator<Item = &'a Slot>,
) -> Result<Expectation> {
    let mut predictor = Predictor::new(profile, calibration)?;
    let (mut sums, mut sources) = ([Sum::default(); 3], Sources::default());
    let mut squares: [Vec<f64>; 3] = Default::default();
    let (mut least_codes, mut is_flagged, count) = (f64::INFINITY, false, slots.len() as f64);
    for slot in slots {
        let given = match &slot.signals {
            Signals::Samples(samples) => Given::Samples(samples),
            Signals::Phasors { amplitudes, mean_square } => {
                Given::Tones { amplitudes, mean_square: *mean_square }
            }
        };
        let Prediction {
            x, y, capacitance, force, least_codes: codes, is_flagged: flagged, ..
        } = predictor.slot(slot.pad, given);
        least_codes = least_codes.min(codes);
        is_flagged |= flagged;
        let percent = 100.0 / capacitance.real;
        let of = |of: &Expected, unit: f64| of.errors.total.times(unit);
        let (force_mn, share) = (of(&force, 1e3), of(&capacitance, percent));
        sums[0].add(force_mn.mean, force_mn.rms().powi(2), force_mn.bound);
        sums[1].add(share.mean, share.rms().powi(2), share.bound);
        let [along, across] = [of(&x, 1e3), of(&y, 1e3)];
        let square = along.rms().powi(2) + across.rms().powi(2);
        sums[2].add(along.mean, square, along.bound.hypot(across.bound));
        let of_slot = [force_mn.rms().powi(2), share.rms().powi(2), square];
        squares.iter_mut().zip(of_slot).for_each(|(all, of)| all.push(of));
        for (quantity, of, unit) in
            [(0, force, 1e3), (1, capacitance, percent), (2, x, 1e3), (2, y, 1e3)]
        {
            for (source, moments) in of.errors.by_source {
                let square = moments.times(unit).rms().powi(2) / count;
                *sources[quantity].entry(source).or_default() += square;
            }
        }
    }
    for of in &mut sources {
        of.values_mut().for_each(|square| *square = square.sqrt());
    }
    let is_of_one = squares.map(|of| is_flagged || is_of_few(of));
    Ok(Expectation { errors: sums.map(Sum::error), sources, least_codes, is_of_one })
}

/// What a core made of slots.
#[derive(Debug, Clone)]
pub struct Results {
    /// Of each slot.
    pub values: Vec<Values>,
    /// How many have a flag set that tells not to take them for what their slot shows.
    pub flagged: usize,
}

/// What a profile's core makes of slots at a fidelity that needs no clocks.
pub fn results(
    fidelity: Fidelity,
    profile: &Arc<Profile>,
    calibration: &Calibration,
    slots: &[Slot],
) -> Results {
    let mut core = engine(fidelity, profile, calibration);
    let mut measure = |slot: &Slot| {
        let given = digitised(slot.pad, &slot.signals, profile.formats.adc);
        core.slot(&given).expect("a slot is answered at once where there are no clocks")
    };
    let measured: Vec<_> = slots.iter().map(&mut measure).collect();
    Results {
        flagged: measured.iter().filter(|measured| is_flagged(measured)).count(),
        values: measured.iter().map(Values::of).collect(),
    }
}

/// What values are off others.
pub fn errors<'a>(values: &[Values], from: impl Iterator<Item = &'a Values>) -> Errors {
    let mut sums = [Sum::default(); 3];
    for (is, should) in values.iter().zip(from) {
        let force = 1e3 * (is.force_n - should.force_n);
        let capacitance = 100.0 * (is.capacitance_pf / should.capacitance_pf - 1.0);
        let place = [0, 1].map(|n| 1e3 * (is.position_mm[n] - should.position_mm[n]));
        sums[0].add(force, force * force, force.abs());
        sums[1].add(capacitance, capacitance * capacitance, capacitance.abs());
        let distance = place[0].hypot(place[1]);
        sums[2].add(place[0], distance * distance, distance);
    }
    sums.map(Sum::error)
}

#[cfg(test)]
mod tests {
    use super::is_of_few;

    #[test]
    fn an_error_is_of_few_slots_where_one_in_24_makes_most_of_it() {
        let with = |large: usize, slots: usize| {
            let square = |n| if n < large { 1e3 } else { 1.0 };
            is_of_few((0..slots).map(square).collect())
        };
        assert!(with(1, 24) && !with(2, 24) && with(1, 3) && !with(1, 2));
        assert!(with(4, 96) && !with(9, 96));
        assert!(!is_of_few(vec![1.0; 96]));
    }
}
