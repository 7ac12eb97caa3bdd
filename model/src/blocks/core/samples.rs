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
use crate::blocks::rests::Rests;
use crate::blocks::{estimator, multiplexer, oscillator, pace};
use hapticore_hdl::block::{Block, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::signal::{Clocked, Signal, bit, is_clear, zero};

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
        let mut left = clocks;
        for codes in codes.chunks_exact(self.demodulator.codes()) {
            let clocks = left.min(self.pace.clocks());
            let overrun = self.pace(&mut state.submodules.pace, clocks);
            let mut sample = Sample { core: self, i, codes, channel, observer, estimator, overrun };
            let begun = sample.begin(state, clocks);
            sample.end(state, clocks - begun);
            left -= clocks;
            if left == 0 {
                return;
            }
        }
    }

    /// The clocks of a strobe and those after it, of which none comes too early: whether one has before.
    #[inline(always)]
    fn pace(&self, state: &mut State<pace::Pace, Clocked>, clocks: u64) -> Signal<Clocked> {
        let idle = pace::Inputs { strobe: bit(false), clear: bit(false) };
        let strobe = pace::Inputs { strobe: bit(true), ..idle };
        let overrun = self.pace.clock(state, strobe).overrun;
        for _ in 1..clocks {
            self.pace.clock(state, idle);
        }
        overrun
    }

    #[inline(always)]
    fn oscillate(
        &self,
        state: &mut State<oscillator::Oscillator, Clocked>,
        slot: &multiplexer::Out<Clocked>,
    ) -> oscillator::Out<Clocked> {
        let inputs =
            oscillator::Inputs { sample: slot.sample, restart: slot.restart, first: slot.first };
        self.oscillator.clock(state, inputs)
    }
}

/// A sample while it is demodulated.
struct Sample<'a, O> {
    core: &'a Core,
    i: &'a In<Clocked>,
    codes: &'a [i32],
    /// The channel that was asked for last.
    channel: &'a mut usize,
    observer: &'a mut O,
    estimator: estimator::Out<Clocked>,
    overrun: Signal<Clocked>,
}

impl<O: Observer> Sample<'_, O> {
    /// The clocks from the strobe until multiplexer and oscillator rest, `most` at most: how many there were.
    #[inline(always)]
    fn begin(&mut self, state: &mut State<Core, Clocked>, most: u64) -> u64 {
        let (core, within) = (self.core, &mut state.submodules);
        for clock in 0..most {
            let inputs = multiplexer::Inputs { strobe: bit(clock == 0), clear: bit(false) };
            let slot = core.multiplexer.clock(&mut within.multiplexer, inputs);
            let oscillator = core.oscillate(&mut within.oscillator, &slot);
            let start = oscillator.ready & slot.integrate;
            self.clock(&mut within.demodulator, &slot, &oscillator, start);
            if !core.multiplexer.is_busy(&within.multiplexer)
                && !core.oscillator.is_busy(&within.oscillator)
            {
                return clock + 1;
            }
        }
        most
    }

    /// So many clocks in which multiplexer and oscillator rest.
    #[inline(always)]
    fn end(&mut self, state: &mut State<Core, Clocked>, clocks: u64) {
        if clocks == 0 {
            return;
        }
        let (core, within) = (self.core, &mut state.submodules);
        let nothing = multiplexer::Inputs { strobe: bit(false), clear: bit(false) };
        let slot = core.multiplexer.clock(&mut within.multiplexer, nothing);
        let oscillator = core.oscillate(&mut within.oscillator, &slot);
        for clock in 0..clocks {
            let rests = !core.demodulator.is_busy(&within.demodulator);
            let channel = self.clock(&mut within.demodulator, &slot, &oscillator, bit(false));
            if rests {
                (clock + 1..clocks).for_each(|_| self.observe(&slot, &oscillator, channel));
                return;
            }
        }
    }

    /// A clock of the demodulator: the channel that it asks for.
    #[inline(always)]
    fn clock(
        &mut self,
        state: &mut State<Demodulator, Clocked>,
        slot: &multiplexer::Out<Clocked>,
        oscillator: &oscillator::Out<Clocked>,
        start: Signal<Clocked>,
    ) -> Signal<Clocked> {
        let code = i64::from(self.codes[*self.channel]);
        let inputs = demodulator::Inputs {
            start,
            first: slot.first,
            last: slot.last,
            pad: slot.pad,
            code: Signal { value: code, ..self.i.code },
            cosine: oscillator.cosine,
            sine: oscillator.sine,
            window: oscillator.window,
            phase: oscillator.phase,
        };
        let channel = self.core.demodulator.clock(state, inputs).channel;
        *self.channel = channel.value as usize;
        self.observe(slot, oscillator, channel);
        channel
    }

    #[inline(always)]
    fn observe(
        &mut self,
        slot: &multiplexer::Out<Clocked>,
        oscillator: &oscillator::Out<Clocked>,
        channel: Signal<Clocked>,
    ) {
        let estimator::Outputs { frames, prompt } = self.estimator;
        self.observer.without_results(Outputs {
            channel,
            serve: slot.pad,
            closed: slot.closed,
            carrier: oscillator.cosine,
            frames,
            overrun: self.overrun,
            prompt,
        });
    }
}
