// SPDX-License-Identifier: MIT OR Apache-2.0
//! The same four slots again and again through fidelity `fixed`: every frame is that of the first
//! round, to the bit.
//!
//! `cargo run --release -p hapticore-tests --example long_run -- 1000000000 [PROFILE]`

use std::process::ExitCode;
use std::time::Instant;

use hapticore_tests::stability::bench::Bench;
use hapticore_tests::stability::long_runs::repeat;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let samples = arguments.next().unwrap_or("1000000000".into());
    let Ok(samples) = samples.parse() else {
        eprintln!("expected a number of samples, got {samples}");
        return ExitCode::FAILURE;
    };
    let bench = Bench::of(&arguments.next().unwrap_or("standard".into()));
    let start = Instant::now();
    let slots = repeat(&bench, samples);
    println!(
        "{}: {samples} samples, {slots} frames equal to those of the first round, {:.1} s",
        bench.profile.name,
        start.elapsed().as_secs_f64()
    );
    ExitCode::SUCCESS
}
