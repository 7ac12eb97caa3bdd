// SPDX-License-Identifier: MIT OR Apache-2.0
//! The committed Verilog is what the model prints.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use hapticore_model::profile::Profile;
use hapticore_rtl::verilog::Design;

fn committed(folder: &Path) -> BTreeMap<String, String> {
    let files = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())).flatten();
    files
        .map(|file| (file.file_name().into_string().expect("a name"), fs::read_to_string(file.path()).expect("a text")))
        .collect()
}

fn printed(profile: &str) -> BTreeMap<String, String> {
    let design = Design::of_core(&Profile::bundled(profile).expect("bundled"));
    design.modules.into_iter().map(|file| (format!("{}.v", file.name), file.text)).collect()
}

#[test]
fn the_committed_verilog_is_fresh() {
    for profile in ["small", "standard"] {
        let folder: PathBuf = [env!("CARGO_MANIFEST_DIR"), "..", "rtl", "verilog", profile].iter().collect();
        let (committed, printed) = (committed(&folder), printed(profile));
        let names = |files: &BTreeMap<String, String>| files.keys().cloned().collect::<Vec<_>>();
        let again = format!(
            "is not what the model prints: cargo run --release -- hdl --profile {profile} --out rtl/verilog/{profile}"
        );
        assert_eq!(names(&committed), names(&printed), "rtl/verilog/{profile} {again}");
        for (name, text) in printed {
            assert!(committed[&name] == text, "rtl/verilog/{profile}/{name} {again}");
        }
    }
}
