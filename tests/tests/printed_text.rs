// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the mutants know of printed text: its statements, and the places in them that can be wrong.

use std::collections::HashSet;

use hapticore_tests::faults::Kind;
use hapticore_tests::faults::kinds::variants;
use hapticore_tests::faults::statements::{Statement, statements, unused};
use hapticore_tests::faults::word::Word;

fn check_variant(kind: Kind, expression: &str, expected: &str) {
    let found = variants(expression);
    let there = found.iter().any(|variant| variant.kind == kind && variant.text == expected);
    assert!(there, "{expression}: {found:#?}");
}

#[test]
fn every_shape_is_found() {
    check_variant(Kind::Sign, "{{2{a[3]}}, a} + b", "{{2{1'b0}}, a} + b");
    check_variant(Kind::Sign, "a < $signed(20'd0)", "a < $unsigned(20'd0)");
    check_variant(Kind::Sign, "left * right", "left * $unsigned(right)");
    check_variant(Kind::Sign, "a - b", "a + b");
    check_variant(Kind::Rounding, "p[30:15] + {15'd0, p[14] & (p[15] | (|p[13:0]))}", "p[30:15]");
    check_variant(
        Kind::Rounding,
        "p[30:15] + {15'd0, p[14] & (p[15] | (|p[13:0]))}",
        "p[30:15] + {15'd0, p[14]}",
    );
    check_variant(Kind::Width, "(f[22:15] == {8{f[22]}}) ? f[15:0] : r", "1'b1 ? f[15:0] : r");
    check_variant(Kind::Width, "(|f[18:17]) ? {17{1'b1}} : f[16:0]", "1'b0 ? {17{1'b1}} : f[16:0]");
    check_variant(Kind::Width, "c[15] ? 15'd0 : c[14:0]", "1'b0 ? 15'd0 : c[14:0]");
    check_variant(Kind::Latency, "index < 4'd12", "index <= 4'd12");
    check_variant(Kind::Latency, "step == 3'd7", "step == 3'd0");
}

fn check_word(range: &str, value: &str, unused: &str, expected: &[&str]) {
    let unused = HashSet::from([unused.to_owned()]);
    let word = Word::new(range, "w", value, &unused);
    let found: Vec<_> =
        word.variants().into_iter().map(|variant| variant.instead).chain(word.narrow()).collect();
    assert_eq!(found, expected, "{range}{value}");
}

#[test]
fn what_the_text_says_is_no_fault_is_none() {
    let (top, low) = ("{1'b0, w_true[6:0]}", "{w_true[7:1], 1'b0}");
    check_word("[7:0] ", "a + b", "v[7]", &["-", top, low]);
    check_word("[7:0] ", "a + b", "w[7]", &["-", low]);
    check_word("[7:0] ", "a + b", "w[7:6]", &[low]);
    check_word("[7:0] ", "{a, 3'd0}", "", &[top]);
    check_word("[7:0] ", "{1'd0, a}", "w[0]", &[]);
    check_word("signed [7:0] ", "{{2{a[5]}}, a} + b", "w[7:6]", &[low]);
    check_word("", "a * b", "", &[]);
}

#[test]
fn statements_are_told_apart() {
    let module = "    wire signed [3:0] a =\n        b ? c\n        : d; // s4.0\n    wire e; // u1.0\n    x <= a + b;\n    if (e) begin\n    assign y = x;\n    wire unused = &{1'b0, a[3], b};\n";
    let [a, b, c, d, e, f] = &statements(module)[..] else { panic!("{:?}", statements(module)) };
    let text = str::to_owned;
    assert_eq!(
        *a,
        Statement::Wire {
            range: text("signed [3:0] "),
            name: text("a"),
            value: text("b ? c\n: d")
        }
    );
    assert_eq!(*b, Statement::Driven { range: text(""), name: text("e") });
    assert_eq!(*c, Statement::Register { name: text("x"), value: text("a + b") });
    assert_eq!(*d, Statement::Condition { value: text("e"), rest: text("if\nbegin") });
    assert_eq!(*e, Statement::Output { name: text("y"), value: text("x") });
    assert!(matches!(f, Statement::Other(_)));
    assert_eq!(unused(module), HashSet::from([text("a[3]"), text("b")]));
}

#[test]
#[should_panic(expected = "unknown: z <- a + b;")]
fn no_operator_is_left_out() {
    statements("    z <- a + b;");
}
