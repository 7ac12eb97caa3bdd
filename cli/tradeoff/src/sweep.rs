// SPDX-License-Identifier: MIT OR Apache-2.0
//! Profiles about a profile, one knob after the other: what each costs and what it is off.

use super::cost::{Cost, cost};
use super::errors::{Errors, Quantity, Sources, measured, predicted};
use super::knobs::Knob;
use super::points::{Slot, slots};
use anyhow::{Context, Result};
use hapticore_contract::calibration::Calibration;
use hapticore_contract::profile::{Carrier, ForceLaw, Profile};
use hapticore_model::fidelity::noise::Predictor;
use hapticore_run::case::Case;
use hapticore_run::interrupt;
use hapticore_scene::Scene;
use rayon::prelude::*;
use serde::Serialize;
use std::sync::{Arc, Mutex};

/// A profile that was tried.
#[derive(Debug, Clone, Serialize)]
pub struct Point {
    /// What was turned: a profile's key; empty of the profile itself.
    pub knob: String,
    /// Where it stands, bits or samples.
    pub value: u64,
    /// What it costs.
    #[serde(flatten)]
    pub cost: Cost,
    /// Predicted errors of force, capacitance and position.
    pub predicted: Errors,
    /// Measured ones.
    pub measured: Errors,
    /// The least amplitude of a channel in steps of the ADC.
    pub least_codes: f64,
    /// What the predicted errors are made of.
    #[serde(skip)]
    pub sources: Sources,
    /// No other point has less measured error of the quantity, and is neither larger nor slower.
    pub front: [bool; 3],
    /// The profile.
    #[serde(skip)]
    pub profile: Arc<Profile>,
}

/// What profiles are tried on.
pub struct Trial {
    scenes: Vec<Scene>,
    profile: Profile,
    slots: usize,
    /// Those that were made: profiles of later runs share them, too.
    benches: Mutex<Vec<Arc<Vec<Bench>>>>,
}

/// Slots and calibration that profiles share which have a slot's times and a table in common.
struct Bench {
    /// The profile that it was made for, and as the scene's device and pads have it.
    of: Profile,
    profile: Arc<Profile>,
    calibration: Calibration,
    slots: Vec<Slot>,
}

/// How many slots of a scene a prediction is made of.
const PREDICTED: usize = 24;

impl Point {
    /// Whether some channel met too few codes for a prediction to hold.
    pub fn has_few_codes(&self) -> bool {
        self.least_codes < Predictor::FEW_CODES
    }
}

impl Trial {
    /// A trial of a profile, and of others about it, on so many slots of each scene.
    pub fn new(scenes: Vec<Scene>, profile: Profile, slots: usize) -> Self {
        Trial { scenes, profile, slots, benches: Mutex::default() }
    }

    /// The profile itself.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// The profiles of a sweep: each knob a few steps down and up.
    pub fn plan(&self) -> Vec<(Option<Knob>, Profile)> {
        let mut plan = vec![(None, self.profile.clone())];
        for knob in Knob::ALL {
            let now = knob.value(&self.profile);
            let values: Vec<u64> = match knob {
                Knob::Window => [1, 2, 3, 6, 8].map(|quarter| now * quarter / 4).to_vec(),
                _ => [-6i64, -4, -3, -2, -1, 1, 2]
                    .iter()
                    .filter_map(|by| now.checked_add_signed(*by))
                    .collect(),
            };
            let turned = values.into_iter().filter_map(|value| knob.set(&self.profile, value));
            plan.extend(turned.map(|profile| (Some(knob), profile)));
        }
        plan
    }

    /// Tries profiles on all cores; `progress` is called after each.
    ///
    /// # Errors
    /// A scene that cannot be run, an interruption.
    pub fn run(
        &self,
        plan: &[(Option<Knob>, Profile)],
        progress: &(dyn Fn() + Sync),
    ) -> Result<Vec<Point>> {
        let benches = plan.iter().map(|(_, profile)| self.benches(profile));
        let benches = benches.collect::<Result<Vec<_>>>()?;
        let points: Result<Vec<Point>> = plan
            .par_iter()
            .zip(&benches)
            .map(|((knob, profile), benches)| {
                interrupt::check()?;
                let point = point(*knob, profile, benches)?;
                progress();
                Ok(point)
            })
            .collect();
        let mut points = points?;
        mark_front(&mut points);
        Ok(points)
    }

