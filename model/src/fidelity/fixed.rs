// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fidelity `fixed`: the frames that `clock` gives, to the bit, without stepping the clocks of
//! every sample.
//!
//! The local oscillator is the same for every slot, and so is asked once. A window's sums are exact in the demodulator.
//! So a plain loop over all channels adds up codes, and numbers that are not rounded; codes that are too wide for it go
//! through the demodulator's own arithmetic sample by sample. The estimator then runs through its clocks, a few hundred
//! a slot, of a block one after the other (`estimator/run_on.rs`). The position's program, most of a slot's clocks,
//! computes its results in one step, from codes.
//!
//! As it is generic over the interpretation, the same run gives the rounding error of every signal
//! ([`Shadow`](hapticore_hdl::interpretations::shadow::Shadow)): position and sheet resistance have
//! none there, as their program starts from codes.

use super::plain::{PlainSums, WHOLE, Waves, Words};
use super::tone::{Response, WindowedSample};
use super::{Gathered, assert_pad, signals};
use crate::blocks::core::{self, Core};
use crate::blocks::estimator::{self, Estimator, In, Inputs, PromptPort};
use crate::blocks::oscillator::Inputs as Sample;
use hapticore_contract::calibration::Calibration;
use hapticore_contract::frame::Frame;
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::{Proved, Signal, bit, code, constant, zero};

/// The windowed carrier at a sample, and the window itself.
#[derive(Debug, Clone, Copy)]
struct Local<V> {
    cosine: V,
    sine: V,
    window: V,
}

/// Loops over all channels: that of codes, and that of numbers that are not rounded, as the
/// interpretation has them.
struct Plain {
    codes: Option<PlainSums>,
    reals: Option<PlainSums>,
}

impl Plain {
    fn add_up(&mut self, codes: &[i32]) {
        for sums in [&mut self.codes, &mut self.reals].into_iter().flatten() {
            sums.add_up(codes);
        }
    }

    /// The sum at an index of [`PlainSums::sums`].
    fn sum<V: Interpretation>(&self, index: usize, format: Format) -> Signal<V> {
        let at = |sums: &Option<PlainSums>| sums.as_ref().map(|sums| sums.sums()[index]);
        let code = at(&self.codes).map_or(0, |sum| sum as i64);
        let rounded = Signal { value: V::raw(code, format), format };
        let value = at(&self.reals).map_or(rounded.value, |sum| V::with_unrounded(rounded, sum));
        Signal { value, format }
    }
}

/// A core at work, slot by slot.
pub struct FixedSimulation<V: Interpretation = i64> {
    core: Core,
    state: State<Core, V>,
    adc: Format,
    oscillator: Format,
    channels: usize,
    pads: usize,
    local: Vec<Local<V>>,
    /// The window's sums in one loop, where it is exact.
    plain: Option<Plain>,
    response: Response,
    quiet: In<V>,
    sums: Vec<Signal<V>>,
    /// The last prompt estimate, where the profile has a controller.
    prompt: Option<PromptPort<Signal<V>>>,
}

impl<V: Interpretation> FixedSimulation<V> {
    /// A core of a profile, calibrated, just before its first slot.
    pub fn new(profile: &Profile, calibration: &Calibration) -> Self {
        let mut core = Core::new(profile);
        if V::DECIDES {
            let words = calibration.position.words.iter();
            core.place_at_once(
                words.map(|&word| profile.formats.table.code_saturating(word)).collect(),
            );
        }
        let constants = signals::<core::Inputs, V>(core.idle_inputs(calibration), core.inputs());
        let sums = vec![zero(core.demodulator().sum()); core.demodulator().sums() as usize];
        let local = local(&core, profile);
        FixedSimulation {
            state: calibrated(&core, profile, calibration),
            response: response(&core, &local, profile),
            plain: plain(&core, &local, profile),
            local,
            quiet: quiet(&core, constants),
            adc: profile.formats.adc,
            oscillator: profile.formats.oscillator,
            channels: profile.channels(),
            pads: profile.pads as usize,
            sums,
            prompt: None,
            core,
        }
    }

    /// The pads that it serves.
    pub(super) fn pads(&self) -> usize {
        self.pads
    }

    /// The samples of a window.
    pub fn window(&self) -> usize {
        self.local.len()
    }

