// SPDX-License-Identifier: MIT OR Apache-2.0
//! A force controller's tuning as a file, `tuning.toml`: `simulate` writes that of its scene, `codes` reads it.
//!
//! Drives are fractions of the drive's full scale, forces newtons, places millimetres. The controller sees the haptic voltage as
//! the frame's word MEAN_SQUARE; `full_drive` is one over that word at full drive (docs/formats.md, "A force loop's words").

use std::path::Path;

use anyhow::{Context, Result, ensure};
use hapticore_contract::control::{Control, Law, Tuning, Walls};
use hapticore_contract::profile::Profile;
use hapticore_hdl::format::Format;
use hapticore_host::text::read;
use hapticore_host::{DriveWord, Setting};
use serde::{Deserialize, Serialize};

/// The name under which a run writes it.
pub const NAME: &str = "tuning.toml";

/// What its first line begins with.
pub const MARK: &str = "# Tuning of the force controller";

/// What stands in the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TuningFile {
    /// One over MEAN_SQUARE at full drive.
    pub full_drive: f64,
    /// Gain of the error: drive per N (proportional) or per √N of the largest target (integral).
    pub proportional: f64,
    /// Filter of the proportional law, integral gain per frame, or step of the inverse law's trim, 0 for none.
    pub correction: f64,
    /// Largest drive.
    pub rail: f64,
    /// Largest change of a drive from frame to frame.
    pub slew: f64,
    /// A larger force is a fault, N.
    pub force_cap_n: f64,
    /// Drives at the square roots of forces from zero to the largest target, evenly spaced.
    pub curve: Vec<f64>,
    /// Target of each pad, N; zero where none is named.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub target_n: Vec<f64>,
    /// The walls, of a profile with walls.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub walls: Option<WallsFile>,
}

/// The table `[walls]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WallsFile {
    /// Stiffness, N/mm.
    pub stiffness_n_per_mm: f64,
    /// Largest force, N.
    pub most_n: f64,
    /// What the direction of a wall on the left reads without a push.
    pub factory: f64,
    /// The insides of the walls are right of their surfaces.
    pub right: bool,
    /// Surface of each pad's wall, mm; zero where none is named.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub surface_mm: Vec<f64>,
}

impl TuningFile {
    /// The file of a tuning, all targets zero.
    pub fn of(tuning: &Tuning) -> Self {
        let walls = tuning.walls.as_ref().map(|walls| WallsFile {
            stiffness_n_per_mm: walls.stiffness_n_per_mm,
            most_n: walls.most_n,
            factory: walls.factory,
            right: walls.right,
            surface_mm: Vec::new(),
        });
        TuningFile {
            full_drive: tuning.full_drive,
            proportional: tuning.proportional,
            correction: tuning.correction,
            rail: tuning.rail,
            slew: tuning.slew,
            force_cap_n: tuning.force_cap,
            curve: tuning.curve.clone(),
            target_n: Vec::new(),
            walls,
        }
    }

    /// A tuning that drives nothing: all words as after a reset.
    pub fn at_reset(profile: &Profile, control: &Control) -> Self {
        let tuning = Tuning { rail: 0.0, slew: 0.0, full_drive: 0.0, ..Tuning::idle(control) };
        let walls = profile.wall.map(|_| WallsFile {
            stiffness_n_per_mm: 0.0,
            most_n: 0.0,
            factory: 0.0,
            right: false,
            surface_mm: Vec::new(),
        });
        TuningFile { walls, force_cap_n: 0.0, ..TuningFile::of(&tuning) }
    }

    /// Reads the file of a controller of the profile.
    ///
    /// # Errors
    /// No such file, a key that is none, a number that its word does not hold.
    pub fn read(path: &Path, profile: &Profile) -> Result<Self> {
        TuningFile::parse(&read(path)?, &path.display().to_string(), profile)
    }

    /// Reads the text of a file of this name.
    ///
    /// # Errors
    /// As [`TuningFile::read`].
    pub fn parse(text: &str, file: &str, profile: &Profile) -> Result<Self> {
        let tuning: TuningFile = toml::from_str(text).with_context(|| file.to_string())?;
        tuning.check(profile).with_context(|| file.to_string())?;
        Ok(tuning)
    }

    /// The text of the file, `of` saying what it tunes.
    ///
    /// # Errors
    /// None that is known: all numbers are TOML's.
    pub fn text(&self, of: &str) -> Result<String> {
        Ok(format!("{MARK}: {of}.\n{}", toml::to_string(self)?))
    }

    /// The tuning.
    pub fn tuning(&self) -> Tuning {
        let walls = self.walls.as_ref().map(|walls| Walls {
            stiffness_n_per_mm: walls.stiffness_n_per_mm,
            most_n: walls.most_n,
            factory: walls.factory,
            right: walls.right,
        });
        Tuning {
            curve: self.curve.clone(),
            full_drive: self.full_drive,
            proportional: self.proportional,
            correction: self.correction,
            rail: self.rail,
            slew: self.slew,
            force_cap: self.force_cap_n,
            walls,
        }
    }

    /// A pad's target, N.
    pub fn target(&self, pad: usize) -> f64 {
        self.target_n.get(pad).copied().unwrap_or_default()
    }

    /// The surface of a pad's wall, mm.
    pub fn surface(&self, pad: usize) -> f64 {
        let surfaces = self.walls.iter().flat_map(|walls| walls.surface_mm.get(pad));
        surfaces.copied().next().unwrap_or_default()
    }

