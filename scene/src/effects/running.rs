// SPDX-License-Identifier: MIT OR Apache-2.0
//! The effects of a run at work, each with what it has cost where somebody wants to know.

use std::time::Instant;

use super::effect::{ChannelEffect, Effect};
use super::pad::Pad;
use super::spec::{Setting, Spec};

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
        self.meter = Meter::On(specs.iter().map(idle).collect());
    }

    /// What each effect has cost; nothing where nobody asked for it to be metered.
    pub fn costs(&self) -> Vec<EffectCost> {
        if let Meter::On(costs) = &self.meter { costs.clone() } else { Vec::new() }
    }

    /// Whether an effect looks at all pads at once.
    pub fn joins_pads(&self) -> bool {
        self.list.iter().any(|effect| matches!(effect, Effect::Pads(_)))
    }

    /// Lets the effects on a single pad act on it.
    pub fn on_pad(&mut self, pad: &mut Pad) {
        for (n, effect) in self.list.iter_mut().enumerate() {
            if let Effect::Pad(effect) = effect {
                self.meter.book(n, || effect.act(pad));
            }
        }
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
        for (n, effect) in self.list.iter_mut().enumerate() {
            if let Effect::Pads(effect) = effect {
                self.meter.book(n, || effect.act(pad, others));
            }
        }
    }

    /// Lets a pad settle under the effects on it.
    pub fn on_resting_pad(&mut self, pad: &mut Pad) {
        for (n, effect) in self.list.iter_mut().enumerate() {
            if let Effect::Pad(effect) = effect {
                self.meter.book(n, || effect.settle(pad));
            }
        }
    }

    /// Lets the effects on the channels do `work`.
    pub fn on_channels(&mut self, mut work: impl FnMut(&mut dyn ChannelEffect)) {
        for (n, effect) in self.list.iter_mut().enumerate() {
            if let Effect::Channels(effect) = effect {
                self.meter.book(n, || work(effect.as_mut()));
            }
        }
    }
}

/// Counts and times evaluations, where somebody wants to know.
enum Meter {
    Off,
    On(Vec<EffectCost>),
}

impl Meter {
    fn book(&mut self, n: usize, work: impl FnOnce()) {
        let Meter::On(costs) = self else { return work() };
        let start = Instant::now();
        work();
        costs[n].seconds += start.elapsed().as_secs_f64();
        costs[n].evaluations += 1;
    }
}
