// SPDX-License-Identifier: MIT OR Apache-2.0
//! A course in Verilator.

use std::fmt::Write;
use std::fs;
use std::process::Command;

use hapticore_model::blocks::core::Inputs;
use hapticore_model::bundle::{Bundle, Field};
use hapticore_rtl::verilog::{Design, Direction, Port};

use super::{Course, Lap, ROTATED, moved};
use crate::lockstep::bits;
use crate::lockstep::verilator::{Program, Speed};
use crate::tools::run;

/// A compiled core with its course.
pub struct Verilated {
    program: Program,
    passes: usize,
}

impl Verilated {
    /// Compiles a core as fast as Verilator and the C++ compiler can make it, and leaves the course beside it.
    ///
    /// # Panics
    /// Where a tool fails.
    pub fn new(design: &Design, course: &Course) -> Verilated {
        let program = Program::compile(design.top(), &main(design, course), &design.text(), Speed::Run);
        let table = course.table.iter().flat_map(|&(address, word)| [address.to_le_bytes(), word.to_le_bytes()]);
        let samples = course.samples.iter().flat_map(|code| code.to_le_bytes());
        fs::write(program.at("table.bin"), table.flatten().collect::<Vec<u8>>()).expect("written");
        fs::write(program.at("samples.bin"), samples.collect::<Vec<u8>>()).expect("written");
        Verilated { program, passes: course.passes }
    }

    /// Runs the course from reset.
    ///
    /// # Panics
    /// Where the program fails.
    pub fn run(&self) -> Lap {
        let mut command = Command::new(self.program.path());
        let said = run(command.args(["table.bin", "samples.bin", &self.passes.to_string()]), &self.program.at(""));
        let (seconds, sum) = said.trim().split_once(' ').expect("a time and a sum");
        Lap { seconds: seconds.parse().expect("a time"), sum: sum.parse().expect("a sum") }
    }
}

/// The program around the core.
fn main(design: &Design, course: &Course) -> String {
    let width = |name: &str| design.ports.iter().find(|port| port.name == name).expect("a port").format.width;
    let mask = |name: &str| format!("{:#x}", bits(-1, width(name)));
    include_str!("verilator.cpp")
        .replace("@TOP@", design.top())
        .replace("@CHANNELS@", &course.channels.to_string())
        .replace("@CLOCKS_PER_SAMPLE@", &course.clocks_per_sample.to_string())
        .replace("@ROTATED@", &ROTATED.to_string())
        .replace("@SUM@", &sum(&design.ports))
        .replace("@CONSTANTS@", &constants(course, &width))
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

fn constants(course: &Course, width: &impl Fn(&str) -> u8) -> String {
    let mut text = String::new();
    Inputs::each(course.constants, |Field { name, .. }, code| {
        let _ = writeln!(text, "    top->{name} = {:#x}ull;", bits(code, width(name)));
    });
    text
}
