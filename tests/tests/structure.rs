// SPDX-License-Identifier: MIT OR Apache-2.0
//! Invariants of ARCHITECTURE.md that a compiler does not hold.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use toml::{Table, Value};

/// Which crates of the workspace a crate may use; tests may use more ([`DEVELOPMENT`]).
const IMPORTS: [(&str, &[&str]); 21] = [
    ("model/hdl", &[]),
    ("model/contract", &["hapticore-hdl"]),
    // Not the hardware language: its signals round, too.
    ("model/reference", &["hapticore-contract"]),
    ("model", &["hapticore-contract", "hapticore-hdl"]),
    ("model/proof", &["hapticore-contract", "hapticore-hdl", "hapticore-model"]),
    ("host/protocol", &["hapticore-contract", "hapticore-hdl"]),
    ("host", &["hapticore-contract", "hapticore-protocol", "hapticore-sheet"]),
    ("rtl", &["hapticore-contract", "hapticore-hdl", "hapticore-model", "hapticore-protocol"]),
    (
        "synth",
        &[
            "hapticore-contract",
            "hapticore-files",
            "hapticore-hdl",
            "hapticore-model",
            "hapticore-rtl",
        ],
    ),
    ("scene/sheet", &[]),
    ("scene", &["hapticore-sheet"]),
    ("cli/files", &[]),
    (
        "cli/board",
        &[
            "hapticore-contract",
            "hapticore-host",
            "hapticore-live",
            "hapticore-model",
            "hapticore-protocol",
            "hapticore-run",
            "hapticore-scene",
        ],
    ),
    ("cli/live", &["hapticore-host", "hapticore-run", "hapticore-scene"]),
    ("waveforms", &["hapticore-files", "hapticore-hdl"]),
    (
        "cli/run",
        &[
            "hapticore-contract",
            "hapticore-files",
            "hapticore-hdl",
            "hapticore-host",
            "hapticore-model",
            "hapticore-reference",
            "hapticore-scene",
        ],
    ),
    ("cli/report", &["hapticore-host", "hapticore-run"]),
    (
        "cli/tradeoff",
        &[
            "hapticore-contract",
            "hapticore-hdl",
            "hapticore-model",
            "hapticore-rtl",
            "hapticore-run",
            "hapticore-scene",
            "hapticore-synth",
        ],
    ),
    (
        "cli/sweep",
        &[
            "hapticore-contract",
            "hapticore-files",
            "hapticore-hdl",
            "hapticore-host",
            "hapticore-model",
            "hapticore-run",
            "hapticore-scene",
            "hapticore-tradeoff",
        ],
    ),
    (
        "python",
        &[
            "hapticore-board",
            "hapticore-contract",
            "hapticore-hdl",
            "hapticore-host",
            "hapticore-live",
            "hapticore-model",
            "hapticore-report",
            "hapticore-run",
            "hapticore-scene",
            "hapticore-tradeoff",
        ],
    ),
    (
        "cli",
        &[
            "hapticore-board",
            "hapticore-contract",
            "hapticore-files",
            "hapticore-hdl",
            "hapticore-host",
            "hapticore-live",
            "hapticore-model",
            "hapticore-report",
            "hapticore-rtl",
            "hapticore-run",
            "hapticore-scene",
            "hapticore-sweep",
            "hapticore-tradeoff",
            "hapticore-waveforms",
        ],
    ),
];

/// What the tests of a crate use besides.
///
/// Tests of boards take the host's side of the line, those of scenes its crosstalk cancellation, those of virtual boards
/// the gateware; other lock-ins have the estimator of the reference behind them. Tests of reports make up settings of a
/// scene.
const DEVELOPMENT: [(&str, &[&str]); 7] = [
    ("cli/board", &["hapticore-hdl", "hapticore-rtl"]),
    ("cli/report", &["hapticore-scene"]),
    ("cli/tradeoff", &["hapticore-reference"]),
    ("model", &["hapticore-reference"]),
    ("model/proof", &["hapticore-rtl"]),
    ("rtl", &["hapticore-host"]),
    ("scene", &["hapticore-host"]),
];

