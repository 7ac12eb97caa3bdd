// SPDX-License-Identifier: MIT OR Apache-2.0
//! The effects of a run at work, each with what it has cost.

use std::time::Instant;

use super::{ChannelEffect, Effect, Pad, PadEffect, Setting, Spec};

/// What an effect has cost so far.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectCost {
    /// Its table, or table and key.
    pub name: &'static str,
    /// Its rung.
    pub rung: String,
    /// Wall time, s.
    pub seconds: f64,
    /// How often it was evaluated: slots, or runs of samples.
    pub evaluations: u64,
}

/// The effects of a run, in the order in which they act.
pub(crate) struct Effects(Vec<(Effect, EffectCost)>);

impl Effects {
    pub fn build(specs: &[Spec], setting: &Setting) -> Self {
        let idle = |spec: &Spec| EffectCost { name: spec.name, rung: spec.rung.clone(), seconds: 0.0, evaluations: 0 };
        Effects(specs.iter().map(|spec| ((spec.build)(setting), idle(spec))).collect())
    }

    pub fn costs(&self) -> Vec<EffectCost> {
        self.0.iter().map(|(_, cost)| cost.clone()).collect()
    }

    /// Lets the effects on the pad act on it.
    pub fn on_pad(&mut self, pad: &mut Pad) {
        for (effect, cost) in &mut self.0 {
            if let Effect::Pad(effect) = effect {
                book(cost, || PadEffect::act(effect.as_mut(), pad));
            }
        }
    }

    /// Lets the effects on the channels do `work`.
    pub fn on_channels(&mut self, mut work: impl FnMut(&mut dyn ChannelEffect)) {
        for (effect, cost) in &mut self.0 {
            if let Effect::Channels(effect) = effect {
                book(cost, || work(effect.as_mut()));
            }
        }
    }
}

fn book(cost: &mut EffectCost, work: impl FnOnce()) {
    let start = Instant::now();
    work();
    cost.seconds += start.elapsed().as_secs_f64();
    cost.evaluations += 1;
}
