// SPDX-License-Identifier: MIT OR Apache-2.0
//! Lock-step: a block's clocked model runs once and leaves a [`Trace`], every input and output at
//! every clock; then its Verilog runs on the same inputs in a simulator, which stops at the first
//! output that differs.
//!
//! | file | runs the Verilog in |
//! | --- | --- |
//! | [`verilator`] | Verilator: millions of clocks; the distribution's and a current one |
//! | [`cxxrtl`] | CXXRTL of Yosys, which stops at an address beyond a memory |
//! | [`icarus`] | Icarus Verilog: an event-driven simulator with unknown values, written by other people |
//! | [`external`] | either, where others have written the Verilog |

mod bench;
pub mod cxxrtl;
pub mod external;
pub mod icarus;
mod trace;
pub mod verilator;

pub use bench::Bench;
pub use trace::{Trace, bits};

use std::fmt;

/// The first output that differs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mismatch {
    /// At which clock after reset.
    pub clock: usize,
    /// Output that differs.
    pub signal: String,
    /// The model's code, as bits.
    pub model: String,
    /// The Verilog's, as bits.
    pub verilog: String,
    /// The inputs of that clock.
    pub inputs: String,
}

impl fmt::Display for Mismatch {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Mismatch { clock, signal, model, verilog, inputs } = self;
        write!(f, "clock {clock}: {signal}: model {model}, Verilog {verilog}; inputs {inputs}")
    }
}

/// A program in C++ around a design: its declaration for a simulator, and the statements that give
/// inputs and compare outputs.
fn program(declared: &str, ports: usize, give: &str, compare: &str) -> String {
    include_str!("program.cpp")
        .replace("@TOP@", declared)
        .replace("@PORTS@", &ports.to_string())
        .replace("@GIVE@", give)
        .replace("@COMPARE@", compare)
}

/// A simulator's verdict: its line `mismatch CLOCK SIGNAL MODEL VERILOG`, or `equal CLOCKS`.
fn verdict(log: &str) -> String {
    let is_verdict = |line: &&str| line.starts_with("mismatch ") || line.starts_with("equal ");
    let line = log.lines().find(is_verdict);
    line.unwrap_or_else(|| panic!("the simulator gave no verdict: {log}")).to_owned()
}

/// Reads a verdict.
fn result(verdict: &str, trace: &Trace) -> Result<(), Mismatch> {
    match verdict.split_whitespace().collect::<Vec<_>>()[..] {
        ["mismatch", clock, signal, model, verilog] => {
            let clock: usize = clock.parse().expect("a clock");
            let [signal, model, verilog] = [signal, model, verilog].map(str::to_owned);
            Err(Mismatch { clock, signal, model, verilog, inputs: trace.inputs(clock) })
        }
        ["equal", clocks] => {
            assert_eq!(clocks.parse(), Ok(trace.clocks()), "the simulator ran all clocks");
            Ok(())
        }
        _ => panic!("no verdict: {verdict}"),
    }
}
