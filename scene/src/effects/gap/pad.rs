// SPDX-License-Identifier: MIT OR Apache-2.0
//! The patches of a pad together: at rest, or brought from slot to slot.

use super::dynamic::Method;
use super::equilibrium::equilibrium;
use super::law::{Drive, Law, State};
use super::quasi_static;
use crate::device::EPSILON_0;
use crate::effects::effect::PadEffect;
use crate::effects::pad::Pad;

/// How a pad's gaps follow their drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Motion {
    Static,
    QuasiStatic,
    Dynamic(Method),
}

/// The pad's rubber: patches of equal area that differ in the gap at which they rest.
#[derive(Clone, Debug)]
pub(super) struct Rubber {
    pub law: Law,
    pub patch_m2: f64,
    /// W/S of a gram.
    pub pa_per_g: f64,
    /// g₀ of each patch.
    pub rest_m: Vec<f64>,
}

impl Rubber {
    pub fn capacitance_f(&self, gaps_m: impl Iterator<Item = f64>) -> f64 {
        gaps_m.map(|gap| EPSILON_0 * self.patch_m2 / (gap + self.law.insulator_m)).sum()
    }

    fn attraction_n(&self, gaps_m: impl Iterator<Item = f64>, pull_n: f64) -> f64 {
        gaps_m.map(|gap| pull_n * self.patch_m2 / (gap + self.law.insulator_m).powi(2)).sum()
    }

    /// The relaxed gaps under a drive.
    pub fn equilibrium_m(&self, drive: Drive) -> impl Iterator<Item = f64> {
        self.rest_m.iter().map(move |rest| equilibrium(&self.law, *rest, drive))
    }
}

/// The effect: the rubber, how it moves, and where each pad is.
pub(super) struct Gap {
    rubber: Rubber,
    motion: Motion,
    step_s: f64,
    /// Of the haptic voltage, where it pulls as a sine.
    sine_rad_s: Option<f64>,
    pads: Vec<Option<Moving>>,
    /// The last equilibrium: over a raster load and voltage stay the same.
    rested: Option<([f64; 2], f64, Vec<f64>)>,
}

/// A pad at the middle of its last slot.
struct Moving {
    time_s: f64,
    source_v_rms: f64,
    pressure_pa: f64,
    patches: Vec<State>,
}

impl PadEffect for Gap {
    fn act(&mut self, pad: &mut Pad) {
        match self.motion {
            Motion::Static => self.settle(pad),
            _ => self.follow(pad),
        }
    }

    fn settle(&mut self, pad: &mut Pad) {
        let asked = [pad.source_v_rms, pad.load_g];
        let (volt, gaps) = match self.rested.take() {
            Some((same, volt, gaps)) if same == asked => (volt, gaps),
            _ => self.at_rest(pad),
        };
        self.set_results(pad, volt, gaps.iter().copied());
        self.rested = Some((asked, volt, gaps));
    }
}

impl Gap {
    pub fn new(rubber: Rubber, motion: Motion, step_s: f64, sine_rad_s: Option<f64>) -> Self {
        Gap { rubber, motion, step_s, sine_rad_s, pads: Vec::new(), rested: None }
    }

    /// Voltage at the pad and relaxed gaps. Behind a supply the voltage falls as the capacitance
    /// rises, and that rises with the voltage: there is one voltage that agrees, found by halving.
    fn at_rest(&self, pad: &Pad) -> (f64, Vec<f64>) {
        let pressure_pa = self.rubber.pa_per_g * pad.load_g;
        let gaps = |volt: f64| self.rubber.equilibrium_m(Drive::new(volt, pressure_pa));
        let (mut low, mut high) = (0.0, pad.source_v_rms);
        if pad.supply.is_none() {
            return (high, gaps(high).collect());
        }
        while high - low > 1e-12 * pad.source_v_rms {
            let middle = 0.5 * (low + high);
            let agreed = pad.haptic_v_at(self.rubber.capacitance_f(gaps(middle)));
            *(if agreed > middle { &mut low } else { &mut high }) = middle;
        }
        (high, gaps(high).collect())
    }

