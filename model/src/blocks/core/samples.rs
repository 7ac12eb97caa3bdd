// SPDX-License-Identifier: MIT OR Apache-2.0
//! A core that is given whole samples: which of its blocks are under way is asked once for many clocks.
//!
//! ```text
//! strobe       ┐________________________┐________________________┐____
//! multiplexer  ████                     ████                     ████
//! oscillator     ███████                  ███████                  ███
//! demodulator  ██       ██████████████████       █████████████████      within a window
//! position     ███████████████████████████████████████████                its program, beside all this
//! ```
//!
//! From the end of a window's read-out to the next window's last sample, nothing but these is under way in most
//! clocks: the estimator's other blocks rest, and its outputs stand still. In such clocks each of these blocks is clocked
//! by itself, clock by clock: they do not depend on one another but from the left to the right of the core, and
//! the demodulator gives no sum. All other clocks are those of [`Core::clock`].

use super::{Core, In, Inputs, Outputs};
use crate::blocks::demodulator::{self, Demodulator};
use crate::blocks::multiplexer::Multiplexer;
use crate::blocks::oscillator::Oscillator;
use crate::blocks::rests::Rests;
use crate::blocks::{estimator, multiplexer, oscillator, pace};
use hapticore_hdl::block::{Block, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::signal::{Clocked, Signal, bit, is_clear, is_set, zero};
use std::mem::ManuallyDrop;

/// Who looks at the outputs of a core, clock by clock.
pub trait Observer {
    /// The outputs of a clock.
    fn outputs(&mut self, outputs: Outputs<Signal<Clocked>>);

    /// The outputs of a clock that gives neither a word of a frame nor a prompt estimate.
    #[inline(always)]
    fn without_results(&mut self, outputs: Outputs<Signal<Clocked>>) {
        self.outputs(outputs);
    }
}

impl Core {
    /// The clocks of samples that follow one another at the profile's pace: `codes` are those of every channel, sample
    /// by sample, `channel` the channel that was asked for last. All other inputs are as given in each clock.
    ///
    /// # Panics
    /// Where `codes` has not one code per channel per sample.
    #[inline(always)]
    pub fn samples(
        &self,
        state: &mut State<Self, Clocked>,
        i: &In<Clocked>,
        codes: &[i32],
        channel: &mut usize,
        observer: &mut impl Observer,
    ) {
        let (clocks, channels) = (self.pace.clocks(), self.demodulator.codes());
        assert_eq!(codes.len() % channels, 0, "one code per channel per sample");
        let mut codes = codes;
        while !codes.is_empty() {
            let most = (codes.len() / channels) as u64;
            let apart = self.clocks_apart(state, i, most);
            if apart > 0 {
                self.apart(state, i, apart, codes, channel, observer);
            }
            codes = &codes[(apart / clocks) as usize * channels..];
            let Some(sample) = codes.get(..channels) else { return };
            for clock in apart % clocks..clocks {
                let code = Signal { value: i64::from(sample[*channel]), ..i.code };
                let outputs = self.clock(state, Inputs { strobe: bit(clock == 0), code, ..*i });
                *channel = outputs.channel.value as usize;
                observer.outputs(outputs);
            }
            codes = &codes[channels..];
        }
    }

    /// Clocks from a strobe on, of `most` samples at most, in which the estimator gives nothing and is given nothing:
    /// it is clocked through them.
    #[inline(always)]
    fn clocks_apart(&self, state: &mut State<Self, Clocked>, i: &In<Clocked>, most: u64) -> u64 {
        let within = &mut state.submodules;
        let ahead = self.multiplexer.samples_before_last(&within.multiplexer).min(most);
        let rests = is_clear(i.clear | i.calibration.table.write)
            && !self.multiplexer.is_busy(&within.multiplexer)
            && !self.pace.is_busy(&within.pace)
            && !self.oscillator.is_busy(&within.oscillator)
            && !self.demodulator.gives_sums(&within.demodulator);
        if !rests || ahead == 0 {
            return 0;
        }
        self.estimator.run_position(&mut within.estimator, ahead * self.pace.clocks())
    }

    /// So many clocks of everything but the estimator.
    ///
    /// Not inlined: what it borrows is then known to be apart, and its loops have the processor's registers to
    /// themselves.
    #[inline(never)]
    fn apart(
        &self,
        state: &mut State<Self, Clocked>,
        i: &In<Clocked>,
        clocks: u64,
        codes: &[i32],
        channel: &mut usize,
        observer: &mut impl Observer,
    ) {
        let nothing = estimator::Inputs {
            calibration: i.calibration,
            ..estimator::Inputs::map(self.estimator.inputs(), zero)
        };
        let estimator = self.estimator.held(&state.submodules.estimator, &nothing);
        let within = &mut state.submodules;
        let mut front = Front {
            core: self,
            code: i.code,
            multiplexer: within.multiplexer.take_out(),
            oscillator: within.oscillator.take_out(),
            demodulator: within.demodulator.take_out(),
            channel: self.demodulator.asked(*channel),
            rests: false,
            estimator,
            overrun: bit(false),
            left: 0,
        };
        let mut left = clocks;
        for codes in codes.chunks_exact(self.demodulator.codes()) {
            front.left = left.min(self.pace.clocks());
            left -= front.left;
            front.overrun = self.pace(&mut within.pace, front.left);
            front.begin(codes, observer);
            front.end(codes, observer);
            if left == 0 {
                break;
            }
        }
        *channel = front.channel.value as usize;
        within.multiplexer.put_back(front.multiplexer);
        within.oscillator.put_back(front.oscillator);
        within.demodulator.put_back(front.demodulator);
    }

    /// The clocks of a strobe and those after it, of which none comes too early: whether one has before.
    #[inline(always)]
    fn pace(&self, state: &mut State<pace::Pace, Clocked>, clocks: u64) -> Signal<Clocked> {
        let idle = pace::Inputs { strobe: bit(false), clear: bit(false) };
        let strobe = pace::Inputs { strobe: bit(true), ..idle };
        let mut own = state.take_out();
        let overrun = self.pace.clock(&mut own, strobe).overrun;
        for _ in 1..clocks {
            self.pace.clock(&mut own, idle);
        }
        state.put_back(own);
        overrun
    }
}

/// Multiplexer, oscillator and demodulator while they are clocked apart.
struct Front<'a> {
    core: &'a Core,
    /// The input of the codes.
    code: Signal<Clocked>,
    multiplexer: ManuallyDrop<State<Multiplexer, Clocked>>,
    oscillator: ManuallyDrop<State<Oscillator, Clocked>>,
    demodulator: ManuallyDrop<State<Demodulator, Clocked>>,
    /// The channel that was asked for last.
    channel: Signal<Clocked>,
    /// The demodulator rests, and has asked for that channel since.
    rests: bool,
    /// What the estimator gives all the while.
    estimator: estimator::Out<Clocked>,
    overrun: Signal<Clocked>,
    /// Clocks to come of the sample.
    left: u64,
}

