// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is known of a device before anything is measured: TOML.
//!
//! ```toml
//! pads = 2
//! sample_rate_hz = 1000000.0      # of the ADC
//! carrier_hz = 101000.0
//! current_full_scale_a = 0.004    # peak, at the end of the ADC's range, as the next two
//! sense_full_scale_v = 8.0
//! haptic_full_scale_v = 600.0
//! mu = 0.12                       # of friction, where it is known and loads.csv has friction_n
//! gravity_m_s2 = 9.80665
//! force_k = 9.6e12                # N/(F·V)², where no loads are measured
//! [terminals]                     # signs in the ratios, and where they are, mm from the sheet's middle: either will do
//! x = [-1, -1, 1, 1]
//! y = [1, -1, -1, 1]
//! places_mm = [[-150, 100], [-150, -100], [150, -100], [150, 100]]
//! [sheet]                         # with the terminals' places: what swapped terminals are found by
//! width_mm = 300
//! height_mm = 200
//! pad_diameter_mm = 30
//! ohm_per_square = 150
//! terminal_ohm = 0
//! ```

use anyhow::{Context, Result, anyhow, ensure};
use hapticore_contract::profile::Profile;
use hapticore_scene::signs_by_place;
use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use hapticore_host::Signs;
use hapticore_host::text::with_key;

/// What is known of a device before anything is measured.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Setup {
    /// Number of pads, selected in turn.
    #[schemars(range(min = 1, max = 256))]
    pub pads: u64,
    /// ADC samples per second.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub sample_rate_hz: f64,
    /// Frequency of the sensing carrier, Hz.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub carrier_hz: f64,
    /// Current at full scale, peak.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub current_full_scale_a: f64,
    /// Sensing voltage at full scale, peak.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub sense_full_scale_v: f64,
    /// Haptic voltage at full scale, peak.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub haptic_full_scale_v: f64,
    /// The coefficient of friction, where it is known.
    pub mu: Option<f64>,
    /// What a kilogram of load weighs, N.
    #[serde(default = "standard_gravity")]
    pub gravity_m_s2: f64,
    /// k of eq. 8, where no loads are measured.
    pub force_k: Option<f64>,
    /// Signs or positions of the terminals.
    #[serde(default)]
    pub terminals: Terminals,
    /// The sheet, where its size is known.
    pub sheet: Option<Sheet>,
}

/// What a text of TOML holds, called `file` in messages.
///
/// # Errors
/// It does not; the message names file, line and key.
pub fn parsed<T: DeserializeOwned>(text: &str, file: &str) -> Result<T> {
    toml::from_str(text).map_err(|error| {
        let line = error.span().map_or(1, |span| text[..span.start].matches('\n').count() + 1);
        anyhow!("{file}:{}", with_key(text, &format!("{line}: {}", error.message())))
    })
}

fn standard_gravity() -> f64 {
    9.80665
}

/// Signs or places of the terminals.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Terminals {
    /// Signs in r_x.
    pub x: Option<Vec<i8>>,
    /// Signs in r_y.
    pub y: Option<Vec<i8>>,
    /// Places, mm from the sheet's middle.
    pub places_mm: Option<Vec<[f64; 2]>>,
}

/// A uniform sheet.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sheet {
    /// Size of the sheet along x, mm.
    pub width_mm: f64,
    /// Size of the sheet along y, mm.
    pub height_mm: f64,
    /// Diameter of a pad, mm.
    #[serde(default = "pad_diameter_mm")]
    pub pad_diameter_mm: f64,
    /// Of the film, where it is known.
    pub ohm_per_square: Option<f64>,
    /// In series with each terminal.
    #[serde(default)]
    pub terminal_ohm: f64,
}

fn pad_diameter_mm() -> f64 {
    30.0
}

impl Setup {
    /// The setup that a text is, called `file` in messages.
    ///
    /// # Errors
    /// It is none; the message names file, line and key.
    pub fn parse(text: &str, file: &str) -> Result<Setup> {
        let setup: Setup = parsed(text, file)?;
        setup.check().with_context(|| file.to_string())?;
        Ok(setup)
    }

    fn check(&self) -> Result<()> {
        ensure!((1..=256).contains(&self.pads), "pads: expected 1 to 256, got {}", self.pads);
        let mut numbers = vec![
            ("sample_rate_hz", self.sample_rate_hz),
            ("carrier_hz", self.carrier_hz),
            ("current_full_scale_a", self.current_full_scale_a),
            ("sense_full_scale_v", self.sense_full_scale_v),
            ("haptic_full_scale_v", self.haptic_full_scale_v),
            ("gravity_m_s2", self.gravity_m_s2),
        ];
        numbers.extend(
            [("mu", self.mu), ("force_k", self.force_k)]
                .iter()
                .filter_map(|(key, x)| Some((*key, (*x)?))),
        );
        if let Some(sheet) = &self.sheet {
            numbers
                .extend([("sheet.width_mm", sheet.width_mm), ("sheet.height_mm", sheet.height_mm)]);
            numbers.push(("sheet.pad_diameter_mm", sheet.pad_diameter_mm));
        }
        let bad = numbers.into_iter().find(|(_, value)| !(value.is_finite() && *value > 0.0));
        bad.map_or(Ok(()), |(key, value)| {
            Err(anyhow!("{key}: expected a number above 0, got {value}"))
        })
    }

    /// The signs of `terminals` terminals in the ratios.
    ///
    /// # Errors
    /// The setup has neither signs nor places for this number; the message names the key.
    pub fn signs(&self, terminals: usize) -> Result<Signs> {
        let Terminals { x, y, places_mm } = &self.terminals;
        let count = |key: &str, got: usize| {
            ensure!(
                got == terminals,
                "terminals.{key}: expected {terminals}, as the places have currents, got {got}"
            );
            Ok(())
        };
        places_mm.as_ref().map_or(Ok(()), |places| count("places_mm", places.len()))?;
        match (x, y, places_mm, &self.sheet) {
            (Some(x), Some(y), ..) => {
                count("x", x.len()).and_then(|()| count("y", y.len()))?;
                Ok(Signs { x: x.clone(), y: y.clone() })
            }
            (None, None, Some(places), Some(sheet)) => {
                let [x, y] = signs_by_place(places, [sheet.width_mm, sheet.height_mm]);
                Ok(Signs { x, y })
            }
            (None, None, None, _) if terminals == 6 => {
                let usual = Profile::bundled("standard")?.terminals;
                Ok(Signs { x: usual.x, y: usual.y })
            }
            _ => Err(anyhow!(
                "terminals: expected x and y, signs of {terminals} terminals, or places_mm and [sheet]"
            )),
        }
    }
}
