// SPDX-License-Identifier: MIT OR Apache-2.0
//! The host's side of the serial line: frames from bytes, and commands to bytes.
//!
//! A [`Decoder`] takes bytes as they come and gives a packet at each END; what it has lost it says, and the next END puts it
//! right. [`Command::encode`] makes the bytes of a command, [`super::startup`] knows those that make a sensor of a board.
//! Framing and CRC are [`super::framing`]'s and [`super::crc16`]'s, here by the crate `crc`, so that neither side checks itself.

use super::framing::{
    Control, END, ESC, ESC_END, ESC_ESC, Register, STATUS_BYTES, VERSION, data_bytes, flags, word_bytes,
};
use bitvec::prelude::{BitArray, Lsb0};
use crc::{CRC_16_IBM_3740, Crc};
use hapticore_contract::frame::{Flags, Frame};
use hapticore_contract::profile::Profile;
use hapticore_hdl::format::Format;
use hapticore_model::blocks::core::{Core, Inputs};
use hapticore_model::blocks::frames::Field;

const CHECK: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_3740);

/// A frame as it came over the line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Packet {
    /// Counts the frames of the core, modulo 256; the first after a reset is 1. A gap is a loss.
    pub sequence: u8,
    /// The frame.
    pub frame: Frame,
    /// The ADC was late since the packet before; samples of it are wrong.
    pub late: bool,
    /// A command was refused since the packet before.
    pub refused: bool,
    /// The line was too slow: frames were dropped since the packet before.
    pub overrun: bool,
    /// Commands taken since reset, modulo 16.
    pub commands: u8,
}

/// What a board tells while it is disabled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Heartbeat {
    /// As [`Packet::sequence`], of the last frame.
    pub sequence: u8,
    /// As [`Packet::late`].
    pub late: bool,
    /// As [`Packet::refused`].
    pub refused: bool,
    /// As [`Packet::overrun`].
    pub overrun: bool,
    /// As [`Packet::commands`].
    pub commands: u8,
    /// Since its reset the board has been given the last register of a calibration.
    pub calibrated: bool,
    /// The version of the line's [`super::framing`], [`super::framing::VERSION`] here.
    pub version: u8,
    words: [i64; Field::ALL.len()],
    bits: u8,
}

impl Heartbeat {
    /// The low bits of what was last written into a register, as many as fit a word of a frame, and how many these are; none
    /// of the control register, which heartbeats do not tell.
    pub fn register(&self, register: Register) -> Option<(u64, u8)> {
        let word = self.words[register as usize] as u64 & ((1 << self.bits) - 1);
        (!matches!(register, Register::Control | Register::Adc)).then_some((word, self.bits))
    }

    /// The digest of the profile that the board was made for.
    pub fn digest(&self) -> u16 {
        self.words[Register::Control as usize] as u16
    }

    /// What the ADC put out while the last word was sent to it: the register that the word before has read.
    pub fn adc_answer(&self) -> u8 {
        // A bit more has come in than the word has.
        (self.words[Register::Adc as usize] >> 1) as u8
    }
}

/// What a board tells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Told {
    /// A frame.
    Frame(Packet),
    /// That it is there, and disabled.
    Heartbeat(Heartbeat),
}

impl Told {
    /// The frame, if it is one.
    pub fn frame(self) -> Option<Packet> {
        match self {
            Told::Frame(packet) => Some(packet),
            Told::Heartbeat(_) => None,
        }
    }
}

/// Bytes between two ENDs that are no packet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Damage {
    /// There are too many or too few.
    #[error("a packet of {got} bytes, expected {expected}")]
    Length {
        /// Bytes of a packet.
        expected: usize,
        /// Bytes that came.
        got: usize,
    },
    /// They are not those that were sent.
    #[error("a packet's CRC is {got:04x}, expected {expected:04x}")]
    Crc {
        /// As computed.
        expected: u16,
        /// As it came.
        got: u16,
    },
    /// ESC stands before a byte that it cannot stand before.
    #[error("byte {0:02x} after ESC")]
    Escape(u8),
    /// There is no such pad.
    #[error("a frame of pad {0}")]
    Pad(u8),
}

