// SPDX-License-Identifier: MIT OR Apache-2.0
//! Device calibration: full scales, the force law, and a raster of places with what is measured
//! there.
//!
//! The file is TOML and holds nothing of a profile, so that one capture can be replayed with any:
//!
//! ```toml
//! pads = 1
//! parts = 1                        # 2 to 4 of them in a row are parts of one split pad
//! [terminals]                     # signs in the ratios; those of eqs. 2 and 3 where the table is left out
//! x = [-1, -1, 1, 1, 0, 0]
//! y = [1, -1, -1, 1, -1, 1]
//! [device]
//! sample_rate_hz = 1000000.0      # of the ADC while the capture was taken
//! carrier_hz = 100000.0
//! current_full_scale_a = 0.004    # at the end of the ADC's range, as the next two
//! sense_full_scale_v = 8.0
//! haptic_full_scale_v = 600.0
//! force_k = 9.6e12                # eq. 8, N/(F·V)²
//! pad_diameter_mm = 30.0          # pads that are nearer to each other touch; never told where it is left out
//! contact_pf = 95.0               # a pad (of a split one: a part) of at most this capacitance is lifted; 0: only one without any
//! [force]                         # of cores whose force.law is a table; k is force_k times a + b·V_s + d·(V_s − V_m)
//! recent_s = 0.01                 # V_s and V_m: low-passes of the pad's rms voltage
//! mean_s = 1.5
//! release_v = 2.0                 # below it a pad's past is forgotten
//! rows = [[a, b, d], …]           # 11: for 320, 384 … 960 pF; b and d per volt
//! [map]
//! columns = 121                   # places in a row
//! open_share = 0.01               # of the ratios' denominator: a terminal with less current is open; none ever where it is left out
//! places = [[x_mm, y_mm, r_x, r_y, sheet_ohm], …]
//! [shares]                        # of each terminal's current by place ([`Shares`]); without it the order of channels is not checked
//! error = 0.001                   # how well a place's shares follow from those about it
//! places = [[x_mm, y_mm, s_1, …], …]
//! ```

mod file;
mod force;
mod refine;
mod shares;

pub use file::DeviceError;
pub use force::{Force, MEAN_S, RECENT_S, RELEASE_V};
pub use shares::Shares;

use std::f64::consts::TAU;

use crate::profile::{TerminalsError, for_terminals, serving};
use crate::residual::Residual;
use hapticore_contract::calibration::{
    Calibration, CalibrationError, Point, PositionError, PositionTable,
};
use hapticore_contract::format::Format;
use hapticore_contract::profile::{ForceLaw, Profile};
use schemars::JsonSchema;
use serde::Deserialize;

/// The calibration of a device, as its file holds it: the same for every profile.
///
/// ```
/// use hapticore_host::{DeviceCalibration, Profile};
///
/// let device = DeviceCalibration::read("recordings/hockey.calibration.toml".as_ref())?;
/// let profile = device.profile(&Profile::bundled("standard")?)?;
/// let calibration = device.for_profile(&profile)?;
/// assert!(device.residual(&calibration).rms_mm < 0.5);
/// assert_eq!(calibration.capacitance_gain.round(), 796.0, "pF at 4 mA for 8 V");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DeviceCalibration {
    /// Number of pads, selected in turn.
    #[schemars(range(min = 1, max = 256))]
    pub pads: u64,
    /// Of them, this many in a row are parts of one pad.
    #[serde(default = "whole")]
    pub parts: u64,
    /// The signs of the terminals' currents in the ratios of `map`.
    #[serde(default)]
    pub terminals: Signs,
    /// Full scales and the force law.
    pub device: Scales,
    /// The force table, where the device has been calibrated for one.
    pub force: Option<Force>,
    /// Places and what is measured there.
    pub map: Raster,
    /// Each terminal's share of the current by place, where it is known.
    pub shares: Option<Shares>,
}

/// Pads that are not split.
fn whole() -> u64 {
    1
}

/// The signs of the terminals' currents in the numerators of both ratios.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Signs {
    /// Signs of the terminals in r_x: −1, 0 or 1.
    #[schemars(inner(range(min = -1, max = 1)))]
    pub x: Vec<i8>,
    /// Signs of the terminals in r_y: −1, 0 or 1.
    #[schemars(inner(range(min = -1, max = 1)))]
    pub y: Vec<i8>,
}