    /// The frame of a slot: `codes` are those of its window, a sample after the other.
    ///
    /// # Panics
    /// Where there is no such pad, `codes` is not one code per channel and sample, or the estimator
    /// does not finish within its latency. A wrong pad or length leaves the core as it was.
    pub fn slot(&mut self, pad: usize, codes: &[i32]) -> Frame {
        assert_pad(pad, self.pads);
        assert_eq!(
            codes.len(),
            self.window() * self.channels,
            "one code a channel and sample of the window"
        );
        self.demodulate(codes);
        let clipped = self.clipped(codes);
        self.estimate(pad, clipped)
    }

    /// The frame of a slot without samples: from the amplitudes of the terminals and of the sensing
    /// voltage, in phase and a quarter turn ahead of the carrier, and the haptic voltage's mean
    /// square. All are fractions of full scale. The ADC's rounding is absent, so that
    /// [`slot`](FixedSimulation::slot) of the same tones' samples differs by it.
    ///
    /// # Panics
    /// Where there is no such pad, `amplitudes` is not one a demodulated channel, or the estimator
    /// does not finish within its latency. A wrong pad or number leaves the core as it was.
    pub fn phasors(&mut self, pad: usize, amplitudes: &[(f64, f64)], mean_square: f64) -> Frame {
        assert_pad(pad, self.pads);
        assert_eq!(
            amplitudes.len(),
            self.channels - 1,
            "an amplitude a terminal, and the sensing voltage's"
        );
        let format = self.core.demodulator().sum();
        let (sums, clipped) = self.response.sums(amplitudes, mean_square);
        for (into, sum) in self.sums.iter_mut().zip(sums) {
            *into = constant(sum, format);
        }
        self.estimate(pad, clipped)
    }

    /// The sums of tones, as numbers: of what [`FixedSimulation::phasors`] takes.
    pub(super) fn sums_of_tones(&self, amplitudes: &[(f64, f64)], mean_square: f64) -> Vec<f64> {
        self.response.sums(amplitudes, mean_square).0
    }

    /// The local oscillator over the window, as numbers.
    pub(super) fn windowed(&self) -> Vec<WindowedSample> {
        windowed(&self.core, &self.local, self.oscillator).collect()
    }

    /// The sums of a window, as numbers: in phase and quadrature of each channel, then of the
    /// haptic voltage's squares.
    ///
    /// # Panics
    /// Where `codes` is not one code per channel and sample.
    pub fn sums(&mut self, codes: &[i32]) -> Vec<f64> {
        assert_eq!(
            codes.len(),
            self.window() * self.channels,
            "one code a channel and sample of the window"
        );
        self.demodulate(codes);
        self.sums.iter().map(|&sum| sum.format.real(V::code(sum))).collect()
    }

    /// The sums of a window.
    fn demodulate(&mut self, codes: &[i32]) {
        match self.plain.take() {
            Some(mut plain) => {
                plain.add_up(codes);
                self.take(&plain);
                self.plain = Some(plain);
            }
            None => self.add_up(codes),
        }
    }

    /// Takes the sums of the loop over all channels.
    fn take(&mut self, plain: &Plain) {
        let (channels, demodulator) = (self.channels, self.core.demodulator());
        let (exact, words) = (demodulator.sum(), self.plain_formats());
        for channel in 0..channels - 1 {
            let tone = |part: usize| plain.sum(1 + part * channels + channel, words[0]);
            let [in_phase, quadrature] = match demodulator.polyphase() {
                None => [tone(0), tone(1)].map(|sum| sum.resize(exact, Proved)),
                Some(polyphase) => demodulator.combine(polyphase, std::array::from_fn(tone)),
            };
            self.sums[2 * channel] = in_phase;
            self.sums[2 * channel + 1] = quadrature;
        }
        let squares: Signal<V> = plain.sum(0, words[1]);
        self.sums[2 * (channels - 1)] = squares.resize(exact, Proved);
    }

    /// The formats of a tone's and of the squares' sum, with the point of their products.
    fn plain_formats(&self) -> [Format; 2] {
        let (sum, adc) = (self.core.demodulator().sum(), self.adc);
        match self.core.demodulator().polyphase() {
            None => [self.running_sum(), with_point_of(sum, adc.product(adc))],
            Some(_) => [sum, sum],
        }
    }

