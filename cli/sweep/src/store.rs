// SPDX-License-Identifier: MIT OR Apache-2.0
//! The store: what has been run, in files that are never changed. Any number of programs on any
//! number of hosts may write to it.
//!
//! | folder | holds |
//! | --- | --- |
//! | `plans/` | plans that were run, by their name, with everything that they need, and how many points make a chunk |
//! | `parts/` | results, a line per point; a part is named by its points |
//! | `index/` | the points of each part, so that a chunk need not read what it does not ask for |
//! | `times/` | how long they took, by the same name |
//! | `claims/` | chunks that some runner is at |
//! | `hosts/` | the reference point of each plan as each host runs it |

use std::collections::BTreeMap;
use std::fmt::Display;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use hapticore_files::AtomicFile;
use rayon::prelude::*;

use crate::canonical;
use crate::claim::Claim;
use crate::index::{self, Asked};
pub use crate::part::Torn;
use crate::part::{Part, write, write_bytes};
use crate::plan::Plan;
use crate::result::{Line, Times};

/// A folder of results.
#[derive(Debug, Clone)]
pub struct Store {
    folder: PathBuf,
}

/// What a store holds.
#[derive(Debug, Default)]
pub struct Contents {
    /// Lines by the name of their point.
    pub lines: BTreeMap<String, Line>,
    /// Files and lines that cannot be read; their points count as missing.
    pub torn: Vec<Torn>,
}

