// SPDX-License-Identifier: MIT OR Apache-2.0
//! The patches of a pad together: in equilibrium, or brought along in time.
//!
//! Load and voltage act as they are at each stage of a step. Charge and the rubber's warmth come from
//! effects before this one: then steps are taken where these are as they were then, `due` by `due`.

use super::dynamic::Method;
use super::equilibrium::equilibrium_from;
use super::law::{Drive, Patch, State};
use super::quasi_static;
use super::rubber::{Rubber, agreed_v, at_rest};
use crate::device::EPSILON_0;
use crate::drive::{PadDrive, Pull};
use crate::effects::effect::PadEffect;
use crate::effects::pad::{Charge, Pad, Supply};
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

/// The effect: the rubber, how it moves, and where each pad is.
pub(super) struct Gap {
    rubber: Rubber,
    motion: Motion,
    step_s: f64,
    /// Of the haptic voltage, where it pulls as a sine.
    sine_rad_s: Option<f64>,
    /// Effects before it change over time what acts on the patches.
    led: bool,
    pads: Vec<Option<Moving>>,
    /// The patches at the time of the evaluation.
    seen: Vec<State>,
    /// The last equilibrium of each pad: load and voltage often stay the same.
    rested: Vec<Option<Rested>>,
}

/// An equilibrium: what it is of, the voltage at the pad, and the gaps.
struct Rested {
    asked: Asked,
    volt: f64,
    gaps: Vec<f64>,
}

/// What an equilibrium is of: source, load, stiffness of the rubber, and charge.
type Asked = ([f64; 3], Option<Charge>);

/// A pad at a time at which its state is kept.
struct Moving {
    tick: Tick,
    patches: Vec<State>,
}

impl PadEffect for Gap {
    fn act(&mut self, pad: &mut Pad) {
        let asked = ([pad.source_v_rms, pad.load_g, pad.stiffness], pad.charge);
        let rested = self.rested_before(pad.index).filter(|rested| rested.asked == asked);
        let rested = rested.unwrap_or_else(|| {
            self.rubber.stiffen(pad.stiffness);
            let (volt, gaps) = self.at_rest(pad);
            Rested { asked, volt, gaps }
        });
        self.set_results(pad, rested.volt, rested.gaps.iter().copied());
        self.rested[pad.index] = Some(rested);
    }

    fn follow(&mut self, pad: &mut Pad, drive: &PadDrive) {
        match self.motion {
            Motion::Static => self.act(pad),
            _ => {
                self.rubber.stiffen(pad.stiffness);
                self.bring_along(pad, drive);
            }
        }
    }

    fn due(&self, pad: &Pad, drive: &PadDrive) -> Option<Tick> {
        if !self.led || self.motion == Motion::Static {
            return None;
        }
        let moving = self.pads.get(pad.index).and_then(Option::as_ref);
        self.next(moving.map_or(Tick::default(), |moving| moving.tick), pad, drive)
    }

    fn keep(&mut self, pad: &Pad, tick: Tick, drive: &PadDrive) {
        self.rubber.stiffen(pad.stiffness);
        let mut moving = self.take(pad.index, drive);
        self.step_to(&mut moving, tick, pad, drive);
        self.pads[pad.index] = Some(moving);
    }
}

impl Gap {
    pub fn new(rubber: Rubber, motion: Motion, step_s: f64, sine_rad_s: Option<f64>) -> Self {
        let (pads, seen, rested) = (Vec::new(), Vec::new(), Vec::new());
        Gap { rubber, motion, step_s, sine_rad_s, led: false, pads, seen, rested }
    }

    /// The same gap, behind effects that change over time what acts on the patches.
    pub fn led(self, led: bool) -> Self {
        Gap { led, ..self }
    }

    /// The last equilibrium of a pad, for a while.
    fn rested_before(&mut self, index: usize) -> Option<Rested> {
        if self.rested.len() <= index {
            self.rested.resize_with(index + 1, || None);
        }
        self.rested[index].take()
    }

    /// Voltage at the pad and relaxed gaps.
    fn at_rest(&self, pad: &Pad) -> (f64, Vec<f64>) {
        let pressure_pa = self.rubber.pa_per_g * pad.load_g;
        let gaps =
            |volt: f64| self.rubber.equilibrium_m(Drive::new(pad.pulling_v(volt), pressure_pa));
        let volt =
            agreed_v(pad.source_v_rms, pad.supply, |volt| self.rubber.capacitance_f(gaps(volt)));
        (volt, gaps(volt).collect())
    }

    /// The equilibria that the patches find from where they are.
    fn relax(&self, patches: &mut [State], pad: &Pad, pull: Pull) {
        let pressure_pa = self.rubber.pa_per_g * pull.load_g;
        let from = patches.iter().zip(&self.rubber.patches);
        let capacitance_f = |volt: f64| {
            let drive = Drive::new(pad.pulling_v(volt), pressure_pa);
            let gaps = from
                .clone()
                .map(|(at, patch)| equilibrium_from(&self.rubber.law, *patch, drive, at.gap_m));
            self.rubber.capacitance_f(gaps)
        };
        let volt = agreed_v(pull.source_v_rms, pad.supply, capacitance_f);
        let drive = Drive::new(pad.pulling_v(volt), pressure_pa);
        for (state, patch) in patches.iter_mut().zip(&self.rubber.patches) {
            let gap_m = equilibrium_from(&self.rubber.law, *patch, drive, state.gap_m);
            *state = at_rest(&self.rubber.law, *patch, gap_m);
        }
    }

