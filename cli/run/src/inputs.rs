// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes and profiles, from bundled names or files.

use std::path::Path;

use crate::capture;
use anyhow::{Context, Result, anyhow};
use hapticore_contract::profile::{BUNDLED, Profile};
use hapticore_host::profile::{load, looks_like_a_file};
use hapticore_host::text::read;
use hapticore_scene::{Scene, Timing, did_you_mean, gallery};

/// The scene of a bundled name or a file, with keys set.
///
/// # Errors
/// No such scene, or one that cannot be run; the message names file, line and key.
pub fn scene(name: &str, set: &[(String, String)]) -> Result<Scene> {
    let (text, file) = match gallery::find(name) {
        Some(text) => (text.to_string(), format!("{name}.toml")),
        None => (scene_file(name)?, name.to_string()),
    };
    Ok(Scene::parse(&text, &file, set)?)
}

fn scene_file(name: &str) -> Result<String> {
    if capture::is_named_as_one(Path::new(name)) {
        return Err(anyhow!("{name}: expected a scene, got a capture: hapticore replay {name}"));
    }
    if looks_like_a_file(name) {
        return Ok(read(Path::new(name))?);
    }
    let bundled: Vec<_> = gallery::all().iter().map(|(name, _)| *name).collect();
    let (known, near) = (bundled.join(", "), did_you_mean(name, bundled));
    Err(anyhow!("expected a file or a scene among {known}, got \"{name}\"{near}"))
}

/// A name of no profile.
#[derive(Debug, thiserror::Error)]
#[error("{message}{near}")]
pub struct NoProfile {
    message: String,
    near: String,
}

/// The profile of a bundled name or a file.
///
/// # Errors
/// No such profile, or one that no core can have; the message names file, line or key.
pub fn profile(name: &str) -> Result<Profile> {
    let profile = match load(name) {
        Err(error) if !looks_like_a_file(name) => {
            let near = did_you_mean(name, BUNDLED.map(|(name, _)| name));
            return Err(NoProfile { message: error.to_string(), near }.into());
        }
        loaded => loaded?,
    };
    hapticore_model::check(&profile).with_context(|| name.to_string())?;
    Ok(profile)
}

/// A profile with the terminals of a device, if a core can be built of it.
///
/// # Errors
/// A core that cannot be.
pub fn buildable(profile: Profile) -> Result<Profile> {
    let what = || format!("profile {} for {} terminals", profile.name, profile.terminals.x.len());
    hapticore_model::check(&profile).with_context(what)?;
    Ok(profile)
}

/// The profile with the slot that a scene asks for.
///
/// # Errors
/// A window that the profile's core cannot have.
pub fn windowed(mut profile: Profile, scene: &Scene) -> Result<Profile> {
    let asked =
        [("window_samples", scene.window_samples), ("settle_samples", scene.settle_samples)];
    for (key, samples) in asked {
        let Some(samples) = samples else { continue };
        match key {
            "window_samples" => profile = profile.with_window(samples),
            _ => profile.slot.settle = samples,
        }
        hapticore_model::check(&profile).with_context(|| format!("{}: {key}", scene.name))?;
    }
    Ok(profile)
}

/// How a core of the profile divides its time.
pub fn timing(profile: &Profile) -> Timing {
    Timing {
        pads: profile.pads as usize,
        slot_samples: profile.slot.samples() as usize,
        window_start: profile.slot.blanking() as usize,
        window_samples: profile.slot.integrate as usize,
        samples_per_period: profile.samples_per_period(),
        signs: Some([profile.terminals.x.clone(), profile.terminals.y.clone()]),
    }
}
