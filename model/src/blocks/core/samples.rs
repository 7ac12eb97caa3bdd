// SPDX-License-Identifier: MIT OR Apache-2.0
//! A core clocked in whole samples: one check for many clocks finds which of its blocks are busy.
//!
//! ```text
//! strobe       ┐________________________┐________________________┐____
//! multiplexer  ████                     ████                     ████
//! oscillator     ███████                  ███████                  ███
//! demodulator  ██       ██████████████████       █████████████████      within a window
//! estimator    ███████████████████████████████████████████                one of its blocks, beside all this
//! ```
//!
//! From the end of a window's read-out to the next window's last sample, the estimator receives nothing. In most of
//! these clocks at most one of its blocks is busy, so that its outputs stand still. For such clocks that block is
//! clocked by itself (`estimator/alone.rs`), and so are the blocks before the estimator (`front.rs`), for the
//! demodulator gives no sum. All other clocks are those of [`Core::clock`].

use super::front::Front;
use super::observer::Observer;
use super::{Core, In, Inputs};
use crate::blocks::estimator;
use crate::blocks::rests::Rests;
use hapticore_hdl::block::{Block, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::signal::{Clocked, Signal, bit, is_clear, zero};

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
            let estimator = self.held(state, i);
            let apart = self.clocks_apart(state, i, most);
            if apart > 0 {
                self.apart(state, (i.code, estimator), apart, codes, channel, observer);
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

    /// Clocks from a strobe on, of `most` samples at most, in which the estimator receives and gives nothing: it is
    /// clocked through them.
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
        let gain = i.calibration.capacitance_gain;
        self.estimator.run_alone(&mut within.estimator, gain, ahead * self.pace.clocks())
    }

    /// What the estimator gives while it is clocked apart.
    #[inline(always)]
    fn held(&self, state: &State<Self, Clocked>, i: &In<Clocked>) -> estimator::Out<Clocked> {
        let nothing = estimator::Inputs {
            calibration: i.calibration,
            ..estimator::Inputs::map(self.estimator.inputs(), zero)
        };
        self.estimator.held(&state.submodules.estimator, &nothing)
    }

    /// Clocks of the blocks before the estimator, which gives the same all the while; `code` has a code's format.
    ///
    /// Not inlined: what it borrows is then known to be apart, and its loops have the processor's registers to
    /// themselves.
    #[inline(never)]
    fn apart(
        &self,
        state: &mut State<Self, Clocked>,
        (code, estimator): (Signal<Clocked>, estimator::Out<Clocked>),
        clocks: u64,
        codes: &[i32],
        channel: &mut usize,
        observer: &mut impl Observer,
    ) {
        let within = &mut state.submodules;
        let mut front = Front {
            core: self,
            code,
            multiplexer: within.multiplexer.take_out(),
            oscillator: within.oscillator.take_out(),
            demodulator: &mut within.demodulator,
            channel: self.demodulator.asked(*channel),
            rests: false,
            passing: None,
            estimator,
            // Nothing is left of a sample's pace at its end, and so nothing at its beginning.
            overrun: within.pace.load(&self.pace).overrun,
            left: 0,
            later: clocks,
        };
        for codes in codes.chunks_exact(self.demodulator.codes()) {
            front.left = front.later.min(self.pace.clocks());
            front.later -= front.left;
            front.sample(codes, observer);
            if front.later == 0 {
                break;
            }
        }
        debug_assert!(front.passing.is_none(), "a sample behind it is clocked");
        *channel = front.channel.value as usize;
        within.multiplexer.put_back(front.multiplexer);
        within.oscillator.put_back(front.oscillator);
    }
}
