// SPDX-License-Identifier: MIT OR Apache-2.0
//! Lock-step of Verilog that somebody else has written, or changed: the model's traces against any
//! files with the core's ports.

use super::verilator::{Start, Verilated};
use super::{Bench, Mismatch, icarus};
use crate::stimulus::{self, Stimulus};

/// What runs the Verilog.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Simulator {
    /// Millions of clocks in seconds.
    Verilator,
    /// A few slots, with unknown values: a register that is used before it is written shows.
    Icarus,
}

/// What the core is given, by name: a scene, random codes and calibrations, tones that fill every
/// word.
fn stimuli(bench: &Bench, simulator: Simulator) -> Vec<(&'static str, Stimulus)> {
    let profile = &bench.profile;
    let hockey = |slots| ("the scene hockey", stimulus::scene(profile, "hockey", slots));
    let random = |seed, slots| ("random codes", stimulus::random(profile, seed, slots));
    let tones = |seed, slots| ("tones", stimulus::tones(profile, seed, slots));
    match simulator {
        Simulator::Verilator => vec![hockey(16), random(1, 8), tones(1, 8), tones(2, 8)],
        Simulator::Icarus => vec![hockey(2), random(1, 1), tones(1, 2)],
    }
}

/// Runs Verilog with the ports of a profile's core, as text, on the model's traces: how many clocks
/// were equal.
///
/// # Errors
/// The first output that differs, and what the core was given.
///
/// # Panics
/// Where a tool fails, as with Verilog that it does not take.
pub fn check(
    bench: &Bench,
    verilog: &str,
    simulator: Simulator,
) -> Result<usize, (&'static str, Mismatch)> {
    let (top, ports) = (bench.design.top(), &bench.design.ports);
    let verilated = (simulator == Simulator::Verilator)
        .then(|| Verilated::new(top, ports, verilog, Start::Zero));
    let mut clocks = 0;
    for (name, stimulus) in stimuli(bench, simulator) {
        let trace = bench.record(stimulus);
        let result = match &verilated {
            Some(verilated) => verilated.check(&trace),
            None => icarus::check(top, verilog, &trace),
        };
        result.map_err(|mismatch| (name, mismatch))?;
        clocks += trace.clocks();
    }
    Ok(clocks)
}
