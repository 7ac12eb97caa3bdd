// SPDX-License-Identifier: MIT OR Apache-2.0
//! Oscillator (NCO): for every sample the cosine and sine of the carrier, and the window.
//!
//! ```text
//! φ[n] = n · periods / N,   w[m] = sin²(π m / N) = (1 − cos 2π m/N) / 2 for sample m of the window's N   (turns; Hann)
//! ```
//!
//! ```text
//! phase ─ quadrant ───────┐
//!       └ rest ─(N/4 − )?─[quarter wave]──[wave]──(±)── window, then cosine, then sine
//! ```
//!
//! | signal               | format            | unit           | overflow                            |
//! | quadrant, phase      | 2 bits, 0 … N/4−1 | 1/4, 1/N turn  | counts modulo N                     |
//! | cosine, sine, window | profile           | full amplitude | the profile's amplitude stands for one |
//!
//! A phase counts modulo the window's samples, so that the quarter wave has an entry for each phase that there is, and no
//! other: none is truncated. The bit that the window's halving drops is carried to the next sample. The phase begins anew
//! with each slot, so that every slot sees the same carrier. Latency: 4 clocks from `sample` to `ready`. Source: paper, eq. 5;
//! Harris, Proc. IEEE 66 (1978) 51, for the window.

use crate::block::{Block, Cell};
use crate::format::{BIT, Format};
use crate::memory::Memory;
use crate::profile::{Profile, Window};
use crate::signal::{Exact, Floor, Never, Signal, Value, Wrap, bit, code, int};
use crate::{bundle, next, parts};
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
        quadrant, phase, window_quadrant, window_phase, negative, wave, sign, cosine, sine, window, residue, ready,
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
    /// The carrier's step from sample to sample: quadrants, and steps of a window's part.
    step: [u64; 2],
    window: Window,
    amplitude: i64,
    /// Of the cosine, the sine and the window.
    wave: Format,
}

/// A phase: its quadrant, and how far into that it is in steps of a window's part of a turn.
type Phase<V> = [Signal<V>; 2];

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
        let (format, quarter) = (profile.formats.oscillator, profile.slot.integrate / 4);
        let entry = |k| profile.amplitude() * (TAU / 4.0 * k as f64 / quarter as f64).sin();
        Oscillator {
            quarter: Memory::table("quarter", magnitude(format), (0..=quarter).map(entry).collect()),
            step: [profile.carrier.periods / quarter, profile.carrier.periods % quarter],
            window: profile.carrier.window,
            amplitude: profile.carrier.amplitude as i64,
            wave: format,
        }
    }

    /// Steps of a quadrant.
    #[inline(always)]
    fn steps(&self) -> u64 {
        self.quarter.words as u64 - 1
    }

    /// The format of a phase within its quadrant.
    #[inline(always)]
    fn quarter_phase(&self) -> Format {
        Format::counter(self.steps() - 1)
    }

    /// Where in the table the sine of a phase lies, and whether it is negative.
    #[inline(always)]
    fn look_up<V: Value>(&self, [quadrant, phase]: Phase<V>) -> (Signal<V>, Signal<V>) {
        let mirrored = (int(self.steps()) - phase).fit(self.quarter.address(), Exact, Never);
        (quadrant.bits(0, 1).select(mirrored, phase), quadrant.msb())
    }

    /// A phase further on by a step.
    #[inline(always)]
    fn advance<V: Value>(&self, [quadrant, phase]: Phase<V>, [quadrants, steps]: [u64; 2]) -> Phase<V> {
        let sum = phase + int(steps);
        let over = sum.at_least(int(self.steps()));
        let rest = (sum - int(self.steps())).fit(phase.format, Exact, Wrap);
        let carried = over.select(int(quadrants + 1), int(quadrants));
        let quadrant = (quadrant + carried).fit(quadrant.format, Exact, Wrap);
        [quadrant, over.select(rest, sum.fit(phase.format, Exact, Wrap))]
    }

    /// (1 − cos) / 2 and what the halving drops, or one throughout.
    #[inline(always)]
    fn weight<V: Value>(&self, cosine: Signal<V>, residue: Signal<V>) -> (Signal<V>, Signal<V>) {
        let one = code(self.amplitude, magnitude(self.wave));
        let twice = (one - cosine).named("twice");
        let sum = twice + residue.scaled(-self.wave.frac);
        match self.window {
            Window::Hann => {
                let half = sum.scaled(-1).fit(cosine.format, Floor, Never).ideally(&[twice], |of| of[0] / 2.0);
                (half, sum.bits(0, 1))
            }
            Window::Rectangular => (one, residue),
        }
    }

    /// The phase of the clock's look-up: the sine of (φ + ¼) is the cosine.
    #[inline(always)]
    fn address_phase<V: Value>(&self, r: &Registers<Signal<V>>, i: &Inputs<Signal<V>>) -> Phase<V> {
        let begins = i.sample & i.first;
        let of = |carrier: Signal<V>, window: Signal<V>| {
            let begun = begins.select(int(0), window);
            (r.step.is(1) | r.step.is(2)).select(carrier, begun)
        };
        let quadrant = of(r.quadrant, r.window_quadrant);
        let turned = (quadrant + int(1)).fit(quadrant.format, Exact, Wrap);
        [r.step.is(2).select(quadrant, turned), of(r.phase, r.window_phase)]
    }

    /// A sample begins: phases start anew where they should.
    #[inline(always)]
    fn begin<V: Value>(&self, r: Registers<Signal<V>>, i: Inputs<Signal<V>>) -> Registers<Signal<V>> {
        let anew = |bit: Signal<V>, phase: Signal<V>| bit.select(int(0), phase);
        Registers {
            step: int(1),
            quadrant: anew(i.restart, r.quadrant),
            phase: anew(i.restart, r.phase),
            window_quadrant: anew(i.first, r.window_quadrant),
            window_phase: anew(i.first, r.window_phase),
            residue: i.first.select(bit(false), r.residue),
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
        let end = at(4);
        let advanced = |phase: Phase<V>, step: [u64; 2]| {
            let [quadrant, rest] = self.advance(phase, step);
            [end.select(quadrant, phase[0]), end.select(rest, phase[1])]
        };
        let [quadrant, phase] = advanced([r.quadrant, r.phase], self.step);
        let [window_quadrant, window_phase] = advanced([r.window_quadrant, r.window_phase], [0, 1]);
        let wave = r.sign.select(-r.wave, r.wave).fit(r.sine.format, Exact, Wrap).named("signed_wave");
        let (weight, residue) = self.weight(r.window, r.residue);
        Registers {
            step: end.select(int(0), r.step + int(1)).fit(r.step.format, Exact, Wrap),
            quadrant,
            phase,
            window_quadrant,
            window_phase,
            wave: magnitude,
            sign: negative,
            window: at(2).select(wave, at(3).select(weight, r.window)),
            residue: at(3).select(residue, r.residue),
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
            quadrant: Format::unsigned(2, 0),
            phase: self.quarter_phase(),
            window_quadrant: Format::unsigned(2, 0),
            window_phase: self.quarter_phase(),
            negative: BIT,
            wave: magnitude(full),
            sign: BIT,
            cosine: full,
            sine: full,
            window: full,
            residue: BIT,
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
        let magnitude = self.quarter.data(&mut cell.parts.quarter);
        let (address, negative) = self.look_up(self.address_phase(&r, &i));
        self.quarter.read(&mut cell.parts.quarter, address);
        let quiet = Registers { ready: bit(false), ..r };
        let before = r.negative;
        let r = Registers { negative, ..quiet };
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
