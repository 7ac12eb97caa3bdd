// SPDX-License-Identifier: MIT OR Apache-2.0
//! Hard cases: what usually breaks a fixed-point lock-in, an estimator of force, a force loop or the
//! device around them; what must happen, what is measured, and how far it is from failing.
//!
//! A case is declared once, beside the code that runs it. The test `stability` runs every case under
//! its name and compares its row with `docs/stability.md`; `STABILITY=write` makes that page anew.
//!
//! | module | holds |
//! | --- | --- |
//! | [`arithmetic`] | operands at the ends of their range: rounding, division, square root, tables |
//! | [`bench`](mod@bench) | a calibrated core of a profile, beside its references, and codes of tones |
//! | [`case`] | what a case is, and its margin |
//! | [`document`] | the page of all cases |
//! | [`figure`] | the curves of the page |
//! | [`force_loop`] | the controller's words, and the loop around a simulated device |
//! | [`lock_in`] | tones, noise and disturbances at the ADC |
//! | [`long_runs`] | the same stimulus again and again, counters that wrap |
//! | [`rivals`] | other lock-ins and filters, on the same samples |
//! | [`system`] | pads, terminals, the core's inputs and registers |

pub mod arithmetic;
pub mod bench;
pub mod case;
pub mod document;
pub mod figure;
pub mod force_loop;
pub mod lock_in;
pub mod long_runs;
pub mod rivals;
pub mod system;

pub use case::{Case, Group, Margin, Outcome};

/// Every group of cases, in the order of the page.
pub const GROUPS: &[Group] =
    &[arithmetic::GROUP, lock_in::GROUP, system::GROUP, force_loop::GROUP, long_runs::GROUP];