impl Store {
    /// A store in a folder, which is made where it is not there; what killed runs left unfinished is
    /// cleared, for there may be nothing left to write.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn open(folder: &Path) -> Result<Store> {
        for name in ["plans", "parts", "index", "times", "hosts", "claims"] {
            let path = folder.join(name);
            fs::create_dir_all(&path).with_context(|| path.display().to_string())?;
            hapticore_files::clear(&path);
        }
        Ok(Store { folder: folder.into() })
    }

    /// Where it is.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Keeps a plan; its name.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn keep_plan(&self, plan: &Plan) -> Result<String> {
        let name = plan.name();
        let path = self.plan_path(&name);
        if !path.exists() {
            write(&path, &canonical::text(plan))?;
        }
        Ok(name)
    }

    /// A plan that was kept.
    ///
    /// # Errors
    /// There is none of the name, or it is not what its name says.
    pub fn plan(&self, name: &str) -> Result<Plan> {
        let path = self.plan_path(name);
        let what = || path.display().to_string();
        let text = fs::read_to_string(&path).with_context(what)?;
        let plan: Plan = serde_json::from_str(&text).with_context(what)?;
        ensure!(plan.name() == name, "{}: expected a plan with the hash {name}", what());
        Ok(plan)
    }

    fn plan_path(&self, name: &str) -> PathBuf {
        self.folder.join("plans").join(format!("{name}.json"))
    }

    /// Adds a part: all of it or nothing.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn add(&self, lines: &[Line], times: &[Times]) -> Result<()> {
        let keys: Vec<_> = lines.iter().map(|line| &line.key).collect();
        let name = &canonical::name(&keys)[..32];
        let text: String = lines.iter().map(|line| line.text() + "\n").collect();
        let of_times: String = times.iter().map(|of| canonical::text(of) + "\n").collect();
        let part = self.folder.join("parts").join(format!("{name}.jsonl"));
        write(&self.folder.join("times").join(format!("{name}.jsonl")), &of_times)?;
        let keys = lines.iter().map(|line| &*line.key);
        write_bytes(&index::path(&self.folder, &part), &index::bytes(text.len() as u64, keys))?;
        write(&part, &text)
    }

    /// The number of points of a plan's chunks, where it has been chosen.
    pub fn chunk_points(&self, plan: &str) -> Option<usize> {
        fs::read_to_string(self.chunk_path(plan)).ok()?.trim().parse().ok().filter(|of| *of > 0)
    }

    /// Chooses the number of points of a plan's chunks, for every runner of the store.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn choose_chunk_points(&self, plan: &str, points: usize) -> Result<()> {
        write(&self.chunk_path(plan), &format!("{points}\n"))
    }

    fn chunk_path(&self, plan: &str) -> PathBuf {
        self.folder.join("plans").join(format!("{plan}.chunk"))
    }

    /// The claim of what a name stands for within a plan.
    ///
    /// # Errors
    /// As [`Claim::take`].
    pub(crate) fn claim(&self, plan: &str, name: impl Display) -> Result<Option<Claim>> {
        Claim::take(&self.claim_path(plan, name))
    }

    /// As [`Store::claim`], as soon as no other runner has it.
    ///
    /// # Errors
    /// As [`Claim::wait`].
    pub(crate) fn wait_for_claim(&self, plan: &str, name: impl Display) -> Result<Claim> {
        Claim::wait(&self.claim_path(plan, name))
    }

    fn claim_path(&self, plan: &str, name: impl Display) -> PathBuf {
        self.folder.join("claims").join(format!("{plan:.16}-{name}.claim"))
    }

    /// All that is in it.
    ///
    /// # Errors
    /// A file that cannot be read; two results of one point that differ.
    pub fn contents(&self) -> Result<Contents> {
        Store::read(self.files("parts")?)
    }

    /// What the parts hold that hold any of some points.
    ///
    /// # Errors
    /// As [`Store::contents`]; an index that cannot be written.
    pub fn contents_about<'b>(&self, keys: impl Iterator<Item = &'b str>) -> Result<Contents> {
        let asked = Asked::new(keys);
        let holds = |path: &PathBuf| {
            let index = index::path(&self.folder, path);
            let held = index::holds_any(path, &index, &asked);
            held.map(|held| held.then(|| path.clone())).transpose()
        };
        Store::read(self.files("parts")?.par_iter().filter_map(holds).collect::<Result<_>>()?)
    }

    fn read(paths: Vec<PathBuf>) -> Result<Contents> {
        let parts = paths.into_par_iter().map(Part::read).collect::<Result<Vec<_>>>()?;
        let (mut contents, mut from) = (Contents::default(), BTreeMap::new());
        for Part { path, lines, torn } in parts {
            contents.torn.extend(torn);
            for line in lines {
                let Some(known) = contents.lines.get(&line.key) else {
                    from.insert(line.key.clone(), path.clone());
                    contents.lines.insert(line.key.clone(), line);
                    continue;
                };
                ensure!(
                    *known == line,
                    "{} and {}: expected equal results of point {:.16}, got others; remove the part of the host that is wrong",
                    from[&line.key].display(),
                    path.display(),
                    line.key
                );
            }
        }
        Ok(contents)
    }

    /// Puts parts with lines that cannot be read aside, as `NAME.jsonl.torn`, and keeps their good
    /// lines.
    ///
    /// # Errors
    /// They cannot be written.
    pub fn mend(&self, torn: &[Torn]) -> Result<()> {
        for part in torn {
            let aside = part.path.with_extension("jsonl.torn");
            copy(&part.path, &aside).with_context(|| aside.display().to_string())?;
            write(&part.path, &part.good)?;
        }
        Ok(())
    }

    /// How long points took; what cannot be read is left out.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn times(&self) -> Result<BTreeMap<String, Times>> {
        let text = |path: PathBuf| fs::read_to_string(path).unwrap_or_default();
        let read = |text: String| -> Vec<Times> {
            text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect()
        };
        let all = self.files("times")?.into_iter().map(text).flat_map(read);
        Ok(all.map(|times| (times.key.clone(), times)).collect())
    }

    fn files(&self, folder: &str) -> Result<Vec<PathBuf>> {
        let folder = self.folder.join(folder);
        let what = || folder.display().to_string();
        let entries = fs::read_dir(&folder).with_context(what)?;
        let entries = entries.collect::<io::Result<Vec<_>>>().with_context(what)?;
        let mut paths: Vec<_> = entries.into_iter().map(|entry| entry.path()).collect();
        paths.retain(|path| path.extension().is_some_and(|of| of == "jsonl"));
        paths.sort();
        Ok(paths)
    }
}

/// Copies a file whole or not at all.
fn copy(from: &Path, to: &Path) -> io::Result<()> {
    let copied = AtomicFile::create(to)?;
    fs::copy(from, copied.partial_path())?;
    copied.persist()
}
