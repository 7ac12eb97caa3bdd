// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs points. Those that differ in the profile's words alone share plant and calibration; results
//! do not depend on what was shared.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use anyhow::{Context, Result, anyhow, ensure};
use hapticore_contract::profile::Profile;
use hapticore_model::fidelity::noise::Predictor;
use hapticore_run::record::Row;
use hapticore_run::{inputs, interrupt};
use hapticore_scene::{LevelDeviation, Scene, Timing};
use hapticore_tradeoff::bench::Bench;
use hapticore_tradeoff::cost::{Cost, cost};
use hapticore_tradeoff::errors::{Expectation, errors, predicted, results};
use hapticore_tradeoff::loops::{LOOP_SLOTS, LoopBench, is_flagged, is_loop};
use hapticore_tradeoff::points::{Values, Which, unrounded};

use crate::axis::Settings;
use crate::plan::{Fidelity, Plan};
use crate::point::{Names, Point};
use crate::result::{Level, Line, Looped, Prediction, Results, Times};
use crate::settings;

/// Runs points of a plan, one after the other.
pub struct Runner<'a> {
    plan: &'a Plan,
    names: &'a Names,
    benches: &'a Benches,
    /// The last profile's cost.
    cost: Option<(Profile, Cost)>,
}

/// The last benches of all runners, each with what of the scene was set; the newest last.
#[derive(Default)]
pub struct Benches(Mutex<Vec<(Settings, Arc<Ground>)>>);

/// What points are tried on, and how exact the simulated device is.
struct Ground {
    tried: Tried,
    levels: Vec<Level>,
}

/// Slots and calibration, or a case whose slots depend on the core.
enum Tried {
    Slots(Bench),
    Loop(LoopBench),
}

/// How many benches are kept for each thread: one is some megabytes.
const KEPT: usize = 2;

impl<'a> Runner<'a> {
    /// A runner of a plan's points.
    pub fn new(plan: &'a Plan, names: &'a Names, benches: &'a Benches) -> Self {
        Runner { plan, names, benches, cost: None }
    }

    /// Runs a point. One that cannot be run leaves a line that says why.
    ///
    /// # Errors
    /// An interruption.
    pub fn run(&mut self, point: &Point) -> Result<(Line, Times)> {
        let start = Instant::now();
        let key = self.names.of(point);
        let mut times = Times { key: key.clone(), seconds: 0.0, plant: 0.0, core: 0.0 };
        let outcome = self.results(point, &mut times);
        interrupt::check()?;
        let (results, error) = match outcome {
            Ok(results) => (Some(results), None),
            Err(error) => (None, Some(format!("{error:#}"))),
        };
        times.seconds = start.elapsed().as_secs_f64();
        let Point { seed, profile, scene, .. } = point.clone();
        Ok((Line { key, seed, profile, scene, results, error }, times))
    }

    fn results(&mut self, point: &Point, times: &mut Times) -> Result<Results> {
        let profile = settings::turned(&self.plan.profile, &point.profile)
            .map_err(|message| anyhow!("profile: {message}"))?;
        hapticore_model::check(&profile).context("profile")?;
        let ground = self.ground(point, &profile)?;
        let of = Results {
            levels: ground.levels.clone(),
            cost: self.cost(&profile)?,
            ..match &ground.tried {
                Tried::Slots(bench) => self.on_slots(bench, &profile, times)?,
                Tried::Loop(bench) => self.in_loop(bench, &profile, times)?,
            }
        };
        ensure!(
            of.is_finite(),
            "expected finite errors; some result or true value is zero or none"
        );
        Ok(of)
    }

    /// What a core makes of slots.
    fn on_slots(&self, bench: &Bench, profile: &Profile, times: &mut Times) -> Result<Results> {
        times.plant = bench.seconds() / bench.simulated_s();
        let (served, slots) = (bench.serve(profile)?, bench.slots());
        let start = Instant::now();
        let found = results(self.plan.fidelity.into(), &served, bench.calibration(), slots);
        times.core = start.elapsed().as_secs_f64() / bench.simulated_s();
        Ok(Results {
            slots: slots.len(),
            flagged: found.flagged,
            measured: errors(&found.values, slots.iter().map(|slot| &slot.ideal)).into(),
            truth: errors(&found.values, slots.iter().map(|slot| &slot.truth)).into(),
            predicted: self.prediction(bench, &served)?,
            ..Results::default()
        })
    }

    /// What a core makes of a case whose slots depend on it.
    fn in_loop(&self, bench: &LoopBench, profile: &Profile, times: &mut Times) -> Result<Results> {
        let start = Instant::now();
        let rows = bench.run(profile, self.plan.fidelity.into())?;
        // Plant and core alternate: their times are not measured apart.
        times.plant = start.elapsed().as_secs_f64() / bench.simulated_s();
        let valid: Vec<[&Row; 2]> = bench.valid(&rows).collect();
        let of =
            |values: &dyn Fn(&[&Row; 2]) -> Values| valid.iter().map(values).collect::<Vec<_>>();
        let found = of(&|[row, _]| Values::of_quantities(&row.measured));
        let ideal = of(&|[_, ideal]| Values::of_quantities(&ideal.measured));
        let known = |row: &Row| row.truth.expect("a plant knows its slots").quantities;
        let truth = of(&|[row, _]| Values::of_quantities(&known(row)));
        Ok(Results {
            slots: valid.len(),
            flagged: valid.iter().filter(|[row, _]| is_flagged(row)).count(),
            measured: errors(&found, ideal.iter()).into(),
            truth: errors(&found, truth.iter()).into(),
            looped: Some(Looped {
                measured: bench.errors(&rows),
                truth: bench.errors_of_truth(&rows),
            }),
            ..Results::default()
        })
    }

