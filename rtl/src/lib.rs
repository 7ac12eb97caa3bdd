// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core as hardware: Verilog printed from the model's netlist.
//!
//! | module | does |
//! | --- | --- |
//! | [`verilog`] | prints any block of the model as Verilog-2005, a module for each block within |

pub mod verilog;
