// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the force loop reaches of its targets: true force, frames of 1 ms, gains as in docs/physics.md
//! §6 (`cargo run --release -p hapticore-tests --example tracking` prints all of it).

use hapticore_tests::tracking::{
    FOUR_SHORT, Followed, LAWS, SHORT, TARGETS, follow, follow_in, overshoot_n, rise_s,
    rms_after_edges_n, rms_n,
};
use rayon::prelude::*;

// Laws, as `LAWS` numbers them.
const OPEN: usize = 0;
const RAW: usize = 1;
const FILTERED: usize = 2;
const INTEGRAL_TABLE: usize = 4;
const INVERSE: usize = 5;
const TABLE: usize = 6;

const LOADS_G: [f64; 3] = [30.0, 50.0, 80.0];

fn slots(law: usize, target: usize, load_g: f64) -> Vec<Followed> {
    follow(&LAWS[law], TARGETS[target], load_g)
}

/// The closed loop's error over the open loop's, both in the whole run: of the law that follows edges
/// fastest.
#[test]
#[cfg_attr(not(optimised), ignore = "whole scenes: run with --release")]
fn the_closed_loop_is_a_small_part_of_the_open_loop_off_its_target() {
    LOADS_G.par_iter().for_each(|&load_g| {
        for (target, most) in [(0, 0.35), (1, 0.15), (2, 0.15), (3, 0.1)] {
            let laws = [INTEGRAL_TABLE, OPEN];
            let [closed, open] = laws.map(|law| rms_n(&slots(law, target, load_g)));
            let name = TARGETS[target];
            println!("{name}, {load_g} g: {:.1} of {:.1} mN", 1e3 * closed, 1e3 * open);
            assert!(closed <= most * open, "{name}, {load_g} g: {closed} of {open} N");
        }
    });
}

/// With the force table what is left is a few millinewtons.
#[test]
#[cfg_attr(not(optimised), ignore = "whole scenes: run with --release")]
fn the_force_table_follows_to_a_few_millinewtons() {
    [50.0, 80.0].par_iter().for_each(|&load_g| {
        // The fastest rise, through the pull-in, is left with 3.3 mN at 50 g.
        for (target, most_n) in [(0, 3e-3), (1, 3e-3), (2, 3e-3), (3, 3.5e-3)] {
            let off_n = rms_after_edges_n(&slots(TABLE, target, load_g));
            println!("{}, {load_g} g: {:.2} mN", TARGETS[target], 1e3 * off_n);
            assert!(off_n <= most_n, "{}, {load_g} g: {off_n} N", TARGETS[target]);
        }
        let by_eq8 = rms_after_edges_n(&slots(INVERSE, 0, load_g));
        assert!(by_eq8 > 4e-3, "eq. 8 leaves more: {by_eq8} N");
    });
}

#[test]
#[cfg_attr(not(optimised), ignore = "whole scenes: run with --release")]
fn an_edge_overshoots_little_and_rises_within_ten_milliseconds() {
    LOADS_G.par_iter().for_each(|&load_g| {
        for law in [INVERSE, TABLE] {
            for (target, most_n) in [(0, 0.0205), (1, 0.05)] {
                let slots = slots(law, target, load_g);
                let (over_n, rise_s) = (overshoot_n(&slots), rise_s(&slots));
                let name = format!("{}, {}, {load_g} g", LAWS[law].name, TARGETS[target]);
                println!("{name}: {:.1} mN, {:.0} ms", 1e3 * over_n, 1e3 * rise_s);
                assert!(over_n <= most_n && rise_s <= 0.010, "{name}: {over_n} N, {rise_s} s");
            }
        }
    });
}

/// Four pads in the same frame of 1 ms, and one alone, with slots of 250 µs: each law that meets the
/// bars of an edge still does, although an estimate is not finished before the next window begins.
#[test]
#[cfg_attr(not(optimised), ignore = "whole scenes: run with --release")]
fn an_edge_in_slots_of_250_us_overshoots_as_little() {
    [FOUR_SHORT, SHORT].par_iter().for_each(|division| {
        for law in [INVERSE, TABLE] {
            for (target, most_n) in [(0, 0.02), (1, 0.05)] {
                let slots = follow_in(division, &LAWS[law], TARGETS[target], 50.0);
                let (over_n, rise_s) = (overshoot_n(&slots), rise_s(&slots));
                let name = format!("{}, {}, {}", division.name, LAWS[law].name, TARGETS[target]);
                println!("{name}: {:.1} mN, {:.2} ms", 1e3 * over_n, 1e3 * rise_s);
                // Slots lie so many microseconds apart: what is said is to half of one.
                assert!(over_n <= most_n && rise_s <= 0.0101, "{name}: {over_n} N, {rise_s} s");
            }
        }
    });
}

/// The paper's gain without a filter is in a limit cycle; with it, it is not.
#[test]
#[cfg_attr(not(optimised), ignore = "whole scenes: run with --release")]
fn a_large_gain_without_a_filter_is_in_a_limit_cycle() {
    let [raw, filtered] = [RAW, FILTERED].map(|law| rms_after_edges_n(&slots(law, 1, 50.0)));
    assert!(raw > 0.15, "{raw} N");
    assert!(filtered < 0.05, "{filtered} N");
}
