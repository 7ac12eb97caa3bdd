// SPDX-License-Identifier: MIT OR Apache-2.0
//! Claims of a netlist as bit-vector problems in SMT-LIB 2 (QF_ABV), for a solver to decide.
//!
//! A [`System`] is a block as a transition system: registers and memories, inputs → next registers
//! and memories, with the blocks within it in place. Time is unrolled: the register `sum` after two
//! clocks is `|sum@2|`. Every [`Problem`] asks for a counterexample, so that `unsat` proves:
//!
//! | problem | asks for |
//! | --- | --- |
//! | [`System::base`] | a run from reset in which a property fails within N clocks |
//! | [`System::step`] | a run from any state that satisfies all invariants, in which a property fails after N clocks |
//! | [`System::replay`] | a difference between this relation and the clocked model's trace |
//!
//! Where base and step of every [`Property`] are `unsat`, it holds at every clock for ever, by
//! induction. An invariant is one that the block states ([`Block::claims`](crate::block::Block::claims)); a
//! claim is an `Assumed("…")` narrowing: the number is one of its format wherever a register or an
//! output takes it.
//!
//! The relation follows the model's arithmetic, not the Verilog printer's text. It allows more than
//! the circuit does: memories and registers without reset begin with anything, and so does a word
//! that is read while it is written, if the memory declares "don't care".

mod bits;
mod fit;
mod places;
mod state;
mod system;
mod terms;
mod used;

pub use state::Variable;
pub use system::{Problem, Property, System};

#[cfg(test)]
mod tests;
