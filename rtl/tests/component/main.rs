// SPDX-License-Identifier: MIT OR Apache-2.0
//! Blocks in rust-hdl designs, and rust-hdl's own expressions: simulation and printed Verilog
//! compared.
//!
//! [`harness`] clocks nothing and computes nothing of its own: it runs a design in rust-hdl's
//! simulator and its Verilog in Icarus on the same inputs, and says where they differ. [`blocks`]
//! holds that components do not; [`traps`] that the harness would see it.

mod blocks;
mod harness;
mod traps;
