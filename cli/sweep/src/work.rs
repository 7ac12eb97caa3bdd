// SPDX-License-Identifier: MIT OR Apache-2.0
//! Work: chunks of a plan's points, each of some seconds, run and stored.

use std::collections::HashSet;
use std::ops::Range;
use std::time::Instant;

use anyhow::{Context, Result, ensure};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::plan::Plan;
use crate::point::Names;
use crate::run::{Benches, Runner};
use crate::store::{Contents, Store};
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

/// How long a chunk should take at least, s: an engine's own cost per call is some tenths of it.
const CHUNK_S: f64 = 5.0;
/// How long points are run to see how long they take, s, and how many at most.
const PROBE_S: f64 = 0.5;
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
    /// Points that have their line.
    present: HashSet<String>,
}

impl<'a> Work<'a> {
    /// A plan in a store, which keeps it. Parts that cannot be read are put aside; what was wrong with
    /// them.
    ///
    /// # Errors
    /// A store that cannot be read or written.
    pub fn new(store: &'a Store, plan: &'a Plan) -> Result<(Work<'a>, Vec<String>)> {
        let plan_name = store.keep_plan(plan)?;
        let Contents { lines, torn } = store.contents()?;
        store.mend(&torn)?;
        let present = lines.into_keys().collect();
        let (names, benches) = (plan.names(), Benches::default());
        let work = Work { store, plan, plan_name, names, benches, present };
        Ok((work, torn.into_iter().map(|torn| torn.message).collect()))
    }

    /// The points without a line, in the plan's order; of equal ones, as draws may give, the first.
    pub fn missing(&self, from: Range<usize>) -> Vec<usize> {
        let named = |index: usize| (index, self.names.of(&self.plan.point(index)));
        let all: Vec<(usize, String)> = from.into_par_iter().map(named).collect();
        let (mut seen, mut missing) = (HashSet::new(), Vec::new());
        for (index, key) in all.iter().filter(|(_, key)| !self.present.contains(key)) {
            if seen.insert(key) {
                missing.push(*index);
            }
        }
        missing
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
        more: impl Fn() -> bool,
        progress: &(dyn Fn() + Sync),
    ) -> Result<usize> {
        let mut runner = Runner::new(self.plan, &self.names, &self.benches);
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

    /// Runs a chunk's points that have no line; how many.
    ///
    /// # Errors
    /// A part that cannot be written, an interruption; a host that differs from the one that made the
    /// store's reference.
    pub fn run_chunk(&self, chunk: &Chunk, progress: &(dyn Fn() + Sync)) -> Result<usize> {
        let range = chunk.first..chunk.first.saturating_add(chunk.count);
        ensure!(
            !range.is_empty() && range.end <= self.plan.len(),
            "expected a chunk within the plan's {} points, got {range:?}",
            self.plan.len()
        );
        let missing = self.missing(range);
        if !missing.is_empty() {
            host::check(self.store, self.plan, &self.plan_name)?;
        }
        self.run(&missing, || true, progress)
    }

    /// Runs all that is missing on all threads of the pool that this is called in.
    ///
    /// # Errors
    /// As [`Work::run_chunk`]; what other chunks have stored stays.
    pub fn run_all(&self, missing: &[usize], progress: &(dyn Fn() + Sync)) -> Result<()> {
        if missing.is_empty() {
            return Ok(());
        }
        host::check(self.store, self.plan, &self.plan_name)?;
        let (probed, size) = self.probe(missing, progress)?;
        let left = &missing[probed..];
        let most = left.len().div_ceil(SHARE * rayon::current_num_threads());
        let chunks: Vec<_> = left.chunks(size.min(most).max(1)).collect();
        let run = |chunk: &[usize]| self.run(chunk, || true, progress).map(drop);
        chunks.into_par_iter().with_max_len(1).try_for_each(run)
    }

    /// Runs the first points to see how long one takes; how many were run, and how many make a chunk.
    fn probe(&self, missing: &[usize], progress: &(dyn Fn() + Sync)) -> Result<(usize, usize)> {
        let start = Instant::now();
        let more = || start.elapsed().as_secs_f64() < PROBE_S;
        let few = &missing[..missing.len().min(MOST_PROBED)];
        let count = self.run(few, more, progress)?;
        let each_s = start.elapsed().as_secs_f64() / count as f64;
        Ok((count, (CHUNK_S / each_s).ceil().clamp(1.0, 1e6) as usize))
    }

    /// The plan as chunks, by how long its points took so far; the first ones are run where nothing is
    /// known.
    ///
    /// # Errors
    /// As [`Work::run_chunk`].
    pub fn chunks(&self) -> Result<Vec<Chunk>> {
        let all: Vec<usize> = self.missing(0..self.plan.len());
        let size = match (self.seconds_each()?, all.is_empty()) {
            (Some(each_s), _) => (CHUNK_S / each_s).ceil().clamp(1.0, 1e6) as usize,
            (None, true) => self.plan.len(),
            (None, false) => {
                host::check(self.store, self.plan, &self.plan_name)?;
                self.probe(&all, &|| ())?.1
            }
        };
        let count = self.plan.len();
        let chunk = |first: usize| Chunk {
            plan: self.plan_name.clone(),
            first,
            count: size.min(count - first),
        };
        Ok((0..count).step_by(size).map(chunk).collect())
    }

    /// What the plan's points took so far, on average, s; none where none was run.
    fn seconds_each(&self) -> Result<Option<f64>> {
        let times = self.store.times()?;
        let own = (0..self.plan.len()).into_par_iter().filter_map(|index| {
            let key = self.names.of(&self.plan.point(index));
            times.get(&key).map(|times| (times.seconds, 1.0))
        });
        let (sum, count) = own.reduce(|| (0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
        Ok((count > 0.0).then(|| (sum / count).max(1e-6)))
    }
}
