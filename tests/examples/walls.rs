// SPDX-License-Identifier: MIT OR Apache-2.0
//! Hands at a wall under every rule, as a table in Markdown.
//!
//! `cargo run --release -p hapticore-tests --example walls [HANDS] [N_PER_MM] [FRAME_MS] [RULE]`: 100
//! hands, 0.5 N/mm, 1 ms, all rules.

use hapticore_tests::walls::device::Drive;
use hapticore_tests::walls::hand::Hand;
use hapticore_tests::walls::measures::{Measures, Row};
use hapticore_tests::walls::trial::{Kind, Setup};
use rayon::prelude::*;

fn main() {
    let number = |n: usize, usual: f64| {
        std::env::args().nth(n).map_or(usual, |text| text.parse().expect("a number"))
    };
    let (hands, n_per_mm, frame_ms) = (number(1, 100.0) as u64, number(2, 0.5), number(3, 1.0));
    println!(
        "| rule, noise, mismatch | mean sticking, N (worst) | slow peak, N | release, ms; p95 | excess flips | vanished, ms | peak, N |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    let rule = std::env::args().nth(4);
    let asked = |kind: &Kind| rule.as_ref().is_none_or(|rule| *rule == format!("{kind:?}"));
    for kind in Kind::ALL.into_iter().filter(asked) {
        let drive = Drive::calibrated(kind.pad());
        for noise_percent in [0.4, 1.0] {
            let trial = |seed: u64| {
                let mismatch_percent = if seed.is_multiple_of(2) { 2.0 } else { -2.0 };
                let setup = Setup { kind, n_per_mm, mismatch_percent, noise_percent, frame_ms };
                let hand = Hand::draw(seed, n_per_mm);
                Measures::of(&setup.run(&hand, &drive, 1000 + seed), frame_ms)
            };
            let trials: Vec<Measures> = (0..hands).into_par_iter().map(trial).collect();
            println!("| {kind:?}, {noise_percent} % | {} |", Row::of(&trials).text());
        }
    }
}
