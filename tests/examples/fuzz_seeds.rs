// SPDX-License-Identifier: MIT OR Apache-2.0
//! Writes what fuzzing begins with to `fuzz/corpus/TARGET/`, where cargo-fuzz looks for it:
//! `cargo run --profile checked -p hapticore-tests --example fuzz_seeds` (docs/fuzzing.md). A folder as its
//! argument stands for `fuzz/corpus`.

use std::fs;
use std::path::{Path, PathBuf};

use hapticore_tests::fuzz::{TARGETS, seeds};

fn main() -> std::io::Result<()> {
    let fuzz = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz");
    let corpus = std::env::args().nth(1).map_or_else(|| fuzz.join("corpus"), PathBuf::from);
    for (target, _) in TARGETS {
        let folder = corpus.join(target);
        fs::create_dir_all(&folder)?;
        for (number, seed) in seeds::of(target).iter().enumerate() {
            fs::write(folder.join(format!("seed-{number}")), seed)?;
        }
        for entry in fs::read_dir(fuzz.join("corpus-seed").join(target))? {
            let path = entry?.path();
            fs::copy(&path, folder.join(path.file_name().expect("a file")))?;
        }
    }
    Ok(())
}
