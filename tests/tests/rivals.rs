// SPDX-License-Identifier: MIT OR Apache-2.0
//! This project's laws beside those of other projects, on the same plant: none of the others follows
//! better, and the known faults of each show (`cargo run --release -p hapticore-tests --example rivals`
//! prints the table of docs/physics.md §6).

use hapticore_tests::rivals::laws::{Gains, Law, Linien, Seen};
use hapticore_tests::rivals::table::{KINDS, Row};
use hapticore_tests::rivals::trial::Kind;
use rayon::prelude::*;

#[test]
#[cfg_attr(not(optimised), ignore = "many loops: run with --release")]
fn no_other_law_follows_better_than_the_best_of_ours() {
    let rows: Vec<Row> = KINDS.par_iter().map(|&kind| Row::of(kind)).collect();
    rows.iter().for_each(|row| println!("{}", row.text()));
    let (ours, others): (Vec<_>, Vec<_>) =
        rows.into_iter().partition(|row| matches!(row.kind, Kind::Ours(..)));
    for other in &others {
        for target in 0..4 {
            let best = ours.iter().map(|row| row.rms_n[target]).fold(f64::INFINITY, f64::min);
            assert!(best <= other.rms_n[target], "target {target}: {best}, {other:?}");
        }
    }
    let recovery_s = |kind: fn(&Kind) -> bool| {
        let row = ours.iter().chain(&others).find(|row| kind(&row.kind)).expect("a row");
        row.recovery_s.expect("it comes back")
    };
    let [integral, pyrpl] = [
        recovery_s(|kind| matches!(kind, Kind::Ours("integral", _))),
        recovery_s(|kind| matches!(kind, Kind::PyRpl(_))),
    ];
    assert!(integral <= 0.005, "nothing winds up: {integral} s");
    assert!(pyrpl > 5.0 * integral, "what winds up takes its time: {pyrpl} s");
}

/// A proportional part that is cut to its word changes its sign where the error is large.
#[test]
fn a_proportional_part_that_wraps_drives_the_wrong_way() {
    let volts = |target_n: f64| {
        let gains = Gains { proportional: 900.0, integral: 0.0 };
        let seen = Seen { target_n, force_n: 0.0, capacitance_pf: 300.0 };
        Linien::new(gains).volts(&seen)
    };
    assert!(volts(0.5) > 400.0 && volts(0.6) < 0.0, "{} {}", volts(0.5), volts(0.6));
}
