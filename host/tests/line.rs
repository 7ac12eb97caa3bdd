// SPDX-License-Identifier: MIT OR Apache-2.0
//! The line as a stranger feeds it: from the middle, damaged, cut, endless.

use hapticore_host::control::{Control, Faults, Law};
use hapticore_host::{
    Damage, Decoder, Driven, END, Flags, Frame, Heartbeat, Message, Packet, Profile, Status,
};
use hapticore_protocol::framing::packet_bytes;
use proptest::prelude::*;

/// A bundled profile, with a controller or without.
fn profiles() -> impl Strategy<Value = Profile> {
    (0..Profile::all().len(), any::<bool>()).prop_map(|(index, drives)| {
        let mut profile = Profile::all().swap_remove(index);
        profile.control = drives.then(|| Control::of(&profile, Law::Inverse));
        profile
    })
}

fn status(profile: &Profile) -> impl Strategy<Value = Status> + use<> {
    let format = profile.control.as_ref().map(|control| control.drive);
    (any::<(u16, u8, u64)>(), any::<[bool; 10]>()).prop_map(
        move |((sequence, commands, word), flags)| {
            let [late, refused, overrun, low, high, free, live, silence, sensor, force] = flags;
            let faults = Faults { silence, sensor, force };
            let driven = format.map(|format| Driven {
                word: (word & ((1 << format.width) - 1)) as i64,
                pad: commands >> 4,
                low,
                high,
                free,
                live,
                faults,
            });
            Status { sequence, late, refused, overrun, commands: commands % 16, driven }
        },
    )
}

/// Any message that a board of the profile can send.
fn message(profile: &Profile) -> impl Strategy<Value = Message> + use<> {
    let bits = 8 * hapticore_protocol::framing::word_bytes(profile);
    let word = (-(1i64 << (bits - 1)))..(1 << (bits - 1));
    let (pads, profile) = (profile.pads as usize, profile.clone());
    let flags = any::<[bool; 5]>().prop_map(|[clipped, saturated, invalid, lost, lifted]| Flags {
        clipped,
        saturated,
        invalid,
        lost,
        lifted,
    });
    let frame = (status(&profile), 0..pads, prop::array::uniform8(word), flags).prop_map(
        |(status, pad, codes, flags)| {
            Message::Frame(Packet { status, frame: Frame { pad, codes, flags } })
        },
    );
    let heartbeat = (status(&profile), any::<bool>()).prop_map(move |(status, calibrated)| {
        let mut heartbeat = Heartbeat::new(status, &profile, None);
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
        prop_assert_eq!(bytes.len() as u64, messages.len() as u64 * packet_bytes(&profile), "whatever they contain");
        prop_assert_eq!(decoded(&profile, bytes), messages.into_iter().map(Ok).collect::<Vec<_>>());
    }

    #[test]
    fn any_bytes_are_survived_and_the_next_end_puts_it_right(
        (profile, messages) in messages(),
        noise in prop::collection::vec(prop_oneof![any::<u8>(), 0u8..40], 0..400),
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
    fn damage_harms_no_packet_but_those_that_it_is_in(
        (profile, messages) in messages(),
        kind in kind(),
        at in any::<prop::sample::Index>(),
    ) {
        let good = encoded(&profile, &messages);
        let at = at.index(good.len());
        let (bytes, touched) = kind.damaged(&good, at);
        let packet = |at: usize| at / packet_bytes(&profile) as usize;
        let (first, behind) = (packet(touched.start), packet(touched.end - 1) + 1);
        let heard: Vec<_> = decoded(&profile, bytes).into_iter().filter_map(Result::ok).collect();
        prop_assert!(heard.starts_with(&messages[..first]), "{kind:?} at {at}: {heard:?}");
        prop_assert!(heard.ends_with(messages.get(behind..).unwrap_or_default()), "{kind:?} at {at}: {heard:?}");
        prop_assert!(heard.iter().all(|message| messages.contains(message)), "{kind:?} at {at}: {heard:?}");
    }
}

/// What becomes of bytes on their way.
#[derive(Debug, Clone, Copy)]
enum Kind {
    /// This many are lost.
    Lost(usize),
    /// This many come twice.
    Doubled(usize),
    /// A bit of one is another.
    Flipped(u32),
    /// This many come in the opposite order.
    Reordered(usize),
}

fn kind() -> impl Strategy<Value = Kind> {
    prop_oneof![
        (1usize..60).prop_map(Kind::Lost),
        (1usize..60).prop_map(Kind::Doubled),
        (0u32..8).prop_map(Kind::Flipped),
        (2usize..60).prop_map(Kind::Reordered),
    ]
}

impl Kind {
    /// The bytes with the damage, and which of the good ones it has touched.
    fn damaged(self, good: &[u8], at: usize) -> (Vec<u8>, std::ops::Range<usize>) {
        let count = match self {
            Kind::Flipped(_) => 1,
            Kind::Lost(count) | Kind::Doubled(count) | Kind::Reordered(count) => count,
        };
        let touched = at..(at + count).min(good.len());
        let mut part = good[touched.clone()].to_vec();
        match self {
            Kind::Lost(_) => part.clear(),
            Kind::Doubled(_) => part.extend_from_within(..),
            Kind::Flipped(bit) => part[0] ^= 1 << bit,
            Kind::Reordered(_) => part.reverse(),
        }
        ([&good[..at], &part, &good[touched.end..]].concat(), touched)
    }
}

#[test]
fn no_one_or_two_flipped_bits_make_another_message() {
    let profile = Profile::bundled("small").expect("bundled");
    let mut decoder = Decoder::new(&profile);
    for codes in [[0; 8], [1, -2, 300, -400, 5, 600, 7, 0x100]] {
        let frame = Frame { pad: 1, codes, flags: Flags::default() };
        let message = Message::Frame(Packet { status: Status::default(), frame });
        let good = message.encode(&profile);
        let bits = 8 * good.len();
        for flips in (0..bits).flat_map(|first| (0..=first).map(move |second| [first, second])) {
            let mut bytes = good.clone();
            bytes[flips[0] / 8] ^= 1 << (flips[0] % 8);
            // The same bit twice is one flip.
            bytes[flips[1] / 8] ^= u8::from(flips[0] != flips[1]) << (flips[1] % 8);
            bytes.push(END);
            let heard: Vec<_> = decoder.decode(bytes).filter_map(Result::ok).collect();
            assert_eq!(heard, [], "{flips:?} of {good:x?}");
        }
    }
}

#[test]
fn an_endless_stream_without_an_end_is_not_kept() {
    let profile = Profile::bundled("standard").expect("bundled");
    let mut decoder = Decoder::new(&profile);
    assert!((0..20_000_000u32).all(|n| decoder.push(n as u8 | 1).is_none()));
    let Some(Err(Damage::Length { expected, got })) = decoder.push(END) else {
        panic!("a damaged packet")
    };
    assert_eq!(got, expected + 1, "no more is counted");
}

#[test]
fn a_heartbeat_that_was_cut_is_left_out_in_silence() {
    let profile = Profile::bundled("small").expect("bundled");
    let heartbeat = Message::Heartbeat(Heartbeat::new(Status::default(), &profile, None));
    let bytes = heartbeat.encode(&profile);
    let cut = bytes[..7].iter().chain(&[END]).chain(&bytes).copied();
    assert_eq!(decoded(&profile, cut), [Ok(heartbeat)]);
}
