// SPDX-License-Identifier: MIT OR Apache-2.0
//! Lock-in demodulator: every channel's in-phase and quadrature sums over a window, and the haptic
//! voltage's mean square.
//!
//! ```text
//! i_k = Σ x_k[n] · (w[n] · cos φ[n]),   q_k = Σ x_k[n] · (w[n] · sin φ[n]),   m = Σ h[n] · (w[n] · h[n])
//! ```
//!
//! ```text
//! window, codes ──┐
//! local oscillator ─(×)─[product]─┬─[windowed: rounded]─[windowed_lo: w·cos, w·sin, w·h]
//!                                 └─(+)─[sum]─[sums: one word per channel and phase]
//! ```
//!
//! One multiplier serves all: three products apply the window (w·cos, w·sin, w·h), two for each
//! channel and one for h follow. What has been made in a clock is stored in the next; the first
//! channel takes the windowed words on their way to their memory.
//!
//! ```text
//! step        0      1      2      3      4      5      6     …  2N+3  2N+4  2N+5      N channels besides h
//! channel     h      h      x0     x0     x1     x1     x2    …                        asked for; its code comes one cycle later
//! operands    w·cos  w·sin  w·h    x0·c   x0·s   x1·c   x1·s  …  h·v                   registers after this step
//! product                   w·cos  w·sin  w·h    x0·c   x0·s  …        …     h·v
//! windowed                  c      s      v                                            in memory two steps later
//! sum                                            i0     q0    …        …     m         given out, and stored, one cycle later
//! ```
//!
//! | signal   | format               | unit               | overflow            |
//! | windowed | ADC's and oscillator's, joined | full scale | cannot (range proof) |
//! | sum      | exact                | full scale · samples | cannot (range proof) |
//!
//! What rounding leaves of w·cos and w·sin is carried to the next sample's, so that the sums of the
//! words are those of the products to half a word, wherever one stops. Rounding then has no share
//! at low frequencies. w·h is rounded half even. A carrier with five samples per period may have
//! its sums by phase instead: see `demodulator/polyphase.rs`.
//!
//! q is positive where the channel lags. The answer to `channel` is expected one cycle later as
//! `code`. Latency: products + 3 clocks from `start` to the last sum. Source: paper, eqs. 1 and 5,
//! detected synchronously; docs/physics.md §5 for the window.

mod at_once;
mod polyphase;

pub(super) use self::at_once::Sample;
pub(crate) use self::polyphase::{GAIN as POLYPHASE_GAIN, Polyphase};
use super::multiplier::{self, Multiplier};
use super::rests::Rests;
use crate::buildable::fits;
use hapticore_contract::profile::{Method, Profile, ProfileError, Window};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format, MAX_WIDTH};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{
    Clocked, Floor, HalfEven, Proved, Signal, Wrap, bit, code, int, is_set, zero,
};
use hapticore_hdl::{block, call, next, when};

