// SPDX-License-Identifier: MIT OR Apache-2.0
//! The words of a force controller, by the ports of the printed loop that take them.

use anyhow::{Context, Result};
use hapticore_contract::profile::Profile;
use hapticore_hdl::format::{BIT, Format};
use hapticore_host::{DriveWord, Setting};
use hapticore_run::tuning_file::TuningFile;

/// What `wall_right` says.
const RIGHT: &str = "one: the insides of walls are right of their surfaces";

/// A word that is stable at its port.
#[derive(Debug, Clone)]
pub struct Constant {
    /// Name of the port.
    pub name: &'static str,
    /// The word.
    pub code: i64,
    /// The word's format.
    pub format: Format,
    /// What it is, with its unit.
    pub about: &'static str,
}

/// Words that are written by address, one per cycle.
#[derive(Debug, Clone)]
pub struct Table {
    /// Name of the port of the word.
    pub name: &'static str,
    /// The words.
    pub codes: Vec<i64>,
    /// Their format.
    pub format: Format,
    /// What they are, with their unit.
    pub about: &'static str,
}

/// The words of a controller; none of a profile without one.
#[derive(Debug, Clone, Default)]
pub struct ControlWords {
    /// Settings of controller and walls.
    pub constants: Vec<Constant>,
    /// Curve, targets, surfaces.
    pub tables: Vec<Table>,
}

impl ControlWords {
    /// The formats of all words.
    pub fn formats(&self) -> impl Iterator<Item = Format> + '_ {
        let tables = self.tables.iter().map(|table| table.format);
        self.constants.iter().map(|constant| constant.format).chain(tables)
    }

    /// Number of words.
    pub fn count(&self) -> usize {
        self.constants.len() + self.tables.iter().map(|table| table.codes.len()).sum::<usize>()
    }
}

/// The words of a tuning for a profile's controller.
///
/// # Errors
/// A profile without one.
pub fn of(profile: &Profile, file: &TuningFile) -> Result<ControlWords> {
    let format = |word: DriveWord| {
        word.format(profile).with_context(|| format!("{}: expected [control]", profile.name))
    };
    let constant = |name, setting, value: f64, about| {
        let format = format(DriveWord::Setting(setting))?;
        anyhow::Ok(Constant { name, code: format.code_saturating(value), format, about })
    };
    let table = |name, word, values: &[f64], about| {
        let format = format(word)?;
        let codes = values.iter().map(|&value| format.code_saturating(value)).collect();
        anyhow::Ok(Table { name, codes, format, about })
    };
    let full_drive = "one over the frame's word MEAN_SQUARE at full drive";
    let mut constants = vec![
        constant("full_drive", Setting::FullDrive, file.full_drive, full_drive)?,
        constant(
            "proportional",
            Setting::Proportional,
            file.proportional,
            "drive per unit of the error",
        )?,
        constant(
            "correction",
            Setting::Correction,
            file.correction,
            "filter, or drive per unit and frame",
        )?,
        constant("rail", Setting::Rail, file.rail, "largest drive word, drive's full scale")?,
        constant("slew", Setting::Slew, file.slew, "largest change per frame, drive's full scale")?,
        constant("force_cap", Setting::ForceCap, file.force_cap_n, "a larger force is a fault, N")?,
    ];
    let pads = 0..profile.pads as usize;
    let targets: Vec<_> = pads.clone().map(|pad| file.target(pad)).collect();
    let mut tables = vec![
        table(
            "curve_word",
            DriveWord::Curve(0),
            &file.curve,
            "by curve_address, drive's full scale",
        )?,
        table("target_word", DriveWord::Target(0), &targets, "by target_pad, N")?,
    ];
    if let Some(walls) = &file.walls {
        let (stiffness, most) = (walls.stiffness_n_per_mm, walls.most_n);
        constants.extend([
            constant("wall_stiffness", Setting::Stiffness, stiffness, "stiffness, N/mm")?,
            constant("wall_most", Setting::Most, most, "largest force of a wall, N")?,
            constant("wall_factory", Setting::Factory, walls.factory, "direction without a push")?,
            Constant { name: "wall_right", code: walls.right.into(), format: BIT, about: RIGHT },
        ]);
        let surfaces: Vec<_> = pads.map(|pad| file.surface(pad)).collect();
        let word = DriveWord::Surface { pad: 0, right: walls.right };
        tables.push(table("wall_surface", word, &surfaces, "by wall_pad, mm")?);
    }
    Ok(ControlWords { constants, tables })
}
