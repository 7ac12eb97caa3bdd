// SPDX-License-Identifier: MIT OR Apache-2.0
//! The words that commands have written, as numbers for a core and its controller.

use hapticore_contract::calibration::Calibration;
use hapticore_contract::control::{Control, Surface, Tuning, Walls};
use hapticore_contract::profile::Profile;
use hapticore_host::{Constant, DriveWord, Setting, WordFormats};

/// Constants and position table.
#[derive(Debug, Clone)]
pub(super) struct SensorWords {
    pub constants: [i64; Constant::ALL.len()],
    pub table: Vec<i64>,
}

impl SensorWords {
    /// As after the configuration: zeros.
    pub fn new(words: usize) -> Self {
        SensorWords { constants: [0; Constant::ALL.len()], table: vec![0; words] }
    }

    /// The calibration that these words are; `like` has the layout of the table.
    pub fn calibration(&self, profile: &Profile, like: &Calibration) -> Calibration {
        let formats = WordFormats::new(profile);
        let constant =
            |of: Constant| formats.constants[of as usize].real(self.constants[of as usize]);
        let mut calibration = like.clone();
        let codes = self.table.iter().map(|code| formats.table.real(*code));
        calibration.position.words.iter_mut().zip(codes).for_each(|(word, code)| *word = code);
        calibration.capacitance_gain = constant(Constant::CapacitanceGain);
        calibration.force_gain = constant(Constant::ForceGain);
        calibration.contact_capacitance = constant(Constant::ContactCapacitance);
        calibration
    }
}

/// The words of a drive.
#[derive(Debug, Clone)]
pub(super) struct DriveWords {
    settings: [i64; Setting::ALL.len()],
    /// Those that have been written since the reset.
    curve: Vec<Option<i64>>,
    pub targets: Vec<i64>,
    pub surfaces: Vec<Option<(i64, bool)>>,
}

impl DriveWords {
    /// As after a reset: nothing is driven.
    pub fn new(control: &Control, pads: usize) -> Self {
        DriveWords {
            settings: [0; Setting::ALL.len()],
            curve: vec![None; control.cells as usize + 1],
            targets: vec![0; pads],
            surfaces: vec![None; pads],
        }
    }

    /// Takes a word; whether the controller has to be made anew for it.
    pub fn write(&mut self, word: DriveWord, code: i64) -> bool {
        match word {
            DriveWord::Setting(Setting::Request) => code & 1 != 0,
            DriveWord::Setting(setting) => {
                std::mem::replace(&mut self.settings[setting as usize], code) != code
            }
            DriveWord::Curve(number) => {
                let old = self.curve.get_mut(usize::from(number));
                old.is_some_and(|old| old.replace(code) != Some(code))
            }
            DriveWord::Target(pad) => {
                self.targets.get_mut(usize::from(pad)).into_iter().for_each(|of| *of = code);
                false
            }
            DriveWord::Surface { pad, right } => {
                let surface = self.surfaces.get_mut(usize::from(pad));
                surface.into_iter().for_each(|of| *of = Some((code, right)));
                false
            }
        }
    }

    /// `DISABLE` takes targets and surfaces; curve and settings outlive it.
    pub fn disable(&mut self) {
        self.targets.fill(0);
        self.surfaces.fill(None);
    }

    /// Whether drives follow their targets: the host has said so, and every word of the curve has come.
    pub fn drives(&self) -> bool {
        self.settings[Setting::Enable as usize] != 0 && self.curve.iter().all(Option::is_some)
    }

    /// The controller's tuning.
    pub fn tuning(&self, profile: &Profile, control: &Control) -> Tuning {
        let real = |setting: Setting| {
            let format = setting.format(profile);
            format.map_or(0.0, |format| format.real(self.settings[setting as usize]))
        };
        let curve = self.curve.iter().map(|word| control.drive.real(word.unwrap_or(0)));
        Tuning {
            curve: curve.collect(),
            full_drive: real(Setting::FullDrive),
            proportional: real(Setting::Proportional),
            correction: real(Setting::Correction),
            rail: real(Setting::Rail),
            slew: real(Setting::Slew),
            force_cap: real(Setting::ForceCap),
            walls: profile.wall.map(|_| Walls {
                stiffness_n_per_mm: real(Setting::Stiffness),
                most_n: real(Setting::Most),
                factory: real(Setting::Factory),
                right: false,
            }),
        }
    }

    /// A pad's target, N.
    pub fn target_n(&self, pad: usize, control: &Control) -> f64 {
        control.target.real(self.targets[pad])
    }

    /// A pad's surface, where it was written.
    pub fn surface(&self, pad: usize, profile: &Profile) -> Option<Surface> {
        let (code, right) = self.surfaces[pad]?;
        Some(Surface { mm: profile.formats.position.real(code), right })
    }
}
