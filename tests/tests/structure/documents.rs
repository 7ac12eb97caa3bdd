// SPDX-License-Identifier: MIT OR Apache-2.0
//! Documents: links, anchors, cited sections and named files exist, and nothing cites a document
//! that is not here.

mod markdown;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

use crate::{read, root};
use markdown::Document;

/// Folders that are not part of the project's sources.
const ELSEWHERE: [&str; 6] = [".git", ".tools", ".venv", "target", "out", "node_modules"];

/// Files that people write, by the end of their name; others hold data.
const TEXTS: [&str; 14] = [
    ".md", ".rs", ".toml", ".v", ".sv", ".py", ".sh", ".core", ".cpp", ".css", "Makefile", "run",
    "test", "tools",
];

/// Every file of the project whose name ends like this, relative to its root.
fn files(ends: &[&str]) -> Vec<PathBuf> {
    let (mut found, mut folders) = (Vec::new(), vec![root()]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder").flatten() {
            let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
            let kind = entry.file_type().expect("a kind of file");
            if kind.is_dir() && !ELSEWHERE.contains(&name.as_str()) {
                folders.push(path);
            } else if kind.is_file() && ends.iter().any(|end| name.ends_with(end)) {
                found.push(path.strip_prefix(root()).expect("below the root").to_owned());
            }
        }
    }
    found.sort();
    found
}

fn documents() -> Vec<(PathBuf, Document)> {
    let documents: Vec<_> = files(&[".md"])
        .into_iter()
        .map(|path| (path.clone(), Document::new(&read(path))))
        .collect();
    assert!(documents.len() > 10, "documents are found");
    documents
}

/// `a/b/../c` as `a/c`.
fn resolved(path: &Path) -> PathBuf {
    let mut parts = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => assert!(parts.pop(), "{} leaves the project", path.display()),
            Component::CurDir => (),
            part => parts.push(part),
        }
    }
    parts
}

/// What is wrong with a relative link of a document; nothing where it leads somewhere.
fn broken(from: &Path, link: &str) -> Option<String> {
    let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
    let to = if file.is_empty() {
        from.to_owned()
    } else {
        resolved(&from.parent().expect("a folder").join(file))
    };
    if !root().join(&to).exists() {
        return Some(format!("{}: ({link}) leads to no file", from.display()));
    }
    let leads = anchor.is_empty() || Document::new(&read(&to)).anchors.contains(anchor);
    (!leads).then(|| format!("{}: ({link}) leads to no heading", from.display()))
}

#[test]
fn every_link_and_anchor_resolves() {
    let mut links = 0;
    let mut errors = Vec::new();
    for (path, document) in documents() {
        for link in document.links.iter().filter(|link| !link.contains("://")) {
            links += 1;
            errors.extend(broken(&path, link));
        }
    }
    assert!(errors.is_empty(), "{}", errors.join("\n"));
    assert!(links > 30, "links are found");
}

#[test]
fn a_broken_link_is_found() {
    let from = Path::new("docs/boards.md");
    assert_eq!(broken(from, "boards.md#the-serial-line"), None);
    for link in [
        "no-such-page.md",
        "boards.md#no-such-heading",
        "#no-such-heading",
        "../docs/no-such-page.md",
    ] {
        assert!(broken(from, link).is_some(), "{link}");
    }
}

#[test]
fn every_cited_section_exists() {
    let mut cited = BTreeSet::new();
    for path in files(&TEXTS) {
        for (document, section) in markdown::citations(&read(&path)) {
            cited.insert((document, section, path.clone()));
        }
    }
    let exists = |document: &String, section: &u32| {
        root().join(document).exists() && Document::new(&read(document)).sections.contains(section)
    };
    let missing = cited.iter().filter(|(document, section, _)| !exists(document, section));
    let errors: Vec<_> = missing
        .map(|(document, section, path)| format!("{} cites {document} §{section}", path.display()))
        .collect();
    assert!(errors.is_empty(), "{}", errors.join("\n"));
    assert!(!cited.is_empty(), "citations are found");
}

#[test]
fn documents_name_files_that_exist() {
    let mut named = 0;
    let mut errors = Vec::new();
    for (path, document) in documents() {
        let folder = path.parent().expect("a folder").to_owned();
        for name in &document.paths {
            let first = Path::new(name).components().next().expect("a name");
            let Some(base) = [Path::new(""), &folder]
                .into_iter()
                .find(|base| root().join(base).join(first).is_dir())
            else {
                continue; // of somebody's own folder, as in an example
            };
            named += 1;
            let generated = ["out/", "target/"].iter().any(|folder| name.starts_with(folder));
            if !generated && !root().join(base).join(name).exists() {
                errors.push(format!("{} names {name}", path.display()));
            }
        }
    }
    assert!(errors.is_empty(), "{}", errors.join("\n"));
    assert!(named > 50, "names of files are found");
}

