// SPDX-License-Identifier: MIT OR Apache-2.0
//! Polyphase sums: a sum a channel and phase of a carrier with five samples per period; its cosine
//! and sine come last.
//!
//! ```text
//! S_p = Σ w[n]·(x[n] + 1) over the samples of phase p,   i = Σ c_p·S_p,   q = Σ s_p·S_p      (c_p, s_p: 16 bits and a sign)
//! ```
//!
//! ```text
//! window, code + 1 ─(×)─[product]─(+)─[sum]─[sums: one word a phase and channel]
//!                     16 bits of a sum, c_p or s_p ─(×)─[product]─(+)─[sum]─ i, q
//! ```
//!
//! Both factors of a product are unsigned, as one hardware multiplier of 16 × 16 bits takes them.
//! Codes are moved up by one full scale for that, which leaves nothing in i and q: the window
//! windows all phases alike, and the c_p, as the s_p, have no sum. A sum is multiplied 16 bits
//! after 16 bits; a negative c_p takes what is missing to 16 ones instead, and what that adds is
//! known. Where i and q are formed costs no time that anybody waits for: the next pad has yet to
//! settle.
//!
//! | signal  | format          | unit                 | overflow             |
//! | operand | u16             | –                    | cannot (range proof) |
//! | S_p     | exact           | full scale · samples | cannot (range proof) |
//! | i, q    | 2^-dropped S_p  | full scale · samples | cannot (range proof) |

use super::{Demodulator, In, Out, Outputs, PIPELINE, Registers, Regs};
use crate::blocks::multiplier;
use crate::blocks::oscillator::PHASES;
use crate::blocks::rests::Rests;
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Interpretation, State};
use hapticore_hdl::format::Format;
use hapticore_hdl::memory::Write;
use hapticore_hdl::signal::{Floor, HalfEven, Proved, Signal, Wrap, bit, code, int, zero};
use hapticore_hdl::{call, next, when};

/// The multiplier's operands: unsigned integers.
pub(super) const OPERAND: Format = Format::unsigned(LIMB, 0);
/// A window's word times a code.
pub(super) const PRODUCT: Format = Format::unsigned(2 * LIMB, 31);
pub(super) const PHASE: Format = Format::counter(PHASES - 1);
pub(super) const BEAT: Format = Format::counter(BEATS - 1);
/// A code of the ADC, moved up by its full scale, and its magnitude.
const UNSIGNED: Format = Format::unsigned(LIMB, 15);
/// A window's word.
const WINDOW: Format = Format::unsigned(LIMB, 16);
const LIMB: u8 = 16;
/// Clocks of a product of the read-out: address, operands, product, sum.
const BEATS: u64 = 4;

/// Cosine and sine of the five phases, times 57230. Of all even numbers below 2^16, 57230 brings
/// these nearest to whole numbers, with the cosines' sum zero and the negative ones' sum a multiple
/// of four.
const WAVES: [[i64; PHASES as usize]; 2] =
    [[57230, 17685, -46300, -46300, 17685], [0, 54429, 33639, -33639, -54429]];
/// What the waves have for one.
pub(crate) const GAIN: f64 = 57230.0 / 65536.0;

/// Clocks from the sums of a window's last sample to the last of its results.
pub(super) fn read_out(channels: u64) -> u64 {
    BEATS * (channels * 4 * PHASES + 1)
}

/// What is particular to polyphase sums.
#[derive(Debug, Clone)]
pub(crate) struct Polyphase {
    /// Bits below the 32 of a sum that are read out.
    pub dropped: u8,
    /// Bits of a channel's number.
    channel_bits: u8,
}

impl Polyphase {
    /// That of a profile.
    pub fn new(profile: &Profile) -> Self {
        let most =
            2.0 * profile.carrier.window.mean() * profile.slot.integrate as f64 / PHASES as f64;
        let width = 31 + most.log2().ceil() as u8;
        let channel_bits = Format::counter(profile.demodulated()).width;
        Polyphase { dropped: width.saturating_sub(2 * LIMB), channel_bits }
    }