/// Those of eqs. 2 and 3, of which calibrations without signs are.
impl Default for Signs {
    fn default() -> Self {
        Signs { x: vec![-1, -1, 1, 1, 0, 0], y: vec![1, -1, -1, 1, 0, 0] }
    }
}

/// A place, mm, and where it was found.
pub type Found = ([f64; 2], [f64; 2]);

/// Full scales, frequencies and the force law.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scales {
    /// ADC samples per second.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub sample_rate_hz: f64,
    /// Frequency of the sensing carrier, Hz.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub carrier_hz: f64,
    /// Current at full scale.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub current_full_scale_a: f64,
    /// Sensing voltage at full scale.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub sense_full_scale_v: f64,
    /// Haptic voltage at full scale.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub haptic_full_scale_v: f64,
    /// k of eq. 8, N/(F·V)².
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub force_k: f64,
    /// Of a pad, where it is known.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub pad_diameter_mm: Option<f64>,
    /// A pad of at most this capacitance is lifted, pF; without it, a tenth of the capacitance whose current is at full scale.
    #[schemars(range(min = 0, max = 1e6))]
    pub contact_pf: Option<f64>,
}

/// Share of a resting pad's capacitance: with less the pad is lifted.
pub const CONTACT_SHARE: f64 = 0.3;

/// The largest `contact_pf`.
pub const MOST_CONTACT_PF: f64 = 1e6;

/// Share of the capacitance at full scale that takes the place of `contact_pf` where a calibration has none. A resting
/// pad whose current is less would use a tenth of the converter's range.
const CONTACT_SHARE_OF_FULL_SCALE: f64 = 0.1;

/// Places in whole rows: `[x_mm, y_mm, r_x, r_y, sheet_ohm]`.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Raster {
    /// Places in a row.
    pub columns: usize,
    /// A terminal whose current is a smaller share of the ratios' denominator counts as open.
    #[serde(default)]
    pub open_share: f64,
    /// The places.
    pub places: Vec<[f64; 5]>,
}

impl Raster {
    /// The ratios at a place, mm, within the raster; none beyond it.
    pub fn ratios_at(&self, at_mm: [f64; 2]) -> Option<[f64; 2]> {
        refine::at(self.columns, &self.places, at_mm).map(|[_, _, r_x, r_y, _]| [r_x, r_y])
    }
}

impl Scales {
    /// Ohms of one full scale of voltage per current.
    pub fn ohm(&self) -> f64 {
        self.sense_full_scale_v / self.current_full_scale_a
    }

    /// Picofarads at an admittance of one full scale of current per voltage.
    fn capacitance_gain(&self) -> f64 {
        self.current_full_scale_a / (TAU * self.carrier_hz * self.sense_full_scale_v) * 1e12
    }
}

/// A terminal whose share of the current is below this at every place is open.
pub const OPEN: f64 = 1e-4;

/// The share of the ratios' denominator below which a terminal counts as open: half of the least
/// that any has anywhere that is not open already. `shares` are those of each terminal, place by
/// place.
pub fn open_share<'a>(shares: impl Iterator<Item = &'a [f64]> + Clone) -> f64 {
    let of = |terminal: usize| shares.clone().map(move |place| place[terminal]);
    let terminals = 0..shares.clone().next().map_or(0, <[f64]>::len);
    let connected = terminals.filter(|&terminal| of(terminal).fold(0.0, f64::max) >= OPEN);
    connected.flat_map(of).fold(1.0, f64::min) / 2.0
}

/// Where the position table of a calibration finds places, `[x_mm, y_mm, r_x, r_y, sheet_ohm]`.
pub fn found(places: &[[f64; 5]], calibration: &Calibration) -> Vec<Found> {
    let found = |&[x, y, r_x, r_y, _]: &[f64; 5]| {
        let found = calibration.position.look_up(r_x, r_y);
        ([x, y], [found.x, found.y])
    };
    places.iter().map(found).collect()
}

