// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a host sends to a board: bytes in, commands out.
//!
//! The first byte chooses the profile of the board, whether it drives its pads, and whether what follows is the line
//! itself or payloads of commands. This target adds the CRC and the stuffing to payloads: by chance no line has a right
//! CRC.

use std::sync::LazyLock;

use crc::{CRC_32_ISO_HDLC, Crc};
use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::Profile;
use hapticore_host::{Command, CommandDecoder, WordFormats};
use hapticore_protocol::framing::{CRC_BYTES, END, STUFFING_BYTES, command_bytes};

/// Profiles without a drive, then the same with one.
static PROFILES: LazyLock<Vec<Profile>> = LazyLock::new(|| {
    let driven = |profile: &Profile| Profile {
        control: Some(Control::of(profile, Law::Inverse)),
        ..profile.clone()
    };
    let plain = Profile::all();
    let driven: Vec<_> = plain.iter().map(driven).collect();
    plain.into_iter().chain(driven).collect()
});

pub(super) fn check(data: &[u8]) -> bool {
    let Some((choice, data)) = data.split_first() else { return false };
    let profile = &PROFILES[usize::from(*choice) % PROFILES.len()];
    let line = if choice & 0x80 == 0 { data.to_vec() } else { packed(data, profile) };
    let (mut decoder, mut heard) = (CommandDecoder::new(profile), false);
    for command in line.into_iter().filter_map(|byte| decoder.push(byte)).flatten().flatten() {
        let again = command.encode(profile);
        assert_eq!(Command::decode(&again[..again.len() - 1], profile), Ok(Some(command)));
        heard = true;
    }
    check_recovery(&mut decoder, profile);
    heard
}

/// Payloads one after the other, as a host sends them.
fn packed(payloads: &[u8], profile: &Profile) -> Vec<u8> {
    const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);
    let length = command_bytes(&WordFormats::new(profile)) - CRC_BYTES - STUFFING_BYTES;
    let command = |payload: &[u8]| {
        let mut stuffed =
            cobs::encode_vec(&[payload, &CRC.checksum(payload).to_le_bytes()].concat());
        stuffed.push(END);
        stuffed
    };
    payloads.chunks_exact(length as usize).flat_map(command).collect()
}

/// Whatever came before: after an END the next command is heard.
fn check_recovery(decoder: &mut CommandDecoder, profile: &Profile) {
    let bytes = std::iter::once(END).chain(Command::DISABLE.encode(profile));
    let last = bytes.filter_map(|byte| decoder.push(byte)).last();
    assert_eq!(last, Some(Ok(Some(Command::DISABLE))));
}
