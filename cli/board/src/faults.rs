// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is wrong with a virtual board: its wires and pads, data lines of its ADC, its serial line.
//!
//! ```text
//! terminals, pads ─[wiring]─ codes ─[data lines]─ core ─ packets ─[serial line]─ bytes
//! ```

use fastrand::Rng;

mod request;

pub use request::Request;

/// A fault of a wire, a pad or a data line. Channels count the terminals, then the sensing and the haptic voltage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wrong {
    /// Nothing comes over the wire of a channel.
    Open(usize),
    /// The wires of two terminals are exchanged.
    Swapped(usize, usize),
    /// The wire of a terminal is connected the wrong way round.
    Reversed(usize),
    /// A channel has noise of this RMS, full scales.
    Noisy(usize, f64),
    /// A channel is at full scale at ±10 V, and not at ±12.5 V: its gain is too large.
    Clipped(usize),
    /// No current flows to a pad: its wire or its switch is open.
    PadMissing(usize),
    /// The select lines of two pads are exchanged.
    PadsSwapped(usize, usize),
    /// A data line of the ADC is low.
    LineLow(usize),
    /// A data line of the ADC is high.
    LineHigh(usize),
    /// A data line of the ADC, the first, brings what another does.
    LineShorted(usize, usize),
}

impl Wrong {
    /// The fault in words.
    pub fn words(self) -> String {
        let line = |line: usize| format!("dout[{line}] (DOUT{})", letter(line));
        match self {
            Wrong::Open(channel) => format!("wire of channel {} open", channel + 1),
            Wrong::Swapped(a, b) => format!("wires of terminals {} and {} swapped", a + 1, b + 1),
            Wrong::Reversed(channel) => format!("wire of terminal {} reversed", channel + 1),
            Wrong::Noisy(channel, _) => format!("channel {} noisy", channel + 1),
            Wrong::Clipped(channel) => format!("channel {} clipped", channel + 1),
            Wrong::PadMissing(pad) => format!("pad {pad} missing"),
            Wrong::PadsSwapped(a, b) => format!("pads {a} and {b} swapped"),
            Wrong::LineLow(of) => format!("{} low", line(of)),
            Wrong::LineHigh(of) => format!("{} high", line(of)),
            Wrong::LineShorted(of, to) => format!("{} shorted to {}", line(of), line(to)),
        }
    }
}

/// The letter of a data line of the ADC.
pub fn letter(line: usize) -> char {
    char::from(b'A' + line.min(25) as u8)
}

/// What happens to the bytes of the serial line.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Noise {
    /// Share of bytes that are lost.
    pub lost: f64,
    /// Share of bytes of which a bit is another.
    pub flipped: f64,
}

/// All faults of a virtual board.
#[derive(Debug, Clone)]
pub struct Faults {
    /// Wires, pads and data lines.
    pub wrong: Vec<Wrong>,
    /// The serial line to the host.
    pub noise: Noise,
    random: Rng,
    /// The last codes of each pad, where select lines are exchanged.
    last: Vec<Vec<i32>>,
}

impl Faults {
    /// A sound board; noise that is added later is drawn by the seed.
    pub fn none(seed: u64) -> Self {
        let random = Rng::with_seed(seed);
        Faults { wrong: Vec::new(), noise: Noise::default(), random, last: Vec::new() }
    }

    /// What the core receives of a slot: `codes` are of its window, a sample after the other, each of all channels.
    /// `gains` are those of the ADC's ranges against ±10 V.
    pub fn act(
        &mut self,
        pad: usize,
        codes: &mut Vec<i32>,
        (channels, limit): (usize, i32),
        gains: &[f64],
    ) {
        let wrong = std::mem::take(&mut self.wrong);
        for fault in &wrong {
            match *fault {
                Wrong::PadsSwapped(a, b) if pad == a || pad == b => {
                    self.exchange(pad, a + b - pad, codes);
                }
                Wrong::PadMissing(of) if of == pad => {
                    let currents = channels - 2;
                    codes.chunks_mut(channels).for_each(|sample| sample[..currents].fill(0));
                }
                _ => (),
            }
        }
        let peaks: Vec<i32> = (0..channels).map(|channel| peak(codes, channel, channels)).collect();
        for sample in codes.chunks_mut(channels) {
            wrong.iter().for_each(|fault| self.at_sample(*fault, sample, (&peaks, limit), gains));
            for (code, gain) in sample.iter_mut().zip(gains) {
                if *gain != 1.0 {
                    *code = clamped(gain * f64::from(*code), limit);
                }
            }
            let before = sample.to_vec();
            wrong.iter().for_each(|fault| on_lines(*fault, sample, &before));
        }
        self.wrong = wrong;
    }

    /// A pad's codes in place of another's, as of that one's last slot.
    fn exchange(&mut self, pad: usize, other: usize, codes: &mut Vec<i32>) {
        if self.last.len() <= pad.max(other) {
            self.last.resize(pad.max(other) + 1, Vec::new());
        }
        self.last[pad].clone_from(codes);
        match self.last[other].is_empty() {
            true => codes.fill(0),
            false => codes.clone_from(&self.last[other]),
        }
    }

