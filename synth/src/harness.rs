// SPDX-License-Identifier: MIT OR Apache-2.0
//! A core between shift registers.
//!
//! A core has more ports than a package has pins, and paths to pins would say nothing of it. Here
//! every input comes out of a register and every output goes into one, so that what limits the
//! clock lies within.

use hapticore_hdl::verilog::{Design, Direction, Port};
use std::fmt::Write as _;

/// The name of the harness's module.
pub const TOP: &str = "harness";

/// Bits of the registers around a core: those before it, those after.
pub fn bits(design: &Design) -> (u64, u64) {
    let of = |direction| {
        design.ports.iter().filter(|port| port.direction == direction).map(width).sum::<u64>()
    };
    (of(Direction::Input), of(Direction::Output))
}

fn width(port: &Port) -> u64 {
    port.format.width.into()
}

/// The harness of a core as Verilog.
pub fn verilog(design: &Design) -> String {
    let (inputs, outputs) = bits(design);
    let mut text = format!(
        "module {TOP} (input clock, input reset, input in, output reg out);\n\
         \x20   reg [{}:0] before;\n    wire [{}:0] results;\n    reg [{}:0] after;\n    {} core (.clock(clock), .reset(reset)",
        inputs - 1,
        outputs - 1,
        outputs - 1,
        design.top()
    );
    let (mut next_input, mut next_output) = (0, 0);
    for port in &design.ports {
        let (next, name) = match port.direction {
            Direction::Input => (&mut next_input, "before"),
            Direction::Output => (&mut next_output, "results"),
        };
        write!(text, ",\n        .{}({name}[{}:{next}])", port.name, *next + width(port) - 1)
            .expect("a string grows");
        *next += width(port);
    }
    let tail = format!(
        "\n    );\n    always @(posedge clock) begin\n        before <= {{before, in}};\n        \
         after <= reset ? results : {{after, 1'b0}} ^ results;\n        out <= after[{}];\n    end\nendmodule\n",
        outputs - 1
    );
    text + &tail
}
