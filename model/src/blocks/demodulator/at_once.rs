// SPDX-License-Identifier: MIT OR Apache-2.0
//! A sample in one step: what its clocks leave to the next, where of the outputs only `channel` is used meanwhile.
//!
//! A sample leaves its share of the sums, what rounding leaves over, whether a code was at full scale, and which sums
//! have begun. All other registers are the pipeline's, which the next sample's clocks write anew: samples may take one
//! step each if the clocks of one behind them are carried out. Products, roundings and sums are the functions that the
//! clocks use.

use super::polyphase::PRODUCT;
use super::{Demodulator, Polyphase, Registers, Regs};
use crate::blocks::oscillator;
use hapticore_hdl::block::State;
use hapticore_hdl::signal::{Clocked, Signal, bit, int};

/// A sample that the demodulator takes in one step.
pub(in crate::blocks) struct Sample<'a> {
    /// Whether it is its window's first.
    pub first: Signal<Clocked>,
    /// The oscillator's words of it.
    pub wave: oscillator::Out<Clocked>,
    /// The codes of every channel, the haptic voltage's last.
    pub codes: &'a [i32],
}

impl Demodulator {
    /// The fewest clocks from one sample's start to the next.
    #[inline(always)]
    pub(in crate::blocks) fn clocks(&self) -> u64 {
        self.steps() + 1
    }

    /// The channel that is asked for in a clock of a sample; its steps begin in the clock after its start, number 0.
    #[inline(always)]
    pub(in crate::blocks) fn asks(&self, clock: u64) -> Signal<Clocked> {
        let busy = clock < self.steps();
        self.channel(bit(busy), int(if busy { clock } else { 0 }))
    }

    /// Takes a sample in one step.
    #[inline(never)]
    pub(in crate::blocks) fn take_sample(
        &self,
        state: &mut State<Self, Clocked>,
        sample: &Sample<'_>,
    ) {
        let r = state.load(self);
        let begun = sample.first.select(bit(false), r.clipped);
        let codes = self.signals(sample.codes);
        let clipped = codes.fold(begun, |clipped, code| clipped | self.at_full_scale(code));
        let words = state.submodules.sums.words_mut();
        let r = match &self.polyphase {
            None => self.take_products(r, sample, words),
            Some(polyphase) => self.take_phases(polyphase, r, sample, words),
        };
        state.store(self, Registers { clipped, ..r });
    }

    /// Codes as signals.
    #[inline(always)]
    fn signals(&self, codes: &[i32]) -> impl Iterator<Item = Signal<Clocked>> {
        codes.iter().map(|&code| Signal { value: i64::from(code), format: self.adc })
    }

    /// The codes of the channels that have two sums each, and that of the haptic voltage.
    #[inline(always)]
    fn tones(
        &self,
        sample: &Sample<'_>,
    ) -> (impl Iterator<Item = Signal<Clocked>>, Signal<Clocked>) {
        let (haptic, tones) = sample.codes.split_last().expect("a code of the haptic voltage");
        (self.signals(tones), Signal { value: i64::from(*haptic), format: self.adc })
    }

    /// A sum with one more product.
    #[inline(always)]
    fn add_to(&self, word: &mut i64, begins: Signal<Clocked>, product: Signal<Clocked>) {
        let sum = Signal { value: *word, format: self.sum() };
        *word = self.accumulate(begins, sum, product).value;
    }

    #[inline(always)]
    fn take_products(
        &self,
        r: Regs<Clocked>,
        sample: &Sample<'_>,
        words: &mut [i64],
    ) -> Regs<Clocked> {
        let (&Sample { first, wave, .. }, (tones, haptic)) = (sample, self.tones(sample));
        let operand = |of: Signal<Clocked>| of.align_point(self.operand);
        let product =
            |left, right| self.of_operands(operand(left).integer() * operand(right).integer());
        let windowed = |of, residue| {
            let residue = first.select(self.fresh_residue(), residue);
            self.carry(product(wave.window, of), residue)
        };
        let (cosine, residue) = windowed(wave.cosine, r.residue);
        let (sine, other_residue) = windowed(wave.sine, r.other_residue);
        let share = self.window_product(product(wave.window, haptic));
        let (tone_words, squares) = words.split_at_mut(2 * self.channels as usize);
        for (code, [in_phase, quadrature]) in tones.zip(tone_words.as_chunks_mut().0) {
            self.add_to(in_phase, first, product(code, cosine));
            self.add_to(quadrature, first, product(code, sine));
        }
        self.add_to(&mut squares[0], first, product(haptic, share));
        Registers { residue, other_residue, ..r }
    }

    #[inline(always)]
    fn take_phases(
        &self,
        polyphase: &Polyphase,
        r: Regs<Clocked>,
        sample: &Sample<'_>,
        words: &mut [i64],
    ) -> Regs<Clocked> {
        let (&Sample { first, wave, .. }, (tones, haptic)) = (sample, self.tones(sample));
        let (fresh, window) = (self.fresh(&r, first, wave.phase), self.window_word(wave.window));
        let product = |left: Signal<_>, right: Signal<_>| {
            (left.integer() * right.integer()).scaled(-PRODUCT.frac)
        };
        let place = |channel: u64| {
            let channel = Signal { format: polyphase.channel(), ..int(channel) };
            self.word(wave.phase, channel).value as usize
        };
        for (channel, code) in (0..).zip(tones) {
            self.add_to(&mut words[place(channel)], fresh, product(self.raised(code), window));
        }
        let magnitude = self.magnitude(haptic);
        let share = self.share(product(magnitude, window));
        self.add_to(&mut words[place(self.channels)], first, product(magnitude, share));
        Registers { fresh, ..r }
    }
}
