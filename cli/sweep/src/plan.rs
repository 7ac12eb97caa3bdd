// SPDX-License-Identifier: MIT OR Apache-2.0
//! A plan: scene, profile, and what of both is varied.
//!
//! ```toml
//! scene = "fig3"                  # a bundled name or a file, relative to the plan
//! case = "rest"                   # default: the scene's first
//! profile = "standard"            # a bundled name or a file; default: the scene's
//! fidelity = "fixed"              # float or fixed; default fixed
//! slots = 24                      # spread over the case; default 24
//! predicted = 2                   # of them, slots that errors are predicted of; default 0: none
//! seeds = [1, 2]                  # of noise and mismatch; default: the scene's own
//!
//! [axes.profile]                  # every combination; keys as of a knob of `hapticore tradeoff`, or of a profile
//! adc = [14, 16, 18]
//! slot.integrate = { from = 500, to = 1000, step = 250 }
//!
//! [axes.scene]                    # keys as of `hapticore simulate --set`
//! sheet.rung = ["bilinear", "bicubic"]
//! ```
//!
//! or, in place of `[axes]`, random points:
//!
//! ```toml
//! scene = "fig3"
//! [random]
//! count = 1000
//! seed = 7                        # of the draws; default 1
//! [random.profile]
//! iq = { from = 18, to = 26 }
//! ```

use std::collections::HashSet;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail, ensure};
use hapticore_contract::profile::Profile;
use hapticore_hdl::verilog::Design;
use hapticore_host::text::read;
use hapticore_run::inputs;
use hapticore_scene::{Place, Scene, SceneError, gallery};
use hapticore_tradeoff::bench::is_same_bench;
use hapticore_tradeoff::cost::netlist;
use hapticore_tradeoff::loops::{controlled, is_loop, is_same_loop};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::axis::{Axis, Points, Settings, Side};
pub use crate::file::Fidelity;
use crate::file::{File, Lines};
use crate::{canonical, settings};

/// Version of everything that is named by its content: keys, lines, plans.
pub const SCHEMA: u32 = 3;

/// Keys of a scene that a plan sets in another way, and how.
const WHOLE: [(&str, &str); 5] = [
    ("seed", "seeds = [...]"),
    ("profile", "profile, and keys of [axes.profile]"),
    ("window_samples", "slot.integrate of [axes.profile]"),
    ("settle_samples", "slot.settle of [axes.profile]"),
    ("case", "case, or one plan per case"),
];

/// How many values of an axis are tried as a plan is read.
const TRIED: usize = 64;

/// The most points of a plan.
const MOST_POINTS: u128 = 10_000_000;

/// A plan with everything that it needs: it can be run where its files are not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// [`SCHEMA`].
    pub schema: u32,
    /// Hash of the Verilog that this version of the core is printed as, with the plan's profile.
    pub core: String,
    /// The scene.
    pub scene: SceneText,
    /// Which of its cases.
    pub case: String,
    /// The profile that points are variations of.
    pub profile: Profile,
    /// How exactly the core is run.
    pub fidelity: Fidelity,
    /// Slots of the case that each point is tried on.
    pub slots: usize,
    /// Slots that errors are predicted of.
    pub predicted: usize,
    /// Seeds of the scene.
    pub seeds: Vec<u64>,
    /// What is varied.
    pub points: Points,
}

/// A scene as it was read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneText {
    /// Its file.
    pub file: String,
    /// Its text.
    pub text: String,
}

impl Plan {
    /// Reads a plan and what it names, and tries the first values of each axis by themselves.
    ///
    /// # Errors
    /// A file that cannot be read, an unknown key, a value that is none; the message names file, line
    /// and key, and what was expected.
    pub fn read(path: &Path) -> Result<Plan> {
        Plan::parse(&read(path)?, &path.display().to_string())
    }

    /// The plan that a text is, called `file` in messages; what it names is read.
    ///
    /// # Errors
    /// As [`Plan::read`].
    pub fn parse(text: &str, file: &str) -> Result<Plan> {
        let read = File::parse(text).map_err(|error| anyhow!("{file}:{error}"))?;
        Plan::of(&read, &Lines::of(file, text, &read))
    }

    fn of(file: &File, lines: &Lines) -> Result<Plan> {
        let scene_text = scene_text(file, lines)?;
        let scene = Scene::parse(&scene_text.text, &scene_text.file, &[])?;
        let named = file.profile.as_ref().map(|name| match Profile::bundled(name.get_ref()) {
            Ok(_) => name.get_ref().clone(),
            Err(_) => beside(lines.name(), name.get_ref()),
        });
        let profile = inputs::profile(named.as_ref().unwrap_or(&scene.profile))
            .with_context(|| lines.at(&file.profile, "profile"))?;
        let case = match &file.case {
            None => scene.cases[0].name.clone(),
            Some(case) => {
                known_case(&scene, case.get_ref()).with_context(|| lines.at(&file.case, "case"))?
            }
        };
        let profile = inputs::windowed(profile, &scene)?;
        let profile = controlled(profile, scene.cases.iter().filter(|of| of.name == case));
        let plan = Plan {
            schema: SCHEMA,
            core: core_hash(&profile)?,
            scene: scene_text,
            case,
            profile,
            fidelity: file.fidelity.unwrap_or_default(),
            slots: file.whole(lines, "slots", &file.slots, 24, 1)?,
            predicted: file.whole(lines, "predicted", &file.predicted, 0, 0)?,
            seeds: file.seeds(lines, scene.seed)?,
            points: file.points(lines)?,
        };
        plan.check(lines)?;
        Ok(plan.slowest_first())
    }

