// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is done to a pad at any time: its stimuli as the scene has them. In place of its haptic
//! voltage a controller or a recording may set one as time goes on, each value held until the next.

use std::collections::VecDeque;

use crate::device::Device;
use crate::effects::pad::Pad;
use crate::pad::{PadPlan, pad_as_set};
use crate::stimulus::Moment;
use crate::truth::Setpoint;

/// The highest voltage of a source, V rms, as scenes have it.
const MOST_V_RMS: f64 = 1e5;

/// A voltage that cannot be set.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DriveError {
    /// The plant has no such pad.
    #[error("expected a pad below {pads}, got {pad}")]
    NoPad {
        /// Which was asked for.
        pad: usize,
        /// Pads of the plant.
        pads: usize,
    },
    /// The plant has been seen at a later time, or the pad has a voltage set for one.
    #[error("expected a time of {earliest_s} s or later, got {time_s} s")]
    Past {
        /// When it should have been set.
        time_s: f64,
        /// The earliest time that is left.
        earliest_s: f64,
    },
    /// The voltage is negative, too high, or no number.
    #[error("expected 0 to 100000 V rms, got {0}")]
    Voltage(f64),
}

/// Voltages that are set as time goes on, each held until the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct HeldVoltage {
    /// Time and value, in the order of time; what a later one has replaced is forgotten.
    updates: VecDeque<[f64; 2]>,
}

impl HeldVoltage {
    /// From `time_s` on the voltage is `v_rms`; `now_s` is the time at which the plant was last
    /// seen.
    pub fn set(&mut self, time_s: f64, v_rms: f64, now_s: f64) -> Result<(), DriveError> {
        let earliest_s = self.updates.back().map_or(now_s, |[last_s, _]| last_s.max(now_s));
        if !(time_s >= earliest_s && time_s.is_finite()) {
            return Err(DriveError::Past { time_s, earliest_s });
        }
        if !(0.0..=MOST_V_RMS).contains(&v_rms) {
            return Err(DriveError::Voltage(v_rms));
        }
        if self.updates.back().is_some_and(|[last_s, _]| *last_s == time_s) {
            self.updates.pop_back();
        }
        // A value that is set again changes nothing, so that it is no event either.
        if self.updates.back().is_none_or(|[_, last_v]| *last_v != v_rms) {
            self.updates.push_back([time_s, v_rms]);
        }
        Ok(())
    }

    /// Forgets what cannot be asked for any more once the pad has been evaluated at a time.
    pub fn forget(&mut self, before_s: f64) {
        while self.updates.get(1).is_some_and(|[time_s, _]| *time_s <= before_s) {
            self.updates.pop_front();
        }
    }

    fn at(&self, moment: Moment) -> Option<f64> {
        let past = self.updates.partition_point(|[time_s, _]| moment.is_past(*time_s));
        Some(self.updates[past.checked_sub(1)?][1])
    }

    fn next_event_s(&self, after_s: f64) -> f64 {
        let next = self.updates.partition_point(|[time_s, _]| *time_s <= after_s);
        self.updates.get(next).map_or(f64::INFINITY, |[time_s, _]| *time_s)
    }
}

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
    /// What has been set in place of the scene's voltage.
    pub held: Option<&'a HeldVoltage>,
    pub device: &'a Device,
    /// What is done to one electrode of the pad in particular.
    pub electrode: Electrode,
}

/// What is done to one electrode of a split pad in particular; nothing of a pad that is whole.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Electrode {
    /// By what share of itself the load is more for each millimetre of the push's eccentricity along x
    /// and y.
    pub lean_per_mm: [f64; 2],
    /// What the push of the hand adds to the eccentricity, mm.
    pub tilt_mm: [f64; 2],
    /// The eccentricity at which the pad tips, mm.
    pub reach_mm: f64,
    /// The most that its source gives.
    pub most_v_rms: f64,
}

impl Electrode {
    /// The whole pad.
    pub const WHOLE: Electrode = Electrode {
        lean_per_mm: [0.0; 2],
        tilt_mm: [0.0; 2],
        reach_mm: f64::INFINITY,
        most_v_rms: f64::INFINITY,
    };

    /// What pulls and presses the electrode, of what does the pad.
    pub fn of_pad(&self, source_v_rms: f64, load_g: f64, eccentricity_mm: f64) -> Pull {
        let [x_mm, y_mm] = self.within_reach([eccentricity_mm + self.tilt_mm[0], self.tilt_mm[1]]);
        let [along_x, along_y] = self.lean_per_mm;
        Pull {
            source_v_rms: source_v_rms.min(self.most_v_rms),
            load_g: load_g * (1.0 + along_x * x_mm + along_y * y_mm),
        }
    }

    /// The eccentricity at which the pad lies on its electrodes still. The centres of quadrants form a
    /// square; then the eccentricity is within the square that joins the middles of its sides.
    fn within_reach(&self, [x_mm, y_mm]: [f64; 2]) -> [f64; 2] {
        if y_mm == 0.0 {
            return [x_mm.clamp(-self.reach_mm, self.reach_mm), y_mm];
        }
        let share = (self.reach_mm / (x_mm.abs() + y_mm.abs())).min(1.0);
        [share * x_mm, share * y_mm]
    }
}

impl PadDrive<'_> {
    /// What the pad is set to.
    pub fn set(&self, moment: Moment) -> Setpoint {
        let set = self.plan.set(self.point(moment), moment);
        Setpoint { haptic_v_rms: self.held_v_rms(moment).unwrap_or(set.haptic_v_rms), ..set }
    }

    /// What pulls and presses the pad, or its electrode.
    pub fn pull(&self, moment: Moment) -> Pull {
        let [load_g, haptic_v_rms, eccentricity_mm] =
            self.plan.set_of_gap(self.point(moment), moment);
        let source_v_rms = self.held_v_rms(moment).unwrap_or(haptic_v_rms);
        self.electrode.of_pad(source_v_rms, load_g, eccentricity_mm)
    }

    /// The source's voltage with its polarity: of a sine nothing, which is its mean.
    pub fn signed_v(&self, moment: Moment) -> f64 {
        self.device.haptic_wave.polarity(moment) * self.pull(moment).source_v_rms
    }

    fn held_v_rms(&self, moment: Moment) -> Option<f64> {
        self.held?.at(moment)
    }

    /// The pad before any effect.
    pub fn pad(&self, moment: Moment) -> Pad {
        let push_n = self.plan.push_n(moment);
        Pad {
            polarity: self.device.haptic_wave.polarity(moment),
            ..pad_as_set(self.index, moment.time_s, &self.set(moment), push_n, self.device)
        }
    }

    /// The same of an electrode.
    pub fn of(self, electrode: Electrode) -> Self {
        PadDrive { electrode, ..self }
    }

    /// When the voltage or what presses the pad next steps or turns; where the pad's insulators
    /// charge, the polarity too.
    pub fn next_pull_event_s(&self, after_s: f64) -> f64 {
        let scenes_s = || self.plan.next_voltage_event_s(after_s);
        let voltage_s = match self.held {
            Some(held) if held.at(Moment::at(after_s)).is_some() => held.next_event_s(after_s),
            Some(held) => held.next_event_s(after_s).min(scenes_s()),
            None => scenes_s(),
        };
        let pressure_s = self.plan.next_pressure_event_s(after_s, self.point_s);
        let turn_s = match self.plan.charges {
            true => self.device.haptic_wave.next_turn_s(after_s),
            false => f64::INFINITY,
        };
        voltage_s.min(pressure_s).min(turn_s)
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
