// SPDX-License-Identifier: MIT OR Apache-2.0
//! Code on one line, so that a woven file keeps its line numbers.

use proc_macro2::{Delimiter, Spacing, TokenStream, TokenTree};
use std::ops::Range;

/// The code of tokens without its comments and line ends; what starts at the bytes `replaced` is replaced.
pub fn one_line(tokens: TokenStream, replaced: Option<(Range<usize>, &str)>) -> String {
    let mut text = String::new();
    write(tokens, &replaced, &mut text);
    text
}

fn write(tokens: TokenStream, replaced: &Option<(Range<usize>, &str)>, text: &mut String) {
    for token in tokens {
        let place = token.span().byte_range();
        match (&token, replaced) {
            (TokenTree::Punct(_), Some((range, new))) if range.contains(&place.start) => {
                if place.start == range.start {
                    text.push_str(new);
                    text.push(' ');
                }
            }
            (TokenTree::Group(group), _) => {
                let (open, close) = match group.delimiter() {
                    Delimiter::Parenthesis => ("(", ")"),
                    Delimiter::Brace => ("{ ", "}"),
                    Delimiter::Bracket => ("[", "]"),
                    Delimiter::None => ("", ""),
                };
                text.push_str(open);
                write(group.stream(), replaced, text);
                text.push_str(close);
                text.push(' ');
            }
            (TokenTree::Punct(punct), _) => {
                text.push(punct.as_char());
                if punct.spacing() == Spacing::Alone {
                    text.push(' ');
                }
            }
            _ => {
                text.push_str(&token.to_string());
                text.push(' ');
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_operator_is_replaced_and_lines_are_joined() {
        let tokens: TokenStream = "a // first\n  <= b.f(&'x c) &&\n !d".parse().unwrap();
        let text = |replaced| one_line(tokens.clone(), replaced).replace(' ', "");
        assert_eq!(text(None), "a<=b.f(&'xc)&&!d");
        assert_eq!(text(Some((13..15, ">"))), "a>b.f(&'xc)&&!d");
    }
}