    /// The axes of a grid in an order in which neighbours share plant and calibration: first those of the
    /// scene, then those of the profile that a bench depends on, then words.
    fn slowest_first(mut self) -> Plan {
        let moving: HashSet<String> = self.bench_keys().into_iter().collect();
        if let Points::Grid(axes) = &mut self.points {
            axes.sort_by_key(|axis| (axis.side == Side::Profile, !moving.contains(&axis.key)));
        }
        self
    }

    /// Keys of the profile's axes that plant, calibration or ideal core depend on.
    pub(crate) fn bench_keys(&self) -> Vec<String> {
        let looped = self.scene_with(&Settings::new()).is_ok_and(|scene| {
            scene.cases.iter().any(|case| case.name == self.case && is_loop(case))
        });
        let is_same = |turned: &Profile| match looped {
            true => is_same_loop(&self.profile, &self.profile, turned),
            false => is_same_bench(&self.profile, turned),
        };
        let moves = |axis: &&Axis| {
            let turned = axis.values.examples().into_iter().map(|value| {
                settings::turned(&self.profile, &Settings::from([(axis.key.clone(), value)]))
            });
            turned.flatten().any(|turned| !is_same(&turned))
        };
        let of_profile = self.axes().iter().filter(|axis| axis.side == Side::Profile);
        of_profile.filter(moves).map(|axis| axis.key.clone()).collect()
    }

    /// Tries values of each axis by themselves, which names their line as a point that fails could not.
    fn check(&self, lines: &Lines) -> Result<()> {
        for axis in self.axes() {
            let whole = WHOLE.iter().find(|(key, _)| axis.side == Side::Scene && *key == axis.key);
            if let Some((_, instead)) = whole {
                bail!("{}: expected {instead} in its place", lines.of_axis(axis));
            }
            for value in axis.values.examples().into_iter().take(TRIED) {
                let set = Settings::from([(axis.key.clone(), value)]);
                let tried = match axis.side {
                    Side::Profile => settings::turned(&self.profile, &set).map(drop),
                    Side::Scene => self.scene_with(&set).map(drop).map_err(|error| told(&error)),
                };
                tried.map_err(|message| anyhow!("{}: {message}", lines.of_axis(axis)))?;
            }
        }
        let points = self.combinations();
        ensure!(
            points <= MOST_POINTS,
            "{}: expected at most {MOST_POINTS} points, got {points}",
            lines.name()
        );
        Ok(())
    }

    /// The scene with keys set.
    ///
    /// # Errors
    /// A key or value that the scene cannot have.
    pub fn scene_with(&self, set: &Settings) -> Result<Scene, SceneError> {
        Scene::parse(&self.scene.text, &self.scene.file, &settings::overrides(set))
    }

    /// The name of the plan: the hash of everything in it.
    pub fn name(&self) -> String {
        canonical::name(self)
    }

    /// The axes.
    pub fn axes(&self) -> &[Axis] {
        match &self.points {
            Points::Grid(axes) | Points::Random { axes, .. } => axes,
        }
    }

    /// Checks that this program makes of the plan what the one made of it that read it.
    ///
    /// # Errors
    /// Another schema, or another core.
    pub fn check_program(&self) -> Result<()> {
        ensure!(
            self.schema == SCHEMA,
            "expected a plan of schema {SCHEMA}, got {}; take the program that wrote it",
            self.schema
        );
        let own = core_hash(&self.profile)?;
        ensure!(
            self.core == own,
            "the plan is of a core whose Verilog has the hash {:.16}, this program's has {own:.16}; take the program that wrote the plan",
            self.core
        );
        Ok(())
    }
}

/// What tells one version of the core from another, as far as results go: a hash of its Verilog.
fn core_hash(profile: &Profile) -> Result<String> {
    let design = Design::print(&netlist(profile)?, "");
    Ok(blake3::hash(design.text().as_bytes()).to_hex().to_string())
}

/// The scene's text. Its file is called as the plan has it, so that a plan is the same from whatever folder it is run.
fn scene_text(file: &File, lines: &Lines) -> Result<SceneText> {
    let name = file.scene.get_ref();
    if let Some(text) = gallery::find(name) {
        return Ok(SceneText { file: format!("{name}.toml"), text: text.into() });
    }
    let path = beside(lines.name(), name);
    // As every command, with its message where it is neither.
    inputs::scene(&path, &[]).with_context(|| lines.at(&Some(file.scene.clone()), "scene"))?;
    Ok(SceneText { file: name.clone(), text: read(Path::new(&path))? })
}

/// A file that a plan names, whose path is relative to the plan's own folder; any other name as it is.
fn beside(plan: &str, name: &str) -> String {
    let path = Path::new(plan).parent().unwrap_or(Path::new("")).join(name);
    match name.contains(['/', '\\', '.']) || path.is_file() {
        true => path.display().to_string(),
        false => name.into(),
    }
}

fn known_case(scene: &Scene, name: &str) -> Result<String> {
    let names: Vec<_> = scene.cases.iter().map(|case| case.name.as_str()).collect();
    match names.contains(&name) {
        true => Ok(name.into()),
        false => bail!("expected a case among {}, got \"{name}\"", names.join(", ")),
    }
}

/// What is wrong with a scene that a plan sets something in, without the scene's own place where the
/// plan's is meant.
fn told(error: &SceneError) -> String {
    match error.place {
        Place::Line(_) => error.to_string(),
        Place::Override | Place::File => error.message.clone(),
    }
}

/// The value of a setting as a reader would write it: texts without quotes.
pub fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), String::from)
}
