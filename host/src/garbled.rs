// SPDX-License-Identifier: MIT OR Apache-2.0
//! Garbled packets: how many pass for good ones, and how many would in the same framing with CRC-16.
//!
//! A million each, or as many as the environment says:
//! `PACKETS=100000000 cargo test --release -p hapticore-host --lib garbled -- --nocapture`.

use crate::decoder::push;
use crate::line::{Check, Collector, Crc32, from_board};
use crate::packet::{Layout, Message, Packet, Status};
use crc::{CRC_16_IBM_3740, Crc};
use fastrand::Rng;
use hapticore_contract::frame::{Field, Flags, Frame};
use hapticore_contract::profile::Profile;
use hapticore_protocol::framing::END;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// The control: a check of two bytes, as that of the line's first version.
#[derive(Debug, Clone)]
struct Crc16;

impl Check for Crc16 {
    const BYTES: usize = 2;

    fn of(payload: &[u8]) -> u32 {
        const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_3740);
        CRC.checksum(payload).into()
    }
}

/// Good packets that garbled ones are made of.
const GOOD: usize = 1024;

/// What becomes of a packet.
#[derive(Debug, Clone, Copy)]
enum Garble {
    /// Some of its bytes are any bytes.
    Random,
    /// A byte or two are lost, and as many others come twice.
    Shifted,
    /// Two bytes are swapped, and two others.
    Swapped,
    /// A byte is lost.
    Lost,
    /// A byte comes twice.
    Doubled,
    /// All bits within 5 to 12 bytes may be others.
    Burst,
    /// Its first part is followed by the second part of another packet.
    Joined,
}

const GARBLES: [Garble; 7] = [
    Garble::Random,
    Garble::Shifted,
    Garble::Swapped,
    Garble::Lost,
    Garble::Doubled,
    Garble::Burst,
    Garble::Joined,
];

impl Garble {
    /// Garbles a packet, which stands before its END.
    fn apply(self, bytes: &mut Vec<u8>, other: &[u8], rng: &mut Rng) {
        let any = |bytes: &[u8], rng: &mut Rng| rng.usize(..bytes.len());
        match self {
            Garble::Random => {
                for _ in 0..rng.usize(1..=8) {
                    let at = any(bytes, rng);
                    bytes[at] = rng.u8(..);
                }
            }
            Garble::Shifted => {
                for _ in 0..rng.usize(1..=2) {
                    let (lost, twice) = (any(bytes, rng), any(bytes, rng));
                    let byte = bytes[twice];
                    bytes.insert(twice, byte);
                    bytes.remove(lost);
                }
            }
            Garble::Swapped => {
                for _ in 0..2 {
                    let (first, second) = (any(bytes, rng), any(bytes, rng));
                    bytes.swap(first, second);
                }
            }
            Garble::Lost => drop(bytes.remove(any(bytes, rng))),
            Garble::Doubled => {
                let at = any(bytes, rng);
                bytes.insert(at, bytes[at]);
            }
            Garble::Burst => {
                let at = any(bytes, rng);
                let end = (at + rng.usize(5..=12)).min(bytes.len());
                bytes[at..end].iter_mut().for_each(|byte| *byte ^= rng.u8(..));
            }
            Garble::Joined => {
                let at = rng.usize(1..bytes.len() - 1);
                bytes.truncate(at);
                bytes.extend_from_slice(&other[at..]);
            }
        }
    }
}

/// Any frame: words are as often small as not.
fn message(profile: &Profile, rng: &mut Rng) -> Message {
    let word = Field::word(profile);
    let codes = std::array::from_fn(|_| {
        let code = rng.i64(word.min_code() as i64..=word.max_code() as i64);
        if rng.bool() { code } else { code >> rng.u8(..word.width) }
    });
    let status = Status { sequence: rng.u16(..), commands: rng.u8(..16), ..Status::default() };
    let pad = rng.usize(..profile.pads as usize);
    Message::Frame(Packet { status, frame: Frame { pad, codes, flags: Flags::default() } })
}

