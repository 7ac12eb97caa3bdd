// SPDX-License-Identifier: MIT OR Apache-2.0
//! A board beside a PC: virtual ones with faults on request, a board behind the live page, its wiring checked.
//!
//! | module | does |
//! | --- | --- |
//! | [`bench`](mod@bench) | what the next two need: a board's start-up, pads at places, frames |
//! | [`check`](mod@check) | which line is open, swapped, reversed, noisy, clipped, which pad is missing |
//! | [`guide`](mod@guide) | a calibration from pads that are put at places, one after the other |
//! | [`virtual_board`] | a scene behind the registers and packets of a board |
//! | [`faults`] | what is wrong with a virtual board: wires, ADC lines, its serial line |
//! | [`virtual_line`] | a virtual board in real time, as a line within this process |
//! | [`serve`] | the same for another program, over TCP or on standard input and output |
//! | [`recording`] | a board's rows as CSV or MCAP |
//! | [`source`] | a board as what a live page shows and drives |
//! | [`background`] | a board that a thread polls, for a program that calls when it likes |
//! | [`target`](mod@target) | which board a command line means, and what it is brought up with |

pub mod background;
pub mod bench;
pub mod check;
pub mod faults;
pub mod guide;
pub mod recording;
pub mod serve;
pub mod source;
pub mod target;
pub mod virtual_board;
pub mod virtual_line;
