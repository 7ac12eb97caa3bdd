// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes whose slots depend on the core, or whose results come from several slots: force loops, and pads
//! that are served part by part.
//!
//! Such a scene is run from its beginning, by the profile's core and by the ideal one: reference and
//! controller in floating point, on samples of 24 bits. What the former is off the latter:
//!
//! | quantity | unit | of a slot |
//! | --- | --- | --- |
//! | force | mN | true haptic force, which the user feels |
//! | drive | V | haptic voltage, RMS |
//! | direction | ppm | direction of the push, of half the sheet's width |

use super::errors::{Error, Sum, pooled};
use anyhow::{Context, Result};
use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::{Carrier, Profile};
use hapticore_hdl::format::Format;
use hapticore_run::case::{Case, Settings};
use hapticore_run::engine::Fidelity;
use hapticore_run::inputs;
use hapticore_run::record::Row;
use hapticore_scene::{Case as SceneCase, ControlLaw, Scene};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A loop is run from its beginning, over this many times as many slots as other scenes.
pub const LOOP_SLOTS: usize = 20;

/// The finest ADC that a core may have: that of the ideal core.
const FINE: Format = Format::signed(24, 23);

/// What a core changes of loops; none of a quantity that no scene has.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoopErrors {
    /// True haptic force, mN.
    pub force: Option<Error>,
    /// Haptic voltage, V rms.
    pub drive: Option<Error>,
    /// Direction of the push, millionths of half the sheet's width.
    pub direction: Option<Error>,
}

impl LoopErrors {
    /// Names and units of the quantities.
    pub const QUANTITIES: [(&str, &str); 3] =
        [("loop_force", "mN"), ("drive", "V"), ("direction", "ppm")];

    /// In the order of [`LoopErrors::QUANTITIES`].
    pub fn all(&self) -> [Option<Error>; 3] {
        [self.force, self.drive, self.direction]
    }

    /// Those over several scenes of the same weight.
    pub fn pooled(of_scenes: &[LoopErrors]) -> LoopErrors {
        let of = |quantity: fn(&LoopErrors) -> Option<Error>| {
            let errors: Vec<_> = of_scenes.iter().filter_map(quantity).collect();
            (!errors.is_empty()).then(|| pooled(&errors))
        };
        LoopErrors {
            force: of(|of| of.force),
            drive: of(|of| of.drive),
            direction: of(|of| of.direction),
        }
    }
}

/// Whether the slots of a case depend on the core, or its results on several of them.
pub fn is_loop(case: &SceneCase) -> bool {
    case.control.is_some() || case.parts() > 1
}

/// The case of a scene that profiles are tried on: the first in closed loop, or the first.
pub fn case_of(scene: &Scene) -> usize {
    let closed =
        |case: &SceneCase| case.control.as_ref().is_some_and(|plan| plan.law != ControlLaw::Open);
    scene.cases.iter().position(closed).unwrap_or(0)
}

/// The profile with a controller, where a case needs one and the profile has none.
pub fn controlled<'a>(profile: Profile, cases: impl IntoIterator<Item = &'a SceneCase>) -> Profile {
    let needed = cases.into_iter().any(|case| case.control.is_some());
    let own = profile.control.clone();
    let control = own.or_else(|| needed.then(|| Control::of(&profile, Law::Inverse)));
    Profile { control, ..profile }
}

/// A case of a scene, and what the ideal core makes of it.
pub struct LoopBench {
    scene: Arc<Scene>,
    index: usize,
    slots: usize,
    /// The profile whose formats the ideal core has; it rounds none of its words.
    words: Profile,
    of: Profile,
    ideal: Vec<Row>,
    slot_s: f64,
}

impl LoopBench {
    /// At most `slots` slots of a case, from its beginning on. Profiles are tried in the slot that the
    /// scene asks for, else in their own. The ideal core has the structure of a profile, and the formats
    /// of `words`, so that it does not depend on which of several profiles is the first.
    ///
    /// # Errors
    /// A case that cannot be run.
    pub fn new(
        (scene, index): (&Arc<Scene>, usize),
        words: &Profile,
        profile: &Profile,
        slots: usize,
    ) -> Result<Self> {
        let mut bench = LoopBench {
            scene: scene.clone(),
            index,
            slots,
            words: words.clone(),
            of: with_words(profile, words),
            ideal: Vec::new(),
            slot_s: 0.0,
        };
        let mut ideal = bench.of.clone();
        ideal.formats.adc = FINE;
        (bench.ideal, bench.slot_s) = {
            let case = bench.case(&ideal)?;
            (rows(&case, Fidelity::Float)?, case.clock.seconds(1))
        };
        Ok(bench)
    }

    /// Whether the ideal core is the same for another profile.
    pub fn suits(&self, profile: &Profile) -> bool {
        is_same_loop(&self.words, &self.of, profile)
    }

