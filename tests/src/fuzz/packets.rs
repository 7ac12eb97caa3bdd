// SPDX-License-Identifier: MIT OR Apache-2.0
//! A board's line: bytes in, messages out.
//!
//! The first byte chooses the profile of the board.

use std::sync::LazyLock;

use hapticore_contract::profile::Profile;
use hapticore_host::{Decoder, Heartbeat, Message, Packet, Status};

use super::{Planted, planted};

static PROFILES: LazyLock<Vec<Profile>> = LazyLock::new(Profile::all);

pub(super) fn check(data: &[u8]) -> bool {
    let Some((choice, data)) = data.split_first() else { return false };
    let profile = &PROFILES[usize::from(*choice) % PROFILES.len()];
    let (mut decoder, mut heard) = (Decoder::new(profile), false);
    for message in data.iter().filter_map(|byte| decoder.push(*byte)).flatten() {
        let sent = mistaken(message).encode(profile);
        let again: Vec<_> = Decoder::new(profile).decode(sent).collect();
        assert_eq!(again, [Ok(message)]);
        heard = true;
    }
    check_recovery(&mut decoder, profile);
    heard
}

/// Whatever came before: of two packets the second is heard.
fn check_recovery(decoder: &mut Decoder, profile: &Profile) {
    let heartbeat = Message::Heartbeat(Heartbeat::new(Status::default(), profile));
    let packet = heartbeat.encode(profile);
    let last = decoder.decode(packet.iter().chain(&packet).copied()).last();
    assert_eq!(last, Some(Ok(heartbeat)));
}

/// The message as it is sent again.
fn mistaken(message: Message) -> Message {
    match message {
        Message::Frame(Packet { mut status, frame })
            if planted(Planted::Packets) && status.sequence >= 240 && status.late =>
        {
            status.sequence = 0;
            Message::Frame(Packet { status, frame })
        }
        message => message,
    }
}
