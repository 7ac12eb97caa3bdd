// SPDX-License-Identifier: MIT OR Apache-2.0
//! The board and its peripherals, clock by clock, against the model's core and against what they
//! say of themselves.

#[path = "../../../model/tests/equality/campaign.rs"]
mod campaign;
#[path = "../../../model/tests/equality/device.rs"]
#[allow(dead_code)]
mod device;
#[path = "../../../model/tests/equality/in_place.rs"]
mod in_place;
#[path = "../../../model/tests/equality/random.rs"]
#[allow(dead_code)]
mod random;
#[path = "../../../model/tests/equality/tally.rs"]
mod tally;

mod bench;
mod blocks;
mod board_pins;
mod clock_error;
mod commands;
mod dac;
mod drive_output;
mod driven;
mod heartbeats;
mod line;
mod mutants;
mod pins;
mod ranges;
mod safety;
mod session;
mod stand_in;
mod startup;
