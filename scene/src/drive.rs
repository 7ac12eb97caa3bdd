// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is done to a pad at any time: its stimuli as the scene has them.

use crate::device::Device;
use crate::effects::Pad;
use crate::pad::{PadPlan, pad_as_set};
use crate::stimulus::Moment;
use crate::truth::Setpoint;

/// What pulls and presses a pad.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pull {
    /// Haptic voltage at the source.
    pub source_v_rms: f64,
    pub load_g: f64,
}

/// What is done to a pad, at any time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PadDrive<'a> {
    pub index: usize,
    pub plan: &'a PadPlan,
    /// How long a point of a sweep lasts; infinite where nothing is swept.
    pub point_s: f64,
    pub device: &'a Device,
    /// By what share of itself the load is more for each millimetre of the push's eccentricity.
    pub lean_per_mm: f64,
}

impl PadDrive<'_> {
    /// What the pad is set to.
    pub fn set(&self, moment: Moment) -> Setpoint {
        self.plan.set(self.point(moment), moment)
    }

    /// What pulls and presses the pad, or its electrode.
    pub fn pull(&self, moment: Moment) -> Pull {
        let [load_g, haptic_v_rms, eccentricity_mm] =
            self.plan.set_of_gap(self.point(moment), moment);
        Pull {
            source_v_rms: haptic_v_rms,
            load_g: load_g * (1.0 + self.lean_per_mm * eccentricity_mm),
        }
    }

    /// The pad before any effect.
    pub fn pad(&self, moment: Moment) -> Pad {
        let push_n = self.plan.push_n(moment);
        pad_as_set(self.index, moment.time_s, &self.set(moment), push_n, self.device)
    }

    /// The same of an electrode that is loaded more where the push is off the centre.
    pub fn leaning(self, lean_per_mm: f64) -> Self {
        PadDrive { lean_per_mm, ..self }
    }

    /// When the voltage or what presses the pad next steps or turns.
    pub fn next_pull_event_s(&self, after_s: f64) -> f64 {
        let voltage_s = self.plan.next_voltage_event_s(after_s);
        voltage_s.min(self.plan.next_pressure_event_s(after_s, self.point_s))
    }

    /// When anything next steps or turns. A line that turns more often than every `least_s` is one
    /// that does not turn at all.
    pub fn next_event_s(&self, after_s: f64, least_s: f64) -> f64 {
        let motion_s = self.plan.next_motion_event_s(after_s, self.point_s, least_s);
        self.next_pull_event_s(after_s).min(motion_s)
    }

    /// The point of the sweep: the next one begins with its first slot.
    fn point(&self, moment: Moment) -> usize {
        const ROUNDING: f64 = 1e-9;
        if self.point_s.is_infinite() {
            return 0;
        }
        let points = moment.time_s / self.point_s;
        match moment.is_past(moment.time_s) {
            true => (points + ROUNDING).floor() as usize,
            false => ((points - ROUNDING).ceil() - 1.0).max(0.0) as usize,
        }
    }
}
