// SPDX-License-Identifier: MIT OR Apache-2.0
//! Waveforms of a simulation: VCD and FST files, GTKWave save files, and text for tests.
//!
//! | module | holds |
//! | --- | --- |
//! | [`tracer`] | follows a [`Probe`](hapticore_hdl::probe::Probe) clock by clock and writes what changed |
//! | [`kind`] | the formats of files, each made by its name |
//! | [`wave`] | what a waveform file can do: the one trait behind both formats |
//! | [`vcd_file`], [`fst_file`] | the two formats |
//! | [`declarations`] | the signals of a trace: paths, formats, scopes |
//! | [`timebase`] | clocks to ticks of the file |
//! | [`view`] | which signals to show and how: `views/*.toml` |
//! | [`gtkwave`] | a GTKWave save file from a view and a trace |
//! | [`text`] | waveforms as text, for tests |
//! | [`pattern`] | how views and tests name signals |
//!
//! Tracing observes a simulation and never alters it; nothing here knows what a signal means. A
//! file appears under its name only when it is whole.

mod bits;
mod changes;
pub mod declarations;
mod display;
mod error;
pub mod fst_file;
pub mod gtkwave;
pub mod kind;
mod layout;
pub mod pattern;
pub mod text;
pub mod timebase;
pub mod tracer;
pub mod vcd_file;
pub mod view;
pub mod wave;

pub use error::Error;
