// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clocks from the last sum to the last word, and sums that come before it.

use super::{Estimator, Inputs, TablePort};
use crate::support::Bench;
use crate::support::device::short_table_profiles;
use crate::support::never_skips::NeverSkips;
use hapticore_contract::calibration::{ForceTable, Layout};
use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::{ForceLaw, Profile};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::signal::{Signal, bit, code};

#[test]
fn latency_is_the_clocks_measured() {
    let with_control = |profile: Profile| {
        let control = Some(Control::of(&profile, Law::Inverse));
        Profile { control, ..profile }
    };
    let controlled = Profile::of_distinct_words().into_iter().map(with_control);
    for profile in Profile::all().into_iter().chain(controlled) {
        let mut bench = Bench::new(Estimator::try_new(&profile).unwrap());
        let quiet = Inputs::map(bench.block.inputs(), |_| 0);
        let sums = 2 * profile.demodulated() as i64;
        for index in 0..=sums {
            bench.clock(Inputs { valid: 1, index, sum: 1 << 20, ..quiet });
        }
        let measured = (1..10_000).find(|_| bench.clock(quiet).frames.done == 1);
        assert_eq!(
            measured,
            Some(bench.block.latency()),
            "clocks from the last sum to the last word"
        );
    }
}

/// Sums of all channels for a pad, one after the other, then `clocks` clocks: the pads of frames that are finished,
/// each with the words.
fn frames_of(
    bench: &mut Bench<Estimator>,
    profile: &Profile,
    pad: i64,
    clocks: u64,
) -> Vec<(i64, Vec<i64>)> {
    let quiet = Inputs::map(bench.block.inputs(), |_| 0);
    let sums = 1 + 2 * profile.demodulated() as i64;
    let (mut words, mut frames) = (Vec::new(), Vec::new());
    for clock in 0..sums + clocks as i64 {
        let inputs = match clock < sums {
            true => Inputs { valid: 1, index: clock, sum: (4 + pad) << 18, pad, ..quiet },
            false => quiet,
        };
        let port = bench.clock(inputs).frames;
        if port.valid == 1 {
            words.push(port.frame);
        }
        if port.done == 1 {
            frames.push((port.pad, std::mem::take(&mut words)));
        }
    }
    frames
}

#[test]
fn sums_that_come_before_the_last_frame_are_dropped_once() {
    for profile in Profile::all().into_iter().filter(|profile| profile.control.is_none()) {
        let new = || Bench::new(Estimator::try_new(&profile).unwrap());
        let (mut alone, mut early) = (new(), new());
        let latency = alone.block.latency();
        let expected = frames_of(&mut alone, &profile, 0, latency);
        assert_eq!(expected.len(), 1);
        // In each third of the estimate another pad's sums.
        for wait in [0, latency / 3, 2 * latency / 3] {
            assert_eq!(frames_of(&mut early, &profile, 0, wait), []);
            assert_eq!(
                frames_of(&mut early, &profile, 1, latency),
                expected,
                "after {wait} clocks"
            );
            // The next ones are taken.
            assert_eq!(frames_of(&mut early, &profile, 0, latency), expected);
        }
        frames_of(&mut early, &profile, 0, 0);
        frames_of(&mut early, &profile, 1, 0);
        // Early ones after early ones are taken.
        let taken = frames_of(&mut early, &profile, 1, latency);
        assert_eq!(taken.last().map(|(pad, _)| *pad), Some(1), "sums are dropped once");
    }
}

/// Pad and flag of the last window stay on the outputs while the estimator is idle.
#[test]
fn clocks_that_are_skipped_give_out_what_others_do() {
    for mut profile in Profile::of_distinct_words() {
        profile.control = Some(Control::of(&profile, Law::Inverse));
        let block = Estimator::try_new(&profile).unwrap();
        let (latency, sums) = (block.latency(), 2 * profile.demodulated() as i64);
        let quiet = Inputs::map(block.inputs(), |_| 0);
        let mut skips = Bench::new(block.clone());
        let mut never = Bench::<_, NeverSkips>::read(block);
        for pad in [1, 0, 1] {
            for clock in 0..=sums + latency as i64 + 20 {
                let window =
                    Inputs { valid: 1, index: clock, sum: 1 << 20, pad, clipped: pad, ..quiet };
                let inputs = if clock <= sums { window } else { quiet };
                let [given, expected] = [skips.clock(inputs), never.clock(inputs)];
                assert_eq!(given, expected, "clock {clock} of pad {pad}");
            }
            let left = skips.clock(quiet).frames;
            assert_eq!([left.pad, left.clipped], [pad; 2], "after the frame");
            assert_eq!(left, never.clock(quiet).frames);
        }
    }
}

/// The words of the position table come first; the port goes on to those of the force table.
#[test]
fn a_word_is_written_into_one_table() {
    for profile in short_table_profiles() {
        let block = Estimator::try_new(&profile).unwrap();
        let (words, port) = (block.position.table().words as i64, block.calibration().table);
        for address in [0, 1, words - 1, words, words + 1, words + 7] {
            let [position, force]: [TablePort<Signal<i64>>; 2] = block.table_ports(TablePort {
                write: bit(true),
                address: code(address, port.address),
                word: code(1, port.word),
            });
            let is_of_force = i64::from(address >= words);
            assert_eq!((position.write.value, force.write.value), (1 - is_of_force, is_of_force));
            let written = if is_of_force == 1 { force } else { position };
            assert_eq!(written.address.value, address - is_of_force * words);
            // The other port's is an address of its table, too.
            assert!(position.address.value < words, "{address}");
            assert_eq!(position.address.format, block.position.table().address());
        }
    }
}

/// Also where the words of the force table need one more bit of the address.
#[test]
fn the_table_port_reaches_every_word_of_both_tables() {
    let profile = Profile::bundled("standard").expect("bundled");
    let bits = |words: usize| (words - 1).ilog2() + 1;
    let sized = |k: u64| {
        let mut profile = profile.clone();
        profile.force.law = ForceLaw::Table;
        (profile.position.columns, profile.position.rows) = (10 + k % 20, 10 + k / 20);
        profile
    };
    let needs_more = |profile: &Profile| {
        let words = Layout::new(profile).words();
        bits(words) < bits(words + ForceTable::WORDS)
    };
    let needing = (0..400).map(sized).find(needs_more).expect("a table of nearly as many words");
    for profile in [sized(0), needing] {
        let words = Layout::new(&profile).words() + ForceTable::WORDS;
        let block = Estimator::try_new(&profile).unwrap();
        assert_eq!(block.table().words, words);
        assert_eq!(u32::from(block.calibration().table.address.width), bits(words));
    }
}