    /// What a profile's core makes of the case.
    ///
    /// # Errors
    /// A case that cannot be run with the profile.
    pub fn run(&self, profile: &Profile, fidelity: Fidelity) -> Result<Vec<Row>> {
        rows(&self.case(profile)?, fidelity)
    }

    /// What is off the ideal core's results.
    pub fn errors(&self, rows: &[Row]) -> LoopErrors {
        let drive = |row: &Row| row.driven.map(|driven| driven.drive_v_rms);
        let ideal = || self.ideal.iter();
        LoopErrors {
            force: self.is_controlled().then(|| off(rows, true_n, ideal().map(true_n), 1e3)),
            drive: self.is_controlled().then(|| off(rows, drive, ideal().map(drive), 1.0)),
            direction: self.has_parts().then(|| off(rows, direction, ideal().map(direction), 1e6)),
        }
    }

    /// What is off what the scene asks for and knows: the true force its target, and the direction that
    /// which it is.
    pub fn errors_of_truth(&self, rows: &[Row]) -> LoopErrors {
        let target = |row: &Row| Some(row.driven?.target_n);
        let truth = |row: &Row| row.truth.map(|truth| truth.quantities.direction);
        let of = || rows.iter();
        LoopErrors {
            force: self.is_controlled().then(|| off(rows, true_n, of().map(target), 1e3)),
            drive: None,
            direction: self.has_parts().then(|| off(rows, direction, of().map(truth), 1e6)),
        }
    }

    /// The slots in which the ideal core flags nothing, of some rows and of the ideal ones.
    pub fn valid<'a>(&'a self, rows: &'a [Row]) -> impl Iterator<Item = [&'a Row; 2]> {
        rows.iter().zip(&self.ideal).filter(|(_, ideal)| !is_flagged(ideal)).map(<[_; 2]>::from)
    }

    /// Simulated time of the slots, s.
    pub fn simulated_s(&self) -> f64 {
        self.ideal.len() as f64 * self.slot_s
    }

    /// The profile as the scene's pads and controller have it.
    ///
    /// # Errors
    /// As [`LoopBench::run`].
    pub fn served(&self, profile: &Profile) -> Result<Arc<Profile>> {
        Ok(self.case(profile)?.profile)
    }

    fn case(&self, profile: &Profile) -> Result<Case> {
        let profile = inputs::windowed(profile.clone(), &self.scene)?;
        let mut case = Case::new(&self.scene, self.index, &profile, &[])
            .with_context(|| format!("{}: profile {}", self.scene.name, profile.name))?;
        case.slots = case.slots.min(self.slots);
        Ok(case)
    }

    fn is_controlled(&self) -> bool {
        self.scene.cases[self.index].control.is_some()
    }

    fn has_parts(&self) -> bool {
        self.scene.cases[self.index].parts() > 1
    }
}

/// Whether a core flags what it says of a slot.
pub fn is_flagged(row: &Row) -> bool {
    ["invalid", "clipped", "saturated"].iter().any(|flag| row.flags.contains(flag))
}

/// Whether the ideal core, which has the formats of `words`, is the same for two profiles.
pub fn is_same_loop(words: &Profile, one: &Profile, other: &Profile) -> bool {
    with_words(one, words) == with_words(other, words)
}

/// A profile with the formats of another, where both have a controller.
fn with_words(profile: &Profile, words: &Profile) -> Profile {
    let of = |own: &Control| {
        let Control { drive, target, gain, .. } = words.control.clone().unwrap_or(own.clone());
        Control { drive, target, gain, ..own.clone() }
    };
    Profile {
        formats: words.formats.clone(),
        // The code that stands for one, in the oscillator's words.
        carrier: Carrier { amplitude: words.carrier.amplitude, ..profile.carrier.clone() },
        control: profile.control.as_ref().map(of),
        ..profile.clone()
    }
}

fn rows(case: &Case, fidelity: Fidelity) -> Result<Vec<Row>> {
    Ok(case.run(&Settings { fidelity, errors: false }, None, &|| ())?.rows)
}

/// What a quantity of rows is off, where both are known.
fn off(
    rows: &[Row],
    of: impl Fn(&Row) -> Option<f64>,
    should: impl Iterator<Item = Option<f64>>,
    unit: f64,
) -> Error {
    let mut sum = Sum::default();
    for (is, should) in rows.iter().map(of).zip(should).filter_map(|(is, should)| is.zip(should)) {
        let off = unit * (is - should);
        sum.add(off, off * off, off.abs());
    }
    sum.error()
}

fn true_n(row: &Row) -> Option<f64> {
    row.truth.map(|truth| truth.quantities.force_n)
}

fn direction(row: &Row) -> Option<f64> {
    Some(row.measured.direction)
}
