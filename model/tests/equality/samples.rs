// SPDX-License-Identifier: MIT OR Apache-2.0
//! A core clocked in whole samples, whose blocks are clocked apart, beside one that is clocked as a whole.

use crate::device::{calibration, overlapping_profiles, short_profiles, short_table_profiles};
use crate::harness::{operations, show};
use crate::idle::flat;
use crate::overlap::slots;
use crate::random::Random;
use hapticore_contract::profile::{Profile, Terminals};
use hapticore_hdl::block::{Block, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::probe::sample;
use hapticore_hdl::signal::Signal;
use hapticore_model::blocks::core::{Core, Inputs, Observer, Outputs};
use hapticore_model::blocks::position::TablePort;

/// The outputs of clocks one after the other.
#[derive(Default)]
struct Seen(Vec<Outputs<i64>>);

impl Observer for Seen {
    fn outputs(&mut self, outputs: Outputs<Signal<i64>>) {
        self.0.push(Outputs::map(outputs, |signal| signal.value));
    }
}

/// Two cores of a profile: one clocked in whole samples, one clocked as a whole.
struct Pair<'a> {
    core: &'a Core,
    apart: State<Core, i64>,
    whole: State<Core, i64>,
    channels: usize,
    clocks: u64,
    /// The channels that were asked for last.
    asked: [usize; 2],
}

fn signals(core: &Core, codes: Inputs<i64>) -> Inputs<Signal<i64>> {
    Inputs::map(Inputs::zip(codes, core.inputs()), |(value, format)| Signal { value, format })
}

impl Pair<'_> {
    /// A clock of both, not at the profile's pace.
    fn clock(&mut self, inputs: Inputs<i64>) {
        let inputs = signals(self.core, inputs);
        let states = [&mut self.apart, &mut self.whole];
        for (state, asked) in states.into_iter().zip(&mut self.asked) {
            *asked = self.core.step(state, inputs).channel.value as usize;
        }
    }

    /// Samples: every output of each clock, and every register behind them.
    fn samples(&mut self, inputs: Inputs<i64>, codes: &[i32], case: &str) {
        let (mut got, mut expected) = (Seen::default(), Seen::default());
        let given = signals(self.core, inputs);
        self.core.samples(&mut self.apart, &given, codes, &mut self.asked[0], &mut got);
        for codes in codes.chunks_exact(self.channels) {
            for clock in 0..self.clocks {
                let (strobe, code) = (i64::from(clock == 0), codes[self.asked[1]].into());
                let given = signals(self.core, Inputs { strobe, code, ..inputs });
                let outputs = self.core.step(&mut self.whole, given);
                self.asked[1] = outputs.channel.value as usize;
                expected.outputs(outputs);
            }
        }
        assert_eq!(got.0.len(), expected.0.len(), "{case}: clocks");
        for (clock, (got, expected)) in got.0.into_iter().zip(expected.0).enumerate() {
            let same = flat::<Outputs>(got) == flat::<Outputs>(expected);
            let (got, expected) = (show::<Outputs>(got), show::<Outputs>(expected));
            assert!(same, "{case}, clock {clock}\napart: {got}\nwhole: {expected}");
        }
        let registers = [&self.apart, &self.whole].map(|state| {
            let mut codes = Vec::new();
            sample(self.core, state, &mut codes);
            codes
        });
        assert!(registers[0] == registers[1], "{case}: registers");
        assert_eq!(self.asked[0], self.asked[1], "{case}: channel");
    }
}

/// A few samples per call, of slots one after the other. Now and then between them: clocks without a strobe, a strobe
/// that comes too early, a slot that is abandoned, a table that is written.
#[test]
fn blocks_clocked_apart_are_the_core_clocked_as_a_whole() {
    let profiles =
        [short_profiles(), short_table_profiles(), overlapping_profiles(), other_devices()];
    for (seed, profile) in (70..).zip(profiles.into_iter().flatten()) {
        let (core, calibration) = (Core::new(&profile), calibration(&profile));
        let constants = core.idle_inputs(&calibration);
        let (channels, clocks) = (profile.channels(), profile.clocks_per_sample);
        let (apart, whole) = (core.reset(), core.reset());
        let mut pair = Pair { core: &core, apart, whole, channels, clocks, asked: [0; 2] };
        for (address, word) in (0..).zip(calibration.words(&profile)) {
            let word = profile.formats.table.code_saturating(word);
            pair.clock(constants.with_table(TablePort { write: 1, address, word }));
        }
        let mut random = Random::new(seed);
        for (slot, (_, codes)) in slots(&profile, operations(12) as usize, seed).enumerate() {
            let mut codes = &codes[..];
            while !codes.is_empty() {
                // Now and then all remaining ones, in which a whole program of the position is carried out.
                let some = 1 + random.below(40) as usize;
                let count = if random.below(4) == 0 { codes.len() } else { some };
                let (now, later) = codes.split_at(codes.len().min(count * channels));
                // Samples that come late, so that strobes meet each step of an estimate.
                if random.below(2) == 0 {
                    (0..random.below(2 * clocks)).for_each(|_| pair.clock(constants));
                }
                pair.samples(constants, now, &case(&profile, slot));
                codes = later;
                // Most slots pass undisturbed: else no window would ever end.
                if slot % 4 == 3 {
                    disturb(&mut pair, constants, now, &mut random, &case(&profile, slot));
                }
            }
        }
    }
}

/// Four terminals, one pad, and clocks between samples that the demodulator does not fill.
fn other_devices() -> Vec<Profile> {
    let other = |mut profile: Profile| {
        let Terminals { x, y } = &mut profile.terminals;
        x.truncate(4);
        y.truncate(4);
        profile.pads = 1;
        profile.clocks_per_sample += 13;
        profile
    };
    short_profiles().into_iter().map(other).collect()
}

fn case(profile: &Profile, slot: usize) -> String {
    format!("{}, {} pads, slot {slot}", profile.name, profile.pads)
}

fn disturb(
    pair: &mut Pair<'_>,
    constants: Inputs<i64>,
    codes: &[i32],
    random: &mut Random,
    case: &str,
) {
    let one = &codes[..pair.channels];
    let write = TablePort { write: 1, address: 0, word: 1 };
    match random.below(16) {
        0 => (0..random.below(30)).for_each(|_| pair.clock(constants)),
        1 => {
            // The next sample's strobe comes too early, now and then when all blocks but the pace are idle again.
            pair.clock(Inputs { strobe: 1, ..constants });
            (0..random.below(pair.clocks)).for_each(|_| pair.clock(constants));
        }
        2 => pair.clock(Inputs { clear: 1, ..constants }),
        3 => pair.samples(Inputs { clear: 1, ..constants }, one, case),
        4 => pair.samples(constants.with_table(write), one, case),
        _ => {}
    }
}