/// Makes packets of bytes.
#[derive(Debug, Clone)]
pub struct Decoder {
    word_bytes: usize,
    /// Bits of a register that a heartbeat tells.
    register_bits: u8,
    pads: u64,
    bytes: Vec<u8>,
    escaped: bool,
    damage: Option<Damage>,
}

impl Decoder {
    /// For the frames of a profile's board.
    pub fn new(profile: &Profile) -> Self {
        let word_bytes = word_bytes(profile) as usize;
        let data = 8 * data_bytes(&Core::new(profile).inputs().calibration) as u8;
        let register_bits = Field::word(profile).width.min(data);
        Decoder { word_bytes, register_bits, pads: profile.pads, bytes: Vec::new(), escaped: false, damage: None }
    }

    /// Takes a byte; gives a packet, or what became of it, at its END.
    pub fn take(&mut self, byte: u8) -> Option<Result<Told, Damage>> {
        match (byte, std::mem::take(&mut self.escaped)) {
            (END, _) => return self.end(),
            (ESC, false) => self.escaped = true,
            (ESC_END, true) => self.keep(END),
            (ESC_ESC, true) => self.keep(ESC),
            (byte, true) => self.damage = Some(Damage::Escape(byte)),
            (byte, false) => self.keep(byte),
        }
        None
    }

    /// Every packet of some bytes.
    pub fn take_all<'a>(
        &'a mut self,
        bytes: impl IntoIterator<Item = u8> + 'a,
    ) -> impl Iterator<Item = Result<Told, Damage>> + 'a {
        bytes.into_iter().filter_map(|byte| self.take(byte))
    }

    /// Bytes of a packet.
    fn length(&self) -> usize {
        Field::ALL.len() * self.word_bytes + STATUS_BYTES as usize + 2
    }

    /// What is longer than any packet is counted, not kept.
    fn keep(&mut self, byte: u8) {
        if self.bytes.len() <= self.length() {
            self.bytes.push(byte);
        }
    }

    fn end(&mut self) -> Option<Result<Told, Damage>> {
        let (bytes, damage) = (std::mem::take(&mut self.bytes), self.damage.take());
        match damage {
            Some(damage) => Some(Err(damage)),
            None if bytes.is_empty() || self.is_cut_heartbeat(&bytes) => None,
            None => Some(self.packet(&bytes)),
        }
    }

    /// Whether these are the first bytes of a heartbeat that ended early because one of its words was written.
    fn is_cut_heartbeat(&self, bytes: &[u8]) -> bool {
        let is_heartbeat = |flags: &u8| flags >> flags::HEARTBEAT & 1 != 0 && flags >> flags::VERSION & 7 == VERSION;
        bytes.len() < self.length() && bytes.get(STATUS_BYTES as usize - 1).is_some_and(is_heartbeat)
    }

    fn packet(&self, bytes: &[u8]) -> Result<Told, Damage> {
        if bytes.len() != self.length() {
            return Err(Damage::Length { expected: self.length(), got: bytes.len() });
        }
        let (payload, check) = bytes.split_at(bytes.len() - 2);
        let (expected, got) = (CHECK.checksum(payload), u16::from_be_bytes([check[0], check[1]]));
        if expected != got {
            return Err(Damage::Crc { expected, got });
        }
        let (status, words) = payload.split_at(STATUS_BYTES as usize);
        let mut codes = words.chunks(self.word_bytes).map(signed);
        let codes = Field::ALL.map(|_| codes.next().expect("a word a field"));
        let &[sequence, pad, bits] = status else { unreachable!("the length was checked") };
        let (commands, pad) = (pad >> 4, pad & 0xf);
        let version = bits >> flags::VERSION & 7;
        let bits = BitArray::<_, Lsb0>::new([bits]);
        let is = |flag: u8| bits[usize::from(flag)];
        let [late, refused, overrun] = [flags::LATE, flags::REFUSED, flags::OVERRUN].map(is);
        if is(flags::HEARTBEAT) {
            let (words, calibrated, bits) = (codes, is(flags::CALIBRATED), self.register_bits);
            let heartbeat = Heartbeat { sequence, late, refused, overrun, commands, calibrated, version, words, bits };
            return Ok(Told::Heartbeat(heartbeat));
        }
        if u64::from(pad) >= self.pads {
            return Err(Damage::Pad(pad));
        }
        let flags = Flags {
            clipped: is(flags::CLIPPED),
            saturated: is(flags::SATURATED),
            invalid: is(flags::INVALID),
            lost: is(flags::LOST),
        };
        let frame = Frame { pad: pad.into(), codes, flags };
        Ok(Told::Frame(Packet { sequence, frame, late, refused, overrun, commands }))
    }
}