/// Numbers that a core of a profile cannot be given.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DeviceWordsError {
    /// No position table fits the map.
    #[error("calibration map: {0}")]
    Map(PositionError),
    /// A number that its format cannot represent.
    #[error(transparent)]
    Number(#[from] CalibrationError),
    /// k of eq. 8 is beyond the core's force gain.
    #[error(
        "device.force_k: expected at most {most:.3e} N/(F·V)², which is what the core's force gain ({format}) holds at \
         haptic_full_scale_v = {full_scale_v}, got {force_k:.3e}; k is μ/(2ε₀S), so a larger pad or a smaller full scale does"
    )]
    ForceGain {
        /// k of the device.
        force_k: f64,
        /// The largest k.
        most: f64,
        /// The word's format.
        format: Format,
        /// The device's full scale.
        full_scale_v: f64,
    },
    /// The core's law is a table, and the device has none.
    #[error(
        "calibration force: expected [force], the table of a profile whose force.law is \"table\""
    )]
    NoForceTable,
}

impl DeviceCalibration {
    /// The capacitance at or below which a pad counts as lifted, pF: `device.contact_pf`. A calibration without it has a tenth
    /// of the capacitance whose current is at full scale with the sensing voltage, shared by a pad's parts.
    ///
    /// ```
    /// # use hapticore_host::DeviceCalibration;
    /// let device = DeviceCalibration::read("recordings/hockey.calibration.toml".as_ref())?;
    /// let earlier = hapticore_host::Scales { contact_pf: None, ..device.device.clone() };
    /// assert_eq!(DeviceCalibration { device: earlier, ..device }.contact_pf().round(), 80.0, "of 796 pF");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn contact_pf(&self) -> f64 {
        self.device.contact_pf.unwrap_or_else(|| {
            CONTACT_SHARE_OF_FULL_SCALE * self.device.capacitance_gain() / self.parts as f64
        })
    }

    /// What is left of the calibration's own places, looked up in the table that was fitted to
    /// them.
    pub fn residual(&self, calibration: &Calibration) -> Residual {
        Residual::of(found(&self.map.places, calibration).into_iter())
    }

    /// The profile of a core for the device: with its terminals, and serving its pads.
    ///
    /// # Errors
    /// As [`for_terminals`].
    pub fn profile(&self, profile: &Profile) -> Result<Profile, TerminalsError> {
        let signs = [self.terminals.x.clone(), self.terminals.y.clone()];
        Ok(serving(&for_terminals(profile, &signs)?, self.pads as usize))
    }

    /// The core's force gain.
    ///
    /// # Errors
    /// The profile's word does not hold it.
    pub fn force_gain(&self, profile: &Profile) -> Result<f64, DeviceWordsError> {
        let Scales { force_k, haptic_full_scale_v: full_scale_v, .. } = self.device;
        let gain = |k: f64| k * 1e-24 * full_scale_v.powi(2) / profile.square_gain();
        let format = profile.formats.force_gain;
        let most = format.real(format.code_saturating(f64::MAX)) / gain(1.0);
        if force_k > most {
            return Err(DeviceWordsError::ForceGain { force_k, most, format, full_scale_v });
        }
        Ok(gain(force_k))
    }

    /// The calibration for a core of the profile.
    ///
    /// # Errors
    /// A number that the profile's formats cannot represent, a map that no position table fits.
    pub fn for_profile(&self, profile: &Profile) -> Result<Calibration, DeviceWordsError> {
        let device = &self.device;
        let place = |[x, y, r_x, r_y, sheet_ohm]: [f64; 5]| Point {
            x,
            y,
            r_x,
            r_y,
            sheet: sheet_ohm / device.ohm(),
        };
        let (_, places) = refine::refine(self.map.columns, &self.map.places);
        let points: Vec<_> = places.into_iter().map(place).collect();
        let force_table = match (&self.force, profile.force.law) {
            (None, ForceLaw::Table) => return Err(DeviceWordsError::NoForceTable),
            (force, _) => force.clone().unwrap_or_default().for_profile(profile, device),
        };
        let table = PositionTable::fit(profile, &points).map_err(DeviceWordsError::Map)?;
        let calibration = Calibration {
            position: table.with_open_share(self.map.open_share),
            capacitance_gain: device.capacitance_gain(),
            force_gain: self.force_gain(profile)?,
            contact_capacitance: self.contact_pf(),
            force_table,
        };
        calibration.check(profile)?;
        Ok(calibration)
    }
}
