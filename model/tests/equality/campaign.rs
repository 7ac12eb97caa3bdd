// SPDX-License-Identifier: MIT OR Apache-2.0
//! Judges the tests of this program by mutants of the netlists of their blocks: missing resets and
//! clears, sticky flags, bits held for a cycle, stale operands
//! (`hapticore_hdl::interpretations::netlist::mutants`).
//!
//! 1. The tests of each block run once with the unchanged netlist in place of the block, and list the
//!    mutants of each block that they clock.
//! 2. For each mutant its block's tests run with the mutated netlist in place of the block, in a
//!    process of their own, with few random operations first and more where none of them fails.
//! 3. A mutant is noticed where a test fails. A timeout is no failure.

pub use super::tally::{Table, Verdict};

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// In each pass, one of this number of random operations is done.
const SHARES: [&str; 2] = ["2000", "100"];

/// What a test may take: as many times what it takes with the unchanged netlist, and as many seconds.
/// Both are generous: a processor may have other work.
const LIMIT: (u32, u64) = (10, 20);

/// Mutants, and the tests that judge each: those that clock its block alone, else those that clock it within another.
#[derive(Debug, Clone, Default)]
pub struct Group {
    mutants: BTreeMap<String, BTreeSet<String>>,
    /// Those that are proved to be equivalent, of each configuration that a test has.
    proved: BTreeSet<String>,
    took: Duration,
}

/// Whether all mutants are judged (`MUTANTS=all`), or those of the blocks named (`MUTANTS=pace,ratio`).
pub fn wanted(block: &str) -> bool {
    let all = std::env::var("MUTANTS").unwrap_or_default();
    all == "all" || all.split(',').any(|wanted| wanted == block)
}

/// Runs tests of this program, those whose names contain one of these, for no longer than the limit: the names of those
/// that failed, and whether the program ended.
fn run(tests: &[&str], variables: &[(&str, &str)], limit: Duration) -> (Vec<String>, bool) {
    let log = tempfile(&format!("{:?}", std::thread::current().id()));
    let mut command = Command::new(std::env::current_exe().expect("this program has a path"));
    command.args(tests).args(["--skip", "mutants_of_", "--test-threads", "2"]);
    command.envs(variables.iter().copied()).env_remove("MUTANTS");
    command.stdout(File::create(&log).expect("a file")).stderr(Stdio::null());
    let mut child = command.spawn().expect("this program runs");
    let begun = Instant::now();
    let ended = loop {
        match child.try_wait().expect("a child of this process") {
            Some(_) => break true,
            None if begun.elapsed() > limit => {
                child.kill().and_then(|()| child.wait()).expect("a child of this process");
                break false;
            }
            None => std::thread::sleep(Duration::from_millis(2)),
        }
    };
    let text = std::fs::read_to_string(&log).unwrap_or_default();
    let failed = |line: &str| Some(line.strip_prefix("test ")?.strip_suffix(" ... FAILED")?.into());
    (text.lines().filter_map(failed).collect(), ended)
}

/// The mutants of blocks whose path `of` selects, and their tests among those whose names contain a filter. These run once
/// with the unchanged netlists. Tests that fail then are named and not asked: blocks that are hurried have no netlist.
///
/// # Panics
/// Where they do not end.
pub fn group(filters: &[&str], of: impl Fn(&str) -> bool) -> Group {
    let folder = tempfile(&filters.concat());
    let path = folder.to_str().expect("a path in UTF-8");
    let variables =
        [("HAPTICORE_MUTANT", "none"), ("HAPTICORE_MUTANTS", path), ("HAPTICORE_SHARE", SHARES[0])];
    let begun = Instant::now();
    let (failed, ended) = run(filters, &variables, Duration::from_secs(3600));
    let took = begun.elapsed();
    assert!(ended, "{filters:?}: tests end");
    failed.iter().for_each(|test| println!("not asked: {test}"));
    let text = std::fs::read_to_string(&folder).unwrap_or_default();
    let _ = std::fs::remove_file(folder);
    let (mutants, proved) =
        listed(&text, |test, path| of(path) && !failed.iter().any(|failed| failed == test));
    Group { mutants, proved, took }
}

/// A file of this process.
fn tempfile(name: &str) -> PathBuf {
    let name = format!("mutants-{}-{}", std::process::id(), name.replace([':', '(', ')'], ""));
    std::env::temp_dir().join(name)
}

type Tests = BTreeMap<String, BTreeSet<String>>;

/// The tests of each mutant, and the mutants that are proved to be equivalent.
fn listed(text: &str, of: impl Fn(&str, &str) -> bool) -> (Tests, BTreeSet<String>) {
    let [mut own, mut within, mut proved] = [Tests::new(), Tests::new(), Tests::new()];
    for line in text.lines() {
        let cells: Vec<_> = line.split('\t').collect();
        let [test, path, place, mutant] = cells[..] else { panic!("four columns: {line}") };
        let into = match place {
            "own" => &mut own,
            "equivalent" => &mut proved,
            _ => &mut within,
        };
        if of(test, path) {
            into.entry(mutant.into()).or_default().insert(test.into());
        }
    }
    proved.retain(|mutant, _| !own.contains_key(mutant));
    let equivalent = proved.keys().cloned().collect();
    within.extend(proved);
    within.extend(own);
    (within, equivalent)
}

impl Group {
    /// Those of a list, a line each, are proved to be equivalent, too.
    #[must_use]
    pub fn with_proved(mut self, list: &str) -> Self {
        let listed = list.lines().filter(|line| self.mutants.contains_key(*line));
        self.proved.extend(listed.map(String::from));
        self
    }

    /// One mutant's verdict: with few operations, then with more, unless it is proved to be equivalent.
    fn judge(&self, mutant: &str, tests: &BTreeSet<String>, proved: bool) -> Verdict {
        let mut tests: Vec<&str> = tests.iter().map(String::as_str).collect();
        tests.push("--exact");
        for share in if proved { &SHARES[..1] } else { &SHARES[..] } {
            let variables = [("HAPTICORE_MUTANT", mutant), ("HAPTICORE_SHARE", *share)];
            let limit = self.took * LIMIT.0 + Duration::from_secs(LIMIT.1);
            match run(&tests, &variables, limit) {
                (failed, _) if !failed.is_empty() => return Verdict::Noticed,
                (_, true) => (),
                (_, false) => return Verdict::TimedOut,
            }
        }
        Verdict::Survived
    }

    /// Judges each `step`th mutant, two at a time.
    pub fn judge_each(&self, step: usize, table: &mut Table) {
        let mutants = Mutex::new(self.mutants.iter().step_by(step));
        let table = Mutex::new(table);
        let next = || mutants.lock().expect("no panic").next();
        let work = || {
            while let Some((mutant, tests)) = next() {
                let proved = self.proved.contains(mutant);
                let verdict = self.judge(mutant, tests, proved);
                table.lock().expect("no panic").enter(mutant, verdict, proved);
            }
        };
        std::thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(work))));
    }
}
