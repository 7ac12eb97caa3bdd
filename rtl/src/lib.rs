// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core as hardware: Verilog printed from the model's netlist.
//!
//! | module | does |
//! | --- | --- |
//! | [`board`] | the peripherals of a board and the board itself, as blocks like those of the core |
//! | [`codes`] | which port of the core takes which word of a calibration |
//! | [`mod@component`] | any block as a rust-hdl component |
//! | [`header`] | prints the core of a profile, and what a bench of it must know |
//! | [`netlist`] | netlists of cores and boards, compiled once for all crates |

pub mod board;
pub mod codes;
pub mod component;
pub mod header;
pub mod netlist;
