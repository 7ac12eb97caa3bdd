// SPDX-License-Identifier: MIT OR Apache-2.0
//! A calibrated core of a profile, beside its references, and the codes of tones.
//!
//! ```text
//! x[n] = a·cos 2π(f·n + φ)      terminals and sensing voltage; f the carrier's, n = 0 where the slot begins
//! ```
//!
//! The device is none in particular: its ratios bend towards the edges of the sheet and its sheet
//! resistance changes with the place, as those of the paper's display do.

use std::f64::consts::TAU;

use hapticore_contract::calibration::{Calibration, ForceTable, Point, PositionTable};
use hapticore_contract::frame::{Frame, Measurement};
use hapticore_contract::profile::Profile;
use hapticore_model::fidelity::clock::ClockSimulation;
use hapticore_model::fidelity::fixed::FixedSimulation;
use hapticore_reference::Reference;
use hapticore_reference::rounded::Slots;

/// The bundled profiles of which no two compute with the same words.
pub const PROFILES: [&str; 3] = ["small", "standard", "fine"];

/// A profile and the calibration of its core.
#[derive(Debug, Clone)]
pub struct Bench {
    /// Word lengths, counts and timings.
    pub profile: Profile,
    /// Of the device above.
    pub calibration: Calibration,
}

/// A pad as the ADC sees it: amplitudes in fractions of full scale, phases in turns.
#[derive(Debug, Clone)]
pub struct Pad {
    /// Amplitude of each terminal's current.
    pub currents: Vec<f64>,
    /// Amplitude of the sensing voltage.
    pub sense: f64,
    /// Phase of the sensing voltage; the currents are a quarter of a turn ahead.
    pub phase: f64,
    /// Amplitude of the haptic voltage.
    pub haptic: f64,
    /// Its frequency, turns per sample.
    pub haptic_turns: f64,
}

/// The core by every way that there is to run it, slot by slot.
pub struct Everyone {
    channels: usize,
    blanking: usize,
    fixed: FixedSimulation,
    clock: ClockSimulation,
    rounded: Slots,
    /// Slots compared so far.
    pub slots: u64,
}

impl Bench {
    /// A bundled profile.
    pub fn of(name: &str) -> Self {
        Bench::with(Profile::bundled(name).expect("a bundled profile"))
    }

    /// The profile, with any change.
    pub fn with(profile: Profile) -> Self {
        Bench { calibration: calibration(&profile), profile }
    }

    /// Each of [`PROFILES`].
    pub fn all() -> Vec<Bench> {
        PROFILES.map(Bench::of).into()
    }

    /// Number of terminals.
    pub fn terminals(&self) -> usize {
        self.profile.terminals.x.len()
    }

    /// A pad off the middle of the sheet with this fraction of full scale at the terminal of the
    /// largest current. Its haptic voltage is a tenth of full scale and periodic in the window.
    pub fn pad(&self, amplitude: f64) -> Pad {
        let shares = [1.0, 0.1, 0.2, 0.3, 0.1, 0.2];
        Pad {
            currents: (0..self.terminals()).map(|k| amplitude * shares[k % shares.len()]).collect(),
            sense: 0.98,
            phase: 0.1,
            haptic: 0.1,
            haptic_turns: 7.0 / self.profile.slot.integrate as f64,
        }
    }

    /// Codes of a whole slot, blanking and window, of what a channel is at a sample, in fractions of
    /// full scale; rounded and clipped as an ADC does.
    pub fn slot(&self, mut of: impl FnMut(usize, usize) -> f64) -> Vec<i32> {
        let (samples, channels) = (self.profile.slot.samples() as usize, self.profile.channels());
        (0..samples * channels).map(|k| self.code(of(k / channels, k % channels))).collect()
    }

    /// The same of the window alone; samples count from the slot's begin.
    pub fn window(&self, mut of: impl FnMut(usize, usize) -> f64) -> Vec<i32> {
        let (first, channels) = (self.profile.slot.blanking() as usize, self.profile.channels());
        let count = self.profile.slot.integrate as usize * channels;
        (0..count).map(|k| self.code(of(first + k / channels, k % channels))).collect()
    }

    /// The code of a fraction of full scale.
    pub fn code(&self, fraction: f64) -> i32 {
        let adc = self.profile.formats.adc;
        let code = (fraction / adc.lsb()).round();
        code.clamp(adc.min_code() as f64, adc.max_code() as f64) as i32
    }

    /// What a channel of a pad is at a sample of a slot.
    pub fn signal(&self, pad: &Pad, n: usize, channel: usize) -> f64 {
        self.signal_at(pad, self.profile.turns_per_sample(), n as f64, channel)
    }

