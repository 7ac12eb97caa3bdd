// SPDX-License-Identifier: MIT OR Apache-2.0
//! The same stimulus again and again: nothing drifts, and nothing is wrong where counters wrap.
//!
//! `cargo run --release -p hapticore-tests --example long_run` is the whole of it: 10⁹ samples, slot by slot or every clock.

use hapticore_contract::frame::Frame;
use hapticore_contract::profile::Profile;
use hapticore_host::{Decoder, Message, Packet, SlotClock, Status};
use hapticore_model::fidelity::clock::ClockSimulation;

use super::bench::{Bench, PROFILES};
use super::system::recurring_state;
use super::{Case, Group, Outcome};

/// The group on the page.
pub const GROUP: Group = Group {
    name: "long_runs",
    title: "Long runs",
    about: "A round of four slots (a large pad, a small one, noise at full scale, nothing) again and again.",
    cases: &[
        Case {
            name: "ten_million_samples",
            stimulus: "10⁷ samples in the windows of each profile, fidelity `fixed` (10⁹: `cargo run --release -p hapticore-tests --example long_run`)",
            must: "every frame that of the first round",
            run: ten_million_samples,
        },
        Case {
            name: "every_clock",
            stimulus: "10⁵ samples of each profile, fidelity `clock` (10⁹: `long_run -- 1000000000 standard clock`)",
            must: "every frame that of the first round of fidelity `fixed`",
            run: every_clock,
        },
        Case {
            name: "phase_after_2_to_the_32_samples",
            stimulus: "a round of all pads after another, every clock, registers, memories and the carrier",
            must: "the whole state comes back each round, so that the phase after 2³² samples or any other number is exact",
            run: phase_for_ever,
        },
        Case {
            name: "sequence_numbers_wrap",
            stimulus: "140,000 packets of the serial line through encoder and decoder",
            must: "every packet whole and in order, times without a gap where numbers wrap",
            run: sequence_numbers_wrap,
        },
    ],
};

/// The slots of a round, blanking and window.
fn round(bench: &Bench) -> [Vec<i32>; 4] {
    let mut rng = fastrand::Rng::with_seed(9);
    [
        bench.slot(|n, channel| bench.signal(&bench.pad(0.9), n, channel)),
        bench.slot(|n, channel| bench.signal(&bench.pad(1e-3), n, channel)),
        bench.slot(|_, _| 2.0 * rng.f64() - 1.0),
        bench.slot(|_, _| 0.0),
    ]
}

/// Repeats the round until `samples` samples of windows have passed; returns the number of slots,
/// each with the frame of the first round.
///
/// # Panics
/// Where a frame is another.
pub fn repeat(bench: &Bench, samples: u64) -> u64 {
    let blanked = bench.profile.slot.blanking() as usize * bench.profile.channels();
    let (slots, mut fixed) = (round(bench), bench.fixed());
    let first = frames_of_first_round(bench);
    let count = samples.div_ceil(bench.profile.slot.integrate);
    for slot in 0..count {
        let of = (slot % 4) as usize;
        let frame = fixed.slot(of, &slots[of][blanked..]);
        assert_eq!(frame, first[of], "{}: slot {slot}", bench.profile.name);
    }
    count
}

fn frames_of_first_round(bench: &Bench) -> [Frame; 4] {
    let blanked = bench.profile.slot.blanking() as usize * bench.profile.channels();
    let (slots, mut fixed) = (round(bench), bench.fixed());
    // Where nothing is found, the core outputs the last valid results: those of the slot before.
    let mut of = |slot: usize| fixed.slot(slot, &slots[slot][blanked..]);
    (0..4).for_each(|slot| {
        of(slot);
    });
    std::array::from_fn(of)
}

fn ten_million_samples() -> Outcome {
    let slots = Bench::all().iter().map(|bench| repeat(bench, 10_000_000)).sum();
    Outcome::default().equal(slots)
}

/// The same at every clock, until `samples` samples of whole slots have passed. Returns the number of slots; each but
/// those of the first round has the frame of the first round of fidelity `fixed`.
///
/// # Panics
/// Where a frame is another.
pub fn repeat_every_clock(bench: &Bench, samples: u64) -> u64 {
    let profile = Profile { pads: 4, ..bench.profile.clone() };
    let (slots, first) = (round(bench), frames_of_first_round(bench));
    let mut clock = ClockSimulation::new(&profile, &bench.calibration);
    let count = samples.div_ceil(profile.slot.samples());
    for slot in 0..count {
        let of = (slot % 4) as usize;
        clock.samples(&slots[of]);
        let frame = clock.finish_slot().expect("a frame for every slot");
        assert!(slot < 4 || frame == first[of], "{}: slot {slot}", profile.name);
    }
    count
}

fn every_clock() -> Outcome {
    let slots = Bench::all().iter().map(|bench| repeat_every_clock(bench, 100_000)).sum();
    Outcome::default().equal(slots)
}

fn phase_for_ever() -> Outcome {
    let words: usize = PROFILES.map(recurring_state).iter().sum();
    Outcome::default().equal(words as u64)
}

fn sequence_numbers_wrap() -> Outcome {
    let bench = Bench::of("standard");
    let profile = &bench.profile;
    let frames = frames_of_first_round(&bench);
    let mut decoder = Decoder::new(profile);
    let mut clock = SlotClock::new(profile, 1e6, 0.0);
    let mut exact = SlotClock::new(profile, 1e6, 0.0);
    let (mut seen, mut numbers) = (0u64, std::collections::BTreeSet::new());
    for slot in 0..140_000u64 {
        // The line numbers frames from 1; its number has as many bits as the packet gives it.
        let status = Status { sequence: (slot + 1) as _, ..Status::default() };
        let packet = Packet { status, frame: frames[slot as usize % 4] };
        for byte in Message::Frame(packet).encode(profile) {
            let Some(message) = decoder.push(byte) else { continue };
            let found = message.expect("a whole packet").frame().expect("a frame");
            assert_eq!(found, packet, "slot {slot}");
            assert_eq!(clock.time_of(found.status.sequence), exact.tick(), "slot {slot}");
            numbers.insert(found.status.sequence);
            seen += 1;
        }
    }
    assert!((numbers.len() as u64) < seen, "numbers wrap");
    Outcome::of(format!("{} sequence numbers", numbers.len())).equal(seen)
}
