// SPDX-License-Identifier: MIT OR Apache-2.0
//! A rust-hdl design on two legs: its simulation in Rust, and the Verilog that it prints in Icarus.

use rust_hdl_core::prelude::{Block, simulate};
use std::fs;
use std::process::Command;

/// Names and widths.
pub type Ports = &'static [(&'static str, usize)];

/// A design with words in and words out, as rust-hdl has them.
pub trait Design: Block {
    /// The inputs, and the outputs.
    const PORTS: (Ports, Ports);
    /// Whether it has a clock.
    const CLOCKED: bool = false;
    /// Steps before its reset has made Verilog's registers known.
    const UNKNOWN: usize = 0;

    /// Gives it inputs.
    fn set(&mut self, inputs: &[u64]);
    /// What it puts out.
    fn get(&self) -> Vec<u64>;
    /// Sets the clock, where there is one.
    fn clock(&mut self, _high: bool) {}
}

/// The outputs that rust-hdl's simulation gives, inputs after inputs; each a clock where there is
/// one.
pub fn simulated<D: Design>(design: &mut D, inputs: &[Vec<u64>]) -> Vec<Vec<u64>> {
    design.connect_all();
    let settle = |design: &mut D| assert!(simulate(design, 100), "the design settles");
    let mut outputs = Vec::new();
    for inputs in inputs {
        design.clock(false);
        design.set(inputs);
        settle(design);
        outputs.push(design.get());
        design.clock(true);
        settle(design);
    }
    outputs
}

/// The outputs that the printed Verilog gives in Icarus.
pub fn printed<D: Design>(verilog: &str, inputs: &[Vec<u64>]) -> Vec<Vec<u64>> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    fs::write(path("top.v"), verilog).expect("a file");
    fs::write(path("bench.v"), bench::<D>(inputs)).expect("a file");
    let run = |program: &str, arguments: &[&str]| {
        let output = Command::new(program)
            .args(arguments)
            .current_dir(folder.path())
            .output()
            .expect("a program");
        assert!(output.status.success(), "{program}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).expect("text")
    };
    run("iverilog", &["-g2005", "-s", "bench", "-o", "bench", "bench.v", "top.v"]);
    let log = run("vvp", &["bench"]);
    let words = |line: &str| {
        line.split_whitespace()
            .map(|word| u64::from_str_radix(word, 16).expect("a known word"))
            .collect()
    };
    log.lines().skip(D::UNKNOWN).map(words).collect()
}

/// A bench that gives the inputs in turn and prints the outputs.
fn bench<D: Design>(inputs: &[Vec<u64>]) -> String {
    let (ins, outs) = D::PORTS;
    let declare = |kind: &str, ports: &[(&str, usize)]| -> String {
        ports
            .iter()
            .map(|(name, width)| format!("    {kind} [{}:0] {name};\n", width - 1))
            .collect()
    };
    let names = ins.iter().chain(outs).map(|(name, _)| format!(".{name}({name})"));
    let clocked = D::CLOCKED.then_some(".clock(clock)".to_string());
    let ports: Vec<_> = names.chain(clocked).collect();
    let format: Vec<_> = outs.iter().map(|_| "%x").collect();
    let shown: Vec<_> = outs.iter().map(|(name, _)| *name).collect();
    let steps: String = inputs
        .iter()
        .map(|words| {
            let set: String = ins
                .iter()
                .zip(words)
                .map(|((name, width), word)| format!("{name} = {width}'h{word:x}; "))
                .collect();
            let show = format!("$display(\"{}\", {});", format.join(" "), shown.join(", "));
            format!("        clock = 0; {set}#1 {show} clock = 1; #1;\n")
        })
        .collect();
    format!(
        "module bench;\n    reg clock;\n{}{}    top uut ({});\n    initial begin\n{steps}    end\nendmodule\n",
        declare("reg", ins),
        declare("wire", outs),
        ports.join(", ")
    )
}

/// The first inputs on which simulation and printed Verilog differ, and what each gives.
pub fn mismatch<D: Design>(mut design: D, inputs: &[Vec<u64>]) -> Option<String> {
    let simulated = simulated(&mut design, inputs).split_off(D::UNKNOWN);
    let printed = printed::<D>(&hapticore_rtl::component::verilog(&design), inputs);
    assert_eq!(simulated.len(), printed.len(), "a line a step");
    let both = simulated.iter().zip(&printed);
    let at = both.into_iter().position(|(simulated, printed)| simulated != printed)?;
    let given = &inputs[at + D::UNKNOWN];
    Some(format!(
        "step {at}, inputs {given:x?}: simulated {:x?}, printed {:x?}",
        simulated[at], printed[at]
    ))
}
