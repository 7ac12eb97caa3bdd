// SPDX-License-Identifier: MIT OR Apache-2.0
//! Equality of whole cores: with the rounded reference, of the readings of a core with each other.
//! What is held of one block alone stands with the block, in `model/src/blocks/`.
//!
//! | tests | hold |
//! | --- | --- |
//! | [`idle`] | skipping an idle block changes no bit on any clock |
//! | [`netlists`] | the captured graph, run by an interpreter of its own = the clocked model, on every clock |
//! | [`samples`] | a core whose blocks are clocked apart, through whole samples = the core clocked as a whole |
//! | [`slots`] | frames of fidelities `fixed` and `clock` = the rounded reference |
//! | [`overlap`] | the same where an estimate runs on within the next window, with a controller too |
//! | [`phasors`] | frames from amplitudes = frames from the same tones' samples, but for the ADC's rounding |
//! | [`ideal`] | the floating-point reference = the equations solved backwards |
//! | [`accuracy`] | fixed point departs from floating point as word lengths predict |
//! | [`signals`] | operations on small formats: clocked = exact, ranges hold what happens |

mod accuracy;
mod device;
mod harness;
mod ideal;
mod idle;
mod in_place;
mod interpreter;
mod netlists;
mod never_skips;
mod overlap;
mod phasors;
mod random;
mod samples;
mod signals;
mod slots;
mod unseen;
