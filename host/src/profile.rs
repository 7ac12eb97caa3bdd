// SPDX-License-Identifier: MIT OR Apache-2.0
//! The profile of a board: a bundled one or a file's, with the terminals and pads of a device.
//!
//! Values are checked against their ranges. Whether a core can be built of them is the concern of
//! its builder.

use crate::text::{ReadError, read, with_key};
use hapticore_contract::profile::{Profile, ProfileError};
use std::path::Path;

/// Why a profile cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum LoadProfileError {
    /// Its file cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// Its file is none; the message names file, line or key.
    #[error("{0}")]
    Invalid(String),
    /// No such bundled profile.
    #[error(transparent)]
    Profile(ProfileError),
}

/// The profile of a bundled name or a file.
///
/// # Errors
/// No such profile, or a value that is out of its range; the message names file, line or key.
///
/// ```
/// let small = hapticore_host::profile::load("small")?;
/// assert_eq!((small.pads, small.channels()), (4, 8));
/// assert!(hapticore_host::profile::load("no-such.toml").is_err());
/// # Ok::<(), hapticore_host::LoadProfileError>(())
/// ```
pub fn load(name: &str) -> Result<Profile, LoadProfileError> {
    match Profile::bundled(name) {
        Err(ProfileError::Unknown { .. }) if looks_like_a_file(name) => {
            let text = read(Path::new(name))?;
            Profile::parse(&text).map_err(|error| {
                LoadProfileError::Invalid(match error {
                    ProfileError::Syntax(message) => {
                        format!("{name}:{}", with_key(&text, &message))
                    }
                    other => format!("{name}: {other}"),
                })
            })
        }
        other => other.map_err(LoadProfileError::Profile),
    }
}

/// Whether a name is rather a file's than a bundled one.
pub fn looks_like_a_file(name: &str) -> bool {
    name.contains(['/', '\\', '.']) || Path::new(name).is_file()
}

/// A device whose terminals no core of the profile can have.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TerminalsError {
    /// A profile of a user's own is for another number of them.
    #[error(
        "profile {profile}: terminals.x: expected {device} signs, as many as the device has terminals, got {own}"
    )]
    Count {
        /// The profile's name.
        profile: String,
        /// Terminals of the device.
        device: usize,
        /// Terminals of the profile.
        own: usize,
    },
    /// The profile with them cannot be.
    #[error("profile {profile} for {device} terminals")]
    Profile {
        /// The profile's name.
        profile: String,
        /// Terminals of the device.
        device: usize,
        /// Why the profile is invalid with this number of terminals.
        source: ProfileError,
    },
}

/// The profile of a core for a device whose terminals have these signs in the ratios r_x and r_y.
///
/// The bundled profiles are for the paper's six terminals and take any other device's; a profile of
/// a user's own keeps its signs. More terminals than the profile's ADC can be read for in a sample
/// take more clocks.
///
/// # Errors
/// A profile of a user's own for another number of terminals; signs that no profile can have.
///
/// ```
/// # use hapticore_host::{Profile, profile::for_terminals};
/// let standard = Profile::bundled("standard")?;
/// let four = for_terminals(&standard, &[vec![-1, -1, 1, 1], vec![1, -1, -1, 1]])?;
/// assert_eq!(four.channels(), 6, "four currents, the sensing and the haptic voltage");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn for_terminals(profile: &Profile, signs: &[Vec<i8>; 2]) -> Result<Profile, TerminalsError> {
    let [x, y] = signs;
    let bundled =
        Profile::bundled(&profile.name).is_ok_and(|bundled| bundled.terminals == profile.terminals);
    let (own, device) = (profile.terminals.x.len(), x.len());
    if !bundled && own != device {
        return Err(TerminalsError::Count { profile: profile.name.clone(), device, own });
    }
    let mut profile = profile.clone();
    if bundled {
        (profile.terminals.x, profile.terminals.y) = (x.clone(), y.clone());
        profile.clocks_per_sample =
            profile.clocks_per_sample.max(profile.least_clocks_per_sample());
        let name = profile.name.clone();
        profile.check_values().map_err(|source| TerminalsError::Profile {
            profile: name,
            device,
            source,
        })?;
    }
    Ok(profile)
}

/// The profile of a core that serves just these pads.
pub fn serving(profile: &Profile, pads: usize) -> Profile {
    Profile { pads: pads as u64, ..profile.clone() }
}