/// What a crate must not reach by any path of dependencies, tests included: the reference, and what
/// it is made of, cannot see the core, and the core is built without the reference. A program
/// beside a board links no core.
const UNREACHABLE: [(&str, bool, &str); 5] = [
    ("hapticore-host", true, "hapticore-model"),
    ("hapticore-reference", true, "hapticore-model"),
    ("hapticore-contract", true, "hapticore-model"),
    ("hapticore-hdl", true, "hapticore-model"),
    ("hapticore-model", false, "hapticore-reference"),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace").into()
}

fn read(path: impl AsRef<Path>) -> String {
    fs::read_to_string(root().join(&path))
        .unwrap_or_else(|error| panic!("{}: {error}", path.as_ref().display()))
}

/// The Rust files below a folder.
fn sources(folder: &str) -> Vec<PathBuf> {
    let (mut found, mut folders) = (Vec::new(), vec![root().join(folder)]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder").flatten() {
            let path = entry.path();
            match path.is_dir() {
                true => folders.push(path),
                false if path.extension().is_some_and(|extension| extension == "rs") => {
                    found.push(path)
                }
                false => (),
            }
        }
    }
    found
}

/// The manifests of the workspace's crates, by folder.
fn manifests() -> BTreeMap<String, Table> {
    let workspace: Table = read("Cargo.toml").parse().expect("TOML");
    let members = workspace["workspace"]["members"].as_array().expect("a list of folders");
    let folders = members.iter().map(|folder| folder.as_str().expect("a folder").to_string());
    folders
        .map(|folder| (folder.clone(), read(format!("{folder}/Cargo.toml")).parse().expect("TOML")))
        .collect()
}

fn name(manifest: &Table) -> &str {
    manifest["package"]["name"].as_str().expect("a name")
}

/// The workspace's crates in a table of a manifest: `dependencies`, `dev-dependencies`,
/// `build-dependencies`, also those of one target alone.
fn uses(manifest: &Table, kind: &str) -> BTreeSet<String> {
    let targets =
        manifest.get("target").and_then(Value::as_table).into_iter().flat_map(Table::values);
    let tables = targets.filter_map(Value::as_table).chain([manifest]);
    let dependencies = tables.filter_map(|table| table.get(kind)?.as_table()).flatten();
    let real = |(name, value): (&String, &Value)| {
        let renamed = value.get("package").and_then(Value::as_str).map(str::to_string);
        renamed.unwrap_or_else(|| name.clone())
    };
    dependencies.map(real).filter(|name| name.starts_with("hapticore")).collect()
}

/// All that a crate is built from, by any path; with its own tests' dependencies, too.
fn reached(manifests: &BTreeMap<String, Table>, from: &str, tests: bool) -> BTreeSet<String> {
    let of = |crate_name: &str, tests: bool| -> BTreeSet<String> {
        let manifest = manifests.values().find(|manifest| name(manifest) == crate_name);
        let manifest = manifest.unwrap_or_else(|| panic!("no crate {crate_name}"));
        let kinds = ["dependencies", "build-dependencies"]
            .into_iter()
            .chain(tests.then_some("dev-dependencies"));
        kinds.flat_map(|kind| uses(manifest, kind)).collect()
    };
    let (mut found, mut left) = (BTreeSet::new(), of(from, tests));
    while let Some(next) = left.pop_first() {
        if found.insert(next.clone()) {
            left.extend(of(&next, false));
        }
    }
    found
}

