// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[sensor]`: what the sensor chain adds between the currents and the ADC's codes. Each key
//! switches on one effect.
//!
//! | key | effect | realistic |
//! | --- | --- | --- |
//! | `haptic_leakage` | the haptic voltage's own current, eq. 1's second term | true |
//! | `haptic_leakage_of_others` | the same of the pads that the slot does not serve | true |
//! | `series_inductance_mh` | between where the sensing voltage is measured and the pad | 0.1 |
//! | `bandwidth_khz` | the current sensors' low-pass of first order | 300 to 3000 |
//! | `jitter_ns_rms` | a random time off at each sample | 0.1 |
//! | `crosstalk_percent` | of the neighbouring terminals' currents | 0.01 to 0.1 |
//! | `gain_error_percent` | all terminals' gain | 0.1 to 1 |
//! | `gain_mismatch_percent` | each terminal's gain, standard deviation | 0.1 to 1 |
//! | `noise_density_na_per_rthz` | noise of the current sensors: white, or behind `bandwidth_khz` | 0.1 to 1 |
//! | `offset_percent` | each channel's offset, of full scale, standard deviation | 0.01 |
//! | `noise_ppm_rms` | white noise per sample, millionths of full scale | 18 (AD7606C-16, 92 dB) |
//! | `dither_lsb_rms` | noise before the codes, in codes | 0.5 |
//! | `quantisation_bits` | codes of this many bits, half to even, clipped at full scale | 16, 18 |
//!
//! The full scales in the same table belong to the device and are always there.

pub(super) mod bandwidth;
pub(super) mod crosstalk;
pub(super) mod gain;
pub(super) mod inductance;
pub(super) mod jitter;
pub(super) mod leakage;
pub(super) mod noise;
pub(super) mod offset;
pub(super) mod others;
pub(super) mod quantisation;
pub(super) mod scale;

use crate::error::SceneError;
use crate::format::{Limits, Table};

/// A number of `[sensor]`, if both the table and the key are there and the effect has a size: one at zero is not built.
fn key(root: &Table, key: &'static str, limits: Limits) -> Result<Option<f64>, SceneError> {
    let Some(table) = root.table("sensor")? else { return Ok(None) };
    Ok(table.number(key, limits)?.filter(|number| *number != 0.0))
}
