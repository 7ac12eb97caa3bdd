// SPDX-License-Identifier: MIT OR Apache-2.0
//! The statements of a printed module that compute something.

use std::collections::HashSet;
use std::sync::LazyLock;

use regex::{Captures, Regex};

/// A statement of the printed Verilog.
#[allow(missing_docs, reason = "fields are what their names say")]
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Statement {
    /// A wire with what drives it; the range has the sign in front and a space behind.
    Wire { range: String, name: String, value: String },
    /// A wire that an instance drives.
    Driven { range: String, name: String },
    /// An output with what drives it.
    Output { name: String, value: String },
    /// A register with what it takes at a clock.
    Register { name: String, value: String },
    /// A condition that registers hang on; the rest of its line.
    Condition { value: String, rest: String },
    /// Anything else, as it stands.
    Other(String),
}

type Reading = fn(&Captures) -> Statement;

/// Shapes of a statement, comments taken away, with what it is.
static SHAPES: LazyLock<Vec<(Regex, Reading)>> = LazyLock::new(|| {
    let shapes: [(&str, Reading); 5] = [
        (r"(?s)^wire ((?:signed )?(?:\[\d+:0\] )?)(\w+) =\s+(.*);$", |c| Statement::Wire {
            range: c[1].into(),
            name: c[2].into(),
            value: c[3].into(),
        }),
        (r"^wire ((?:signed )?(?:\[\d+:0\] )?)(\w+);$", |c| Statement::Driven {
            range: c[1].into(),
            name: c[2].into(),
        }),
        (r"(?s)^assign (\w+) =\s+(.*);$", |c| Statement::Output {
            name: c[1].into(),
            value: c[2].into(),
        }),
        (r"(?s)^(\w+(?:\[.*\])?) <=\s+(.*);$", |c| Statement::Register {
            name: c[1].into(),
            value: c[2].into(),
        }),
        (r"^((?:end else )?if) \((.*)\) (begin|\w+\[.*;)$", |c| Statement::Condition {
            value: c[2].into(),
            rest: format!("{}\n{}", &c[1], &c[3]),
        }),
    ];
    shapes.map(|(shape, of)| (Regex::new(shape).expect("an expression"), of)).into()
});

/// The text of a module, below its ports, as statements.
///
/// # Panics
/// Where a line computes something in a shape that is not known here, so that no operator is left
/// out unseen. (What stands in the port list of an instance is left out.)
pub fn statements(module: &str) -> Vec<Statement> {
    let mut all = Vec::new();
    let mut open = String::new();
    for line in module.lines() {
        let code = line.split(" // ").next().unwrap_or_default().trim();
        let continued = !open.is_empty() || (begins(code) && !code.ends_with(';'));
        if continued {
            open += if open.is_empty() { "" } else { "\n" };
            open += code;
        }
        match (continued, code.ends_with(';')) {
            (true, false) => (),
            (true, true) => all.push(read(&std::mem::take(&mut open))),
            _ => all.push(read(code)),
        }
    }
    all
}

/// Whether a line without its end is a statement that goes on below.
fn begins(code: &str) -> bool {
    code.ends_with('=') || code.starts_with("wire unused")
}

fn read(code: &str) -> Statement {
    if code.starts_with("wire unused") || code.starts_with("if (reset)") {
        return Statement::Other(code.into());
    }
    let found =
        SHAPES.iter().find_map(|(shape, of)| shape.captures(code).map(|captures| of(&captures)));
    found.unwrap_or_else(|| {
        let plain = ["for (", "."].iter().any(|start| code.starts_with(start));
        assert!(
            plain || ![" + ", " - ", " * ", " < ", " ? "].iter().any(|sign| code.contains(sign)),
            "unknown: {code}"
        );
        Statement::Other(code.into())
    })
}

/// What a module's wire `unused` names: `name[high:low]`, or a name.
pub fn unused(module: &str) -> HashSet<String> {
    let list =
        module.split_once("wire unused = &{1'b0, ").and_then(|(_, rest)| rest.split_once('}'));
    list.map(|(list, _)| list.split(',').map(|part| part.trim().to_owned()).collect())
        .unwrap_or_default()
}
