// SPDX-License-Identifier: MIT OR Apache-2.0
//! Standard normal numbers: those of [`StandardNormal`], to the bit, in fewer instructions.
//!
//! The library draws by the ziggurat method (Doornik, *An Improved Ziggurat Method to Generate Normal
//! Random Samples*, 2005). The lower byte of a word chooses layer i, the upper 52 bits a place u in
//! [-1, 1) on it; x = u·w_i is the number if |x| < w_(i+1), w_i being half a layer's width. That is so for
//! 98.5 of 100 words, and all that is done here. The others go to the library.

use std::convert::Infallible;
use std::sync::LazyLock;

use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::rand_core::utils::fill_bytes_via_next_word;
use rand_xoshiro::rand_core::{Rng, TryRng};

use super::Stream;

/// Half the width of each layer, and 0 above the last.
type Widths = [f64; 257];

/// Those of the library, which says them if it is asked for small enough numbers.
static WIDTHS: LazyLock<Widths> = LazyLock::new(|| {
    let mut widths = [0.0; 257];
    for (layer, width) in (0..256).zip(&mut widths) {
        let word = SMALL << 12 | layer;
        let number: f64 = StandardNormal.sample(&mut Words { first: Some(word), then: || 1 << 63 });
        *width = number / place(word);
    }
    widths
});

/// The upper bits of a word whose place is 2⁻⁵⁰: a number so small is in every layer, and the width
/// is multiplied by a power of two.
const SMALL: u64 = (1 << 51) + 2;

/// The place on its layer that a word chooses.
fn place(word: u64) -> f64 {
    f64::from_bits(word >> 12 | 2f64.to_bits()) - 3.0
}

/// A word that has been drawn, and those after it.
struct Words<Then> {
    first: Option<u64>,
    then: Then,
}

impl<Then: FnMut() -> u64> TryRng for Words<Then> {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        self.try_next_u64().map(|word| word as u32)
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        Ok(self.first.take().unwrap_or_else(&mut self.then))
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        fill_bytes_via_next_word(bytes, || self.try_next_u64())
    }
}

/// Standard normal numbers one after the other.
#[inline(never)]
pub(crate) fn draw(random: &mut Stream, numbers: &mut [f64]) {
    let widths: &Widths = &WIDTHS;
    let mut state = random.clone();
    for number in numbers {
        let word = state.next_u64();
        let layer = word as usize & 0xff;
        *number = place(word) * widths[layer];
        if number.abs() >= widths[layer + 1] {
            // A copy, so that the state itself stays in registers.
            let mut after = state;
            *number = from_word(word, &mut after);
            state = after;
        }
    }
    *random = state;
}

/// The number that the library makes of a word and, if it is not on the word's layer, of those after it.
#[cold]
#[inline(never)]
fn from_word(word: u64, random: &mut Stream) -> f64 {
    StandardNormal.sample(&mut Words { first: Some(word), then: || random.next_u64() })
}

/// A standard normal number.
pub(crate) fn normal(random: &mut Stream) -> f64 {
    let mut number = [0.0];
    draw(random, &mut number);
    number[0]
}

#[cfg(test)]
mod tests {
    use rand_xoshiro::rand_core::SeedableRng;

    use super::*;

    /// 30,000 of these words are not on their layer, 490 of them on the lowest, whose rest is the tail.
    #[test]
    fn numbers_and_state_are_those_of_the_library() {
        for seed in 0..2 {
            let (mut ours, mut library) =
                (Stream::seed_from_u64(seed), Stream::seed_from_u64(seed));
            let mut numbers = vec![0.0; 1_000_000];
            draw(&mut ours, &mut numbers);
            for (index, number) in numbers.into_iter().enumerate() {
                let expected: f64 = StandardNormal.sample(&mut library);
                assert_eq!(number.to_bits(), expected.to_bits(), "{index}: {number} {expected}");
            }
            assert_eq!(ours, library);
        }
    }

    #[test]
    fn layers_get_narrower_and_the_lowest_but_one_is_as_wide_as_the_tail_begins() {
        assert!(WIDTHS.is_sorted_by(|wide, narrow| wide > narrow));
        assert_eq!(WIDTHS[1], 3.654152885361009);
    }
}
