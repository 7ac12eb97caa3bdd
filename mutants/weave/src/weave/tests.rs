// SPDX-License-Identifier: MIT OR Apache-2.0
//! The woven text of each genre.

use super::{Numbers, weave};
use crate::mutant::{Genre, Mutant, Place, Span};
use std::collections::BTreeSet;

/// A source with mutants, each given by what it replaces (`|`…`|` within a text that occurs once), by
/// what, and its genre: the woven text, without marks, and why the rest could not be woven.
fn woven(source: &str, changes: &[(&str, &str, Genre)]) -> (String, Vec<&'static str>) {
    let mutants: Vec<_> = changes.iter().map(|change| mutant(source, change)).collect();
    let listed: Vec<_> = mutants.iter().enumerate().collect();
    let constant = BTreeSet::from(["f".to_string()]);
    let (text, unwoven) = weave(source, &listed, &constant, &mut Numbers::default()).expect("Rust");
    assert_eq!(text.lines().count(), source.lines().count(), "lines stay where they are");
    syn::parse_file(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
    (without_marks(&text), unwoven.into_iter().map(|(_, reason)| reason).collect())
}

fn mutant(source: &str, &(place, replacement, genre): &(&str, &str, Genre)) -> Mutant {
    let parts: Vec<_> = place.split('|').collect();
    let [before, replaced, _] = parts[..] else { panic!("{place}: two bars") };
    let start = source.find(&parts.concat()).expect("in the source") + before.len();
    let at = |byte: usize| {
        let line = source[..byte].rfind('\n').map_or(0, |end| end + 1);
        let column = source[line..byte].chars().count() + 1;
        Place { line: source[..byte].matches('\n').count() + 1, column }
    };
    let span = Span { start: at(start), end: at(start + replaced.len()) };
    let (name, file) = (format!("{place} {replacement}"), "lib.rs".into());
    Mutant { name, file, span, replacement: replacement.into(), genre }
}

/// The text without comments and repeated spaces, the switch as `m`.
fn without_marks(text: &str) -> String {
    let mut plain = String::new();
    for (index, part) in text.split("/*").enumerate() {
        plain.push_str(if index == 0 { part } else { part.split_once("*/").expect("an end").1 });
    }
    let plain = plain.replace("::hapticore_hdl::woven", "m");
    plain.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn operators_and_what_is_within_them() {
    let changes = [
        ("1 |+| g", "-", Genre::BinaryOperator),
        ("1 |+| g", "*", Genre::BinaryOperator),
        ("(|-|2", "", Genre::UnaryOperator),
    ];
    let (text, _) = woven("fn f() -> i32 {\n    1 + g(-2) // three\n        - 3\n}", &changes);
    assert_eq!(
        text,
        "fn f() -> i32 { (match m(1, 2) { 0 => 1 + g((match m(3, 3) { 0 => -2, _ => 2 , })) // three - 3, \
         1 => 1 - g (- 2 ) - 3 , _ => 1 * g (- 2 ) - 3 , }) }"
    );
}

#[test]
fn an_operator_binds_as_the_new_one_does() {
    let (text, _) =
        woven("fn f() -> i32 { a - b - c }", &[("b |-| c", "/", Genre::BinaryOperator)]);
    assert_eq!(text, "fn f() -> i32 { (match m(1, 1) { 0 => a - b - c, _ => a - b / c , }) }");
}

#[test]
fn assignments() {
    let changes =
        [("a |+=| b", "-=", Genre::BinaryOperator), ("b |*| c", "+", Genre::BinaryOperator)];
    let (text, _) = woven("fn f() { a += b * c; }", &changes);
    assert_eq!(
        text,
        "fn f() { (match m(1, 1) { 0 => a += (match m(2, 2) { 0 => b * c, _ => b + c , }), _ => a -= b * c , }); }"
    );
}

#[test]
fn values_of_functions() {
    let (text, _) = woven(
        "fn f() -> u8 {\n    g()\n}",
        &[("|g()\n|}", "0", Genre::FnValue), ("|g()\n|}", "1", Genre::FnValue)],
    );
    assert_eq!(
        text,
        "fn f() -> u8 { match m(1, 2) { 0 => {}, 1 => return 0 , _ => return 1 , } g() }"
    );
}

#[test]
fn arms_and_guards() {
    let changes = [
        ("|1 => b,|", "", Genre::MatchArm),
        ("if |c| =>", "true", Genre::MatchArmGuard),
        ("if |c| =>", "false", Genre::MatchArmGuard),
    ];
    let (text, _) = woven("fn f() { match a { 1 => b, 2 if c => d, _ => e } }", &changes);
    assert_eq!(
        text,
        "fn f() { match a { 1 if m(1, 1) == 0 => b, 2 if (match m(2, 3) { 0 => c, 2 => true , _ => false , }) => d, _ => e } }"
    );
}

#[test]
fn fields_of_a_base() {
    let changes = [("|a,|", "", Genre::StructField), ("|b: 1,|", "", Genre::StructField)];
    let (text, _) = woven("fn f() -> S { S { a, b: 1, ..*r } }", &changes);
    assert_eq!(
        text,
        "fn f() -> S { S { a: match m(1, 1) { 0 => a, _ => (* r ).a , }, b: match m(2, 2) { 0 => 1, _ => (* r ).b , }, ..*r } }"
    );
    let (text, _) =
        woven("fn f() -> S { S { a: 1, ..g() } }", &[("|a: 1,|", "", Genre::StructField)]);
    assert_eq!(
        text,
        "fn f() -> S { S { a: match m(1, 1) { 0 => 1, _ => (S { ..g () }).a , }, ..g() } }"
    );
}

#[test]
fn what_cannot_be_woven_is_named() {
    let source = "const N: u8 = 1 + 2; const fn f() -> u8 { 3 - 4 } fn g() { if let A = b && c == d {} } fn h() -> impl I { 0 }";
    let changes = [
        ("1 |+| 2", "-", Genre::BinaryOperator),
        ("3 |-| 4", "+", Genre::BinaryOperator),
        ("b |&&| c", "||", Genre::BinaryOperator),
        ("c |==| d", "!=", Genre::BinaryOperator),
        ("{ |0| }", "1", Genre::FnValue),
        ("|h|", "", Genre::MatchArm),
    ];
    let (text, reasons) = woven(source, &changes);
    assert!(
        text.contains("if let A = b && (match m(1, 1) { 0 => c == d, _ => c != d , }) {}"),
        "{text}"
    );
    let expected = [
        "in a constant",
        "in a function that constants call",
        "between conditions with `let`",
        "of a type `impl Trait`",
        "its place is not found",
    ];
    assert_eq!(reasons, expected);
}

#[test]
fn a_const_fn_that_no_constant_calls_is_woven() {
    let changes = [("|1|", "0", Genre::FnValue)];
    let (text, reasons) = woven("pub const fn g() -> u8 { 1 }", &changes);
    assert_eq!(text, "pub fn g() -> u8 { match m(1, 1) { 0 => {}, _ => return 0 , } 1 }");
    assert_eq!(reasons, [""; 0]);
}
