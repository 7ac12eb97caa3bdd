// SPDX-License-Identifier: MIT OR Apache-2.0
//! One hand at a wall under one rule.

use std::ops::Range;

use fastrand::Rng;
use hapticore_contract::profile::Wall;
use hapticore_reference::wall::{
    Direction, Eq11, Eq12, Frame, Fused, Linear, Rule, Sequential, Stiffness, Target, Test,
};
use hapticore_scene::Truth;
use rayon::prelude::*;

use super::clocked::Clocked;
use super::device::{Drive, MOST_V, Pad, with_hand};
use super::hand::{Hand, Phase};
use super::measures::{Measures, Row};

/// The processing time from the last sample of a frame to its drive, s.
const PROCESSING_S: f64 = 30e-6;

/// Noise of the pad's place, mm rms.
const PLACE_MM: f64 = 0.01;

/// A wall's rule as it stands in the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Eq. 11.
    Eq11,
    /// Eq. 12, uncalibrated.
    Eq12,
    /// Eq. 12 with a linear force, calibrated.
    Eq12Linear,
    /// The fused rule.
    Fused,
    /// Rule B.
    B,
    /// Rule A.
    A,
    /// Rule A as the wall's block, in the words of profile `small`.
    SmallA,
    /// Rule A as the wall's block, in the words of profile `standard`.
    StandardA,
    /// Rule B as the wall's block, in the words of profile `small`.
    SmallB,
    /// A wall that knows the force of the hand.
    True,
}

impl Kind {
    /// All, in the order of the table.
    pub const ALL: [Kind; 10] = [
        Kind::Eq11,
        Kind::Eq12,
        Kind::Eq12Linear,
        Kind::Fused,
        Kind::B,
        Kind::A,
        Kind::SmallA,
        Kind::StandardA,
        Kind::SmallB,
        Kind::True,
    ];

    /// What pad it is for.
    pub fn pad(self) -> Pad {
        match self {
            Kind::A | Kind::SmallA | Kind::StandardA => Pad::Strips,
            _ => Pad::Halves,
        }
    }
}

/// What a trial is of.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The rule.
    pub kind: Kind,
    /// Stiffness of the wall, N/mm.
    pub n_per_mm: f64,
    /// By how much the left electrode is larger, %.
    pub mismatch_percent: f64,
    /// Noise of each capacitance, % rms.
    pub noise_percent: f64,
    /// Length of a frame, ms.
    pub frame_ms: f64,
}

/// A frame of a trial.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Middle of the frame, s.
    pub time_s: f64,
    /// Part of the trial, and what the hand is about.
    pub part: (usize, Phase),
    /// Place of the pad, mm.
    pub x_mm: f64,
    /// Force of the hand on the pad, N.
    pub hand_n: f64,
    /// Haptic force, N.
    pub force_n: f64,
    /// What of the friction that acts is the wall's, N.
    pub felt_n: f64,
    /// What the rule says behind this frame.
    pub direction: Direction,
    /// Haptic voltage in the frame, V rms.
    pub haptic_v: f64,
}

/// The rule that knows the hand's force.
struct Omniscient {
    stiffness: Stiffness,
    direction: Direction,
}

impl Omniscient {
    fn frame(&mut self, x_mm: f64, hand_n: f64) -> (Target, Direction) {
        match hand_n {
            _ if x_mm >= 0.0 => self.direction = Direction::Push,
            out if out > 0.01 => self.direction = Direction::Free,
            out if out < -0.01 => self.direction = Direction::Push,
            _ => (),
        }
        let depth = (-x_mm).max(0.0);
        let force_n = (self.stiffness.n_per_mm * depth).min(self.stiffness.most_n);
        let acts = self.direction == Direction::Push;
        (Target::Force(if acts { force_n } else { 0.0 }), self.direction)
    }
}

/// What a rule's frames go to.
enum Judge {
    Reads(Box<dyn Rule>),
    Knows(Omniscient),
}

