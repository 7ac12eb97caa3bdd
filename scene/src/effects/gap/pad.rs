// SPDX-License-Identifier: MIT OR Apache-2.0
//! The patches of a pad together: at rest, or brought along in time.

use super::dynamic::Method;
use super::equilibrium::{equilibrium, equilibrium_from};
use super::law::{Drive, Law, State};
use super::quasi_static;
use crate::device::EPSILON_0;
use crate::drive::{PadDrive, Pull};
use crate::effects::effect::PadEffect;
use crate::effects::pad::{Pad, Supply};
use crate::effects::tick::{Tick, slack_s};
use crate::stimulus::Moment;

/// How a pad's gaps follow their drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Motion {
    Static,
    /// The equilibrium that the pad finds from where it is.
    Hysteresis,
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
    /// The stiffest spring that steps of a method are stable with: where the highest patch rests
    /// the film damps least.
    pub fn stiffest_pa_per_m(&self, method: Method, step_s: f64) -> f64 {
        let highest_m = self.rest_m.iter().copied().fold(0.0, f64::max);
        method.stiffest_pa_per_m(&self.law, highest_m, step_s)
    }

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
    /// The patches at the time that is looked at.
    seen: Vec<State>,
    /// The last equilibrium: over a raster load and voltage stay the same.
    rested: Option<([f64; 2], f64, Vec<f64>)>,
}

/// A pad at a time at which its state is kept.
struct Moving {
    tick: Tick,
    patches: Vec<State>,
}

impl PadEffect for Gap {
    fn act(&mut self, pad: &mut Pad) {
        let asked = [pad.source_v_rms, pad.load_g];
        let (volt, gaps) = match self.rested.take() {
            Some((same, volt, gaps)) if same == asked => (volt, gaps),
            _ => self.at_rest(pad),
        };
        self.set_results(pad, volt, gaps.iter().copied());
        self.rested = Some((asked, volt, gaps));
    }

    fn follow(&mut self, pad: &mut Pad, drive: &PadDrive) {
        match self.motion {
            Motion::Static => self.act(pad),
            _ => self.bring_along(pad, drive),
        }
    }
}

impl Gap {
    pub fn new(rubber: Rubber, motion: Motion, step_s: f64, sine_rad_s: Option<f64>) -> Self {
        let (pads, seen, rested) = (Vec::new(), Vec::new(), None);
        Gap { rubber, motion, step_s, sine_rad_s, pads, seen, rested }
    }

    /// Voltage at the pad and relaxed gaps.
    fn at_rest(&self, pad: &Pad) -> (f64, Vec<f64>) {
        let pressure_pa = self.rubber.pa_per_g * pad.load_g;
        let gaps = |volt: f64| self.rubber.equilibrium_m(Drive::new(volt, pressure_pa));
        let volt =
            agreed_v(pad.source_v_rms, pad.supply, |volt| self.rubber.capacitance_f(gaps(volt)));
        (volt, gaps(volt).collect())
    }

    /// The equilibria that the patches find from where they are.
    fn relax(&self, patches: &mut [State], supply: Option<Supply>, pull: Pull) {
        let pressure_pa = self.rubber.pa_per_g * pull.load_g;
        let from = patches.iter().zip(&self.rubber.rest_m);
        let capacitance_f = |volt: f64| {
            let drive = Drive::new(volt, pressure_pa);
            let gaps = from
                .clone()
                .map(|(at, rest)| equilibrium_from(&self.rubber.law, *rest, drive, at.gap_m));
            self.rubber.capacitance_f(gaps)
        };
        let volt = agreed_v(pull.source_v_rms, supply, capacitance_f);
        let drive = Drive::new(volt, pressure_pa);
        for (patch, rest) in patches.iter_mut().zip(&self.rubber.rest_m) {
            let gap_m = equilibrium_from(&self.rubber.law, *rest, drive, patch.gap_m);
            *patch = at_rest(*rest, gap_m);
        }
    }

