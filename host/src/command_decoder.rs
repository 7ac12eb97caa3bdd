// SPDX-License-Identifier: MIT OR Apache-2.0
//! The board's side of commands: from bytes of the line to words that are written. For programs that stand in for a
//! board, and for tests of the host's side.
//!
//! As on a board, a command counts at its END, with the right length, links and CRC; all else is refused and changes
//! nothing. END twice is nothing: a host clears the line with it.

use crate::command::Command;
use crate::line::{Check, Crc32};
use hapticore_contract::format::Format;
use hapticore_contract::profile::Profile;
use hapticore_protocol::framing::{
    CRC_BYTES, END, PLACE_BYTES, STUFFING_BYTES, command_bytes, data_bytes,
};
use hapticore_protocol::{DriveWord, Register, WordFormats};

/// Why a board refuses bytes between two ENDs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Refused {
    /// There are too many or too few.
    #[error("a command of {got} bytes, expected {expected}")]
    Length {
        /// Bytes of a command on the line, without END.
        expected: usize,
        /// Bytes that came; of more than a command has, one more is counted.
        got: usize,
    },
    /// A link leads beyond the end.
    #[error("a command whose links lead beyond its end")]
    Link,
    /// The CRC is another.
    #[error("a command with a wrong CRC")]
    Crc,
}

impl Command {
    /// The command that these bytes are, without their END; none where no word is at its place: a board of the profile
    /// accepts that, and nothing changes. The code is that of the word's low bits.
    ///
    /// ```
    /// use hapticore_host::{Command, Profile};
    ///
    /// let profile = Profile::bundled("small")?;
    /// let command = Command::Table { address: 0x0102, code: -2 };
    /// let bytes = command.encode(&profile);
    /// let (_end, stuffed) = bytes.split_last().expect("a command has bytes");
    /// assert_eq!(Command::decode(stuffed, &profile), Ok(Some(command)));
    /// assert!(Command::decode(&stuffed[1..], &profile).is_err());
    /// # Ok::<(), hapticore_host::ProfileError>(())
    /// ```
    ///
    /// # Errors
    /// What a board refuses.
    pub fn decode(stuffed: &[u8], profile: &Profile) -> Result<Option<Command>, Refused> {
        let formats = WordFormats::new(profile);
        let expected = command_bytes(&formats) as usize - 1;
        if stuffed.len() != expected {
            return Err(Refused::Length { expected, got: stuffed.len().min(expected + 1) });
        }
        let mut bytes = stuffed.to_vec();
        let length = cobs::decode_in_place(&mut bytes).map_err(|_| Refused::Link)?;
        let payload = (PLACE_BYTES + data_bytes(&formats)) as usize;
        if length != payload + CRC_BYTES as usize {
            return Err(Refused::Link);
        }
        if Crc32::of(&bytes[..payload]).to_le_bytes() != bytes[payload..length] {
            return Err(Refused::Crc);
        }
        let place = u16::from_be_bytes([bytes[0], bytes[1]]);
        let data = bytes[2..payload].iter().fold(0, |data, &byte| data << 8 | u64::from(byte));
        Ok(Command::at(place, data, (profile, &formats)))
    }

    /// The command that writes these bits at a place.
    fn at(place: u16, data: u64, (profile, formats): (&Profile, &WordFormats)) -> Option<Command> {
        if place & Register::SELECT != 0 {
            let register = Register::of_place(place)?;
            return Some(Command::Register(register, code(data, register.format(formats))));
        }
        if profile.control.is_some() && place & DRIVE != 0 {
            let word = DriveWord::of_place(place)?;
            return Some(Command::Drive(word, code(data, word.format(profile)?)));
        }
        Some(Command::Table { address: place, code: code(data, formats.table) })
    }
}

/// Set in the places of a drive, on boards that have one.
const DRIVE: u16 = 0x4000;

/// The code that the low bits are in a format.
fn code(bits: u64, format: Format) -> i64 {
    let above = 64 - u32::from(format.width);
    let raised = bits << above;
    if format.signed { raised as i64 >> above } else { (raised >> above) as i64 }
}

/// Finds commands in the bytes that a host sends.
///
/// ```
/// use hapticore_host::{Command, CommandDecoder, Profile, encode};
///
/// let profile = Profile::bundled("small")?;
/// let mut decoder = CommandDecoder::new(&profile);
/// let sent = [Command::RESET_ADC, Command::ENABLE];
/// let heard: Vec<_> = encode(&sent, &profile).into_iter().filter_map(|byte| decoder.push(byte)).collect();
/// assert_eq!(heard, sent.map(|command| Ok(Some(command))));
/// # Ok::<(), hapticore_host::ProfileError>(())
/// ```
#[derive(Debug, Clone)]
pub struct CommandDecoder {
    profile: Profile,
    /// Bytes of a command on the line, without END.
    length: usize,
    stuffed: Vec<u8>,
}

