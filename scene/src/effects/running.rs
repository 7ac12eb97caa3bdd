// SPDX-License-Identifier: MIT OR Apache-2.0
//! The effects of a run at work, each with what it has cost where somebody wants to know.

use std::time::Instant;

use super::effect::{ChannelEffect, Effect};
use super::pad::Pad;
use super::spec::{Setting, Spec};
use super::tick::Tick;
use crate::drive::PadDrive;
use crate::stimulus::Moment;

/// What an effect has cost so far.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectCost {
    /// Its table, or table and key.
    pub name: &'static str,
    /// Fidelity level in use.
    pub level: String,
    /// Wall time, s.
    pub seconds: f64,
    /// How often it was evaluated: slots, or runs of samples.
    pub evaluations: u64,
}

impl EffectCost {
    /// With what the same effect has cost elsewhere.
    #[must_use]
    pub fn and(self, other: &EffectCost) -> EffectCost {
        EffectCost {
            seconds: self.seconds + other.seconds,
            evaluations: self.evaluations + other.evaluations,
            ..self
        }
    }
}

/// The effects of a run, in the order in which they act.
pub(crate) struct Effects {
    list: Vec<Effect>,
    meter: Meter,
}

impl Effects {
    pub fn build(specs: &[Spec], setting: &Setting) -> Self {
        Effects { list: specs.iter().map(|spec| spec.build(setting)).collect(), meter: Meter::Off }
    }

    /// Counts and times every evaluation from now on.
    pub fn metered(&mut self, specs: &[Spec]) {
        let idle = |spec: &Spec| EffectCost {
            name: spec.name,
            level: spec.level().label.clone(),
            seconds: 0.0,
            evaluations: 0,
        };
        self.meter = Meter::On { costs: specs.iter().map(idle).collect(), since: Instant::now() };
    }

    /// What each effect has cost; nothing where costs are not metered.
    pub fn costs(&self) -> Vec<EffectCost> {
        if let Meter::On { costs, .. } = &self.meter { costs.clone() } else { Vec::new() }
    }

    /// Whether samples are within full scale once all effects have acted on them.
    pub fn clip(&self) -> bool {
        let last = self.list.iter().rev().find_map(|effect| match effect {
            Effect::Channels(effect) => Some(effect.clips()),
            _ => None,
        });
        last == Some(true)
    }

    /// Whether an effect reads all pads together.
    pub fn joins_pads(&self) -> bool {
        self.list.iter().any(|effect| matches!(effect, Effect::Pads(_)))
    }

    /// Lets the effects on a single pad act on it, their states brought to its time.
    pub fn on_pad(&mut self, pad: &mut Pad, drive: &PadDrive) {
        while let Some((n, tick)) = self.due(pad, drive) {
            self.keep(n, tick, drive);
        }
        pad.hand_n = self.hand_n(pad.index);
        self.meter.start();
        for (n, effect) in self.list.iter_mut().enumerate() {
            if let Effect::Pad(effect) = effect {
                effect.follow(pad, drive);
                self.meter.book(n);
            }
        }
    }

    /// Lets effect `n` keep its state at a time, after those before it have acted on the pad.
    fn keep(&mut self, n: usize, tick: Tick, drive: &PadDrive) {
        let mut pad = drive.pad(Moment::before(tick.time_s));
        pad.hand_n = self.hand_n(pad.index);
        self.meter.start();
        for (k, effect) in self.list[..=n].iter_mut().enumerate() {
            let Effect::Pad(effect) = effect else { continue };
            match k < n {
                true => effect.follow(&mut pad, drive),
                false => effect.keep(&pad, tick, drive),
            }
            self.meter.time(k);
        }
    }

    /// Force of the hand on a pad, as last kept.
    fn hand_n(&self, pad: usize) -> [f64; 2] {
        let said = self.list.iter().find_map(|effect| match effect {
            Effect::Pad(effect) => effect.hand_n(pad),
            _ => None,
        });
        said.unwrap_or_default()
    }

    /// The first effect to keep its state before the pad's time, and when.
    fn due(&self, pad: &Pad, drive: &PadDrive) -> Option<(usize, Tick)> {
        let due = |(n, effect): (usize, &Effect)| match effect {
            Effect::Pad(effect) => Some((n, effect.due(pad, drive)?)),
            _ => None,
        };
        let due = self.list.iter().enumerate().filter_map(due);
        due.min_by(|(_, a), (_, b)| a.time_s.total_cmp(&b.time_s))
    }

    /// Which effect cannot be used on a pad that they have acted on, and why.
    pub fn refusal(&self, pad: &Pad) -> Option<(usize, String)> {
        let refusal = |effect: &Effect| match effect {
            Effect::Pad(effect) => effect.refuses(pad),
            Effect::Channels(effect) => effect.refuses(pad),
            Effect::Pads(_) => None,
        };
        self.list.iter().enumerate().find_map(|(n, effect)| refusal(effect).map(|why| (n, why)))
    }

    /// Lets the effects of other pads act on one that has been acted on by itself, as they have.
    pub fn on_pads(&mut self, pad: &mut Pad, others: &[Pad]) {
        self.meter.start();
        for (n, effect) in self.list.iter_mut().enumerate() {
            if let Effect::Pads(effect) = effect {
                effect.act(pad, others);
                self.meter.book(n);
            }
        }
    }

    /// Lets a pad settle under the effects on it.
    pub fn on_resting_pad(&mut self, pad: &mut Pad) {
        self.meter.start();
        for (n, effect) in self.list.iter_mut().enumerate() {
            if let Effect::Pad(effect) = effect {
                effect.settle(pad);
                self.meter.book(n);
            }
        }
    }

    /// Lets the effects on the channels do `work`.
    pub fn on_channels(&mut self, mut work: impl FnMut(&mut dyn ChannelEffect)) {
        self.meter.start();
        for (n, effect) in self.list.iter_mut().enumerate() {
            if let Effect::Channels(effect) = effect {
                work(effect.as_mut());
                self.meter.book(n);
            }
        }
    }
}

/// Counts and times evaluations, where somebody wants to know. The end of one is the start of the next: a look
/// at the clock takes as long as a small effect.
enum Meter {
    Off,
    On { costs: Vec<EffectCost>, since: Instant },
}

impl Meter {
    fn start(&mut self) {
        if let Meter::On { since, .. } = self {
            *since = Instant::now();
        }
    }

    /// Books an evaluation of effect `n`, which took the time since the start or since the one before.
    fn book(&mut self, n: usize) {
        self.time(n);
        if let Meter::On { costs, .. } = self {
            costs[n].evaluations += 1;
        }
    }

    /// Books the time of what is not an evaluation of its own.
    fn time(&mut self, n: usize) {
        let Meter::On { costs, since } = self else { return };
        let now = Instant::now();
        costs[n].seconds += (now - *since).as_secs_f64();
        *since = now;
    }
}
