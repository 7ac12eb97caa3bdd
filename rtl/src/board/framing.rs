// SPDX-License-Identifier: MIT OR Apache-2.0
//! Framing: how packets lie in the bytes of the serial line, either way.
//!
//! ```text
//! packet:  payload … │ CRC high │ CRC low │ END             END inside: ESC, DC; ESC inside: ESC, DD (hex; SLIP, RFC 1055)
//! frame:   sequence │ commands taken (4 bits), pad (4 bits) │ flags │ 8 words of B bytes, most significant first
//! command: where, 2 bytes │ data, D bytes               where: 8000 (hex) + register, or a word of the map; other bits are ignored
//! ```
//!
//! SLIP rather than COBS or a length: END is nowhere but at the end, so that a reader who has lost its place has it again after
//! one END, for certain; and the sender needs no look ahead, so that no packet is buffered. Escapes cost on average 0.8 %.

use hapticore_model::blocks::core;
use hapticore_model::blocks::frames::Field;
use hapticore_model::format::Format;
use hapticore_model::profile::Profile;

/// Ends a packet.
pub const END: u8 = 0xc0;
/// Stands before what END or ESC is replaced by.
pub const ESC: u8 = 0xdb;
/// END, after ESC.
pub const ESC_END: u8 = 0xdc;
/// ESC, after ESC.
pub const ESC_ESC: u8 = 0xdd;

/// Bytes of a frame packet before its words: sequence number, commands taken and pad, flags.
pub const STATUS_BYTES: u64 = 3;

/// The bits of a frame packet's flags.
pub mod flags {
    /// A code was at a rail of the ADC.
    pub const CLIPPED: u8 = 0;
    /// A word was held at a rail.
    pub const SATURATED: u8 = 1;
    /// The last valid results stand.
    pub const INVALID: u8 = 2;
    /// A terminal's current is missing.
    pub const LOST: u8 = 3;
    /// The ADC was late since the packet before.
    pub const LATE: u8 = 4;
    /// A command was refused since the packet before.
    pub const REFUSED: u8 = 5;
    /// A frame was dropped since the packet before.
    pub const OVERRUN: u8 = 6;
}

/// Bytes of a frame's word.
pub fn word_bytes(profile: &Profile) -> u64 {
    u64::from(Field::word(profile).width.div_ceil(8))
}

/// The registers that commands write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Register {
    /// The x ratio in the middle of the box.
    OriginX,
    /// One over half the box's width.
    ScaleX,
    /// The y ratio in the middle of the box.
    OriginY,
    /// One over half the box's height.
    ScaleY,
    /// Picofarads at an admittance of one.
    CapacitanceGain,
    /// Newtons per square picofarad.
    ForceGain,
    /// Whether the board converts and measures.
    Enable,
    /// A register of the ADC: address and data.
    Adc,
}

impl Register {
    /// All registers, in the order of their numbers.
    pub const ALL: [Register; 8] = [
        Register::OriginX,
        Register::ScaleX,
        Register::OriginY,
        Register::ScaleY,
        Register::CapacitanceGain,
        Register::ForceGain,
        Register::Enable,
        Register::Adc,
    ];

    /// Set in `where` of a register, clear in that of a word of the map.
    pub const SELECT: u16 = 0x8000;

    /// What commands call it.
    pub fn place(self) -> u16 {
        Register::SELECT | self as u16
    }

    /// The format of its code, of a core with these inputs.
    pub fn format(self, core: &core::Inputs<Format>) -> Format {
        match self {
            Register::OriginX => core.origin_x,
            Register::ScaleX => core.scale_x,
            Register::OriginY => core.origin_y,
            Register::ScaleY => core.scale_y,
            Register::CapacitanceGain => core.capacitance_gain,
            Register::ForceGain => core.force_gain,
            Register::Enable => Format::unsigned(1, 0),
            Register::Adc => Format::unsigned(16, 0),
        }
    }
}

/// Bytes of a command's data, for a core with these inputs.
pub fn data_bytes(core: &core::Inputs<Format>) -> u64 {
    let registers = Register::ALL.into_iter().map(|register| register.format(core).width);
    u64::from(registers.chain([core.word.width]).max().expect("there are registers").div_ceil(8))
}
