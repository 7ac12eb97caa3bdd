// SPDX-License-Identifier: MIT OR Apache-2.0
//! A workload in a simulator of Verilog.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use hapticore_hdl::bundle::{Bundle, Field};
use hapticore_hdl::verilog::{Design, Direction, Port};
use hapticore_model::blocks::core::Inputs;
use hapticore_tests::lockstep::verilator::{Program, Speed, Version};
use hapticore_tests::lockstep::{bits, cxxrtl};
use hapticore_tests::tools::run;

use super::{Lap, ROTATED, Workload, moved};

/// A simulator, as fast as its and the C++ compiler's options make it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Simulator {
    /// Verilator `-O3`.
    Verilator(Version),
    /// The same, compiled for what it does in a run of the workload.
    ProfileGuided(Version),
    /// The simulator of Yosys, without its assertions.
    Cxxrtl,
}

impl Simulator {
    /// The simulators that are compared.
    pub const ALL: [Simulator; 4] = [
        Simulator::Verilator(Version::Distribution),
        Simulator::ProfileGuided(Version::Distribution),
        Simulator::Verilator(Version::Current),
        Simulator::Cxxrtl,
    ];

    /// The commands that it takes.
    pub fn commands(self) -> Vec<&'static str> {
        match self {
            Simulator::Verilator(version) | Simulator::ProfileGuided(version) => {
                version.commands().to_vec()
            }
            Simulator::Cxxrtl => cxxrtl::COMMANDS.to_vec(),
        }
    }

    /// Its name.
    pub fn name(self) -> String {
        match self {
            Simulator::Verilator(version) => format!("{}, -O3", short(&version.name())),
            Simulator::ProfileGuided(version) => {
                format!("{}, profile-guided", short(&version.name()))
            }
            Simulator::Cxxrtl => "CXXRTL, -O3".into(),
        }
    }

    /// How a port is named in C++.
    fn port(self, name: &str) -> String {
        match self {
            Simulator::Cxxrtl => cxxrtl::escaped(name).split_off("p_".len()),
            _ => name.into(),
        }
    }

    /// What a program includes and defines before its own text.
    fn design(self, top: &str) -> String {
        match self {
            Simulator::Cxxrtl => include_str!("cxxrtl.cpp").replace("@TOP@", &cxxrtl::escaped(top)),
            _ => include_str!("verilator.cpp").into(),
        }
    }
}

/// `Verilator 5.006` of `verilator (Verilator 5.006 2023-01-22 …)`, or the command, where it tells no such version.
fn short(name: &str) -> String {
    let (command, says) = name.split_once(" (").unwrap_or((name, ""));
    match says.split(' ').collect::<Vec<_>>()[..] {
        ["Verilator", version, ..] => format!("Verilator {version}"),
        _ => command.into(),
    }
}

/// A compiled core with its workload.
pub struct Simulated {
    program: Compiled,
    passes: usize,
}

enum Compiled {
    Verilated(Program),
    Cxxrtl(tempfile::TempDir),
}

impl Compiled {
    fn folder(&self) -> PathBuf {
        match self {
            Compiled::Verilated(program) => program.at(""),
            Compiled::Cxxrtl(folder) => folder.path().into(),
        }
    }

    fn path(&self) -> PathBuf {
        match self {
            Compiled::Verilated(program) => program.path(),
            Compiled::Cxxrtl(folder) => folder.path().join("design"),
        }
    }
}

impl Simulated {
    /// Compiles a core, and leaves the workload beside it.
    ///
    /// # Panics
    /// Where a tool fails.
    pub fn new(simulator: Simulator, design: &Design, workload: &Workload) -> Simulated {
        let (main, text) = (main(simulator, design, workload), design.text());
        let verilated = |version| {
            let program = Program::compile(version, design.top(), &main, &text, Speed::Run);
            write(workload, &program.at(""));
            program
        };
        let program = match simulator {
            Simulator::Verilator(version) => Compiled::Verilated(verilated(version)),
            Simulator::ProfileGuided(version) => {
                let program = verilated(version);
                program.optimise_for(|program| {
                    lap(&program.path(), &program.at(""), 1);
                });
                Compiled::Verilated(program)
            }
            Simulator::Cxxrtl => {
                let options = ["-O3", "-march=native", "-DNDEBUG"];
                let folder = cxxrtl::compile(design.top(), &main, &text, &options);
                write(workload, folder.path());
                Compiled::Cxxrtl(folder)
            }
        };
        Simulated { program, passes: workload.passes }
    }

    /// Runs the workload from reset.
    ///
    /// # Panics
    /// Where the program fails.
    pub fn run(&self) -> Lap {
        lap(&self.program.path(), &self.program.folder(), self.passes)
    }
}

fn lap(program: &Path, folder: &Path, passes: usize) -> Lap {
    let mut command = Command::new(program);
    let log = run(command.args(["table.bin", "samples.bin", &passes.to_string()]), folder);
    let (seconds, sum) = log.trim().split_once(' ').expect("a time and a sum");
    Lap { seconds: seconds.parse().expect("a time"), sum: sum.parse().expect("a sum") }
}

/// The workload's files.
fn write(workload: &Workload, folder: &Path) {
    let table = workload
        .table
        .iter()
        .flat_map(|&(address, word)| [address.to_le_bytes(), word.to_le_bytes()]);
    let samples = workload.samples.iter().flat_map(|code| code.to_le_bytes());
    let files = [("table.bin", table.flatten().collect()), ("samples.bin", samples.collect())];
    for (name, bytes) in files {
        let bytes: Vec<u8> = bytes;
        fs::write(folder.join(name), bytes).expect("written");
    }
}

/// The program around the core.
fn main(simulator: Simulator, design: &Design, workload: &Workload) -> String {
    let width = |name: &str| {
        design.ports.iter().find(|port| port.name == name).expect("a port").format.width
    };
    let mask = |name: &str| format!("{:#x}", bits(-1, width(name)));
    include_str!("simulator.cpp")
        .replace("@INCLUDES@", &simulator.design(design.top()))
        .replace("@CHANNELS@", &workload.channels.to_string())
        .replace("@CLOCKS_PER_SAMPLE@", &workload.clocks_per_sample.to_string())
        .replace("@ROTATED@", &ROTATED.to_string())
        .replace("@SUM@", &sum(simulator, &design.ports))
        .replace("@CONSTANTS@", &constants(simulator, workload, &width))
        .replace("@CODE@", &mask("code"))
        .replace("@WORD@", &mask("word"))
}

/// Every output, as a number with its sign, into the sum.
fn sum(simulator: Simulator, ports: &[Port]) -> String {
    let mut text = String::new();
    let outputs = ports.iter().filter(|port| port.direction == Direction::Output);
    for (index, Port { name, format, .. }) in outputs.enumerate() {
        let (name, unused) = (simulator.port(name), 64 - u32::from(format.width));
        let code = match format.signed {
            true => format!("(uint64_t)((int64_t)(GET({name}) << {unused}) >> {unused})"),
            false => format!("GET({name})"),
        };
        let _ = writeln!(text, "    sum += {code} << {};", moved(index));
    }
    text
}

fn constants(simulator: Simulator, workload: &Workload, width: &impl Fn(&str) -> u8) -> String {
    let mut text = String::new();
    Inputs::each(workload.constants, |Field { name, .. }, code| {
        let (name, code) = (simulator.port(name), bits(code, width(name)));
        let _ = writeln!(text, "    SET({name}, {code:#x}ull);");
    });
    text
}
