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
//! A phase counts modulo the window's samples, so that the quarter wave has an entry for each phase
//! that there is, and no other: none is truncated. The bit that the window's halving drops is
//! carried to the next sample. The phase begins anew with each slot, so that every slot sees the
//! same carrier.
//!
//! A polyphase demodulator needs the window and the number of the phase only: the table then holds
//! half a window, whose other half is its mirror image, and the carrier is one of five constants.
//!
//! Latency: 4 clocks from `sample` to `ready`, polyphase 2. Source: paper, eq. 5; Harris, Proc.
//! IEEE 66 (1978) 51, for the window.

use super::rests::Rests;
use hapticore_contract::profile::{Method, Profile, Window};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::Memory;
use hapticore_hdl::signal::{Clocked, Floor, Proved, Signal, Wrap, bit, code, int, is_set, zero};
use hapticore_hdl::states::States;
use hapticore_hdl::{block, next, states};
use std::f64::consts::TAU;

states! {
    /// The steps of a sample; polyphase, the first two.
    pub enum Step {
        Idle, LookUp, Wave, Cosine, Sine,
    }
}

block! {
    /// The numerically controlled oscillator, and the window.
    pub struct Oscillator("oscillator") {
        /// The carrier's step from sample to sample: quadrants, and steps of a window's part.
        step: [u64; 2],
        window: Window,
        /// Samples of the window.
        samples: u64,
        polyphase: bool,
        /// Polyphase: the carrier's codes at its phases 0, 1 and 2; phases 4 and 3 are as 1 and 2.
        carrier: [i64; 3],
        amplitude: i64,
        /// Of the cosine, the sine and the window.
        wave: Format,
    }
    submodules {
        quarter: Memory,
    }
    inputs(oscillator) {
        /// A sample is valid.
        sample: BIT,
        /// First sample of its slot: the carrier restarts.
        restart: BIT,
        /// First sample of its window.
        first: BIT,
    }
    outputs(oscillator) {
        /// Asserted for one cycle before the other outputs are those of the sample.
        ready: BIT,
        /// Cosine of the carrier, fraction of its amplitude.
        cosine: oscillator.wave,
        /// Sine of the carrier, fraction of its amplitude.
        sine: oscillator.wave,
        /// Window value, from 0 to 1.
        window: oscillator.wave,
        /// Polyphase: carrier phase of the sample, 0 to 4.
        phase: if oscillator.polyphase { POLYPHASE } else { BIT },
    }
    registers(oscillator) {
        step in Step,
        quadrant: QUADRANT,
        phase: if oscillator.polyphase { POLYPHASE } else { oscillator.quarter_phase() },
        window_quadrant: QUADRANT,
        window_phase: oscillator.window_phase(),
        negative: BIT,
        wave: magnitude(oscillator.wave),
        sign: BIT,
        cosine: oscillator.wave,
        sine: oscillator.wave,
        window: oscillator.wave,
        residue: BIT,
        ready: BIT,
    }
}

const QUADRANT: Format = Format::unsigned(2, 0);
const POLYPHASE: Format = Format::counter(PHASES - 1);

/// Phases of a polyphase demodulator's carrier.
pub const PHASES: u64 = 5;

/// A phase: its quadrant, and how far into that it is in steps of a window's part of a turn.
type Phase<V> = [Signal<V>; 2];

/// The sine of a quarter turn, an entry for each step of a window's part.
fn quarter_wave(profile: &Profile) -> Vec<f64> {
    let quarter = profile.slot.integrate / 4;
    (0..=quarter)
        .map(|k| (TAU / 4.0 * k as f64 / quarter as f64).sin())
        .map(|sine| profile.amplitude() * exact_quarters(sine))
        .collect()
}

/// The first half of the window, its middle among it.
fn half_window(profile: &Profile) -> Vec<f64> {
    let samples = profile.slot.integrate;
    let window_value = |m: u64| match profile.carrier.window {
        Window::Hann => exact_quarters((TAU / 2.0 * m as f64 / samples as f64).sin().powi(2)),
        Window::Rectangular => 1.0,
    };
    (0..=samples / 2).map(|m| profile.amplitude() * window_value(m)).collect()
}

/// The sine of a rational part of a turn, or its square, exactly where it is a multiple of a quarter: its
/// only rational values (Niven's theorem). An amplitude times ¼, ½ or ¾ may be half way between two
/// words, which the last bit of an `f64` must not decide.
fn exact_quarters(value: f64) -> f64 {
    let quarters = (4.0 * value).round() / 4.0;
    if (value - quarters).abs() < 1e-14 { quarters } else { value }
}

/// The format of a wave without its sign.
#[inline(always)]
const fn magnitude(wave: Format) -> Format {
    Format { signed: false, width: wave.width - 1, ..wave }
}