    /// Brings the pad's patches to its time: tick by tick, then by a step that is not kept.
    fn bring_along(&mut self, pad: &mut Pad, drive: &PadDrive) {
        let mut moving = self.take(pad.index, drive);
        while let Some(next) = self.next(moving.tick, pad, drive) {
            self.step_to(&mut moving, next, pad, drive);
        }
        let mut seen = std::mem::take(&mut self.seen);
        seen.clone_from(&moving.patches);
        if moving.tick.ahead_s(self.step_s, pad.time_s).is_some() {
            self.step(&mut seen, [moving.tick.time_s, pad.time_s], pad, drive);
        }
        let gaps = seen.iter().map(|patch| patch.gap_m);
        let volt = pad.haptic_v_at(self.rubber.capacitance_f(gaps.clone()));
        self.set_results(pad, volt, gaps);
        self.seen = seen;
        self.pads[pad.index] = Some(moving);
    }

    /// What is kept of a pad, for a while.
    fn take(&mut self, index: usize, drive: &PadDrive) -> Moving {
        if self.pads.len() <= index {
            self.pads.resize_with(index + 1, || None);
        }
        self.pads[index].take().unwrap_or_else(|| self.begin(drive))
    }

    /// When the state is kept next, up to the pad's time.
    fn next(&self, from: Tick, pad: &Pad, drive: &PadDrive) -> Option<Tick> {
        from.next(self.step_s, pad.time_s, |after_s| drive.next_pull_event_s(after_s))
    }

    /// Brings a pad to the next time at which its state is kept.
    fn step_to(&self, moving: &mut Moving, next: Tick, pad: &Pad, drive: &PadDrive) {
        self.step(&mut moving.patches, [moving.tick.time_s, next.time_s], pad, drive);
        moving.tick = next;
    }

    /// The pad at the start of the case, when its voltage is switched on: relaxed under its load.
    fn begin(&self, drive: &PadDrive) -> Moving {
        let pressure_pa = self.rubber.pa_per_g * drive.pull(Moment::at(0.0)).load_g;
        let gaps = self.rubber.equilibrium_m(Drive::new(0.0, pressure_pa));
        let still = |(gap_m, patch): (f64, &Patch)| at_rest(&self.rubber.law, *patch, gap_m);
        let patches = gaps.zip(&self.rubber.patches).map(still).collect();
        Moving { tick: Tick::default(), patches }
    }

    /// Brings the patches from one time to another, between which nothing steps.
    fn step(&self, states: &mut [State], [from_s, to_s]: [f64; 2], pad: &Pad, drive: &PadDrive) {
        if self.motion == Motion::Hysteresis {
            return self.relax(states, pad, drive.pull(Moment::before(to_s)));
        }
        let span_s = to_s - from_s;
        let seen = self.seen_square(states, pad.supply);
        let at = |fraction: f64| {
            let moment = match fraction {
                0.0 => Moment::at(from_s + slack_s(self.step_s)),
                1.0 => Moment::before(to_s),
                _ => Moment::at(from_s + fraction * span_s),
            };
            let charge = pad.charge.map(|charge| charge.ago(to_s - moment.time_s));
            self.drive(seen, drive.pull(moment), moment.time_s, charge)
        };
        let rubber = &self.rubber;
        if let Motion::Dynamic(method) = self.motion {
            return method.step(&rubber.law, &rubber.patches, states, span_s, &method.stages(at));
        }
        let end = at(1.0);
        for (state, patch) in states.iter_mut().zip(&rubber.patches) {
            *state = quasi_static::advance(&rubber.law, *patch, *state, span_s, end);
        }
    }

    /// What pulls and presses the patches, where this part of the source's mean square is at the
    /// pad.
    fn drive(&self, seen: f64, pull: Pull, time_s: f64, charge: Option<Charge>) -> Drive {
        let mean_square = seen * pull.source_v_rms.powi(2);
        let square = match charge {
            None => self.instant(mean_square, time_s),
            Some(charge) => self.instant_charged(mean_square, time_s, charge),
        };
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

    /// The same less what charge holds against it.
    fn instant_charged(&self, mean_square: f64, time_s: f64, charge: Charge) -> f64 {
        match self.sine_rad_s {
            None => charge.square_under(mean_square.sqrt()),
            Some(rad_s) => {
                ((2.0 * mean_square).sqrt() * (rad_s * time_s).sin() - charge.volt).powi(2)
            }
        }
    }

    fn set_results(&self, pad: &mut Pad, volt: f64, gaps_m: impl Iterator<Item = f64> + Clone) {
        pad.haptic_v_rms = volt;
        pad.capacitance_f = self.rubber.capacitance_f(gaps_m.clone());
        let pull_n = Drive::new(pad.pulling_v(volt), 0.0).pull_n;
        pad.attraction_n = self.rubber.attraction_n(gaps_m, pull_n);
        pad.uneven = true;
    }
}
