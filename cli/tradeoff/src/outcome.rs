// SPDX-License-Identifier: MIT OR Apache-2.0
//! A whole tradeoff, from names to rows and, with a target, the cheapest profile.
//!
//! ```text
//! Request ─ Prepared::new ─ Prepared::sweep ─ points ─ Prepared::outcome ─ Tradeoff ─ csv, JSON, profile
//! ```

use super::cost::{self, Family};
use super::errors::{Error, Quantity};
use super::loops::{self, LoopErrors, case_of};
use super::model::{Model, NextBit};
use super::points;
use super::search::{Found, models, search};
use super::sweep::{Point, Trial};
use super::synthesis::Synthesised;
use super::target::Target;
use anyhow::{Context, Result, ensure};
use hapticore_contract::profile::Profile;
use hapticore_run::inputs;
use hapticore_run::record::Provenance;
use hapticore_scene::{Scene, Timing};
use serde::Serialize;

/// The profile where none is named.
const PROFILE: &str = "standard";
/// The scenes where none are: places all over the sheet, forces over load and voltage, motion.
const SCENES: [&str; 3] = ["fig3", "fig6", "hockey"];

/// What is asked.
#[derive(Debug, Clone, Default)]
pub struct Request {
    /// The profile that is varied, a bundled name or a file.
    pub profile: Option<String>,
    /// Scenes that profiles are tried on, bundled names or files.
    pub scenes: Vec<String>,
    /// Slots of each scene.
    pub slots: usize,
    /// Errors that the cheapest profile shall not exceed.
    pub target: Option<Target>,
    /// The family whose LUT4 a search saves, by its name.
    pub family: Option<String>,
    /// Also what one more bit of each word would buy.
    pub explain: bool,
}

/// All that a run leaves.
#[derive(Debug, Serialize)]
pub struct Tradeoff {
    /// The profile that was varied.
    pub profile: String,
    /// The scenes whose slots it was tried on.
    pub scenes: Vec<String>,
    /// Slots of each scene.
    pub slots: usize,
    /// The profile itself, then each of its neighbours.
    pub points: Vec<Point>,
    /// The cheapest profile for a target, where there was one.
    pub found: Option<Found>,
    /// What one more bit would buy, of the profile that was found or else of the profile itself; where
    /// it was asked for.
    pub next_bits: Vec<NextBit>,
    /// What synthesis makes of the profile, and of the profile that was found; where it was asked
    /// for.
    pub synthesised: Vec<Synthesised>,
    /// Version, command and such.
    pub provenance: Provenance,
}

/// A request whose inputs were read.
pub struct Prepared {
    trial: Trial,
    family: Family,
    names: Vec<String>,
    request: Request,
    /// What a user must know.
    pub warnings: Vec<String>,
}

impl Prepared {
    /// Reads profile and scenes.
    ///
    /// # Errors
    /// No such profile, scene or family, no slots.
    pub fn new(request: Request) -> Result<Self> {
        let mut warnings = Vec::new();
        let profile = inputs::profile(request.profile.as_deref().unwrap_or(PROFILE))?;
        let (names, scenes) = scenes(&request.scenes)?;
        let profile = windowed(profile, &scenes, &mut warnings)?;
        let timing = Timing { signs: None, ..inputs::timing(&profile) };
        let scenes = scenes.into_iter().map(|scene| scene.within_budget(&timing));
        let scenes = scenes.collect::<Result<Vec<_>, _>>()?;
        ensure!(request.slots >= 1, "--slots: expected at least 1");
        let trial = Trial::new(scenes, profile, request.slots);
        let family = match &request.family {
            None => cost::family(trial.profile()),
            Some(name) => cost::named(name).with_context(|| {
                let names = Family::ALL.map(|family| family.name()).join(" or ");
                format!("--family: expected {names}, got {name:?}")
            })?,
        };
        Ok(Prepared { trial, family, names, request, warnings })
    }

    /// The profile that is varied, as the scenes have it.
    pub fn profile(&self) -> &Profile {
        self.trial.profile()
    }

    /// How many profiles a sweep tries.
    pub fn profiles(&self) -> usize {
        self.trial.plan().len()
    }

    /// Tries the profile and its neighbours on all processors; `progress` is called after each.
    ///
    /// # Errors
    /// As [`Trial::run`].
    pub fn sweep(&self, progress: &(dyn Fn() + Sync)) -> Result<Vec<Point>> {
        self.trial.run(&self.trial.plan(), progress)
    }

