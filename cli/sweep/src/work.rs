// SPDX-License-Identifier: MIT OR Apache-2.0
//! Work: chunks of a plan's points, each of some seconds, run and stored.

use std::collections::{BTreeMap, HashSet};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use anyhow::{Context, Result, ensure};
use cpu_time::ThreadTime;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::claim::Claim;
use crate::plan::Plan;
use crate::point::Names;
use crate::run::{Benches, Runner};
use crate::store::Store;
use crate::{canonical, host};

/// A chunk of a plan: what one call of an engine runs, one line of JSON.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Chunk {
    /// The plan's name.
    pub plan: String,
    /// The first point.
    pub first: usize,
    /// How many.
    pub count: usize,
}

/// How much processor time a chunk should take at least, s: an engine's own cost per call is some tenths of it.
const CHUNK_S: f64 = 5.0;
/// How long points are run to see how long they take, and how many at most.
const PROBE: Duration = Duration::from_millis(500);
const MOST_PROBED: usize = 64;
/// Chunks for each thread, at least, so that all end at about the same time.
const SHARE: usize = 4;

impl Chunk {
    /// Reads a line of `--list`.
    ///
    /// # Errors
    /// It is none.
    pub fn read(line: &str) -> Result<Chunk> {
        serde_json::from_str(line).with_context(|| {
            format!("expected a line of `sweep --list`, got \"{:.60}\"", line.trim())
        })
    }

    /// The line of `--list`.
    pub fn text(&self) -> String {
        canonical::text(self)
    }
}

/// A plan at work in a store.
pub struct Work<'a> {
    store: &'a Store,
    plan: &'a Plan,
    plan_name: String,
    names: Names,
    benches: Benches,
    /// What was wrong with parts that have been put aside.
    torn: Mutex<Vec<String>>,
}

