// SPDX-License-Identifier: MIT OR Apache-2.0
//! Framing: how packets lie in the bytes of the serial line, as [`hapticore_protocol`] says for
//! both sides of it.

use crate::codes::word_formats;
use hapticore_hdl::format::Format;
use hapticore_model::blocks::estimator::Calibration;

pub use hapticore_protocol::framing::{
    CRC_BYTES, END, NIBBLE, PLACE_BYTES, STATUS_BYTES, STUFFING_BYTES, VERSION, digest, flags,
    packet_bytes, word_bytes,
};
pub use hapticore_protocol::register::{Control, PLACE, Register};

/// Bytes of a command's data, for a core with this calibration.
pub fn data_bytes(calibration: &Calibration<Format>) -> u64 {
    hapticore_protocol::framing::data_bytes(&word_formats(calibration))
}

/// Bytes of a command on the line, END included, for a core with this calibration.
pub fn command_bytes(calibration: &Calibration<Format>) -> u64 {
    hapticore_protocol::framing::command_bytes(&word_formats(calibration))
}