/// A two's complement word, most significant byte first.
fn signed(bytes: &[u8]) -> i64 {
    let sign = if bytes[0] & 0x80 != 0 { -1 } else { 0 };
    bytes.iter().fold(sign, |code, &byte| code << 8 | i64::from(byte))
}

/// Something to be written on the board.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Command {
    /// A register's code.
    Register(Register, i64),
    /// A word of the position table.
    Table {
        /// Where.
        address: u16,
        /// Its code.
        code: i64,
    },
}

impl Command {
    /// What switches the board on.
    pub const ENABLE: Command = Command::Register(Register::Control, 1 << Control::ENABLE);
    /// What switches it off.
    pub const DISABLE: Command = Command::Register(Register::Control, 0);
    /// What switches it off and holds the ADC in reset, until the next command to the control register.
    pub const RESET_ADC: Command = Command::Register(Register::Control, 1 << Control::ADC_RESET);

    /// The bytes, for a core with these inputs.
    pub fn encode(self, core: &Inputs<Format>) -> Vec<u8> {
        let (place, code) = match self {
            Command::Register(register, code) => (register.place(), code),
            Command::Table { address, code } => (address, code),
        };
        let data = &code.to_be_bytes()[8 - data_bytes(&core.calibration) as usize..];
        let payload = [&place.to_be_bytes(), data].concat();
        let check = CHECK.checksum(&payload).to_be_bytes();
        let escaped = [payload.as_slice(), &check].concat().into_iter().flat_map(escape);
        escaped.chain([END]).collect()
    }
}

fn escape(byte: u8) -> impl Iterator<Item = u8> {
    let (first, second) = match byte {
        END => (ESC, Some(ESC_END)),
        ESC => (ESC, Some(ESC_ESC)),
        byte => (byte, None),
    };
    std::iter::once(first).chain(second)
}

/// The bytes of commands, with an END before them that clears the line.
pub fn encode(commands: &[Command], profile: &Profile) -> Vec<u8> {
    let core = Core::new(profile).inputs();
    std::iter::once(END).chain(commands.iter().flat_map(|command| command.encode(&core))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn core() -> Inputs<Format> {
        Core::new(&Profile::bundled("small").expect("bundled")).inputs()
    }

    #[test]
    fn a_command_is_its_bytes() {
        let bytes = Command::Table { address: 0x0102, code: -2 }.encode(&core());
        assert_eq!(bytes[..4], [1, 2, 0xff, 0xfe]);
        assert_eq!(bytes.len(), 2 + 2 + 2 + 1);
        assert_eq!(bytes.last(), Some(&END));
        let escaped = Command::Table { address: 0xc0db_u16 & 0x7fff, code: 0xdb }.encode(&core());
        assert!(escaped.windows(2).any(|pair| pair == [ESC, ESC_ESC]));
        assert_eq!(escaped.iter().filter(|&&byte| byte == END).count(), 1);
    }

    #[test]
    fn damage_is_told_and_forgotten() {
        let profile = Profile::bundled("small").expect("bundled");
        let mut decoder = Decoder::new(&profile);
        let length = decoder.length();
        let mut packet = vec![0u8; length - 2];
        packet.extend(CHECK.checksum(&packet).to_be_bytes());
        packet.push(END);
        let mut results = decoder.take_all([1, 2, END, ESC, 7, END].into_iter().chain(packet.clone()));
        assert_eq!(results.next(), Some(Err(Damage::Length { expected: length, got: 2 })));
        assert_eq!(results.next(), Some(Err(Damage::Escape(7))));
        assert!(results.next().expect("a third").is_ok());
        assert!(results.next().is_none());
        drop(results);
        packet[3] ^= 1;
        assert!(matches!(decoder.take_all(packet).next(), Some(Err(Damage::Crc { .. }))));
        assert!(matches!(decoder.take_all(vec![0; 9 * length].into_iter().chain([END])).next(), Some(Err(_))));
    }
}
