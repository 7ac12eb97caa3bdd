// SPDX-License-Identifier: MIT OR Apache-2.0
//! Slots: what the ADC sees, and how its strobes come.

use super::Noise;

/// Terminals, sensing voltage, haptic voltage.
pub const CHANNELS: usize = 8;

/// A full scale of sine over five samples, in codes of 16 bits.
const CARRIER: [i64; 5] = [0, 31_163, 19_260, -19_260, -31_163];

/// A full scale's part that amplitudes are often given in, in codes.
const SHARE: i64 = 32_768 / 64;

/// What the ADC sees in a slot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Slot {
    /// Signals of a pad on the sheet.
    Pad,
    /// A pad with small currents.
    Faint,
    /// A pad; one terminal has no current.
    OpenTerminal,
    /// Currents, but no sensing voltage.
    NoVoltage,
    /// All current at the terminals with a sign of this kind: ratios of one.
    OneSide(bool),
    /// Tones of one size or of any, in step or of any phase, that may begin within the window.
    Any,
    /// Tones of any phase beyond full scale.
    Loud,
    /// Tones of one phase at full scale, one of the full size of a sum.
    Alike(i64),
    /// Tones of any phase and size that begin within the window: its two halves no longer cancel
    /// what is not in phase.
    Late,
    /// A constant behind each code.
    Offset,
    /// A few codes about zero.
    Noise,
    /// All codes zero.
    Silence,
    /// Codes at either end of full scale.
    FullScale,
    /// Currents of a few codes.
    Whisper,
    /// Currents of which three have the sign that the others do not: next to nothing is their
    /// total.
    Cancelling,
    /// Currents whose amplitudes have a power of two for a sum: ratios lie halfway.
    PowerSum,
    /// A pad with haptic codes whose products with the window lie halfway.
    Halfway,
    /// A pad, but a strobe comes a clock too early, some come late, and the slot is abandoned
    /// before its end.
    Abandoned,
    /// A pad whose slot ends with `clear`, a clock after the strobe of this sample, counted from one.
    Cut(u64),
}

impl Slot {
    /// Whether `clear` follows its last sample.
    pub fn is_abandoned(self) -> bool {
        matches!(self, Slot::Abandoned | Slot::Cut(_))
    }
}

/// What a channel sees.
#[derive(Debug, Clone, Copy, Default)]
pub struct Tone {
    /// Amplitude, in codes.
    size: i64,
    /// Delay, in samples.
    lag: i64,
    /// Offset, in codes.
    offset: i64,
    /// Samples of the window before it begins.
    onset: u64,
}

/// Terminals within a third of each other, so that most places are found, and anything at the other
/// channels.
fn any(noise: &mut Noise) -> [Tone; CHANNELS] {
    let (turn, size) = (noise.below(5), 1 + noise.below(4) * noise.below(60));
    let (late, apart) = (noise.below(2) * noise.below(400), noise.below(4) == 0);
    let offset = noise.below(4) / 3 * (noise.below(8000) - 4000);
    std::array::from_fn(|channel| {
        let share =
            if channel < 6 { size + noise.below(2 + size as u32 / 3) } else { noise.below(200) };
        let lag = turn + i64::from(channel < 6) + if apart { noise.below(5) } else { 0 };
        Tone { size: SHARE * share, lag: lag % 5, offset, onset: late as u64 }
    })
}

