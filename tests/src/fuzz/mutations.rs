// SPDX-License-Identifier: MIT OR Apache-2.0
//! Mutations of a corpus: what a fuzzer tries first, without its coverage, but the same each time.

use fastrand::Rng;

use super::mutate;

/// Words that readers know or stumble over.
const WORDS: [&str; 28] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "256",
    "1e300",
    "-1e300",
    "1e-300",
    "1e400",
    "nan",
    "inf",
    "-inf",
    "9223372036854775807",
    "-9223372036854775808",
    "18446744073709551616",
    "0.1",
    "true",
    "\"\"",
    "[]",
    "{}",
    "[[",
    "\n",
    "=",
    ",",
    "\0",
    "é",
    "\u{202e}",
    "# ",
];

/// Targets whose values are mutated, in half of the inputs.
const TEXTS: [&str; 7] = ["profile", "scene", "calibration", "tuning", "plan", "lab", "csv"];

/// Inputs made of others, without end.
pub struct Mutations {
    rng: Rng,
    target: &'static str,
    corpus: Vec<Vec<u8>>,
}

impl Mutations {
    /// Of a target's corpus, which must not be empty.
    pub fn new(target: &'static str, corpus: Vec<Vec<u8>>, seed: u64) -> Self {
        assert!(!corpus.is_empty(), "there is something to mutate");
        Mutations { rng: Rng::with_seed(seed), target, corpus }
    }

    fn one(&mut self) -> Vec<u8> {
        let mut data = self.corpus[self.rng.usize(..self.corpus.len())].clone();
        if TEXTS.contains(&self.target) && self.rng.bool() {
            return self.values(data);
        }
        for _ in 0..self.rng.usize(1..=3) {
            self.mutate(&mut data);
        }
        data
    }

    /// The input with other values.
    fn values(&mut self, mut data: Vec<u8>) -> Vec<u8> {
        let (size, most) = (data.len(), 2 * data.len() + 64);
        data.resize(most, 0);
        let as_it_is = |_: &mut [u8], size, _| size;
        let size = mutate(self.target, &mut data, size, most, self.rng.u32(..), as_it_is);
        data.truncate(size);
        data
    }

    fn mutate(&mut self, data: &mut Vec<u8>) {
        let rng = &mut self.rng;
        let at = rng.usize(..=data.len());
        let end = (at + rng.usize(..16)).min(data.len());
        match rng.u8(..8) {
            0 => data.iter_mut().skip(at).take(1).for_each(|byte| *byte ^= 1 << rng.u8(..8)),
            1 => data.iter_mut().skip(at).take(1).for_each(|byte| *byte = rng.u8(..)),
            2 => drop(data.drain(at..end)),
            3 => data.extend_from_within(at..end),
            4 => data.truncate(at),
            5 | 6 => word(data, at, WORDS[rng.usize(..WORDS.len())]),
            _ => {
                let other = &self.corpus[rng.usize(..self.corpus.len())];
                let from = rng.usize(..=other.len());
                data.truncate(at);
                data.extend(&other[from..]);
            }
        }
    }
}

/// Puts a word in place of the number that stands there, or between what stands there.
fn word(data: &mut Vec<u8>, at: usize, word: &str) {
    let of_number = |byte: &u8| byte.is_ascii_digit() || b"+-.e".contains(byte);
    let digits = data[at..].iter().take_while(|byte| of_number(byte)).count();
    data.splice(at..at + digits, word.bytes());
}

impl Iterator for Mutations {
    type Item = Vec<u8>;

    fn next(&mut self) -> Option<Vec<u8>> {
        Some(self.one())
    }
}