/// `packets` garbled packets of each kind: how many of them the decoder takes for good ones.
fn accepted<C: Check>(profile: &Profile, seed: u64, packets: u64) -> [u64; GARBLES.len()] {
    let layout = Layout::new(profile);
    let (mut collector, mut rng) =
        (Collector::<C>::new(layout.payload_bytes()), Rng::with_seed(seed));
    let mut good = Vec::new();
    for _ in 0..GOOD {
        let message = message(profile, &mut rng);
        let mut bytes = from_board::<C>(&layout.payload(&message));
        assert_eq!(bytes.pop(), Some(END));
        good.push((bytes, message));
    }
    let mut bytes = Vec::new();
    GARBLES.map(|garble| {
        let mut passed = 0;
        for _ in 0..packets {
            // Two packets: parts of one, joined, are that one.
            let which = rng.usize(..GOOD);
            let (one, first) = &good[which];
            let (other, second) = &good[(which + rng.usize(1..GOOD)) % GOOD];
            loop {
                bytes.clone_from(one);
                garble.apply(&mut bytes, other, &mut rng);
                if bytes != *one && bytes != *other {
                    break;
                }
            }
            let ended = bytes.iter().copied().chain([END]);
            let mut heard = ended.filter_map(|byte| push(&layout, &mut collector, byte)?.ok());
            let wrong = heard.find(|message| message != first && message != second);
            passed += u64::from(wrong.is_some());
        }
        passed
    })
}

/// Packets of a kind and check by all processors: how many of each kind are taken for good ones.
fn all_accepted<C: Check>(profile: &Profile, packets: u64) -> [u64; GARBLES.len()] {
    const LOT: u64 = 20_000;
    let next = AtomicU64::new(0);
    let work = || {
        let mut sum = [0; GARBLES.len()];
        loop {
            let lot = next.fetch_add(1, Ordering::Relaxed);
            if lot * LOT >= packets {
                return sum;
            }
            let passed = accepted::<C>(profile, lot, LOT.min(packets - lot * LOT));
            sum.iter_mut().zip(passed).for_each(|(sum, passed)| *sum += passed);
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        let running: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        let mut sum = [0; GARBLES.len()];
        for thread in running {
            let passed = thread.join().expect("a thread that ends");
            sum.iter_mut().zip(passed).for_each(|(sum, passed)| *sum += passed);
        }
        sum
    })
}

#[test]
fn of_garbled_packets_none_is_accepted_and_with_crc_16_some_are() {
    let profile = Profile::bundled("standard").expect("bundled");
    let packets = std::env::var("PACKETS").map_or(1_000_000, |all| all.parse().expect("a number"));
    let of_each = u64::div_ceil(packets, GARBLES.len() as u64);
    let begin = Instant::now();
    let (strong, weak) =
        (all_accepted::<Crc32>(&profile, of_each), all_accepted::<Crc16>(&profile, of_each));
    println!(
        "garbled packets accepted, of {of_each} of each kind: CRC-32, and CRC-16 for comparison"
    );
    for (kind, (strong, weak)) in GARBLES.iter().zip(strong.iter().zip(&weak)) {
        println!("{:>8}: {strong:6} {weak:6}", format!("{kind:?}"));
    }
    let [strong, weak] = [strong, weak].map(|passed| passed.into_iter().sum::<u64>());
    let all = of_each * GARBLES.len() as u64;
    println!(
        "{:>8}: {strong:6} {weak:6}   of {all}, {:.1} s",
        "all",
        begin.elapsed().as_secs_f64()
    );
    assert_eq!(strong, 0, "of {all} packets");
    let by_chance = all as f64 / 65_536.0;
    assert!(weak > 0, "a control that shows nothing");
    assert!(
        (weak as f64) < by_chance + 5.0 * by_chance.sqrt(),
        "{weak}, {by_chance:.1} by chance at most"
    );
}
