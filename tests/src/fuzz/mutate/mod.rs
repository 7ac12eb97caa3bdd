// SPDX-License-Identifier: MIT OR Apache-2.0
//! Mutations that know what a text is: a number of a document, a key, a cell of a table is changed,
//! where a fuzzer's own mutations change a byte.
//!
//! | target | text |
//! | --- | --- |
//! | `profile`, `scene`, `calibration`, `plan` | a TOML document ([`document`]) |
//! | `lab` | a TOML document, then tables, a zero between them |
//! | `csv` | a byte of options, then a table ([`table`]) |
//!
//! One call in eight, and every text that cannot be parsed, is left to the fuzzer's own mutations,
//! so that syntax is fuzzed as well. Those also make numbers ([`Mutator::observed`]): the fuzzer puts in what the
//! program has compared with.

mod cross;
mod document;
mod scalar;
mod table;

pub use cross::cross;

use fastrand::Rng;

/// The fuzzer's own mutation of a slice: takes the length of the input in it and the length
/// allowed, returns the new length.
pub type Bytes = fn(&mut [u8], usize, usize) -> usize;

/// Mutates an input in place; how long it is then. The same arguments give the same input.
pub fn mutate(
    target: &str,
    data: &mut [u8],
    size: usize,
    most: usize,
    seed: u32,
    bytes: Bytes,
) -> usize {
    let mut mutator = Mutator { rng: Rng::with_seed(seed.into()), bytes };
    let by_value = mutator.rng.u8(..8) > 0;
    let made = by_value.then(|| mutator.input(target, &data[..size])).flatten();
    match made.filter(|made| made.len() <= most && made.as_bytes() != &data[..size]) {
        Some(made) => {
            data[..made.len()].copy_from_slice(made.as_bytes());
            made.len()
        }
        None => bytes(data, size, most),
    }
}

/// What chooses, and what makes up what it cannot.
struct Mutator {
    rng: Rng,
    bytes: Bytes,
}

impl Mutator {
    /// Another input of a target; none where it is no text that can be parsed.
    fn input(&mut self, target: &str, data: &[u8]) -> Option<String> {
        let text = str::from_utf8(data).ok()?;
        match target {
            "csv" => {
                let (options, text) = text.split_at_checked(1)?;
                Some(format!("{options}{}", self.table(text)?))
            }
            "lab" => self.files(text),
            _ => self.toml(target, text),
        }
    }

    /// One of the files that a zero separates, the first a document, the others tables.
    fn files(&mut self, text: &str) -> Option<String> {
        let mut files: Vec<String> = text.split('\0').map(String::from).collect();
        let chosen = self.rng.usize(..files.len());
        files[chosen] = match chosen {
            0 => self.toml("lab", &files[0])?,
            _ => self.table(&files[chosen])?,
        };
        Some(files.join("\0"))
    }

    /// The number of changes, with fewer more likely.
    fn changes(&mut self) -> usize {
        1 + self.rng.usize(..3) * self.rng.usize(..2)
    }

    /// One of a list, which must not be empty.
    fn one_of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.rng.usize(..list.len())]
    }
}
