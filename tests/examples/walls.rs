// SPDX-License-Identifier: MIT OR Apache-2.0
//! Hands at a wall under every rule, as a table in Markdown; then at walls in a core.
//!
//! `cargo run --release -p hapticore-tests --example walls [HANDS] [N_PER_MM] [FRAME_MS] [RULE]`: 100
//! hands, 0.5 N/mm, 1 ms, all rules; `Core` for the walls in cores alone.

use hapticore_tests::walls::core::InCore;
use hapticore_tests::walls::device::Pad;
use hapticore_tests::walls::trial::{Kind, Setup};

fn main() {
    let number = |n: usize, usual: f64| {
        std::env::args().nth(n).map_or(usual, |text| text.parse().expect("a number"))
    };
    let (hands, n_per_mm, frame_ms) = (number(1, 100.0) as u64, number(2, 0.5), number(3, 1.0));
    println!(
        "| rule, noise, mismatch | mean sticking, N (worst) | slow peak, N | release, ms; p95 | excess flips | vanished, ms | peak, N | bursts |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    let rule = std::env::args().nth(4);
    let asked = |kind: &Kind| rule.as_ref().is_none_or(|rule| *rule == format!("{kind:?}"));
    for kind in Kind::ALL.into_iter().filter(asked) {
        for noise_percent in [0.4, 1.0] {
            let setup = Setup { kind, n_per_mm, mismatch_percent: 2.0, noise_percent, frame_ms };
            println!("| {kind:?}, {noise_percent} % | {} |", setup.hands(0..hands).text());
        }
    }
    if rule.is_none_or(|rule| rule == "Core") {
        in_cores(hands, n_per_mm);
    }
}

/// The slots of profile `fast`: frames of 0.75 ms for strips, of 0.5 ms for halves.
fn in_cores(hands: u64, n_per_mm: f64) {
    for pad in [Pad::Strips, Pad::Halves] {
        for (play_mm, noise_ppm) in [(0.2, 18.0), (0.4, 60.0)] {
            let core = InCore { pad, profile: "fast", n_per_mm, play_mm, noise_ppm };
            println!(
                "| core, {pad:?}, play {play_mm} mm, {noise_ppm} ppm | {} |",
                core.hands(0..hands, 2.0).text()
            );
        }
    }
}