impl CommandDecoder {
    /// For a board of the profile.
    pub fn new(profile: &Profile) -> Self {
        let length = command_bytes(&WordFormats::new(profile)) as usize - 1;
        debug_assert!(length as u64 > STUFFING_BYTES);
        CommandDecoder { profile: profile.clone(), length, stuffed: Vec::new() }
    }

    /// Takes a byte; at its END the command, or why it is refused.
    pub fn push(&mut self, byte: u8) -> Option<Result<Option<Command>, Refused>> {
        if byte != END {
            // One byte too many is enough for a refusal.
            if self.stuffed.len() <= self.length {
                self.stuffed.push(byte);
            }
            return None;
        }
        if self.stuffed.is_empty() {
            return None;
        }
        let decoded = Command::decode(&self.stuffed, &self.profile);
        self.stuffed.clear();
        Some(decoded)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::encode;
    use hapticore_contract::control::{Control, Law};
    use hapticore_protocol::Setting;

    fn profiles() -> [Profile; 2] {
        let standard = Profile::bundled("standard").expect("bundled");
        let control = Some(Control::of(&standard, Law::Inverse));
        [standard.clone(), Profile { control, ..standard }]
    }

    /// A command for each kind of word, at the ends of its format.
    fn commands(profile: &Profile) -> Vec<Command> {
        let formats = WordFormats::new(profile);
        let ends = |format: Format| [format.min_code() as i64, -1, 0, 1, format.max_code() as i64];
        let held = move |format: Format| {
            ends(format).into_iter().filter(move |code| i128::from(*code) >= format.min_code())
        };
        let registers = Register::ALL.into_iter().flat_map(|register| {
            held(register.format(&formats)).map(move |code| Command::Register(register, code))
        });
        let table = [0, 1, 0x3fff].into_iter().flat_map(|address| {
            held(formats.table).map(move |code| Command::Table { address, code })
        });
        let settings = Setting::ALL.into_iter().map(DriveWord::Setting);
        let others = [
            DriveWord::Curve(0xfff),
            DriveWord::Target(15),
            DriveWord::Surface { pad: 15, right: true },
            DriveWord::Surface { pad: 0, right: false },
        ];
        let words: Vec<_> = settings.chain(others).collect();
        let drive = words.into_iter().flat_map(|word| {
            let codes = word.format(profile).into_iter().flat_map(held);
            codes.map(move |code| Command::Drive(word, code))
        });
        registers.chain(table).chain(drive).collect()
    }

    #[test]
    fn every_command_that_is_encoded_is_decoded() {
        for profile in profiles() {
            let commands = commands(&profile);
            let mut decoder = CommandDecoder::new(&profile);
            let bytes = encode(&commands, &profile);
            let heard: Vec<_> = bytes.into_iter().filter_map(|byte| decoder.push(byte)).collect();
            let expected: Vec<_> = commands.into_iter().map(|command| Ok(Some(command))).collect();
            assert_eq!(heard, expected);
        }
    }

    #[test]
    fn no_changed_byte_passes_and_the_next_command_is_heard() {
        let [profile, _] = profiles();
        let good = Command::ENABLE.encode(&profile);
        for (at, flip) in (0..good.len() - 1).flat_map(|at| (1..=255).map(move |flip| (at, flip))) {
            let mut bad = good.clone();
            bad[at] ^= flip;
            let mut decoder = CommandDecoder::new(&profile);
            let line = bad.iter().chain(&good);
            let heard: Vec<_> = line.filter_map(|byte| decoder.push(*byte)).collect();
            let (last, before) = heard.split_last().expect("an END came");
            assert_eq!(*last, Ok(Some(Command::ENABLE)), "{at} ^ {flip:x}");
            assert!(!before.is_empty() && before.iter().all(Result::is_err), "{at} ^ {flip:x}");
        }
    }

    #[test]
    fn a_place_without_a_word_changes_nothing() {
        let [plain, driven] = profiles();
        let at = |place: u16, profile: &Profile| {
            let data = vec![0; data_bytes(&WordFormats::new(profile)) as usize];
            let bytes = crate::line::to_board(&[&place.to_be_bytes(), &data[..]].concat());
            Command::decode(&bytes[..bytes.len() - 1], profile)
        };
        assert_eq!(at(0x8007, &plain), Ok(None));
        assert_eq!(at(0x4fff, &driven), Ok(None));
        assert_eq!(at(0x4000, &plain), Ok(Some(Command::Table { address: 0x4000, code: 0 })));
    }
}