    fn check(&self, profile: &Profile) -> Result<()> {
        let control = profile.control.as_ref();
        let control = control.with_context(|| {
            format!("expected a profile with [control], {} has none", profile.name)
        })?;
        let (got, words) = (self.curve.len(), control.cells + 1);
        ensure!(
            got as u64 == words,
            "curve: expected {words} numbers (control.cells + 1), got {got}"
        );
        let walled = profile.wall.is_some();
        let expected = if walled { "a table" } else { "none, for the profile has no walls" };
        ensure!(self.walls.is_some() == walled, "walls: expected {expected}");
        let word = |word: DriveWord| word.format(profile).expect("a profile with [control]");
        let set = |setting: Setting| word(DriveWord::Setting(setting));
        holds("full_drive", set(Setting::FullDrive), self.full_drive)?;
        holds("proportional", set(Setting::Proportional), self.proportional)?;
        holds("correction", set(Setting::Correction), self.correction)?;
        // Tunings of 0.1.0 have 1 here, which no inverse law read.
        ensure!(
            control.law != Law::Inverse || self.correction <= Control::MOST_TRIM_STEP,
            "correction: expected at most {} with law = \"inverse\", whose trim it is since version 0.1.0, got {}; 0 is the \
             law without a trim",
            Control::MOST_TRIM_STEP,
            self.correction
        );
        holds("rail", set(Setting::Rail), self.rail)?;
        holds("slew", set(Setting::Slew), self.slew)?;
        // A cap beyond the largest force that the word holds is one at that force.
        let format = set(Setting::ForceCap);
        let largest_n = format.real(format.max_code() as i64);
        let cap_n = if self.force_cap_n > largest_n { largest_n } else { self.force_cap_n };
        holds("force_cap_n", format, cap_n)?;
        each("curve", word(DriveWord::Curve(0)), &self.curve, self.curve.len())?;
        let pads = profile.pads as usize;
        each("target_n", word(DriveWord::Target(0)), &self.target_n, pads)?;
        let Some(walls) = &self.walls else { return Ok(()) };
        holds("walls.stiffness_n_per_mm", set(Setting::Stiffness), walls.stiffness_n_per_mm)?;
        holds("walls.most_n", set(Setting::Most), walls.most_n)?;
        holds("walls.factory", set(Setting::Factory), walls.factory)?;
        let surface = word(DriveWord::Surface { pad: 0, right: false });
        each("walls.surface_mm", surface, &walls.surface_mm, pads)
    }
}

fn each(key: &str, format: Format, numbers: &[f64], most: usize) -> Result<()> {
    let got = numbers.len();
    ensure!(got <= most, "{key}: expected at most {most} numbers, one per pad, got {got}");
    numbers
        .iter()
        .enumerate()
        .try_for_each(|(n, &number)| holds(&format!("{key}[{n}]"), format, number))
}

/// Holds that a number's word represents it; full scale, one step beyond the word, is held at it.
fn holds(key: &str, format: Format, number: f64) -> Result<()> {
    let (least, most) =
        (format.real(format.min_code() as i64), format.real(format.max_code() as i64));
    let held = number >= least && number <= most + format.lsb();
    ensure!(held, "{key}: expected {least} to {most} ({format}), got {number}");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn profile() -> Profile {
        let profile = Profile::bundled("fast").expect("bundled");
        Profile { control: Some(Control::of(&profile, Law::Inverse)), ..profile }
    }

    fn message(change: impl Fn(&mut TuningFile)) -> String {
        let profile = profile();
        let control = profile.control.clone().expect("a controller");
        let mut file = TuningFile::of(&Tuning::idle(&control));
        change(&mut file);
        file.check(&profile).err().map(|error| error.to_string()).unwrap_or_default()
    }

    #[test]
    fn a_written_file_reads_as_it_was() {
        let control = profile().control.expect("a controller");
        let file = TuningFile {
            rail: 0.25,
            target_n: vec![0.1],
            ..TuningFile::of(&Tuning::idle(&control))
        };
        let text = file.text("a test").expect("TOML");
        assert_eq!(toml::from_str::<TuningFile>(&text).expect("TOML"), file, "{text}");
        assert_eq!(file.tuning().force_cap, f64::INFINITY);
    }

    #[test]
    fn a_tuning_from_before_the_trim_is_refused_with_the_cure() {
        let old = message(|file| file.correction = 1.0);
        assert!(
            old.starts_with("correction: expected at most 0.25") && old.contains("0 is the law"),
            "{old}"
        );
        assert_eq!(message(|file| file.correction = 0.25), "");
    }

    #[test]
    fn numbers_that_no_word_holds_are_refused_by_name() {
        assert_eq!(message(|_| ()), "");
        assert!(message(|file| file.rail = -0.1).starts_with("rail: expected 0 to "));
        assert!(message(|file| file.slew = f64::NAN).contains("slew"));
        assert!(message(|file| file.full_drive = 1e9).contains("full_drive"));
        assert!(
            message(|file| {
                file.curve.pop();
            })
            .contains("curve: expected 65 numbers")
        );
        assert!(message(|file| file.curve[3] = 2.0).starts_with("curve[3]: "));
        assert!(message(|file| file.target_n = vec![0.1; 17]).contains("at most"));
        let unknown = toml::from_str::<TuningFile>("rial = 1").unwrap_err().to_string();
        assert!(unknown.contains("rial"), "{unknown}");
    }
}
