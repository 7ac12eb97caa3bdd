// SPDX-License-Identifier: MIT OR Apache-2.0
//! Multiplexer, oscillator and demodulator, clocked by themselves while the estimator takes nothing from them.
//!
//! Of the demodulator's outputs only `channel` goes on being used, and that depends on the step alone. So the
//! demodulator takes all samples but the last in one step (`demodulator/at_once.rs`), with `channel` in each of their
//! clocks. The last sample's clocks are carried out, and leave every register as if all had been.

use super::observer::Observer;
use super::{Core, Outputs};
use crate::blocks::demodulator::{self, Demodulator, Sample};
use crate::blocks::estimator;
use crate::blocks::multiplexer::{self, Multiplexer};
use crate::blocks::oscillator::{self, Oscillator};
use crate::blocks::rests::Rests;
use hapticore_hdl::block::{Block, State};
use hapticore_hdl::signal::{Clocked, Signal, bit, is_clear, is_set};
use std::mem::ManuallyDrop;

/// Multiplexer, oscillator and demodulator while they are clocked apart.
pub(super) struct Front<'a> {
    pub core: &'a Core,
    /// The input of the codes.
    pub code: Signal<Clocked>,
    pub multiplexer: ManuallyDrop<State<Multiplexer, Clocked>>,
    pub oscillator: ManuallyDrop<State<Oscillator, Clocked>>,
    pub demodulator: &'a mut State<Demodulator, Clocked>,
    /// The channel that was asked for last.
    pub channel: Signal<Clocked>,
    /// The demodulator is idle, and has asked for that channel since.
    pub rests: bool,
    /// The sample that the demodulator takes in one step, while its clocks go by.
    pub passing: Option<Passing>,
    /// What the estimator gives all the while.
    pub estimator: estimator::Out<Clocked>,
    pub overrun: Signal<Clocked>,
    /// Clocks to come of the sample.
    pub left: u64,
    /// Clocks to come after it.
    pub later: u64,
}

/// A sample that the demodulator takes in one step.
#[derive(Clone, Copy)]
pub(super) struct Passing {
    /// First sample of its window.
    first: Signal<Clocked>,
    /// The number of the carrier's phase.
    phase: Signal<Clocked>,
    /// Its clocks that have gone by, without that of its start.
    since: u64,
}

