// SPDX-License-Identifier: MIT OR Apache-2.0
//! Single-event upsets: a bit of a register or of a memory is inverted in some clock, and the core
//! runs on beside the device that it drives.
//!
//! Without an upset the state at the end of each frame comes back round after round. Once the state
//! after an upset is that of the same frame without it, everything that follows is the same for
//! ever.

use std::collections::{BTreeMap, BTreeSet};

use fastrand::Rng;
use hapticore_contract::frame::{Flags, Frame};
use hapticore_hdl::block::{Edit, Submodule, Visitor};
use hapticore_hdl::bundle::Field;
use hapticore_hdl::format::Format;
use hapticore_hdl::memory::Memory;
use hapticore_hdl::signal::{Overflow, Rounding, Signal, Value};
use rayon::prelude::*;

use super::bits::{Bits, Words};
use super::device::{Ask, Device, Now};

/// Rounds of all pads until an upset that is still seen is one that stays.
const MOST_ROUNDS: u64 = 6;

/// A bit that may be inverted.
#[derive(Debug, Clone)]
pub struct Site {
    /// Instance and register, or instance and memory.
    pub name: String,
    /// In the order of the states.
    word: usize,
    bit: u8,
}

/// What became of the core after an upset.
#[derive(Debug, Clone, Default)]
pub struct Fate {
    /// Frames of each pad that were not as they should be.
    wrong: Vec<u64>,
    /// How many of these had a flag.
    flagged: u64,
    /// Clocks until all frames were right again, and came when they should.
    right_after: u64,
    /// The state is that without the upset.
    pub recovered: bool,
}

/// Fates of many upsets.
#[derive(Debug, Clone, Default)]
pub struct Fates {
    /// Upsets after which the state is in the end that without.
    pub recovered: u64,
    /// Upsets that no frame shows.
    pub unseen: u64,
    /// Upsets with a wrong frame.
    pub seen: u64,
    /// Wrong frames, and how many of them had a flag.
    pub frames: [u64; 2],
    /// Most wrong frames of a pad, where the state recovers.
    pub most: u64,
    /// Longest time until frames were right again, rounds of all pads, where the state recovers.
    pub rounds: f64,
    /// What stays: upsets that leave a trace, and those with wrong frames at the end, by name.
    pub stays: BTreeMap<String, [u64; 2]>,
    /// Names of upsets after which a pad had more than one wrong frame, and recovered.
    pub repeats: BTreeSet<String>,
}

/// A core that has settled, and what it gives without upsets.
pub struct Steady<'a> {
    device: &'a Device,
    now: Now,
    /// Frame and state at its end, of each pad.
    rounds: Vec<(Frame, Vec<i64>)>,
}

/// Every bit of every register.
pub fn registers(device: &Device) -> Vec<Site> {
    sites(device).0
}

/// Every bit of every memory's words.
pub fn memories(device: &Device) -> Vec<Site> {
    sites(device).1
}

fn sites(device: &Device) -> (Vec<Site>, Vec<Site>) {
    let mut names = Names::default();
    device.core.visit("core", &device.start().core, &mut names);
    (names.registers, names.memories)
}

impl<'a> Steady<'a> {
    /// The core of a device after enough rounds for its state to come back.
    ///
    /// # Panics
    /// Where it does not.
    pub fn of(device: &'a Device) -> Self {
        let mut now = device.start();
        for _ in 0..(device.bench.profile.haptic.windows + 2) * device.round() {
            device.clock(&mut now, Ask::default());
        }
        let round = |now: &mut Now| {
            let mut found = BTreeMap::new();
            for _ in 0..device.round() {
                if let Some(frame) = device.clock(now, Ask::default()) {
                    found.insert(frame.pad, (frame, device.state(now)));
                }
            }
            found.into_values().collect::<Vec<_>>()
        };
        let rounds = round(&mut now);
        assert_eq!(rounds.len() as u64, device.bench.profile.pads, "a frame of every pad");
        assert!(rounds.iter().all(|(frame, _)| !flagged(frame)), "{:?}", rounds[0].0);
        assert!(rounds == round(&mut now), "the state comes back");
        Steady { device, now, rounds }
    }

    /// Words of a state.
    pub fn words(&self) -> usize {
        self.rounds[0].1.len()
    }

    /// The frame of each pad.
    pub fn frames(&self) -> impl Iterator<Item = &Frame> {
        self.rounds.iter().map(|(frame, _)| frame)
    }

    /// Runs on in step with what would be without disturbance, and disturbs copies of it, each at
    /// one of `clocks` of a round.
    pub fn disturbed<T: Send>(
        &self,
        clocks: &[u64],
        disturb: impl Fn(usize, Now) -> T + Sync,
    ) -> Vec<T> {
        let mut order: Vec<usize> = (0..clocks.len()).collect();
        order.sort_by_key(|&k| clocks[k]);
        let (mut now, mut at, mut found) = (self.now.clone(), 0, Vec::new());
        for chunk in order.chunks(64) {
            let mut copies = Vec::new();
            for &k in chunk {
                while at < clocks[k] {
                    self.device.clock(&mut now, Ask::default());
                    at += 1;
                }
                copies.push((k, now.clone()));
            }
            found.par_extend(copies.into_par_iter().map(|(k, now)| disturb(k, now)));
        }
        found
    }

