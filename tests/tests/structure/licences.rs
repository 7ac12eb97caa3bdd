// SPDX-License-Identifier: MIT OR Apache-2.0
//! Packages of other authors: how many the command brings, and notices of their licences.

use std::collections::BTreeSet;
use std::process::Command;

use crate::{read, root};

/// The most packages of other authors that are linked for the first result.
const MOST_LINKED: usize = 120;

/// Packages of other authors in the binary of a package, with features, as `name version`.
fn packages_of(package: &str, features: &str) -> BTreeSet<String> {
    let edges = ["--edges", "normal,no-proc-macro", "--prefix", "none", "--format", "{p}"];
    let output = Command::new(env!("CARGO"))
        .current_dir(root())
        .args(["tree", "--locked", "--package", package, "--features", features])
        .args(edges)
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let others = text.lines().filter(|line| !line.contains("(/") && !line.contains('\\'));
    let named = others.filter_map(|line| line.split_once(" v"));
    named.map(|(name, version)| format!("{name} {}", version.replace(" (*)", ""))).collect()
}

/// Packages that a notice names.
fn named_in(notice: &str) -> BTreeSet<String> {
    let text = read(notice);
    let lines = text.lines().filter_map(|line| line.strip_prefix("  "));
    let version = |text: &str| text.starts_with(|c: char| c.is_ascii_digit());
    let packages = lines.filter(|line| {
        line.split_once(' ').is_some_and(|(_, number)| version(number) && !number.contains(' '))
    });
    packages.map(str::to_owned).collect()
}

#[test]
fn notices_of_licences_name_every_package_of_the_binaries() {
    let locked = read("Cargo.lock");
    let binaries = [("hapticore", "boards", "cli"), ("hapticore-python", "", "python")];
    for (package, features, folder) in binaries {
        let notice = format!("{folder}/LICENSE-THIRD-PARTY");
        let (linked, named) = (packages_of(package, features), named_in(&notice));
        assert!(linked.len() > 100, "{package}: {linked:?}");
        let missing: Vec<_> = linked.difference(&named).collect();
        assert!(missing.is_empty(), "{notice} lacks {missing:?}: run cli/licences/write");
        let gone = named.iter().filter(|package| {
            let (name, version) = package.split_once(' ').expect("a name and a version");
            !locked.contains(&format!("name = \"{name}\"\nversion = \"{version}\""))
        });
        let gone: Vec<_> = gone.collect();
        assert!(
            gone.is_empty(),
            "{notice} names {gone:?}, of other versions: run cli/licences/write"
        );
    }
}

#[test]
fn rust_hdl_is_linked_for_boards_alone() {
    let linked = |features: &str| packages_of("hapticore", features);
    let hdl =
        |packages: &BTreeSet<String>| packages.iter().any(|name| name.starts_with("rust-hdl"));
    let (lean, whole) = (linked(""), linked("boards"));
    assert!(hdl(&whole) && !hdl(&lean));
    assert!(lean.len() <= MOST_LINKED, "{} packages: {lean:?}", lean.len());
}
