// SPDX-License-Identifier: MIT OR Apache-2.0
//! Slots of scenes, which every profile is tried on: samples as the sensors give them, before any
//! ADC.

use std::sync::Arc;

use anyhow::{Result, ensure};
use hapticore_contract::frame::Measurement;
use hapticore_contract::profile::Profile;
use hapticore_hdl::format::Format;
use hapticore_run::case::Case;
use hapticore_run::digitiser::Digitiser;
use hapticore_run::engine::{self, Fidelity, engine};
use hapticore_run::interrupt;
use hapticore_run::record::Quantities;
use hapticore_scene::{Case as SceneCase, Complex, Plant, Truth};
use toml::{Table, Value};

/// An ADC that rounds nothing away: that of the ideal estimator.
pub const FINE: Format = Format::signed(30, 29);

/// A slot of a scene.
#[derive(Debug, Clone)]
pub struct Slot {
    /// Pad, from 0.
    pub pad: usize,
    /// What a core receives of it.
    pub signals: Signals,
    /// What the ideal estimator makes of it.
    pub ideal: Values,
    /// What the plant knows.
    pub truth: Values,
}

/// The signals of a slot's window, before any ADC.
#[derive(Debug, Clone)]
pub enum Signals {
    /// Samples, of full scale; a sample after the other, each of all channels.
    Samples(Vec<f64>),
    /// What an ideal demodulator finds, in fractions of full scale.
    Phasors {
        /// In-phase and quadrature of the terminals and the sensing voltage.
        amplitudes: Vec<(f64, f64)>,
        /// Of the haptic voltage.
        mean_square: f64,
    },
}

/// The results that errors are asked of.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Values {
    /// Haptic force, N.
    pub force_n: f64,
    /// Capacitance, pF.
    pub capacitance_pf: f64,
    /// Position, mm.
    pub position_mm: [f64; 2],
}

/// The overrides that leave the rounding of a case's samples to the core's ADC: the finest
/// quantisation there is. Noise that is counted in its codes keeps its size.
///
/// # Errors
/// A document that is no TOML, which is a broken invariant.
pub fn unrounded(case: &SceneCase) -> Result<Vec<(String, String)>> {
    let document: Table = case.document.parse()?;
    let sensor = document.get("sensor").and_then(Value::as_table);
    let number = |key: &str| {
        let value = sensor?.get(key)?;
        value.as_float().or_else(|| Some(value.as_integer()? as f64))
    };
    let Some(bits) = number("quantisation_bits") else { return Ok(Vec::new()) };
    let dither = number("dither_lsb_rms").filter(|lsb| *lsb > 0.0);
    // The scene refuses dither of more than `MOST_DITHER_LSB` codes.
    let room = dither.map_or(f64::INFINITY, |lsb| (MOST_DITHER_LSB / lsb).log2().floor());
    let finer = (FINEST_BITS - bits).min(room).max(0.0);
    let set = |key: &str, value: f64| (format!("sensor.{key}"), value.to_string());
    let dither = dither.map(|lsb| set("dither_lsb_rms", lsb * finer.exp2()));
    Ok([set("quantisation_bits", bits + finer)].into_iter().chain(dither).collect())
}

/// The most bits of `sensor.quantisation_bits`.
const FINEST_BITS: f64 = 32.0;
/// The most of `sensor.dither_lsb_rms`.
const MOST_DITHER_LSB: f64 = 1e3;

/// Which slots of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Which {
    /// This many, spread over its time.
    Every(usize),
    /// Those in the middle between these; where there are none between, the same.
    Between(usize),
}

impl Which {
    /// The numbers of the slots, out of `slots`.
    fn of(self, slots: usize) -> impl Iterator<Item = usize> {
        let (count, is_between) = match self {
            Which::Every(count) => (count, 0),
            Which::Between(count) => (count, 1),
        };
        let step = (slots / count).max(1);
        (is_between * (step / 2)..slots).step_by(step)
    }
}