impl Front<'_> {
    /// The clocks of a sample, from its strobe on.
    #[inline(always)]
    pub fn sample(&mut self, codes: &[i32], observer: &mut impl Observer) {
        let mut strobe = bit(true);
        while self.left > 0 && (is_set(strobe) || self.core.multiplexer.is_busy(&self.multiplexer))
        {
            let slot = self.multiplex(strobe);
            let wave = self.core.oscillator.clock(&mut self.oscillator, Self::given(&slot));
            self.demodulate(codes, &slot, &wave, wave.ready & slot.integrate, observer);
            strobe = bit(false);
        }
        if self.left == 0 {
            return;
        }
        let slot = self.multiplex(strobe);
        let given = Self::given(&slot);
        while self.left > 0 && self.core.oscillator.is_busy(&self.oscillator) {
            let wave = self.core.oscillator.clock_step(&mut self.oscillator, given);
            self.demodulate(codes, &slot, &wave, wave.ready & slot.integrate, observer);
        }
        if self.left > 0 {
            let wave = self.core.oscillator.clock(&mut self.oscillator, given);
            self.behind(codes, &slot, &wave, observer);
        }
    }

    /// The clocks of a sample in which multiplexer and oscillator are idle.
    #[inline(always)]
    fn behind(
        &mut self,
        codes: &[i32],
        slot: &multiplexer::Out<Clocked>,
        wave: &oscillator::Out<Clocked>,
        observer: &mut impl Observer,
    ) {
        self.pass(self.left, codes, slot, wave, observer);
        while self.left > 0 && !self.rests {
            self.demodulate(codes, slot, wave, bit(false), observer);
        }
        (0..self.left).for_each(|_| self.observe(slot, wave, observer));
    }

    /// A clock of the multiplexer.
    #[inline(always)]
    fn multiplex(&mut self, strobe: Signal<Clocked>) -> multiplexer::Out<Clocked> {
        let inputs = multiplexer::Inputs { strobe, clear: bit(false) };
        self.core.multiplexer.clock(&mut self.multiplexer, inputs)
    }

    /// The oscillator's inputs, from the multiplexer's outputs.
    #[inline(always)]
    fn given(slot: &multiplexer::Out<Clocked>) -> oscillator::In<Clocked> {
        oscillator::Inputs { sample: slot.sample, restart: slot.restart, first: slot.first }
    }

    /// A clock of the demodulator.
    #[inline(always)]
    fn demodulate(
        &mut self,
        codes: &[i32],
        slot: &multiplexer::Out<Clocked>,
        wave: &oscillator::Out<Clocked>,
        start: Signal<Clocked>,
        observer: &mut impl Observer,
    ) {
        if is_clear(start) && self.passing.is_some() {
            return self.pass(1, codes, slot, wave, observer);
        }
        self.passing = None;
        let passes = is_set(start) && self.lets_pass();
        if !self.rests || is_set(start) {
            let start = if passes { bit(false) } else { start };
            self.rests = is_clear(start) && !self.core.demodulator.is_busy(self.demodulator);
            let code = i64::from(codes[self.channel.value as usize]);
            let inputs = demodulator::Inputs {
                start,
                first: slot.first,
                last: slot.last,
                pad: slot.pad,
                code: Signal { value: code, ..self.code },
                cosine: wave.cosine,
                sine: wave.sine,
                window: wave.window,
                phase: wave.phase,
            };
            self.channel = self.core.demodulator.step(self.demodulator, inputs).channel;
        }
        if passes {
            self.passing = Some(Passing { first: slot.first, phase: wave.phase, since: 0 });
            self.rests = false;
        }
        self.left -= 1;
        self.observe(slot, wave, observer);
    }

    /// Whether the demodulator may take a sample that starts now in one step: the next one starts within the clocks to
    /// come, and its remaining clocks are carried out in any case.
    #[inline(always)]
    fn lets_pass(&self) -> bool {
        self.left + self.later > self.core.pace.clocks()
    }

    /// Clocks of a sample taken in one step, `most` at most: in the first of them the oscillator's words are there.
    #[inline(always)]
    fn pass(
        &mut self,
        most: u64,
        codes: &[i32],
        slot: &multiplexer::Out<Clocked>,
        wave: &oscillator::Out<Clocked>,
        observer: &mut impl Observer,
    ) {
        let Some(Passing { first, phase, since }) = self.passing else { return };
        let demodulator = &self.core.demodulator;
        if since == 0 {
            let wave = oscillator::Outputs { phase, ..*wave };
            demodulator.take_sample(self.demodulator, &Sample { first, wave, codes });
        }
        let until = demodulator.clocks().min(since + most);
        for since in since..until {
            self.channel = demodulator.asks(since);
            self.observe(slot, wave, observer);
        }
        self.left -= until - since;
        let passing = Passing { first, phase, since: until };
        self.passing = (until < demodulator.clocks()).then_some(passing);
        self.rests = self.passing.is_none();
    }

    #[inline(always)]
    fn observe(
        &self,
        slot: &multiplexer::Out<Clocked>,
        wave: &oscillator::Out<Clocked>,
        observer: &mut impl Observer,
    ) {
        let estimator::Outputs { frames, prompt } = self.estimator;
        observer.without_results(Outputs {
            channel: self.channel,
            serve: slot.pad,
            closed: slot.closed,
            carrier: wave.cosine,
            frames,
            overrun: self.overrun,
            prompt,
        });
    }
}
