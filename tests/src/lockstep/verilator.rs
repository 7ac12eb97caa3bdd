// SPDX-License-Identifier: MIT OR Apache-2.0
//! Verilog in Verilator, as a program that reads a trace and compares every output at every clock.

use std::fmt::Write;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

use hapticore_rtl::verilog::{Direction, Port};

use super::{Mismatch, Trace, verdict};
use crate::tools::run;

/// How the program is compiled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Speed {
    /// Soon.
    Compile,
    /// As fast as Verilator can be.
    Run,
}

/// A compiled design.
pub struct Verilated {
    folder: tempfile::TempDir,
    program: PathBuf,
}

impl Verilated {
    /// Compiles a design given as Verilog text.
    ///
    /// # Panics
    /// Where a tool fails.
    pub fn new(top: &str, ports: &[Port], verilog: &str, speed: Speed) -> Verilated {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("design.v"), verilog).expect("written");
        fs::write(at("main.cpp"), program(top, ports)).expect("written");
        let mut verilate = Command::new("verilator");
        verilate.args(["--cc", "-O3", "--x-assign", "fast", "--noassert", "-Wno-fatal", "-Wno-lint", "-Wno-style"]);
        verilate.args(["--top-module", top, "--prefix", "Vtop", "--exe"]).arg(at("main.cpp")).arg("design.v");
        run(&mut verilate, folder.path());
        let optimise = if speed == Speed::Run { "-O3 -march=native" } else { "-O1" };
        let mut make = Command::new("make");
        make.args(["-C", "obj_dir", "-f", "Vtop.mk", "-j2"]).arg(format!("OPT_FAST={optimise}"));
        run(&mut make, folder.path());
        Verilated { program: at("obj_dir/Vtop"), folder }
    }

    /// Runs a trace; the first mismatch, if there is one.
    ///
    /// # Errors
    /// An output that differs.
    pub fn check(&self, trace: &Trace) -> Result<(), Mismatch> {
        verdict(&self.run(trace, "check"), trace)
    }

    /// Seconds that the design takes for the clocks of a trace, without comparing and without reading it.
    pub fn seconds(&self, trace: &Trace) -> f64 {
        let said = self.run(trace, "time");
        let seconds = said.lines().find_map(|line| line.strip_prefix("seconds ")).expect("a time");
        seconds.parse().expect("a number")
    }

    fn run(&self, trace: &Trace, what: &str) -> String {
        let file = self.folder.path().join("trace.bin");
        fs::write(&file, trace.bytes()).expect("written");
        run(Command::new(&self.program).arg(&file).arg(what), self.folder.path())
    }
}

/// The program around the design.
fn program(top: &str, ports: &[Port]) -> String {
    let (mut give, mut compare, mut sum) = (String::new(), String::new(), String::new());
    for (index, port) in ports.iter().enumerate() {
        let (name, mask) = (&port.name, u64::MAX >> (64 - u32::from(port.format.width)));
        let _ = match port.direction {
            Direction::Input => writeln!(give, "    top->{name} = row[{index}] & {mask}ull;"),
            Direction::Output => {
                let _ = writeln!(sum, "    sum = sum * 31 + top->{name};");
                writeln!(compare, "    differ(clock, \"{name}\", row[{index}] & {mask}ull, top->{name} & {mask}ull);")
            }
        };
    }
    include_str!("verilator.cpp")
        .replace("@TOP@", top)
        .replace("@PORTS@", &ports.len().to_string())
        .replace("@GIVE@", &give)
        .replace("@COMPARE@", &compare)
        .replace("@SUM@", &sum)
}