    /// The format of a channel's number.
    #[inline(always)]
    pub(super) fn channel(&self) -> Format {
        Format::unsigned(self.channel_bits, 0)
    }

    /// By what a sample of the window joins the in-phase and quadrature results.
    pub fn waves(&self, sample: usize) -> [f64; 2] {
        WAVES.map(|wave| {
            wave[sample % PHASES as usize] as f64
                * 2f64.powi(-i32::from(LIMB) - i32::from(self.dropped))
        })
    }

    /// Words of the sums: for each phase a channel, and the sum of squares beside the first.
    pub fn words(&self) -> u64 {
        PHASES << self.channel_bits
    }
}

/// The wave's magnitude by which a phase's sum is multiplied for the in-phase or the quadrature
/// part, and whether it is negative.
#[inline(always)]
fn wave<V: Interpretation>(part: Signal<V>, tap: Signal<V>) -> (Signal<V>, Signal<V>) {
    let of = |part: usize| {
        let magnitude = |tap: usize| code(WAVES[part][tap].abs(), OPERAND);
        let outer = (tap.is(1) | tap.is(4)).select(magnitude(1), magnitude(2));
        tap.is(0).select(magnitude(0), outer)
    };
    let negative_cosine = tap.is(2) | tap.is(3);
    let negative_sine = tap.is(3) | tap.is(4);
    (part.select(of(1), of(0)), part.select(negative_sine, negative_cosine))
}

impl Demodulator {
    /// A code moved up by its full scale.
    #[inline(always)]
    pub(crate) fn raised<V: Interpretation>(&self, code: Signal<V>) -> Signal<V> {
        (code + int(1)).resize(UNSIGNED, Proved)
    }

    /// The magnitude of a code.
    #[inline(always)]
    pub(crate) fn magnitude<V: Interpretation>(&self, code: Signal<V>) -> Signal<V> {
        code.abs().resize(UNSIGNED, Proved)
    }

    /// A window's word.
    #[inline(always)]
    pub(crate) fn window_word<V: Interpretation>(&self, window: Signal<V>) -> Signal<V> {
        window.resize(WINDOW, Proved)
    }

    /// The haptic code's share of the window.
    #[inline(always)]
    pub(crate) fn share<V: Interpretation>(&self, product: Signal<V>) -> Signal<V> {
        product.quantize(WINDOW, HalfEven, Proved)
    }

    /// In-phase and quadrature sums from those of the phases.
    pub(crate) fn combine<V: Interpretation>(
        &self,
        polyphase: &Polyphase,
        sums: [Signal<V>; PHASES as usize],
    ) -> [Signal<V>; 2] {
        [bit(false), bit(true)].map(|part| {
            let mut sum = zero(self.sum());
            for high in [bit(false), bit(true)] {
                for (tap, &phase) in (0..).zip(&sums) {
                    let tap = int(tap);
                    let (magnitude, negative) = wave(part, tap);
                    let product = self.limb(polyphase, phase, high, negative) * magnitude;
                    sum =
                        self.add(self.carried(sum, tap, high, part), product.scaled(-PRODUCT.frac));
                }
            }
            sum
        })
    }

    /// Sixteen bits of a phase's sum, or what they lack to all ones.
    #[inline(always)]
    fn limb<V: Interpretation>(
        &self,
        polyphase: &Polyphase,
        sum: Signal<V>,
        high: Signal<V>,
        negative: Signal<V>,
    ) -> Signal<V> {
        let upper = sum.bits(polyphase.dropped + LIMB, LIMB);
        let whole = sum.scaled(sum.format.frac - polyphase.dropped as i8);
        let lower =
            sum.bits(polyphase.dropped, LIMB).golden(&[whole, upper], |of| of[0] - of[1] * 65536.0);
        let limb = high.select(upper, lower).named("limb");
        negative.select((int(65535) - limb).resize(OPERAND, Proved), limb)
    }

