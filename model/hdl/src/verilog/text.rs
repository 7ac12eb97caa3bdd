// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pieces of Verilog text: constants, expressions and how they bind.

/// An expression in Verilog; its width and sign are those of the wire it stands for.
#[derive(Debug, Clone)]
pub struct Text {
    /// Verilog text of the expression.
    pub text: String,
    /// Precedence class of the expression.
    pub kind: Kind,
}

/// How an expression binds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A name, a literal, a concatenation.
    Atom,
    /// `c ? a : b`.
    Select,
    /// With any other operator.
    Operation,
}

impl Text {
    pub fn atom(text: impl Into<String>) -> Text {
        Text { text: text.into(), kind: Kind::Atom }
    }

    pub fn operation(text: String) -> Text {
        Text { text, kind: Kind::Operation }
    }

    /// The text as an operand, in parentheses where needed.
    pub fn operand(&self) -> String {
        if self.kind == Kind::Atom { self.text.clone() } else { format!("({})", self.text) }
    }
}

/// A sized constant: negative codes as the bits they are.
pub fn literal(code: i64, width: u8) -> String {
    if code < 0 { bits(code as u64, width) } else { format!("{width}'d{code}") }
}

/// A sized constant by its bits.
pub fn bits(code: u64, width: u8) -> String {
    let mask = u64::MAX >> (64 - u32::from(width));
    format!("{width}'h{:0digits$x}", code & mask, digits = usize::from(width).div_ceil(4))
}

/// An expression as it stands behind `=`, on the same line or with its alternatives one below the
/// other.
pub fn broken(text: &Text, indent: usize) -> String {
    if text.kind != Kind::Select || text.text.len() < 80 {
        return format!(" {}", text.text);
    }
    let line = format!("\n{:indent$}", "");
    line.clone() + &text.text.replace(BREAK, &line)
}

/// A space where a line may end: before the other alternative.
pub const BREAK: char = '\u{b}';

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alternatives_are_on_one_line_up_to_79_characters() {
        let text = |kind, length: usize| Text {
            kind,
            text: "a ? b".to_string() + &"b".repeat(length - 7) + &BREAK.to_string() + ":",
        };
        assert!(!broken(&text(Kind::Select, 79), 4).contains('\n'));
        assert!(broken(&text(Kind::Select, 80), 4).contains("\n    :"));
        assert!(!broken(&text(Kind::Operation, 80), 4).contains('\n'));
    }
}
