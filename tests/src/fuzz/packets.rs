// SPDX-License-Identifier: MIT OR Apache-2.0
//! A board's line: bytes in, messages out.
//!
//! The first byte chooses the profile of the board, and whether what follows is the line itself or payloads of packets.
//! This target adds the CRC and the stuffing of a board to payloads: by chance no line has a right CRC.

use std::sync::LazyLock;

use crc::{CRC_32_ISO_HDLC, Crc};
use hapticore_contract::profile::Profile;
use hapticore_host::{Decoder, Heartbeat, Message, Packet, Status};
use hapticore_protocol::framing::{CRC_BYTES, END, STUFFING_BYTES, packet_bytes};

use super::{Planted, all_hold, planted};

static PROFILES: LazyLock<Vec<Profile>> = LazyLock::new(Profile::all);

pub(super) fn check(data: &[u8]) -> bool {
    let Some((choice, data)) = data.split_first() else { return false };
    let profile = &PROFILES[usize::from(*choice) % PROFILES.len()];
    let line = if choice & 0x80 == 0 { data.to_vec() } else { packed(data, profile) };
    let (mut decoder, mut heard) = (Decoder::new(profile), false);
    for message in line.into_iter().filter_map(|byte| decoder.push(byte)).flatten() {
        let sent = mistaken(message).encode(profile);
        let again: Vec<_> = Decoder::new(profile).decode(sent).collect();
        assert_eq!(again, [Ok(message)]);
        heard = true;
    }
    check_recovery(&mut decoder, profile);
    heard
}

/// Payloads one after the other, as a board sends them.
fn packed(payloads: &[u8], profile: &Profile) -> Vec<u8> {
    const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);
    let length = packet_bytes(profile) - CRC_BYTES - STUFFING_BYTES;
    let packet = |payload: &[u8]| {
        let mut packet = [payload, &CRC.checksum(payload).to_le_bytes()].concat();
        packet.reverse();
        let mut stuffed = cobs::encode_vec(&packet);
        stuffed.reverse();
        stuffed.push(END);
        stuffed
    };
    payloads.chunks_exact(length as usize).flat_map(packet).collect()
}

/// Whatever came before: of two packets the second is heard.
fn check_recovery(decoder: &mut Decoder, profile: &Profile) {
    let heartbeat = Message::Heartbeat(Heartbeat::new(Status::default(), profile, None));
    let packet = heartbeat.encode(profile);
    let last = decoder.decode(packet.iter().chain(&packet).copied()).last();
    assert_eq!(last, Some(Ok(heartbeat)));
}

/// The message as it is sent again.
fn mistaken(message: Message) -> Message {
    match message {
        Message::Frame(Packet { mut status, frame })
            if planted(Planted::Packets)
                && all_hold(&[
                    (0xf000..0xff00).contains(&status.sequence),
                    status.late,
                    frame.pad > 1,
                ]) =>
        {
            status.sequence = 0;
            Message::Frame(Packet { status, frame })
        }
        message => message,
    }
}
