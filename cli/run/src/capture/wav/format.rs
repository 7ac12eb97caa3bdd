// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a WAV file says of its samples.

/// `wFormatTag`: integers.
pub const PCM: u16 = 1;

/// `wFormatTag`: IEEE floats.
pub const FLOAT: u16 = 3;

/// `wFormatTag`: the format stands in the extension's GUID.
pub const EXTENSIBLE: u16 = 0xfffe;

/// What follows the format tag in a GUID of the extension.
pub const GUID: [u8; 14] = [0, 0, 0, 0, 0x10, 0, 0x80, 0, 0, 0xaa, 0, 0x38, 0x9b, 0x71];

/// A size of 32 bits that stands for one that is elsewhere, or unknown.
pub const ELSEWHERE: u32 = u32::MAX;
