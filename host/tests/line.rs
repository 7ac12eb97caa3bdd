// SPDX-License-Identifier: MIT OR Apache-2.0
//! The line as a stranger feeds it: from the middle, damaged, cut, endless.

use hapticore_host::{
    Damage, Decoder, END, Flags, Frame, Heartbeat, Message, Packet, Profile, Status,
};
use proptest::prelude::*;

/// A bundled profile.
fn profiles() -> impl Strategy<Value = Profile> {
    (0..Profile::all().len()).prop_map(|index| Profile::all().swap_remove(index))
}

fn status() -> impl Strategy<Value = Status> {
    (any::<[u8; 2]>(), any::<[bool; 3]>()).prop_map(
        |([sequence, commands], [late, refused, overrun])| Status {
            sequence,
            late,
            refused,
            overrun,
            commands: commands % 16,
        },
    )
}

/// Any message that a board of the profile can send.
fn message(profile: &Profile) -> impl Strategy<Value = Message> + use<> {
    let bits = 8 * hapticore_protocol::framing::word_bytes(profile);
    let word = (-(1i64 << (bits - 1)))..(1 << (bits - 1));
    let (pads, profile) = (profile.pads as usize, profile.clone());
    let flags = any::<[bool; 4]>().prop_map(|[clipped, saturated, invalid, lost]| Flags {
        clipped,
        saturated,
        invalid,
        lost,
    });
    let frame = (status(), 0..pads, prop::array::uniform8(word), flags).prop_map(
        |(status, pad, codes, flags)| {
            Message::Frame(Packet { status, frame: Frame { pad, codes, flags } })
        },
    );
    let heartbeat = (status(), any::<bool>()).prop_map(move |(status, calibrated)| {
        let mut heartbeat = Heartbeat::new(status, &profile);
        heartbeat.calibrated = calibrated;
        Message::Heartbeat(heartbeat)
    });
    prop_oneof![4 => frame, 1 => heartbeat]
}

fn messages() -> impl Strategy<Value = (Profile, Vec<Message>)> {
    profiles().prop_flat_map(|profile| {
        (Just(profile.clone()), prop::collection::vec(message(&profile), 1..8))
    })
}

fn encoded(profile: &Profile, messages: &[Message]) -> Vec<u8> {
    messages.iter().flat_map(|message| message.encode(profile)).collect()
}

fn decoded(profile: &Profile, bytes: impl IntoIterator<Item = u8>) -> Vec<Result<Message, Damage>> {
    let mut decoder = Decoder::new(profile);
    bytes.into_iter().filter_map(|byte| decoder.push(byte)).collect()
}

