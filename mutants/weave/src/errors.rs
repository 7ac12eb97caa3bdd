// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which mutants an error of the compiler is about: the marks of [`crate::weave`] around its place say it.

use std::ops::RangeInclusive;

/// What an error is about, with numbers of mutants.
#[derive(Debug, PartialEq, Eq)]
pub enum Blame {
    /// The code of one mutant, or a `match` from which it takes an arm: it does not compile.
    Mutants(RangeInclusive<usize>),
    /// The code around mutants: they cannot be woven.
    Place(RangeInclusive<usize>),
}

/// What an error at a byte of a woven text is about.
pub fn blame(text: &str, byte: usize, code: &str) -> Option<Blame> {
    let open = open_marks(&text[..byte]);
    // Where patterns are not exhaustive.
    let arms = code == "E0004";
    let mark = open.iter().rev().find(|mark| arms == (mark.kind == '?'))?;
    let numbers = mark.first..=mark.last;
    Some(if mark.kind == '{' { Blame::Place(numbers) } else { Blame::Mutants(numbers) })
}

/// The function that a constant calls and that is none for constants, where a message says so.
pub fn called_by_constant(message: &str) -> Option<&str> {
    let path = message.strip_prefix("cannot call non-const ")?.split('`').nth(1)?;
    let path =
        path.split_once("::<").filter(|_| path.ends_with('>')).map_or(path, |(path, _)| path);
    path.rsplit("::").next().filter(|name| *name != "woven")
}

struct Mark {
    kind: char,
    first: usize,
    last: usize,
}

/// The marks that are open at the end of a text.
fn open_marks(text: &str) -> Vec<Mark> {
    let mut open = Vec::new();
    for part in text.split("/*").skip(1) {
        let Some((comment, _)) = part.split_once("*/") else { continue };
        let mut characters = comment.chars();
        match (characters.next(), numbers(characters.as_str())) {
            (Some(kind @ ('<' | '{' | '?')), Some((first, last))) => {
                open.push(Mark { kind, first, last });
            }
            (Some('>' | '}' | '.'), Some(_)) => drop(open.pop()),
            _ => (),
        }
    }
    open
}

fn numbers(text: &str) -> Option<(usize, usize)> {
    let (first, last) = text.split_once(',').unwrap_or((text, text));
    Some((first.parse().ok()?, last.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_function_of_constants_is_named() {
        for (message, name) in [
            (
                "cannot call non-const associated function `Format::unsigned` in constants",
                Some("unsigned"),
            ),
            ("cannot call non-const function `states::snake::<4>` in constants", Some("snake")),
            ("cannot call non-const function `hapticore_hdl::woven` in constants", None),
            ("mismatched types", None),
        ] {
            assert_eq!(called_by_constant(message), name);
        }
    }

    #[test]
    fn the_innermost_mark_is_blamed() {
        let text = "a (/*{4,5*/match m(4, 5) { 0 => x + (/*{6,6*/y/*}6*/), /*<4*/ 4 => Z /*>4*/, }/*}4*/) match /*?7,8*/ q /*.7*/ {}";
        let at = |what: &str, code| blame(text, text.find(what).unwrap(), code);
        assert_eq!(at("a", "E0308"), None);
        assert_eq!(at("x", "E0308"), Some(Blame::Place(4..=5)));
        assert_eq!(at("y", "E0308"), Some(Blame::Place(6..=6)));
        assert_eq!(at("Z", "E0308"), Some(Blame::Mutants(4..=4)));
        assert_eq!(at("q", "E0004"), Some(Blame::Mutants(7..=8)));
        assert_eq!(at("q", "E0308"), None);
    }
}