    /// The same with a carrier of any frequency, turns per sample, at any time in samples.
    pub fn signal_at(&self, pad: &Pad, turns: f64, n: f64, channel: usize) -> f64 {
        let tone = |amplitude: f64, phase: f64| amplitude * (TAU * (turns * n + phase)).cos();
        match channel.checked_sub(pad.currents.len()) {
            None => tone(pad.currents[channel], pad.phase + 0.25),
            Some(0) => tone(pad.sense, pad.phase),
            Some(_) => pad.haptic * (TAU * pad.haptic_turns * n).sin(),
        }
    }

    /// Codes of the window of a pad.
    pub fn codes(&self, pad: &Pad) -> Vec<i32> {
        self.window(|n, channel| self.signal(pad, n, channel))
    }

    /// The core slot by slot.
    pub fn fixed(&self) -> FixedSimulation {
        FixedSimulation::new(&self.profile, &self.calibration)
    }

    /// The equations in floating point.
    pub fn reference(&self) -> Reference {
        Reference::new(&self.profile, &self.calibration)
    }

    /// What a new core measures in one window of pad 0.
    pub fn measure(&self, window: &[i32]) -> Measurement {
        self.fixed().slot(0, window).measurement(&self.profile)
    }

    /// What floating point makes of the same codes.
    pub fn measure_in_float(&self, window: &[i32]) -> Measurement {
        self.reference().slot(0, window)
    }

    /// The phasors of a pad's terminals and of its sensing voltage, of full scale.
    pub fn phasors(&self, pad: &Pad) -> Vec<(f64, f64)> {
        let tone = |amplitude: f64, phase: f64| {
            (amplitude * (TAU * phase).cos(), amplitude * (TAU * phase).sin())
        };
        let currents = pad.currents.iter().map(|&current| tone(current, pad.phase + 0.25));
        currents.chain([tone(pad.sense, pad.phase)]).collect()
    }

    /// What floating point makes of the pad itself, which no ADC has rounded.
    pub fn ideal(&self, pad: &Pad) -> Measurement {
        self.reference().phasors(0, &self.phasors(pad), 0.5 * pad.haptic * pad.haptic)
    }

    /// The core by every way side by side, with a single pad.
    pub fn everyone(&self) -> Everyone {
        let profile = Profile { pads: 1, ..self.profile.clone() };
        Everyone {
            channels: profile.channels(),
            blanking: profile.slot.blanking() as usize,
            fixed: FixedSimulation::new(&profile, &self.calibration),
            clock: ClockSimulation::new(&profile, &self.calibration),
            rounded: Slots::new(&profile, &self.calibration),
            slots: 0,
        }
    }
}

impl Everyone {
    /// The frame of a whole slot: `clock`, `fixed` and the rounded reference give the same.
    ///
    /// # Panics
    /// Where they do not.
    pub fn slot(&mut self, codes: &[i32]) -> Frame {
        let window = &codes[self.blanking * self.channels..];
        let expected = self.rounded.slot(0, window);
        let slot = self.slots;
        assert_eq!(self.fixed.slot(0, window), expected, "slot {slot}: fixed, rounded reference");
        self.clock.samples(codes);
        let frame = self.clock.finish_slot().expect("a frame for every slot");
        assert_eq!(frame, expected, "slot {slot}: clock, rounded reference");
        self.slots += 1;
        frame
    }
}

/// A calibration such as a sheet has.
fn calibration(profile: &Profile) -> Calibration {
    let (columns, rows) = (41, 25);
    let point = |k: usize| {
        let (u, v) = ((k % columns) as f64 / 20.0 - 1.0, (k / columns) as f64 / 12.0 - 1.0);
        let r_x = 0.78 * (1.3 * u).sin() / 1.3f64.sin() * (1.0 - 0.15 * v * v);
        let r_y = 0.7 * (1.2 * v).sin() / 1.2f64.sin() * (1.0 - 0.3 * u * u);
        Point { x: 400.0 * u, y: 220.0 * v, r_x, r_y, sheet: 0.05 + 0.02 * u * u + 0.01 * v }
    };
    let points: Vec<Point> = (0..columns * rows).map(point).collect();
    let calibration = Calibration {
        position: PositionTable::fit(profile, &points).expect("a raster").with_open_share(0.01),
        capacitance_gain: 180.0,
        force_gain: 8e-6,
        contact_capacitance: 1.0,
        force_table: ForceTable::default(),
    };
    calibration.check(profile).expect("a calibration within its formats");
    calibration
}

/// How far a result is off, in percent of what it should be.
pub fn percent(found: f64, ideal: f64) -> f64 {
    100.0 * (found / ideal - 1.0)
}

/// The root of the mean of squares.
pub fn rms(values: impl IntoIterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values {
        sum += value * value;
        count += 1.0;
    }
    (sum / f64::max(count, 1.0)).sqrt()
}
