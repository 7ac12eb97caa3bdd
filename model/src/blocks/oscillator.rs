// SPDX-License-Identifier: MIT OR Apache-2.0
//! Oscillator (NCO): for every sample the cosine and sine of the carrier, and the window.
//!
//! ```text
//! φ[n] = n · periods / samples,   w[n] = sin²(π m / N) = (1 − cos 2π m/N) / 2 for sample m of the window   (turns; Hann)
//! ```
//!
//! ```text
//! phase u32.32 ─quadrant 2─┐
//!              └─address──[quarter wave]──[wave]──(±)── window, then cosine, then sine
//! ```
//!
//! | signal             | format     | unit           | overflow                                  |
//! | phase, window_phase | u32.32    | turn           | wraps, meant                              |
//! | cosine, sine, window | profile  | full amplitude | the table's largest code stands for one |
//!
//! The phase begins anew with each slot, so that every slot sees the same carrier. Entries lie at the middles of their
//! steps, (k + ½) / 4·2^a turns: the wave is symmetric and a constant half step late. Latency: 4 clocks from `sample` to
//! `ready`. Source: PHYSICS §5 (sine table, Hann window).

use crate::block::{Block, Cell};
use crate::format::{BIT, Format};
use crate::memory::Memory;
use crate::profile::{Profile, Window};
use crate::signal::{Exact, HalfEven, Saturate, Signal, Value, Wrap, bit, code, int, zero};
use crate::{bundle, choose, next, parts};
use std::f64::consts::TAU;

bundle! {
    /// The inputs.
    pub struct Inputs {
        /// A sample is there.
        sample,
        /// It is the first of its slot.
        restart,
        /// It is the first of its window.
        first,
    }
}

bundle! {
    /// The outputs.
    pub struct Outputs {
        /// Set for one clock before the other outputs are those of the sample.
        ready,
        /// The cosine of the carrier.
        cosine,
        /// The sine of the carrier.
        sine,
        /// The window.
        window,
    }
}

bundle! {
    /// The registers.
    pub struct Registers {
        step: ["idle", "look_up", "wave", "cosine", "sine"],
        phase, window_phase, looked_up, negative, wave, sign, cosine, sine, window, ready,
    }
}