    fn prediction(&self, bench: &Bench, profile: &Profile) -> Result<Option<Prediction>> {
        if self.plan.predicted == 0 || self.plan.fidelity == Fidelity::Float {
            return Ok(None);
        }
        let Expectation { errors, least_codes, .. } =
            predicted(profile, bench.calibration(), bench.some(self.plan.predicted))?;
        Ok(Some(Prediction { errors: errors.into(), least_codes }))
    }

    fn cost(&mut self, profile: &Profile) -> Result<Cost> {
        if let Some((of, cost)) = &self.cost
            && of == profile
        {
            return Ok(*cost);
        }
        let of = cost(profile)?;
        self.cost = Some((profile.clone(), of));
        Ok(of)
    }

    fn ground(&self, point: &Point, profile: &Profile) -> Result<Arc<Ground>> {
        let mut set = point.scene.clone();
        set.insert("seed".into(), point.seed.into());
        if let Some(ground) = self.benches.find(&set, profile) {
            return Ok(ground);
        }
        // Two threads may make the same one: that costs less than to wait for each other.
        let ground = Arc::new(self.new_ground(&set, profile)?);
        self.benches.keep(set, ground.clone());
        Ok(ground)
    }

    /// Slots of the plan's case, as its scene asks for samples or phasors. The rounding is left to the
    /// core's ADC, unless the plan sets the sensors' own.
    fn new_ground(&self, set: &Settings, profile: &Profile) -> Result<Ground> {
        let chosen = |scene: &Scene| {
            scene.cases.iter().position(|case| case.name == self.plan.case).with_context(|| {
                format!("{}: expected a case named {}", scene.name, self.plan.case)
            })
        };
        let mut scene = self.plan.scene_with(set)?;
        let index = chosen(&scene)?;
        if !set.keys().any(|key| key.starts_with("sensor.quantisation_bits")) {
            let finer = unrounded(&scene.cases[index])?;
            let all = settings::overrides(set).into_iter().chain(finer).collect::<Vec<_>>();
            scene = Scene::parse(&self.plan.scene.text, &self.plan.scene.file, &all)?;
        }
        let timing = Timing { signs: None, ..inputs::timing(profile) };
        let scene = Arc::new(scene.within_budget(&timing)?);
        let sampled = scene.cases[index].sampled();
        // Beside the seed, which every point sets.
        let of_levels = |profile: &Profile| match set.len() > 1 {
            true => levels(&scene, index, profile),
            false => Ok(Vec::new()),
        };
        if is_loop(&scene.cases[index]) {
            let slots = LOOP_SLOTS * self.plan.slots;
            let bench = LoopBench::new((&scene, index), &self.plan.profile, profile, slots)?;
            return Ok(Ground {
                levels: of_levels(&*bench.served(profile)?)?,
                tried: Tried::Loop(bench),
            });
        }
        let bench = Bench::new((&scene, index), profile, Which::Every(self.plan.slots), sampled)?;
        Ok(Ground { levels: of_levels(&*bench.serve(profile)?)?, tried: Tried::Slots(bench) })
    }
}

/// How far the levels of a case are from finer ones.
fn levels(scene: &Scene, index: usize, profile: &Profile) -> Result<Vec<Level>> {
    let deviations = scene.level_deviations(index, &inputs::timing(profile))?;
    let level = |of: LevelDeviation| {
        let (finer, percent) = of.finer?;
        Some(Level { effect: of.effect.into(), level: of.level, finer, percent })
    };
    Ok(deviations.into_iter().filter_map(level).collect())
}

impl Benches {
    fn find(&self, set: &Settings, profile: &Profile) -> Option<Arc<Ground>> {
        let suits =
            |(of, ground): &&(Settings, Arc<Ground>)| of == set && ground.tried.suits(profile);
        self.all().iter().rfind(suits).map(|(_, ground)| ground.clone())
    }

    fn keep(&self, set: Settings, ground: Arc<Ground>) {
        let mut all = self.all();
        if all.len() >= KEPT * rayon::current_num_threads() {
            all.remove(0);
        }
        all.push((set, ground));
    }

    fn all(&self) -> std::sync::MutexGuard<'_, Vec<(Settings, Arc<Ground>)>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Tried {
    fn suits(&self, profile: &Profile) -> bool {
        match self {
            Tried::Slots(bench) => bench.suits(profile),
            Tried::Loop(bench) => bench.suits(profile),
        }
    }
}

impl Prediction {
    /// Whether some amplitude meets too few codes for the prediction to hold.
    pub fn has_few_codes(&self) -> bool {
        self.least_codes < Predictor::FEW_CODES
    }
}
