// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[sensor]`: what the sensor chain adds between the currents and the ADC's codes. Each key
//! switches on one effect. The full scales in the same table belong to the device and are always there.

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
use crate::format::{Key, Limits, Table, keys};

keys! { KEYS:
    /// The haptic voltage's own current, eq. 1's second term.
    HAPTIC_LEAKAGE: bool = Key::flag("haptic_leakage");
    /// The same of the pads that the slot does not serve.
    HAPTIC_LEAKAGE_OF_OTHERS: bool = Key::flag("haptic_leakage_of_others");
    /// Inductance between where the sensing voltage is measured and the pad; 0.1 is realistic.
    SERIES_INDUCTANCE_MH: Option<f64> = Key::number("series_inductance_mh", Limits::within(0.0, 1e3));
    /// Low-pass of first order of the current sensors; 300 to 3000 is realistic.
    BANDWIDTH_KHZ: Option<f64> = Key::number("bandwidth_khz", Limits::within(1e-3, 1e6));
    /// A random time off at each sample; 0.1 is realistic.
    JITTER_NS_RMS: Option<f64> = Key::number("jitter_ns_rms", Limits::within(0.0, 1e3));
    /// Share of the neighbouring terminals' currents; 0.01 to 0.1 is realistic.
    CROSSTALK_PERCENT: Option<f64> = Key::number("crosstalk_percent", Limits::within(0.0, 50.0));
    /// Error of all terminals' gain; 0.1 to 1 is realistic.
    GAIN_ERROR_PERCENT: Option<f64> = Key::number("gain_error_percent", Limits::within(-50.0, 50.0));
    /// Error of each terminal's gain, standard deviation; 0.1 to 1 is realistic.
    GAIN_MISMATCH_PERCENT: Option<f64> = Key::number("gain_mismatch_percent", Limits::within(0.0, 50.0));
    /// Noise of the current sensors: white, or behind `bandwidth_khz`; 0.1 to 1 is realistic.
    NOISE_DENSITY: Option<f64> = Key::number("noise_density_na_per_rthz", Limits::within(0.0, 1e6));
    /// Offset of each channel, of full scale, standard deviation; 0.01 is realistic.
    OFFSET_PERCENT: Option<f64> = Key::number("offset_percent", Limits::within(0.0, 50.0));
    /// White noise per sample, millionths of full scale; an AD7606C-16 has 18, which is 92 dB.
    NOISE_PPM_RMS: Option<f64> = Key::number("noise_ppm_rms", Limits::within(0.0, 1e6));
    /// Noise before the codes, in codes; with `quantisation_bits`.
    DITHER_LSB_RMS: Option<f64> = Key::number("dither_lsb_rms", Limits::within(0.0, 1e3));
    /// Samples become codes of this many bits, half to even, clipped at full scale; an ADC has 16 or 18.
    QUANTISATION_BITS: Option<u64> = Key::whole("quantisation_bits", 2, 32);
}

/// A number of `[sensor]`, if both the table and the key are there and the effect has a size: one at zero is not built.
fn key(root: &Table, key: &Key<Option<f64>>) -> Result<Option<f64>, SceneError> {
    let Some(table) = root.table("sensor")? else { return Ok(None) };
    Ok(table.get(key)?.filter(|number| *number != 0.0))
}
