// SPDX-License-Identifier: MIT OR Apache-2.0
//! Random sequences of commands, resets and faults on the complete board. The rig holds in each that no channel is above the
//! rail or above the slew from zero that were set since the last reset. Here: 0 V within its time, and that the drive
//! reaches a lawful target.
//!
//! `SAFETY_SEQUENCES=10000 cargo test --release -p hapticore-rtl --test board safety::random -- --nocapture`, or a part of
//! them: `SAFETY_SEQUENCES=2000..4000`.

use super::rig::{AT_ONCE, FULL_SCALE_V, PADS, Pad, Rig, open_drive, profile, tuning};
use crate::pins::Health;
use crate::random::Random;
use hapticore_contract::control::{Law, Tuning};
use hapticore_contract::profile::Profile;
use hapticore_host::{Command, drive, encode};
use std::thread;

const SEED: u64 = 48;
/// Sequences where the environment names no number.
const SEQUENCES: u64 = 200;
const STEPS: u64 = 8;
/// What a drive at its target may be off, part of full scale.
const REACHED: f64 = 0.002;

/// What happened in some sequences.
#[derive(Debug, Default)]
struct Told {
    sequences: u64,
    reached: u64,
    largest_v: f64,
    longest_to_zero: u64,
    clocks: u64,
}

/// A step of a sequence.
fn step(rig: &mut Rig, random: &mut Random, told: &mut Told) {
    let slot = rig.profile.slot_clocks();
    let pad = random.below(PADS as u64) as usize;
    match random.below(14) {
        0 => rig.send(&[Command::ENABLE]),
        1 => {
            rig.send(&[Command::DISABLE]);
            told.longest_to_zero = told.longest_to_zero.max(rig.until_zero(AT_ONCE));
        }
        2 => {
            rig.reset(1 + random.below(300));
            told.longest_to_zero = told.longest_to_zero.max(rig.until_zero(AT_ONCE));
        }
        3 => rig.targets(random.between(0.0, 1.5)),
        4 => {
            let tuning = any_tuning(rig, random);
            rig.tune(&tuning);
        }
        5 => {
            // A part of the settings, or settings that are damaged.
            let tuning = any_tuning(rig, random);
            let commands = drive::tune(&rig.profile, &tuning).expect("a controller");
            let some: Vec<_> = commands.into_iter().filter(|_| random.below(2) == 0).collect();
            rig.send(&some);
        }
        6 => {
            let tuning = any_tuning(rig, random);
            let commands = drive::tune(&rig.profile, &tuning).expect("a controller");
            let mut bytes = encode(&commands, &rig.profile);
            for _ in 0..commands.len() {
                let at = random.below(bytes.len() as u64) as usize;
                bytes[at] ^= 1 << random.below(8);
            }
            // What is whole among them counts.
            rig.send(&[]);
            rig.watch.rail = rig.watch.rail.max(tuning.rail);
            rig.watch.slew = rig.watch.slew.max(tuning.slew);
            rig.send_bytes(bytes);
        }
        7 => rig.pads[pad] = Pad { share: 0.01 * random.between(0.1, 20.0) },
        8 => rig.pads[pad] = Pad { share: random.between(0.6, 1.6) },
        9 => rig.adc.broken = Some((random.below(8) as usize, random.below(2) as i64)),
        10 => rig.adc.health = [Health::Absent, Health::Slow][random.below(2) as usize],
        11 => (rig.adc.broken, rig.adc.health) = (None, Health::Well),
        12 => rig.send(&[drive::clear_faults()]),
        _ => {
            rig.send(&[drive::rest()]);
            rig.until_zero(rig.frame_clocks() + AT_ONCE);
        }
    }
    rig.run(random.below(3 * slot));
    if rig.enabled && random.below(3) == 0 {
        rig.frames(2);
    }
}

fn any_tuning(rig: &Rig, random: &mut Random) -> Tuning {
    let cap = if random.below(4) == 0 { 0.001 } else { f64::INFINITY };
    let of = tuning(&rig.profile, random.between(0.05, 0.9), random.between(0.01, 0.3));
    Tuning { force_cap: cap, ..of }
}

