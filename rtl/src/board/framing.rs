// SPDX-License-Identifier: MIT OR Apache-2.0
//! Framing: how packets lie in the bytes of the serial line, as [`hapticore_protocol`] says for
//! both sides of it.

pub use hapticore_protocol::Constant;
pub use hapticore_protocol::framing::{
    CRC_BYTES, END, NIBBLE, PLACE_BYTES, STATUS_BYTES, STUFFING_BYTES, VERSION, board_digest,
    command_bytes, data_bytes, digest, flags, packet_bytes, packet_words, word_bytes,
};
pub use hapticore_protocol::register::{Control, PLACE, Register};
