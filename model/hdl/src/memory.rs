// SPDX-License-Identifier: MIT OR Apache-2.0
//! Memories: words with one read port and one write port, as a block RAM has them.
//!
//! The read port has a register: what is asked for in one clock is there in the next. A word that
//! is read and written in the same clock reads as it was.

use crate::format::Format;
use crate::signal::{Signal, Value};
use std::sync::Arc;

/// An interpretation's memories.
pub trait Storage: Value {
    /// What a memory holds.
    type Words: Clone + std::fmt::Debug;

    /// The words of a memory at reset, and its read register.
    fn words(memory: &Memory) -> Self::Words;
    /// What the read register of a memory holds.
    fn data(memory: &Memory, words: &mut Self::Words) -> Self;
    /// The words and the read register, of which nothing that is used again need be left behind.
    #[inline(always)]
    fn take(words: &mut Self::Words) -> Self::Words {
        words.clone()
    }
    /// One clock of a memory: reads the old word at `address` into the read register, and writes.
    #[track_caller]
    fn access(
        memory: &Memory,
        words: &mut Self::Words,
        address: Signal<Self>,
        write: Option<Write<Self>>,
    );
}

/// What a read of a word gives that is written in the same cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Collision {
    /// The word as it was. A block RAM may need additional logic for that.
    OldWord,
    /// Don't care: no block uses such a word. Test builds read a wrong one, so that using it is
    /// noticed.
    DontCare,
}

/// The configuration of a memory.
#[derive(Debug, Clone)]
pub struct Memory {
    /// Its name among the submodules of its block.
    pub name: &'static str,
    /// How many words it has.
    pub words: usize,
    /// The format of a word.
    pub format: Format,
    /// What a word reads as that is written in the same cycle.
    pub collision: Collision,
    /// Whether it shall be a block RAM although it is so small that synthesis would rather take
    /// registers.
    pub block: bool,
    /// What it holds at reset, before rounding to its format; zero where there is nothing.
    pub initial: Arc<[f64]>,
}

/// What is written into a memory at the end of a clock.
#[derive(Debug, Clone, Copy)]
pub struct Write<V> {
    /// Whether a word is written in this cycle.
    pub enable: Signal<V>,
    /// Address of the word.
    pub address: Signal<V>,
    /// What: of a format that the memory's holds.
    pub data: Signal<V>,
}

impl Memory {
    /// A memory of zeros.
    pub fn new(name: &'static str, words: usize, format: Format) -> Self {
        Memory {
            name,
            words,
            format,
            collision: Collision::OldWord,
            block: false,
            initial: Arc::new([]),
        }
    }

    /// The memory, with read-during-write as "don't care": no block uses a word that was read while
    /// it was written.
    pub fn dont_care_on_collision(self) -> Self {
        Memory { collision: Collision::DontCare, ..self }
    }

    /// The memory as a block RAM, however small it is.
    pub fn in_block(self) -> Self {
        Memory { block: true, ..self }
    }

    /// A read-only table. Entries outside the format saturate.
    pub fn table(name: &'static str, format: Format, initial: Vec<f64>) -> Self {
        Memory {
            name,
            words: initial.len(),
            format,
            collision: Collision::DontCare,
            block: false,
            initial: initial.into(),
        }
    }

    /// The words at reset, as numbers.
    pub fn reals(&self) -> Vec<f64> {
        let mut words = self.initial.to_vec();
        words.resize(self.words, 0.0);
        words
    }

    /// The words at reset, as codes.
    pub fn codes(&self) -> Vec<i64> {
        self.reals().into_iter().map(|real| self.format.code_saturating(real)).collect()
    }

    /// The format of an address.
    #[inline]
    pub fn address(&self) -> Format {
        Format::counter(self.words as u64 - 1)
    }

    /// What was asked for in the previous cycle.
    #[inline(always)]
    pub fn data<V: Storage>(&self, words: &mut V::Words) -> Signal<V> {
        Signal { value: V::data(self, words), format: self.format }
    }

    /// Asks for a word.
    #[inline(always)]
    #[track_caller]
    pub fn read<V: Storage>(&self, words: &mut V::Words, address: Signal<V>) {
        V::access(self, words, address, None);
    }

    /// Asks for a word, and writes one.
    #[inline(always)]
    #[track_caller]
    pub fn access<V: Storage>(&self, words: &mut V::Words, address: Signal<V>, write: Write<V>) {
        if V::ELABORATES {
            let given = write.data.format;
            assert!(
                self.format.holds(given),
                "{} holds {}, which cannot represent every {given}",
                self.name,
                self.format
            );
        }
        V::access(self, words, address, Some(write));
    }
}

#[cfg(test)]
mod tests;