impl Slot {
    /// Of each channel, what it sees.
    pub fn tones(self, noise: &mut Noise) -> [Tone; CHANNELS] {
        let of = |share: i64, lag: i64| Tone { size: SHARE * share, lag, ..Tone::default() };
        let small = |size: i64| Tone { size, lag: 1, ..Tone::default() };
        let pad: [Tone; CHANNELS] = std::array::from_fn(|channel| match channel {
            6 => of(40 + noise.below(16), 0),
            7 => of(4 + noise.below(50), 0),
            _ => of(4 + noise.below(7), 1),
        });
        let with = |change: &mut dyn FnMut(usize, Tone) -> Tone| {
            std::array::from_fn(|channel| change(channel, pad[channel]))
        };
        match self {
            Slot::Faint => with(&mut |k, tone| {
                if k < 6 { of(1 + tone.size / SHARE / 8, tone.lag) } else { tone }
            }),
            Slot::OpenTerminal => with(&mut |k, tone| if k == 2 { of(0, 0) } else { tone }),
            Slot::NoVoltage => with(&mut |k, tone| if k == 6 { of(0, 0) } else { tone }),
            // Of `small`: 3 and 4 are on the right, 1 and 2 on the left.
            Slot::OneSide(right) => with(&mut |k, tone| match k {
                2 | 3 if right => of(50, 1),
                0 | 1 if !right => of(50, 1),
                0..6 => of(0, 0),
                _ => tone,
            }),
            Slot::Any => any(noise),
            Slot::Loud => with(&mut |_, _| of(64 + noise.below(128), noise.below(5))),
            Slot::Alike(lag) => with(&mut |_, _| of(256, lag)),
            Slot::Late => with(&mut |_, _| Tone {
                onset: noise.below(400) as u64,
                ..of(1 + noise.below(70), noise.below(5))
            }),
            Slot::Offset => {
                with(&mut |_, tone| Tone { offset: 4 * noise.below(6000) - 12_000, ..tone })
            }
            Slot::Whisper => {
                with(&mut |k, tone| if k < 6 { small(3 + noise.below(5)) } else { tone })
            }
            Slot::Cancelling => with(&mut |k, tone| match k {
                0..6 if k % 2 == 0 => small(10_240 + noise.below(300)),
                0..6 => small(-10_240),
                _ => tone,
            }),
            Slot::PowerSum => {
                let mut last = 0;
                with(&mut |k, tone| match k {
                    0..6 if k % 2 == 0 => {
                        last = noise.below(8000);
                        small(26_254 + last)
                    }
                    0..6 => small(26_254 - last + noise.below(4)),
                    _ => tone,
                })
            }
            Slot::Noise | Slot::Silence => [Tone::default(); CHANNELS],
            Slot::Pad | Slot::FullScale | Slot::Halfway | Slot::Abandoned | Slot::Cut(_) => pad,
        }
    }

    /// The codes of the channels at a sample of the window.
    pub fn codes(
        self,
        tones: &[Tone; CHANNELS],
        sample: u64,
        noise: &mut Noise,
    ) -> [i64; CHANNELS] {
        std::array::from_fn(|channel| {
            let Tone { size, lag, offset, onset } = tones[channel];
            let code = match self {
                Slot::Silence => 0,
                Slot::FullScale if (sample as usize + channel).is_multiple_of(3) => {
                    i64::from(i16::MIN)
                }
                Slot::FullScale => i64::from(i16::MAX),
                Slot::Halfway if channel == CHANNELS - 1 => (noise.below(7) - 3) << 13,
                _ if sample < onset => 0,
                _ => {
                    CARRIER[(sample as usize + 5 - lag as usize) % 5] * size / 32_768
                        + offset
                        + noise.below(8)
                        - 4
                }
            };
            code.clamp(i16::MIN.into(), i16::MAX.into())
        })
    }

    /// How many of its samples come.
    pub fn samples(self, whole: u64) -> u64 {
        match self {
            Slot::Abandoned => whole - 100,
            Slot::Cut(samples) => samples,
            _ => whole,
        }
    }

    /// Clocks from the strobe of a sample on to the next one.
    pub fn clocks(self, sample: u64, usual: u64) -> u64 {
        match (self, sample) {
            (Slot::Abandoned, 0) => usual + 3,
            (Slot::Abandoned, 9) => usual - 1,
            _ => usual,
        }
    }
}