block! {
    /// The lock-in demodulator.
    pub struct Demodulator("demodulator") {
        /// Channels with two sums each: the terminals and the sensing voltage. The haptic voltage is the one after.
        pub(super) channels: u64,
        pub(super) adc: Format,
        pub(super) oscillator: Format,
        /// The ADC's largest and smallest codes.
        full_scale: [i64; 2],
        /// Operands of the multiplier, and their product: the point of both is known here.
        pub(super) operand: Format,
        /// Where the sums' point is.
        point: i8,
        channel: Format,
        step: Format,
        index: Format,
        pad: Format,
        /// Where sums are kept by phase: what is particular to that.
        pub(super) polyphase: Option<Polyphase>,
    }
    submodules {
        pub(super) multiplier: Multiplier,
        windowed_lo: Memory,
        pub(super) sums: Memory,
    }
    inputs(demodulator) {
        /// The oscillator's outputs are those of a sample to be integrated.
        start: BIT,
        /// First sample of its window.
        first: BIT,
        /// Last sample of its window.
        last: BIT,
        /// The selected pad.
        pad: demodulator.pad,
        /// The code of the channel that `channel` asked for one cycle earlier.
        code: demodulator.adc,
        /// The oscillator's cosine.
        cosine: demodulator.oscillator,
        /// The oscillator's sine.
        sine: demodulator.oscillator,
        /// The oscillator's window.
        window: demodulator.oscillator,
        /// Polyphase: the number of the carrier's phase.
        phase: demodulator.phase(),
    }
    outputs(demodulator) {
        /// The channel whose code is needed in the next cycle.
        channel: demodulator.channel,
        /// Asserted for one cycle for each finished sum of a window.
        valid: BIT,
        /// The number of the sum: 2k the in-phase and 2k + 1 the quadrature of channel k, the last the mean square.
        index: Format::counter(demodulator.sums() - 1),
        sum: demodulator.sum(),
        /// Pad whose slot the window belongs to.
        pad: demodulator.pad,
        /// A code of the window was at full scale.
        clipped: BIT,
    }
    registers(demodulator) {
        busy: BIT,
        step: demodulator.step.as_uint(),
        first: BIT,
        last: BIT,
        pad: demodulator.pad.as_uint(),
        left: demodulator.operand,
        right: demodulator.operand,
        windowed: demodulator.operand,
        residue: demodulator.residue(),
        other_residue: demodulator.residue(),
        valid: BIT,
        summed: BIT,
        index: demodulator.index.as_uint(),
        sum: demodulator.sum(),
        clipped: BIT,
        fresh: BIT,
        phase: demodulator.phase(),
        reading: BIT,
        beat: polyphase::BEAT,
        tap: polyphase::PHASE,
        high: BIT,
        part: BIT,
        channel: demodulator.channel.as_uint(),
    }
}

/// Products before those of the channels: window times cosine, sine and haptic code.
const WINDOWING: u64 = 3;
/// Clocks from a product's operands to its use.
const PIPELINE: u64 = 2;

impl Demodulator {
    /// The demodulator of a profile.
    ///
    /// # Errors
    /// A window whose sums no word of the model holds.
    pub fn try_new(profile: &Profile) -> Result<Self, ProfileError> {
        let (adc, oscillator) = (profile.formats.adc, profile.formats.oscillator);
        let channels = profile.demodulated();
        let polyphase =
            (profile.carrier.method == Method::Polyphase).then(|| Polyphase::new(profile));
        // Of products with nothing to join, two more are counted.
        let products =
            if polyphase.is_some() { profile.slot.integrate + 2 } else { profile.slot.integrate };
        // A flat window of the most negative haptic code sums to its number of samples: one code more than fits where that
        // is a power of two. Tapered windows sum to less.
        let reached = products - u64::from(profile.carrier.window != Window::Rectangular);
        let growth = 64 - reached.leading_zeros() as u8;
        let operand = if polyphase.is_some() { polyphase::OPERAND } else { adc.join(oscillator) };
        let product =
            if polyphase.is_some() { polyphase::PRODUCT } else { operand.product(operand) };
        let sum = Format::signed(
            product.width - u8::from(product.signed) + growth + u8::from(!product.signed),
            product.frac,
        );
        fits("slot.integrate", "a sum over the window", sum.width)?;
        let sums = 2 * channels + 1;
        let words = polyphase.as_ref().map_or(sums, |polyphase| polyphase.words());
        let steps = if polyphase.is_some() { channels + 2 } else { WINDOWING + sums } + PIPELINE;
        let memory = |name, words: u64, format| {
            Memory::new(name, words.next_power_of_two() as usize, format).dont_care_on_collision()
        };
        Ok(Demodulator {
            // In one clock whatever its width: products keep pace with the channels.
            multiplier: Multiplier::new(operand.integer(), operand.integer(), MAX_WIDTH),
            windowed_lo: memory("windowed_lo", WINDOWING, operand).in_block(),
            sums: memory("sums", words, sum),
            channels,
            adc,
            oscillator,
            full_scale: [adc.max_code(), adc.min_code()].map(|code| code as i64),
            operand,
            point: product.frac,
            channel: Format::counter(channels),
            step: Format::counter(steps - 1),
            index: Format::counter(words.max(sums) - 1),
            pad: Format::counter(profile.pads - 1),
            polyphase,
        })
    }

    /// The format of a sum.
    #[inline(always)]
    pub fn sum(&self) -> Format {
        self.sums.format.assume_frac(self.point)
    }