    /// Brings the pad's patches from its last slot to this one.
    fn follow(&mut self, pad: &mut Pad) {
        if self.pads.len() <= pad.index {
            self.pads.resize_with(pad.index + 1, || None);
        }
        let moving = self.pads[pad.index].take().unwrap_or_else(|| self.begin(pad));
        let moving = self.advance(moving, pad);
        let gaps = || moving.patches.iter().map(|patch| patch.gap_m);
        let volt = pad.haptic_v_at(self.rubber.capacitance_f(gaps()));
        self.set_results(pad, volt, gaps());
        self.pads[pad.index] = Some(moving);
    }

    /// The pad at the start of the case, when its voltage is switched on: relaxed under its load.
    fn begin(&self, pad: &Pad) -> Moving {
        let pressure_pa = self.rubber.pa_per_g * pad.load_g;
        let gaps = self.rubber.equilibrium_m(Drive::new(0.0, pressure_pa));
        let still =
            |(gap_m, rest_m): (f64, &f64)| State { gap_m, speed_m_s: 0.0, creep_m: rest_m - gap_m };
        let patches = gaps.zip(&self.rubber.rest_m).map(still).collect();
        Moving { time_s: 0.0, source_v_rms: pad.source_v_rms, pressure_pa, patches }
    }

    fn advance(&self, mut moving: Moving, pad: &Pad) -> Moving {
        let span_s = (pad.time_s - moving.time_s).max(0.0);
        let steps = (span_s / self.step_s).ceil();
        let pressure_pa = self.rubber.pa_per_g * pad.load_g;
        for step in 0..steps as usize {
            let seen = self.seen_square(&moving.patches, pad);
            let drive = |fraction: f64| {
                let along = (step as f64 + fraction) / steps;
                let mix = |from: f64, to: f64| from + (to - from) * along;
                let square = seen * mix(moving.source_v_rms.powi(2), pad.source_v_rms.powi(2));
                let now = self.instant(square, moving.time_s + along * span_s);
                Drive {
                    pull_n: 0.5 * EPSILON_0 * now,
                    pressure_pa: mix(moving.pressure_pa, pressure_pa),
                }
            };
            for (patch, rest) in moving.patches.iter_mut().zip(&self.rubber.rest_m) {
                *patch = self.step(*patch, *rest, span_s / steps, drive);
            }
        }
        Moving { time_s: pad.time_s, source_v_rms: pad.source_v_rms, pressure_pa, ..moving }
    }

    fn step(&self, patch: State, rest_m: f64, step_s: f64, drive: impl Fn(f64) -> Drive) -> State {
        let law = &self.rubber.law;
        match self.motion {
            Motion::Dynamic(method) => method.step(law, rest_m, patch, step_s, drive),
            _ => quasi_static::advance(law, rest_m, patch, step_s, drive(1.0)),
        }
    }

    /// What part of the source's mean square is at the pad, its capacitance being what it is now.
    fn seen_square(&self, patches: &[State], pad: &Pad) -> f64 {
        let Some(supply) = pad.supply else { return 1.0 };
        supply.share(self.rubber.capacitance_f(patches.iter().map(|patch| patch.gap_m))).powi(2)
    }

    /// The square of the voltage at a time, from its mean.
    fn instant(&self, mean_square: f64, time_s: f64) -> f64 {
        self.sine_rad_s
            .map_or(mean_square, |rad_s| 2.0 * mean_square * (rad_s * time_s).sin().powi(2))
    }

    fn set_results(&self, pad: &mut Pad, volt: f64, gaps_m: impl Iterator<Item = f64> + Clone) {
        pad.haptic_v_rms = volt;
        pad.capacitance_f = self.rubber.capacitance_f(gaps_m.clone());
        pad.attraction_n = self.rubber.attraction_n(gaps_m, Drive::new(volt, 0.0).pull_n);
    }
}
