// SPDX-License-Identifier: MIT OR Apache-2.0
//! The line: payloads in a stream of bytes, with CRC and escapes. Format:
//! [`hapticore_protocol::framing`].

use crc::{CRC_16_IBM_3740, Crc};
use hapticore_protocol::framing::{CRC_BYTES, END, ESC, ESC_END, ESC_ESC};

const CHECK: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_3740);

/// The bytes of a payload on the line: its CRC behind it, escaped, END at the end.
pub(crate) fn frame_bytes(payload: &[u8]) -> Vec<u8> {
    let check = CHECK.checksum(payload).to_be_bytes();
    payload.iter().copied().chain(check).flat_map(escape).chain([END]).collect()
}

fn escape(byte: u8) -> impl Iterator<Item = u8> {
    let (first, second) = match byte {
        END => (ESC, Some(ESC_END)),
        ESC => (ESC, Some(ESC_ESC)),
        byte => (byte, None),
    };
    std::iter::once(first).chain(second)
}

/// Bytes between two ENDs that are no packet.
///
/// ```
/// use hapticore_host::{Damage, Decoder, END, ESC, Profile};
///
/// let mut decoder = Decoder::new(&Profile::bundled("small")?);
/// let heard: Vec<_> = decoder.decode([1, 2, END, ESC, 7, END, END]).collect();
/// assert_eq!(heard, [Err(Damage::Length { expected: 21, got: 2 }), Err(Damage::Escape(7))]);
/// assert_eq!(Damage::Escape(7).to_string(), "byte 07 after ESC");
/// # Ok::<(), hapticore_host::ProfileError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Damage {
    /// There are too many or too few.
    #[error("a packet of {got} bytes, expected {expected}")]
    Length {
        /// Bytes of a packet.
        expected: usize,
        /// Bytes that came; of more than a packet has, one more is counted.
        got: usize,
    },
    /// They are not those that were sent.
    #[error("a packet's CRC is {got:04x}, expected {expected:04x}")]
    Crc {
        /// CRC computed from the packet.
        expected: u16,
        /// CRC received with the packet.
        got: u16,
    },
    /// ESC stands before a byte that it cannot stand before.
    #[error("byte {0:02x} after ESC")]
    Escape(u8),
    /// There is no such pad.
    #[error("a frame of pad {0}")]
    Pad(u8),
}

/// Collects the bytes of a payload of a known length.
#[derive(Debug, Clone)]
pub(crate) struct Collector {
    payload: usize,
    bytes: Vec<u8>,
    escaped: bool,
    damage: Option<Damage>,
}

impl Collector {
    pub fn new(payload: usize) -> Self {
        Collector { payload, bytes: Vec::with_capacity(payload + 3), escaped: false, damage: None }
    }

    /// Bytes of a packet.
    pub fn length(&self) -> usize {
        self.payload + CRC_BYTES as usize
    }

    /// Takes a byte; at END all bytes since the END before, or why they are none.
    pub fn push(&mut self, byte: u8) -> Option<Result<Vec<u8>, Damage>> {
        match (byte, std::mem::take(&mut self.escaped)) {
            (END, _) => return self.end(),
            (ESC, false) => self.escaped = true,
            (ESC_END, true) => self.keep(END),
            (ESC_ESC, true) => self.keep(ESC),
            (byte, true) => self.damage = self.damage.or(Some(Damage::Escape(byte))),
            (byte, false) => self.keep(byte),
        }
        None
    }

    /// What is longer than any packet is not kept.
    fn keep(&mut self, byte: u8) {
        if self.bytes.len() <= self.length() {
            self.bytes.push(byte);
        }
    }

    fn end(&mut self) -> Option<Result<Vec<u8>, Damage>> {
        let bytes = std::mem::replace(&mut self.bytes, Vec::with_capacity(self.payload + 3));
        match self.damage.take() {
            Some(damage) => Some(Err(damage)),
            None if bytes.is_empty() => None,
            None => Some(Ok(bytes)),
        }
    }

    /// The payload of a packet's bytes.
    pub fn payload<'a>(&self, bytes: &'a [u8]) -> Result<&'a [u8], Damage> {
        if bytes.len() != self.length() {
            return Err(Damage::Length { expected: self.length(), got: bytes.len() });
        }
        let (payload, check) = bytes.split_last_chunk().expect("the length was checked");
        let (expected, got) = (CHECK.checksum(payload), u16::from_be_bytes(*check));
        if expected == got { Ok(payload) } else { Err(Damage::Crc { expected, got }) }
    }
}
