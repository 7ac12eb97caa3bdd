// SPDX-License-Identifier: MIT OR Apache-2.0
//! Vectors for users of the Verilog who have no Rust: a calibration, slots of samples, and the frames that follow.
//!
//! `rtl/verilog/vectors/` holds them for the small profile; `synth/run vectors` makes them, a test holds them fresh. The
//! calibration is that of a sheet whose ratios flatten towards its edges. Most slots are pads somewhere on it, a carrier of five
//! samples a period with some noise; the last ones are what breaks a careless core. No plant is behind them.

use crate::sources::File;
use hapticore_model::block::{Block, Cell};
use hapticore_model::blocks::core::{Core, Inputs, Outputs};
use hapticore_model::bundle::Bundle;
use hapticore_model::calibration::{Calibration, Point, PositionTable};
use hapticore_model::profile::Profile;
use hapticore_model::signal::Signal;
use hapticore_rtl::codes::{Codes, Constant};
use std::fmt::Write as _;

/// The profile that they are for.
pub const PROFILE: &str = "small";

/// A full scale of sine over five samples, in codes of 16 bits.
const CARRIER: [i64; 5] = [0, 31_163, 19_260, -19_260, -31_163];

/// Terminals, sensing voltage, haptic voltage.
const CHANNELS: usize = 8;

/// What the ADC sees in a slot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Slot {
    /// A pad.
    Pad,
    /// A pad with small currents.
    Faint,
    /// A pad; one terminal has no current.
    OpenTerminal,
    /// Currents, but no sensing voltage.
    NoVoltage,
    /// A few codes about zero.
    Noise,
    /// Zero.
    Silence,
    /// Codes at either rail.
    Rails,
}

const SLOTS: [Slot; 16] = [
    Slot::Pad,
    Slot::Pad,
    Slot::Pad,
    Slot::Pad,
    Slot::Pad,
    Slot::Pad,
    Slot::Pad,
    Slot::Pad,
    Slot::Faint,
    Slot::Faint,
    Slot::OpenTerminal,
    Slot::NoVoltage,
    Slot::Noise,
    Slot::Silence,
    Slot::Rails,
    Slot::Pad,
];

/// Numbers without a pattern, the same everywhere.
struct Noise(u32);

impl Noise {
    fn below(&mut self, most: u32) -> i64 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        i64::from((self.0 >> 16) % most)
    }
}

/// Of each channel, 64ths of full scale, and by how many samples it lags.
fn tones(slot: Slot, noise: &mut Noise) -> [(i64, i64); CHANNELS] {
    let mut tones: [(i64, i64); CHANNELS] = std::array::from_fn(|channel| match channel {
        6 => (40 + noise.below(16), 0),
        7 => (4 + noise.below(50), 0),
        _ => (4 + noise.below(7), 1),
    });
    match slot {
        Slot::Faint => tones[..6].iter_mut().for_each(|tone| tone.0 = 1 + tone.0 / 8),
        Slot::OpenTerminal => tones[2].0 = 0,
        Slot::NoVoltage => tones[6].0 = 0,
        Slot::Noise | Slot::Silence => tones = [(0, 0); CHANNELS],
        Slot::Pad | Slot::Rails => (),
    }
    tones
}

/// The codes of the channels at a sample of the window.
fn codes(slot: Slot, tones: &[(i64, i64); CHANNELS], sample: usize, noise: &mut Noise) -> [i64; CHANNELS] {
    std::array::from_fn(|channel| {
        let (share, lag) = tones[channel];
        match slot {
            Slot::Silence => 0,
            Slot::Rails if (sample + channel).is_multiple_of(3) => i64::from(i16::MIN),
            Slot::Rails => i64::from(i16::MAX),
            _ => CARRIER[(sample + 5 - lag as usize) % 5] * share / 64 + noise.below(8) - 4,
        }
    })
}

/// A calibration such as a sheet has.
fn calibration(profile: &Profile) -> Calibration {
    let (columns, rows) = (41, 25);
    let point = |k: usize| {
        let (u, v) = ((k % columns) as f64 / 20.0 - 1.0, (k / columns) as f64 / 12.0 - 1.0);
        let r_x = u * (0.95 - 0.2 * u * u) * (1.0 - 0.15 * v * v);
        let r_y = v * (0.9 - 0.2 * v * v) * (1.0 - 0.3 * u * u);
        Point { x: 400.0 * u, y: 220.0 * v, r_x, r_y, sheet: 0.05 + 0.02 * u * u + 0.01 * v }
    };
    let points: Vec<Point> = (0..columns * rows).map(point).collect();
    let position = PositionTable::fit(profile, &points).expect("a sheet");
    Calibration { position, capacitance_gain: 800.0, force_gain: 2e-6 }
}

/// A core at work, and what it has said.
struct Bench {
    core: Core,
    cell: Cell<Core, i64>,
    asked: i64,
    frames: String,
}

impl Bench {
    fn clock(&mut self, inputs: Inputs<i64>) {
        let formats = self.core.inputs();
        let signals = Inputs::map(Inputs::zip(inputs, formats), |(value, format)| Signal { value, format });
        let outputs = Outputs::map(self.core.clock(&mut self.cell, signals), |signal| signal.value);
        let Outputs { channel, valid, pad, index, frame, clipped, saturated, invalid, lost, .. } = outputs;
        self.asked = channel;
        if valid == 1 {
            writeln!(self.frames, "{pad},{index},{frame},{clipped},{saturated},{invalid},{lost}")
                .expect("a string grows");
        }
    }
}

/// The files.
pub fn files() -> Vec<File> {
    let profile = Profile::bundled(PROFILE).expect("a bundled profile");
    let core = Core::new(&profile);
    let calibration = calibration(&profile);
    let calibrated = Codes::new(&profile, &calibration);
    let constants = calibrated.inputs;
    let frames = String::from("pad,index,word,clipped,saturated,invalid,lost\n");
    let mut bench = Bench { cell: core.cell(), core, asked: 0, frames };
    let mut words = String::from("what,code\n");
    for Constant { name, code, .. } in calibrated.constants() {
        writeln!(words, "{name},{code}").expect("a string grows");
    }
    for (address, &word) in (0..).zip(&calibrated.table) {
        writeln!(words, "{address},{word}").expect("a string grows");
        bench.clock(Inputs { write: 1, address, word, ..constants });
    }

    let (mut samples, mut noise) = (String::from("i1,i2,i3,i4,i5,i6,v_sense,v_haptic\n"), Noise(1));
    for slot in SLOTS {
        let tones = tones(slot, &mut noise);
        for sample in 0..profile.slot.samples() {
            // Whatever comes while the pad settles is ignored.
            let window = sample >= profile.slot.blanking();
            let codes = if window { codes(slot, &tones, sample as usize, &mut noise) } else { [0; CHANNELS] };
            let row: Vec<_> = codes.iter().map(i64::to_string).collect();
            writeln!(samples, "{}", row.join(",")).expect("a string grows");
            for step in 0..profile.clocks_per_sample {
                bench.clock(Inputs { strobe: i64::from(step == 0), code: codes[bench.asked as usize], ..constants });
            }
        }
    }
    (0..bench.core.latency()).for_each(|_| bench.clock(constants));
    let file = |name: &str, text: String| File { name: name.into(), text };
    vec![file("calibration.csv", words), file("samples.csv", samples), file("frames.csv", bench.frames)]
}
