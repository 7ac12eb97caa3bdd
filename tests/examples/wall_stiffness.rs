// SPDX-License-Identifier: MIT OR Apache-2.0
//! How stiff walls are, and from which stiffness on they come and go in bursts, as tables in
//! Markdown.
//!
//! `cargo run --release -p hapticore-tests --example wall_stiffness [HANDS]`: 12 hands.

use hapticore_tests::walls::trial::{Kind, Setup};

/// Stiffnesses of walls, N/mm.
const WALLS: [f64; 4] = [0.5, 1.0, 2.0, 8.0];
/// Stiffnesses that are tried for bursts, N/mm.
const STIFFER: [f64; 7] = [0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0];

fn main() {
    let hands = std::env::args().nth(1).map_or(12, |text| text.parse().expect("a number"));
    println!(
        "| rule, up to | k_w, N/mm | stiffness, N/mm (least) | least peak, N | bursts of {hands} hands |"
    );
    println!("| --- | --- | --- | --- | --- |");
    for (kind, to_n) in [(Kind::A, 0.7), (Kind::B, 1.0)] {
        for n_per_mm in WALLS {
            let setup = setup(kind, n_per_mm, 1.0);
            let stiffness = setup.stiffness(0..hands, to_n);
            println!(
                "| {kind:?}, {to_n} N | {n_per_mm} | {:.2} ({:.2}) | {:.2} | {} |",
                stiffness.n_per_mm,
                stiffness.least_n_per_mm,
                stiffness.least_peak_n,
                setup.hands(0..hands).bursts
            );
        }
    }
    println!(
        "\n| pads, slot | A: frame, ms; k_w without bursts, N/mm | B: likewise |\n| --- | --- | --- |"
    );
    for pads in [1.0, 4.0] {
        for slot_ms in [0.25, 0.5, 1.7] {
            let of = |kind, parts: f64| {
                let frame_ms = pads * parts * slot_ms;
                format!("{frame_ms}; {}", without_bursts(kind, frame_ms, hands))
            };
            println!("| {pads}, {slot_ms} ms | {} | {} |", of(Kind::A, 3.0), of(Kind::B, 2.0));
        }
    }
}

/// 1 % noise.
fn setup(kind: Kind, n_per_mm: f64, frame_ms: f64) -> Setup {
    Setup { kind, n_per_mm, mismatch_percent: 2.0, noise_percent: 1.0, frame_ms }
}

/// The stiffest wall without a burst, as none softer has one, and the bursts of each.
fn without_bursts(kind: Kind, frame_ms: f64, hands: u64) -> String {
    let bursts = STIFFER.map(|n_per_mm| setup(kind, n_per_mm, frame_ms).hands(0..hands).bursts);
    let free = bursts.iter().take_while(|bursts| **bursts == 0.0).count();
    let stiffest = free.checked_sub(1).map_or("none".into(), |n| STIFFER[n].to_string());
    let bursts = bursts.map(|bursts| bursts.to_string()).join(", ");
    format!("{stiffest} ({bursts})")
}
