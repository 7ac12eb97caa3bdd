// SPDX-License-Identifier: MIT OR Apache-2.0
//! The line: payloads in a stream of bytes, with CRC and stuffing. Format:
//! [`hapticore_protocol::framing`].

use crc::{CRC_32_ISO_HDLC, Crc};
use hapticore_protocol::framing::END;
use std::marker::PhantomData;

/// What guards a packet. The line has one, [`Crc32`]; tests have a weaker one for comparison.
pub(crate) trait Check {
    /// Bytes of it at the end of a packet.
    const BYTES: usize;

    /// The check of a payload, in the low bits.
    fn of(payload: &[u8]) -> u32;
}

/// The CRC of the line.
#[derive(Debug, Clone)]
pub(crate) struct Crc32;

impl Check for Crc32 {
    const BYTES: usize = hapticore_protocol::framing::CRC_BYTES as usize;

    fn of(payload: &[u8]) -> u32 {
        const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);
        CRC.checksum(payload)
    }
}

/// A payload with its check behind it.
fn checked<C: Check>(payload: &[u8]) -> Vec<u8> {
    [payload, &C::of(payload).to_le_bytes()[..C::BYTES]].concat()
}

/// The bytes of a payload on the line to a board: links point to the next.
pub(crate) fn to_board(payload: &[u8]) -> Vec<u8> {
    let mut bytes = cobs::encode_vec(&checked::<Crc32>(payload));
    bytes.push(END);
    bytes
}

/// The bytes of a payload on the line from a board: links point back to the one before.
pub(crate) fn from_board<C: Check>(payload: &[u8]) -> Vec<u8> {
    let mut bytes = checked::<C>(payload);
    bytes.reverse();
    let mut bytes = cobs::encode_vec(&bytes);
    bytes.reverse();
    bytes.push(END);
    bytes
}

/// Bytes between two ENDs that are no packet.
///
/// ```
/// use hapticore_host::{Damage, Decoder, END, Profile};
///
/// let mut decoder = Decoder::new(&Profile::bundled("small")?);
/// let heard: Vec<_> = decoder.decode([1, 2, END].into_iter().chain([9; 26]).chain([END, END])).collect();
/// assert_eq!(heard, [Err(Damage::Length { expected: 26, got: 2 }), Err(Damage::Link)]);
/// assert_eq!(Damage::Link.to_string(), "a packet whose links do not meet its beginning");
/// # Ok::<(), hapticore_host::ProfileError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Damage {
    /// There are too many or too few.
    #[error("a packet of {got} bytes, expected {expected}")]
    Length {
        /// Bytes of a packet on the line, without END.
        expected: usize,
        /// Bytes that came; of more than a packet has, one more is counted.
        got: usize,
    },
    /// The links between them lead elsewhere than to the first.
    #[error("a packet whose links do not meet its beginning")]
    Link,
    /// They are not those that were sent.
    #[error("a packet's CRC is {got:08x}, expected {expected:08x}")]
    Crc {
        /// CRC computed from the packet.
        expected: u32,
        /// CRC received with the packet.
        got: u32,
    },
    /// There is no such pad.
    #[error("a frame of pad {0}")]
    Pad(u8),
}

/// Collects the bytes of packets of a known length, as a board sends them.
#[derive(Debug, Clone)]
pub(crate) struct Collector<C> {
    payload: usize,
    bytes: Vec<u8>,
    packet: Vec<u8>,
    check: PhantomData<C>,
}

impl<C: Check> Collector<C> {
    pub fn new(payload: usize) -> Self {
        Collector { payload, bytes: Vec::new(), packet: Vec::new(), check: PhantomData }
    }

    /// Bytes of a packet on the line, without END.
    pub fn length(&self) -> usize {
        self.payload + C::BYTES + 1
    }

    /// Takes a byte; at END whether there were any since the END before.
    pub fn push(&mut self, byte: u8) -> bool {
        if byte == END {
            std::mem::swap(&mut self.bytes, &mut self.packet);
            self.bytes.clear();
            return !self.packet.is_empty();
        }
        // Of what is longer than any packet the last bytes are kept: they are one where an END was lost.
        if self.bytes.len() > self.length() {
            self.bytes.remove(0);
        }
        self.bytes.push(byte);
        false
    }

    /// The bytes between the last two ENDs.
    pub fn stuffed(&self) -> &[u8] {
        &self.packet
    }

    /// The payload of these bytes; where there are too many, of the last of them.
    pub fn payload(&mut self) -> Result<&[u8], Damage> {
        let (expected, got) = (self.length(), self.packet.len());
        let wrong = Damage::Length { expected, got };
        self.packet.drain(..got.checked_sub(expected).ok_or(wrong)?);
        self.unstuff().map_err(|damage| if got > expected { wrong } else { damage })?;
        Ok(&self.packet[..self.payload])
    }

    /// Makes payload and check of the bytes of a packet.
    fn unstuff(&mut self) -> Result<(), Damage> {
        self.packet.reverse();
        let length = cobs::decode_in_place(&mut self.packet).map_err(|_| Damage::Link)?;
        self.packet.truncate(length);
        self.packet.reverse();
        let (payload, check) = self.packet.split_at(self.payload);
        let got = check.iter().rfold(0, |check, &byte| check << 8 | u32::from(byte));
        let expected = C::of(payload);
        if expected == got { Ok(()) } else { Err(Damage::Crc { expected, got }) }
    }
}
