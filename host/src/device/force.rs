// SPDX-License-Identifier: MIT OR Apache-2.0
//! The force table in physical units, and as a core of a profile has it.
//!
//! ```text
//! k = force_k·(a(C) + b(C)·V_s + d(C)·(V_s − V_m)),   V_s and V_m first-order low-passes of the pad's rms voltage
//! α = 1 − e^(−T/τ),   T the time of a frame: of a slot of every pad
//! ```
//!
//! A core's voltages are square roots of its mean-square words: shares of full scale times √gain of
//! the window.

use hapticore_contract::calibration::ForceTable;
use hapticore_contract::profile::Profile;
use schemars::JsonSchema;
use serde::Deserialize;

use super::Scales;

/// The force table of a device: `[force]` of its calibration.
///
/// ```
/// use hapticore_host::device::Force;
///
/// let force: Force = toml::from_str(&format!(
///     "recent_s = 0.01\nmean_s = 1.5\nrelease_v = 2\nrows = [{}]", "[1, 2e-4, 0], ".repeat(11)
/// ))?;
/// assert_eq!(force.factor(500.0, 300.0, 300.0), 1.0 + 300.0 * 2e-4);
/// # Ok::<(), toml::de::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Force {
    /// Time constant of V_s, s; at 0 it is the voltage itself.
    pub recent_s: f64,
    /// Time constant of V_m, s.
    pub mean_s: f64,
    /// Voltage below which a pad counts as released, and its past is forgotten.
    pub release_v: f64,
    /// a, b (1/V) and d (1/V) for 320, 384 … 960 pF.
    pub rows: [[f64; 3]; ForceTable::ROWS],
}

/// The longest V_m is averaged over by default, s: the rubber's creep (docs/physics.md §3).
pub const MEAN_S: f64 = 1.5;
/// What V_s is averaged over by default, s.
pub const RECENT_S: f64 = 0.01;
/// Pads below this voltage are released by default, V.
pub const RELEASE_V: f64 = 2.0;

/// Eq. 8.
impl Default for Force {
    fn default() -> Self {
        let rows = [[1.0, 0.0, 0.0]; ForceTable::ROWS];
        Force { recent_s: RECENT_S, mean_s: MEAN_S, release_v: RELEASE_V, rows }
    }
}

impl Force {
    /// What `force_k` is multiplied by at a capacitance, pF, V_s and V_m.
    pub fn factor(&self, capacitance_pf: f64, recent_v: f64, mean_v: f64) -> f64 {
        let (row, share) = ForceTable::place(capacitance_pf);
        let at = |[a, b, d]: [f64; 3]| a + b * recent_v + d * (recent_v - mean_v);
        let below = at(self.rows[row]);
        below + share * (at(self.rows[row + 1]) - below)
    }

    /// The table for a core of the profile on a device of these scales.
    pub fn for_profile(&self, profile: &Profile, scales: &Scales) -> ForceTable {
        let frame_s = (profile.pads * profile.slot.samples()) as f64 / scales.sample_rate_hz;
        let share = |time_s: f64| -(-frame_s / time_s).exp_m1();
        let volts = scales.haptic_full_scale_v / profile.square_gain().sqrt();
        ForceTable {
            rows: self.rows.map(|[a, b, d]| [a, b * volts, d * volts]),
            recent: share(self.recent_s),
            mean: share(self.mean_s),
            release: self.release_v / volts,
        }
    }

    pub(super) fn check(&self) -> Result<(), String> {
        let times = [("recent_s", self.recent_s), ("release_v", self.release_v)];
        let above = |(key, value): (&str, f64)| {
            let message = format!("force.{key}: expected a number not below 0, got {value}");
            if value >= 0.0 && value.is_finite() { Ok(()) } else { Err(message) }
        };
        times.into_iter().try_for_each(above)?;
        if !(self.mean_s > 0.0 && self.mean_s.is_finite()) {
            return Err(format!("force.mean_s: expected a number above 0, got {}", self.mean_s));
        }
        match self.rows.iter().flatten().find(|number| !number.is_finite()) {
            Some(number) => Err(format!("force.rows: expected finite numbers, got {number}")),
            None => Ok(()),
        }
    }

    /// Its part of a calibration file.
    pub(super) fn text(&self) -> String {
        let rows: String = self.rows.iter().map(|row| format!("{row:?},\n")).collect();
        format!(
            "\n[force]\nrecent_s = {:?}\nmean_s = {:?}\nrelease_v = {:?}\n\
             rows = [ # a, b (1/V), d (1/V), every 64 pF from 320 pF on\n{rows}]\n",
            self.recent_s, self.mean_s, self.release_v
        )
    }
}
