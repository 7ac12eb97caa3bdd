// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clocks a second of the model and of simulators on the Verilog that is printed of it, all over
//! the same [`Workload`].
//!
//! | file | runs a workload in |
//! | --- | --- |
//! | [`model`] | the clocked model |
//! | [`simulator`] | Verilator and CXXRTL, as fast as they can be |
//!
//! What is outside of the core is the same few instructions everywhere: a set of codes for each
//! strobe, and the code of the requested channel. At every clock all outputs go into a sum, so that
//! none is spared. Equal sums are equal outputs (the lock-step tests compare them one by one).

pub mod model;
pub mod simulator;
mod workload;

pub use workload::Workload;

/// What a run gave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lap {
    /// How long it took, without calibration and without reading the workload.
    pub seconds: f64,
    /// The sum of all outputs at every clock.
    pub sum: u64,
}

/// By how many bits the sum is rotated at each clock.
const ROTATED: u32 = 7;

/// By how many bits output number `index` is moved before it is added.
const fn moved(index: usize) -> u32 {
    index as u32 * 5 % 64
}