    /// The sums of a window.
    pub fn sums(&self) -> u64 {
        2 * self.channels + 1
    }

    /// Codes of a sample: one per channel, the haptic voltage's last.
    pub(super) fn codes(&self) -> usize {
        self.channels as usize + 1
    }

    /// What is particular to polyphase sums, where they are used.
    pub(crate) fn polyphase(&self) -> Option<&Polyphase> {
        self.polyphase.as_ref()
    }

    /// Bits by which in-phase and quadrature sums come smaller than the sum of squares does.
    pub fn shift(&self) -> i8 {
        self.polyphase.as_ref().map_or(0, |polyphase| polyphase.dropped as i8)
    }

    /// Clocks from `start` to the last sum's `valid`.
    pub fn latency(&self) -> u64 {
        self.steps()
            + 1
            + if self.polyphase.is_some() { polyphase::read_out(self.channels) } else { 0 }
    }

    /// Clocks from `start` to the first sum's `valid`, at least: polyphase sums are read out after
    /// them.
    pub fn first_sum(&self) -> u64 {
        self.steps() + 1 - if self.polyphase.is_some() { 0 } else { self.sums() - 1 }
    }

    /// The fewest clocks from one sample to the next: the last code is asked for while it is there.
    pub fn least_clocks_per_sample(&self) -> u64 {
        let asks = 2 + if self.polyphase.is_some() { 2 } else { 4 } + self.steps() - PIPELINE;
        asks.max(self.steps() + 1)
    }

    pub(super) fn steps(&self) -> u64 {
        PIPELINE
            + if self.polyphase.is_some() { self.channels + 2 } else { WINDOWING + self.sums() }
    }

    /// The haptic code's share of the window: its product with the window.
    #[inline(always)]
    pub fn window_product<V: Interpretation>(&self, product: Signal<V>) -> Signal<V> {
        product.quantize(self.adc, HalfEven, Proved)
    }

    /// The local oscillator at a sample, windowed: the product to the nearest word, with what the
    /// samples before have left over; and what it leaves to the next. So rounding has no share at
    /// low frequencies.
    #[inline(always)]
    pub fn carry<V: Interpretation>(
        &self,
        product: Signal<V>,
        residue: Signal<V>,
    ) -> (Signal<V>, Signal<V>) {
        let sum = (product + residue).named("carried");
        let word = sum.quantize(self.oscillator, Floor, Proved).golden(&[product], |of| of[0]);
        let rest = sum.bits(0, residue.format.width).scaled(-residue.format.frac);
        (word, rest.golden(&[], |_| 0.0))
    }

    /// What is left over before a window's first sample: half a word, so that words are the
    /// nearest.
    #[inline(always)]
    pub fn fresh_residue<V: Interpretation>(&self) -> Signal<V> {
        let format = self.residue();
        code(1 << (format.width - 1), format)
    }

    /// The format of the number of the carrier's phase.
    #[inline(always)]
    fn phase(&self) -> Format {
        if self.polyphase.is_some() { polyphase::PHASE } else { BIT }
    }

    /// The format of what rounding leaves over.
    #[inline(always)]
    fn residue(&self) -> Format {
        if self.polyphase.is_some() {
            return BIT;
        }
        let frac = 2 * self.operand.frac;
        Format::unsigned((frac - self.oscillator.frac) as u8, frac)
    }

    /// A sum with one more product; a window's first product begins it.
    #[inline(always)]
    pub fn accumulate<V: Interpretation>(
        &self,
        first: Signal<V>,
        sum: Signal<V>,
        product: Signal<V>,
    ) -> Signal<V> {
        let before = first.select(zero(sum.format), sum).named("so_far");
        (before + product).named("accumulated").resize(sum.format, Proved)
    }

    /// Whether a code is at full scale of the ADC.
    #[inline(always)]
    pub fn at_full_scale<V: Interpretation>(&self, code: Signal<V>) -> Signal<V> {
        let [most, least] = self.full_scale;
        code.equals(hapticore_hdl::signal::code(most, code.format))
            | code.equals(hapticore_hdl::signal::code(least, code.format))
    }

