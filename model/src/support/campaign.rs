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

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// One of so many random operations is done, in each pass.
const SHARES: [&str; 2] = ["2000", "100"];

/// What a test may take: as many times what it takes with the unchanged netlist, and as many seconds.
/// Both are generous: a processor may have other work.
const LIMIT: (u32, u64) = (10, 20);

/// What became of a mutant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// A test failed.
    Noticed,
    /// No test failed.
    Survived,
    /// No test failed within the time.
    TimedOut,
}

/// Mutants, and the tests that judge each: those that clock its block alone, else those that clock it within another.
#[derive(Debug, Clone, Default)]
pub struct Group {
    mutants: BTreeMap<String, BTreeSet<String>>,
    /// Those that are proved to be equivalent, of each configuration that a test has.
    proved: BTreeSet<String>,
    took: Duration,
}

/// How many mutants of each block and class there are, and how many are noticed.
#[derive(Debug, Default)]
pub struct Table {
    /// By block and class: all, noticed, proved to be equivalent, missed.
    pub counts: BTreeMap<(String, String), [usize; 4]>,
    /// Those that are missed.
    pub missed: Vec<(String, Verdict)>,
}

/// Whether all mutants are judged (`MUTANTS=all`), or those of the blocks named (`MUTANTS=pace,ratio`).
pub fn wanted(block: &str) -> bool {
    let all = std::env::var("MUTANTS").unwrap_or_default();
    all == "all" || all.split(',').any(|wanted| wanted == block)
}

/// Runs tests of this program, those whose names contain one of these: whether they pass; `None` after the time
/// that they may take.
fn run(tests: &[&str], variables: &[(&str, &str)], limit: Duration) -> Option<bool> {
    let mut command = Command::new(std::env::current_exe().expect("this program has a path"));
    command.args(tests).args(["--skip", "mutants_of_", "--test-threads", "2"]);
    command.envs(variables.iter().copied()).env_remove("MUTANTS");
    let mut child =
        command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("this program runs");
    let begun = Instant::now();
    loop {
        if let Some(status) = child.try_wait().expect("a child of this process") {
            return Some(status.success());
        }
        if begun.elapsed() > limit {
            child.kill().and_then(|()| child.wait()).expect("a child of this process");
            return None;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// The mutants of blocks whose path `of` selects, and their tests among those whose names contain `filter`. These run once
/// with the unchanged netlists.
///
/// # Panics
/// Where one of them fails.
pub fn group(filter: &str, of: impl Fn(&str) -> bool) -> Group {
    let folder = tempfile(filter);
    let path = folder.to_str().expect("a path in UTF-8");
    let variables =
        [("HAPTICORE_MUTANT", "none"), ("HAPTICORE_MUTANTS", path), ("HAPTICORE_SHARE", SHARES[0])];
    let begun = Instant::now();
    let passed = run(&[filter], &variables, Duration::from_secs(3600));
    let took = begun.elapsed();
    assert_eq!(passed, Some(true), "{filter}: the netlist in place of the block passes its tests");
    let text = std::fs::read_to_string(&folder).unwrap_or_default();
    let _ = std::fs::remove_file(folder);
    let (mutants, proved) = listed(&text, of);
    Group { mutants, proved, took }
}

/// A file of this process.
fn tempfile(name: &str) -> PathBuf {
    let name = format!("mutants-{}-{}", std::process::id(), name.replace(':', ""));
    std::env::temp_dir().join(name)
}

type Tests = BTreeMap<String, BTreeSet<String>>;

/// The tests of each mutant, and the mutants that are proved to be equivalent.
fn listed(text: &str, of: impl Fn(&str) -> bool) -> (Tests, BTreeSet<String>) {
    let [mut own, mut within, mut proved] = [Tests::new(), Tests::new(), Tests::new()];
    for line in text.lines() {
        let cells: Vec<_> = line.split('\t').collect();
        let [test, path, place, mutant] = cells[..] else { panic!("four columns: {line}") };
        let into = match place {
            "own" => &mut own,
            "equivalent" => &mut proved,
            _ => &mut within,
        };
        if of(path) {
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
    /// One mutant's verdict: with few operations, then with more.
    fn judge(&self, mutant: &str, tests: &BTreeSet<String>) -> Verdict {
        let mut tests: Vec<&str> = tests.iter().map(String::as_str).collect();
        tests.push("--exact");
        for share in SHARES {
            let variables = [("HAPTICORE_MUTANT", mutant), ("HAPTICORE_SHARE", share)];
            let limit = self.took * LIMIT.0 + Duration::from_secs(LIMIT.1);
            match run(&tests, &variables, limit) {
                Some(false) => return Verdict::Noticed,
                Some(true) => (),
                None => return Verdict::TimedOut,
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
                let verdict = self.judge(mutant, tests);
                let proved = self.proved.contains(mutant);
                table.lock().expect("no panic").enter(mutant, verdict, proved);
            }
        };
        std::thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(work))));
    }
}

impl Table {
    fn enter(&mut self, mutant: &str, verdict: Verdict, proved: bool) {
        let (place, class) = mutant.rsplit_once(": ").expect("place: class");
        let (block, _) = place.split_once('.').expect("module.place");
        let count = self.counts.entry((block.into(), class.into())).or_default();
        let of = match verdict {
            Verdict::Noticed => 1,
            _ if proved => 2,
            _ => 3,
        };
        count[0] += 1;
        count[of] += 1;
        if of == 3 {
            self.missed.push((mutant.into(), verdict));
        }
    }

    /// Counts by block and class, and every mutant that is missed.
    pub fn print(&self) {
        for ((block, class), [all, noticed, proved, _]) in &self.counts {
            println!("{block}, {class}: {noticed} of {all} noticed, {proved} proved equivalent");
        }
        for (mutant, verdict) in &self.missed {
            println!("{verdict:?}: {mutant}");
        }
    }

    /// Holds that at least 99 % are noticed, of those that are not proved to be equivalent.
    ///
    /// # Panics
    /// Where fewer are, or none was judged.
    pub fn check(&self) {
        self.print();
        let sum = |of: usize| self.counts.values().map(|counts| counts[of]).sum::<usize>();
        let [all, noticed, proved, missed] = [0, 1, 2, 3].map(sum);
        println!("{noticed} of {all} noticed, {proved} proved equivalent, {missed} missed");
        assert!(noticed > 0, "no mutant was judged");
        assert!(100 * noticed >= 99 * (all - proved), "{missed} of {} missed", all - proved);
    }
}
