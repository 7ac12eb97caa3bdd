// SPDX-License-Identifier: MIT OR Apache-2.0
//! The same four slots again and again, slot by slot (`fixed`) or every clock (`clock`): every frame is that of the first
//! round, to the bit.
//!
//! `cargo run --release -p hapticore-tests --example long_run -- [SAMPLES [PROFILE [fixed|clock]]]`, by default 10⁹ samples
//! of `standard` in `fixed`

use std::process::ExitCode;
use std::time::Instant;

use hapticore_contract::profile::Profile;
use hapticore_tests::stability::bench::Bench;
use hapticore_tests::stability::long_runs::{repeat, repeat_every_clock};

fn main() -> ExitCode {
    match run(&std::env::args().skip(1).collect::<Vec<_>>()) {
        Ok(line) => println!("{line}"),
        Err(message) => {
            eprintln!("{message}");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

/// What was run, and how long it took; panics where a frame is another.
fn run(arguments: &[String]) -> Result<String, String> {
    let argument = |index: usize, default| arguments.get(index).map_or(default, String::as_str);
    let (samples, fidelity) = (argument(0, "1000000000"), argument(2, "fixed"));
    let samples =
        samples.parse().map_err(|_| format!("expected a number of samples, got {samples}"))?;
    let repeat = match fidelity {
        "fixed" => repeat,
        "clock" => repeat_every_clock,
        other => return Err(format!("expected fixed or clock, got {other}")),
    };
    let bench = Bench::with(Profile::bundled(argument(1, "standard")).map_err(|e| e.to_string())?);
    let start = Instant::now();
    let slots = repeat(&bench, samples);
    Ok(format!(
        "{}, {fidelity}: {samples} samples, {slots} frames equal to those of the first round, {:.1} s",
        bench.profile.name,
        start.elapsed().as_secs_f64()
    ))
}
