// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a block claims of itself, for a solver to prove: invariants, and what its caller keeps to.
//!
//! An `Assumed("…")` narrowing ([`Overflow::Assumed`](crate::signal::Overflow::Assumed)) relates
//! several signals. It follows from what the block's registers always satisfy, which
//! [`Block::claims`](crate::block::Block::claims) states in the language itself: as signals of one
//! bit. They are read into the netlist beside the block, are never printed as Verilog, and are
//! proved by induction from the same graph ([`smt`](crate::smt)).

use crate::signal::Signal;

/// Claims of a block about one clock.
#[derive(Debug, Clone)]
pub struct Claims<V> {
    /// Bits that are set at every clock, by name.
    pub invariants: Vec<(&'static str, Signal<V>)>,
    /// What the caller keeps to, if anything.
    pub held: Option<Held<V>>,
}

/// Inputs that a caller leaves as they were in the clock before.
#[derive(Debug, Clone, Copy)]
pub struct Held<V> {
    /// In clocks where this bit is set.
    pub when: Signal<V>,
    /// Names of the inputs.
    pub inputs: &'static [&'static str],
}

impl<V> Default for Claims<V> {
    fn default() -> Self {
        Claims { invariants: Vec::new(), held: None }
    }
}
