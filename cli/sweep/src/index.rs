// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which points a part holds, without reading what they left: beside `parts/NAME.jsonl` stands
//! `index/NAME.index`, a head and the first half of each point's name, binary.
//!
//! | bytes | hold |
//! | --- | --- |
//! | 8 | the part's length in bytes, little endian: an index of a part that has changed since is made anew |
//! | 16 each | the first 32 of the 64 hexadecimal digits of a point's name |

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::part::{Part, write_bytes};

/// The first half of a point's name: two of 10⁷ points share it once in 10²⁴ stores.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Short([u8; SHORT]);

const HEAD: usize = 8;
const SHORT: usize = 16;

impl Short {
    /// That of a name of 64 hexadecimal digits; of any other text, whatever its hash begins with.
    pub fn of(key: &str) -> Short {
        let digits =
            key.as_bytes().get(..2 * SHORT).and_then(|text| std::str::from_utf8(text).ok());
        let number = digits.and_then(|digits| u128::from_str_radix(digits, 16).ok());
        let hashed = || blake3::hash(key.as_bytes()).as_bytes()[..SHORT].try_into();
        Short(number.map_or_else(|| hashed().expect("32 bytes"), u128::to_be_bytes))
    }

    fn beginning(self) -> usize {
        u16::from_be_bytes([self.0[0], self.0[1]]).into()
    }
}

/// Points that are looked for.
#[derive(Debug)]
pub struct Asked {
    shorts: HashSet<Short>,
    /// Whether one begins with these two bytes: they distinguish most of a large store's points, without a hash.
    begins: Vec<bool>,
}

impl Asked {
    /// Those of these names.
    pub fn new<'a>(keys: impl Iterator<Item = &'a str>) -> Asked {
        let shorts: HashSet<Short> = keys.map(Short::of).collect();
        let mut begins = vec![false; 1 << 16];
        shorts.iter().for_each(|short| begins[short.beginning()] = true);
        Asked { shorts, begins }
    }

    fn has(&self, short: Short) -> bool {
        self.begins[short.beginning()] && self.shorts.contains(&short)
    }
}

/// Whether a part holds one of some points, or has lines that cannot be read. Its index is made where it
/// is missing or of another length.
///
/// # Errors
/// A part that cannot be read, an index that cannot be written.
pub fn holds_any(part: &Path, index: &Path, asked: &Asked) -> Result<bool> {
    let what = || part.display().to_string();
    let length = fs::metadata(part).with_context(what)?.len();
    let bytes = match fs::read(index) {
        Ok(bytes) if bytes.get(..HEAD) == Some(&length.to_le_bytes()[..]) => bytes,
        _ => match Part::read(part.into())? {
            Part { torn: Some(_), .. } => return Ok(true),
            Part { lines, .. } => {
                let bytes = bytes(length, lines.iter().map(|line| &*line.key));
                write_bytes(index, &bytes)?;
                bytes
            }
        },
    };
    let (shorts, _) = bytes[HEAD..].as_chunks::<SHORT>();
    Ok(shorts.iter().any(|short| asked.has(Short(*short))))
}

/// The index of a part of a length.
pub fn bytes<'a>(length: u64, keys: impl Iterator<Item = &'a str>) -> Vec<u8> {
    let head = length.to_le_bytes().into_iter();
    head.chain(keys.flat_map(|key| Short::of(key).0)).collect()
}

/// Where the index of a part stands.
pub fn path(store: &Path, part: &Path) -> PathBuf {
    store.join("index").join(part.with_extension("index").file_name().unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Settings;
    use crate::result::Line;

    fn line(key: &str) -> String {
        let [profile, scene] = [Settings::new(), Settings::new()];
        let error = Some("none".into());
        Line { key: key.into(), seed: 1, profile, scene, results: None, error }.text() + "\n"
    }

    /// A search for the one part's point need not read the other part, whatever its content.
    #[test]
    fn a_part_is_read_where_it_holds_what_is_asked_or_has_changed() {
        let folder = tempfile::tempdir().expect("a folder");
        let [part, index] = ["part", "index"].map(|name| folder.path().join(name));
        let keys = ["0a", "1b"].map(|digits| digits.repeat(32));
        let holds = |key: &str| {
            holds_any(&part, &index, &Asked::new([key].into_iter())).expect("files are read")
        };
        fs::write(&part, line(&keys[0])).expect("it is written");
        assert_eq!(keys.each_ref().map(|key| holds(key)), [true, false]);
        let length = line(&keys[0]).len();
        fs::write(&part, "x".repeat(length)).expect("it is written");
        assert!(!holds(&keys[1]), "of the same length: the index stands for it");
        fs::write(&part, "x").expect("it is written");
        assert!(holds(&keys[1]), "changed, and with a line that cannot be read");
        fs::write(&part, line(&keys[0]) + &line(&keys[1])).expect("it is written");
        assert_eq!(keys.each_ref().map(|key| holds(key)), [true, true], "the index is made anew");
    }
}
