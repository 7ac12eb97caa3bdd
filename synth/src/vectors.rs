// SPDX-License-Identifier: MIT OR Apache-2.0
//! Vectors for users of the Verilog who have no Rust: a calibration, one slot of samples, and the frame that follows.
//!
//! `rtl/verilog/vectors/` holds them for the small profile; `synth/run vectors` makes them, a test holds them fresh.
//! The samples are a carrier of five samples a period and some noise; no plant is behind them.

use crate::sources::File;
use hapticore_model::block::Block;
use hapticore_model::blocks::core::{Core, Inputs, Outputs};
use hapticore_model::bundle::Bundle;
use hapticore_model::profile::Profile;
use hapticore_model::signal::Signal;
use std::fmt::Write as _;

/// The profile that they are for.
pub const PROFILE: &str = "small";

/// A full scale of sine over five samples, in codes of 16 bits.
const CARRIER: [i64; 5] = [0, 31_163, 19_260, -19_260, -31_163];

/// Sixty-fourths of a full scale of each channel, and by how many samples it lags.
const CHANNELS: [(i64, usize); 8] = [(9, 1), (7, 1), (8, 2), (10, 1), (4, 1), (5, 2), (48, 0), (30, 0)];

/// The codes of the channels at a sample.
fn codes(sample: usize, noise: &mut u32) -> Vec<i64> {
    let code = |&(share, lag): &(i64, usize)| {
        *noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        CARRIER[(sample + 5 - lag) % 5] * share / 64 + i64::from(*noise >> 29)
    };
    CHANNELS.iter().map(code).collect()
}

/// The files.
pub fn files() -> Vec<File> {
    let profile = Profile::bundled(PROFILE).expect("a bundled profile");
    let core = Core::new(&profile);
    let (formats, mut cell) = (core.inputs(), core.cell::<i64>());
    let middle = |bits: u8| 1_i64 << (bits - 1);
    let constants = Inputs {
        scale_x: middle(formats.scale_x.width),
        scale_y: middle(formats.scale_y.width),
        capacitance_gain: middle(formats.capacitance_gain.width),
        force_gain: middle(formats.force_gain.width),
        ..Inputs::map(formats, |_| 0)
    };
    let mut outputs = Outputs::map(core.outputs(), |_| 0_i64);
    let mut frames = String::from("pad,index,word,clipped,saturated,invalid,lost\n");
    let mut clock = |inputs: Inputs<i64>, asked: &mut i64| {
        let signals = Inputs::map(Inputs::zip(inputs, formats), |(value, format)| Signal { value, format });
        outputs = Outputs::map(core.clock(&mut cell, signals), |signal| signal.value);
        let Outputs { channel, valid, pad, index, frame, clipped, saturated, invalid, lost, .. } = outputs;
        *asked = channel;
        if valid == 1 {
            writeln!(frames, "{pad},{index},{frame},{clipped},{saturated},{invalid},{lost}").expect("a string grows");
        }
    };

    let mut calibration = String::from("what,code\n");
    Inputs::each(constants, |name, code| {
        if name.starts_with("origin") || name.starts_with("scale") || name.ends_with("gain") {
            writeln!(calibration, "{name},{code}").expect("a string grows");
        }
    });
    let (mut asked, most) = (0, formats.word.max_code() as i64);
    for address in 0..core.estimator().map().words().words as i64 {
        let word = (address * 7919) % most - most / 2;
        writeln!(calibration, "{address},{word}").expect("a string grows");
        clock(Inputs { write: 1, address, word, ..constants }, &mut asked);
    }

    let (mut samples, mut noise) = (String::from("i1,i2,i3,i4,i5,i6,v_sense,v_haptic\n"), 1);
    for sample in 0..profile.slot.samples() as usize {
        let codes = codes(sample, &mut noise);
        let row: Vec<_> = codes.iter().map(i64::to_string).collect();
        writeln!(samples, "{}", row.join(",")).expect("a string grows");
        for step in 0..profile.clocks_per_sample {
            clock(Inputs { strobe: i64::from(step == 0), code: codes[asked as usize], ..constants }, &mut asked);
        }
    }
    for _ in 0..core.latency() {
        clock(constants, &mut asked);
    }
    let file = |name: &str, text: String| File { name: name.into(), text };
    vec![file("calibration.csv", calibration), file("samples.csv", samples), file("frames.csv", frames)]
}
