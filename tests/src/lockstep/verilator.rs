// SPDX-License-Identifier: MIT OR Apache-2.0
//! Verilog in Verilator, as a program that reads a trace and compares every output at every clock.
//!
//! What has no initial value starts at zero or with anything, as [`Start`] says.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use hapticore_hdl::verilog::{Direction, Port};
use hapticore_synth::certificates::Subject;

use super::{Mismatch, Trace, program, result, verdict};
use crate::tools::run;

/// How the program is compiled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Speed {
    /// Soon; what has no initial value is decided at run time.
    Compile,
    /// As fast as Verilator can be.
    Run,
}

/// How the compiler is to make fast programs.
const FAST: &str = "-O3 -march=native";

/// What a design holds before its first clock, where it does not say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// Zero, as registers of both FPGA families do. For printed Verilog: a register that starts
    /// with anything may write into a memory at the clock that resets it.
    Zero,
    /// What Verilator makes up, the same at each run. For gates, whose registers say what they
    /// start with: read registers of memories, inputs that a cell leaves open.
    Anything,
}

/// Which Verilator: they are years apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Version {
    /// That of the distribution, 5.006 in Debian 12.
    Distribution,
    /// That of `synth/requirements.txt`.
    Current,
}

impl Version {
    /// The commands that it takes.
    pub fn commands(self) -> [&'static str; 3] {
        let verilator = match self {
            Version::Distribution => "verilator",
            Version::Current => "verilator-current",
        };
        [verilator, "make", "g++"]
    }

    /// Its command, and what that says of its version.
    ///
    /// # Panics
    /// Where it does not run.
    pub fn name(self) -> String {
        let command = self.commands()[0];
        let says = run(Command::new(command).arg("--version"), Path::new("."));
        format!("{command} ({})", says.trim())
    }
}

/// A compiled program around a design.
pub struct Program {
    folder: tempfile::TempDir,
}

impl Program {
    /// Compiles a design given as Verilog text with `main`, the C++ around it, in which the design
    /// is the class `Vtop`.
    ///
    /// # Panics
    /// Where a tool fails.
    pub fn compile(
        version: Version,
        top: &str,
        main: &str,
        verilog: &str,
        speed: Speed,
    ) -> Program {
        let program = Program { folder: tempfile::tempdir().expect("a folder") };
        fs::write(program.at("design.v"), verilog).expect("written");
        fs::write(program.at("main.cpp"), main).expect("written");
        let mut verilate = Command::new(version.commands()[0]);
        let unknown = if speed == Speed::Run { "fast" } else { "unique" };
        verilate.args(["--cc", "-O3", "--x-assign", unknown, "--x-initial", unknown, "--noassert"]);
        verilate.args([
            "-Wno-fatal",
            "-Wno-lint",
            "-Wno-style",
            "--top-module",
            top,
            "--prefix",
            "Vtop",
        ]);
        run(verilate.arg("--exe").arg(program.at("main.cpp")).arg("design.v"), &program.at(""));
        match speed {
            Speed::Run => program.make(FAST, &[]),
            // Verilator's own library is compiled for each program, and little of it runs at each clock.
            Speed::Compile => program.make("-O1", &["OPT_GLOBAL=-O0"]),
        }
        program
    }

    fn make(&self, optimise: &str, more: &[&str]) {
        let mut make = Command::new("make");
        // The package's Verilator calls whatever `python` is.
        make.args(["-C", "obj_dir", "-f", "Vtop.mk", "-j2", "PYTHON3=python3"]);
        run(make.arg(format!("OPT_FAST={optimise}")).args(more), &self.at(""));
    }

    /// Compiles it anew for what it did in a run (gcc's profile-guided optimisation).
    ///
    /// # Panics
    /// Where a tool fails.
    pub fn optimise_for(&self, run: impl FnOnce(&Program)) {
        let build = |option: &str| {
            let options = format!("{FAST} {option} -Wno-missing-profile");
            self.make(&options, &["--always-make", &format!("LDFLAGS={option}")]);
        };
        build("-fprofile-generate");
        run(self);
        build("-fprofile-use");
    }

    /// A file beside it.
    pub fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Path of the compiled program.
    pub fn path(&self) -> PathBuf {
        self.at("obj_dir/Vtop")
    }
}

