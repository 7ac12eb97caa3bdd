// SPDX-License-Identifier: MIT OR Apache-2.0
//! Invariants of ARCHITECTURE.md that a compiler does not hold.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Which crates of the workspace a crate may use.
const IMPORTS: [(&str, &[&str]); 10] = [
    ("model", &[]),
    ("host/protocol", &["hapticore-model"]),
    ("host", &["hapticore-model", "hapticore-protocol", "hapticore-sheet"]),
    ("rtl", &["hapticore-model", "hapticore-protocol"]),
    ("synth", &["hapticore-files", "hapticore-model", "hapticore-rtl"]),
    ("scene/sheet", &[]),
    ("scene", &["hapticore-sheet"]),
    ("cli/files", &[]),
    ("waveforms", &["hapticore-files", "hapticore-model"]),
    ("cli/run", &["hapticore-files", "hapticore-host", "hapticore-model", "hapticore-scene"]),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace").into()
}

fn read(path: impl AsRef<Path>) -> String {
    fs::read_to_string(root().join(&path)).unwrap_or_else(|error| panic!("{}: {error}", path.as_ref().display()))
}

/// The Rust files below a folder.
fn sources(folder: &str) -> Vec<PathBuf> {
    let (mut found, mut folders) = (Vec::new(), vec![root().join(folder)]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder").flatten() {
            let path = entry.path();
            match path.is_dir() {
                true => folders.push(path),
                false if path.extension().is_some_and(|extension| extension == "rs") => found.push(path),
                false => (),
            }
        }
    }
    found
}

#[test]
fn imports_run_one_way() {
    for (name, may_use) in IMPORTS {
        let manifest = read(format!("{name}/Cargo.toml"));
        // Tests of boards take the host's side of the line, those of scenes its crosstalk cancellation.
        let manifest = manifest.split("[dev-dependencies]").next().expect("a first part");
        let uses = manifest.lines().filter_map(|line| line.split(['=', '.']).next()).map(str::trim);
        let uses: BTreeSet<_> = uses.filter(|line| line.starts_with("hapticore-")).collect();
        assert_eq!(uses, may_use.iter().copied().collect(), "{name}/Cargo.toml");
    }
}

#[test]
fn the_reference_shares_no_code_with_the_blocks() {
    for path in sources("model/src/reference") {
        let text = fs::read_to_string(&path).expect("a source");
        for module in
            ["crate::signal", "crate::blocks", "crate::block", "crate::memory", "crate::fidelity", "crate::proof"]
        {
            // Names of a frame's words are declarations, not behaviour.
            let text = text.replace("crate::blocks::frames::Field", "");
            assert!(!text.contains(module), "{} uses {module}", path.display());
        }
    }
}

#[test]
fn the_model_knows_no_files_and_no_time() {
    for path in sources("model/src") {
        let text = fs::read_to_string(&path).expect("a source");
        for absent in ["std::fs", "std::io", "std::time", "std::path"] {
            assert!(!text.contains(absent), "{} uses {absent}", path.display());
        }
    }
}

#[test]
fn every_source_names_its_licence() {
    for folder in ["model", "rtl", "synth", "scene", "waveforms", "host", "cli", "tests"] {
        for path in sources(folder) {
            let text = fs::read_to_string(&path).expect("a source");
            assert!(text.starts_with("// SPDX-License-Identifier: MIT OR Apache-2.0"), "{}", path.display());
        }
    }
}

#[test]
fn the_readme_names_files_that_are_there() {
    for document in ["README.md", "ARCHITECTURE.md"] {
        let text = read(document);
        for path in text
            .split(['(', ')', '`'])
            .filter(|word| word.contains('/') && !word.contains(char::is_whitespace) && !word.contains(['*', '…', ':']))
        {
            let path = path.split('#').next().unwrap_or(path);
            let generated = ["out/", "target/", "./", "rtl/", "synth/"].iter().any(|folder| path.starts_with(folder));
            assert!(generated || root().join(path).exists(), "{document} names {path}");
        }
    }
}
