// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pads that move against friction: as their trajectory says, or hanging on the finger that follows
//! it.
//!
//! A step takes finger, push, load and attraction as they are at its end, and the finger's velocity
//! as its mean over the step.

use super::coefficient::Coefficient;
use super::law::{Drive, Law, Motion, Surface, Vector, add, length};
use crate::device::Device;
use crate::drive::PadDrive;
use crate::effects::effect::PadEffect;
use crate::effects::pad::Pad;
use crate::effects::sheet::ideal::ideal_split;
use crate::effects::tick::Tick;
use crate::stimulus::Moment;
use crate::trajectory::SLACK_MM;

/// The effect: a law, and where each pad is.
pub(super) struct Moving {
    law: Law,
    surface: Surface,
    mu: Coefficient,
    step_s: f64,
    device: Device,
    pads: Vec<Option<Track>>,
}

/// Where a pad is, and where its trajectory.
#[derive(Clone, Copy, Debug)]
struct Track {
    tick: Tick,
    finger_m: Vector,
    pad_m: Vector,
    motion: Motion,
    /// Force of finger and push on the pad, N.
    hand_n: Vector,
}

impl Moving {
    pub fn new(law: Law, surface: Surface, mu: Coefficient, step_s: f64, device: Device) -> Self {
        Moving { law, surface, mu, step_s, device, pads: Vec::new() }
    }

    /// The pad at the start of the case: motionless, the finger on it.
    fn begin(drive: &PadDrive) -> Track {
        let start = drive.set(Moment::at(0.0));
        let at_m = [1e-3 * start.x_mm, 1e-3 * start.y_mm];
        Track {
            tick: Tick::default(),
            finger_m: at_m,
            pad_m: at_m,
            motion: Motion::default(),
            hand_n: [0.0; 2],
        }
    }

    /// The track that is kept of a pad.
    fn kept(&self, index: usize, drive: &PadDrive) -> Track {
        let kept = self.pads.get(index).copied().flatten();
        kept.unwrap_or_else(|| Moving::begin(drive))
    }

    /// The track at the pad's time, `step_s` later.
    fn step(&self, from: &Track, pad: &Pad, step_s: f64) -> Track {
        let finger_m = [1e-3 * pad.x_mm, 1e-3 * pad.y_mm];
        let finger_m_s = add([0.0; 2], 1.0 / step_s, add(finger_m, -1.0, from.finger_m));
        let mu = self.mu.before(pad.time_s);
        let sliding_n = mu * (self.device.weight_n(pad.load_g) + pad.attraction_n);
        let Some(finger) = pad.finger else {
            let motion = self.law.follow(&self.surface, from.motion, finger_m_s, step_s, sliding_n);
            return Track { finger_m, pad_m: finger_m, motion, ..*from };
        };
        let inertia = finger.mass_kg / step_s;
        let spring = add(pad.push_n, finger.stiffness_n_per_m, add(finger_m, -1.0, from.pad_m));
        let damped = add(spring, finger.damping_n_s_per_m, finger_m_s);
        let drive = Drive {
            step_s,
            mobility_n_s_per_m: inertia
                + finger.damping_n_s_per_m
                + finger.stiffness_n_per_m * step_s,
            push_n: add(damped, inertia, from.motion.velocity_m_s),
            sliding_n,
        };
        let motion = self.law.step(&self.surface, from.motion, drive);
        let pad_m = add(from.pad_m, step_s, motion.velocity_m_s);
        let stretch = add(finger_m, -1.0, pad_m);
        let damped_m_s = add(finger_m_s, -1.0, motion.velocity_m_s);
        let hand_n = add(pad.push_n, finger.stiffness_n_per_m, stretch);
        let hand_n = add(hand_n, finger.damping_n_s_per_m, damped_m_s);
        Track { finger_m, pad_m, motion, hand_n, ..*from }
    }

    /// What the track makes of the pad.
    fn set_results(&self, pad: &mut Pad, track: &Track) {
        let [half_mm, reach_mm] = [
            [self.device.width_mm, self.device.height_mm].map(|mm| mm / 2.0),
            self.device.reach_mm(),
        ];
        let at_mm = track.pad_m.map(|m| 1e3 * m);
        pad.over_edge |=
            [0, 1].into_iter().any(|axis| at_mm[axis].abs() > reach_mm[axis] + SLACK_MM);
        [pad.x_mm, pad.y_mm] = [0, 1].map(|axis| at_mm[axis].clamp(-half_mm[axis], half_mm[axis]));
        pad.split = ideal_split(pad.x_mm, pad.y_mm, &self.device);
        pad.friction_n = length(track.motion.friction_n);
        pad.hand_n = track.hand_n;
    }
}

impl PadEffect for Moving {
    /// A motionless pad: friction has nothing to work against.
    fn act(&mut self, pad: &mut Pad) {
        pad.force_n = Some(self.mu.at(pad.time_s) * pad.attraction_n);
    }

    /// A calibration is of the nominal coefficient.
    fn settle(&mut self, pad: &mut Pad) {
        pad.force_n = Some(self.mu.nominal * pad.attraction_n);
    }

    fn hand_n(&self, pad: usize) -> Option<Vector> {
        self.pads.get(pad)?.map(|track| track.hand_n)
    }

    fn due(&self, pad: &Pad, drive: &PadDrive) -> Option<Tick> {
        let track = self.pads.get(pad.index).and_then(Option::as_ref);
        let from = track.map_or(Tick::default(), |track| track.tick);
        from.next(self.step_s, pad.time_s, |after_s| {
            drive.next_event_s(after_s, self.step_s).min(self.mu.next_event_s(after_s))
        })
    }

    fn keep(&mut self, pad: &Pad, tick: Tick, drive: &PadDrive) {
        if self.pads.len() <= pad.index {
            self.pads.resize(pad.index + 1, None);
        }
        let from = self.kept(pad.index, drive);
        let track = self.step(&from, pad, tick.time_s - from.tick.time_s);
        self.pads[pad.index] = Some(Track { tick, ..track });
    }

    fn follow(&mut self, pad: &mut Pad, drive: &PadDrive) {
        let from = self.kept(pad.index, drive);
        let ahead_s = from.tick.ahead_s(self.step_s, pad.time_s);
        let track = ahead_s.map_or(from, |ahead_s| self.step(&from, pad, ahead_s));
        self.set_results(pad, &track);
        self.act(pad);
    }
}