    fn at_sample(
        &mut self,
        fault: Wrong,
        sample: &mut [i32],
        (peaks, limit): (&[i32], i32),
        gains: &[f64],
    ) {
        match fault {
            Wrong::Open(channel) => sample[channel] = 0,
            Wrong::Swapped(a, b) => sample.swap(a, b),
            Wrong::Reversed(channel) => {
                sample[channel] = clamped(-f64::from(sample[channel]), limit);
            }
            Wrong::Noisy(channel, rms) => {
                let noise = rms * f64::from(limit) * self.gaussian();
                sample[channel] = clamped(f64::from(sample[channel]) + noise, limit);
            }
            Wrong::Clipped(channel) => {
                // A tenth beyond full scale at the peak, whatever flows; the range acts on it before it is limited.
                let gain = 1.1 * f64::from(limit) / f64::from(peaks[channel].max(1));
                let range = gains.get(channel).copied().unwrap_or(1.0);
                let code = clamped(gain * range * f64::from(sample[channel]), limit);
                sample[channel] = (f64::from(code) / range).round() as i32;
            }
            _ => (),
        }
    }

    /// A number of a normal distribution (Box and Muller, Annals of Mathematical Statistics 29, 1958).
    fn gaussian(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.random.f64()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.random.f64()).cos()
    }

    /// The codes that data lines bring of those that the ADC puts out.
    pub fn on_lines(&self, codes: &mut [i32]) {
        let before = codes.to_vec();
        self.wrong.iter().for_each(|fault| on_lines(*fault, codes, &before));
    }

    /// What the first data line brings of the ADC's answer to a word for a register; the other lines are low meanwhile.
    pub fn answer(&self, answer: u16) -> u16 {
        self.wrong.iter().fold(answer, |answer, fault| match fault {
            Wrong::LineLow(0) | Wrong::LineShorted(0, _) => 0,
            Wrong::LineHigh(0) => u16::MAX,
            _ => answer,
        })
    }

    /// What is left of bytes on the serial line.
    pub fn on_serial_line(&mut self, bytes: &mut Vec<u8>) {
        let Noise { lost, flipped } = self.noise;
        if lost > 0.0 {
            bytes.retain(|_| self.random.f64() >= lost);
        }
        if flipped > 0.0 {
            for byte in bytes {
                if self.random.f64() < flipped {
                    *byte ^= 1 << self.random.u8(0..8);
                }
            }
        }
    }
}

/// Codes of the ADC's channels over those at ±10 V, by the registers of its ranges.
pub fn gains(ranges: [u8; 4]) -> [f64; 8] {
    const VOLTS: [f64; 5] = [2.5, 5.0, 6.25, 10.0, 12.5];
    std::array::from_fn(|channel| {
        let range = ranges[channel / 2] >> (4 * (channel % 2)) & 0xf;
        VOLTS.get(usize::from(range)).map_or(1.0, |volts| 10.0 / volts)
    })
}

/// A code within the ADC's range.
fn clamped(code: f64, limit: i32) -> i32 {
    code.round().clamp(-f64::from(limit) - 1.0, f64::from(limit)) as i32
}

fn peak(codes: &[i32], channel: usize, channels: usize) -> i32 {
    codes
        .iter()
        .skip(channel)
        .step_by(channels)
        .map(|code| code.saturating_abs())
        .max()
        .unwrap_or(0)
}

fn on_lines(fault: Wrong, sample: &mut [i32], before: &[i32]) {
    match fault {
        Wrong::LineLow(line) => sample[line] = 0,
        Wrong::LineHigh(line) => sample[line] = -1,
        Wrong::LineShorted(line, other) => sample[line] = before[other],
        _ => (),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn acted(wrong: &[Wrong], codes: &[i32]) -> Vec<i32> {
        let mut faults = Faults { wrong: wrong.to_vec(), ..Faults::none(1) };
        let mut codes = codes.to_vec();
        faults.act(0, &mut codes, (5, 32767), &[1.0; 5]);
        codes
    }

    #[test]
    fn each_fault_changes_its_channel_and_no_other() {
        let codes = [100, 200, 300, 400, 500, -100, -200, -300, -400, -500];
        assert_eq!(acted(&[], &codes), codes);
        assert_eq!(acted(&[Wrong::Open(1)], &codes)[..5], [100, 0, 300, 400, 500]);
        assert_eq!(acted(&[Wrong::Swapped(0, 2)], &codes)[5..], [-300, -200, -100, -400, -500]);
        assert_eq!(acted(&[Wrong::Reversed(2)], &codes)[..5], [100, 200, -300, 400, 500]);
        assert_eq!(acted(&[Wrong::PadMissing(0)], &codes)[..5], [0, 0, 0, 400, 500]);
        assert_eq!(acted(&[Wrong::PadMissing(1)], &codes), codes);
        assert_eq!(acted(&[Wrong::Clipped(0)], &codes)[..2], [32767, 200]);
        assert_eq!(acted(&[Wrong::LineHigh(3)], &codes)[..5], [100, 200, 300, -1, 500]);
        assert_eq!(acted(&[Wrong::LineShorted(0, 1)], &codes)[..2], [200, 200]);
        let noisy = acted(&[Wrong::Noisy(1, 0.1)], &codes);
        assert!(noisy[1] != 200 && noisy[0] == 100);
    }
}