/// A lawful target at the end of a sequence: the drive reaches it in time.
fn reach(rig: &mut Rig, random: &mut Random) {
    (rig.adc.broken, rig.adc.health) = (None, Health::Well);
    rig.pads = [Pad { share: 1.0 }; PADS];
    rig.send(&[Command::DISABLE]);
    rig.until_zero(AT_ONCE);
    let (rail, slew) = (random.between(0.3, 0.9), random.between(0.05, 0.4));
    let newtons = random.between(0.1, 1.0);
    let tuning = tuning(&rig.profile, rail, slew);
    rig.start(&tuning, newtons, false);
    let expected = open_drive(&rig.profile, newtons, rail);
    let frames = (expected / slew).ceil() as u64 + 2;
    for _ in 0..frames {
        rig.targets(newtons);
        rig.frames(1);
    }
    for (channel, now) in rig.watch.now.iter().enumerate() {
        assert!(
            (now - expected).abs() < REACHED,
            "channel {channel}: {now:.4} of full scale after {frames} frames, expected {expected:.4}: {:?}",
            rig.driven()
        );
    }
    assert!(rig.is_live());
}

/// Slots of 2,750 clocks in place of 8,750: sequences have as many slots, in less time.
fn with_short_slots(mut profile: Profile) -> Profile {
    profile.slot.settle -= 120;
    hapticore_model::check(&profile).expect("a slot longer than the estimator takes");
    profile
}

fn sequence(ready: &Rig, law: Law, number: u64) -> Told {
    let mut rig = ready.clone();
    let mut random = Random::new(SEED + number);
    let mut told = Told { sequences: 1, ..Told::default() };
    for _ in 0..STEPS {
        step(&mut rig, &mut random, &mut told);
    }
    // More than half of all sequences end with a lawful target.
    if law == Law::Open && random.below(6) != 0 {
        reach(&mut rig, &mut random);
        told.reached += 1;
    }
    told.largest_v = rig.watch.largest_v;
    told.clocks = rig.clock - ready.clock;
    told
}

/// The numbers of the sequences, the end excluded.
fn wanted() -> (u64, u64) {
    let Ok(text) = std::env::var("SAFETY_SEQUENCES") else { return (0, SEQUENCES) };
    let number = |text: &str| text.parse().expect("SAFETY_SEQUENCES: expected N or FROM..TO");
    text.split_once("..")
        .map_or_else(|| (0, number(&text)), |(from, to)| (number(from), number(to)))
}

#[test]
fn no_sequence_drives_above_rail_or_slew_and_a_lawful_target_is_reached() {
    let (first, end) = wanted();
    let worker = |part: u64| {
        let laws = [Law::Open, Law::Inverse, Law::Integral];
        let mut told = Told::default();
        // Rigs are cloned, not shared: each worker makes its own. Two of three sequences are of the open law.
        let ready: Vec<(Law, Rig)> = laws
            .into_iter()
            .map(|law| {
                let mut rig = Rig::of(with_short_slots(profile(law)));
                rig.prepare(true);
                (law, rig)
            })
            .collect();
        for number in (first + part..end).step_by(2) {
            let (law, rig) = &ready[[0, 0, 0, 1, 0, 2][(number / 2 % 6) as usize]];
            let one = sequence(rig, *law, number);
            told.sequences += 1;
            told.reached += one.reached;
            told.clocks += one.clocks;
            told.largest_v = told.largest_v.max(one.largest_v);
            told.longest_to_zero = told.longest_to_zero.max(one.longest_to_zero);
        }
        told
    };
    let parts: Vec<Told> = thread::scope(|scope| {
        let parts: Vec<_> = (0..2).map(|part| scope.spawn(move || worker(part))).collect();
        parts.into_iter().map(|part| part.join().expect("a worker")).collect()
    });
    let sum = |of: fn(&Told) -> u64| parts.iter().map(of).sum::<u64>();
    let (sequences, reached) = (sum(|told| told.sequences), sum(|told| told.reached));
    let clocks = sum(|told| told.clocks);
    let largest_v = parts.iter().map(|told| told.largest_v).fold(0.0, f64::max);
    let longest = parts.iter().map(|told| told.longest_to_zero).max().unwrap_or(0);
    println!(
        "{sequences} sequences of {clocks} clocks, {reached} reached their target; at most {largest_v:.0} V; 0 V after a reset or DISABLE within {:.1} µs",
        longest as f64 / 25.0
    );
    assert!(largest_v <= FULL_SCALE_V);
    assert!(2 * reached >= sequences, "{reached} of {sequences} have a lawful target");
}