impl<'a> Work<'a> {
    /// A plan in a store, which keeps it.
    ///
    /// # Errors
    /// A store that cannot be written.
    pub fn new(store: &'a Store, plan: &'a Plan) -> Result<Work<'a>> {
        let plan_name = store.keep_plan(plan)?;
        let (names, benches, torn) = (plan.names(), Benches::default(), Mutex::default());
        Ok(Work { store, plan, plan_name, names, benches, torn })
    }

    /// What was wrong with parts that could not be read and were put aside.
    pub fn torn(&self) -> Vec<String> {
        self.torn.lock().unwrap_or_else(PoisonError::into_inner).drain(..).collect()
    }

    /// The points without a line, in the plan's order; of equal ones, as draws may give, the first. Parts
    /// that cannot be read are put aside.
    ///
    /// # Errors
    /// A store that cannot be read or written.
    pub fn missing(&self, from: impl IntoParallelIterator<Item = usize>) -> Result<Vec<usize>> {
        let named = |index: usize| (index, self.names.of(&self.plan.point(index)));
        let all: Vec<(usize, String)> = from.into_par_iter().map(named).collect();
        let present = self.store.contents_about(all.iter().map(|(_, key)| &**key))?;
        self.store.mend(&present.torn)?;
        let messages = present.torn.into_iter().map(|torn| torn.message);
        self.torn.lock().unwrap_or_else(PoisonError::into_inner).extend(messages);
        let mut seen = HashSet::new();
        let mut is_missing = |key| !present.lines.contains_key(key) && seen.insert(key);
        Ok(all.iter().filter_map(|(index, key)| is_missing(key).then_some(*index)).collect())
    }

    /// Runs points one after the other, as long as `more` says so, and stores them; how many.
    /// `progress` is called after each.
    ///
    /// # Errors
    /// A part that cannot be written: then none of them is stored. An interruption: those that were
    /// run are.
    fn run(
        &self,
        points: &[usize],
        mut more: impl FnMut() -> bool,
        progress: &(dyn Fn() + Sync),
    ) -> Result<usize> {
        let mut runner = self.runner();
        let (mut lines, mut times) = (Vec::new(), Vec::new());
        let mut run = |index: &usize| -> Result<()> {
            let (line, time) = runner.run(&self.plan.point(*index))?;
            lines.push(line);
            times.push(time);
            progress();
            Ok(())
        };
        let ended = points.iter().take_while(|_| more()).try_for_each(&mut run);
        if !lines.is_empty() {
            self.store.add(&lines, &times)?;
        }
        ended.map(|()| lines.len())
    }

    fn runner(&self) -> Runner<'_> {
        Runner::new(self.plan, &self.names, &self.benches)
    }

    /// Runs a chunk's points that have no line; how many.
    ///
    /// # Errors
    /// A part that cannot be written, an interruption; a host that differs from the host of the
    /// store's reference.
    pub fn run_chunk(&self, chunk: &Chunk, progress: &(dyn Fn() + Sync)) -> Result<usize> {
        let range = chunk.first..chunk.first.saturating_add(chunk.count);
        ensure!(
            !range.is_empty() && range.end <= self.plan.len(),
            "expected a chunk within the plan's {} points, got {range:?}",
            self.plan.len()
        );
        let _claim = self.store.wait_for_claim(&self.plan_name, chunk.first)?;
        let missing = self.missing(range)?;
        if !missing.is_empty() {
            self.check_host()?;
        }
        self.run_grouped(missing, progress)
    }

    /// Runs points so that those which share a bench follow one another.
    fn run_grouped(&self, mut points: Vec<usize>, progress: &(dyn Fn() + Sync)) -> Result<usize> {
        self.plan.group_by_bench(&mut points);
        self.run(&points, || true, progress)
    }

    fn check_host(&self) -> Result<()> {
        host::check(self.store, &self.plan_name, || Ok(self.runner().run(&self.plan.point(0))?.0))
    }

    /// Runs everything that is missing on all threads of the pool that this is called in. Chunks that
    /// another runner is at are left to it; they are run here as well where it ends without them.
    ///
    /// # Errors
    /// As [`Work::run_chunk`]; what other chunks have stored stays.
    pub fn run_all(&self, missing: &[usize], progress: &(dyn Fn() + Sync)) -> Result<()> {
        if missing.is_empty() {
            return Ok(());
        }
        self.check_host()?;
        let share = self.plan.len().div_ceil(SHARE * rayon::current_num_threads());
        let size = self.chunk_points(missing, share)?;
        let mut chunks: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        missing.iter().for_each(|index| chunks.entry(index / size).or_default().push(*index));
        let run = |points: &[usize], _claim: Claim| -> Result<()> {
            // What another runner has stored until now counts.
            let left = self.missing(points.to_vec())?;
            (left.len()..points.len()).for_each(|_| progress());
            self.run_grouped(left, progress).map(drop)
        };
        let run_or_leave = |(number, points): (usize, Vec<usize>)| -> Result<_> {
            match self.store.claim(&self.plan_name, number * size)? {
                Some(claim) => run(&points, claim).map(|()| None),
                None => Ok(Some((number, points))),
            }
        };
        let chunks: Vec<_> = chunks.into_iter().collect();
        let left = chunks.into_par_iter().with_max_len(1).map(run_or_leave);
        let left: Vec<_> = left.collect::<Result<_>>()?;
        left.into_iter().flatten().try_for_each(|(number, points)| {
            run(&points, self.store.wait_for_claim(&self.plan_name, number * size)?)
        })
    }

    /// How many points make a chunk: what the store's first runner has found, at most `most`.
    fn chunk_points(&self, missing: &[usize], most: usize) -> Result<usize> {
        let _claim = self.store.wait_for_claim(&self.plan_name, "size")?;
        if let Some(known) = self.store.chunk_points(&self.plan_name) {
            return Ok(known);
        }
        let points = self.probe(missing)?.min(most).max(1);
        self.store.choose_chunk_points(&self.plan_name, points)?;
        Ok(points)
    }

    /// Runs some points to see how many make a chunk by processor time.
    fn probe(&self, missing: &[usize]) -> Result<usize> {
        let mut starts = Vec::new();
        let more = || {
            starts.push(ThreadTime::now());
            starts.len() < 3 || starts[1].elapsed() < PROBE
        };
        let count = self.run(&missing[..missing.len().min(MOST_PROBED)], more, &|| ())?;
        // The first point makes what the others share.
        let (from, points) = if count > 1 { (starts[1], count - 1) } else { (starts[0], 1) };
        let each_s = from.elapsed().as_secs_f64() / points as f64;
        Ok((CHUNK_S / each_s.max(1e-6)).ceil() as usize)
    }

    /// The plan as chunks.
    ///
    /// # Errors
    /// As [`Work::run_chunk`].
    pub fn chunks(&self) -> Result<Vec<Chunk>> {
        let count = self.plan.len();
        let missing = self.missing(0..count)?;
        let size = match missing.is_empty() {
            true => self.store.chunk_points(&self.plan_name).unwrap_or(count),
            false => {
                self.check_host()?;
                self.chunk_points(&missing, count)?
            }
        };
        let chunk = |first: usize| Chunk {
            plan: self.plan_name.clone(),
            first,
            count: size.min(count - first),
        };
        Ok((0..count).step_by(size).map(chunk).collect())
    }
}
