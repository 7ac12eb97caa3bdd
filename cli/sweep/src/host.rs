// SPDX-License-Identifier: MIT OR Apache-2.0
//! Hosts must not differ: each runs the first point of a plan before anything else of it, and compares
//! the bytes with those that the store keeps as reference, from whichever host came first.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};

use crate::canonical;
use crate::part::write;
use crate::result::Line;
use crate::store::Store;

/// A plan's first point as a host runs it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// The host's name.
    pub host: String,
    /// Hash of the program.
    pub program: String,
    /// The line of results.
    pub line: String,
}

impl Reference {
    /// Who ran it.
    pub fn who(&self) -> String {
        format!("{} (program {})", self.host, self.program)
    }
}

/// Checks this host and program against the store's reference of a plan, a first point that `run` gives;
/// it is run once for each.
///
/// # Errors
/// Other bytes: both hosts are named. A file that cannot be written, an interruption.
pub fn check(store: &Store, name: &str, run: impl FnOnce() -> Result<Line>) -> Result<()> {
    let folder = store.folder().join("hosts").join(&name[..16]);
    fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    let (host, program) = (host(), program());
    let path = folder.join(format!("{host}-{program}.json"));
    let own = match read(&path) {
        Some(known) => known,
        None => {
            let own = Reference { host, program, line: run()?.text() };
            write(&path, &canonical::text(&own))?;
            own
        }
    };
    let kept = folder.join("reference.json");
    hapticore_files::write_new(&kept, &canonical::text(&own))
        .with_context(|| kept.display().to_string())?;
    let reference =
        read(&kept).with_context(|| format!("{}: expected a reference point", kept.display()))?;
    match reference.line == own.line {
        true => Ok(()),
        false => bail!("{}", differs(&reference, &own)),
    }
}

/// Hosts whose bytes are not those of the reference, in words.
///
/// # Errors
/// A folder that cannot be read.
pub fn differing(store: &Store, name: &str) -> Result<Vec<String>> {
    let folder = store.folder().join("hosts").join(&name[..16]);
    let Some(reference) = read(&folder.join("reference.json")) else { return Ok(Vec::new()) };
    let entries = fs::read_dir(&folder).with_context(|| folder.display().to_string())?;
    let all = entries.flatten().filter_map(|entry| read(&entry.path()));
    let mut others: Vec<_> = all.filter(|of| of.line != reference.line).collect();
    others.sort_by_key(Reference::who);
    Ok(others.iter().map(|other| differs(&reference, other)).collect())
}

fn differs(reference: &Reference, other: &Reference) -> String {
    let pairs = reference.line.bytes().zip(other.line.bytes());
    let at = pairs.take_while(|(a, b)| a == b).count();
    let around = |line: &str| {
        let from = line[..at.min(line.len())].rfind(',').map_or(0, |comma| comma + 1);
        line[from..].chars().take(40).collect::<String>()
    };
    format!(
        "host {} differs from host {} in the reference point: expected {}, got {}; run the plan with one program on hosts of one kind, or in another store",
        other.who(),
        reference.who(),
        around(&reference.line),
        around(&other.line)
    )
}

fn read(path: &PathBuf) -> Option<Reference> {
    serde_json::from_str(&fs::read_to_string(path).ok()?).ok()
}

/// This host's name, as it may stand in a file's.
fn host() -> String {
    let name = fs::read_to_string("/proc/sys/kernel/hostname").ok();
    let name = name.or_else(|| std::env::var("HOSTNAME").ok());
    let name = name.or_else(|| std::env::var("COMPUTERNAME").ok()).unwrap_or_default();
    let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' };
    let name: String = name.trim().chars().map(plain).collect();
    if name.is_empty() { "unknown".into() } else { name }
}

/// This program: the hash of its file, else its version.
fn program() -> String {
    let bytes = std::env::current_exe().and_then(fs::read);
    let hash = blake3::hash(&bytes.unwrap_or_else(|_| env!("CARGO_PKG_VERSION").into()));
    hash.to_hex()[..16].to_string()
}
