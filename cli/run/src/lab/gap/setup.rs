// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pad and insulators, by their keys in a scene and with a scene's defaults.

use anyhow::{Result, ensure};
use serde::{Deserialize, Serialize};

use crate::lab::setup::parsed;

/// Pad and insulators, as a scene has them.
#[derive(Debug, Clone, Default, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Setup {
    pub device: Pad,
    pub gap: Insulators,
}

#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Pad {
    pub pad_diameter_mm: f64,
    pub gravity_m_s2: f64,
}

#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Insulators {
    pub insulator_um: f64,
    pub insulator_permittivity: f64,
}

impl Default for Pad {
    fn default() -> Self {
        Pad { pad_diameter_mm: 30.0, gravity_m_s2: 9.80665 }
    }
}

impl Default for Insulators {
    fn default() -> Self {
        Insulators { insulator_um: 16.0, insulator_permittivity: 3.2 }
    }
}

impl Setup {
    /// The setup that a text is, called `file` in messages.
    pub fn parse(text: &str, file: &str) -> Result<Setup> {
        let setup: Setup = parsed(text, file)?;
        for (key, number) in [
            ("device.pad_diameter_mm", setup.device.pad_diameter_mm),
            ("device.gravity_m_s2", setup.device.gravity_m_s2),
            ("gap.insulator_um", setup.gap.insulator_um),
            ("gap.insulator_permittivity", setup.gap.insulator_permittivity),
        ] {
            ensure!(
                (1e-6..1e6).contains(&number),
                "{file}: {key}: expected a number above 0, got {number}"
            );
        }
        Ok(setup)
    }

    /// S, m².
    pub fn area_m2(&self) -> f64 {
        std::f64::consts::PI * (0.5e-3 * self.device.pad_diameter_mm).powi(2)
    }

    /// d, m.
    pub fn insulator_m(&self) -> f64 {
        1e-6 * self.gap.insulator_um / self.gap.insulator_permittivity
    }
}
