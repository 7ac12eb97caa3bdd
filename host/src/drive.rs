// SPDX-License-Identifier: MIT OR Apache-2.0
//! Drive: the commands that tune a board's force controller, and move its targets and walls.
//!
//! ```text
//! startup: prepare, check ─ targets, surfaces ─ tune ─ ENABLE ─ targets and surfaces, often enough to be heard
//! ```
//!
//! A board drives nothing until its settings have come: after a reset its rail, its slew and its force cap are zero. Faults
//! come back in every packet ([`crate::Driven`]), and stay until [`clear_faults`].

use crate::command::Command;
use hapticore_contract::control::Tuning;
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_protocol::{DriveWord, Request, Setting};

/// A word's command on a board of the profile, its value saturated.
///
/// # Errors
/// A profile without a controller.
fn command(profile: &Profile, word: DriveWord, value: f64) -> Result<Command, ProfileError> {
    let format = word.format(profile);
    let format = format.ok_or_else(|| ProfileError::value("control", "a table", "none"))?;
    Ok(Command::Drive(word, format.code_saturating(value)))
}

/// The commands that tune a controller and its walls, clear its faults and switch it on. A reset, `DISABLE` too, takes targets
/// and surfaces: write them again, while the board is disabled or later.
///
/// ```
/// use hapticore_host::control::{Control, Law, Tuning};
/// use hapticore_host::{Profile, drive};
///
/// let profile = Profile::bundled("standard")?;
/// let control = Control::of(&profile, Law::Inverse);
/// let tuning = Tuning::idle(&control);
/// let profile = Profile { control: Some(control), ..profile };
/// let commands = drive::tune(&profile, &tuning)?;
/// assert_eq!(commands.len(), tuning.curve.len() + 6 + 2);
/// # Ok::<(), hapticore_host::ProfileError>(())
/// ```
///
/// # Errors
/// A profile without a controller.
pub fn tune(profile: &Profile, tuning: &Tuning) -> Result<Vec<Command>, ProfileError> {
    let curve = (0..).zip(&tuning.curve).map(|(number, &word)| (DriveWord::Curve(number), word));
    let set = |setting: Setting, value: f64| (DriveWord::Setting(setting), value);
    let walls = tuning.walls.iter().flat_map(|walls| {
        [
            set(Setting::Stiffness, walls.stiffness_n_per_mm),
            set(Setting::Most, walls.most_n),
            set(Setting::Factory, walls.factory),
        ]
    });
    let settings = [
        set(Setting::FullDrive, tuning.full_drive),
        set(Setting::Proportional, tuning.proportional),
        set(Setting::Correction, tuning.correction),
        set(Setting::Rail, tuning.rail),
        set(Setting::Slew, tuning.slew),
        set(Setting::ForceCap, tuning.force_cap),
    ];
    let on =
        [set(Setting::Request, f64::from(1 << Request::CLEAR_FAULTS)), set(Setting::Enable, 1.0)];
    let words = curve.chain(settings).chain(walls).chain(on);
    words.map(|(word, value)| command(profile, word, value)).collect()
}

/// The command that sets a pad's target force, N. It is a sign of life, too.
///
/// # Errors
/// A profile without a controller.
pub fn target(profile: &Profile, pad: u8, newtons: f64) -> Result<Command, ProfileError> {
    command(profile, DriveWord::Target(pad), newtons)
}

/// The command that sets where a pad's wall begins, mm, and whether its inside is right of that.
///
/// # Errors
/// A profile without a controller.
pub fn surface(
    profile: &Profile,
    pad: u8,
    surface_mm: f64,
    right: bool,
) -> Result<Command, ProfileError> {
    command(profile, DriveWord::Surface { pad, right }, surface_mm)
}

/// The command that clears the controller's faults.
pub const fn clear_faults() -> Command {
    Command::Drive(DriveWord::Setting(Setting::Request), 1 << Request::CLEAR_FAULTS)
}

/// The command that takes all drives to zero, each with its next word.
pub const fn rest() -> Command {
    Command::Drive(DriveWord::Setting(Setting::Enable), 0)
}
