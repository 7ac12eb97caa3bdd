// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sets up what a page watches and leads: a bundled scene, or the file of the command line.

use std::sync::Arc;

use anyhow::{Context, Result, bail};
use hapticore_host::profile::looks_like_a_file;
use hapticore_run::engine::Fidelity;
use hapticore_run::inputs;
use hapticore_run::session::Options;
use hapticore_run::stepper::Stepper;
use hapticore_scene::{Scene, gallery};

use crate::protocol::Opening;
use crate::simulated::Simulated;
use crate::source::Source;

/// Sets up sources.
pub struct Setup {
    /// What the server was started with: a file that a client may open again; none where no scene can be opened.
    first: Option<Opening>,
}

impl Setup {
    /// For a server that is started with a scene.
    pub fn new(first: &Opening) -> Setup {
        Setup { first: Some(first.clone()) }
    }

    /// For a server of one source, which no client replaces.
    pub fn fixed() -> Setup {
        Setup { first: None }
    }

    /// A client's opening with what it leaves open. A client reads no files but those of the command line: it may be a
    /// page that somebody has sent.
    ///
    /// # Errors
    /// A scene or a profile that is none of the bundled ones.
    pub fn allowed(&self, opening: Opening, current: &Opening) -> Result<Opening, String> {
        let Some(first) = &self.first else {
            return Err("open: expected a page of scenes, this one shows a board".into());
        };
        let names: Vec<&str> = gallery::all().iter().map(|(name, _)| *name).collect();
        if opening.scene != first.scene && !names.contains(&opening.scene.as_str()) {
            let cited: String = opening.scene.chars().take(40).collect();
            return Err(format!("scene: expected one of {}, got {cited:?}", names.join(", ")));
        }
        let of_set = opening.set.iter().filter(|(key, _)| key == "profile").map(|(_, value)| value);
        let profiles = opening.profile.iter().chain(of_set);
        let known = |name: &&String| {
            Some(*name) == first.profile.as_ref()
                || !looks_like_a_file(name.trim_matches(['"', '\'']))
        };
        if profiles.clone().any(|name| !known(&name)) {
            return Err("profile: expected small, standard, fine or fast".into());
        }
        let core = opening.core.clone().or(current.core.clone());
        Ok(Opening { core, ..opening })
    }

    /// A source at its first slot.
    ///
    /// # Errors
    /// A scene that cannot be run; the message names file, line and key.
    pub fn source(&self, opening: &Opening) -> Result<Box<dyn Source>, String> {
        simulated(opening).map(|source| Box::new(source) as _).map_err(|error| format!("{error:#}"))
    }
}

/// A scene that is simulated.
///
/// # Errors
/// A scene that cannot be run, no such case.
pub fn simulated(opening: &Opening) -> Result<Simulated> {
    let scene = inputs::scene(&opening.scene, &opening.set)?;
    let profile = inputs::profile(opening.profile.as_ref().unwrap_or(&scene.profile))?;
    let index = case_index(&scene, opening.case.as_deref())?;
    let fidelity = fidelity(opening.core.as_deref())?;
    let options = Options { fidelity, errors: false, reference: false };
    let stepper = Stepper::new(Arc::new(scene), index, &profile, options)
        .with_context(|| opening.scene.clone())?;
    Simulated::new(opening.clone(), fidelity, stepper)
}

/// The number of a case by its name or number.
fn case_index(scene: &Scene, case: Option<&str>) -> Result<usize> {
    let Some(case) = case else { return Ok(0) };
    let by_name = scene.cases.iter().position(|of| of.name == case);
    let by_number = || case.parse().ok().filter(|index| *index < scene.cases.len());
    by_name.or_else(by_number).with_context(|| {
        let names: Vec<&str> = scene.cases.iter().map(|case| case.name.as_str()).collect();
        format!(
            "case: expected a number below {} or one of {}, got {case:?}",
            names.len(),
            names.join(", ")
        )
    })
}

fn fidelity(name: Option<&str>) -> Result<Fidelity> {
    let all = [Fidelity::Float, Fidelity::Fixed, Fidelity::Clock];
    match name {
        None => Ok(Fidelity::Fixed),
        Some(name) => match all.into_iter().find(|fidelity| fidelity.name() == name) {
            Some(fidelity) => Ok(fidelity),
            None => bail!("core: expected float, fixed or clock, got {name:?}"),
        },
    }
}
