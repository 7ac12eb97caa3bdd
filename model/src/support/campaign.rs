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
use std::fs::File;
use std::path::Path;
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

/// The tests of a block, and the mutants that they meet.
#[derive(Debug, Clone, Default)]
pub struct Group {
    tests: BTreeSet<String>,
    mutants: BTreeSet<String>,
    took: Duration,
}

/// How many mutants of each block and class there are, and how many are noticed.
#[derive(Debug, Default)]
pub struct Table {
    /// By block and class: all, noticed.
    pub counts: BTreeMap<(String, String), [usize; 2]>,
    /// Those that are not noticed.
    pub missed: Vec<(String, Verdict)>,
}

/// Whether all mutants are judged (`MUTANTS=all`), or those of the blocks named (`MUTANTS=pace,ratio`).
pub fn wanted(block: &str) -> bool {
    let all = std::env::var("MUTANTS").unwrap_or_default();
    all == "all" || all.split(',').any(|wanted| wanted == block)
}

/// Runs tests of this program, all whose names begin so or those named: whether they pass; `None` after the time
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

/// The mutants of a block and its tests, of which `own` selects those that a test of this name and a block of this path
/// have. The tests run once with the unchanged netlist.
///
/// # Panics
/// Where one of them fails.
pub fn group(filter: &str, own: impl Fn(&str, &str) -> bool) -> Group {
    let folder = std::env::temp_dir().join(format!("mutants-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let list = folder.join(filter.replace("::", "-"));
    File::create(&list).expect("a file");
    let path = list.to_str().expect("a path in UTF-8");
    let variables =
        [("HAPTICORE_MUTANT", "none"), ("HAPTICORE_MUTANTS", path), ("HAPTICORE_SHARE", SHARES[0])];
    let begun = Instant::now();
    let passed = run(&[filter], &variables, Duration::from_secs(3600));
    let took = begun.elapsed();
    assert_eq!(passed, Some(true), "{filter}: the netlist in place of the block passes its tests");
    let mut group = Group { took, ..Group::default() };
    listed(&list, |test, path, mutant| {
        if own(test, path) {
            group.tests.insert(test.into());
            group.mutants.insert(mutant.into());
        }
    });
    group
}

fn listed(list: &Path, mut each: impl FnMut(&str, &str, &str)) {
    let text = std::fs::read_to_string(list).expect("the list that was written");
    let lines: BTreeSet<&str> = text.lines().collect();
    for line in lines {
        let [test, path, mutant] =
            line.split('\t').collect::<Vec<_>>().try_into().expect("three columns");
        each(test, path, mutant);
    }
    std::fs::remove_file(list).expect("the list that was written");
}

impl Group {
    /// One mutant's verdict: with few operations, then with more.
    fn judge(&self, mutant: &str) -> Verdict {
        let mut tests: Vec<&str> = self.tests.iter().map(String::as_str).collect();
        tests.push("--exact");
        let mut verdict = Verdict::Survived;
        for share in SHARES {
            let variables = [("HAPTICORE_MUTANT", mutant), ("HAPTICORE_SHARE", share)];
            let limit = self.took * LIMIT.0 + Duration::from_secs(LIMIT.1);
            match run(&tests, &variables, limit) {
                Some(false) => return Verdict::Noticed,
                Some(true) => verdict = Verdict::Survived,
                None => return Verdict::TimedOut,
            }
        }
        verdict
    }

    /// Judges each `step`th mutant, two at a time.
    pub fn judge_each(&self, step: usize, table: &mut Table) {
        let mutants = Mutex::new(self.mutants.iter().step_by(step));
        let table = Mutex::new(table);
        let next = || mutants.lock().expect("no panic").next();
        let work = || {
            while let Some(mutant) = next() {
                let verdict = self.judge(mutant);
                table.lock().expect("no panic").enter(mutant, verdict);
            }
        };
        std::thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(work))));
    }
}

impl Table {
    fn enter(&mut self, mutant: &str, verdict: Verdict) {
        let (place, class) = mutant.rsplit_once(": ").expect("place: class");
        let (block, _) = place.split_once('.').expect("module.place");
        let [all, noticed] = self.counts.entry((block.into(), class.into())).or_default();
        *all += 1;
        *noticed += usize::from(verdict == Verdict::Noticed);
        if verdict != Verdict::Noticed {
            self.missed.push((mutant.into(), verdict));
        }
    }

    /// Mutants noticed of all, by block and class, and those that are not.
    pub fn print(&self) {
        for ((block, class), [all, noticed]) in &self.counts {
            println!("{block}, {class}: {noticed} of {all}");
        }
        for (mutant, verdict) in &self.missed {
            println!("{verdict:?}: {mutant}");
        }
        let [all, noticed] = self.total();
        println!("all: {noticed} of {all}");
    }

    /// All mutants, and those that are noticed.
    pub fn total(&self) -> [usize; 2] {
        self.counts.values().fold([0; 2], |sum, of| [sum[0] + of[0], sum[1] + of[1]])
    }

    /// Holds that at least 99 % are noticed, of those that no tool has proved to be equivalent: a list of these, each
    /// under the reason (`#`).
    ///
    /// # Panics
    /// Where fewer are, or where one of the list is noticed after all.
    pub fn check(&self, equivalent: &str) {
        self.print();
        let lines = equivalent.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
        let equivalent: BTreeSet<&str> = lines.collect();
        let missed = self.missed.iter().map(|(mutant, _)| mutant.as_str());
        let proved = missed.filter(|mutant| equivalent.contains(mutant)).count();
        let [all, noticed] = self.total();
        assert!(all > proved, "no mutant was judged");
        let share = noticed as f64 / (all - proved) as f64;
        println!("{proved} proved equivalent; noticed of the others: {:.1} %", 100.0 * share);
        assert!(share >= 0.99, "{noticed} of {} noticed", all - proved);
    }
}
