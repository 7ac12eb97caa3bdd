// SPDX-License-Identifier: MIT OR Apache-2.0
//! How fast the core runs, and how exactly, beside idsp's lock-in on the same samples, in one run.
//!
//! `cargo bench -p hapticore-model --bench core [PROFILE]`. Figures are medians of alternating
//! rounds; nothing here asserts a time, for the machine is never quiet: quote the ratios.
//!
//! An instant is a time of sampling, in which all channels are sampled; each has two products and the
//! haptic one a third. A channel sample is one code.

#[path = "../tests/equality/never_skips.rs"]
mod never_skips;

use dsp_process::SplitProcess;
use hapticore_contract::calibration::{Calibration, ForceTable, Point, PositionTable};
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Block, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::signal::Signal;
use hapticore_model::blocks::core::{Core, Inputs};
use hapticore_model::fidelity::{clock::ClockSimulation, fixed::FixedSimulation};
use idsp::{Lockin, Lowpass, Lowpass2, LowpassState};
use never_skips::NeverSkips;
use std::f64::consts::{SQRT_2, TAU};
use std::num::Wrapping;
use std::ops::AddAssign;
use std::time::Instant;

const ROUNDS: usize = 7;
const SLOTS: usize = 200;
/// The board's clock and sample rate (docs/decisions.md §14).
const BOARD_HZ: f64 = 25e6;
const SAMPLE_HZ: f64 = 1e6;

fn main() {
    // Cargo adds an option of its own.
    let name = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    let profile =
        Profile::bundled(name.as_deref().unwrap_or("standard")).expect("a bundled profile");
    let calibration = calibration(&profile);
    let codes = slot(&profile, 0.2);
    let mut clock = ClockSimulation::new(&profile, &calibration);
    let mut fixed: FixedSimulation = FixedSimulation::new(&profile, &calibration);
    let mut never_skips = NeverSkipping::new(&profile, &calibration);
    let memory = resident_kib();
    let mut rates: [Vec<f64>; 7] = Default::default();
    for _ in 0..ROUNDS {
        let round = [
            rate(|| run_clock(&mut clock, &codes)),
            rate(|| never_skips.run(&codes)),
            rate(|| run_fixed(&mut fixed, &profile, &codes)),
            rate(|| run_sums(&mut fixed, &profile, &codes)),
            rate(|| run_limit(&profile, &codes, f64::from, |code, word| f64::from(code) * word)),
            rate(|| {
                run_limit(
                    &profile,
                    &codes,
                    |word| word,
                    |code, word| i64::from(code) * i64::from(word),
                )
            }),
            rate(|| run_idsp(&profile, &codes)),
        ];
        rates.iter_mut().zip(round).for_each(|(rates, rate)| rates.push(rate));
    }
    let [clocks, unskipped, instants, sums, floats, integers, lockin] = rates.map(median);
    let channels = profile.channels() as f64;
    let share = profile.slot.integrate as f64 / profile.slot.samples() as f64;
    println!("profile {}, {ROUNDS} rounds, medians", profile.name);
    println!(
        "clock   {:8.1} M clocks/s            {:6.2} × a {} MHz board",
        clocks / 1e6,
        clocks / BOARD_HZ,
        BOARD_HZ / 1e6
    );
    println!(
        "        {:8.1} M clocks/s, no block skips a clock in which it rests",
        unskipped / 1e6
    );
    println!(
        "fixed   {:8.1} M instants/s in window {:6.1} × 1 MS/s, whole slots with their estimates",
        instants / 1e6,
        instants / SAMPLE_HZ
    );
    println!("        {:8.1} M instants/s, the window's sums alone", sums / 1e6);
    println!(
        "        {:8.1} M instants/s, a plain loop of two products a channel in f64; {:.1} M in i64",
        floats / 1e6,
        integers / 1e6
    );
    println!(
        "        with the blanking between, which it need not look at: {:.1} × real time",
        instants / share / SAMPLE_HZ
    );
    println!("        {:8.1} M channel samples/s", instants * channels / 1e6);
    println!("idsp    {:8.1} M samples/s of one channel (Lockin<Lowpass2>)", lockin / 1e6);
    println!("fixed / idsp, per channel sample: {:.2}", instants * channels / lockin);
    println!(
        "resident memory: {memory} KiB before, {} KiB after {} clocks",
        resident_kib(),
        clock.clocks()
    );
    accuracy(&profile, &calibration);
}

