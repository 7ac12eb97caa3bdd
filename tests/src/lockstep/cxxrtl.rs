// SPDX-License-Identifier: MIT OR Apache-2.0
//! Verilog in CXXRTL, the simulator of Yosys, with its assertions on: an address beyond the words of
//! a memory ends the program, whether or not the word is used.

use std::cell::OnceCell;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use hapticore_hdl::verilog::{Direction, Port};
use hapticore_synth::certificates::Subject;
use tempfile::TempDir;

use super::{Mismatch, Trace, program, result, verdict};
use crate::tools::{find, run};

/// The commands that it takes.
pub const COMMANDS: [&str; 2] = ["yosys", "g++"];

/// Runs a design, given as Verilog text, on traces.
///
/// # Errors
/// An output that differs.
///
/// # Panics
/// Where a tool fails, and where an assertion does.
pub fn check(top: &str, verilog: &str, traces: &[Trace]) -> Result<(), Mismatch> {
    let ports = &traces.first().expect("a trace").ports;
    let main = main(top, ports);
    let program = OnceCell::new();
    for trace in traces {
        let subject = Subject::new().and("cxxrtl -O1").and(verilog).and(&main).and(trace.bytes());
        let ask = || {
            let folder = program.get_or_init(|| compile(top, &main, verilog, &["-O1"])).path();
            fs::write(folder.join("trace"), trace.bytes()).expect("written");
            verdict(&run(Command::new(folder.join("design")).arg("trace"), folder))
        };
        result(&subject.verdict(&format!("cxxrtl: {top}"), ask), trace)?;
    }
    Ok(())
}

/// Compiles a design given as Verilog text with `main`, the C++ around it, which includes `design.cc`: the folder in which
/// the program `design` lies.
///
/// # Panics
/// Where a tool fails.
pub fn compile(top: &str, main: &str, verilog: &str, options: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    fs::write(at("design.v"), verilog).expect("written");
    fs::write(at("main.cpp"), main).expect("written");
    // Without what only debuggers need.
    let script = format!("read_verilog design.v; hierarchy -top {top}; write_cxxrtl -g0 design.cc");
    run(Command::new("yosys").args(["-q", "-p", &script]), folder.path());
    let mut compiler = Command::new("g++");
    compiler.args(options).args(["-std=c++14", "-I"]).arg(runtime());
    run(compiler.args(["-o", "design", "main.cpp"]), folder.path());
    folder
}

/// The headers that a printed design includes, beside the Yosys that is called.
fn runtime() -> PathBuf {
    let yosys = find("yosys").expect("yosys is on the path");
    let prefix = yosys.parent().and_then(Path::parent).expect("a program in a folder `bin`");
    let shares = ["share", "share/yosys"].map(|share| prefix.join(share));
    let headers = shares.map(|share| share.join("include/backends/cxxrtl/runtime"));
    headers.into_iter().find(|folder| folder.is_dir()).expect("Yosys brings CXXRTL's headers")
}

/// The program around the design.
fn main(top: &str, ports: &[Port]) -> String {
    let (mut give, mut compare) = (String::new(), String::new());
    for (index, port) in ports.iter().enumerate() {
        let (name, mask) = (escaped(&port.name), u64::MAX >> (64 - u32::from(port.format.width)));
        let _ = match port.direction {
            Direction::Input => {
                writeln!(give, "    top->{name}.set<uint64_t>(row[{index}] & {mask}ull);")
            }
            Direction::Output => writeln!(
                compare,
                "    differ(clock, \"{}\", row[{index}] & {mask}ull, bits(top->{name}));",
                port.name
            ),
        };
    }
    let declared = include_str!("cxxrtl.cpp").replace("p_@TOP@", &escaped(top));
    program(&declared, ports.len(), &give, &compare)
}

/// A name as CXXRTL has it.
pub fn escaped(name: &str) -> String {
    format!("p_{}", name.replace('_', "__"))
}
