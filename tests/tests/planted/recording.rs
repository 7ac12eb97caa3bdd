// SPDX-License-Identifier: MIT OR Apache-2.0
//! A recording of a device, sample by sample, and the files that recorders make of it.

use std::f64::consts::TAU;
use std::fmt::Write;

use fastrand::Rng;

use super::device::{CURRENT_A, Device, HAPTIC_V, RATE_HZ, SENSE_V};

/// Samples of a slot, and of them with the switch open: those of the profile `standard`.
pub const SLOT: usize = 1700;
const OPEN: usize = 10;

/// Noise of a channel, rms, of full scale.
const NOISE: f64 = 2e-5;

/// A recording: fractions of full scale, one list for each sample.
pub struct Recording {
    pub samples: Vec<Vec<f64>>,
    pub terminals: usize,
}

impl Recording {
    /// `slots` slots of a device.
    pub fn of(device: &Device, slots: usize, rng: &mut Rng) -> Recording {
        let mut samples = Vec::with_capacity(slots * SLOT);
        for slot in 0..slots {
            let pad = slot % device.pads.len();
            let at_mm = device.at_mm(pad, slot as f64 / slots as f64);
            let drawn = &device.pads[pad];
            let currents = device.currents(drawn.farad, at_mm);
            for n in 0..SLOT {
                let (sine, cosine) = (TAU * (n as f64 * 0.101).fract()).sin_cos();
                let closed = if n < OPEN { 0.0 } else { 1.0 };
                let mut noise = || NOISE * 3f64.sqrt() * (2.0 * rng.f64() - 1.0);
                let current = |[re, im]: &[f64; 2]| closed * (re * cosine - im * sine) / CURRENT_A;
                let mut sample: Vec<f64> = currents.iter().map(current).collect();
                sample.push(device.sensing_v() * cosine / SENSE_V);
                let time_s = (slot * SLOT + n) as f64 / RATE_HZ;
                let haptic =
                    drawn.haptic_v_rms * 2f64.sqrt() * (TAU * drawn.haptic_hz * time_s).sin();
                sample.push(haptic / HAPTIC_V);
                sample.iter_mut().for_each(|value| *value += noise());
                samples.push(sample);
            }
        }
        Recording { samples, terminals: device.terminals_mm.len() }
    }

    /// Names of the channels.
    pub fn names(&self) -> Vec<String> {
        let terminals = (1..=self.terminals).map(|k| format!("i{k}"));
        terminals.chain(["v_sense".into(), "v_haptic".into()]).collect()
    }

    fn codes(&self, bits: u32) -> impl Iterator<Item = Vec<i64>> + '_ {
        let full = f64::from(1u32 << (bits - 1));
        self.samples.iter().map(move |sample| {
            sample
                .iter()
                .map(|value| (value * full).round().clamp(-full, full - 1.0) as i64)
                .collect()
        })
    }

    /// A WAV file of 24 bits with this rate; `size` in place of its samples' bytes.
    pub fn wav(&self, rate: u32, size: Option<u32>) -> Vec<u8> {
        let channels = (self.terminals + 2) as u32;
        let data: Vec<u8> = self
            .codes(24)
            .flatten()
            .flat_map(|code| (code as i32).to_le_bytes()[..3].to_vec())
            .collect();
        let size = size.unwrap_or(data.len() as u32);
        let mut file = b"RIFF".to_vec();
        file.extend(size.wrapping_add(36).to_le_bytes());
        file.extend(b"WAVEfmt ");
        file.extend(16u32.to_le_bytes());
        file.extend([1u16, channels as u16].map(u16::to_le_bytes).concat());
        file.extend([rate, rate * channels * 3].map(u32::to_le_bytes).concat());
        file.extend([channels as u16 * 3, 24].map(u16::to_le_bytes).concat());
        file.extend(b"data");
        file.extend(size.to_le_bytes());
        file.extend(data);
        file
    }

    /// A CSV file of codes of `bits` bits, which its head names or does not.
    pub fn csv(&self, bits: u32, named: bool) -> String {
        let mut text = if named { format!("# bits = {bits}\n") } else { String::new() };
        text += &(self.names().join(",") + "\n");
        for row in self.codes(bits) {
            let cells: Vec<String> = row.iter().map(i64::to_string).collect();
            text += &(cells.join(",") + "\n");
        }
        text
    }

    /// A CSV file of volts, 10 of them at full scale, with a column of times; `time_s` is that of
    /// each sample.
    pub fn volts(&self, time_s: impl Fn(usize) -> f64) -> String {
        let mut text = format!("Time,{}\n", self.names().join(","));
        for (n, sample) in self.samples.iter().enumerate() {
            write!(text, "{:.7}", time_s(n)).expect("a string takes all");
            sample.iter().for_each(|value| {
                write!(text, ",{:.6}", 10.0 * value).expect("a string takes all")
            });
            text.push('\n');
        }
        text
    }
}