    /// What a product of the read-out is added to: nothing, the sum of the lower halves' products
    /// less what negative waves add, or the sum so far.
    #[inline(always)]
    fn carried<V: Interpretation>(
        &self,
        sum: Signal<V>,
        tap: Signal<V>,
        high: Signal<V>,
        part: Signal<V>,
    ) -> Signal<V> {
        let format = self.sum();
        let shifted = sum.scaled(-(LIMB as i8));
        let above = shifted
            .quantize(Format::unsigned(18, format.frac), Floor, Wrap)
            .golden(&[shifted], |of| of[0]);
        let added = |part: usize| WAVES[part].iter().filter(|&&wave| wave < 0).sum::<i64>() << LIMB;
        let [cosine, sine] = [0, 1].map(|part| code(added(part), format));
        let carried = (above + part.select(sine, cosine)).named("carried").resize(format, Proved);
        tap.is(0).select(high.select(carried, zero(format)), sum)
    }

    /// A sum with one more product.
    #[inline(always)]
    pub(crate) fn add<V: Interpretation>(&self, sum: Signal<V>, product: Signal<V>) -> Signal<V> {
        (sum + product).named("accumulated").resize(self.sum(), Proved)
    }

    /// The operands of a sample's products: haptic code and window, each channel and the window,
    /// haptic code and its share.
    #[inline(always)]
    fn sample_operands<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> (Signal<V>, Signal<V>) {
        let haptic = r.step.is(0) | r.step.is(self.channels + 1);
        let left = haptic.select(self.magnitude(i.code), self.raised(i.code));
        let right = r
            .step
            .is(self.channels + 1)
            .select(r.windowed.scaled(-WINDOW.frac), self.window_word(i.window));
        (left.integer(), right.integer())
    }

    /// A clock of a sample: the product of the clock before last joins its sum.
    #[inline(always)]
    fn sample<V: Interpretation>(
        &self,
        r: Regs<V>,
        i: In<V>,
        product: Signal<V>,
        sum: Signal<V>,
        index: Signal<V>,
    ) -> Regs<V> {
        let (left, right) = self.sample_operands(&r, &i);
        let end = r.step.is(self.steps() - 1);
        let windows = r.step.is(PIPELINE);
        let uses_code = r.step.less_than(int(self.channels + 2));
        Registers {
            busy: !end,
            reading: end & r.last,
            step: end.select(int(0), r.step + int(1)).resize(r.step.format, Proved),
            left,
            right,
            windowed: when!(windows => self.share(product).integer(), else r.windowed),
            summed: !(windows | r.step.less_than(int(PIPELINE))),
            index,
            sum,
            clipped: r.clipped | when!(uses_code => self.at_full_scale(i.code), else bit(false)),
            ..r
        }
    }

    /// A clock of the read-out: a product takes four, a result twice as many products as there are
    /// phases.
    #[inline(always)]
    fn read<V: Interpretation>(
        &self,
        polyphase: &Polyphase,
        r: Regs<V>,
        word: Signal<V>,
        sum: Signal<V>,
    ) -> Regs<V> {
        let square = r.channel.is(self.channels);
        let (magnitude, negative) = wave(r.part, r.tap);
        let end = r.beat.is(BEATS - 1);
        let result = ((r.tap.is(PHASES - 1) & r.high) | square).named("result");
        let tap = r.tap.is(PHASES - 1).select(int(0), r.tap + int(1)).resize(r.tap.format, Proved);
        let turns = |bit: Signal<V>, by: Signal<V>| (bit & !by) | (by & !bit);
        let high = turns(r.high, r.tap.is(PHASES - 1));
        // Of the sum of squares one product is made, with the quadrature's first wave: zero.
        let last_channel = r.channel.is(self.channels - 1);
        let part = turns(r.part, result) | (last_channel & r.part);
        let channel = (r.channel + (result & r.part)).resize(r.channel.format, Wrap);
        let place = r.channel.concat(r.part & !square);
        let index = place.resize(r.index.format, Proved);
        let loads = r.beat.is(1);
        let after = |ends: Signal<V>, now: Signal<V>| end.select(ends, now);
        Registers {
            beat: r.beat.increment(),
            tap: after(square.select(int(0), tap).resize(r.tap.format, Proved), r.tap),
            high: after(high & !square, r.high),
            part: after(part & !square, r.part),
            channel: after(
                square.select(int(0), channel).resize(r.channel.format, Proved),
                r.channel,
            ),
            left: loads.select(self.limb(polyphase, word, r.high, negative), r.left),
            right: loads.select(magnitude, r.right),
            sum: end.select(sum, r.sum),
            index: end.select(index, r.index),
            valid: end & result,
            reading: !(end & square),
            ..r
        }
    }

