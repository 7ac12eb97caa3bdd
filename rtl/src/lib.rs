// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core as hardware: Verilog printed from the model's netlist.
//!
//! | module | does |
//! | --- | --- |
//! | [`board`] | the peripherals of a board and the board itself, as blocks like those of the core |
//! | [`codes`] | which port of the core takes which word of a calibration |
//! | `component` | any block as a rust-hdl component; with the feature `boards` alone |
//! | [`header`] | prints the core of a profile, and what a bench of it must know |
//! | [`netlist`] | netlists of cores and boards, compiled once for all crates |

pub mod board;
pub mod codes;
#[cfg(feature = "boards")]
pub mod component;
pub mod header;
pub mod netlist;
