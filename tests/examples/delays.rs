// SPDX-License-Identifier: MIT OR Apache-2.0
//! Stability of a force loop against slot and number of pads, as a table in Markdown: what is
//! predicted at 0.6 N, and the edges of `fig9` with half of the largest stable gain.
//!
//! `cargo run --release -p hapticore-tests --example delays`

use hapticore_tests::tracking::{
    Division, OWN, SHORT, TARGETS, follow_integral, overshoot_n, rise_s, stability,
};
use rayon::prelude::*;

/// K_p and K_i·T, V/√N, from which the largest are found.
const PROPORTIONAL_V: f64 = 25.0;
const INTEGRAL_V: f64 = 200.0;

fn main() {
    let slots = [
        (250, SHORT),
        (500, Division { samples: [186, 304], ..SHORT }),
        (1000, OWN),
        (1700, Division { samples: [690, 1000], ..OWN }),
    ];
    println!(
        "| slot, µs | pads | frame, ms | delay, ms | largest K_i, kV/(√N·s), K_p = K_i·T/8 | half of both: open loop is 1 at, Hz | phase margin | overshoot at 0.3 / 0.6 N, mN | to 90 %, ms |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let rows = slots.iter().flat_map(|slot| [1, 2, 4].map(|pads| (slot.0, slot.1, pads)));
    let rows: Vec<_> = rows.collect();
    let rows: Vec<String> = rows
        .par_iter()
        .map(|&(slot_us, division, pads)| row(slot_us, &Division { pads, ..division }))
        .collect();
    rows.iter().for_each(|row| println!("{row}"));
}

fn row(slot_us: u64, division: &Division) -> String {
    // Linear about the state that gains lead to with which the loop settles.
    let integral_v = INTEGRAL_V / (1e-6 * slot_us as f64 * division.pads as f64);
    let gains = [PROPORTIONAL_V, integral_v];
    let margin = stability(division, gains, 0.6).gain_margin.expect("a loop with a limit");
    let half = gains.map(|gain| gain * margin / 2.0);
    let of = stability(division, half, 0.6);
    let edges = [0, 1].map(|target| {
        let slots = follow_integral(division, half, TARGETS[target]);
        [overshoot_n(&slots), rise_s(&slots)].map(|number| 1e3 * number)
    });
    format!(
        "| {slot_us} | {} | {} | {:.2} | {:.0} | {:.0} | {:.0}° | {:.0} / {:.0} | {:.1} / {:.1} |",
        division.pads,
        1e3 * of.frame_s,
        1e3 * of.delay_s,
        1e-3 * margin * integral_v,
        of.crossover_hz.unwrap_or(f64::NAN),
        of.phase_margin_deg.unwrap_or(f64::NAN),
        edges[0][0],
        edges[1][0],
        edges[0][1],
        edges[1][1],
    )
}
