// SPDX-License-Identifier: MIT OR Apache-2.0
//! Verdicts of tools, known by what they were about: what has been simulated, proved or placed once need not be again.
//!
//! `synth/certificates.tsv` has a line a verdict: the hash of everything that it depends on, who asked, the verdict. A change of
//! the Verilog, of what it is run with, or of a tool's version is another hash: then the tools are asked.
//!
//! | `CERTIFICATES` | the tools are asked | verdicts are added to the file |
//! | --- | --- | --- |
//! | unset | where no certificate is | no |
//! | `add` | where no certificate is | yes |
//! | `renew` | always | yes |
//!
//! `./test --full` begins a new file and renews it.

use crate::tools::{Tools, root};
use std::collections::HashMap;
use std::convert::Infallible;
use std::fs::{self, OpenOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// What tools of the distribution say of their versions; those of `synth/tools` are pinned in its files.
const VERSIONS: [&[&str]; 5] = [
    &["verilator", "--version"],
    &["iverilog", "-V"],
    &["g++", "--version"],
    &["make", "--version"],
    &["python3", "--version"],
];

/// The file of certificates.
fn path() -> PathBuf {
    root().join("synth/certificates.tsv")
}

/// What asks the tools, with which options, and reads their answers: a part of every hash.
const HARNESS: [&str; 4] =
    ["tests/src/lockstep", "tests/src/tools.rs", "synth/src/formal.rs", "synth/src/tools.rs"];

/// What a verdict depends on.
#[derive(Debug, Clone)]
pub struct Subject {
    hash: blake3::Hasher,
}

impl Default for Subject {
    fn default() -> Self {
        Subject::new()
    }
}

impl Subject {
    /// Nothing but the tools' versions.
    pub fn new() -> Self {
        Subject { hash: blake3::Hasher::new() }.and(versions())
    }

    /// Bytes, too.
    #[must_use]
    pub fn and(mut self, bytes: impl AsRef<[u8]>) -> Self {
        let bytes = bytes.as_ref();
        self.hash.update(&(bytes.len() as u64).to_le_bytes()).update(bytes);
        self
    }

    /// Files of the project, too, and all below its folders, by their names and contents.
    ///
    /// # Panics
    /// One is not there.
    #[must_use]
    pub fn and_files(self, names: &[&str]) -> Self {
        names.iter().fold(self, |subject, name| subject.and_path(&root().join(name), name))
    }

    fn and_path(self, path: &Path, name: &str) -> Self {
        if !path.is_dir() {
            let bytes =
                fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            return self.and(name).and(bytes);
        }
        let mut names: Vec<_> = fs::read_dir(path)
            .expect("a folder")
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names.iter().fold(self, |subject, below| {
            subject.and_path(&path.join(below), &format!("{name}/{below}"))
        })
    }

    /// The verdict about this, in a line without tabs: that of its certificate, or what `ask` finds.
    ///
    /// # Panics
    /// Where `ask` does: then there is no certificate.
    pub fn verdict(&self, who: &str, ask: impl FnOnce() -> String) -> String {
        let Ok(verdict) = self.try_verdict(who, || Ok::<_, Infallible>(ask()));
        verdict
    }

    /// The verdict about this, where `ask` may find none.
    ///
    /// # Errors
    /// Those of `ask`: then there is no certificate.
    pub fn try_verdict<E>(
        &self,
        who: &str,
        ask: impl FnOnce() -> Result<String, E>,
    ) -> Result<String, E> {
        let hash = with_harness(&hex(&self.hash));
        let mode = std::env::var("CERTIFICATES").unwrap_or_default();
        if let Some(known) = certified().get(&hash).filter(|_| mode != "renew") {
            return Ok(known.clone());
        }
        let verdict = ask()?;
        if matches!(mode.as_str(), "add" | "renew") {
            add(&path(), &hash, who, &verdict);
        }
        Ok(verdict)
    }

    /// Runs a check that fails by a panic, where it has no certificate.
    pub fn holds(&self, who: &str, check: impl FnOnce()) {
        self.verdict(who, || {
            check();
            "holds".into()
        });
    }
}

/// The first half of a hash.
fn hex(hash: &blake3::Hasher) -> String {
    hash.finalize().to_hex()[..32].to_owned()
}

/// The hash of a subject and of [`HARNESS`].
fn with_harness(subject: &str) -> String {
    static FOUND: OnceLock<String> = OnceLock::new();
    let nothing = || Subject { hash: blake3::Hasher::new() };
    let harness = FOUND.get_or_init(|| hex(&nothing().and_files(&HARNESS).hash));
    hex(&nothing().and(subject).and(harness).hash)
}

/// All verdicts by hash.
fn certified() -> &'static HashMap<String, String> {
    static CERTIFIED: OnceLock<HashMap<String, String>> = OnceLock::new();
    CERTIFIED.get_or_init(|| read(&fs::read_to_string(path()).unwrap_or_default()))
}