/// The total current's amplitude over the sensing voltage's, of clean tones: what the core and idsp
/// make of it.
fn accuracy(profile: &Profile, calibration: &Calibration) {
    println!("tones without noise, total current / sensing voltage: relative error by level");
    println!("{:>10} {:>12} {:>12}", "level", "core", "idsp");
    for level in [0.5, 0.05, 5e-3, 5e-4] {
        let codes = slot(profile, level);
        let mut fixed: FixedSimulation = FixedSimulation::new(profile, calibration);
        let window = &codes[profile.slot.blanking() as usize * profile.channels()..];
        let core = fixed.slot(0, window).measurement(profile).capacitance_pf
            / calibration.capacitance_gain;
        let currents: f64 =
            (0..SHARES.len()).map(|channel| idsp_amplitude(profile, &codes, channel)).sum();
        let idsp = currents / idsp_amplitude(profile, &codes, SHARES.len());
        let ideal = level * SHARES.iter().sum::<f64>() / SENSE;
        println!("{level:>10.0e} {:>+12.1e} {:>+12.1e}", core / ideal - 1.0, idsp / ideal - 1.0);
    }
}

const SHARES: [f64; 6] = [0.15, 0.2, 0.25, 0.2, 0.1, 0.1];
const SENSE: f64 = 0.625;

/// A flat map without sheet resistance, so that capacitance is current over voltage.
fn calibration(profile: &Profile) -> Calibration {
    let points: Vec<_> = (0..121)
        .map(|k| (f64::from(k % 11) - 5.0, f64::from(k / 11) - 5.0))
        .map(|(i, j)| Point { x: i * 80.0, y: j * 40.0, r_x: i / 6.0, r_y: j / 6.0, sheet: 0.0 })
        .collect();
    let position = PositionTable::fit(profile, &points).expect("a raster");
    let force_table = ForceTable::default();
    let (capacitance_gain, force_gain, contact_capacitance) = (796.0, 1e-6, 100.0);
    Calibration { position, capacitance_gain, force_gain, contact_capacitance, force_table }
}

/// The codes of a slot: currents a quarter turn ahead of the sensing voltage, a slow haptic
/// voltage.
fn slot(profile: &Profile, level: f64) -> Vec<i32> {
    let full = -(profile.formats.adc.min_code() as f64);
    let turn = TAU * profile.turns_per_sample();
    let mut codes = Vec::new();
    for n in 0..profile.slot.samples() {
        let phase = turn * n as f64;
        codes.extend(
            SHARES.map(|share| -level * share * phase.sin()).map(|x| (x * full).round() as i32),
        );
        codes.push((SENSE * full * phase.cos()).round() as i32);
        codes.push((0.8 * full * (phase / 100.0).sin()).round() as i32);
    }
    codes
}

fn run_clock(clock: &mut ClockSimulation, codes: &[i32]) -> f64 {
    let before = clock.clocks();
    for _ in 0..SLOTS / 4 {
        clock.samples(codes);
    }
    (clock.clocks() - before) as f64
}

/// A core of which every block works in each clock.
struct NeverSkipping {
    core: Core,
    state: State<Core, NeverSkips>,
    inputs: Inputs<Signal<NeverSkips>>,
    channels: usize,
    clocks: u64,
}

impl NeverSkipping {
    fn new(profile: &Profile, calibration: &Calibration) -> Self {
        let core = Core::new(profile);
        let codes = Inputs::zip(core.idle_inputs(calibration), core.inputs());
        let signal = |(code, format)| Signal { value: NeverSkips(code), format };
        NeverSkipping {
            state: core.reset(),
            inputs: Inputs::map(codes, signal),
            channels: profile.channels(),
            clocks: profile.clocks_per_sample,
            core,
        }
    }

