// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the value of a key may be, and what is read where a scene does not have it.

use std::fmt;

use super::limits::{Limits, short};

/// What the value of a key may be.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// Text.
    Text,
    /// True or false.
    Flag,
    /// A number.
    Number(Limits),
    /// An integer, from the least to the greatest.
    Whole(u64, u64),
    /// One of a list of words.
    Words(fn() -> Vec<&'static str>),
    /// A list of texts.
    Texts,
    /// A list of numbers.
    Numbers(Limits),
    /// A number, or a list of them.
    OneOrSeveral(Limits),
    /// Two numbers.
    Pair(Limits),
    /// A list of pairs of numbers.
    Pairs,
    /// A number, a sweep, or a function of time.
    Stimulus(Limits),
    /// A number, or a function of time.
    OverTime(Limits),
    /// A place, a sweep over places, or a path.
    Position,
    /// Keys of the scene, each with the value that it gets.
    Keys,
    /// Quantities, each with the range that it must lie in.
    Ranges,
}

/// What is read where a scene does not have a key.
#[derive(Clone, Copy, Debug)]
pub enum Otherwise {
    /// Nothing: the key switches something on.
    Nothing,
    /// An error, which says that this was expected.
    Required(&'static str),
    /// What follows from other keys, in words.
    Follows(&'static str),
    /// A number.
    Number(f64),
    /// An integer.
    Whole(u64),
    /// A word or a text.
    Word(&'static str),
    /// Numbers.
    Numbers(&'static [f64]),
}

/// What the value may be, in few words.
impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Kind::Text => f.write_str("text"),
            Kind::Flag => f.write_str("true or false"),
            Kind::Number(limits) => f.write_str(&limits.short()),
            Kind::Whole(low, high) => write!(f, "integer, {low} to {high}"),
            Kind::Words(words) => f.write_str(&words().join(", ")),
            Kind::Texts => f.write_str("list of texts"),
            Kind::Numbers(limits) => write!(f, "list, each {}", limits.short()),
            Kind::OneOrSeveral(limits) => write!(f, "{}, or a list", limits.short()),
            Kind::Pair(limits) => write!(f, "two numbers, {}", limits.short()),
            Kind::Pairs => f.write_str("list of pairs"),
            Kind::Stimulus(limits) => write!(f, "{}, a sweep or over time", limits.short()),
            Kind::OverTime(limits) => write!(f, "{}, or over time", limits.short()),
            Kind::Position => f.write_str("[x, y], a sweep or a path"),
            Kind::Keys => f.write_str("keys with their values"),
            Kind::Ranges => f.write_str("quantities with ranges"),
        }
    }
}

/// What is read, in few words.
impl fmt::Display for Otherwise {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Otherwise::Nothing => f.write_str("none"),
            Otherwise::Required(_) => f.write_str("required"),
            Otherwise::Follows(what) => f.write_str(what),
            Otherwise::Number(number) => f.write_str(&short(*number)),
            Otherwise::Whole(whole) => write!(f, "{whole}"),
            Otherwise::Word(word) => write!(f, "\"{word}\""),
            Otherwise::Numbers(numbers) => {
                let numbers: Vec<_> = numbers.iter().map(|number| short(*number)).collect();
                write!(f, "[{}]", numbers.join(", "))
            }
        }
    }
}
