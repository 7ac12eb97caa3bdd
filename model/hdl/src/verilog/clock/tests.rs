// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registers that keep their word under a condition or without it, that choose before their point is
//! moved, and that hang on different conditions.

use crate::block::{Block, Interpretation, State};
use crate::format::{BIT, Format};
use crate::verilog::Design;

crate::block! {
    /// A register of each kind.
    struct Chosen("chosen") {}
    submodules {}
    inputs(block) { p: BIT, q: BIT, s: BIT, a: Format::signed(3, 1), b: Format::signed(3, 1) }
    outputs(block) {
        kept: Format::signed(3, 1),
        taken: Format::signed(3, 1),
        moved: Format::signed(3, 2),
        nested: Format::signed(3, 1),
        part: Format::unsigned(2, 0),
    }
    registers(block) {
        kept: Format::signed(3, 1),
        taken: Format::signed(3, 1),
        moved: Format::signed(3, 2),
        nested: Format::signed(3, 1),
    }
}

impl Block for Chosen {
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        state.store(
            self,
            Registers {
                kept: i.s.select(r.kept, i.a),
                taken: i.q.select(i.b, r.taken),
                moved: i.p.select(i.a, i.b).scaled(-1),
                nested: i.p.select(i.q.select(i.a, i.b), i.q.select(i.b, r.nested)),
            },
        );
        let Registers { kept, taken, moved, nested } = r;
        Outputs { kept, taken, moved, nested, part: (i.a + i.b).bits(1, 2) }
    }
}

const CLOCK: &str = "            if (p) begin
                moved <= a;
                nested <= q ? a : b;
            end else begin
                moved <= b;
                if (q) begin
                    nested <= b;
                end
            end
            if (q) begin
                taken <= b;
            end
            if (~s) begin
                kept <= a;
            end
";

#[test]
fn conditions_are_shared_and_what_is_kept_is_left_out() {
    let text = Design::of(&Chosen {}, "a test").text();
    let (_, clock) = text.split_once("        end else begin\n").expect("a reset");
    let (clock, rest) = clock.split_once("        end\n    end\n").expect("an end");
    assert_eq!(clock, CLOCK);
    assert!(rest.contains("{1'b0, a_plus_b[0], a_plus_b[3]}"), "{rest}");
}

#[test]
fn branches_that_are_empty_are_left_out() {
    let of = |set, unset| super::alternatives("a", "a", set, unset, 0);
    assert_eq!(of("", ""), "");
    assert_eq!(of("    x;\n", ""), "if (a) begin\n    x;\nend\n");
    assert_eq!(of("", "    y;\n"), "if (~a) begin\n    y;\nend\n");
    assert_eq!(of("    x;\n", "    y;\n"), "if (a) begin\n    x;\nend else begin\n    y;\nend\n");
}