    /// The sums of a window, a channel after the other, so that its two sums stay at hand.
    fn add_up(&mut self, codes: &[i32]) {
        let (haptic, demodulated) = (self.channels - 1, self.channels - 1);
        for channel in 0..demodulated {
            let [in_phase, quadrature] = self.tone(channel, codes);
            self.sums[2 * channel] = in_phase;
            self.sums[2 * channel + 1] = quadrature;
        }
        self.sums[2 * demodulated] = self.squares(haptic, codes);
    }

    /// The in-phase and quadrature sums of a channel.
    fn tone(&self, channel: usize, codes: &[i32]) -> [Signal<V>; 2] {
        match self.core.demodulator().polyphase() {
            None => self.products(channel, codes),
            Some(polyphase) => {
                let sums = self.phases(channel, codes);
                self.core.demodulator().combine(polyphase, sums)
            }
        }
    }

    /// A channel's sums by the phases of a carrier with five samples per period.
    #[inline]
    fn phases(&self, channel: usize, codes: &[i32]) -> [Signal<V>; 5] {
        let (demodulator, adc) = (self.core.demodulator(), self.adc);
        let mut sums = [zero(demodulator.sum()); 5];
        let (samples, local) = (codes.chunks_exact(5 * self.channels), self.local.chunks_exact(5));
        for (samples, local) in samples.zip(local) {
            for ((sum, codes), local) in
                sums.iter_mut().zip(samples.chunks_exact(self.channels)).zip(local)
            {
                let code = demodulator.raised(raw(codes[channel], adc));
                *sum =
                    demodulator.add(*sum, code * demodulator.window_word(self.wave(local.window)));
            }
        }
        sums
    }

    /// The in-phase and quadrature sums of a channel, from products with the local oscillator.
    #[inline]
    fn products(&self, channel: usize, codes: &[i32]) -> [Signal<V>; 2] {
        let (demodulator, adc, begun) = (self.core.demodulator(), self.adc, bit(false));
        let mut sums = [zero(self.running_sum()); 2];
        for (codes, local) in codes.chunks_exact(self.channels).zip(&self.local) {
            let code = raw(codes[channel], adc);
            sums[0] = demodulator.accumulate(begun, sums[0], code * self.wave(local.cosine));
            sums[1] = demodulator.accumulate(begun, sums[1], code * self.wave(local.sine));
        }
        sums.map(|sum| sum.resize(demodulator.sum(), Proved))
    }

    /// The windowed sum of squares of a channel.
    #[inline]
    fn squares(&self, channel: usize, codes: &[i32]) -> Signal<V> {
        let (demodulator, adc, begun) = (self.core.demodulator(), self.adc, bit(false));
        let mut sum = zero(demodulator.sum());
        if demodulator.polyphase().is_some() {
            for (codes, local) in codes.chunks_exact(self.channels).zip(&self.local) {
                let code = demodulator.magnitude(raw(codes[channel], adc));
                let share =
                    demodulator.share(demodulator.window_word(self.wave(local.window)) * code);
                sum = demodulator.add(sum, code * share);
            }
            return sum;
        }
        for (codes, local) in codes.chunks_exact(self.channels).zip(&self.local) {
            let code = raw(codes[channel], adc);
            let windowed = demodulator.window_product(self.wave(local.window) * code);
            sum = demodulator.accumulate(begun, sum, code * windowed);
        }
        sum
    }

    /// The format of a sum within the loop: with the point of its products, so that nothing is
    /// aligned there.
    fn running_sum(&self) -> Format {
        with_point_of(self.core.demodulator().sum(), self.adc.product(self.oscillator))
    }

    #[inline(always)]
    fn wave(&self, value: V) -> Signal<V> {
        Signal { value, format: self.oscillator }
    }

    fn clipped(&self, codes: &[i32]) -> bool {
        let full_scale = [self.adc.min_code() as i32, self.adc.max_code() as i32];
        codes.iter().fold(false, |clipped, code| clipped | full_scale.contains(code))
    }

    /// Hands the sums to the estimator and runs it until its frame is there.
    fn estimate(&mut self, pad: usize, clipped: bool) -> Frame {
        let (pad, clipped) = (code(pad as i64, self.quiet.pad.format), bit(clipped));
        let quiet = Inputs { pad, clipped, ..self.quiet };
        let state = &mut self.state.submodules.estimator;
        run(self.core.estimator(), state, &quiet, &self.sums, &mut self.prompt)
    }