    /// The channel whose code the next clock's operand needs, in a step of a sample.
    #[inline(always)]
    fn channel<V: Interpretation>(&self, busy: Signal<V>, step: Signal<V>) -> Signal<V> {
        let (format, haptic) = (self.channel.as_uint(), self.asked(self.channels as usize));
        if self.polyphase.is_some() {
            let asked = step.resize(format, Wrap);
            return (busy & step.less_than(int(self.channels))).select(asked, haptic);
        }
        let ahead = (step - int(WINDOWING - 1)).bits(1, format.width);
        let of_channels = step.at_least(int(WINDOWING - 1))
            & step.less_than(int(WINDOWING - 1 + 2 * self.channels));
        of_channels.select(ahead, haptic)
    }

    /// The output `channel` that asks for this one.
    #[inline(always)]
    pub(super) fn asked<V: Interpretation>(&self, channel: usize) -> Signal<V> {
        code(channel as i64, self.channel.as_uint())
    }

    /// What the multiplier gives of two operands, with the point of their product.
    #[inline(always)]
    fn of_operands<V: Interpretation>(&self, product: Signal<V>) -> Signal<V> {
        let product = product.scaled(-2 * self.operand.frac);
        Signal { format: product.format.assume_frac(self.point), ..product }
    }

    /// The multiplier's operands of this step.
    #[inline(always)]
    fn operands<V: Interpretation>(
        &self,
        r: &Regs<V>,
        i: &In<V>,
        window_word: Signal<V>,
    ) -> (Signal<V>, Signal<V>) {
        let windowing = r.step.less_than(int(WINDOWING)).named("windowing");
        let operand = r.left.format;
        let (code, window) = (i.code.align_point(operand), i.window.align_point(operand));
        let (cosine, sine) = (i.cosine.align_point(operand), i.sine.align_point(operand));
        let wave = r.step.is(0).select(cosine, r.step.is(1).select(sine, code));
        let windowed = r.step.less_than(int(WINDOWING + PIPELINE)).select(r.windowed, window_word);
        (windowing.select(window, code), windowing.select(wave, windowed))
    }

    /// Stores the windowed local oscillator of the cycle before, and asks for that of the next
    /// step.
    #[inline(always)]
    fn windowed_lo<V: Interpretation>(&self, r: &Regs<V>, words: &mut V::Words) -> Signal<V> {
        let format = self.windowed_lo.format.assume_frac(self.operand.frac);
        let window_word = Signal { format, ..self.windowed_lo.data(words) };
        let place = (r.step - int(WINDOWING)).bits(0, Format::counter(WINDOWING - 1).width);
        let enable =
            r.busy & r.step.at_least(int(WINDOWING)) & r.step.less_than(int(2 * WINDOWING));
        let haptic = r.step.is(WINDOWING - 1 + 2 * self.channels);
        let sine = (r.step - int(WINDOWING - 1)).bits(0, 1);
        let wanted = haptic.concat(sine & !haptic);
        self.windowed_lo.access(words, wanted, Write { enable, address: place, data: r.windowed });
        window_word
    }

    /// While products apply the window: the word of this product, of cosine, sine or the haptic
    /// code. The residues of cosine and sine change places with each.
    #[inline(always)]
    fn windowed<V: Interpretation>(&self, r: Regs<V>, product: Signal<V>) -> Regs<V> {
        let of_wave = (r.step.is(PIPELINE) | r.step.is(PIPELINE + 1)).named("of_wave");
        let of_haptic = r.step.is(PIPELINE + WINDOWING - 1);
        let residue = r.first.select(self.fresh_residue(), r.residue);
        let (wave, rest) = self.carry(product, residue);
        let word = |word: Signal<V>| word.resize(r.windowed.format, Proved);
        Registers {
            windowed: when!(of_haptic => word(self.window_product(product)), else word(wave)),
            residue: of_wave.select(r.other_residue, r.residue),
            other_residue: of_wave.select(rest, r.other_residue),
            ..r
        }
    }

    /// Polyphase: whether a sample begins the sums of its phase, as a window's first five do.
    #[inline(always)]
    fn fresh<V: Interpretation>(
        &self,
        r: &Regs<V>,
        first: Signal<V>,
        phase: Signal<V>,
    ) -> Signal<V> {
        first | (r.fresh & !phase.is(0))
    }