    /// What becomes of a core whose state is now this.
    pub fn fate(&self, mut now: Now) -> Fate {
        let (device, pads) = (self.device, self.rounds.len());
        let slot = device.bench.profile.slot_clocks();
        let mut fate = Fate { wrong: vec![0; pads], ..Fate::default() };
        let mut last = None;
        for clock in 1..=MOST_ROUNDS.max(device.bench.profile.haptic.windows + 3) * device.round() {
            let Some(frame) = device.clock(&mut now, Ask::default()) else { continue };
            let late =
                last.is_some_and(|last| clock - last != slot) || clock > 2 * slot && last.is_none();
            last = Some(clock);
            let expected = self.rounds.get(frame.pad);
            if expected.is_none_or(|(expected, _)| *expected != frame) {
                fate.wrong[frame.pad % pads] += 1;
                fate.flagged += u64::from(flagged(&frame));
                fate.right_after = clock;
            } else if late {
                fate.right_after = clock;
            }
            if expected.is_some_and(|(_, state)| *state == device.state(&now)) {
                fate.recovered = true;
                break;
            }
        }
        if last.is_none() {
            fate.right_after = u64::MAX;
        }
        fate
    }

    /// Inverts each of these bits, each in a random clock of a round.
    pub fn upset(&self, sites: &[Site], seed: u64) -> Fates {
        let (mut rng, round) = (Rng::with_seed(seed), self.device.round());
        let clocks: Vec<u64> = sites.iter().map(|_| rng.u64(0..round)).collect();
        let fates = self.disturbed(&clocks, |k, mut now| {
            self.device
                .core
                .edit(&mut now.core, &mut Flip { before: sites[k].word, bit: sites[k].bit });
            (k, self.fate(now))
        });
        let mut all = Fates::default();
        for (k, fate) in &fates {
            all.count(&sites[*k].name, fate, round);
        }
        all
    }
}

impl Fate {
    /// Most wrong frames of a pad.
    pub fn most_wrong(&self) -> u64 {
        self.wrong.iter().copied().max().unwrap_or(0)
    }
}

impl Fates {
    fn count(&mut self, name: &str, fate: &Fate, round: u64) {
        let wrong: u64 = fate.wrong.iter().sum();
        self.frames[0] += wrong;
        self.frames[1] += fate.flagged;
        *(if wrong == 0 { &mut self.unseen } else { &mut self.seen }) += 1;
        if fate.recovered {
            self.recovered += 1;
            self.most = self.most.max(fate.most_wrong());
            if fate.most_wrong() > 1 {
                self.repeats.insert(name.into());
            }
            self.rounds = self.rounds.max(fate.right_after as f64 / round as f64);
            return;
        }
        let stays = self.stays.entry(name.into()).or_default();
        stays[0] += 1;
        stays[1] += u64::from(fate.right_after > 2 * round);
    }

    /// With those of others.
    pub fn and(mut self, others: Fates) -> Fates {
        for (name, [traces, wrong]) in others.stays {
            let stays = self.stays.entry(name).or_default();
            (stays[0], stays[1]) = (stays[0] + traces, stays[1] + wrong);
        }
        Fates {
            recovered: self.recovered + others.recovered,
            unseen: self.unseen + others.unseen,
            seen: self.seen + others.seen,
            frames: [self.frames[0] + others.frames[0], self.frames[1] + others.frames[1]],
            most: self.most.max(others.most),
            rounds: self.rounds.max(others.rounds),
            stays: self.stays,
            repeats: &self.repeats | &others.repeats,
        }
    }
}

fn flagged(frame: &Frame) -> bool {
    frame.flags != Flags::default()
}

#[derive(Default)]
struct Names {
    path: Vec<&'static str>,
    words: usize,
    registers: Vec<Site>,
    memories: Vec<Site>,
}

impl Names {
    fn bits(&mut self, of: &str, format: Format) -> Vec<Site> {
        let name = format!("{}.{of}", self.path[1..].join("."));
        let word = self.words;
        self.words += 1;
        (0..format.width).map(|bit| Site { name: name.clone(), word, bit }).collect()
    }
}

impl Visitor<Bits> for Names {
    fn enter(&mut self, name: &'static str) {
        self.path.push(name);
    }
    fn register(&mut self, field: &'static Field, format: Format, _value: Bits) {
        let bits = self.bits(field.name, format);
        self.registers.extend(bits);
    }
    fn memory(&mut self, memory: &Memory, words: &Words) {
        for _ in 0..=words.words.len() {
            let bits = self.bits(memory.name, memory.format);
            self.memories.extend(bits);
        }
    }
    fn leave(&mut self) {
        self.path.pop();
    }
}

/// Inverts a bit of the word that comes after `before` others.
struct Flip {
    before: usize,
    bit: u8,
}

impl Edit<Bits> for Flip {
    fn word(&mut self, format: Format, value: Bits) -> Bits {
        let hit = self.before == 0;
        self.before = self.before.wrapping_sub(1);
        if !hit {
            return value;
        }
        let flipped = Signal { value: Bits(value.0 ^ 1 << self.bit), format };
        Bits::quantize(flipped, format, Rounding::Exact, Overflow::Wrap)
    }
    fn memory(&mut self, memory: &Memory, words: &mut Words) {
        for word in words.words.iter_mut().chain([&mut words.data]) {
            *word = self.word(memory.format, *word);
        }
    }
}