    /// The prompt estimate of the last slot.
    pub(super) fn prompt(&self) -> Option<PromptPort<Signal<V>>> {
        self.prompt
    }

    /// The core, and the state of its estimator.
    pub fn state(&self) -> (&Core, &State<Core, V>) {
        (&self.core, &self.state)
    }
}

/// The state of a core with the calibration's tables in it.
pub(super) fn calibrated<V: Interpretation>(
    core: &Core,
    profile: &Profile,
    calibration: &Calibration,
) -> State<Core, V> {
    let mut state = core.reset();
    let estimator = &mut state.submodules.estimator;
    core.estimator().set_table(estimator, &calibration.words(profile));
    state
}

/// The frame that an estimator makes of a window's sums. Not inlined: what it borrows is then known
/// to be apart, and the compiler need not read formats again after every word that is written.
///
/// # Panics
/// Where it does not finish within its latency.
#[inline(never)]
pub(super) fn run<V: Interpretation>(
    estimator: &Estimator,
    state: &mut State<Estimator, V>,
    quiet: &In<V>,
    sums: &[Signal<V>],
    prompt: &mut Option<PromptPort<Signal<V>>>,
) -> Frame {
    let mut gathered = Gathered::default();
    for clock in 0..sums.len() + estimator.latency() as usize {
        let inputs = match sums.get(clock) {
            Some(&sum) => Inputs {
                valid: bit(true),
                index: code(clock as i64, quiet.index.format),
                sum,
                ..*quiet
            },
            None => *quiet,
        };
        let estimator::Outputs { frames: frame, prompt: given } =
            estimator.clock_running_on(state, inputs);
        if V::known_bit(given.prompt.value) == Some(true) {
            *prompt = Some(given);
        }
        if V::known_bit(frame.valid.value) == Some(true) {
            gathered.accept_word(1, V::code(frame.index), V::code(frame.frame));
        }
        if V::known_bit(frame.done.value) == Some(true) {
            return gathered.frame(frame);
        }
    }
    unreachable!("the estimator finishes within its latency")
}

/// A sum's format with the point of its products, to the right of which it has nothing.
fn with_point_of(sum: Format, product: Format) -> Format {
    Format { width: sum.width - (sum.frac - product.frac) as u8, frac: product.frac, ..sum }
}

/// The loops over all channels that an interpretation has; none where that of codes is not exact.
fn plain<V: Interpretation>(core: &Core, local: &[Local<V>], profile: &Profile) -> Option<Plain> {
    let (channels, largest) = (profile.channels(), -(profile.formats.adc.min_code() as f64));
    let codes = || PlainSums::exact(words_of_codes(core, local, profile), channels, largest);
    let reals = || PlainSums::new(words_of_reals(core, local, profile), channels);
    let plain = Plain {
        codes: V::HAS_CODE.then(codes).flatten(),
        reals: V::HAS_REAL.then(reals).flatten(),
    };
    let is_whole = plain.codes.is_some() == V::HAS_CODE && plain.reals.is_some() == V::HAS_REAL;
    (is_whole && (V::HAS_CODE || V::HAS_REAL)).then_some(plain)
}

/// What codes are multiplied by for sums that are codes.
fn words_of_codes<V: Interpretation>(core: &Core, local: &[Local<V>], profile: &Profile) -> Words {
    let (demodulator, adc) = (core.demodulator(), profile.formats.adc);
    let word = |value: V| Signal { value, format: profile.formats.oscillator };
    let whole = |word: Signal<V>| V::code(word) as f64;
    let windows = || local.iter().map(|of| word(of.window));
    let power = |bits: i8| 2f64.powi(bits.into());
    match demodulator.polyphase() {
        None => {
            let waves = |of: &Local<V>| [of.cosine, of.sine].map(|wave| whole(word(wave)));
            Words {
                waves: Waves::Products(local.iter().map(waves).collect()),
                window: windows().map(whole).collect(),
                keep: power(-profile.formats.oscillator.frac),
                raise: 1.0,
                rounding: WHOLE,
            }
        }
        Some(_) => {
            let raised = demodulator.raised(zero::<V>(adc)).format.frac;
            let raise = power(raised - adc.frac);
            let window = |word| whole(demodulator.window_word(word)) * raise;
            Words {
                waves: Waves::Phases { offset: -(adc.min_code() as f64) },
                window: windows().map(window).collect(),
                keep: power(-raised),
                raise,
                rounding: WHOLE,
            }
        }
    }
}

