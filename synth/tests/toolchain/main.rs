// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the tools make of the printed Verilog: proofs, cells, bitstreams, and the checks that users
//! run.
//!
//! One program: one to link instead of eight.

mod board_formal;
mod cells;
mod claims;
mod downstream;
mod equivalence;
mod flow;
mod formal;
mod fresh;
mod isolation;
mod lint;
mod mutants;