    fn benches(&self, profile: &Profile) -> Result<Arc<Vec<Bench>>> {
        let mut made = self.benches.lock().expect("nobody panics with it");
        if let Some(known) = made.iter().find(|of| same_bench(&of[0].of, profile)) {
            return Ok(known.clone());
        }
        let bench = |scene| bench(scene, profile, self.slots);
        let benches = Arc::new(self.scenes.iter().map(bench).collect::<Result<Vec<_>>>()?);
        made.push(benches.clone());
        Ok(benches)
    }
}

/// Whether profiles may share slots and calibration but for its gains: whether plant, position table
/// and ideal estimator are the same for both.
fn same_bench(a: &Profile, b: &Profile) -> bool {
    // The words of a force table are in units of the square's gain, which is of the carrier's words.
    let of_table = |p: &Profile| {
        (p.force.law == ForceLaw::Table).then_some((p.carrier.amplitude, p.formats.oscillator))
    };
    let of = |p: &Profile| {
        let carrier = Carrier { amplitude: 0, ..p.carrier.clone() };
        (
            (p.slot.clone(), carrier, p.terminals.clone(), p.pads),
            (p.position.clone(), p.formats.table),
            (p.capacitance, p.haptic, p.force, of_table(p)),
        )
    };
    of(a) == of(b)
}

fn bench(scene: &Scene, profile: &Profile, count: usize) -> Result<Bench> {
    let case = Case::new(scene, 0, profile, &[])?;
    let slots = slots(&case, count)?;
    let calibration = case.calibration()?.clone();
    Ok(Bench { of: profile.clone(), profile: case.profile.clone(), calibration, slots })
}

impl Bench {
    /// The profile as the scene's device and pads have it, and the calibration in its words.
    fn serve(&self, profile: &Profile) -> (Profile, Calibration) {
        let of = &self.profile;
        let mut served =
            Profile { terminals: of.terminals.clone(), pads: of.pads, ..profile.clone() };
        // More terminals than the profile's own take more clocks.
        served.clocks_per_sample = served.clocks_per_sample.max(served.least_clocks_per_sample());
        // Of the square of the haptic voltage, a core's gain is that of its window's words.
        let force_gain = self.calibration.force_gain * of.square_gain() / served.square_gain();
        (served, Calibration { force_gain, ..self.calibration.clone() })
    }
}

fn point(knob: Option<Knob>, profile: &Profile, benches: &[Bench]) -> Result<Point> {
    let (mut sum, mut of_sources) = ([Errors::default(); 2], Sources::default());
    let mut least_codes = f64::INFINITY;
    for bench in benches {
        let (profile, calibration) = bench.serve(profile);
        let few = bench.slots.iter().step_by(bench.slots.len().div_ceil(PREDICTED));
        let (expected, sources, codes) = predicted(&profile, &calibration, few)
            .with_context(|| format!("profile {}", profile.name))?;
        least_codes = least_codes.min(codes);
        let found = measured(&profile, &calibration, &bench.slots);
        for (sum, errors) in sum.iter_mut().zip([expected, found]) {
            for (sum, error) in sum.iter_mut().zip(errors) {
                sum.rms += error.rms * error.rms / benches.len() as f64;
                sum.mean += error.mean / benches.len() as f64;
                sum.largest = sum.largest.max(error.largest);
            }
        }
        for (of, sources) in of_sources.iter_mut().zip(sources) {
            for (name, rms) in sources {
                *of.entry(name).or_default() += rms * rms / benches.len() as f64;
            }
        }
    }
    for error in sum.iter_mut().flatten() {
        error.rms = error.rms.sqrt();
    }
    of_sources.iter_mut().flat_map(|of| of.values_mut()).for_each(|square| *square = square.sqrt());
    let [predicted, measured] = sum;
    Ok(Point {
        knob: knob.map_or(String::new(), |knob| knob.key().into()),
        value: knob.map_or(0, |knob| knob.value(profile)),
        cost: cost(profile)?,
        predicted,
        measured,
        least_codes,
        sources: of_sources,
        front: [false; 3],
        profile: Arc::new(profile.clone()),
    })
}

/// Marks the points that none beats in error, size and age together.
fn mark_front(points: &mut [Point]) {
    let of = |point: &Point, quantity: usize| {
        [point.measured[quantity].rms, point.cost.luts, point.cost.age_us]
    };
    for quantity in 0..Quantity::ALL.len() {
        let all: Vec<[f64; 3]> = points.iter().map(|point| of(point, quantity)).collect();
        for (point, own) in points.iter_mut().zip(&all) {
            let beats = |other: &[f64; 3]| {
                other.iter().zip(own).all(|(a, b)| a <= b)
                    && other.iter().zip(own).any(|(a, b)| a < b)
            };
            point.front[quantity] = !all.iter().any(beats);
        }
    }
}
