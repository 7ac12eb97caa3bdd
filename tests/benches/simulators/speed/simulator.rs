// SPDX-License-Identifier: MIT OR Apache-2.0
//! A workload in Verilator.

use std::fmt::Write;
use std::fs;
use std::process::Command;

use hapticore_hdl::bundle::{Bundle, Field};
use hapticore_hdl::verilog::{Design, Direction, Port};
use hapticore_model::blocks::core::Inputs;

use super::{Lap, ROTATED, Workload, moved};
use hapticore_tests::lockstep::bits;
use hapticore_tests::lockstep::verilator::{Program, Speed};
use hapticore_tests::tools::run;

/// A compiled core with its workload.
pub struct Verilated {
    program: Program,
    passes: usize,
}

impl Verilated {
    /// Compiles a core as fast as Verilator and the C++ compiler can make it, and leaves the
    /// workload beside it.
    ///
    /// # Panics
    /// Where a tool fails.
    pub fn new(design: &Design, workload: &Workload) -> Verilated {
        let program =
            Program::compile(design.top(), &main(design, workload), &design.text(), Speed::Run);
        let table = workload
            .table
            .iter()
            .flat_map(|&(address, word)| [address.to_le_bytes(), word.to_le_bytes()]);
        let samples = workload.samples.iter().flat_map(|code| code.to_le_bytes());
        fs::write(program.at("table.bin"), table.flatten().collect::<Vec<u8>>()).expect("written");
        fs::write(program.at("samples.bin"), samples.collect::<Vec<u8>>()).expect("written");
        Verilated { program, passes: workload.passes }
    }

    /// Runs the workload from reset.
    ///
    /// # Panics
    /// Where the program fails.
    pub fn run(&self) -> Lap {
        let mut command = Command::new(self.program.path());
        let log = run(
            command.args(["table.bin", "samples.bin", &self.passes.to_string()]),
            &self.program.at(""),
        );
        let (seconds, sum) = log.trim().split_once(' ').expect("a time and a sum");
        Lap { seconds: seconds.parse().expect("a time"), sum: sum.parse().expect("a sum") }
    }
}

/// The program around the core.
fn main(design: &Design, workload: &Workload) -> String {
    let width = |name: &str| {
        design.ports.iter().find(|port| port.name == name).expect("a port").format.width
    };
    let mask = |name: &str| format!("{:#x}", bits(-1, width(name)));
    include_str!("verilator.cpp")
        .replace("@TOP@", design.top())
        .replace("@CHANNELS@", &workload.channels.to_string())
        .replace("@CLOCKS_PER_SAMPLE@", &workload.clocks_per_sample.to_string())
        .replace("@ROTATED@", &ROTATED.to_string())
        .replace("@SUM@", &sum(&design.ports))
        .replace("@CONSTANTS@", &constants(workload, &width))
        .replace("@CODE@", &mask("code"))
        .replace("@WORD@", &mask("word"))
}

/// Every output, as a number with its sign, into the sum.
fn sum(ports: &[Port]) -> String {
    let mut text = String::new();
    let outputs = ports.iter().filter(|port| port.direction == Direction::Output);
    for (index, Port { name, format, .. }) in outputs.enumerate() {
        let unused = 64 - u32::from(format.width);
        let code = match format.signed {
            true => format!("(uint64_t)((int64_t)((uint64_t)top->{name} << {unused}) >> {unused})"),
            false => format!("(uint64_t)top->{name}"),
        };
        let _ = writeln!(text, "    sum += {code} << {};", moved(index));
    }
    text
}

fn constants(workload: &Workload, width: &impl Fn(&str) -> u8) -> String {
    let mut text = String::new();
    Inputs::each(workload.constants, |Field { name, .. }, code| {
        let _ = writeln!(text, "    top->{name} = {:#x}ull;", bits(code, width(name)));
    });
    text
}
