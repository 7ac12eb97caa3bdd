// SPDX-License-Identifier: MIT OR Apache-2.0
//! Equality: of every block with the rounded reference, of the readings of a block with each other, of whole slots.
//!
//! | tests | hold |
//! | --- | --- |
//! | [`serial`], [`streams`] | fixed results = the exact values, rounded so: corners, then a million random operations a block |
//! | [`exhaustive`] | small dividers and roots over all operands, every register within its format on every clock |
//! | [`latencies`] | `latency()` = the clocks measured |
//! | [`idle`] | skipping an idle block changes no bit on any clock |
//! | [`netlists`] | the captured graph, run by an interpreter of its own = the clocked model, on every clock |
//! | [`slots`] | frames of fidelities `fixed` and `clock` = the rounded reference |
//! | [`phasors`] | frames from amplitudes = frames from the same tones' samples, but for the ADC's rounding |
//! | [`ideal`] | the floating-point reference = the equations solved backwards |
//! | [`accuracy`] | fixed point departs from floating point as word lengths predict |
//! | [`signals`] | operations on small formats: clocked = exact, ranges hold what happens |

mod accuracy;
mod device;
mod exhaustive;
mod harness;
mod ideal;
mod idle;
mod interpreter;
mod latencies;
mod netlists;
mod never_idle;
mod phasors;
mod random;
mod serial;
mod signals;
mod slots;
mod streams;
