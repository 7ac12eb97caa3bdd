// SPDX-License-Identifier: MIT OR Apache-2.0
//! Verilog in Icarus Verilog, under a bench that reads a trace as text.

use std::fmt::Write;
use std::fs;
use std::process::Command;

use hapticore_hdl::verilog::{Direction, Port};
use hapticore_synth::certificates::Subject;

use super::trace::bits;
use super::{Mismatch, Trace, result, verdict};
use crate::tools::run;

/// Runs a design, given as Verilog text, on a trace.
///
/// # Errors
/// An output that differs, or is unknown.
///
/// # Panics
/// Where a tool fails.
pub fn check(top: &str, verilog: &str, trace: &Trace) -> Result<(), Mismatch> {
    let bench = bench(top, &trace.ports);
    let subject = Subject::new().and("icarus").and(verilog).and(&bench).and(trace.bytes());
    let ask = || {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("design.v"), verilog).expect("written");
        fs::write(at("bench.v"), &bench).expect("written");
        fs::write(at("trace.hex"), vectors(trace)).expect("written");
        let mut compile = Command::new("iverilog");
        compile.args(["-g2005", "-o", "bench", "design.v", "bench.v"]);
        run(&mut compile, folder.path());
        verdict(&run(Command::new("vvp").arg("bench"), folder.path()))
    };
    result(&subject.verdict(&format!("icarus: {top}"), ask), trace)
}

/// A line of hexadecimal words for each clock.
fn vectors(trace: &Trace) -> String {
    let mut text = String::new();
    for clock in 0..trace.clocks() {
        for (port, &code) in trace.ports.iter().zip(trace.row(clock)) {
            let _ = write!(text, "{:x} ", bits(code, port.format.width));
        }
        text.push('\n');
    }
    text
}

fn bench(top: &str, ports: &[Port]) -> String {
    let (mut declare, mut connect, mut read, mut compare) =
        (String::new(), String::new(), String::new(), String::new());
    for port in ports {
        let (name, high) = (&port.name, port.format.width - 1);
        let _ = writeln!(connect, "        , .{name}({name})");
        if port.direction == Direction::Input {
            let _ = writeln!(declare, "    reg [{high}:0] {name};");
            let _ = writeln!(read, "            got = $fscanf(file, \"%h\", {name});");
        } else {
            let _ = writeln!(declare, "    wire [{high}:0] {name}; reg [{high}:0] model_{name};");
            let _ = writeln!(read, "            got = $fscanf(file, \"%h\", model_{name});");
            let _ = writeln!(compare, "            if ({name} !== model_{name}) begin");
            let log = format!("\"mismatch %0d {name} 0x%0h 0x%0h\", clocks, model_{name}, {name}");
            let _ = writeln!(
                compare,
                "                $display({log});\n                $finish(0);\n            end"
            );
        }
    }
    include_str!("icarus.v")
        .replace("@TOP@", top)
        .replace("@DECLARE@", &declare)
        .replace("@CONNECT@", &connect)
        .replace("@READ@", &read)
        .replace("@COMPARE@", &compare)
}
