// SPDX-License-Identifier: MIT OR Apache-2.0
//! Profiles about a profile, one knob after the other: what each costs and what it is off.

use super::bench::Bench;
use super::cost::Cost;
use super::errors::{Errors, Quantity, Sources, errors, results};
use super::forecast::{Forecast, forecast, mean};
use super::front::front;
use super::knobs::Knob;
use super::loops::{LOOP_SLOTS, LoopBench, LoopErrors, case_of, controlled, is_loop};
use super::points::Which;
use anyhow::Result;
use hapticore_contract::profile::Profile;
use hapticore_run::engine::Fidelity;
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
    /// Measured ones of force loops and split pads, where scenes have them.
    pub looped: LoopErrors,
    /// The least amplitude of a channel in steps of the ADC.
    pub least_codes: f64,
    /// Whether one slot makes most of a predicted error or a frame is flagged: the error then may be any.
    pub is_of_one: [bool; 3],
    /// What the predicted errors are made of.
    #[serde(skip)]
    pub sources: Sources,
    /// No other point has less measured error of the quantity, and is neither larger nor slower.
    pub front: [bool; 3],
    /// The same of force, drive and direction in loops.
    pub front_in_loops: [bool; 3],
    /// The profile.
    #[serde(skip)]
    pub profile: Arc<Profile>,
}

/// What profiles are tried on.
pub struct Trial {
    scenes: Vec<Arc<Scene>>,
    /// Scenes whose slots depend on the core.
    loops: Vec<Arc<Scene>>,
    profile: Profile,
    slots: usize,
    /// Those that were made: profiles of later runs share them, too.
    benches: Mutex<Vec<Arc<Vec<Bench>>>>,
    /// Of slots that no other run sees.
    judges: Mutex<Vec<Arc<Vec<Bench>>>>,
    loop_benches: Mutex<Vec<Arc<Vec<LoopBench>>>>,
}

/// What a profile is off where it is worst, on slots that a search has not seen.
#[derive(Debug, Clone, Serialize)]
pub struct Judged {
    /// Errors of force, capacitance and position: each of its worst scene.
    pub errors: Errors,
    /// The names of these scenes.
    pub scenes: [String; 3],
    /// Scenes that have no slots between those that were seen: judged on the same.
    pub seen: Vec<String>,
}

impl Trial {
    /// A trial of a profile, and of others about it, on `slots` slots of each scene. Of scenes whose
    /// slots depend on the core it is the first twenty times as many.
    pub fn new(scenes: Vec<Scene>, profile: Profile, slots: usize) -> Self {
        let tried = scenes.iter().map(|scene| &scene.cases[case_of(scene)]);
        let profile = controlled(profile, tried);
        let (loops, scenes): (Vec<_>, _) = scenes
            .into_iter()
            .map(Arc::new)
            .partition(|scene| is_loop(&scene.cases[case_of(scene)]));
        let (benches, judges, loop_benches) = Default::default();
        Trial { scenes, loops, profile, slots, benches, judges, loop_benches }
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
                Knob::BlockShift => {
                    let others = Knob::other_blocks(&self.profile);
                    others.map(|profile| knob.value(&profile)).collect()
                }
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
        let benches = plan
            .iter()
            .map(|(_, profile)| Ok((self.benches(profile)?, self.loop_benches(profile)?)));
        let benches = benches.collect::<Result<Vec<_>>>()?;
        let points: Result<Vec<Point>> = plan
            .par_iter()
            .zip(&benches)
            .map(|((knob, profile), (benches, loops))| {
                interrupt::check()?;
                let point = point(*knob, profile, (benches, loops))?;
                progress();
                Ok(point)
            })
            .collect();
        let mut points = points?;
        mark_front(&mut points);
        Ok(points)
    }