    /// Brings the pad's patches to its time: tick by tick, then by a step that is not kept.
    fn bring_along(&mut self, pad: &mut Pad, drive: &PadDrive) {
        if self.pads.len() <= pad.index {
            self.pads.resize_with(pad.index + 1, || None);
        }
        let mut moving = self.pads[pad.index].take().unwrap_or_else(|| self.begin(drive));
        let next_event_s = |after_s: f64| drive.next_pull_event_s(after_s);
        while let Some(next) = moving.tick.next(self.step_s, pad.time_s, next_event_s) {
            self.step(&mut moving.patches, [moving.tick.time_s, next.time_s], pad.supply, drive);
            moving.tick = next;
        }
        let mut seen = std::mem::take(&mut self.seen);
        seen.clone_from(&moving.patches);
        if moving.tick.ahead_s(self.step_s, pad.time_s).is_some() {
            self.step(&mut seen, [moving.tick.time_s, pad.time_s], pad.supply, drive);
        }
        let gaps = seen.iter().map(|patch| patch.gap_m);
        let volt = pad.haptic_v_at(self.rubber.capacitance_f(gaps.clone()));
        self.set_results(pad, volt, gaps);
        self.seen = seen;
        self.pads[pad.index] = Some(moving);
    }

    /// The pad at the start of the case, when its voltage is switched on: relaxed under its load.
    fn begin(&self, drive: &PadDrive) -> Moving {
        let pressure_pa = self.rubber.pa_per_g * drive.pull(Moment::at(0.0)).load_g;
        let gaps = self.rubber.equilibrium_m(Drive::new(0.0, pressure_pa));
        let still = |(gap_m, rest_m): (f64, &f64)| at_rest(*rest_m, gap_m);
        let patches = gaps.zip(&self.rubber.rest_m).map(still).collect();
        Moving { tick: Tick::default(), patches }
    }

    /// Brings the patches from one time to another, between which nothing steps.
    fn step(
        &self,
        patches: &mut [State],
        [from_s, to_s]: [f64; 2],
        supply: Option<Supply>,
        drive: &PadDrive,
    ) {
        if self.motion == Motion::Hysteresis {
            return self.relax(patches, supply, drive.pull(Moment::before(to_s)));
        }
        let span_s = to_s - from_s;
        let seen = self.seen_square(patches, supply);
        let at = |fraction: f64| {
            let moment = match fraction {
                0.0 => Moment::at(from_s + slack_s(self.step_s)),
                1.0 => Moment::before(to_s),
                _ => Moment::at(from_s + fraction * span_s),
            };
            self.drive(seen, drive.pull(moment), moment.time_s)
        };
        let law = &self.rubber.law;
        let each = patches.iter_mut().zip(&self.rubber.rest_m);
        if let Motion::Dynamic(method) = self.motion {
            let stages = method.stages(at);
            each.for_each(|(patch, rest)| {
                *patch = method.step(law, *rest, *patch, span_s, &stages)
            });
            return;
        }
        let end = at(1.0);
        each.for_each(|(patch, rest)| {
            *patch = quasi_static::advance(law, *rest, *patch, span_s, end);
        });
    }

    /// What pulls and presses the patches, where this part of the source's mean square is at the
    /// pad.
    fn drive(&self, seen: f64, pull: Pull, time_s: f64) -> Drive {
        let square = self.instant(seen * pull.source_v_rms.powi(2), time_s);
        Drive { pull_n: 0.5 * EPSILON_0 * square, pressure_pa: self.rubber.pa_per_g * pull.load_g }
    }

    /// What part of the source's mean square is at the pad, its capacitance being what it is now.
    fn seen_square(&self, patches: &[State], supply: Option<Supply>) -> f64 {
        let Some(supply) = supply else { return 1.0 };
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

/// A patch that is still, and has crept as far as it will.
fn at_rest(rest_m: f64, gap_m: f64) -> State {
    State { gap_m, speed_m_s: 0.0, creep_m: rest_m - gap_m }
}

/// The voltage at a pad whose capacitance rises with it: behind a supply the voltage falls as the
/// capacitance rises, so that there is one that agrees, found by halving.
fn agreed_v(source_v: f64, supply: Option<Supply>, capacitance_f: impl Fn(f64) -> f64) -> f64 {
    let Some(supply) = supply else { return source_v };
    let (mut low, mut high) = (0.0, source_v);
    while high - low > 1e-12 * source_v {
        let middle = 0.5 * (low + high);
        let agreed = source_v * supply.share(capacitance_f(middle));
        *(if agreed > middle { &mut low } else { &mut high }) = middle;
    }
    high
}
