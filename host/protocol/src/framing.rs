// SPDX-License-Identifier: MIT OR Apache-2.0
//! Framing: how packets lie in the bytes of the serial line, either way.
//!
//! ```text
//! packet:    payload … │ CRC, 4 bytes, least significant first              stuffed, then END, a zero byte
//! frame:     sequence, 2 bytes │ commands accepted (4 bits), pad (4 bits) │ flags, 2 bytes │ 8 words of B bytes
//! heartbeat: the same with the flag of that name; its words are those last written to [`Register::ALL`], but for
//!            the digest of profile and output in place of the control register, and for the ADC's answer to the last word
//!            sent to it, or the code of a line's test; those of [`crate::output`] follow;
//!            where one of them is written meanwhile, END comes early, behind the flags or later, and the heartbeat is void
//! command:   place, 2 bytes │ data, D bytes               place: 8000 (hex) + register, or the address of a word of the
//!                                                         position table; other bits are ignored. Boards that drive pads
//!                                                         have more places, and two words more in a packet: see `drive`
//! ```
//!
//! Numbers are most significant byte first. The CRC is CRC-32/ISO-HDLC (polynomial 04C11DB7, hex,
//! least significant bit first, initial value and final exclusive or all ones) over the payload
//! before stuffing.
//!
//! **Stuffing** is COBS (S. Cheshire and M. Baker, "Consistent overhead byte stuffing", IEEE/ACM
//! Transactions on Networking 7(2), 1999). One byte is added, and each zero byte is replaced by a
//! *link*, the distance to the next link; the added byte is a link, too. Packets are shorter than
//! 254 bytes, so that every packet of a kind has one length on the line, whatever it contains, and
//! END is nowhere but at its end. The board neither buffers nor looks ahead in either direction:
//!
//! | direction | links | the added byte | with a COBS library |
//! | --- | --- | --- | --- |
//! | host to board | point to the next link, as in the paper | is the first byte | `encode(bytes)` |
//! | board to host | point back to the link before | is the last byte before END | `reverse(decode(reverse(bytes)))` |
//!
//! ```text
//! to the board    11 00 22 33 00      →   02 11 03 22 33 01 00       02 ─→ 03 ──→ 01 ─→ END
//! to the host     11 00 22 33 00      →   11 02 22 33 03 01 00       start ←── 02 ←── 03 ← 01
//! ```
//!
//! A character without a stop bit counts as END at either end (POSIX terminals read it as a zero
//! byte unless they are configured otherwise). END on the line is nine low bits, so that a receiver
//! that has lost the place of the characters' start bits finds no stop bit within the next END.
//!
//! [`Register::ALL`]: crate::Register::ALL

use crate::calibration::WordFormats;
use crate::drive::PACKET_WORDS;
use crate::output::Output;
use crate::register::Register;
use hapticore_contract::frame::Field;
use hapticore_contract::profile::{Force, Profile};
use hapticore_hdl::format::Format;

/// Ends a packet.
pub const END: u8 = 0;

/// Bytes of a frame packet before its words: sequence number, commands accepted and pad, flags.
pub const STATUS_BYTES: u64 = 5;

/// The flags' first byte, which holds the low eight of them, from a payload's beginning.
pub const FLAGS_BYTE: u64 = 3;

/// Bytes of the CRC behind the payload.
pub const CRC_BYTES: u64 = 4;

/// Bytes that stuffing adds, and END.
pub const STUFFING_BYTES: u64 = 2;

/// Bytes of the place at the beginning of a command.
pub const PLACE_BYTES: u64 = 2;

/// The bits of a frame packet's flags: the low eight are the first byte, the others the second.
pub mod flags {
    crate::bits! {
        /// A code was at full scale of the ADC.
        CLIPPED = 0;
        /// A word was saturated.
        SATURATED = 1;
        /// The pad's last valid results stand.
        INVALID = 2;
        /// A terminal is open.
        LOST = 3;
        /// The ADC was late since the packet before: samples since then are wrong.
        LATE = 4;
        /// A command was refused since the packet before: damaged, or for the ADC while the board is enabled.
        REFUSED = 5;
        /// A frame was dropped since the packet before, for the line was busy.
        OVERRUN = 6;
        /// The packet is no frame but a heartbeat, never lifted, and the first four flags are others.
        HEARTBEAT = 7;
        /// The pad does not touch; its last valid place stands.
        LIFTED = 8;
    }
    /// Of a heartbeat: since reset the last calibration register has been written.
    pub const CALIBRATED: u8 = 0;
    /// Of a heartbeat: the first of three bits, which are [`super::VERSION`].
    pub const VERSION: u8 = 1;
}