/// Slots of a case; those without a valid position are left out. With `sampled` cores receive samples, else phasors.
///
/// # Errors
/// A case that is controlled, or whose pads are served part by part; no slot with a valid position.
pub fn slots(case: &Case, which: Which, sampled: bool) -> Result<Vec<Slot>> {
    let scene = &case.scene.name;
    ensure!(
        case.plan().is_none(),
        "{scene}: expected a scene without [control]: its slots depend on the core"
    );
    let mut plant = case.plant()?;
    // A slot of a part has half the pad's capacitance, for which the core has another gain, and a
    // force only together with the slots of the other parts.
    ensure!(
        plant.parts() == 1,
        "{scene}: halves.senses: expected \"together\", got \"each\": a pad's slots must each have its force"
    );
    let mut fine = (*case.profile).clone();
    fine.formats.adc = FINE;
    let mut ideal = engine(Fidelity::Float, &Arc::new(fine), case.calibration()?);
    let mut slots = Vec::new();
    for number in which.of(case.slots) {
        interrupt::check()?;
        let truth = plant.truth(number);
        let signals = match sampled {
            true => samples(&mut plant, number, &case.profile),
            false => phasors(&mut plant, number),
        };
        let measured = ideal.slot(&digitised(truth.pad, &signals, FINE));
        let measured = measured.expect("the ideal estimator answers at once");
        if !is_flagged(&measured) {
            slots.push(Slot {
                pad: truth.pad,
                signals,
                ideal: Values::of(&measured),
                truth: Values::of_truth(&truth),
            });
        }
    }
    ensure!(!slots.is_empty(), "{scene}: expected a pad on the sheet in some slot");
    Ok(slots)
}

fn samples(plant: &mut Plant, number: usize, profile: &Profile) -> Signals {
    let window = profile.slot.blanking() as usize..profile.slot.samples() as usize;
    let mut samples = Vec::with_capacity(window.len() * profile.channels());
    plant.samples(number, window, &mut samples);
    Signals::Samples(samples)
}

fn phasors(plant: &mut Plant, number: usize) -> Signals {
    let mut found = vec![Complex::default(); plant.channels() - 1];
    let mean_square = plant.phasors(number, &mut found);
    let amplitudes = found.iter().map(|phasor| (phasor.re, phasor.im)).collect();
    Signals::Phasors { amplitudes, mean_square }
}

/// What a core with such an ADC receives of a slot.
pub fn digitised(pad: usize, signals: &Signals, adc: Format) -> engine::Slot {
    let signals = match signals {
        Signals::Samples(samples) => {
            let mut codes = Vec::with_capacity(samples.len());
            Digitiser::new(adc).codes(samples, &mut codes);
            engine::Signals::Samples { codes, blanking: 0 }
        }
        Signals::Phasors { amplitudes, mean_square } => {
            engine::Signals::Phasors { amplitudes: amplitudes.clone(), mean_square: *mean_square }
        }
    };
    engine::Slot { pad, signals }
}

/// Whether a measurement is not to be taken for what its slot shows.
pub fn is_flagged(measured: &Measurement) -> bool {
    let flags = measured.flags;
    flags.invalid || flags.clipped || flags.saturated
}

impl Values {
    /// Those of a measurement.
    pub fn of(measured: &Measurement) -> Self {
        Values {
            force_n: measured.force_n,
            capacitance_pf: measured.capacitance_pf,
            position_mm: [measured.x_mm, measured.y_mm],
        }
    }

    /// Those among the quantities of a slot.
    pub fn of_quantities(of: &Quantities) -> Self {
        Values {
            force_n: of.force_n,
            capacitance_pf: of.capacitance_pf,
            position_mm: [of.x_mm, of.y_mm],
        }
    }

    fn of_truth(truth: &Truth) -> Self {
        Values {
            force_n: truth.force_n,
            capacitance_pf: truth.capacitance_pf,
            position_mm: [truth.x_mm, truth.y_mm],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hapticore_run::inputs;

    /// What a scene's sensors are set to, and the noise of that, of full scale.
    fn sensor(name: &str) -> (Option<f64>, Option<f64>) {
        let set = unrounded(&inputs::scene(name, &[]).unwrap().cases[0]).unwrap();
        inputs::scene(name, &set).expect("the scene takes them");
        let number = |of: &str| {
            set.iter().find(|(key, _)| key.ends_with(of)).map(|(_, value)| value.parse().unwrap())
        };
        let bits: Option<f64> = number("quantisation_bits");
        (bits, number("dither_lsb_rms").zip(bits).map(|(lsb, bits): (f64, f64)| lsb / bits.exp2()))
    }

    #[test]
    fn slots_between_others_are_none_of_them_where_there_is_room() {
        let numbers = |which: Which, slots| which.of(slots).collect::<Vec<_>>();
        assert_eq!(numbers(Which::Every(3), 12), [0, 4, 8]);
        assert_eq!(numbers(Which::Between(3), 12), [2, 6, 10]);
        assert_eq!(numbers(Which::Between(12), 12), numbers(Which::Every(12), 12));
    }

    #[test]
    fn samples_are_as_fine_as_the_scene_has_them_and_dither_keeps_its_size() {
        assert_eq!(sensor("fig3"), (Some(32.0), None));
        assert_eq!(sensor("minimal-supply"), (None, None), "neither [sensor] nor codes");
        assert_eq!(sensor("minimal-sensor"), (Some(26.0), Some(0.5 / 16f64.exp2())));
    }
}
