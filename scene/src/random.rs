// SPDX-License-Identifier: MIT OR Apache-2.0
//! Random streams named by what they are for, so that no stream depends on how much another was
//! used.

use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::rand_core::SeedableRng;

/// A fast generator of good quality, started afresh for each name.
pub(crate) type Stream = rand_xoshiro::Xoshiro256PlusPlus;

/// What noise comes from: each has a stream of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Origin {
    Adc,
    Amplifier,
    Dither,
    Panel,
}

/// What a stream is for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Purpose {
    Gain,
    Offset,
    PhasorNoise(Origin),
    /// Of a run that starts this many samples after its slot.
    SampleNoise {
        origin: Origin,
        from: u64,
    },
    PhasorJitter,
    /// Sampling jitter of a run that starts this many samples after its slot.
    SampleJitter {
        from: u64,
    },
}

/// What is added to a purpose's number for each that came after it, more than a slot has samples.
const NEXT: u64 = 1 << 40;

impl Purpose {
    fn number(self) -> u64 {
        match self {
            Purpose::Gain => 1,
            Purpose::Offset => 2,
            Purpose::PhasorNoise(origin) => 3 + NEXT * origin as u64,
            Purpose::SampleNoise { origin, from } => 4 + from + NEXT * origin as u64,
            Purpose::PhasorJitter => 3 + NEXT * 8,
            Purpose::SampleJitter { from } => 4 + from + NEXT * 8,
        }
    }
}

/// The stream for `purpose` at `place` (case, slot) of a scene with this seed.
pub(crate) fn stream(seed: u64, place: [u64; 2], purpose: Purpose) -> Stream {
    let name = [place[0], place[1], purpose.number()];
    Stream::seed_from_u64(name.into_iter().fold(mix(seed), |hash, part| mix(hash ^ part)))
}

/// A standard normal number.
pub(crate) fn normal(random: &mut Stream) -> f64 {
    StandardNormal.sample(random)
}

/// Standard normal numbers that belong to the hardware: the same in every case and slot.
pub(crate) fn normals(seed: u64, purpose: Purpose) -> impl Iterator<Item = f64> {
    let mut random = stream(seed, [0, 0], purpose);
    std::iter::repeat_with(move || normal(&mut random))
}

/// One step of SplitMix64: every bit of the input reaches every bit of the output (Steele, Lea and
/// Flood, 2014).
fn mix(word: u64) -> u64 {
    let word = word.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}
