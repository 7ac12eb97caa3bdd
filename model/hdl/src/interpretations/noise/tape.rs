// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is written down as blocks run: operations with their derivatives, and sources of error.

use super::Noise;
use super::moments::Moments;
use crate::format::Format;
use crate::interpretations::shadow::Shadow;
use crate::signal::Signal;
use std::cell::RefCell;
use std::marker::PhantomData;

/// Where constants come from that no instance has: a calibration's words.
const OUTSIDE: &str = "calibration";

/// The number of an operation that was written down; 0 where a value is exact.
pub(super) type Entry = u32;
pub(super) const EXACT: Entry = 0;

/// An operation: what its result depends on.
#[derive(Debug, Clone, Copy, Default)]
struct Operation {
    from: [(Entry, f64); 2],
}

/// A source of error, added to an operation's result.
#[derive(Debug, Clone, Copy)]
struct Source {
    entry: Entry,
    scope: usize,
    moments: Moments,
}

/// What a floor has left out, which is its error where a golden model says that it is one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Floored {
    pub entry: Entry,
    pub before: f64,
    pub dropped: u8,
}

/// Blocks within blocks, by the names of their instances.
#[derive(Debug)]
struct Scope {
    parent: usize,
    name: &'static str,
}

#[derive(Debug, Default)]
pub(super) struct Tape {
    /// Which recording of the thread it is.
    number: u64,
    operations: Vec<Operation>,
    sources: Vec<Source>,
    pub floored: Option<Floored>,
    scopes: Vec<Scope>,
    pub scope: usize,
}

thread_local! {
    static TAPE: RefCell<Tape> = RefCell::default();
}

pub(super) fn with<T>(act: impl FnOnce(&mut Tape) -> T) -> T {
    TAPE.with_borrow_mut(act)
}

impl Tape {
    fn begin(&mut self) {
        let (number, operations) = (self.number + 1, vec![Operation::default()]);
        *self = Tape { number, operations, ..Tape::default() };
        self.scopes.push(Scope { parent: 0, name: OUTSIDE });
    }

    pub fn operation(&mut self, from: [(Entry, f64); 2]) -> Entry {
        if from.iter().all(|&(entry, gain)| entry == EXACT || gain == 0.0) {
            return EXACT;
        }
        self.push(from)
    }

    pub fn push(&mut self, from: [(Entry, f64); 2]) -> Entry {
        self.operations.push(Operation { from });
        Entry::try_from(self.operations.len() - 1).expect("a slot has fewer than 2^32 operations")
    }

    /// An entry with an error of its own.
    pub fn source(&mut self, from: [(Entry, f64); 2], moments: Moments) -> Entry {
        let entry = self.push(from);
        self.sources.push(Source { entry, scope: self.scope, moments });
        entry
    }

    pub fn enter(&mut self, name: &'static str) -> usize {
        let (before, parent) = (self.scope, self.scope);
        let known = self.scopes.iter().position(|of| of.parent == parent && of.name == name);
        self.scope = known.unwrap_or_else(|| {
            self.scopes.push(Scope { parent, name });
            self.scopes.len() - 1
        });
        before
    }

    /// The gain from each operation's result to that of `entry`.
    fn gains(&self, entry: Entry) -> Vec<f64> {
        let mut gains = vec![0.0; entry as usize + 1];
        gains[entry as usize] = 1.0;
        for number in (1..=entry as usize).rev() {
            if gains[number] != 0.0 {
                for (from, derivative) in self.operations[number].from {
                    gains[from as usize] += derivative * gains[number];
                }
            }
        }
        gains
    }

    fn path(&self, mut scope: usize) -> String {
        if scope == 0 {
            return OUTSIDE.into();
        }
        let mut names = Vec::new();
        while scope != 0 {
            names.push(self.scopes[scope].name);
            scope = self.scopes[scope].parent;
        }
        names.reverse();
        names.join(".")
    }
}

/// What blocks compute with [`Noise`] on this thread, from [`Recording::begin`] on. There is one a
/// thread: as another one begins, this one ends, and its methods panic.
#[derive(Debug)]
pub struct Recording {
    number: u64,
    of_this_thread: PhantomData<*const ()>,
}

/// A time of a recording.
#[derive(Debug, Clone, Copy)]
pub struct Mark {
    operations: usize,
    sources: usize,
}

/// The error of a signal.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Errors {
    /// All of it.
    pub total: Moments,
    /// By where it comes from: the path of the instance that rounds, or the name of an input.
    pub by_source: Vec<(String, Moments)>,
}

impl Recording {
    /// Begins to write down.
    pub fn begin() -> Self {
        with(Tape::begin);
        Recording { number: with(|tape| tape.number), of_this_thread: PhantomData }
    }

    fn with<T>(&self, act: impl FnOnce(&mut Tape) -> T) -> T {
        with(|tape| {
            assert_eq!(tape.number, self.number, "another recording has begun on this thread");
            act(tape)
        })
    }

    /// Now.
    pub fn mark(&self) -> Mark {
        self.with(|tape| Mark { operations: tape.operations.len(), sources: tape.sources.len() })
    }

    /// Forgets what was written down since: signals of that time are no longer to be used.
    pub fn rewind(&self, to: Mark) {
        self.with(|tape| {
            tape.operations.truncate(to.operations);
            tape.sources.truncate(to.sources);
            tape.floored = None;
        });
    }

    /// A signal from outside with a name, whose error is `moments`: that of its code, if it is
    /// known, included.
    pub fn input(
        &self,
        name: &'static str,
        shadow: Shadow,
        format: Format,
        moments: Moments,
    ) -> Signal<Noise> {
        let entry = self.with(|tape| {
            let before = tape.enter(name);
            let entry = tape.source([(EXACT, 0.0); 2], moments);
            tape.scope = before;
            entry
        });
        Signal { value: Noise::new(shadow, entry), format }
    }

    /// The error of a value.
    pub fn errors(&self, of: Noise) -> Errors {
        self.with(|tape| {
            let gains = tape.gains(of.entry);
            let mut by_scope = vec![Moments::default(); tape.scopes.len()];
            for source in &tape.sources {
                let gain = gains.get(source.entry as usize).copied().unwrap_or(0.0);
                if gain != 0.0 {
                    by_scope[source.scope] =
                        by_scope[source.scope].plus(source.moments.times(gain));
                }
            }
            let total = by_scope.iter().fold(Moments::default(), |sum, of| sum.plus(*of));
            let named = by_scope.into_iter().enumerate().filter(|(_, of)| of.bound > 0.0);
            Errors { total, by_source: named.map(|(n, of)| (tape.path(n), of)).collect() }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[should_panic(expected = "another recording")]
    fn a_recording_ends_as_another_begins() {
        let first = Recording::begin();
        Recording::begin();
        first.mark();
    }
}