    /// A clock of a demodulator with polyphase sums.
    #[inline(always)]
    pub(super) fn clock_polyphase<V: Interpretation>(
        &self,
        polyphase: &Polyphase,
        state: &mut State<Demodulator, V>,
        i: In<V>,
    ) -> Out<V> {
        let r = state.load(self);
        let outputs = Outputs {
            channel: self.channel(r.busy, r.step),
            valid: r.valid,
            index: self.result(&r),
            sum: r.sum,
            pad: r.pad,
            clipped: r.clipped,
        };
        if (i.start | self.under_way(&r)).can_skip() {
            return outputs;
        }
        let inputs =
            multiplier::Inputs { enable: r.busy | r.reading, left: r.left, right: r.right };
        let product = call!(self.multiplier, state, inputs).product;
        let word = Signal { format: self.sum(), ..self.sums.data(&mut state.submodules.sums) };
        let square = r.channel.is(self.channels);
        let begun = r.step.is(self.steps() - 1).select(r.first, r.fresh) & !r.reading;
        let so_far = begun.select(zero(word.format), word);
        let so_far = (r.reading & !square)
            .select(self.carried(r.sum, r.tap, r.high, r.part), so_far)
            .named("so_far");
        let sum = self.add(so_far, product.scaled(-PRODUCT.frac));
        // The place of the sum that the product after the next belongs to, and of that which this
        // belongs to.
        let place = |ahead: u64| self.place(polyphase, &r, ahead);
        let reads = r.tap.concat(r.channel);
        let address = r.reading.select(reads, place(1));
        let write = Write { enable: r.summed, address: r.index, data: r.sum };
        self.sums.access(&mut state.submodules.sums, address, write);
        let index = place(0);
        let quiet = Registers { valid: bit(false), summed: bit(false), ..r };
        next!(self, state,
            i.start => self.begin(quiet, i),
            r.busy => self.sample(quiet, i, product.scaled(-PRODUCT.frac), sum, index),
            r.reading => self.read(polyphase, quiet, word, sum),
            else quiet
        );
        outputs
    }

    /// The index of a result.
    #[inline(always)]
    fn result<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        r.index.bits(0, Format::counter(self.sums() - 1).width)
    }

    /// Where the sum of a product lies, whose step is `ahead` after this one; anywhere where there
    /// is none.
    #[inline(always)]
    fn place<V: Interpretation>(
        &self,
        polyphase: &Polyphase,
        r: &Regs<V>,
        ahead: u64,
    ) -> Signal<V> {
        // The first channel's product is the second; it joins its sum two steps later.
        let channel = (r.step - int(PIPELINE + 1 - ahead)).bits(0, polyphase.channel_bits);
        self.word(r.phase, channel)
    }

    /// Where the sum of a phase and channel lies; that of squares is beside the first phase's.
    #[inline(always)]
    pub(super) fn word<V: Interpretation>(
        &self,
        phase: Signal<V>,
        channel: Signal<V>,
    ) -> Signal<V> {
        let square = channel.is(self.channels);
        square.select(int(0), phase).resize(PHASE, Proved).concat(channel)
    }
}