fn read(text: &str) -> HashMap<String, String> {
    let line = |line: &str| {
        let mut fields = line.split('\t');
        let [hash, _, verdict] = [fields.next()?, fields.next()?, fields.next()?];
        Some((hash.to_owned(), verdict.to_owned()))
    };
    text.lines().filter_map(line).collect()
}

/// One write for the line: test programs run side by side.
fn add(path: &Path, hash: &str, who: &str, verdict: &str) {
    assert!(!format!("{who}{verdict}").contains(['\t', '\n']), "{who}: {verdict}: not a field");
    let mut file = OpenOptions::new().create(true).append(true).open(path).expect("certificates");
    file.write_all(format!("{hash}\t{who}\t{verdict}\n").as_bytes()).expect("written");
}

/// The versions of all tools.
fn versions() -> &'static str {
    static FOUND: OnceLock<String> = OnceLock::new();
    FOUND.get_or_init(|| {
        let pinned = ["synth/requirements.txt", "synth/tools"].map(|name| root().join(name));
        let pinned = pinned.map(|path| fs::read_to_string(path).expect("a file of the project"));
        let says = VERSIONS.map(|words| {
            let mut command = match Tools::find() {
                Ok(tools) => tools.command(words[0]),
                Err(_) => Command::new(words[0]),
            };
            let output = command.args(&words[1..]).output();
            let text = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned());
            text.unwrap_or_default().lines().next().unwrap_or_default().to_owned()
        });
        [pinned.concat(), says.join("\n")].concat()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hash(subject: &Subject) -> String {
        subject.hash.finalize().to_hex().to_string()
    }

    #[test]
    fn another_byte_or_another_border_between_texts_is_another_subject() {
        let subjects = [
            Subject::new(),
            Subject::new().and("ab").and("c"),
            Subject::new().and("a").and("bc"),
            Subject::new().and("ab").and("d"),
            Subject::new().and_files(&["synth/formal"]),
            Subject::new().and_files(&["synth/cells"]),
        ];
        for (k, subject) in subjects.iter().enumerate() {
            assert!(subjects[..k].iter().all(|other| hash(other) != hash(subject)), "{k}");
        }
        assert_eq!(hash(&Subject::new().and("ab")), hash(&Subject::new().and(b"ab")));
    }

    #[test]
    fn a_file_that_changes_its_name_or_content_is_another_subject() {
        let folder = tempfile::tempdir().expect("a folder");
        let of = |name: &str, text: &str| {
            fs::write(folder.path().join(name), text).expect("written");
            let subject = hash(&Subject::new().and_path(folder.path(), "folder"));
            fs::remove_file(folder.path().join(name)).expect("removed");
            subject
        };
        assert_eq!(of("a", "1"), of("a", "1"));
        assert_ne!(of("a", "1"), of("b", "1"));
        assert_ne!(of("a", "1"), of("a", "2"));
    }

    #[test]
    fn a_verdict_that_is_added_is_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("certificates.tsv");
        add(&path, "0123", "a test", "equal 12");
        add(&path, "4567", "a test", "");
        let known = read(&fs::read_to_string(&path).expect("a file"));
        assert_eq!(known["0123"], "equal 12");
        assert_eq!(known["4567"], "");
    }

    /// No certificate is about these words, so that the check runs, and its failure fails.
    #[test]
    #[should_panic(expected = "another result")]
    fn without_a_certificate_the_check_runs() {
        Subject::new()
            .and("no certificate is about this")
            .holds("a test", || panic!("another result"));
    }
}
