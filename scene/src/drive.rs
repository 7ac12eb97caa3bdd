// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is done to a pad at any time: its stimuli as the scene has them, or what has been set in
//! their place (`pad_inputs.rs`).

use crate::device::Device;
use crate::effects::pad::Pad;
use crate::pad::{PadPlan, pad_as_set};
use crate::pad_inputs::PadInputs;
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
    /// What has been set in place of what the scene says.
    pub inputs: Option<&'a PadInputs>,
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
    /// What its source gives of the pad's voltage.
    pub source_share: f64,
    /// The most that its source gives.
    pub most_v_rms: f64,
}

impl Electrode {
    /// The whole pad.
    pub const WHOLE: Electrode = Electrode {
        lean_per_mm: [0.0; 2],
        tilt_mm: [0.0; 2],
        reach_mm: f64::INFINITY,
        source_share: 1.0,
        most_v_rms: f64::INFINITY,
    };

    /// The voltage of the electrode's source, by the pad's.
    pub fn source_v_rms(&self, pad_v_rms: f64) -> f64 {
        (self.source_share * pad_v_rms).min(self.most_v_rms)
    }

    /// What pulls and presses the electrode, of what does the pad.
    pub fn of_pad(&self, source_v_rms: f64, load_g: f64, eccentricity_mm: f64) -> Pull {
        let [x_mm, y_mm] = self.within_reach([eccentricity_mm + self.tilt_mm[0], self.tilt_mm[1]]);
        let [along_x, along_y] = self.lean_per_mm;
        Pull {
            source_v_rms: self.source_v_rms(source_v_rms),
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
        let mut set = self.plan.set(self.point(moment), moment);
        let Some(inputs) = self.inputs else { return set };
        if let Some([x_mm, y_mm]) = inputs.finger.at(moment.time_s) {
            (set.x_mm, set.y_mm) = (x_mm, y_mm);
        }
        set.load_g = inputs.load_g.at(moment).unwrap_or(set.load_g);
        set.haptic_v_rms = inputs.voltage_v_rms.at(moment).unwrap_or(set.haptic_v_rms);
        set
    }

    /// Where the scene has the finger, whatever has been set, mm.
    pub fn scripted_mm(&self, moment: Moment) -> [f64; 2] {
        let set = self.plan.set(self.point(moment), moment);
        [set.x_mm, set.y_mm]
    }

    /// What pulls and presses the pad, or its electrode.
    pub fn pull(&self, moment: Moment) -> Pull {
        let [mut load_g, mut source_v_rms, eccentricity_mm] =
            self.plan.set_of_gap(self.point(moment), moment);
        if let Some(inputs) = self.inputs {
            load_g = inputs.load_g.at(moment).unwrap_or(load_g);
            source_v_rms = inputs.voltage_v_rms.at(moment).unwrap_or(source_v_rms);
        }
        self.electrode.of_pad(source_v_rms, load_g, eccentricity_mm)
    }

    /// The source's voltage with its polarity: of a sine nothing, which is its mean.
    pub fn signed_v(&self, moment: Moment) -> f64 {
        self.device.haptic_wave.polarity(moment) * self.pull(moment).source_v_rms
    }

    /// The pad before any effect.
    pub fn pad(&self, moment: Moment) -> Pad {
        let set_n = self.inputs.and_then(|inputs| inputs.push_n.at(moment));
        let push_n = set_n.unwrap_or_else(|| self.plan.push_n(moment));
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
        let of_voltage_s = || self.plan.next_voltage_event_s(after_s);
        let of_load_s = || self.plan.next_load_event_s(after_s);
        let [voltage_s, load_s] = match self.inputs {
            None => [of_voltage_s(), of_load_s()],
            Some(inputs) => [
                inputs.voltage_v_rms.next_event_s(after_s, of_voltage_s),
                inputs.load_g.next_event_s(after_s, of_load_s),
            ],
        };
        let pressure_s = self.plan.next_pressure_event_s(after_s, self.point_s).min(load_s);
        let turn_s = match self.plan.charges {
            true => self.device.haptic_wave.next_turn_s(after_s),
            false => f64::INFINITY,
        };
        voltage_s.min(pressure_s).min(turn_s)
    }

    /// When anything next steps or turns. A line that turns more often than every `least_s` is one
    /// that does not turn at all.
    pub fn next_event_s(&self, after_s: f64, least_s: f64) -> f64 {
        let turn_s = || self.plan.next_turn_s(after_s, least_s);
        let of_push_s = || self.plan.next_push_event_s(after_s);
        let [turn_s, push_s] = match self.inputs {
            None => [turn_s(), of_push_s()],
            Some(inputs) => [
                inputs.finger.next_event_s(after_s, turn_s),
                inputs.push_n.next_event_s(after_s, of_push_s),
            ],
        };
        let motion_s = self.plan.next_motion_event_s(after_s, self.point_s);
        self.next_pull_event_s(after_s).min(turn_s).min(push_s).min(motion_s)
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