    /// Forecasts of profiles before a core of any has run, on all processors.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn forecast(&self, profiles: &[Profile]) -> Result<Vec<Forecast>> {
        let benches = profiles.iter().map(|profile| self.benches(profile));
        let benches = benches.collect::<Result<Vec<_>>>()?;
        let of = |(profile, benches): (&Profile, &Arc<Vec<Bench>>)| {
            interrupt::check()?;
            forecast(profile, benches)
        };
        profiles.par_iter().zip(&benches).map(of).collect()
    }

    /// What a profile's core is off on slots between those of [`run`](Self::run), scene by scene.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    ///
    /// # Panics
    /// Where all scenes are force loops.
    pub fn judge(&self, profile: &Profile) -> Result<Judged> {
        let benches = self.benches_of(&self.judges, Which::Between(self.slots), profile)?;
        let of_scenes = benches.par_iter().map(|bench| Ok((bench, measured(bench, profile)?)));
        let of_scenes = of_scenes.collect::<Result<Vec<_>>>()?;
        let worst = [0, 1, 2].map(|n| {
            let by_rms = of_scenes.iter().max_by(|a, b| a.1[n].rms.total_cmp(&b.1[n].rms));
            by_rms.expect("a scene")
        });
        let seen = benches.iter().filter(|bench| !bench.has_between(self.slots));
        Ok(Judged {
            errors: [0, 1, 2].map(|n| worst[n].1[n]),
            scenes: worst.map(|(bench, _)| bench.scene().to_owned()),
            seen: seen.map(|bench| bench.scene().to_owned()).collect(),
        })
    }

    fn benches(&self, profile: &Profile) -> Result<Arc<Vec<Bench>>> {
        self.benches_of(&self.benches, Which::Every(self.slots), profile)
    }

    fn benches_of(
        &self,
        made: &Mutex<Vec<Arc<Vec<Bench>>>>,
        which: Which,
        profile: &Profile,
    ) -> Result<Arc<Vec<Bench>>> {
        let mut made = made.lock().expect("nobody panics with it");
        if let Some(known) = made.iter().find(|of| of.iter().all(|bench| bench.suits(profile))) {
            return Ok(known.clone());
        }
        let bench = |scene| Bench::new((scene, 0), profile, which, true);
        let benches = Arc::new(self.scenes.iter().map(bench).collect::<Result<Vec<_>>>()?);
        made.push(benches.clone());
        Ok(benches)
    }

    fn loop_benches(&self, profile: &Profile) -> Result<Arc<Vec<LoopBench>>> {
        let mut made = self.loop_benches.lock().expect("nobody panics with it");
        let suits = |benches: &&Arc<Vec<LoopBench>>| benches.iter().all(|of| of.suits(profile));
        if let Some(known) = made.iter().find(suits) {
            return Ok(known.clone());
        }
        let slots = LOOP_SLOTS * self.slots;
        let bench = |scene: &Arc<Scene>| {
            LoopBench::new((scene, case_of(scene)), &self.profile, profile, slots)
        };
        let benches = Arc::new(self.loops.par_iter().map(bench).collect::<Result<Vec<_>>>()?);
        made.push(benches.clone());
        Ok(benches)
    }
}

fn point(
    knob: Option<Knob>,
    profile: &Profile,
    (benches, loops): (&[Bench], &[LoopBench]),
) -> Result<Point> {
    let Forecast { cost, predicted, sources, least_codes, is_of_one } = forecast(profile, benches)?;
    let measured = benches.iter().map(|bench| measured(bench, profile));
    let of_loop = |bench: &LoopBench| Ok(bench.errors(&bench.run(profile, Fidelity::Fixed)?));
    let looped = loops.iter().map(of_loop);
    let looped = LoopErrors::pooled(&looped.collect::<Result<Vec<_>>>()?);
    Ok(Point {
        knob: knob.map_or(String::new(), |knob| knob.key().into()),
        value: knob.map_or(0, |knob| knob.value(profile)),
        cost,
        predicted,
        measured: mean(&measured.collect::<Result<Vec<_>>>()?),
        looped,
        least_codes,
        is_of_one,
        sources,
        front: [false; 3],
        front_in_loops: [false; 3],
        profile: Arc::new(profile.clone()),
    })
}

/// What a profile's core is off on the slots of a bench.
fn measured(bench: &Bench, profile: &Profile) -> Result<Errors> {
    let (profile, calibration) = (bench.serve(profile)?, bench.calibration());
    let results = results(Fidelity::Fixed, &profile, calibration, bench.slots());
    Ok(errors(&results.values, bench.slots().iter().map(|slot| &slot.ideal)))
}

/// Marks the points that none beats in error, size and age together.
fn mark_front(points: &mut [Point]) {
    for quantity in 0..Quantity::ALL.len() {
        let on = on_front(points, |point| Some(point.measured[quantity].rms));
        points.iter_mut().zip(on).for_each(|(point, on)| point.front[quantity] = on);
        let on = on_front(points, |point| Some(point.looped.all()[quantity]?.rms));
        points.iter_mut().zip(on).for_each(|(point, on)| point.front_in_loops[quantity] = on);
    }
}

/// Which points none beats in an error, size and age together; none where there is no such error.
fn on_front(points: &[Point], error: impl Fn(&Point) -> Option<f64>) -> Vec<bool> {
    let of = |point: &Point| Some([error(point)?, point.cost.luts, point.cost.age_us]);
    let all: Option<Vec<_>> = points.iter().map(of).collect();
    all.map_or_else(|| vec![false; points.len()], |all| front(&all))
}
