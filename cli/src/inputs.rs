// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes and profiles, from bundled names or files.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, anyhow, ensure};
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_scene::{Scene, Timing, gallery};

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
    if looks_like_a_file(name) {
        return read(Path::new(name));
    }
    let bundled: Vec<_> = gallery::all().iter().map(|(name, _)| *name).collect();
    Err(anyhow!("expected a file or a scene among {}, got \"{name}\"", bundled.join(", ")))
}

/// The profile of a bundled name or a file.
///
/// # Errors
/// No such profile, or one that no core can have; the message names file, line or key.
pub fn profile(name: &str) -> Result<Profile> {
    match Profile::bundled(name) {
        Err(ProfileError::Unknown { .. }) if looks_like_a_file(name) => {
            let text = read(Path::new(name))?;
            hapticore_model::parse_profile(&text).map_err(|error| match error {
                ProfileError::Syntax(message) => anyhow!("{name}:{}", with_key(&text, &message)),
                other => anyhow!("{name}: {other}"),
            })
        }
        other => Ok(other?),
    }
}

fn looks_like_a_file(name: &str) -> bool {
    name.contains(['/', '\\', '.']) || Path::new(name).is_file()
}

/// A message `LINE: what` about a TOML text, with the key of the line.
pub fn with_key(text: &str, message: &str) -> String {
    let named = message.split_once(':').and_then(|(number, what)| {
        let line = text.lines().nth(number.parse::<usize>().ok()?.checked_sub(1)?)?;
        let key = line.split_once('=')?.0.trim();
        Some(format!("{number}: {key}:{what}"))
    });
    named.unwrap_or_else(|| message.to_string())
}

/// A file's text.
///
/// # Errors
/// It cannot be read, or is no text.
pub fn read(path: &Path) -> Result<String> {
    fs::read_to_string(path).with_context(|| path.display().to_string())
}

/// The profile of a core for a device whose terminals have these signs in the ratios.
///
/// The bundled profiles are for the paper's six terminals and take any other device's; a profile of a user's own keeps its signs.
/// More terminals than the profile's ADC can be read for in a sample take more clocks.
///
/// # Errors
/// A profile of a user's own for another number of terminals; a core that cannot be.
pub fn for_terminals(profile: &Profile, signs: &[Vec<i8>; 2]) -> Result<Profile> {
    let [x, y] = signs;
    let bundled = Profile::bundled(&profile.name).is_ok_and(|bundled| bundled.terminals == profile.terminals);
    let (own, device) = (profile.terminals.x.len(), x.len());
    ensure!(
        bundled || own == device,
        "profile {}: terminals.x: expected {device} signs, as many as the device has terminals, got {own}",
        profile.name
    );
    let mut profile = profile.clone();
    if bundled {
        (profile.terminals.x, profile.terminals.y) = (x.clone(), y.clone());
        profile.clocks_per_sample = profile.clocks_per_sample.max(hapticore_model::least_clocks_per_sample(&profile));
        hapticore_model::check(&profile).with_context(|| format!("profile {} for {device} terminals", profile.name))?;
    }
    Ok(profile)
}

/// The profile of a core that serves just these pads.
pub fn serving(profile: &Profile, pads: usize) -> Profile {
    Profile { pads: pads as u64, ..profile.clone() }
}

/// The profile with the window that a scene asks for.
///
/// # Errors
/// A window that the profile's core cannot have.
pub fn windowed(mut profile: Profile, scene: &Scene) -> Result<Profile> {
    if let Some(samples) = scene.window_samples {
        profile = profile.with_window(samples);
        hapticore_model::check(&profile).with_context(|| format!("{}: window_samples", scene.name))?;
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
