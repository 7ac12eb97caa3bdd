// SPDX-License-Identifier: MIT OR Apache-2.0
//! The copy of the tree into which mutants are woven. A file that stays the same is not written, so that
//! nothing is built twice.

use anyhow::{Context, Result, ensure};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{fs, io};

/// Where the copy is, from the root of the tree.
pub const WOVEN: &str = "target/mutants/woven";

/// The crate that has the switch of mutants; all others that have mutants use it.
const SWITCHED: &str = "model/hdl/src";

/// Build scripts that tell tests that code is optimised: here they take as few operations as in a build
/// that is not (docs/mutation.md).
const SCRIPTS: [&str; 2] = ["model/build.rs", "model/hdl/build.rs"];
const SCRIPT: &str = "fn main() {\n    println!(\"cargo::rustc-check-cfg=cfg(optimised)\");\n}\n";

/// What makes a core one piece, which with mutants in it takes the compiler gigabytes.
const ALWAYS: &str = "#[inline(always)]";

/// Copies what git does not ignore, but for the files that are woven.
pub fn copy(woven: &BTreeSet<String>) -> Result<()> {
    let listed = Command::new("git").args(["ls-files", "-zco", "--exclude-standard"]).output()?;
    ensure!(listed.status.success(), "git ls-files does not succeed");
    let listed = String::from_utf8(listed.stdout)?;
    let files: BTreeSet<&str> =
        listed.split_terminator('\0').filter(|file| Path::new(file).is_file()).collect();
    for file in files.iter().filter(|file| !woven.contains(**file)) {
        let mut content = fs::read(file)?;
        if SCRIPTS.contains(file) {
            content = SCRIPT.into();
        } else if *file == format!("{SWITCHED}/lib.rs") {
            content.extend(
                b"\nextern crate self as hapticore_hdl;\nmod woven;\npub use woven::woven;\n",
            );
        }
        write(file, &content)?;
    }
    write_as_is(&format!("{SWITCHED}/woven.rs"), include_bytes!("switch.rs"))?;
    remove_others(Path::new(WOVEN), &files)
}

/// Writes a file of the copy. What would always be inlined need not be; bytes stay where they are.
pub fn write(file: &str, content: &[u8]) -> Result<()> {
    match str::from_utf8(content) {
        Ok(text) if file.ends_with(".rs") => {
            write_as_is(file, text.replace(ALWAYS, "#[inline]        ").as_bytes())
        }
        _ => write_as_is(file, content),
    }
}

/// Writes a file, if it is another.
fn write_as_is(file: &str, content: &[u8]) -> Result<()> {
    let path = Path::new(WOVEN).join(file);
    if fs::read(&path).is_ok_and(|before| before == content) {
        return Ok(());
    }
    fs::create_dir_all(path.parent().expect("a folder"))?;
    fs::write(&path, content).with_context(|| path.display().to_string())
}

/// Removes from the copy what the tree no longer has.
fn remove_others(folder: &Path, files: &BTreeSet<&str>) -> Result<()> {
    for entry in fs::read_dir(folder)?.collect::<io::Result<Vec<_>>>()? {
        let path: PathBuf = entry.path();
        let name = path.strip_prefix(WOVEN)?.to_string_lossy().into_owned();
        if path.is_dir() {
            remove_others(&path, files)?;
        } else if !files.contains(&*name)
            && name != format!("{SWITCHED}/woven.rs")
            && name != "Cargo.lock"
        {
            fs::remove_file(&path)?;
        }
    }
    Ok(())
}
