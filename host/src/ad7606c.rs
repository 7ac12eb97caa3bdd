// SPDX-License-Identifier: MIT OR Apache-2.0
//! The registers of an AD7606C behind its serial port, and what the part refuses: for programs that stand in for a board
//! and its ADC.
//!
//! A word over SDI is 16 bits: zero, read, six bits of address, eight of data. While the part
//! converts (ADC mode) it takes nothing but a read, which puts it into register mode. There it
//! takes reads and writes, and puts out the register of a read during the next word. A write to
//! address 0 leaves register mode. Source: data sheet AD7606C-16 (register map); the public drivers
//! `drivers/adc/ad7606` of Analog Devices' no-OS and of Linux.

/// A word over SDI that reads.
const READ: u16 = 0x4000;
/// The register of the configuration.
const CONFIG: usize = 0x02;
/// The registers of the ranges.
const RANGES: std::ops::RangeInclusive<usize> = 0x03..=0x06;
/// The register of the bandwidths.
const BANDWIDTH: usize = 0x07;
/// The register that says which part it is.
const ID: usize = 0x2f;
/// Registers that can only be read.
const READ_ONLY: [usize; 8] = [0x01, 0x22, 0x24, 0x26, 0x27, 0x2d, 0x2e, ID];

/// The registers, and the mode.
///
/// ```
/// use hapticore_host::ad7606c::Part;
///
/// let mut part = Part::new(0x31);
/// let send = |part: &mut Part, word: u16| part.word(&(0..16).rev().map(|bit| i64::from(word >> bit & 1)).collect::<Vec<_>>());
/// assert!(send(&mut part, 0x0218).is_err(), "a write before a read has entered register mode");
/// assert!(send(&mut part, 0x6f00).is_ok() && send(&mut part, 0x0218).is_ok());
/// assert_eq!(part.lines(), 8);
/// ```
#[derive(Debug, Clone)]
pub struct Part {
    registers: [u8; 0x30],
    register_mode: bool,
    read: Option<usize>,
    /// Words that were no reading of codes.
    pub commands: Vec<u16>,
}

impl Part {
    /// The part after a full reset, with this ID.
    pub fn new(id: u8) -> Self {
        let mut registers = [0; 0x30];
        registers[CONFIG] = 0x08;
        RANGES.for_each(|range| registers[range] = 0x33);
        (0x11..=0x18).for_each(|offset| registers[offset] = 0x80);
        registers[0x21] = 0x01;
        registers[ID] = id;
        Part { registers, register_mode: false, read: None, commands: Vec::new() }
    }

    /// A full reset: what was commanded stays on record.
    pub fn reset(&mut self) {
        let commands = std::mem::take(&mut self.commands);
        *self = Part { commands, ..Part::new(self.registers[ID]) };
    }

    /// Whether the part takes words for registers, and puts no codes out.
    pub fn register_mode(&self) -> bool {
        self.register_mode
    }

    /// The codes that the interface check puts out in place of samples: a fixed one per channel. That of the first is an
    /// AD7606C-16's, those of the others stand in for it.
    pub fn fixed_codes(&self, bits: u32) -> Option<Vec<i32>> {
        let code = |channel: u32| i32::from(0xaccau16.rotate_left(channel)) << (bits - 16);
        (self.registers[0x21] & 0x80 != 0).then(|| (0..8).map(code).collect())
    }

    /// How many data lines are in use.
    pub fn lines(&self) -> usize {
        1 << (self.registers[CONFIG] >> 3 & 3)
    }

    /// The ranges of channels two by two, and the bandwidths.
    pub fn inputs(&self) -> ([u8; 4], u8) {
        let ranges = &self.registers[RANGES];
        (ranges.try_into().expect("four"), self.registers[BANDWIDTH])
    }

    /// What the first data line puts out during the next word of register mode. The upper byte is
    /// not specified.
    pub fn answer(&self) -> u16 {
        0xa500 | self.read.map_or(0x5a, |address| u16::from(self.registers[address]))
    }

    /// A read of codes, or a word for a register: sixteen bits, each as it was at a falling edge of
    /// SCLK, or another number.
    ///
    /// # Errors
    /// What the part refuses, and why.
    pub fn word(&mut self, bits: &[i64]) -> Result<(), &'static str> {
        let word = bits.iter().fold(0, |word, &bit| word << 1 | bit as u32);
        if word == 0 && !self.register_mode {
            return Ok(());
        }
        if bits.len() != 16 {
            return Err("a word for a register that has not 16 bits");
        }
        self.commands.push(word as u16);
        self.command(word as u16)
    }

    fn command(&mut self, word: u16) -> Result<(), &'static str> {
        let (address, data) = (usize::from(word >> 8 & 0x3f), word as u8);
        self.read = None;
        if word & 0x8000 != 0 {
            return Err("a word for a register whose first bit is set");
        }
        if word & READ != 0 {
            self.register_mode = true;
            if address == 0 || address >= self.registers.len() {
                return Err("a read of a register that is not there");
            }
            self.read = Some(address);
            return Ok(());
        }
        if !self.register_mode {
            return Err("a write in ADC mode, without a read before it");
        }
        if address == 0 {
            self.register_mode = false;
            return if data == 0 { Ok(()) } else { Err("a write of other than zero to address 0") };
        }
        self.write(address, data)
    }

    fn write(&mut self, address: usize, data: u8) -> Result<(), &'static str> {
        if address >= self.registers.len() || READ_ONLY.contains(&address) {
            return Err("a write of a register that cannot be written");
        }
        let reserved = match address {
            CONFIG => data & 0x84 != 0,
            address if RANGES.contains(&address) => data & 0xf > 0xb || data >> 4 > 0xb,
            0x08 => data & 0xf > 8,
            0x09..=0x10 => data & 0xc0 != 0,
            _ => false,
        };
        if reserved {
            return Err("a write of reserved bits");
        }
        self.registers[address] = data;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_part_takes_what_its_data_sheet_says_and_nothing_else() {
        let bits =
            |word: u16| (0..16).rev().map(|bit| i64::from(word >> bit & 1)).collect::<Vec<_>>();
        let mut part = Part::new(0x31);
        assert!(part.word(&bits(0x0218)).is_err() && part.lines() == 2, "ADC mode takes no write");
        assert!(part.word(&[0; 18]).is_ok() && !part.register_mode(), "a read of codes is no word");
        assert!(
            part.word(&bits(0x6f00)).is_ok() && part.register_mode(),
            "a read enters register mode"
        );
        assert_eq!(part.answer() & 0xff, 0x31, "and is answered during the next word");
        assert!(part.word(&bits(0x0218)).is_ok() && part.lines() == 8);
        for refused in [0x2f00, 0x3000, 0x03ff, 0x0284, 0x8000, 0x4000] {
            assert!(part.word(&bits(refused)).is_err(), "{refused:04x}");
        }
        assert!(part.word(&bits(0x0218)[1..]).is_err(), "15 bits");
        assert!(part.word(&bits(0)).is_ok() && !part.register_mode(), "zero leaves register mode");
        assert_eq!(
            part.commands,
            [0x0218, 0x6f00, 0x0218, 0x2f00, 0x3000, 0x03ff, 0x0284, 0x8000, 0x4000, 0]
        );
    }
}
