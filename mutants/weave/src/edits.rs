// SPDX-License-Identifier: MIT OR Apache-2.0
//! Changes of a source text, some within others.

use std::cmp::Reverse;
use std::ops::Range;

/// What takes the place of a part of the source.
pub struct Edit {
    /// Bytes of the source; an empty range is an insertion.
    pub range: Range<usize>,
    /// The new text, in order.
    pub pieces: Vec<Piece>,
}

/// A part of a new text.
pub enum Piece {
    /// As it is.
    Text(String),
    /// Bytes of the source, with the edits that lie within them.
    Source(Range<usize>),
}

impl Edit {
    /// Text before and behind a part of the source that stays.
    pub fn around(range: Range<usize>, before: String, behind: String) -> Self {
        let pieces = vec![Piece::Text(before), Piece::Source(range.clone()), Piece::Text(behind)];
        Edit { range, pieces }
    }

    /// Text at a place.
    pub fn insertion(at: usize, text: String) -> Self {
        Edit { range: at..at, pieces: vec![Piece::Text(text)] }
    }
}

/// The source with all edits. Of two edits one holds the other, or they do not overlap.
pub fn apply(source: &str, edits: &[Edit]) -> String {
    let mut sorted: Vec<&Edit> = edits.iter().collect();
    sorted.sort_by_key(|edit| (edit.range.start, !edit.range.is_empty(), Reverse(edit.range.end)));
    let mut text = String::with_capacity(2 * source.len());
    render(source, &sorted, 0..source.len(), &mut text);
    text
}

fn render(source: &str, edits: &[&Edit], range: Range<usize>, text: &mut String) {
    let (mut at, mut rest) = (range.start, edits);
    while let [edit, behind @ ..] = rest {
        text.push_str(&source[at..edit.range.start]);
        let within = behind.iter().take_while(|other| other.range.start < edit.range.end).count();
        for piece in &edit.pieces {
            match piece {
                Piece::Text(new) => text.push_str(new),
                Piece::Source(part) => {
                    let holds = |other: &&&Edit| {
                        part.start <= other.range.start && other.range.end <= part.end
                    };
                    let inner: Vec<_> = behind[..within].iter().filter(holds).copied().collect();
                    render(source, &inner, part.clone(), text);
                }
            }
        }
        (at, rest) = (edit.range.end, &behind[within..]);
    }
    text.push_str(&source[at..range.end]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_nest_and_follow_each_other() {
        let around = |range, before: &str, behind: &str| {
            Edit::around(range, before.to_string(), behind.to_string())
        };
        let edits = [
            around(4..5, "<", ">"),
            around(0..5, "(", ")"),
            Edit::insertion(0, "first ".to_string()),
            around(8..9, "[", "]"),
            around(0..1, "{", "}"),
        ];
        assert_eq!(apply("a + b - c", &edits), "first ({a} + <b>) - [c]");
    }
}
