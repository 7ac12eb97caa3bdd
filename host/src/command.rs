// SPDX-License-Identifier: MIT OR Apache-2.0
//! Commands: what a host writes on a board, as bytes.

use crate::line::to_board;
use hapticore_contract::profile::Profile;
use hapticore_protocol::framing::{END, data_bytes};
use hapticore_protocol::{Control, DriveWord, Register, WordFormats};

/// Something to be written on the board.
///
/// ```
/// use hapticore_host::{Command, END, Profile};
///
/// let profile = Profile::bundled("small")?;
/// let bytes = Command::Table { address: 0x0102, code: -2 }.encode(&profile);
/// assert_eq!(bytes[1..5], [0x01, 0x02, 0xff, 0xfe]);
/// assert_eq!(bytes.len(), 1 + 2 + 2 + 4 + 1, "link, place, data, CRC, END");
/// # Ok::<(), hapticore_host::ProfileError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Command {
    /// A register's code.
    Register(Register, i64),
    /// A word of the position table.
    Table {
        /// Address of the word, from 0.
        address: u16,
        /// Raw code of the word.
        code: i64,
    },
    /// A word of a board that drives its pads, as a raw code.
    Drive(DriveWord, i64),
}

impl Command {
    /// What switches the board on.
    pub const ENABLE: Command = Command::Register(Register::Control, 1 << Control::ENABLE);
    /// What switches it off.
    pub const DISABLE: Command = Command::Register(Register::Control, 0);
    /// What switches it off and holds the ADC in reset, until the next command to the control
    /// register.
    pub const RESET_ADC: Command = Command::Register(Register::Control, 1 << Control::ADC_RESET);

    /// The bytes, for a board of the profile.
    pub fn encode(self, profile: &Profile) -> Vec<u8> {
        let (place, code) = match self {
            Command::Register(register, code) => (register.place(), code),
            Command::Table { address, code } => (address, code),
            Command::Drive(word, code) => (word.place(), code),
        };
        let data = &code.to_be_bytes()[8 - data_bytes(&WordFormats::new(profile)) as usize..];
        to_board(&[&place.to_be_bytes(), data].concat())
    }
}

/// The bytes of commands, with an END before them that clears the line.
///
/// ```
/// use hapticore_host::{Command, END, Profile, encode};
///
/// let profile = Profile::bundled("small")?;
/// let bytes = encode(&[Command::RESET_ADC, Command::DISABLE], &profile);
/// assert_eq!(bytes.iter().filter(|byte| **byte == END).count(), 3);
/// # Ok::<(), hapticore_host::ProfileError>(())
/// ```
pub fn encode(commands: &[Command], profile: &Profile) -> Vec<u8> {
    std::iter::once(END)
        .chain(commands.iter().flat_map(|command| command.encode(profile)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use hapticore_protocol::framing::command_bytes;

    #[test]
    fn zeros_within_become_links_and_end_is_only_at_the_end() {
        let profile = Profile::bundled("small").expect("bundled");
        let length = command_bytes(&WordFormats::new(&profile)) as usize;
        for (address, code) in [(0, 0), (0x4000, 0), (0x0001, 0x100), (0x1111, 0x1111)] {
            let bytes = Command::Table { address, code }.encode(&profile);
            assert_eq!(bytes.len(), length, "{bytes:x?}");
            assert_eq!(bytes.iter().position(|&byte| byte == END), Some(length - 1), "{bytes:x?}");
        }
        let bytes = Command::Table { address: 0x4000, code: 0 }.encode(&profile);
        assert_eq!(bytes[..4], [2, 0x40, 1, 1], "each link leads to the next");
    }
}
