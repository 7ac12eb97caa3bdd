// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Verilog that a report is about.

use hapticore_hdl::verilog::Design;
#[cfg(feature = "boards")]
use hapticore_rtl::board::target::{Printed, Target};

/// A file by name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct File {
    /// Name of the module and file.
    pub name: String,
    /// What stands in it.
    pub text: String,
}

/// The files of a printed design.
pub fn files(design: &Design) -> Vec<File> {
    design
        .modules
        .iter()
        .map(|file| File { name: format!("{}.v", file.name), text: file.text.clone() })
        .collect()
}

/// The Verilog of a board's top and all within it, and its constraints.
#[cfg(feature = "boards")]
pub fn board(target: Target) -> Vec<File> {
    let Printed { verilog, constraints: (name, text) } = target.bundled();
    vec![File { name: "top.v".into(), text: verilog }, File { name, text }]
}

/// A hash of bytes that does not change with the compiler: FNV-1a, 64 bits.
pub fn hash(bytes: impl IntoIterator<Item = u8>) -> String {
    let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    format!("{:016x}", bytes.into_iter().fold(0xcbf2_9ce4_8422_2325, step))
}

/// The hash of what tools read of files, whichever order the files come in: comments (`//` to the
/// end of the line) and blank lines do not count.
pub fn hash_of(files: &[File]) -> String {
    let mut all: Vec<_> =
        files.iter().map(|file| format!("{}\0{}\0", file.name, code(&file.text))).collect();
    all.sort();
    hash(all.concat().into_bytes())
}

/// The lines of a text without comments and what they leave blank. A line without a comment stays
/// as it is.
fn code(text: &str) -> String {
    let uncommented = |line: &str| {
        line.split_once("//").map_or(line.to_owned(), |(code, _)| code.trim_end().to_owned())
    };
    text.lines()
        .map(uncommented)
        .filter(|line| !line.trim().is_empty())
        .map(|line| line + "\n")
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_fnv() {
        assert_eq!(hash([]), "cbf29ce484222325");
        assert_eq!(hash(*b"foobar"), "85944171f73967e8");
    }

    #[test]
    fn the_hash_follows_names_and_texts_and_not_their_order() {
        let file = |name: &str, text: &str| File { name: name.into(), text: text.into() };
        let (a, b) = (file("a.v", "x"), file("b.v", "y"));
        assert_eq!(hash_of(&[a.clone(), b.clone()]), hash_of(&[b.clone(), a.clone()]));
        assert_ne!(hash_of(&[a.clone(), b]), hash_of(&[file("a.v", "y"), file("b.v", "x")]));
        assert_ne!(hash_of(&[a]), hash_of(&[file("a.v", "x ")]));
    }

    #[test]
    fn the_hash_ignores_comments_and_blank_lines_only() {
        let hash = |text: &str| hash_of(&[File { name: "a.v".into(), text: text.into() }]);
        let plain = hash("module a;\n  wire b = c / d;\nendmodule\n");
        assert_eq!(
            plain,
            hash(
                "// Version 2\n\nmodule a; // all of it\n  wire b = c / d;\n  // e\n\nendmodule // a\n"
            )
        );
        assert_ne!(
            plain,
            hash("module a;\n  wire b = c // d;\nendmodule\n"),
            "what a comment hides is missing"
        );
        assert_ne!(plain, hash("module a;\n  wire b = c / e;\nendmodule\n"));
    }
}
