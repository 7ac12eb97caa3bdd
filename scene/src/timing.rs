// SPDX-License-Identifier: MIT OR Apache-2.0
//! How the core divides its time and reads positions: what a plant has to know of it.

/// How the core divides its time and reads positions, from its profile.
#[derive(Clone, Debug, PartialEq)]
pub struct Timing {
    /// Pads that the core can serve.
    pub pads: usize,
    /// ADC samples of a slot.
    pub slot_samples: usize,
    /// First sample of the integration window within the slot.
    pub window_start: usize,
    /// Samples of the integration window.
    pub window_samples: usize,
    /// ADC samples per carrier period.
    pub samples_per_period: f64,
    /// Sign of each terminal's current in the ratios r_x and r_y, as [`Truth`](crate::Truth) tells
    /// them; by the terminals' places ([`signs_by_place`](crate::signs_by_place)) where there are
    /// none.
    pub signs: Option<[Vec<i8>; 2]>,
}

impl Timing {
    /// Whether there is a window, within the slot, and the carrier is sampled at all.
    pub(crate) fn check(&self) -> Result<(), String> {
        let window_end = self.window_start + self.window_samples;
        let periods = self.samples_per_period;
        let sound = self.window_samples > 0
            && window_end <= self.slot_samples
            && periods.is_finite()
            && periods > 2.0;
        if sound {
            Ok(())
        } else {
            Err(format!(
                "expected a window within the slot and over 2 samples a period, got {self:?}"
            ))
        }
    }
}
