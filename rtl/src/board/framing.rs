// SPDX-License-Identifier: MIT OR Apache-2.0
//! Framing: how packets lie in the bytes of the serial line, either way.
//!
//! ```text
//! packet:  payload … │ CRC high │ CRC low │ END             END inside: ESC, DC; ESC inside: ESC, DD (hex; SLIP, RFC 1055)
//! frame:   sequence │ commands taken (4 bits), pad (4 bits) │ flags │ 8 words of B bytes, most significant first
//! heartbeat: the same with the flag of that name; the words are those of [`Register::ALL`] as they were written last, but for
//!          the profile's digest in place of the control register, and for the ADC's answer to the last word that it was sent;
//!          where one of them is written meanwhile, END comes early, behind the flags or later, and that heartbeat does not count
//! command: where, 2 bytes │ data, D bytes               where: 8000 (hex) + register, or a word of the position table; other bits are ignored
//! ```
//!
//! SLIP rather than COBS or a length: END is nowhere but at the end, so that a reader who has lost its place has it again after
//! one END, for certain; and the sender needs no look ahead, so that no packet is buffered. Escapes cost on average 0.8 %.

use hapticore_contract::profile::Profile;
use hapticore_hdl::format::Format;
use hapticore_model::blocks::estimator::Calibration;
use hapticore_model::blocks::frames::Field;

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
    /// A terminal's current is that of an open one.
    pub const LOST: u8 = 3;
    /// The ADC was late since the packet before.
    pub const LATE: u8 = 4;
    /// A command was refused since the packet before.
    pub const REFUSED: u8 = 5;
    /// A frame was dropped since the packet before.
    pub const OVERRUN: u8 = 6;
    /// The packet is no frame but a heartbeat, and the first four flags are others: [`CALIBRATED`], and from [`VERSION`] on
    /// [`super::VERSION`]. That one is neither 0 nor 5, so that no flags of a heartbeat are END or ESC.
    pub const HEARTBEAT: u8 = 7;
    /// Of a heartbeat: since reset the last calibration register has been written.
    pub const CALIBRATED: u8 = 0;
    /// Of a heartbeat: the first of three bits.
    pub const VERSION: u8 = 1;
}

/// The version of what this file says: 1 to 7, but not 5.
pub const VERSION: u8 = 1;

/// The digest of a profile, as a board has it: what no two profiles share that differ in more than their name, but for chance.
///
/// FNV-1a of the profile as JSON-like text, folded to sixteen bits.
pub fn digest(profile: &Profile) -> u16 {
    let text = format!("{:?}", Profile { name: String::new(), ..profile.clone() });
    let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    let hash = text.bytes().fold(0xcbf2_9ce4_8422_2325, step);
    (hash ^ hash >> 16 ^ hash >> 32 ^ hash >> 48) as u16
}

/// Bytes of a frame's word.
pub fn word_bytes(profile: &Profile) -> u64 {
    u64::from(Field::word(profile).width.div_ceil(8))
}

/// The registers that commands write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Register {
    /// Picofarads at an admittance of one.
    CapacitanceGain,
    /// Newtons per square picofarad.
    ForceGain,
    /// What the board does: the bits of [`Control`].
    Control,
    /// A register of the ADC: address and data.
    Adc,
}

impl Register {
    /// All registers, in the order of their numbers.
    pub const ALL: [Register; 4] = [Register::CapacitanceGain, Register::ForceGain, Register::Control, Register::Adc];

    /// Set in `where` of a register, clear in that of a word of the position table.
    pub const SELECT: u16 = 0x8000;

    /// What commands call it.
    pub fn place(self) -> u16 {
        Register::SELECT | self as u16
    }

    /// The format of its code, of a core with these inputs.
    pub fn format(self, calibration: &Calibration<Format>) -> Format {
        match self {
            Register::CapacitanceGain => calibration.capacitance_gain,
            Register::ForceGain => calibration.force_gain,
            Register::Control => Control::FORMAT,
            Register::Adc => Format::unsigned(16, 0),
        }
    }
}

/// The format of a register's number.
pub const PLACE: Format = Format::unsigned(3, 0);
/// The format of a count of commands, and of a pad.
pub const NIBBLE: Format = Format::unsigned(4, 0);

/// The bits of the control register.
#[derive(Debug, Clone, Copy)]
pub struct Control;

impl Control {
    /// The board converts and measures. Setting it begins the first pad's slot.
    pub const ENABLE: u8 = 0;
    /// The ADC is held in reset.
    pub const ADC_RESET: u8 = 1;
    /// The format of the register.
    pub const FORMAT: Format = Format::unsigned(2, 0);
}

/// Bytes of a command's data, for a core with this calibration.
pub fn data_bytes(calibration: &Calibration<Format>) -> u64 {
    let registers = Register::ALL.into_iter().map(|register| register.format(calibration).width);
    u64::from(registers.chain([calibration.table.word.width]).max().expect("there are registers").div_ceil(8))
}
