// SPDX-License-Identifier: MIT OR Apache-2.0
//! Places: those of the rounded Newton steps; the clocks they take.

use super::{Inputs, Position, TablePort};
use crate::support::device::calibration;
use crate::support::random::Random;
use crate::support::{Bench, MILLION, cases, check, check_latency_of};
use hapticore_contract::profile::Profile;
use hapticore_reference::rounded::{self, Exact};

/// Half of the tables are a device's, and half are any words, of which few have a place for any
/// ratios.
#[test]
fn places_are_those_of_the_rounded_newton_steps() {
    let with = |calibrated| Profile::all().into_iter().map(move |profile| (calibrated, profile));
    for (seed, (calibrated, profile)) in (0..).zip([true, false].into_iter().flat_map(with)) {
        let f = &profile.formats;
        let block = Position::new(&profile);
        let (mut random, share) = (Random::new(seed), block.inputs().share);
        let any = (0..block.table().words).map(|_| random.word(f.table)).collect();
        let of_device = calibration(&profile)
            .position
            .words
            .into_iter()
            .map(|word| f.table.code_saturating(word));
        let words: Vec<i64> = if calibrated { of_device.collect() } else { any };
        let mut bench = Bench::new(block);
        for (address, &word) in words.iter().enumerate() {
            bench.clock(Inputs {
                table: TablePort { write: 1, address: address as i64, word },
                ..no_place()
            });
        }
        let words: Vec<Exact> = words.into_iter().map(|word| Exact::of(word, f.table)).collect();
        let quiet = |i: Inputs<i64>| Inputs { table: TablePort { write: 0, ..i.table }, ..i };
        let cases = cases(&bench.block, MILLION / 1000, seed).map(quiet);
        let reference = rounded::Position::new(&profile, &words);
        check(&mut bench, cases, |i| {
            let place = reference.place([i.r_x, i.r_y].map(|code| Exact::of(code, f.ratio)));
            let [x, y] = [place.x, place.y].map(|mm| mm.code(f.position));
            let sheet = place.sheet.code(profile.sheet());
            let (invalid, saturated) = (place.invalid.into(), place.saturated.into());
            let lost = reference.any_open(Exact::of(i.share, share)).into();
            [
                ("x", x),
                ("y", y),
                ("sheet", sheet),
                ("invalid", invalid),
                ("lost", lost),
                ("saturated", saturated),
            ]
        });
    }
}

fn no_place() -> Inputs<i64> {
    Inputs::of(0)
}

#[test]
fn latency_is_the_clocks_measured() {
    for profile in Profile::all() {
        let block = Position::new(&profile);
        check_latency_of(block.clone(), block.latency(), |i: Inputs<i64>| Inputs {
            table: TablePort { write: 0, ..i.table },
            ..i
        });
    }
}
