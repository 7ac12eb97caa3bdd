// SPDX-License-Identifier: MIT OR Apache-2.0
//! What happens to the core itself, at any clock: upsets, `clear`, reset, another calibration.

use std::fmt::Write;

use fastrand::Rng;

use super::device::{Ask, Device, Now};
use super::upsets::{Fate, Fates, Site, Steady, memories, registers};
use crate::stability::Outcome;
use crate::stability::bench::PROFILES;

/// This many clocks of a round, at random.
const CLOCKS: usize = 100;

fn some(sites: Vec<Site>, count: usize, seed: u64) -> Vec<Site> {
    let mut rng = Rng::with_seed(seed);
    let step = (sites.len() / count).max(1);
    sites.into_iter().skip(rng.usize(0..step)).step_by(step).collect()
}

/// What stays wrong, by name: upsets with a trace, and those of them with wrong frames.
fn list(fates: &Fates) -> String {
    let mut text = String::new();
    for (name, [traces, wrong]) in fates.stays.iter().filter(|(_, [_, wrong])| *wrong > 0) {
        let _ =
            write!(text, "{}`{name}` {traces} ({wrong})", if text.is_empty() { "" } else { ", " });
    }
    if text.is_empty() { "none".into() } else { text }
}

/// A share of the bits of all registers.
pub fn upset_registers() -> Outcome {
    let all = upsets(registers, [400, 100, 100], [usize::MAX, 600, 600]);
    let for_good: u64 = all.stays.values().map(|[_, wrong]| wrong).sum();
    counted(&all)
        .at_most("upsets with wrong frames for good", for_good as f64, 0.0, "")
        .at_most("wrong frames of a pad", all.most as f64, 1.0, "")
        .at_most("right again after", all.rounds, 1.5, "rounds")
        .equal(all.recovered)
}

/// Some bits of the memories, tables among them, which nothing writes again but a calibration.
pub fn upset_memories() -> Outcome {
    let all = upsets(memories, [60; 3], [500; 3]);
    counted(&all)
        .at_most("wrong frames of a pad, where it recovers", all.most as f64, 1.0, "")
        .equal(all.recovered)
}

/// As many upsets of each profile as `few` says; with `UPSETS=all` as many as `many` says, which takes
/// minutes.
fn upsets(sites: fn(&Device) -> Vec<Site>, few: [usize; 3], many: [usize; 3]) -> Fates {
    let counts = if std::env::var("UPSETS").as_deref() == Ok("all") { many } else { few };
    let mut all = Fates::default();
    for (name, count) in PROFILES.into_iter().zip(counts) {
        let device = Device::short(name);
        all = all.and(Steady::of(&device).upset(&some(sites(&device), count, 1), 2));
    }
    all
}

fn counted(all: &Fates) -> Outcome {
    let [wrong, flagged] = all.frames;
    let repeats: Vec<_> = all.repeats.iter().map(|name| format!("`{name}`")).collect();
    let repeats = match repeats.is_empty() {
        true => String::new(),
        false => format!("; a pad has more than one after some of {}", repeats.join(", ")),
    };
    Outcome::of(format!(
        "{} upsets, {} of them in no frame; {wrong} wrong frames, {flagged} flagged{repeats}; frames stay wrong after some of (upsets that left a trace; with wrong frames): {}",
        all.unseen + all.seen,
        all.unseen,
        list(all)
    ))
}

/// A round's clocks at random, and what becomes of copies of a core at each.
fn at_random(
    device: &Device,
    steady: &Steady,
    after: impl Fn(Now) -> Fate + Sync,
    most: u64,
) -> u64 {
    let (mut rng, round) = (Rng::with_seed(5), device.round());
    let clocks: Vec<u64> = (0..CLOCKS).map(|_| rng.u64(0..round)).collect();
    let fates = steady.disturbed(&clocks, |k, now| (clocks[k], after(now)));
    for (clock, fate) in &fates {
        let name = &device.bench.profile.name;
        assert!(fate.recovered && fate.most_wrong() <= most, "{name}, clock {clock}: {fate:?}");
    }
    fates.len() as u64
}

/// The input `clear`.
pub fn clear_in_mid_frame() -> Outcome {
    let count = PROFILES.map(|name| {
        let device = Device::short(name);
        let steady = Steady::of(&device);
        let clear = |mut now: Now| {
            device.clock(&mut now, Ask { clear: true, table: None });
            steady.fate(now)
        };
        at_random(&device, &steady, clear, 0)
    });
    Outcome::default().equal(count.iter().sum())
}

/// Every register to zero.
pub fn reset_in_mid_frame() -> Outcome {
    let count = PROFILES.map(|name| {
        let device = Device::short(name);
        let steady = Steady::of(&device);
        let reset = |mut now: Now| {
            device.reset(&mut now);
            steady.fate(now)
        };
        at_random(&device, &steady, reset, 0)
    });
    Outcome::default().equal(count.iter().sum())
}

/// Other gains and another position table, while slots go on.
pub fn calibration_changed_in_mid_frame() -> Outcome {
    let count = PROFILES.map(|name| {
        let before = Device::short(name);
        let mut bench = before.bench.clone();
        bench.calibration.capacitance_gain *= 1.1;
        bench.calibration.force_gain *= 0.9;
        bench.calibration.position.words.iter_mut().for_each(|word| *word *= 0.99);
        let words = bench.calibration.words(&bench.profile);
        let after = Device::with(bench);
        let (from, to) = (Steady::of(&before), Steady::of(&after));
        assert!(from.frames().zip(to.frames()).all(|(from, to)| from != to));
        let change = |mut now: Now| {
            for (address, word) in words.iter().enumerate() {
                after.clock(&mut now, Ask { clear: false, table: Some((address, *word)) });
            }
            to.fate(now)
        };
        at_random(&before, &from, change, 1)
    });
    Outcome::default().equal(count.iter().sum())
}
