// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Verilog that a report is about.

use anyhow::{Context, Result, ensure};
use hapticore_model::blocks::core::Core;
use hapticore_model::profile::Profile;
use hapticore_rtl::verilog::Design;
use std::fs;
use std::path::Path;

/// A file by name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct File {
    /// Its name.
    pub name: String,
    /// What stands in it.
    pub text: String,
}

/// The printed core of a profile.
pub fn core(profile: &Profile) -> Design {
    Design::of(&Core::new(profile), &format!("hapticore hdl --profile {}", profile.name))
}

/// The files of a printed design.
pub fn files(design: &Design) -> Vec<File> {
    design.modules.iter().map(|file| File { name: format!("{}.v", file.name), text: file.text.clone() }).collect()
}

/// Verilog and constraints (`.v`, `.lpf`, `.pcf`) in a folder, by name.
///
/// # Errors
/// The folder cannot be read, or has no Verilog.
pub fn read(folder: &Path) -> Result<Vec<File>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let path = entry?.path();
        if path.extension().is_some_and(|ending| ["v", "lpf", "pcf"].iter().any(|known| ending == *known)) {
            let name = path.file_name().expect("a file").to_string_lossy().into_owned();
            files.push(File { name, text: fs::read_to_string(&path)? });
        }
    }
    ensure!(files.iter().any(|file| file.name.ends_with(".v")), "{} has no Verilog", folder.display());
    Ok(files)
}

/// A hash of bytes that does not change with the compiler: FNV-1a, 64 bits.
pub fn hash(bytes: impl IntoIterator<Item = u8>) -> String {
    let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    format!("{:016x}", bytes.into_iter().fold(0xcbf2_9ce4_8422_2325, step))
}

/// The hash of files, whichever order they come in.
pub fn hash_of(files: &[File]) -> String {
    let mut all: Vec<_> = files.iter().map(|file| format!("{}\0{}\0", file.name, file.text)).collect();
    all.sort();
    hash(all.concat().into_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_fnv() {
        assert_eq!(hash([]), "cbf29ce484222325");
        assert_eq!(hash(*b"foobar"), "85944171f73967e8");
    }

    #[test]
    fn the_hash_follows_names_and_texts_and_not_their_order() {
        let file = |name: &str, text: &str| File { name: name.into(), text: text.into() };
        let (a, b) = (file("a.v", "x"), file("b.v", "y"));
        assert_eq!(hash_of(&[a.clone(), b.clone()]), hash_of(&[b.clone(), a.clone()]));
        assert_ne!(hash_of(&[a.clone(), b]), hash_of(&[file("a.v", "y"), file("b.v", "x")]));
        assert_ne!(hash_of(&[a]), hash_of(&[file("a.v", "x ")]));
    }
}
