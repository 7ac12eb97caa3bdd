// SPDX-License-Identifier: MIT OR Apache-2.0
//! The blocks of the core, one file each, from the ADC's codes to frames.

pub mod capacitance;
pub mod controller;
pub mod core;
pub mod currents;
pub mod demodulator;
pub mod divider;
pub mod drives;
pub mod estimator;
pub mod force;
pub mod force_loop;
pub mod force_table;
pub mod frames;
pub mod haptic_voltage;
mod marks;
pub mod multiplexer;
pub mod multiplier;
#[cfg(test)]
mod mutants;
pub mod oscillator;
pub mod pace;
pub mod position;
pub mod ratio;
mod rests;
pub mod sided_wall;
pub mod split_pad;
pub mod sqrt;
pub mod wall;
