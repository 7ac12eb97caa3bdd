// SPDX-License-Identifier: MIT OR Apache-2.0
//! Blocks that start and finish: their results are the exact values, rounded so.

use crate::device::calibration;
use crate::harness::{Bench, cases, check};
use crate::random::Random;
use hapticore_model::blocks::capacitance::{self, Capacitance};
use hapticore_model::blocks::currents::Currents;
use hapticore_model::blocks::divider::Divider;
use hapticore_model::blocks::force::Force;
use hapticore_model::blocks::position::TablePort;
use hapticore_model::blocks::position::{self, Position};
use hapticore_model::blocks::ratio::{self, Ratio};
use hapticore_model::blocks::root::Root;
use hapticore_model::format::Format;
use hapticore_model::profile::Profile;
use hapticore_reference::rounded::{self, Exact, round_quotient, round_root};

/// Operations of each block over all profiles.
const MILLION: u64 = 1_000_000;

fn format(text: &str) -> Format {
    text.parse().expect("a format")
}

#[test]
fn quotients_are_the_nearest_codes() {
    let formats = [
        ("u29.23", "u28.23", "u21.20"),
        ("u27.23", "u28.23", "u24.22"),
        ("u30.26", "u31.26", "u28.26"),
        ("u12.4", "u9.7", "u7.3"),
    ];
    for (seed, (numerator, denominator, quotient)) in (0..).zip(formats) {
        let [n, d, q] = [numerator, denominator, quotient].map(format);
        let mut bench = Bench::new(Divider::new(n, d, q));
        let cases = cases(&bench.block, MILLION / 4, seed);
        check(&mut bench, cases, |i| {
            let quotient = round_quotient(Exact::of(i.numerator, n), Exact::of(i.denominator, d), q);
            [("quotient", quotient.value.code(q)), ("saturated", quotient.held.into())]
        });
    }
}

#[test]
fn roots_are_the_nearest_codes() {
    for (seed, (radicand, frac)) in (0..).zip([("u52.46", 23), ("u60.52", 26), ("u11.4", 5), ("u13.-2", 3)]) {
        let radicand = format(radicand);
        let mut bench = Bench::new(Root::new(radicand, frac));
        let (cases, root) = (cases(&bench.block, MILLION / 4, seed), bench.block.root());
        check(&mut bench, cases, |i| [("root", round_root(Exact::of(i.radicand, radicand), frac).code(root))]);
    }
}

#[test]
fn ratios_are_those_of_eqs_2_and_3() {
    for (seed, profile) in (0..).zip(Profile::all()) {
        let currents = Currents::new(&profile);
        let ((sums, corners), least) = (currents.sums(), currents.least());
        let ratio = profile.formats.ratio;
        let mut bench = Bench::new(Ratio::new(&profile, (sums, corners), least));
        // A numerator is at most its denominator: each term of the one is a term of the other.
        let bounded = |i: ratio::Inputs<i64>| {
            let bound = |x: i64| if i.corners == 0 { 0 } else { x % (i.corners + 1) };
            ratio::Inputs { x: bound(i.x), y: bound(i.y), least: bound(i.least), ..i }
        };
        let cases = cases(&bench.block, MILLION / 3, seed).map(bounded);
        check(&mut bench, cases, |i| {
            let of = |code| Exact::of(code, sums);
            let [total, sense] = [Exact::ZERO; 2];
            let corners = Exact::of(i.corners, corners);
            let (x, y, least) = (of(i.x), of(i.y), Exact::of(i.least, least));
            let currents = rounded::Currents { total, sense, x, y, corners, least, saturated: false };
            let expected = rounded::ratio(&profile, &currents);
            let [r_x, r_y, share] = [expected.r_x, expected.r_y, expected.share].map(|r| r.code(ratio));
            [("r_x", r_x), ("r_y", r_y), ("share", share), ("invalid", expected.invalid.into())]
        });
    }
}

