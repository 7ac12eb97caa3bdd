// SPDX-License-Identifier: MIT OR Apache-2.0
//! How each law of the force loop follows its target, as a table in Markdown.
//!
//! `cargo run --release -p hapticore-tests --example tracking [LOAD_G …]`: 50 g.

use hapticore_tests::tracking::{
    LAWS, TARGETS, follow, overshoot_n, rise_s, rms_after_edges_n, rms_n,
};

fn main() {
    let loads: Vec<f64> =
        std::env::args().skip(1).map(|text| text.parse().expect("a load in grams")).collect();
    for load_g in if loads.is_empty() { vec![50.0] } else { loads } {
        println!(
            "{load_g} g, mN: RMS; overshoot; RMS of what was asked for 50 ms after edges; to 90 %, ms\n"
        );
        println!("| law | {} |", TARGETS.join(" | "));
        println!("| --- | --- | --- | --- | --- |");
        for law in &LAWS {
            let cells = TARGETS.map(|target| {
                let slots = follow(law, target, load_g);
                let numbers =
                    [rms_n(&slots), overshoot_n(&slots), rms_after_edges_n(&slots), rise_s(&slots)];
                let [rms, over, after, rise] = numbers.map(|number| 1e3 * number);
                format!("{rms:.1}; {over:.1}; {after:.1}; {rise:.0}")
            });
            println!("| {} | {} |", law.name, cells.join(" | "));
        }
        println!();
    }
}