    /// A slot.
    #[inline(never)]
    fn run(&mut self, codes: &[i32]) -> f64 {
        let Self { core, state, inputs, channels, clocks } = self;
        let mut channel = 0;
        for codes in codes.chunks_exact(*channels) {
            for clock in 0..*clocks {
                let signal = |value, of| Signal { value: NeverSkips(value), ..of };
                let strobe = signal(i64::from(clock == 0), inputs.strobe);
                let code = signal(i64::from(codes[channel]), inputs.code);
                let outputs = core.clock(state, Inputs { strobe, code, ..*inputs });
                channel = outputs.channel.value.0 as usize;
            }
        }
        (codes.len() / *channels) as f64 * *clocks as f64
    }
}

fn run_fixed(fixed: &mut FixedSimulation, profile: &Profile, codes: &[i32]) -> f64 {
    let window = &codes[profile.slot.blanking() as usize * profile.channels()..];
    for slot in 0..SLOTS {
        std::hint::black_box(fixed.slot(slot % profile.pads as usize, window));
    }
    (SLOTS * fixed.window()) as f64
}

/// The sums of a window without the estimate.
fn run_sums(fixed: &mut FixedSimulation, profile: &Profile, codes: &[i32]) -> f64 {
    let window = &codes[profile.slot.blanking() as usize * profile.channels()..];
    for _ in 0..SLOTS {
        std::hint::black_box(fixed.sums(window));
    }
    (SLOTS * fixed.window()) as f64
}

/// What a loop over eight channels can do that multiplies codes by two words of each instant, and
/// nothing else.
fn run_limit<W: Copy, S: Copy + Default + AddAssign>(
    profile: &Profile,
    codes: &[i32],
    word: impl Fn(i32) -> W,
    product: impl Fn(i32, W) -> S,
) -> f64 {
    const CHANNELS: usize = 8;
    let window = profile.slot.integrate as usize;
    let words: Vec<[W; 2]> = (1..).map(|n| [word(n), word(-n)]).take(window).collect();
    for _ in 0..SLOTS {
        let (samples, _) = std::hint::black_box(codes).as_chunks::<CHANNELS>();
        let (mut in_phase, mut quadrature) = ([S::default(); CHANNELS], [S::default(); CHANNELS]);
        for (codes, words) in samples.iter().zip(&words) {
            for channel in 0..CHANNELS {
                in_phase[channel] += product(codes[channel], words[0]);
                quadrature[channel] += product(codes[channel], words[1]);
            }
        }
        let sums = [in_phase, quadrature];
        std::hint::black_box(sums);
    }
    (SLOTS * window) as f64
}

fn run_idsp(profile: &Profile, codes: &[i32]) -> f64 {
    for _ in 0..SLOTS {
        std::hint::black_box(idsp_amplitude(profile, codes, 0));
    }
    (SLOTS as u64 * profile.slot.samples()) as f64
}

/// idsp's lock-in on one channel: a second-order low-pass that settles within the slot; its last
/// output.
fn idsp_amplitude(profile: &Profile, codes: &[i32], channel: usize) -> f64 {
    let corner = 4.0 / profile.slot.samples() as f64;
    let k = TAU * corner;
    let gain = (k * 2f64.powi(31)) as i64;
    let lowpass: Lowpass2 =
        Lowpass([((gain * gain) >> 32) as i32, (-(gain as f64) * SQRT_2) as i32]);
    let lockin = Lockin(lowpass);
    let mut state: [LowpassState<2>; 2] = Default::default();
    let step = (2f64.powi(32) * profile.turns_per_sample()).round() as i64 as i32;
    let shift = 32 - u32::from(profile.formats.adc.width);
    let mut phase = Wrapping(0i32);
    let mut out = (0, 0);
    for codes in codes.chunks_exact(profile.channels()) {
        let iq = lockin.process(&mut state, (codes[channel] << (shift - 1), phase));
        phase += step;
        out = (iq.re(), iq.im());
    }
    f64::from(out.0).hypot(f64::from(out.1)) * 2.0 / 2f64.powi(30)
}

fn rate(mut run: impl FnMut() -> f64) -> f64 {
    let start = Instant::now();
    run() / start.elapsed().as_secs_f64()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// What the process keeps in memory.
fn resident_kib() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok()).unwrap_or(0)
}
