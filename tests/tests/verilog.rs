// SPDX-License-Identifier: MIT OR Apache-2.0
//! The committed Verilog is what the model prints.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::Format;
use hapticore_hdl::memory::Memory;
use hapticore_hdl::verilog::Design;
use hapticore_rtl::header;

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
    let profile = Profile::bundled(profile).expect("bundled");
    let design = header::design(&profile);
    let header = (header::NAME.to_owned(), header::of_core(&profile, &design));
    design
        .modules
        .into_iter()
        .map(|file| (format!("{}.v", file.name), file.text))
        .chain([header])
        .collect()
}

#[test]
fn the_committed_verilog_is_fresh() {
    for profile in ["small", "standard"] {
        let folder: PathBuf =
            [env!("CARGO_MANIFEST_DIR"), "..", "rtl", "verilog", profile].iter().collect();
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

hapticore_hdl::block! {
    /// A block whose memory has a name that is a word of Verilog.
    struct Keeper("keeper") {}
    submodules {
        table: Memory,
    }
    inputs(keeper) {
        address: keeper.table.address(),
    }
    outputs(keeper) {
        word: keeper.table.format,
    }
    registers(keeper) {}
}

impl Block for Keeper {
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let word = self.table.data(&mut state.submodules.table);
        self.table.read(&mut state.submodules.table, i.address);
        Outputs { word }
    }
}

#[test]
fn a_memory_named_by_a_word_of_the_language_has_one_other_name_throughout() {
    let table = Memory::table("table", Format::unsigned(4, 0), (0..8).map(f64::from).collect());
    let text = &Design::of(&Keeper { table }, "a test").modules[0].text;
    assert!(text.contains("reg [3:0] table_2 [0:7]") && text.contains("table_2[0] = "), "{text}");
    let words = text.split(|letter: char| !(letter.is_alphanumeric() || letter == '_'));
    assert_eq!(words.filter(|word| *word == "table").count(), 0, "{text}");
}