#[test]
fn architecture_lists_the_crates_of_the_workspace() {
    let manifest = read("Cargo.toml");
    let list = manifest
        .split_once("members = [")
        .and_then(|(_, rest)| rest.split_once(']'))
        .expect("members")
        .0;
    let members: BTreeSet<_> =
        list.split(',').map(|name| name.trim().trim_matches('"').to_string()).collect();
    let architecture = read("ARCHITECTURE.md");
    let table = architecture
        .split("\n## ")
        .find(|section| section.starts_with("Crates\n"))
        .expect("a table of crates");
    let crates = table.split("**API boundaries.**").next().expect("a text");
    let rows = crates.lines().filter_map(|line| line.strip_prefix("| `")?.split_once('`'));
    let listed: BTreeSet<_> = rows.map(|(folder, _)| folder.to_string()).collect();
    assert_eq!(listed, members.into_iter().filter(|name| !name.is_empty()).collect());
}

#[test]
fn the_readme_repeats_rows_of_the_results_page() {
    let (readme, results) = (read("README.md"), read("docs/results.md"));
    let section = readme
        .split("\n## ")
        .find(|section| section.starts_with("Measured results\n"))
        .expect("measured results");
    let rows: Vec<_> = section.lines().filter(|line| line.starts_with("| ")).collect();
    for row in &rows {
        assert!(results.lines().any(|line| line == *row), "docs/results.md has no row {row}");
    }
    assert!(rows.len() > 5, "rows are found");
}

/// The most words of a table's cell.
const CELL: usize = 25;

#[test]
fn cells_of_tables_are_short_in_readme_guide_and_results() {
    let is_of_guide = |path: &PathBuf| path.starts_with("docs/guide");
    let guide = files(&[".md"]).into_iter().filter(is_of_guide);
    let others = ["README.md", "docs/results.md"].map(PathBuf::from);
    for path in guide.chain(others) {
        for (number, line) in read(&path).lines().enumerate() {
            let row = line.strip_prefix("| ").unwrap_or_default().replace("\\|", " ");
            for cell in row.split('|') {
                let words = cell.split_whitespace().count();
                let place = format!("{}:{}", path.display(), number + 1);
                assert!(words <= CELL, "{place}: {words} words in a cell:{cell}");
            }
        }
    }
}

/// Working papers of the developers, which users do not have.
const ABSENT: [&str; 5] = [
    concat!("PHY", "SICS"),
    concat!("DES", "IGN"),
    concat!("TER", "MS"),
    concat!("PROTO", "TYPES"),
    concat!("STYLE", ".md"),
];

#[test]
fn nothing_cites_a_document_that_is_not_here() {
    let mut errors = Vec::new();
    for path in files(&TEXTS) {
        for (number, line) in read(&path).lines().enumerate() {
            let words = line.split(|c: char| !c.is_ascii_alphanumeric() && c != '_' && c != '.');
            let cited =
                words.map(|word| word.trim_end_matches('.')).find(|word| ABSENT.contains(word));
            errors.extend(cited.map(|word| format!("{}:{}: {word}", path.display(), number + 1)));
        }
    }
    assert!(errors.is_empty(), "{}", errors.join("\n"));
}

/// Set by the system, by cargo, or by a test program for itself.
const NOT_FOR_USERS: [&str; 7] = [
    "PATH",
    "HOSTNAME",
    "COMPUTERNAME",
    "OPT_LEVEL",
    "HAPTICORE_MUTANT",
    "HAPTICORE_MUTANTS",
    "HAPTICORE_PLANTED",
];

#[test]
fn contributing_lists_the_variables_that_tests_read() {
    let (listed, mut read_by_tests) = (read("CONTRIBUTING.md"), BTreeSet::new());
    for path in files(&[".rs"]) {
        let text = read(path);
        let calls = ["env::var(\"", "env::var_os(\"", "given(\"", "number(\""];
        let names = calls.iter().flat_map(|call| text.split(call).skip(1));
        let names = names.filter_map(|rest| rest.split('"').next());
        let is_variable = |name: &&str| name.chars().all(|c| c.is_ascii_uppercase() || c == '_');
        read_by_tests.extend(names.filter(is_variable).map(str::to_owned));
    }
    assert!(read_by_tests.len() > 15, "variables are found");
    for name in read_by_tests.iter().filter(|name| !NOT_FOR_USERS.contains(&name.as_str())) {
        let is_listed = ["=", "`"].iter().any(|end| listed.contains(&format!("`{name}{end}")));
        assert!(is_listed, "CONTRIBUTING.md lacks {name}");
    }
}
