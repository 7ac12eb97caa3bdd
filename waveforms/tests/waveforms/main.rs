// SPDX-License-Identifier: MIT OR Apache-2.0
//! Waveforms and views as their readers see them, in one program: a program of its own for each file takes
//! long to build.

mod common;
mod cost;
mod gtkwave;
mod nothing_half_written;
mod round_trip;
mod save_file;
mod text;
