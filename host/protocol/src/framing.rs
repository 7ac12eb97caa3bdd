// SPDX-License-Identifier: MIT OR Apache-2.0
//! Framing: how packets lie in the bytes of the serial line, either way.
//!
//! ```text
//! packet:    payload … │ CRC high │ CRC low │ END         END inside: ESC, DC; ESC inside: ESC, DD (hex; SLIP, RFC 1055)
//! frame:     sequence │ commands accepted (4 bits), pad (4 bits) │ flags │ 8 words of B bytes, most significant first
//! heartbeat: the same with the flag of that name; its words are those last written to [`Register::ALL`], but for
//!            the profile's digest in place of the control register, and for the ADC's answer to the last word sent to it;
//!            where one of them is written meanwhile, END comes early, behind the flags or later, and the heartbeat is void
//! command:   place, 2 bytes │ data, D bytes               place: 8000 (hex) + register, or the address of a word of the
//!                                                         position table; other bits are ignored
//! ```
//!
//! The CRC is CRC-16/IBM-3740 (polynomial 1021, initial value FFFF, hex) over the payload before
//! escaping.
//!
//! SLIP rather than COBS or a length: END is nowhere but at the end, so that a reader who has lost
//! its place has it again after one END, for certain; and the sender needs no look ahead, so that
//! no packet is buffered. Escapes cost on average 0.8 %.
//!
//! [`Register::ALL`]: crate::Register::ALL

use crate::calibration::WordFormats;
use crate::register::Register;
use hapticore_contract::frame::Field;
use hapticore_contract::profile::{Force, Profile};
use hapticore_hdl::format::Format;

/// Ends a packet.
pub const END: u8 = 0xc0;
/// Stands before the replacement of END or ESC.
pub const ESC: u8 = 0xdb;
/// END, after ESC.
pub const ESC_END: u8 = 0xdc;
/// ESC, after ESC.
pub const ESC_ESC: u8 = 0xdd;

/// Bytes of a frame packet before its words: sequence number, commands accepted and pad, flags.
pub const STATUS_BYTES: u64 = 3;

/// Bytes of the CRC at the end of a packet.
pub const CRC_BYTES: u64 = 2;

/// The bits of a frame packet's flags.
pub mod flags {
    /// A code was at full scale of the ADC.
    pub const CLIPPED: u8 = 0;
    /// A word was saturated.
    pub const SATURATED: u8 = 1;
    /// The pad's last valid results stand.
    pub const INVALID: u8 = 2;
    /// A terminal is open.
    pub const LOST: u8 = 3;
    /// The ADC was late since the packet before.
    pub const LATE: u8 = 4;
    /// A command was refused since the packet before.
    pub const REFUSED: u8 = 5;
    /// A frame was dropped since the packet before.
    pub const OVERRUN: u8 = 6;
    /// The packet is no frame but a heartbeat, and the first four flags are others: [`CALIBRATED`],
    /// and from [`VERSION`] on [`super::VERSION`]. That one is neither 0 nor 5, so that no flags of
    /// a heartbeat are END or ESC.
    pub const HEARTBEAT: u8 = 7;
    /// Of a heartbeat: since reset the last calibration register has been written.
    pub const CALIBRATED: u8 = 0;
    /// Of a heartbeat: the first of three bits.
    pub const VERSION: u8 = 1;
}

/// The version of what this file says: 1 to 7, but not 5.
pub const VERSION: u8 = 1;

/// The format of a count of commands, and of a pad.
pub const NIBBLE: Format = Format::unsigned(4, 0);

/// The digest of a profile, as a board has it: equal for profiles that differ in their name alone,
/// and else different but for chance (one in 65,536).
///
/// FNV-1a of the profile as JSON-like text, folded to sixteen bits.
///
/// ```
/// # use hapticore_contract::profile::Profile;
/// # use hapticore_protocol::framing::digest;
/// let small = Profile::bundled("small")?;
/// assert_eq!(digest(&small), digest(&Profile { name: "mine".into(), ..small.clone() }));
/// assert_ne!(digest(&small), digest(&Profile { pads: 3, ..small.clone() }));
/// # Ok::<(), hapticore_contract::profile::ProfileError>(())
/// ```
pub fn digest(profile: &Profile) -> u16 {
    let text = format!("{:?}", Profile { name: String::new(), ..profile.clone() });
    // What a profile does not have is not of its digest: boards from before keep theirs.
    let text = text.replace("wall: None, ", "").replace("control: None, ", "");
    let text = match profile.force == Force::default() {
        true => text.replace(&format!("force: {:?}, ", profile.force), ""),
        false => text,
    };
    let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    let hash = text.bytes().fold(0xcbf2_9ce4_8422_2325, step);
    (hash ^ hash >> 16 ^ hash >> 32 ^ hash >> 48) as u16
}

/// Bytes of a frame's word.
pub fn word_bytes(profile: &Profile) -> u64 {
    u64::from(Field::word(profile).width.div_ceil(8))
}

/// Bytes of a command's data, for a core whose calibration has these formats.
pub fn data_bytes(formats: &WordFormats) -> u64 {
    let registers = Register::ALL.into_iter().map(|register| register.format(formats).width);
    u64::from(
        registers.chain([formats.table.width]).max().expect("there are registers").div_ceil(8),
    )
}