    /// What follows from the points of [`Prepared::sweep`]: searches where there is a target.
    ///
    /// # Errors
    /// As [`Trial::run`].
    pub fn outcome(self, points: Vec<Point>) -> Result<Tradeoff> {
        let Prepared { trial, family, names, request, .. } = self;
        let models = match request.target {
            Some(_) => models(&trial, family, &points)?,
            None if request.explain => vec![Model::new(trial.profile(), family, &points)],
            None => Vec::new(),
        };
        let search = |target: Target| search(&trial, &points, &models, &target);
        let found = request.target.map(search).transpose()?;
        let of = found.as_ref().map_or(trial.profile(), |found| &found.profile);
        let explained = models.iter().find(|model| request.explain && model.is_about(of));
        let next_bits = explained.map(|model| model.next_bits(of)).unwrap_or_default();
        Ok(Tradeoff {
            profile: trial.profile().name.clone(),
            scenes: names,
            slots: request.slots,
            points,
            found,
            next_bits,
            synthesised: Vec::new(),
            provenance: Provenance::new(),
        })
    }
}

/// The scenes that were named, with their names. Those whose slots depend on the core show what its words
/// change of drives and directions; where all are such, the usual ones show all else.
fn scenes(named: &[String]) -> Result<(Vec<String>, Vec<Scene>)> {
    let mut scenes = named.iter().map(|name| scene(name)).collect::<Result<Vec<_>>>()?;
    let mut names = named.to_vec();
    if scenes.iter().all(is_loop) {
        for (n, name) in SCENES.iter().enumerate() {
            scenes.insert(n, scene(name)?);
            names.insert(n, name.to_string());
        }
    }
    Ok((names, scenes))
}

fn is_loop(scene: &Scene) -> bool {
    loops::is_loop(&scene.cases[case_of(scene)])
}

/// A scene whose sensors leave the rounding to the core's ADC.
fn scene(name: &str) -> Result<Scene> {
    let scene = inputs::scene(name, &[])?;
    inputs::scene(name, &points::unrounded(&scene.cases[case_of(&scene)])?)
}

/// The profile with the slot that the scenes ask for, as `simulate` runs them. Where they do not all
/// ask for the same, it keeps its own: all scenes are to try one profile.
fn windowed(profile: Profile, scenes: &[Scene], warnings: &mut Vec<String>) -> Result<Profile> {
    let slot = |scene: &Scene| (scene.window_samples, scene.settle_samples);
    let asking = |scene: &&Scene| slot(scene) != (None, None);
    // Force loops are run in their own.
    let scenes: Vec<&Scene> = scenes.iter().filter(|scene| !is_loop(scene)).collect();
    match scenes.iter().copied().find(asking) {
        None => Ok(profile),
        Some(first) if scenes.iter().all(|scene| slot(scene) == slot(first)) => {
            inputs::windowed(profile, first)
        }
        Some(_) => {
            let names = scenes.iter().copied().filter(asking).map(|scene| scene.name.as_str());
            warnings.push(format!(
                "{}: window_samples and settle_samples are not taken, since not all scenes ask for the same; slots are those of profile {}",
                names.collect::<Vec<_>>().join(", "),
                profile.name
            ));
            Ok(profile)
        }
    }
}

impl Tradeoff {
    /// The profile that was found, as TOML; none without a target.
    ///
    /// # Errors
    /// A profile that is no TOML, which is a broken invariant.
    pub fn found_profile(&self) -> Result<Option<String>> {
        let text = |found: &Found| -> Result<String> {
            Ok(format!("# Found by hapticore tradeoff.\n{}", toml::to_string(&found.profile)?))
        };
        self.found.as_ref().map(text).transpose()
    }

    /// A row for each point, as CSV.
    pub fn csv(&self) -> String {
        csv(&self.points)
    }
}

const COLUMNS: &str = "knob,value,latency_clocks,age_us,frames_per_second,luts_ecp5,luts_ice40,flip_flops,multipliers,memory_bits,multipliers_ice40,block_rams_ecp5,block_rams_ice40,least_codes";

fn csv(points: &[Point]) -> String {
    let mut head = COLUMNS.to_string();
    for kind in ["predicted", "measured"] {
        for quantity in Quantity::ALL {
            for what in ["rms", "mean", "largest"] {
                head += &format!(",{kind}_{}_{what}", quantity.name());
            }
        }
    }
    for (name, _) in LoopErrors::QUANTITIES {
        for what in ["rms", "mean", "largest"] {
            head += &format!(",measured_{name}_{what}");
        }
    }
    let row = |point: &Point| {
        let cost = &point.cost;
        let mut row = format!(
            "{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
            point.knob,
            point.value,
            cost.latency_clocks,
            cost.age_us,
            cost.frames_per_second,
            cost.luts.round(),
            cost.luts_ice40.round(),
            cost.flip_flops,
            cost.multipliers,
            cost.memory_bits,
            cost.multipliers_ice40,
            cost.block_rams,
            cost.block_rams_ice40,
            point.least_codes
        );
        for error in point.predicted.iter().chain(&point.measured) {
            row += &format!(",{:e},{:e},{:e}", error.rms, error.mean, error.largest);
        }
        for error in point.looped.all() {
            let of =
                |error: Error| format!(",{:e},{:e},{:e}", error.rms, error.mean, error.largest);
            row += &error.map_or(",,,".into(), of);
        }
        row + "\n"
    };
    points.iter().fold(head + "\n", |text, point| text + &row(point))
}
