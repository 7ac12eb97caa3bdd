// SPDX-License-Identifier: MIT OR Apache-2.0
//! Mutants in a core, on the schedule of its strobes.

use crate::isolation::{place, short};
use hapticore_contract::profile::{ForceLaw, Profile};
use hapticore_hdl::format::BIT;
use hapticore_hdl::interpretations::netlist::mutants::Mutant;
use hapticore_hdl::interpretations::netlist::{Named, Netlist, Node};
use hapticore_rtl::netlist::of_profile;
use hapticore_synth::equivalence::SideBySide;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Mutex;

/// Mutants that are followed side by side.
const BATCH: usize = 16;

/// Clocks of a round in which `clear` is asserted, each in a round of its own: parts of the round.
pub const CLEARS: u64 = 2;

/// Rounds after which what is known has to have repeated.
const MOST_ROUNDS: usize = 6;

/// Clocks after which the designs forget how what they hold has come about.
const REMEMBERED: u64 = 250;

/// What holds for a frame, while `valid` is asserted.
const FRAME: [&str; 8] =
    ["index", "frame", "pad", "clipped", "saturated", "invalid", "lost", "lifted"];

/// Designs beside one another, and the clock of their schedule.
struct Run<'a> {
    profile: &'a Profile,
    ports: &'a [Named],
    of_frame: Vec<usize>,
    valid: usize,
    all: SideBySide,
    inputs: Vec<Node>,
}

impl<'a> Run<'a> {
    fn new(netlist: &'a Netlist, profile: &'a Profile, names: &[String]) -> Self {
        let mutants = names.iter().filter_map(|name| {
            let (mutated, starts) = Mutant::netlist(netlist, name)?;
            Some((name.clone(), mutated, starts))
        });
        let mut all = SideBySide::new(netlist, mutants);
        let (ports, outputs) = (&netlist.top().inputs, &netlist.top().outputs);
        let inputs = ports.iter().map(|port| all.unknown(port.format)).collect();
        let of_frame = FRAME.iter().map(|name| place(outputs, name)).collect();
        Run { profile, ports, of_frame, valid: place(outputs, "valid"), all, inputs }
    }

    /// One clock of the schedule.
    fn clock(&mut self, strobe: bool, clear: bool) {
        for (port, input) in self.ports.iter().zip(&mut self.inputs) {
            *input = match port.name {
                "strobe" => self.all.known(strobe.into(), BIT),
                "clear" => self.all.known(clear.into(), BIT),
                "write" => self.all.known(0, BIT),
                "code" => self.all.unknown(port.format),
                _ if port.format == BIT => self.all.unknown(BIT),
                _ => continue,
            };
        }
        let (valid, of_frame) = (self.valid, &self.of_frame);
        self.all.clock(&self.inputs, |port, sound| {
            !of_frame.contains(&port) || sound[valid] != Some(0)
        });
    }

    fn round(&self) -> u64 {
        self.profile.pads * self.profile.slot.samples() * self.profile.clocks_per_sample
    }

    /// The first clocks of a round.
    fn clocks(&mut self, count: u64) {
        let period = self.profile.clocks_per_sample;
        for clock in 0..count {
            // At the same clocks of each round: what is known repeats.
            if clock.is_multiple_of(REMEMBERED) {
                self.all.forget(&mut self.inputs);
            }
            self.clock(clock.is_multiple_of(period), false);
        }
    }

    /// Rounds until what is known repeats; whether it does.
    fn settle(&mut self) -> bool {
        let mut seen = BTreeSet::new();
        for _ in 0..MOST_ROUNDS {
            if self.all.names().is_empty() || !seen.insert(self.all.knowledge(&mut self.inputs)) {
                return true;
            }
            self.clocks(self.round());
        }
        false
    }

    /// A `clear` in a clock of a round; the next strobe comes when it would have.
    fn clear(&mut self, at: u64) -> bool {
        let period = self.profile.clocks_per_sample;
        self.clocks(at);
        self.clock(at.is_multiple_of(period), true);
        (at + 1..(at + 1).next_multiple_of(period)).for_each(|_| self.clock(false, false));
        self.settle()
    }

    /// The mutants that are equivalent.
    fn proved(mut self, clears: u64) -> Vec<String> {
        let round = self.round();
        let clears = (0..clears).map(|k| k * round / clears + k * k);
        let settled = self.settle() && clears.into_iter().all(|at| self.clear(at));
        if settled { self.all.names().to_vec() } else { Vec::new() }
    }
}

/// A core in which mutants are followed.
pub struct Core {
    name: &'static str,
    profile: Profile,
    /// Its netlist.
    pub netlist: Netlist,
}

impl Core {
    /// A bundled profile's, of two pads and with slots as short as they may be.
    fn new(name: &'static str, law: ForceLaw) -> Self {
        let mut profile = Profile::bundled(name).expect("bundled");
        (profile.pads, profile.force.law) = (2, law);
        // The program's loop is the same, however often it is run through.
        profile.position.steps = 2;
        let profile = short(profile);
        let netlist = of_profile(&profile).expect("a design");
        Core { name, profile, netlist }
    }

    /// One of each method and force law.
    pub fn all() -> Vec<Core> {
        vec![Core::new("small", ForceLaw::Eq8), Core::new("standard", ForceLaw::Table)]
    }
}

/// Of these mutants those that are equivalent in each core that has them; the others that one has.
pub fn proved(cores: &[Core], names: &[String], clears: u64) -> [BTreeSet<String>; 2] {
    let verdicts = Mutex::new(BTreeMap::<String, bool>::new());
    let mut work = Vec::new();
    for core in cores {
        // Only some clears are followed.
        let own = |name: &&String| {
            !name.contains(" of clear") && Mutant::netlist(&core.netlist, name).is_some()
        };
        let names: Vec<String> = names.iter().filter(own).cloned().collect();
        work.extend(names.chunks(BATCH).map(|batch| (core, batch.to_vec())));
    }
    let work = Mutex::new(work.into_iter());
    let follow = || {
        loop {
            let next = work.lock().expect("no panic").next();
            let Some((core, batch)) = next else { return };
            let equivalent = Run::new(&core.netlist, &core.profile, &batch).proved(clears);
            println!("{}: {} of {} equivalent", core.name, equivalent.len(), batch.len());
            let mut verdicts = verdicts.lock().expect("no panic");
            for name in batch {
                let equal = equivalent.contains(&name);
                *verdicts.entry(name).or_insert(true) &= equal;
            }
        }
    };
    std::thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(follow))));
    let verdicts = verdicts.into_inner().expect("no panic");
    [true, false].map(|wanted| {
        let own = verdicts.iter().filter(|(_, equivalent)| **equivalent == wanted);
        own.map(|(name, _)| name.clone()).collect()
    })
}
