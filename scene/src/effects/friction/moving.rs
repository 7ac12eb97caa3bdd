// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pads that move against friction, from slot to slot: as their trajectory says, or hanging on the
//! finger that follows it.
//!
//! Between slots the finger moves evenly, and load, attraction and push are linear.

use super::law::{Drive, Law, Motion, Surface, Vector, add};
use crate::device::Device;
use crate::effects::effect::PadEffect;
use crate::effects::pad::Finger;
use crate::effects::pad::Pad;
use crate::effects::sheet::ideal_split;
use crate::trajectory::SLACK_MM;

/// The effect: a law, and where each pad is.
pub(super) struct Moving {
    law: Law,
    surface: Surface,
    step_s: f64,
    device: Device,
    pads: Vec<Option<Track>>,
}

/// A pad at the middle of its last slot.
#[derive(Clone, Copy, Debug)]
struct Track {
    time_s: f64,
    finger_m: Vector,
    pad_m: Vector,
    push_n: Vector,
    sliding_n: f64,
    motion: Motion,
}

impl Moving {
    pub fn new(law: Law, surface: Surface, step_s: f64, device: Device) -> Self {
        Moving { law, surface, step_s, device, pads: Vec::new() }
    }

    /// Where the trajectory, the push and the friction's strength are now.
    fn now(&self, pad: &Pad) -> Track {
        let at_m = [1e-3 * pad.x_mm, 1e-3 * pad.y_mm];
        let sliding_n = self.device.mu * (self.device.weight_n(pad.load_g) + pad.attraction_n);
        let motion = Motion::default();
        Track {
            time_s: pad.time_s,
            finger_m: at_m,
            pad_m: at_m,
            push_n: pad.push_n,
            sliding_n,
            motion,
        }
    }

    fn advance(&self, from: Track, to: Track, finger: Option<Finger>) -> Track {
        let span_s = (to.time_s - from.time_s).max(0.0);
        let steps = (span_s / self.step_s).ceil();
        let mut at = from;
        for step in 1..=steps as usize {
            let along = step as f64 / steps;
            let mix = |from: Vector, to: Vector| add(from, along, add(to, -1.0, from));
            let there = Track {
                finger_m: mix(from.finger_m, to.finger_m),
                push_n: mix(from.push_n, to.push_n),
                sliding_n: from.sliding_n + along * (to.sliding_n - from.sliding_n),
                ..at
            };
            at = match finger {
                Some(finger) => self.pull(finger, there, at.finger_m, span_s / steps),
                None => self.follow(there, at.finger_m, span_s / steps),
            };
        }
        Track { time_s: to.time_s, ..at }
    }

    /// The pad on the finger's spring.
    fn pull(&self, finger: Finger, to: Track, finger_before_m: Vector, step_s: f64) -> Track {
        let finger_m_s = add([0.0; 2], 1.0 / step_s, add(to.finger_m, -1.0, finger_before_m));
        let inertia = finger.mass_kg / step_s;
        let spring = add(to.push_n, finger.stiffness_n_per_m, add(to.finger_m, -1.0, to.pad_m));
        let damped = add(spring, finger.damping_n_s_per_m, finger_m_s);
        let drive = Drive {
            step_s,
            mobility_n_s_per_m: inertia
                + finger.damping_n_s_per_m
                + finger.stiffness_n_per_m * step_s,
            push_n: add(damped, inertia, to.motion.velocity_m_s),
            sliding_n: to.sliding_n,
        };
        let motion = self.law.step(&self.surface, to.motion, drive);
        Track { pad_m: add(to.pad_m, step_s, motion.velocity_m_s), motion, ..to }
    }

    /// The pad where its trajectory says.
    fn follow(&self, to: Track, before_m: Vector, step_s: f64) -> Track {
        let velocity_m_s = add([0.0; 2], 1.0 / step_s, add(to.finger_m, -1.0, before_m));
        let motion = self.law.follow(&self.surface, to.motion, velocity_m_s, step_s, to.sliding_n);
        Track { pad_m: to.finger_m, motion, ..to }
    }
}

impl PadEffect for Moving {
    fn act(&mut self, pad: &mut Pad) {
        if self.pads.len() <= pad.index {
            self.pads.resize(pad.index + 1, None);
        }
        let now = self.now(pad);
        let track = self.pads[pad.index].map_or(now, |from| self.advance(from, now, pad.finger));
        self.pads[pad.index] = Some(track);
        let [half_mm, reach_mm] = [
            [self.device.width_mm, self.device.height_mm].map(|mm| mm / 2.0),
            self.device.reach_mm(),
        ];
        let at_mm = track.pad_m.map(|m| 1e3 * m);
        pad.over_edge |=
            [0, 1].into_iter().any(|axis| at_mm[axis].abs() > reach_mm[axis] + SLACK_MM);
        [pad.x_mm, pad.y_mm] = [0, 1].map(|axis| at_mm[axis].clamp(-half_mm[axis], half_mm[axis]));
        pad.split = ideal_split(pad.x_mm, pad.y_mm, &self.device);
        pad.friction_n = super::law::length(track.motion.friction_n);
        pad.force_n = Some(self.device.mu * pad.attraction_n);
    }

    fn settle(&mut self, pad: &mut Pad) {
        pad.force_n = Some(self.device.mu * pad.attraction_n);
    }
}
