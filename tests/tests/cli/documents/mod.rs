// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every code block and every command of every document: parsed by the command's own declaration, its files looked
//! for, and run where a run takes a second or so. `DOCUMENTS=all` runs the slow ones, too.
//!
//! `docs/tutorial.md` is followed step by step in `tutorial.rs`; here its commands are parsed.

mod blocks;
mod extract;
mod parse;
mod running;

use std::fs;
use std::path::{Path, PathBuf};

use extract::{Block, Snippet};

/// The page that `tutorial.rs` follows.
const FOLLOWED: &str = "docs/tutorial.md";

/// The project's root.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Pages that users and contributors read. Reports are generated, and the changelog is history.
fn documents() -> Vec<(String, String)> {
    const PAGES: [&str; 6] = [
        "README.md",
        "CONTRIBUTING.md",
        "ARCHITECTURE.md",
        "scene/README.md",
        "rtl/verilog/README.md",
        "synth/README.md",
    ];
    let mut names: Vec<String> = PAGES.map(String::from).to_vec();
    for folder in ["docs", "docs/guide", "docs/guide/reference"] {
        for entry in fs::read_dir(root().join(folder)).expect("documents").flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            names.extend(name.ends_with(".md").then(|| format!("{folder}/{name}")));
        }
    }
    names.sort();
    let read = |name: String| {
        let text = fs::read_to_string(root().join(&name)).expect("a document");
        (name, text)
    };
    names.into_iter().map(read).collect()
}

fn all_blocks() -> Vec<Block> {
    documents().iter().flat_map(|(name, text)| extract::blocks(name, text)).collect()
}

fn all_snippets() -> Vec<Snippet> {
    documents().iter().flat_map(|(name, text)| extract::snippets(name, text)).collect()
}

#[test]
fn every_command_in_a_document_is_one() {
    let snippets = all_snippets();
    let errors: Vec<_> = snippets
        .iter()
        .flat_map(|snippet| {
            parse::errors(snippet)
                .into_iter()
                .map(move |error| format!("{}: {error}", snippet.place))
        })
        .collect();
    assert!(errors.is_empty(), "{}", errors.join("\n"));
    assert!(snippets.len() > 150, "{} commands are found", snippets.len());
}
