// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sensing core, written once in the hardware language of [`hapticore_hdl`].
//!
//! The core takes ADC codes of the terminals' currents, of the sensing voltage and of the haptic
//! voltage. For each pad in turn it outputs a frame: current ratios, position, sheet resistance,
//! capacitance, haptic force, and flags.
//!
//! | module | holds |
//! | --- | --- |
//! | [`blocks`] | the blocks, one file each: multiplexer, oscillator, demodulator, estimator and what it is made of |
//! | [`fidelity`] | the core at work: every clock ([`fidelity::clock`]), or slot by slot to the same bits ([`fidelity::fixed`]) |
//!
//! Widths, counts and timings are those of a [`Profile`]; [`check()`] says whether a core can be
//! built of one.
//!
//! ```
//! use hapticore_contract::profile::Profile;
//! use hapticore_model::blocks::core::Core;
//!
//! let profile = Profile::bundled("small")?;
//! let core = Core::try_new(&profile)?;
//! let slot = profile.slot.samples() * profile.clocks_per_sample;
//! assert!(core.latency() < slot, "a frame is out before the next slot ends");
//! # Ok::<(), hapticore_contract::profile::ProfileError>(())
//! ```
//!
//! [`Profile`]: hapticore_contract::profile::Profile

// For what tests of blocks share with tests of whole cores.
#[cfg(test)]
extern crate self as hapticore_model;

pub mod blocks;
mod buildable;
mod check;
pub mod fidelity;
#[cfg(test)]
mod support;

pub use check::{check, parse_profile};
