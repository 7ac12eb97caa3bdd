// SPDX-License-Identifier: MIT OR Apache-2.0
//! A window's sums of codes, or of numbers that nothing rounds: a plain loop over all channels.
//!
//! ```text
//! Σ x·(w·cos), Σ x·(w·sin)     or Σ x·w of each of the carrier's five phases;     Σ h·round(w·h)
//! ```
//!
//! The demodulator's operators are exact, so that the order in which its products are added does
//! not matter. Codes, words and partial sums are whole numbers below 2^53, which an `f64` holds
//! exactly, and of which a processor multiplies several per instruction. A test holds the frames
//! equal to those of every clock. With the words that an unrounded core has, the same loop gives
//! its sums.

use crate::blocks::oscillator::PHASES;

/// The words of a window, and how its haptic code is rounded.
pub(super) struct Words {
    /// By which a sample's codes are multiplied: windowed cosine and sine, or, of polyphase sums,
    /// the window alone.
    pub waves: Waves,
    /// The window's words.
    pub window: Vec<f64>,
    /// What is kept of the product of window and haptic code, a power of two: it is rounded.
    pub keep: f64,
    /// By how much the haptic code is moved up for the product that follows, a power of two.
    pub raise: f64,
    /// What is added to a number and taken away again: [`WHOLE`] rounds it, 0 does not.
    pub rounding: f64,
}

/// What a sample's codes are multiplied by.
pub(super) enum Waves {
    /// Windowed cosine and sine.
    Products(Vec<[f64; 2]>),
    /// The window alone, five phases apart, by which codes are multiplied that have the offset.
    Phases { offset: f64 },
}

/// The sums of a window of N channels, the last one haptic.
pub(super) struct PlainSums {
    words: Words,
    /// The loop over the samples, with the number of channels known to the compiler.
    sum: Sum,
    sums: Vec<f64>,
}

impl Words {
    /// What no partial sum exceeds, of codes that are at most `largest`: of a tone, of the squares,
    /// and four times a product that is rounded.
    fn largest_sums(&self, largest: f64) -> [f64; 3] {
        let tone = match &self.waves {
            Waves::Products(waves) => {
                let larger = waves.iter().map(|[cosine, sine]| cosine.abs().max(sine.abs()));
                larger.sum::<f64>() * largest
            }
            Waves::Phases { offset } => self.window.iter().sum::<f64>() * (largest + offset),
        };
        let product = |window: &f64| window * largest;
        let share = |window: &f64| product(window) * self.keep + 1.0;
        let square = self.window.iter().map(|window| largest * self.raise * share(window));
        let rounded = self.window.iter().map(product).fold(0.0, f64::max);
        [tone, square.sum(), 4.0 * rounded]
    }
}

/// Whole numbers below this are exact.
const EXACT: f64 = (1u64 << 53) as f64;
/// Adding this to a number below 2^51 leaves no fraction: the sum is rounded half to even.
pub(super) const WHOLE: f64 = 1.5 * (1u64 << 52) as f64;

impl PlainSums {
    /// The exact sums of `channels` channels whose codes are at most `largest`; none where a partial
    /// sum could be inexact, or for more channels than a board reads.
    pub fn exact(words: Words, channels: usize, largest: f64) -> Option<Self> {
        let is_exact = words.largest_sums(largest).into_iter().all(|most| most < EXACT);
        Self::new(words, channels).filter(|_| is_exact)
    }

    /// The sums of `channels` channels; none for more than a board reads.
    pub fn new(words: Words, channels: usize) -> Option<Self> {
        let [products, phases] = loops(channels)?;
        let (sum, parts) = match &words.waves {
            Waves::Products(_) => (products, 2),
            Waves::Phases { .. } => (phases, PHASES as usize),
        };
        Some(PlainSums { words, sum, sums: vec![0.0; parts * channels + 1] })
    }

    /// Adds up a window.
    pub fn add_up(&mut self, codes: &[i32]) {
        let (squares, sums) = self.sums.split_first_mut().expect("the squares' is one");
        *squares = (self.sum)(&self.words, codes, sums);
    }

    /// The sums of the last window: that of the squares, then of each part (in phase and quadrature,
    /// or each phase) all channels'.
    pub fn sums(&self) -> &[f64] {
        &self.sums
    }
}

type Sum = fn(&Words, &[i32], &mut [f64]) -> f64;

/// The loops over products and over phases of `channels` channels.
fn loops(channels: usize) -> Option<[Sum; 2]> {
    Some(match channels {
        2 => [products::<2>, phases::<2>],
        3 => [products::<3>, phases::<3>],
        4 => [products::<4>, phases::<4>],
        5 => [products::<5>, phases::<5>],
        6 => [products::<6>, phases::<6>],
        7 => [products::<7>, phases::<7>],
        8 => [products::<8>, phases::<8>],
        _ => return None,
    })
}

/// The haptic code's product with its share of the window.
#[inline(always)]
fn square(words: &Words, window: f64, code: i32) -> f64 {
    let code = f64::from(code);
    let share = (code * (window * words.keep) + words.rounding) - words.rounding;
    code * words.raise * share
}

fn products<const N: usize>(words: &Words, codes: &[i32], into: &mut [f64]) -> f64 {
    let Waves::Products(waves) = &words.waves else { unreachable!("chosen by the waves") };
    let samples = codes.as_chunks::<N>().0.iter();
    let (mut in_phase, mut quadrature, mut squares) = ([0.0; N], [0.0; N], 0.0);
    for ((codes, [cosine, sine]), window) in samples.zip(waves).zip(&words.window) {
        for channel in 0..N {
            let code = f64::from(codes[channel]);
            in_phase[channel] += code * cosine;
            quadrature[channel] += code * sine;
        }
        squares += square(words, *window, codes[N - 1]);
    }
    into[..N].copy_from_slice(&in_phase);
    into[N..].copy_from_slice(&quadrature);
    squares
}

fn phases<const N: usize>(words: &Words, codes: &[i32], into: &mut [f64]) -> f64 {
    const COUNT: usize = PHASES as usize;
    let Waves::Phases { offset } = words.waves else { unreachable!("chosen by the waves") };
    let (periods, _) = codes.as_chunks::<N>().0.as_chunks::<COUNT>();
    let (mut sums, mut squares) = ([[0.0; N]; COUNT], 0.0);
    for (period, windows) in periods.iter().zip(words.window.as_chunks::<COUNT>().0) {
        for phase in 0..COUNT {
            let (codes, window) = (&period[phase], windows[phase]);
            for channel in 0..N {
                sums[phase][channel] += (f64::from(codes[channel]) + offset) * window;
            }
            squares += square(words, window, codes[N - 1]);
        }
    }
    into.copy_from_slice(sums.as_flattened());
    squares
}