/// A design that is compared with traces; compiled when a trace is run.
pub struct Verilated {
    version: Version,
    top: String,
    main: String,
    /// The text, or what it is made from.
    source: String,
    make: Box<dyn Fn(&str) -> String + Send + Sync>,
    program: OnceLock<Program>,
    start: Start,
}

impl Verilated {
    /// A design given as Verilog text.
    pub fn new(top: &str, ports: &[Port], verilog: &str, start: Start) -> Verilated {
        Verilated::with(Version::Distribution, top, ports, verilog, start)
    }

    /// A design given as Verilog text, for one Verilator or the other.
    pub fn with(
        version: Version,
        top: &str,
        ports: &[Port],
        verilog: &str,
        start: Start,
    ) -> Verilated {
        Verilated {
            version,
            top: top.to_owned(),
            main: main(ports),
            source: verilog.to_owned(),
            make: Box::new(str::to_owned),
            program: OnceLock::new(),
            start,
        }
    }

    /// A design whose text is made from another by nothing but that: gates of Verilog.
    pub fn made(
        top: &str,
        ports: &[Port],
        source: &str,
        make: impl Fn(&str) -> String + Send + Sync + 'static,
    ) -> Verilated {
        let make = Box::new(make);
        Verilated { make, ..Verilated::new(top, ports, source, Start::Anything) }
    }

    fn program(&self) -> &Program {
        let Verilated { version, top, main, .. } = self;
        let verilog = || (self.make)(&self.source);
        self.program
            .get_or_init(|| Program::compile(*version, top, main, &verilog(), Speed::Compile))
    }

    /// Runs a trace; the first mismatch, if there is one.
    ///
    /// # Errors
    /// An output that differs.
    ///
    /// # Panics
    /// Where a tool fails.
    pub fn check(&self, trace: &Trace) -> Result<(), Mismatch> {
        let Verilated { version, top, main, source, start, .. } = self;
        let how = format!("{version:?} {start:?} {top}");
        let subject = Subject::new().and(how).and(main).and(source).and(trace.bytes());
        let ask = || self.with_trace(trace.clone()).run(0);
        result(&subject.verdict(&format!("verilator: {top}"), ask), trace)
    }

    /// A trace beside the program, to be run more than once.
    pub fn with_trace(&self, trace: Trace) -> CompiledTrace<'_> {
        let file = tempfile::NamedTempFile::new_in(self.program().at("")).expect("a file");
        fs::write(file.path(), trace.bytes()).expect("written");
        CompiledTrace { verilated: self, trace, file }
    }
}

/// A compiled design with a trace.
pub struct CompiledTrace<'a> {
    verilated: &'a Verilated,
    trace: Trace,
    file: tempfile::NamedTempFile,
}

impl CompiledTrace<'_> {
    /// Runs the trace with a fault of a [`Planted`](crate::faults::Planted) design, or none (0).
    ///
    /// # Errors
    /// An output that differs.
    pub fn check(&self, fault: usize) -> Result<(), Mismatch> {
        result(&self.run(fault), &self.trace)
    }

    /// The simulator's verdict.
    fn run(&self, fault: usize) -> String {
        let (program, start) = (self.verilated.program(), self.verilated.start);
        let random = if start == Start::Zero { 0 } else { 2 };
        let mut command = Command::new(program.path());
        command
            .arg(self.file.path())
            .args(["+verilator+seed+1", &format!("+verilator+rand+reset+{random}")]);
        verdict(&run(command.arg(format!("+fault={fault}")), &program.at("")))
    }
}

/// The program around the design.
fn main(ports: &[Port]) -> String {
    let (mut give, mut compare) = (String::new(), String::new());
    for (index, port) in ports.iter().enumerate() {
        let (name, mask) = (&port.name, u64::MAX >> (64 - u32::from(port.format.width)));
        let _ = match port.direction {
            Direction::Input => writeln!(give, "    top->{name} = row[{index}] & {mask}ull;"),
            Direction::Output => {
                writeln!(
                    compare,
                    "    differ(clock, \"{name}\", row[{index}] & {mask}ull, top->{name} & {mask}ull);"
                )
            }
        };
    }
    program(include_str!("verilator.cpp"), ports.len(), &give, &compare)
}