/// What codes are multiplied by for the sums of a core that rounds nothing, in units of full scale.
fn words_of_reals<V: Interpretation>(core: &Core, local: &[Local<V>], profile: &Profile) -> Words {
    let (adc, format) = (profile.formats.adc, profile.formats.oscillator);
    let number = |value: V| V::unrounded(Signal { value, format }) * adc.lsb();
    let waves = |of: &Local<V>| [of.cosine, of.sine].map(number);
    Words {
        waves: match core.demodulator().polyphase() {
            None => Waves::Products(local.iter().map(waves).collect()),
            Some(_) => Waves::Phases { offset: -(adc.min_code() as f64) },
        },
        window: local.iter().map(|of| number(of.window)).collect(),
        keep: 1.0,
        raise: adc.lsb(),
        rounding: 0.0,
    }
}

/// A code of the ADC.
#[inline(always)]
fn raw<V: Interpretation>(code: i32, adc: Format) -> Signal<V> {
    Signal { value: V::raw(code.into(), adc), format: adc }
}

/// The estimator's inputs between sums.
pub(super) fn quiet<V: Interpretation>(core: &Core, constants: core::In<V>) -> In<V> {
    let zeros = Inputs::map(core.estimator().inputs(), zero);
    Inputs { calibration: constants.calibration, ..zeros }
}

/// What the window makes of tones, with the oscillator's own words.
fn response<V: Interpretation>(core: &Core, local: &[Local<V>], profile: &Profile) -> Response {
    let windowed = windowed(core, local, profile.formats.oscillator);
    let full_scale = 1.0 - profile.formats.adc.lsb();
    Response::new(windowed, profile.slot.blanking(), profile.turns_per_sample(), full_scale)
}

/// The local oscillator over the window: windowed cosine and sine, and the window.
fn windowed<V: Interpretation>(
    core: &Core,
    local: &[Local<V>],
    format: Format,
) -> impl Iterator<Item = WindowedSample> {
    let real = move |value: V| V::real(Signal { value, format });
    let polyphase = core.demodulator().polyphase();
    local.iter().enumerate().map(move |(sample, local)| {
        let [cosine, sine, window] = [local.cosine, local.sine, local.window].map(real);
        match polyphase {
            None => [cosine, sine, window],
            Some(polyphase) => {
                let [cosine, sine] = polyphase.waves(sample);
                [window * cosine, window * sine, window]
            }
        }
    })
}

/// The local oscillator over the window of a slot: the oscillator's own, asked once.
fn local<V: Interpretation>(core: &Core, profile: &Profile) -> Vec<Local<V>> {
    let (oscillator, demodulator) = (core.oscillator(), core.demodulator());
    let mut state = oscillator.reset();
    let (mut local, mut residues) = (Vec::new(), [demodulator.fresh_residue(); 2]);
    for sample in 0..profile.slot.samples() {
        let [restart, first] = [sample == 0, sample == profile.slot.blanking()].map(bit);
        let quiet = Sample { sample: bit(false), restart: bit(false), first: bit(false) };
        let mut out = oscillator.clock(&mut state, Sample { sample: bit(true), restart, first });
        while V::known_bit(out.ready.value) != Some(true) {
            out = oscillator.clock(&mut state, quiet);
        }
        let out = oscillator.clock(&mut state, quiet);
        if sample >= profile.slot.blanking() {
            if demodulator.polyphase().is_some() {
                local.push(Local {
                    cosine: out.cosine.value,
                    sine: out.sine.value,
                    window: out.window.value,
                });
                continue;
            }
            let [(cosine, of_cosine), (sine, of_sine)] =
                [(out.cosine, residues[0]), (out.sine, residues[1])]
                    .map(|(wave, residue)| demodulator.carry(out.window * wave, residue));
            residues = [of_cosine, of_sine];
            local.push(Local { cosine: cosine.value, sine: sine.value, window: out.window.value });
        }
    }
    local
}