    #[inline(always)]
    fn begin<V: Interpretation>(&self, r: Regs<V>, i: In<V>) -> Regs<V> {
        let clipped = i.first.select(bit(false), r.clipped);
        let (fresh, phase) = (self.fresh(&r, i.first, i.phase), i.phase);
        Registers {
            busy: bit(true),
            step: int(0),
            first: i.first,
            last: i.last,
            pad: i.pad,
            clipped,
            fresh,
            phase,
            ..r
        }
    }

    #[inline(always)]
    fn step<V: Interpretation>(
        &self,
        r: Regs<V>,
        i: In<V>,
        index: Signal<V>,
        (product, window_word): (Signal<V>, Signal<V>),
        (sum, summed): (Signal<V>, Signal<V>),
    ) -> Regs<V> {
        let (left, right) = self.operands(&r, &i, window_word);
        let uses_code =
            r.step.at_least(int(WINDOWING - 1)) & r.step.less_than(int(WINDOWING + self.sums()));
        let end = r.step.is(self.steps() - 1);
        let windowing =
            r.step.at_least(int(PIPELINE)) & r.step.less_than(int(PIPELINE + WINDOWING));
        let r = when!(windowing => self.windowed(r, product), else r);
        Registers {
            busy: !end,
            step: end.select(int(0), r.step + int(1)).resize(r.step.format, Proved),
            left,
            right,
            valid: summed & r.last,
            summed,
            index,
            sum,
            clipped: r.clipped | when!(uses_code => self.at_full_scale(i.code), else bit(false)),
            ..r
        }
    }
}

impl Demodulator {
    /// Whether sums of a window are being given, or will be without another sample.
    #[inline(always)]
    pub(super) fn gives_sums(&self, state: &State<Self, Clocked>) -> bool {
        let r = state.load(self);
        is_set(r.valid | r.reading | (r.last & self.under_way(&r)))
    }
}

impl Rests for Demodulator {
    #[inline(always)]
    fn under_way<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        let sample = r.busy | r.summed;
        if self.polyphase.is_some() { sample | r.reading | r.valid } else { sample }
    }
}

impl Block for Demodulator {
    #[inline(never)]
    fn step(&self, state: &mut State<Self, Clocked>, i: In<Clocked>) -> Out<Clocked> {
        self.clock(state, i)
    }

    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        if let Some(polyphase) = &self.polyphase {
            return self.clock_polyphase(polyphase, state, i);
        }
        let r = state.load(self);
        let channel = self.channel(r.busy, r.step);
        let outputs = Outputs {
            channel,
            valid: r.valid,
            index: r.index,
            sum: r.sum,
            pad: r.pad,
            clipped: r.clipped,
        };
        if (i.start | self.under_way(&r)).can_skip() {
            return outputs;
        }
        let place = |ahead: u64| {
            let from_end = r.step - int(WINDOWING + PIPELINE - ahead);
            let in_range = r.step.at_least(int(WINDOWING + PIPELINE - ahead));
            (in_range & r.busy, from_end.bits(0, self.index.width))
        };
        let ((summed, index), (_, next_index)) = (place(0), place(1));
        let inputs =
            multiplier::Inputs { enable: r.busy, left: r.left.integer(), right: r.right.integer() };
        let product = self.of_operands(call!(self.multiplier, state, inputs).product);
        let so_far = Signal { format: self.sum(), ..self.sums.data(&mut state.submodules.sums) };
        let sum = self.accumulate(r.first, so_far, product);
        let write = Write { enable: r.summed, address: r.index, data: r.sum };
        self.sums.access(&mut state.submodules.sums, next_index, write);
        let window_word = self.windowed_lo(&r, &mut state.submodules.windowed_lo);
        let r = Registers { valid: bit(false), summed: bit(false), ..r };
        next!(self, state,
            i.start => self.begin(r, i),
            r.busy => self.step(r, i, index, (product, window_word), (sum, summed)),
            else r
        );
        outputs
    }
}

#[cfg(test)]
mod tests;
