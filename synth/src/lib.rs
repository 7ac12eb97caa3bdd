// SPDX-License-Identifier: MIT OR Apache-2.0
//! From Verilog to bitstreams and reports.
//!
//! ```text
//! Verilog, pins ─ yosys ─ netlist ─┬─ nextpnr, seeds 1 … 5 ─ fmax of each, median
//!                                  └─ seed 1 ─ pack ─ bitstream
//! ```
//!
//! | module | does |
//! | --- | --- |
//! | [`target`] | families, boards and what must hold on each |
//! | [`certificates`] | verdicts of tools, known by what they were about |
//! | [`tools`] | the tools that `synth/tools` fetched |
//! | [`formal`] | proofs with SymbiYosys |
//! | [`claims`] | `Assumed` narrowings and invariants of a block, decided by a solver |
//! | [`flow`] | synthesis, placement and packing of one design |
//! | [`harness`] | a core between shift registers, so that it can be placed without a board |
//! | [`loops`] | force loops whose area and clock are reported |
//! | [`isolation`] | proof that no pad can change another's frame |
//! | [`equivalence`] | proof that a mutant of a netlist changes no output, for all codes |
//! | [`cells`] | cells of an FPGA, counted by what they are |
//! | [`report`] | what is committed in `synth/reports/`, as JSON and as text |
//! | [`sources`] | the Verilog that a report is about, and its hash |
//! | [`vectors`] | what users without Rust test the Verilog with |
//!
//! `synth/run BOARD` is the command; `synth/formal/` and `tests/toolchain/formal.rs` hold the
//! proofs.

pub mod cells;
pub mod certificates;
pub mod claims;
pub mod equivalence;
pub mod flow;
pub mod formal;
pub mod harness;
pub mod isolation;
pub mod loops;
pub mod report;
pub mod sources;
pub mod target;
pub mod tools;
pub mod vectors;