#[cfg(test)]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};

    use super::*;
    use crate::support::device;
    use crate::support::random::Random;
    use hapticore_hdl::interpretations::shadow::Shadow;

    #[test]
    fn a_slot_of_no_pad_leaves_the_core_as_it_was() {
        let profile = Profile::bundled("standard").unwrap();
        let new = || FixedSimulation::<i64>::new(&profile, &device::calibration(&profile));
        let (mut refusing, mut same) = (new(), new());
        let mut random = Random::new(2);
        let mut codes = || -> Vec<i32> {
            let count = same.window() * profile.channels();
            (0..count).map(|_| random.word(profile.formats.adc) as i32 >> 4).collect()
        };
        let tones = vec![(0.1, 0.01); profile.channels() - 1];
        for (n, codes) in [codes(), codes(), codes()].iter().enumerate() {
            let pad = n % profile.pads as usize;
            let mut is_refused = |of: &mut dyn FnMut(&mut FixedSimulation) -> Frame| {
                catch_unwind(AssertUnwindSafe(|| of(&mut refusing))).is_err()
            };
            assert!(is_refused(&mut |core| core.slot(profile.pads as usize, codes)));
            assert!(is_refused(&mut |core| core.slot(99, codes)));
            assert!(is_refused(&mut |core| core.slot(pad, &codes[1..])));
            assert!(is_refused(&mut |core| core.phasors(99, &tones, 0.1)));
            assert!(is_refused(&mut |core| core.phasors(pad, &tones[1..], 0.1)));
            assert_eq!(refusing.slot(pad, codes), same.slot(pad, codes));
        }
    }

    /// Random codes with many corners, then windows of the largest, the most negative and of both in
    /// turn.
    #[test]
    fn the_loop_over_all_channels_gives_the_demodulators_sums() {
        for profile in Profile::all() {
            let new = || FixedSimulation::<i64>::new(&profile, &device::calibration(&profile));
            let (mut looped, mut one_by_one) = (new(), new());
            assert!(looped.plain.is_some(), "{}", profile.name);
            one_by_one.plain = None;
            let (adc, count) = (profile.formats.adc, looped.window() * profile.channels());
            let [least, most] = [adc.min_code() as i32, adc.max_code() as i32];
            let mut random = Random::new(1);
            let mut windows: Vec<Vec<i32>> =
                (0..20).map(|_| (0..count).map(|_| random.word(adc) as i32).collect()).collect();
            windows.extend([vec![least; count], vec![most; count]]);
            windows.push((0..count).map(|n| [least, most][n / profile.channels() % 2]).collect());
            for codes in &windows {
                assert_eq!(looped.sums(codes), one_by_one.sums(codes), "{}", profile.name);
            }
        }
    }

    /// The same sums in another order: only rounding of `f64` may differ.
    #[test]
    fn the_loop_over_all_channels_gives_the_unrounded_sums() {
        for profile in Profile::all() {
            let new = || FixedSimulation::<Shadow>::new(&profile, &device::calibration(&profile));
            let (mut looped, mut one_by_one) = (new(), new());
            assert!(looped.plain.is_some(), "{}", profile.name);
            one_by_one.plain = None;
            let (adc, count) = (profile.formats.adc, looped.window() * profile.channels());
            let mut random = Random::new(2);
            let codes: Vec<i32> = (0..count).map(|_| random.word(adc) as i32).collect();
            looped.demodulate(&codes);
            one_by_one.demodulate(&codes);
            for (looped, one_by_one) in looped.sums.iter().zip(&one_by_one.sums) {
                let (a, b) = (looped.value, one_by_one.value);
                assert_eq!(a.code, b.code, "{}", profile.name);
                let off = (a.real - b.real).abs();
                assert!(off < 1e-9, "{}: {} and {}", profile.name, a.real, b.real);
            }
        }
    }

    #[test]
    fn sums_that_an_f64_does_not_hold_are_left_to_the_demodulator() {
        let window = |word: f64| Words {
            waves: Waves::Products(vec![[word; 2]; 1000]),
            window: vec![word; 1000],
            keep: 1.0 / word,
            raise: 1.0,
            rounding: WHOLE,
        };
        let loops = |word: f64, code: f64| PlainSums::exact(window(word), 8, code).is_some();
        let [narrow, wide] = [17, 23].map(|bits| 2f64.powi(bits));
        assert!(loops(narrow, narrow) && loops(wide, narrow));
        assert!(!loops(wide, wide), "a tone's sum");
        assert!(!loops(1.0, wide), "the sum of squares");
        assert!(
            PlainSums::exact(window(narrow), 9, narrow).is_none(),
            "more channels than a board's"
        );
    }
}