/// Half of the tables are a device's, and half are any words, of which few have a place for any ratios.
#[test]
fn places_are_those_of_the_rounded_newton_steps() {
    for (seed, profile) in (0..).zip(Profile::all().into_iter().chain(Profile::all())) {
        let f = &profile.formats;
        let block = Position::new(&profile);
        let (mut random, share) = (Random::new(seed), block.inputs().share);
        let any = (0..block.table().words).map(|_| random.word(f.table)).collect();
        let of_device = calibration(&profile).position.words.into_iter().map(|word| f.table.code_saturating(word));
        let words: Vec<i64> = if seed < 3 { of_device.collect() } else { any };
        let mut bench = Bench::new(block);
        for (address, &word) in words.iter().enumerate() {
            bench
                .clock(position::Inputs { table: TablePort { write: 1, address: address as i64, word }, ..no_place() });
        }
        let words: Vec<Exact> = words.into_iter().map(|word| Exact::of(word, f.table)).collect();
        let quiet = |i: position::Inputs<i64>| position::Inputs { table: TablePort { write: 0, ..i.table }, ..i };
        let cases = cases(&bench.block, MILLION / 1000, seed).map(quiet);
        let reference = rounded::Position::new(&profile, &words);
        check(&mut bench, cases, |i| {
            let place = reference.place([i.r_x, i.r_y].map(|code| Exact::of(code, f.ratio)));
            let [x, y] = [place.x, place.y].map(|mm| mm.code(f.position));
            let sheet = place.sheet.code(profile.sheet());
            let (invalid, saturated) = (place.invalid.into(), place.saturated.into());
            let lost = reference.any_open(Exact::of(i.share, share)).into();
            [("x", x), ("y", y), ("sheet", sheet), ("invalid", invalid), ("lost", lost), ("saturated", saturated)]
        });
    }
}

fn no_place() -> position::Inputs<i64> {
    position::Inputs::of(0)
}

#[test]
fn capacitances_have_the_sheet_taken_out() {
    for (seed, mut profile) in (0..).zip(Profile::all().into_iter().chain(Profile::all())) {
        profile.capacitance.sheet_correction = seed < 3;
        let amplitude = Currents::new(&profile).amplitude();
        let f = &profile.formats;
        let mut bench = Bench::new(Capacitance::new(&profile, amplitude));
        // Every other current is below the voltage, as a real one is; else most would saturate.
        let plausible = |i: capacitance::Inputs<i64>| match i.total % 2 {
            0 => capacitance::Inputs { total: i.total / 4, sense: i.sense.max(i.total / 3), ..i },
            _ => i,
        };
        let cases = cases(&bench.block, MILLION / 6, seed).map(plausible);
        check(&mut bench, cases, |i| {
            let [total, sense] = [i.total, i.sense].map(|code| Exact::of(code, amplitude));
            let (sheet, gain) = (Exact::of(i.sheet, profile.sheet()), Exact::of(i.gain, f.capacitance_gain));
            let expected = rounded::capacitance(&profile, total, sense, sheet, gain);
            let code = expected.capacitance.code(f.capacitance);
            [("capacitance", code), ("invalid", expected.invalid.into()), ("saturated", expected.saturated.into())]
        });
    }
}

#[test]
fn forces_are_those_of_eq_8() {
    for (seed, profile) in (0..).zip(Profile::all()) {
        let f = &profile.formats;
        let mut bench = Bench::new(Force::new(&profile));
        let cases = cases(&bench.block, MILLION / 3, seed);
        check(&mut bench, cases, |i| {
            let capacitance = Exact::of(i.capacitance, f.capacitance);
            let (mean_square, gain) = (Exact::of(i.mean_square, f.mean_square), Exact::of(i.gain, f.force_gain));
            let expected = rounded::force(&profile, capacitance, mean_square, gain);
            [("haptic_force", expected.force.code(f.force)), ("saturated", expected.saturated.into())]
        });
    }
}
