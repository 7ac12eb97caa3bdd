// SPDX-License-Identifier: MIT OR Apache-2.0
//! Kinds of faults: shapes of the printer (`rtl/src/verilog/{expression,fit}.rs`) and what becomes
//! of them.

use std::sync::LazyLock;

use regex::{Captures, Regex};

/// What is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// An operand is extended with zeros, taken as unsigned, added instead of subtracted, or the
    /// other way round.
    Sign,
    /// A word is a bit narrower, above or below, or wraps where it should be saturated.
    Width,
    /// What is dropped is not rounded, or halves are rounded up and not to even.
    Rounding,
    /// A value comes a clock late, or a step is taken a count late.
    Latency,
}

impl Kind {
    /// Every kind of mutant.
    pub const ALL: [Kind; 4] = [Kind::Sign, Kind::Width, Kind::Rounding, Kind::Latency];
}

/// An expression with a fault.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Variant {
    /// What is wrong.
    pub kind: Kind,
    /// The part that is wrong.
    pub printed: String,
    /// What stands in its place.
    pub instead: String,
    /// The whole expression.
    pub text: String,
}

struct Rule {
    kind: Kind,
    shape: Regex,
    instead: fn(&Captures) -> Option<String>,
}

/// Each shape with what becomes of it, or nothing where it only looks like it.
static RULES: LazyLock<Vec<Rule>> = LazyLock::new(|| {
    let rule = |kind, shape, instead| Rule {
        kind,
        shape: Regex::new(shape).expect("an expression"),
        instead,
    };
    vec![
        rule(Kind::Sign, r"\{\{(\d+)\{(\w+)\[\d+\]\}\}, (\w+)", |c| {
            (c[2] == c[3]).then(|| format!("{{{{{}{{1'b0}}}}, {}", &c[1], &c[3]))
        }),
        rule(Kind::Sign, r"\$signed", |_| Some("$unsigned".into())),
        rule(Kind::Sign, r"(\w+) \* (\w+)$", |c| Some(format!("{} * $unsigned({})", &c[1], &c[2]))),
        rule(Kind::Sign, r" \+ ", |_| Some(" - ".into())),
        rule(Kind::Sign, r" - ", |_| Some(" + ".into())),
        rule(Kind::Rounding, r" \+ \{\d+'d0, \w+\[\d+\] & [^}]*\}", |_| Some(String::new())),
        rule(Kind::Rounding, r"(\+ \{\d+'d0, \w+\[\d+\]) & [^}]*\}", |c| {
            Some(format!("{}}}", &c[1]))
        }),
        rule(Kind::Width, r"\(\w+\[\d+:\d+\] == \{\d+\{\w+\[\d+\]\}\}\) \?", |_| {
            Some("1'b1 ?".into())
        }),
        rule(Kind::Width, r"\(\|\w+\[[\d:]+\]\) \?", |_| Some("1'b0 ?".into())),
        rule(Kind::Width, r"\w+\[\d+\] (\? \d+'d0 :)", |c| Some(format!("1'b0 {}", &c[1]))),
        rule(Kind::Latency, r" < ", |_| Some(" <= ".into())),
        rule(Kind::Latency, r"== (\d+)'d(\d+)", |c| {
            let (width, count): (u32, u64) = (c[1].parse().ok()?, c[2].parse().ok()?);
            Some(format!("== {width}'d{}", (count + 1) % (1 << width)))
        }),
    ]
});

/// Every fault of an expression.
pub fn variants(expression: &str) -> Vec<Variant> {
    let of = |rule: &Rule| -> Vec<Variant> {
        let faulty = |captures: Captures| {
            let whole = captures.get(0).expect("a match");
            let instead = (rule.instead)(&captures)?;
            let text =
                format!("{}{instead}{}", &expression[..whole.start()], &expression[whole.end()..]);
            Some(Variant {
                kind: rule.kind,
                printed: whole.as_str().trim().into(),
                instead: instead.trim().into(),
                text,
            })
        };
        rule.shape.captures_iter(expression).filter_map(faulty).collect()
    };
    RULES.iter().flat_map(of).collect()
}