impl Setup {
    fn judge(&self) -> Judge {
        let stiffness = Stiffness { n_per_mm: self.n_per_mm, most_n: 1.0 };
        // What a device reads when it leaves the factory: left C·(1 + m/2), right C·(1 − m/2).
        let factory = -0.005 * self.mismatch_percent;
        // Eq. 11 reaches half a newton, which takes 370 V, at the depth at which the linear wall does.
        let eq11 = Eq11 { v_per_mm: 370.0 * self.n_per_mm / 0.5, most_v: MOST_V };
        Judge::Reads(match self.kind {
            Kind::Eq11 => Box::new(eq11),
            Kind::Eq12 => Box::new(Eq12 { wall: eq11, inwards: -1.0, last: 0.0 }),
            Kind::Eq12Linear => Box::new(Linear { stiffness, offset: Some(factory) }),
            Kind::Fused => Box::new(Fused::new(stiffness, factory, self.frame_ms)),
            Kind::B => Box::new(Sequential::new(stiffness, Test::B, factory, self.frame_ms)),
            Kind::A => Box::new(Sequential::new(stiffness, Test::A, factory, self.frame_ms)),
            Kind::SmallA => Box::new(Clocked::new("small", Wall::A, stiffness, factory)),
            Kind::StandardA => Box::new(Clocked::new("standard", Wall::A, stiffness, factory)),
            Kind::SmallB => Box::new(Clocked::new("small", Wall::B, stiffness, factory)),
            Kind::True => {
                return Judge::Knows(Omniscient { stiffness, direction: Direction::Push });
            }
        })
    }

    /// With the mismatch of a seed: that of every other one has the other sign.
    pub(super) fn of_seed(&self, seed: u64) -> Setup {
        let sign = if seed.is_multiple_of(2) { 1.0 } else { -1.0 };
        Setup { mismatch_percent: sign * self.mismatch_percent, ..self.clone() }
    }

    /// What hands of these seeds feel; the mismatch of every other one has the other sign.
    pub fn hands(&self, seeds: Range<u64>) -> Row {
        let drive = Drive::calibrated(self.kind.pad());
        let trial = |seed: u64| {
            let hand = Hand::draw(seed, self.n_per_mm);
            Measures::of(&self.of_seed(seed).run(&hand, &drive, 1000 + seed), self.frame_ms)
        };
        let trials: Vec<Measures> = seeds.into_par_iter().map(trial).collect();
        Row::of(&trials)
    }

    /// The frames of a hand.
    pub fn run(&self, hand: &Hand, drive: &Drive, seed: u64) -> Vec<Seen> {
        let pad = self.kind.pad();
        let mut plant = with_hand(pad, hand, self.mismatch_percent, self.frame_ms);
        let (mut judge, mut rng, mut volts) = (self.judge(), Rng::with_seed(seed), 0.0);
        let base_n = plant.device().mu * hand.load_n;
        let frame = |slot: usize| {
            let truth = plant.truth(slot);
            let (sensed, brakes_pf) = pad.capacitances(&truth);
            let noisy = sensed.map(|pf| pf * (1.0 + 0.01 * self.noise_percent * gauss(&mut rng)));
            let x_mm = truth.x_mm + PLACE_MM * gauss(&mut rng);
            let at_zero = volts == 0.0;
            let frame = Frame { left: noisy[0], right: noisy[1], x_mm, along_mm: 0.0, at_zero };
            let (target, direction) = match &mut judge {
                Judge::Reads(rule) => rule.frame(&frame),
                Judge::Knows(rule) => rule.frame(x_mm, truth.hand_n[0]),
            };
            let brakes_pf = brakes_pf * (1.0 + 0.01 * self.noise_percent * gauss(&mut rng));
            volts = match target {
                Target::Voltage(volts) => volts,
                Target::Force(force_n) => drive.voltage(force_n, brakes_pf),
            };
            let end_s = 1e-3 * self.frame_ms * (slot + 1) as f64;
            plant.set_drive(0, end_s + PROCESSING_S, volts).expect("the frame has just been seen");
            seen(&truth, hand, base_n, direction)
        };
        let slots = (1e3 * hand.duration_s() / self.frame_ms).floor() as usize;
        (0..slots).map(frame).collect()
    }
}

fn seen(truth: &Truth, hand: &Hand, base_n: f64, direction: Direction) -> Seen {
    Seen {
        time_s: truth.time_s,
        part: hand.phase(truth.time_s),
        x_mm: truth.x_mm,
        hand_n: truth.hand_n[0],
        force_n: truth.force_n,
        felt_n: (truth.friction_n - base_n).clamp(0.0, truth.force_n),
        direction,
        haptic_v: truth.haptic_v_rms,
    }
}

/// A normal random number (Box and Muller).
fn gauss(rng: &mut Rng) -> f64 {
    let (a, b) = (1.0 - rng.f64(), rng.f64());
    (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
}
