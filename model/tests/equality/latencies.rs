// SPDX-License-Identifier: MIT OR Apache-2.0
//! `latency()` is what the clocks say: from `start` (or the event that the block's doc names) to `done`.

use crate::harness::{Bench, cases};
use hapticore_model::block::{Block, Inputs};
use hapticore_model::blocks::capacitance::Capacitance;
use hapticore_model::blocks::core::{self, Core};
use hapticore_model::blocks::currents::{self, Currents};
use hapticore_model::blocks::demodulator::{self, Demodulator};
use hapticore_model::blocks::divider::Divider;
use hapticore_model::blocks::estimator::{self, Estimator};
use hapticore_model::blocks::force::Force;
use hapticore_model::blocks::frames::Frames;
use hapticore_model::blocks::oscillator::{self, Oscillator};
use hapticore_model::blocks::position::TablePort;
use hapticore_model::blocks::position::{self, Position};
use hapticore_model::blocks::ratio::Ratio;
use hapticore_model::blocks::root::Root;
use hapticore_model::bundle::Bundle;
use hapticore_model::format::Format;
use hapticore_model::profile::Profile;

/// Clocks that a block is given in all, about.
const CLOCKS: u64 = 2_000_000;

/// Holds that a block which starts and finishes takes as many clocks as it says, whatever its operands.
fn check_latency<B: Block>(block: B, latency: u64) {
    check_latency_of(block, latency, |inputs| inputs);
}

fn check_latency_of<B: Block>(block: B, latency: u64, legal: impl Fn(Inputs<B, i64>) -> Inputs<B, i64>) {
    let (mut bench, operations) = (Bench::new(block), (CLOCKS / latency).clamp(100, 4000));
    for inputs in cases(&bench.block, operations, 1).map(legal) {
        let (_, clocks) = bench.operate(inputs);
        assert_eq!(clocks, latency, "{}: clocks measured, latency()", B::NAME);
    }
}

#[test]
fn divider() {
    let [n, d] = [Format::unsigned(9, 4), Format::unsigned(7, 3)];
    for width in [3, 8, 20] {
        let block = Divider::new(n, d, Format::unsigned(width, 5));
        check_latency(block.clone(), block.latency());
    }
}

#[test]
fn root() {
    for width in [7, 8, 20] {
        let block = Root::new(Format::unsigned(width, 4), 5);
        check_latency(block.clone(), block.latency());
    }
}

#[test]
fn ratio() {
    for profile in Profile::all() {
        let currents = Currents::new(&profile);
        let block = Ratio::new(&profile, currents.sums(), currents.least());
        check_latency_of(block.clone(), block.latency(), |i| {
            let bound = |x: i64| if i.corners == 0 { 0 } else { x % (i.corners + 1) };
            hapticore_model::blocks::ratio::Inputs { x: bound(i.x), y: bound(i.y), least: bound(i.least), ..i }
        });
    }
}

#[test]
fn position() {
    for profile in Profile::all() {
        let block = Position::new(&profile);
        check_latency_of(block.clone(), block.latency(), |i: position::Inputs<i64>| position::Inputs {
            table: TablePort { write: 0, ..i.table },
            ..i
        });
    }
}

#[test]
fn capacitance() {
    for mut profile in Profile::all() {
        for sheet_correction in [true, false] {
            profile.capacitance.sheet_correction = sheet_correction;
            let block = Capacitance::new(&profile, Currents::new(&profile).amplitude());
            check_latency(block.clone(), block.latency());
        }
    }
}

#[test]
fn force() {
    for profile in Profile::all() {
        let block = Force::new(&profile);
        check_latency(block.clone(), block.latency());
    }
}

#[test]
fn frames() {
    for profile in Profile::all() {
        let block = Frames::new(&profile);
        check_latency(block.clone(), block.latency());
    }
}

#[test]
fn oscillator() {
    for profile in Profile::all() {
        let mut bench = Bench::new(Oscillator::new(&profile));
        bench.clock(oscillator::Inputs { sample: 1, restart: 1, first: 1 });
        let quiet = oscillator::Inputs { sample: 0, restart: 0, first: 0 };
        let measured = (1..100).find(|_| bench.clock(quiet).ready == 1);
        assert_eq!(measured, Some(bench.block.latency()), "clocks from sample to ready");
    }
}

#[test]
fn demodulator() {
    for profile in Profile::all() {
        let mut bench = Bench::new(Demodulator::new(&profile));
        let quiet = demodulator::Inputs::map(bench.block.inputs(), |_| 0);
        bench.clock(demodulator::Inputs { start: 1, first: 1, last: 1, ..quiet });
        let last = (1..2000).filter(|_| bench.clock(quiet).valid == 1).last();
        assert_eq!(last, Some(bench.block.latency()), "clocks from start to the last sum");
    }
}

#[test]
fn currents() {
    for profile in Profile::all() {
        let mut bench = Bench::new(Currents::new(&profile));
        for index in 0..=2 * profile.demodulated() as i64 {
            bench.clock(currents::Inputs { valid: 1, index, sum: 1000 * index });
        }
        let quiet = currents::Inputs { valid: 0, index: 0, sum: 0 };
        let measured = (1..10_000).find(|_| bench.clock(quiet).done == 1);
        assert_eq!(measured, Some(bench.block.latency()), "clocks from the last sum (the mean square's) to done");
    }
}

#[test]
fn estimator() {
    for profile in Profile::all() {
        let mut bench = Bench::new(Estimator::new(&profile));
        let quiet = estimator::Inputs::map(bench.block.inputs(), |_| 0);
        let sums = 2 * profile.demodulated() as i64;
        for index in 0..=sums {
            bench.clock(estimator::Inputs { valid: 1, index, sum: 1 << 20, ..quiet });
        }
        let measured = (1..10_000).find(|_| bench.clock(quiet).frames.done == 1);
        assert_eq!(measured, Some(bench.block.latency()), "clocks from the last sum to the last word");
    }
}

#[test]
fn core() {
    for profile in crate::device::short_profiles() {
        let mut bench = Bench::new(Core::new(&profile));
        let quiet = core::Inputs::map(bench.block.inputs(), |_| 0);
        let clocks = profile.clocks_per_sample;
        for clock in 0..(profile.slot.samples() - 1) * clocks {
            bench.clock(core::Inputs { strobe: (clock % clocks == 0).into(), code: 100, ..quiet });
        }
        bench.clock(core::Inputs { strobe: 1, ..quiet });
        let measured = (1..10_000).find(|_| bench.clock(quiet).frames.done == 1);
        let latency = bench.block.latency();
        assert_eq!(measured, Some(latency), "{}: clocks from the last strobe to the last word", profile.name);
    }
}
