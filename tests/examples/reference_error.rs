// SPDX-License-Identifier: MIT OR Apache-2.0
//! The reference's own error on every bundled scene, as a table in Markdown.
//!
//! `cargo run --release -p hapticore-tests --example reference_error [SLOTS]`: about SLOTS slots of
//! each scene (default 48), evenly spread over its cases.

use hapticore_scene::gallery;
use hapticore_tests::reference_error::{HEAD, Measured, measure, table};
use rayon::prelude::*;

fn main() {
    let slots =
        std::env::args().nth(1).map_or(48, |slots| slots.parse().expect("a number of slots"));
    let of = |&(name, _): &(&'static str, &str)| (name, measure(name, slots));
    let measured: Vec<(&str, Measured)> = gallery::all().par_iter().map(of).collect();
    print!("{HEAD}");
    measured.iter().for_each(|(name, measured)| print!("{}", table(name, measured)));
    let [slots, left_out] = [|m: &Measured| m.slots, |m: &Measured| m.left_out]
        .map(|of| measured.iter().map(|(_, measured)| of(measured)).sum::<usize>());
    println!("\n{slots} slots; {left_out} without a valid place or capacitance are left out.");
}