parts! {
    /// The memory within.
    pub struct Parts of Oscillator {
        quarter: Memory,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct Oscillator {
    quarter: Memory,
    address_bits: u8,
    /// Codes of [`PHASE`]: settings, and so the same in every reading.
    increment: i64,
    window_increment: i64,
    window: Window,
    /// Of the cosine, the sine and the window.
    wave: Format,
}

/// The format of a phase: turns.
const PHASE: Format = Format::unsigned(32, 32);

/// The format of a wave without its sign.
#[inline(always)]
const fn magnitude(wave: Format) -> Format {
    Format { signed: false, width: wave.width - 1, ..wave }
}

impl Oscillator {
    /// Clocks from `sample` to `ready`.
    pub const LATENCY: u64 = 4;

    /// The oscillator of a profile.
    pub fn new(profile: &Profile) -> Self {
        let format = profile.formats.oscillator;
        let address_bits = profile.carrier.quarter_address;
        let entries = 1usize << address_bits;
        let entry = |k| (TAU / 4.0 * (k as f64 + 0.5) / entries as f64).sin();
        // The largest code, not one, is the amplitude: one would not fit.
        let amplitude = 1.0 - format.lsb();
        let table = (0..entries).map(|k| amplitude * entry(k)).collect();
        Oscillator {
            quarter: Memory::table("quarter", magnitude(format), table),
            address_bits,
            increment: PHASE.code_saturating(profile.carrier.turns_per_sample()),
            window_increment: PHASE.code_saturating(1.0 / profile.slot.integrate as f64),
            window: profile.carrier.window,
            wave: format,
        }
    }

    /// Where in the table the sine of a phase lies, and whether it is negative.
    #[inline(always)]
    fn look_up<V: Value>(&self, phase: Signal<V>) -> (Signal<V>, Signal<V>) {
        let index = phase.bits(30 - self.address_bits, self.address_bits);
        let last = int((1 << self.address_bits) - 1);
        let mirrored = (last - index).fit(index.format, Exact, Wrap);
        (phase.bits(30, 1).select(mirrored, index), phase.msb())
    }

    /// The magnitude of the sine of the phase that was looked up.
    #[inline(always)]
    fn magnitude<V: Value>(&self, r: &Registers<Signal<V>>, word: Signal<V>) -> Signal<V> {
        word.ideally(&[r.looked_up], |turns| (TAU * turns[0]).sin().abs())
    }

    /// (1 − cos) / 2, or one throughout.
    #[inline(always)]
    fn weight<V: Value>(&self, cosine: Signal<V>) -> Signal<V> {
        let one = int(1);
        match self.window {
            Window::Hann => (one - cosine).scaled(-1).fit(cosine.format, HalfEven, Saturate),
            Window::Rectangular => one.fit(cosine.format, Exact, Saturate),
        }
    }

    /// The phase of the clock's look-up: the sine of (φ + ¼) is the cosine.
    #[inline(always)]
    fn address_phase<V: Value>(&self, r: &Registers<Signal<V>>, i: &Inputs<Signal<V>>) -> Signal<V> {
        let quarter = code(1 << 30, PHASE);
        let zero = zero(PHASE);
        let begun = (i.sample & i.first).select(zero, r.window_phase);
        let sine = r.step.is(2);
        let phase = (r.step.is(1) | sine).select(r.phase, begun);
        (phase + sine.select(zero, quarter)).fit(PHASE, Exact, Wrap).named("angle")
    }

    /// A sample begins: phases start anew where they should.
    #[inline(always)]
    fn begin<V: Value>(&self, r: Registers<Signal<V>>, i: Inputs<Signal<V>>) -> Registers<Signal<V>> {
        let zero = zero(PHASE);
        Registers {
            step: int(1),
            phase: i.restart.select(zero, r.phase),
            window_phase: i.first.select(zero, r.window_phase),
            ..r
        }
    }

    /// The word of the look-up before is there, and that of the one before it gets its sign.
    #[inline(always)]
    fn step<V: Value>(
        &self,
        r: Registers<Signal<V>>,
        magnitude: Signal<V>,
        negative: Signal<V>,
    ) -> Registers<Signal<V>> {
        let at = |step: u64| r.step.is(step);
        let advance = |phase: Signal<V>, by: i64| (phase + code(by, PHASE)).fit(PHASE, Exact, Wrap);
        let wave = r.sign.select(-r.wave, r.wave).fit(r.sine.format, Exact, Wrap).named("signed_wave");
        let end = at(4);
        Registers {
            step: end.select(int(0), r.step + int(1)).fit(r.step.format, Exact, Wrap),
            phase: end.select(advance(r.phase, self.increment), r.phase),
            window_phase: end.select(advance(r.window_phase, self.window_increment), r.window_phase),
            wave: magnitude,
            sign: negative,
            window: at(2).select(wave, {
                let weighs = at(3);
                choose!(V, weighs, self.weight(r.window), r.window)
            }),
            // The cosine comes first, and moves on: one value, one register that takes it.
            cosine: end.select(r.sine, r.cosine),
            sine: (at(3) | end).select(wave, r.sine),
            ready: at(3),
            ..r
        }
    }
}

impl Block for Oscillator {
    const NAME: &'static str = "oscillator";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = Parts<V>;

    #[inline]
    fn inputs(&self) -> Inputs<Format> {
        Inputs { sample: BIT, restart: BIT, first: BIT }
    }

    #[inline]
    fn outputs(&self) -> Outputs<Format> {
        Outputs { ready: BIT, cosine: self.wave, sine: self.wave, window: self.wave }
    }

    #[inline(always)]
    fn registers(&self) -> Registers<Format> {
        let full = self.wave;
        Registers {
            step: Format::unsigned(3, 0),
            phase: PHASE,
            window_phase: PHASE,
            looked_up: PHASE,
            negative: BIT,
            wave: magnitude(full),
            sign: BIT,
            cosine: full,
            sine: full,
            window: full,
            ready: BIT,
        }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let outputs = Outputs { ready: r.ready, cosine: r.cosine, sine: r.sine, window: r.window };
        let busy = !r.step.is(0);
        if (i.sample | busy | r.ready).idle() {
            return outputs;
        }
        let magnitude = self.magnitude(&r, self.quarter.data(&mut cell.parts.quarter));
        let looked_up = self.address_phase(&r, &i);
        let (address, negative) = self.look_up(looked_up);
        self.quarter.read(&mut cell.parts.quarter, address);
        let quiet = Registers { ready: bit(false), ..r };
        let before = r.negative;
        let r = Registers { looked_up, negative, ..quiet };
        next!(
            V,
            Registers,
            self,
            cell,
            i.sample => self.begin(r, i),
            busy => self.step(r, magnitude, before),
            else quiet
        );
        outputs
    }
}