impl Oscillator {
    /// Clocks from `sample` to `ready`.
    pub fn latency(&self) -> u64 {
        let last = if self.polyphase { Step::LookUp } else { Step::Cosine };
        last.code() + 1
    }

    /// The oscillator of a profile.
    pub fn new(profile: &Profile) -> Self {
        let (format, quarter) = (profile.formats.oscillator, profile.slot.integrate / 4);
        let polyphase = profile.carrier.method == Method::Polyphase;
        let table = if polyphase { half_window(profile) } else { quarter_wave(profile) };
        Oscillator {
            quarter: Memory::table("quarter", magnitude(format), table),
            samples: profile.slot.integrate,
            polyphase,
            carrier: [0.0, 1.0, 2.0]
                .map(|k| format.code_saturating((TAU * k / PHASES as f64).cos())),
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

    /// The format of the register that counts through the window.
    #[inline(always)]
    fn window_phase(&self) -> Format {
        if self.polyphase { Format::counter(self.samples - 1) } else { self.quarter_phase() }
    }

    /// Where in the table the sine of a phase lies, and whether it is negative.
    #[inline(always)]
    fn look_up<V: Interpretation>(&self, [quadrant, phase]: Phase<V>) -> (Signal<V>, Signal<V>) {
        let mirrored = (int(self.steps()) - phase).resize(self.quarter.address(), Proved);
        (quadrant.bits(0, 1).select(mirrored, phase), quadrant.msb())
    }

    /// A phase further on by a step.
    #[inline(always)]
    fn advance<V: Interpretation>(
        &self,
        [quadrant, phase]: Phase<V>,
        [quadrants, steps]: [u64; 2],
    ) -> Phase<V> {
        let sum = phase + int(steps);
        let over = sum.at_least(int(self.steps()));
        let rest = (sum - int(self.steps())).resize(phase.format, Wrap);
        let carried = over.select(int(quadrants + 1), int(quadrants));
        let quadrant = (quadrant + carried).resize(quadrant.format, Wrap);
        [quadrant, over.select(rest, sum.resize(phase.format, Wrap))]
    }

    /// The phase, further on by a step where a sample ends.
    #[inline(always)]
    fn advanced<V: Interpretation>(
        &self,
        end: Signal<V>,
        phase: Phase<V>,
        step: [u64; 2],
    ) -> Phase<V> {
        let [quadrant, rest] = self.advance(phase, step);
        [end.select(quadrant, phase[0]), end.select(rest, phase[1])]
    }

    /// (1 − cos) / 2 and what the halving drops, or one throughout.
    #[inline(always)]
    fn window_value<V: Interpretation>(
        &self,
        cosine: Signal<V>,
        residue: Signal<V>,
    ) -> (Signal<V>, Signal<V>) {
        let one = code(self.amplitude, magnitude(self.wave));
        let twice = (one - cosine).named("twice");
        let sum = twice + residue.scaled(-self.wave.frac);
        match self.window {
            Window::Hann => {
                let half = sum
                    .scaled(-1)
                    .quantize(cosine.format, Floor, Proved)
                    .golden(&[twice], |of| of[0] / 2.0);
                (half, sum.bits(0, 1))
            }
            Window::Rectangular => (one, residue),
        }
    }

    /// The phase of the clock's look-up: the sine of (φ + ¼) is the cosine.
    #[inline(always)]
    fn address_phase<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> Phase<V> {
        let begins = i.sample & i.first;
        let of_carrier = r.step.at(Step::LookUp) | r.step.at(Step::Wave);
        let window_quadrant = begins.select(int(0), r.window_quadrant);
        let window_phase = begins.select(int(0), r.window_phase);
        let quadrant = of_carrier.select(r.quadrant, window_quadrant);
        let turned = quadrant.increment();
        [r.step.at(Step::Wave).select(quadrant, turned), of_carrier.select(r.phase, window_phase)]
    }

    /// Polyphase: a sample begins, with the next phase and the next place in the window.
    #[inline(always)]
    fn begin_polyphase<V: Interpretation>(&self, r: Regs<V>, i: In<V>) -> Regs<V> {
        let next = |anew: Signal<V>, count: Signal<V>, last: u64| {
            (anew | count.is(last)).select(int(0), count.increment())
        };
        Registers {
            step: Step::LookUp.signal(),
            phase: next(i.restart, r.phase, PHASES - 1),
            window_phase: next(i.first, r.window_phase, self.samples - 1),
            ..r
        }
    }

    /// Polyphase: the word of the window's place, or of its mirror image, is looked up; one cycle
    /// later it is there.
    #[inline(always)]
    fn clock_polyphase<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let window = self.quarter.data(&mut state.submodules.quarter).resize(self.wave, Proved);
        let Registers { ready, phase, .. } = r;
        let (cosine, sine) = (self.carrier(phase), zero(self.wave));
        let outputs = Outputs { ready, cosine, sine, window, phase };
        let busy = !r.step.at(Step::Idle);
        if (i.sample | busy | r.ready).can_skip() {
            return outputs;
        }
        let mirrored = (int(self.samples) - r.window_phase).resize(self.quarter.address(), Wrap);
        let first_half = r.window_phase.less_than(int(self.quarter.words as u64));
        let place = r.window_phase.resize(self.quarter.address(), Wrap);
        self.quarter.read(&mut state.submodules.quarter, first_half.select(place, mirrored));
        let r = Registers { step: Step::Idle.signal(), ready: busy, ..r };
        next!(self, state, i.sample => self.begin_polyphase(r, i), else r);
        outputs
    }

    /// Polyphase: the carrier at a phase.
    #[inline(always)]
    fn carrier<V: Interpretation>(&self, phase: Signal<V>) -> Signal<V> {
        let [first, second, third] = self.carrier.map(|wave| code(wave, self.wave));
        phase.is(0).select(first, (phase.is(1) | phase.is(4)).select(second, third))
    }

    /// A sample begins: phases start anew where they should.
    #[inline(always)]
    fn begin<V: Interpretation>(&self, r: Regs<V>, i: In<V>) -> Regs<V> {
        let anew = |bit: Signal<V>, phase: Signal<V>| bit.select(int(0), phase);
        Registers {
            step: Step::LookUp.signal(),
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
    fn step<V: Interpretation>(
        &self,
        r: Regs<V>,
        magnitude: Signal<V>,
        negative: Signal<V>,
    ) -> Regs<V> {
        use Step::*;
        let at = |step: Step| r.step.at(step);
        let end = at(Sine);
        let [quadrant, phase] = self.advanced(end, [r.quadrant, r.phase], self.step);
        let [window_quadrant, window_phase] =
            self.advanced(end, [r.window_quadrant, r.window_phase], [0, 1]);
        let wave = r.sign.select(-r.wave, r.wave).resize(r.sine.format, Wrap).named("signed_wave");
        let (window_value, residue) = self.window_value(r.window, r.residue);
        Registers {
            step: end.select(Idle.signal(), r.step + int(1)).resize(r.step.format, Wrap),
            quadrant,
            phase,
            window_quadrant,
            window_phase,
            wave: magnitude,
            sign: negative,
            window: at(Wave).select(wave, at(Cosine).select(window_value, r.window)),
            residue: at(Cosine).select(residue, r.residue),
            // The cosine comes first, and moves on: one value, one register that takes it.
            cosine: end.select(r.sine, r.cosine),
            sine: (at(Cosine) | end).select(wave, r.sine),
            ready: at(Cosine),
            ..r
        }
    }
}

impl Oscillator {
    /// A clock of a sample in progress, with code of its own for each step: in each copy the compiler sees how little
    /// that is.
    #[inline(always)]
    pub(super) fn clock_step(
        &self,
        state: &mut State<Self, Clocked>,
        i: In<Clocked>,
    ) -> Out<Clocked> {
        macro_rules! copies {
            ($($step:ident)*) => {
                $(if is_set(state.load(self).step.at(Step::$step)) {
                    state.registers.step = Step::$step.code() as i64;
                    return self.clock(state, i);
                })*
            };
        }
        copies!(LookUp Wave Cosine Sine);
        self.clock(state, i)
    }
}

impl Rests for Oscillator {
    #[inline(always)]
    fn under_way<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        !r.step.at(Step::Idle) | r.ready
    }
}

impl Block for Oscillator {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        if self.polyphase {
            return self.clock_polyphase(state, i);
        }
        let r = state.load(self);
        let outputs = Outputs {
            ready: r.ready,
            cosine: r.cosine,
            sine: r.sine,
            window: r.window,
            phase: bit(false),
        };
        let busy = !r.step.at(Step::Idle);
        if (i.sample | busy | r.ready).can_skip() {
            return outputs;
        }
        let magnitude = self.quarter.data(&mut state.submodules.quarter);
        let (address, negative) = self.look_up(self.address_phase(&r, &i));
        self.quarter.read(&mut state.submodules.quarter, address);
        let quiet = Registers { ready: bit(false), ..r };
        let before = r.negative;
        let r = Registers { negative, ..quiet };
        next!(self, state,
            i.sample => self.begin(r, i),
            busy => self.step(r, magnitude, before),
            else quiet
        );
        outputs
    }
}

#[cfg(test)]
mod tests;
