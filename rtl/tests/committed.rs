// SPDX-License-Identifier: MIT OR Apache-2.0
//! The committed Verilog is what the model prints: the cores of `small` and `standard`, and a force loop
//! with everything that drives pads.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use hapticore_host::profile::load;
use hapticore_rtl::header;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("verilog")
}

fn committed(folder: &Path) -> BTreeMap<String, String> {
    let files = fs::read_dir(folder)
        .unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
        .flatten();
    files
        .map(|file| {
            (
                file.file_name().into_string().expect("a name"),
                fs::read_to_string(file.path()).expect("a text"),
            )
        })
        .collect()
}

fn printed(profile: &str) -> BTreeMap<String, String> {
    let profile = load(profile).expect("a profile");
    let design = header::design(&profile);
    let header = (header::NAME.to_owned(), header::of_core(&profile, &design));
    design
        .modules
        .into_iter()
        .map(|file| (format!("{}.v", file.name), file.text))
        .chain([header])
        .collect()
}

/// Holds that a profile, a bundled name or a file, is printed as it is in a folder.
fn check(profile: &str, name: &str) {
    let (committed, printed) = (committed(&folder().join(name)), printed(profile));
    let names = |files: &BTreeMap<String, String>| files.keys().cloned().collect::<Vec<_>>();
    let of = if profile == name { name } else { "rtl/verilog/loop.toml" };
    let again = format!(
        "is not what the model prints: cargo run --release -- hdl --profile {of} --out rtl/verilog/{name}"
    );
    assert_eq!(names(&committed), names(&printed), "rtl/verilog/{name} {again}");
    for (file, text) in printed {
        assert!(committed[&file] == text, "rtl/verilog/{name}/{file} {again}");
    }
}

#[test]
fn the_committed_cores_are_fresh() {
    for profile in ["small", "standard"] {
        check(profile, profile);
    }
}

#[test]
fn the_committed_force_loop_is_fresh() {
    check(folder().join("loop.toml").to_str().expect("a path"), "loop");
}