impl Front<'_> {
    /// The clocks from the strobe until multiplexer and oscillator rest.
    #[inline(always)]
    fn begin(&mut self, codes: &[i32], observer: &mut impl Observer) {
        let mut strobe = bit(true);
        while self.left > 0 && (is_set(strobe) || self.oscillates()) {
            let (slot, wave) = self.oscillate(strobe);
            self.demodulate(codes, &slot, &wave, wave.ready & slot.integrate, observer);
            strobe = bit(false);
        }
    }

    /// The clocks in which multiplexer and oscillator rest.
    #[expect(
        clippy::if_same_then_else,
        reason = "either kind of sums has a loop of its own, from which the compiler drops what the other needs"
    )]
    #[inline(always)]
    fn end(&mut self, codes: &[i32], observer: &mut impl Observer) {
        if self.left == 0 {
            return;
        }
        let (slot, wave) = self.oscillate(bit(false));
        if self.core.demodulator.polyphase().is_some() {
            self.until_rest(codes, &slot, &wave, observer);
        } else {
            self.until_rest(codes, &slot, &wave, observer);
        }
        (0..self.left).for_each(|_| self.observe(&slot, &wave, observer));
    }

    #[inline(always)]
    fn until_rest(
        &mut self,
        codes: &[i32],
        slot: &multiplexer::Out<Clocked>,
        wave: &oscillator::Out<Clocked>,
        observer: &mut impl Observer,
    ) {
        while self.left > 0 && !self.rests {
            self.demodulate(codes, slot, wave, bit(false), observer);
        }
    }

    /// Whether multiplexer or oscillator are under way.
    #[inline(always)]
    fn oscillates(&self) -> bool {
        self.core.multiplexer.is_busy(&self.multiplexer)
            || self.core.oscillator.is_busy(&self.oscillator)
    }

    /// A clock of multiplexer and oscillator.
    #[inline(always)]
    fn oscillate(
        &mut self,
        strobe: Signal<Clocked>,
    ) -> (multiplexer::Out<Clocked>, oscillator::Out<Clocked>) {
        let inputs = multiplexer::Inputs { strobe, clear: bit(false) };
        let slot = self.core.multiplexer.clock(&mut self.multiplexer, inputs);
        let inputs =
            oscillator::Inputs { sample: slot.sample, restart: slot.restart, first: slot.first };
        (slot, self.core.oscillator.clock(&mut self.oscillator, inputs))
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
        self.left -= 1;
        if !self.rests || is_set(start) {
            self.rests = is_clear(start) && !self.core.demodulator.is_busy(&self.demodulator);
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
            self.channel = self.core.demodulator.clock(&mut self.demodulator, inputs).channel;
        }
        self.observe(slot, wave, observer);
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
