// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cells of an FPGA, counted by what they are.

use serde::{Deserialize, Serialize};

/// Cells by what they are, as synthesis counts them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Cells {
    /// Look-up tables of four inputs.
    pub luts: u64,
    /// Carries: one bit each on iCE40, two on ECP5.
    pub carries: u64,
    /// Number of flip-flops.
    pub registers: u64,
    /// Number of hardware multipliers.
    pub multipliers: u64,
    /// Number of block RAMs; used and available where there are two numbers.
    pub block_rams: u64,
    /// Look-up tables used as memory.
    pub lut_rams: u64,
}