/// The version of what this file says: 1 to 7. Version 1 was SLIP with CRC-16 and a sequence number of
/// 8 bits. Version 2 had flags of one byte, no register of the capacitance of a contact, and neither
/// the test of the ADC's lines nor the output. To one version the other's packets are damaged ones.
pub const VERSION: u8 = 3;

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
    board_digest(profile, None)
}

/// The digest of a board's profile, and of the output that it drives its pads with, where it has one.
///
/// ```
/// # use hapticore_contract::profile::Profile;
/// # use hapticore_protocol::framing::{board_digest, digest};
/// # use hapticore_protocol::output::{Dac, Output, Wave};
/// let profile = Profile::bundled("standard")?;
/// let output = Output { dac: Dac::Ad5664r, wave: Wave::Dc, full_scale_v: 500, clock_hz: 25_000_000 };
/// let of = |output: &Output| board_digest(&profile, Some(output));
/// assert_eq!(board_digest(&profile, None), digest(&profile));
/// assert_ne!(of(&output), of(&Output { full_scale_v: 300, ..output }));
/// # Ok::<(), hapticore_contract::profile::ProfileError>(())
/// ```
pub fn board_digest(profile: &Profile, output: Option<&Output>) -> u16 {
    let text = format!("{:?}", Profile { name: String::new(), ..profile.clone() });
    // What a profile does not have is not of its digest: boards from before keep theirs.
    let text = text.replace("wall: None, ", "").replace("control: None, ", "");
    let text = match profile.force == Force::default() {
        true => text.replace(&format!("force: {:?}, ", profile.force), ""),
        false => text,
    };
    let text = match output {
        Some(output) => format!("{text}, {output}"),
        None => text,
    };
    let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    let hash = text.bytes().fold(0xcbf2_9ce4_8422_2325, step);
    (hash ^ hash >> 16 ^ hash >> 32 ^ hash >> 48) as u16
}

/// Bytes of a frame's word.
pub fn word_bytes(profile: &Profile) -> u64 {
    u64::from(Field::word(profile).width.div_ceil(8))
}

/// Words of a packet: those of a frame, and of the drive, where the profile has a controller.
pub fn packet_words(profile: &Profile) -> u64 {
    let of_drive = if profile.control.is_some() { PACKET_WORDS } else { 0 };
    Field::ALL.len() as u64 + of_drive
}

/// Bytes of a frame or a heartbeat on the line, END included, whatever it contains.
///
/// ```
/// # use hapticore_contract::profile::Profile;
/// # use hapticore_protocol::framing::packet_bytes;
/// assert_eq!(packet_bytes(&Profile::bundled("small")?), 5 + 8 * 2 + 4 + 2);
/// assert_eq!(packet_bytes(&Profile::bundled("standard")?), 5 + 8 * 4 + 4 + 2);
/// # Ok::<(), hapticore_contract::profile::ProfileError>(())
/// ```
pub fn packet_bytes(profile: &Profile) -> u64 {
    STATUS_BYTES + packet_words(profile) * word_bytes(profile) + CRC_BYTES + STUFFING_BYTES
}

/// Bytes of a command on the line, END included, for a core whose calibration has these formats.
pub fn command_bytes(formats: &WordFormats) -> u64 {
    PLACE_BYTES + data_bytes(formats) + CRC_BYTES + STUFFING_BYTES
}

/// Bytes of a command's data, for a core whose calibration has these formats.
pub fn data_bytes(formats: &WordFormats) -> u64 {
    let registers = Register::ALL.into_iter().map(|register| register.format(formats).width);
    u64::from(
        registers
            .chain([formats.table.width, formats.drive_bits])
            .max()
            .expect("there are registers")
            .div_ceil(8),
    )
}