#[test]
fn imports_run_one_way() {
    let manifests = manifests();
    for (folder, may_use) in IMPORTS {
        let manifest = &manifests[folder];
        let expected =
            |list: &[&str]| list.iter().map(|name| name.to_string()).collect::<BTreeSet<_>>();
        assert_eq!(uses(manifest, "dependencies"), expected(may_use), "{folder}/Cargo.toml");
        let own = DEVELOPMENT
            .iter()
            .find(|(tested, _)| *tested == folder)
            .map_or(&[][..], |(_, uses)| uses);
        let besides = &uses(manifest, "dev-dependencies") - &expected(may_use);
        assert_eq!(besides, expected(own), "{folder}/Cargo.toml, dev-dependencies");
    }
}

#[test]
fn the_reference_cannot_see_the_core() {
    let manifests = manifests();
    for (from, tests, unreachable) in UNREACHABLE {
        let reached = reached(&manifests, from, tests);
        assert!(
            !reached.contains(unreachable),
            "{from} reaches {unreachable}, by way of {reached:?}"
        );
    }
}

#[test]
fn a_path_through_other_crates_is_found() {
    let mut manifests = manifests();
    let contract = manifests.get_mut("model/contract").expect("the contract");
    let (by_way_of, any) = ("hapticore-rtl".to_string(), Value::String("*".into()));
    contract["dependencies"].as_table_mut().expect("dependencies").insert(by_way_of, any);
    assert!(reached(&manifests, "hapticore-reference", false).contains("hapticore-model"));
}

#[test]
fn the_model_knows_no_files_and_no_time() {
    let folders = ["model/src", "model/hdl/src", "model/contract/src", "model/reference/src"];
    for path in folders.into_iter().flat_map(sources) {
        let text = fs::read_to_string(&path).expect("a source");
        for absent in ["std::fs", "std::io", "std::time", "std::path"] {
            assert!(!text.contains(absent), "{} uses {absent}", path.display());
        }
    }
}

#[test]
fn every_source_names_its_licence() {
    for folder in
        ["model", "rtl", "synth", "scene", "waveforms", "host", "cli", "python/src", "tests"]
    {
        for path in sources(folder) {
            let text = fs::read_to_string(&path).expect("a source");
            assert!(
                text.starts_with("// SPDX-License-Identifier: MIT OR Apache-2.0"),
                "{}",
                path.display()
            );
        }
    }
}

/// A patch that no longer applies judges nothing.
#[test]
fn each_fault_of_the_drive_can_be_put_back() {
    let folder = root().join("mutants/mended");
    let patches: Vec<_> = fs::read_dir(&folder)
        .expect("patches")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    assert!(patches.len() >= 10, "{}", patches.len());
    for patch in patches {
        let mut git = Command::new("git");
        let checked = git.current_dir(root()).args(["apply", "--check"]).arg(&patch).output();
        let checked = checked.expect("git");
        let errors = String::from_utf8_lossy(&checked.stderr);
        assert!(checked.status.success(), "{}: {errors}", patch.display());
    }
}

#[test]
fn crates_with_debug_assertions_are_tested_with_them() {
    let workspace: Table = read("Cargo.toml").parse().expect("TOML");
    let of_crates = &workspace["profile"]["checked"]["package"];
    let asserts = |path: &PathBuf| read(path).contains("debug_assert");
    let mut found = 0;
    for member in workspace["workspace"]["members"].as_array().expect("members") {
        let folder = member.as_str().expect("a folder");
        if sources(&format!("{folder}/src")).iter().any(asserts) {
            let manifest: Table = read(format!("{folder}/Cargo.toml")).parse().expect("TOML");
            let name = manifest["package"]["name"].as_str().expect("a name");
            let on = of_crates.get(name).and_then(|of| of.get("debug-assertions"));
            assert_eq!(on, Some(&Value::Boolean(true)), "[profile.checked.package.{name}]");
            found += 1;
        }
    }
    assert!(found > 4, "crates with assertions are found: {found}");
}

#[path = "structure/documents.rs"]
mod documents;
#[path = "structure/licences.rs"]
mod licences;
