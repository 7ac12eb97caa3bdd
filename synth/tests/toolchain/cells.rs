// SPDX-License-Identifier: MIT OR Apache-2.0
//! The models of cells that netlists are simulated with: a design with every shape of memory and
//! product, beside its gates.

use hapticore_synth::certificates::Subject;
use hapticore_synth::tools::{Tools, root};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Memories: address bits and width of a word. On ECP5 these become ports of 4 to 36 bits.
const MEMORIES: [(u32, u32); 5] = [(12, 4), (11, 9), (10, 18), (9, 36), (8, 23)];
/// Products: widths, and whether each factor is signed.
const PRODUCTS: [(u32, bool, u32, bool); 5] = [
    (18, true, 18, true),
    (16, false, 16, false),
    (16, true, 15, false),
    (22, true, 20, true),
    (9, false, 18, true),
];

/// The design, of modules that look like printed ones.
fn design() -> String {
    let mut text = String::from(
        "module mixture (input clock, input [63:0] a, input [63:0] b, output reg [63:0] sum);\n",
    );
    let mut sums = String::new();
    for (k, (bits, width)) in MEMORIES.into_iter().enumerate() {
        let (address, word, last) = (bits - 1, width - 1, (1_u32 << bits) - 1);
        write!(
            text,
            "    reg [{word}:0] memory_{k} [0:{last}];\n    reg [{word}:0] word_{k};\n    integer i_{k};\n\
             \x20   initial begin word_{k} = 0; for (i_{k} = 0; i_{k} <= {last}; i_{k} = i_{k} + 1) \
             memory_{k}[i_{k}] = i_{k} * 40503; end\n\
             \x20   always @(posedge clock) begin\n        word_{k} <= memory_{k}[a[{address}:0]];\n\
             \x20       if (a[63]) memory_{k}[b[{address}:0]] <= {{a[40:20], b[40:20]}};\n    end\n"
        )
        .expect("a string grows");
        write!(sums, " + {{word_{k}, {k}'d0}}", k = k).expect("a string grows");
    }
    for (k, (a, a_signed, b, b_signed)) in PRODUCTS.into_iter().enumerate() {
        let signed = |signed| if signed { "signed " } else { "" };
        let factor = |name: &str, is_signed: bool| match is_signed {
            true => format!("{name}_{k}"),
            false => format!("$signed({{1'b0, {name}_{k}}})"),
        };
        writeln!(
            text,
            "    wire {}[{}:0] left_{k} = a[{}:0];\n    wire {}[{}:0] right_{k} = b[{}:0];\n    reg signed [{}:0] product_{k} = 0;\n\
             \x20   always @(posedge clock) product_{k} <= {} * {};",
            signed(a_signed), a - 1, a - 1, signed(b_signed), b - 1, b - 1, a + b + 1,
            factor("left", a_signed), factor("right", b_signed)
        )
        .expect("a string grows");
        write!(sums, " + product_{k}").expect("a string grows");
    }
    let sums = sums.replace(", 0'd0", "");
    text + &format!(
        "    initial sum = 0;\n    always @(posedge clock) sum <= 0{sums};\nendmodule\n"
    )
}

/// Random input to both; addresses that meet are more than frequent. With `wrong`, a write goes to
/// the gates alone.
fn bench(wrong: bool) -> String {
    let gate_a = if wrong { "{a[63] | (clock_number == 500), a[62:0]}" } else { "a" };
    format!(
        "module bench;\n    reg clock = 0;\n    reg [63:0] a = 0, b = 0;\n    wire [63:0] sum, gate_sum;\n    integer clock_number;\n\
         \x20   mixture one (.clock(clock), .a(a), .b(b), .sum(sum));\n\
         \x20   mixture_gate other (.clock(clock), .a({gate_a}), .b(b), .sum(gate_sum));\n\
         \x20   initial begin\n        for (clock_number = 0; clock_number < 3000; clock_number = clock_number + 1) begin\n\
         \x20           a = {{$urandom, $urandom}};\n            b = {{$urandom, $urandom}};\n\
         \x20           if (a[62:61] == 0) b[15:0] = a[15:0];\n            if (a[60:58] == 0) {{a[13:5], b[13:5]}} = 0;\n\
         \x20           #5 clock = 1;\n            #5 clock = 0;\n\
         \x20           if (clock_number > 4 && sum !== gate_sum) begin\n\
         \x20               $display(\"clock %0d: %h, gates %h\", clock_number, sum, gate_sum);\n                $finish;\n\
         \x20           end\n        end\n        $display(\"EQUAL\");\n        $finish;\n    end\nendmodule\n"
    )
}

fn simulate(tools: &Tools, folder: &Path, wrong: bool) -> String {
    fs::write(folder.join("bench.v"), bench(wrong)).expect("a file");
    let sources = ["-g2012", "-s", "bench", "-o", "bench.vvp", "design.v", "gates.v", "bench.v"];
    tools.run("iverilog", &sources, folder).unwrap();
    tools.run("vvp", &["-n", "bench.vvp"], folder).unwrap()
}

fn check(family: &str) {
    let files = ["synth/netlist", "synth/cells", "synth/tests/toolchain/cells.rs"];
    Subject::new()
        .and(family)
        .and_files(&files)
        .holds(&format!("cells: {family}"), || gates_are_their_verilog(family));
}

fn gates_are_their_verilog(family: &str) {
    let tools = Tools::find().expect("what synth/tools fetches");
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("design.v"), design()).expect("a file");
    let script = root().join("synth/netlist");
    let mut command = tools.command(script.to_str().expect("a path"));
    command.args([family, "design.v", "gates.v"]).env("TOP", "mixture").current_dir(folder.path());
    let output = command.output().expect("a script");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let log = simulate(&tools, folder.path(), false);
    assert!(log.contains("EQUAL"), "{family}: {log}");
    let log = simulate(&tools, folder.path(), true);
    assert!(
        log.contains("clock ") && !log.contains("EQUAL"),
        "{family}, with a write that only the gates see: {log}"
    );
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn ice40_gates_simulate_as_their_verilog() {
    check("ice40");
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn ecp5_gates_simulate_as_their_verilog() {
    check("ecp5");
}