proptest! {
    #[test]
    fn what_is_encoded_is_decoded((profile, messages) in messages()) {
        let bytes = encoded(&profile, &messages);
        prop_assert_eq!(bytes.iter().filter(|byte| **byte == END).count(), messages.len());
        prop_assert_eq!(decoded(&profile, bytes), messages.into_iter().map(Ok).collect::<Vec<_>>());
    }

    #[test]
    fn any_bytes_are_survived_and_the_next_end_puts_it_right(
        (profile, messages) in messages(),
        noise in prop::collection::vec(prop_oneof![any::<u8>(), prop::sample::select(vec![0xc0, 0xdb, 0xdc, 0xdd])], 0..400),
    ) {
        let good = encoded(&profile, &messages);
        let heard = decoded(&profile, noise.into_iter().chain([END]).chain(good));
        let expected: Vec<_> = messages.into_iter().map(Ok).collect();
        prop_assert!(heard.ends_with(&expected), "{:?}", heard);
    }

    #[test]
    fn from_the_middle_of_a_packet_on_all_others_are_heard((profile, messages) in messages(), from in 1usize..20) {
        let bytes = encoded(&profile, &messages);
        let heard = decoded(&profile, bytes[from..].iter().copied());
        let expected: Vec<_> = messages[1..].iter().copied().map(Ok).collect();
        prop_assert!(heard.ends_with(&expected));
        prop_assert!(heard.len() <= messages.len(), "and no more than the damaged one before them");
    }

    #[test]
    fn bytes_that_are_lost_harm_the_packet_that_they_are_of_and_the_next(
        (profile, messages) in messages(),
        at in any::<prop::sample::Index>(),
        count in 1usize..4,
    ) {
        let mut bytes = encoded(&profile, &messages);
        let at = at.index(bytes.len());
        bytes.drain(at..(at + count).min(bytes.len()));
        let heard: Vec<_> = decoded(&profile, bytes).into_iter().filter_map(Result::ok).collect();
        prop_assert!(heard.len() + 2 >= messages.len());
        prop_assert!(heard.iter().all(|message| messages.contains(message)));
    }

    #[test]
    fn up_to_three_flipped_bits_within_a_packet_are_never_taken_for_another(
        (profile, messages) in messages(),
        flips in prop::collection::vec((any::<prop::sample::Index>(), 0..8), 1..=3),
    ) {
        // Of the bytes as they are before escaping: CRC-16 finds all of these in packets of this
        // length.
        let clean = |message: &Message| !message.encode(&profile).iter().any(|byte| matches!(byte, 0xdb..=0xdd));
        let message = messages[0];
        prop_assume!(clean(&message));
        let mut bytes = message.encode(&profile);
        let payload = bytes.len() - 1;
        flips.iter().for_each(|(at, bit)| bytes[at.index(payload)] ^= 1u8 << bit);
        prop_assume!(!bytes[..payload].iter().any(|byte| matches!(byte, 0xc0 | 0xdb..=0xdd)));
        let heard: Vec<_> = decoded(&profile, bytes).into_iter().filter_map(Result::ok).collect();
        prop_assert!(heard.is_empty() || heard == [message], "{:?}", heard);
    }
}

/// Damage of any kind passes the CRC as often as chance has it: 1 in 65,536.
#[test]
fn damaged_packets_pass_for_good_ones_with_the_probability_of_the_crc() {
    const PACKETS: u32 = 1_000_000;
    let profile = Profile::bundled("small").expect("bundled");
    let frame = Frame { pad: 1, codes: [1, -2, 300, -400, 5, 600, 7, 8], flags: Flags::default() };
    let message = Message::Frame(Packet { status: Status::default(), frame });
    let good = message.encode(&profile);
    let (mut decoder, mut state, mut passed) = (Decoder::new(&profile), 1u64, 0);
    for _ in 0..PACKETS {
        let mut bytes = good.clone();
        for byte in &mut bytes[4..20] {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            *byte = (state >> 33) as u8;
        }
        passed +=
            bytes.into_iter().filter_map(|byte| decoder.push(byte)).filter(Result::is_ok).count();
    }
    let expected = f64::from(PACKETS) / 65_536.0;
    assert!(
        (passed as f64) < expected + 5.0 * expected.sqrt(),
        "{passed} of {PACKETS}, {expected:.1} by chance"
    );
    assert!(passed > 0, "{passed}: with none the test would show nothing");
}

#[test]
fn an_endless_stream_without_an_end_is_not_kept() {
    let profile = Profile::bundled("standard").expect("bundled");
    let mut decoder = Decoder::new(&profile);
    assert!((0..20_000_000u32).all(|n| decoder.push(n as u8 & 0x7f).is_none()));
    let Some(Err(Damage::Length { expected, got })) = decoder.push(END) else {
        panic!("a damaged packet")
    };
    assert_eq!(got, expected + 1, "no more is counted");
}

#[test]
fn a_heartbeat_that_was_cut_is_left_out_in_silence() {
    let profile = Profile::bundled("small").expect("bundled");
    let heartbeat = Message::Heartbeat(Heartbeat::new(Status::default(), &profile));
    let bytes = heartbeat.encode(&profile);
    let cut = bytes[..7].iter().chain(&[END]).chain(&bytes).copied();
    assert_eq!(decoded(&profile, cut), [Ok(heartbeat)]);
}
