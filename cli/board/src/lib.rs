// SPDX-License-Identifier: MIT OR Apache-2.0
//! A board beside a PC: virtual ones with faults on request, a board behind the live page, its wiring checked.
//!
//! | module | does |
//! | --- | --- |
//! | [`check`](mod@check) | which line is open, swapped, reversed, noisy, clipped, which pad is missing |
//! | [`virtual_board`] | a scene behind the registers and packets of a board |
//! | [`faults`] | what is wrong with a virtual board: wires, ADC lines, its serial line |
//! | [`virtual_line`] | a virtual board in real time: within this process, over TCP, on standard input and output |
//! | [`source`] | a board as what a live page shows and drives, or as CSV |
//! | [`target`](mod@target) | which board a command line means, and what it is brought up with |

pub mod check;
pub mod faults;
pub mod source;
pub mod target;
pub mod virtual_board;
pub mod virtual_line;
