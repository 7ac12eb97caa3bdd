// SPDX-License-Identifier: MIT OR Apache-2.0
//! What no check of a recording can see, by the nature of a lock-in (docs/limits.md).
//!
//! The lock-in takes a tone within the window's main lobe about the carrier for current. The same
//! holds for a harmonic of the carrier that aliases onto the carrier: k·p ≡ ±p (mod N) for p
//! periods in N samples.

use hapticore_contract::profile::{Profile, Window};

/// The highest harmonic that is checked: those beyond have little amplitude.
const HIGHEST: u64 = 12;

/// Harmonics of the carrier, from the second on, that the core of a profile takes for the carrier.
pub fn harmonics(profile: &Profile) -> Vec<u64> {
    let (samples, periods) = (profile.slot.integrate, profile.carrier.periods);
    let aliases = |k: &u64| {
        let at = k * periods % samples;
        at == periods % samples || at == samples - periods % samples
    };
    (2..=HIGHEST).filter(aliases).collect()
}

/// Half of the width of the main lobe about the carrier, Hz.
pub fn half_band_hz(profile: &Profile, sample_rate_hz: f64) -> f64 {
    let bins = if profile.carrier.window == Window::Hann { 2.0 } else { 1.0 };
    bins * sample_rate_hz / profile.slot.integrate as f64
}

/// What a replay says of it.
pub fn text(profile: &Profile, sample_rate_hz: f64) -> String {
    let carrier_hz =
        sample_rate_hz * profile.carrier.periods as f64 / profile.slot.integrate as f64;
    let harmonics: Vec<String> = harmonics(profile).iter().map(u64::to_string).collect();
    let of_carrier = if harmonics.is_empty() {
        String::new()
    } else {
        format!(", harmonics {} of the carrier", harmonics.join(", "))
    };
    format!(
        "not seen by any check: tones within {:.0} Hz of {:.1} kHz{of_carrier}, disturbances of a single window, a mirrored sheet; docs/limits.md \
         says how far they put a frame off",
        half_band_hz(profile, sample_rate_hz),
        carrier_hz / 1e3
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_samples_a_period_take_four_harmonics_for_the_carrier() {
        let of = |name| harmonics(&Profile::bundled(name).expect("bundled"));
        assert_eq!(of("small"), [4, 6, 9, 11]);
        assert_eq!([of("standard"), of("fine"), of("fast")], [[0; 0]; 3].map(Vec::from));
    }
}
