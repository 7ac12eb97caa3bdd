// SPDX-License-Identifier: MIT OR Apache-2.0
//! Judges woven mutants: only by tests that meet them, the quickest first. What survives is judged again,
//! by the same tests with more operations.

use crate::area::Area;
use crate::mutant::Mutant;
use crate::run::{End, SHARES, Test, parallel, run};
use crate::verdict::{Fate, Verdicts};
use crate::weave::Index;
use anyhow::Result;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// A test has three times the processor time that it takes in the unmutated build, and at least this.
const FLOOR_S: u64 = 3;
/// Where so many tests of a mutant do not end, no more are asked.
const ENDLESS: usize = 2;
/// Tests of others than the area itself are asked where they take no longer; longer ones where no other test
/// meets the mutant.
const QUICK: Duration = Duration::from_secs(5);

/// Judges mutants, given with their numbers in the build.
pub fn judge(
    mutants: &[Mutant],
    open: &[(usize, Index)],
    tests: &[Test],
    jobs: usize,
    verdicts: &mut Verdicts,
) -> Result<()> {
    let shared =
        Mutex::new((verdicts, Progress { begun: Instant::now(), done: 0, all: open.len() }));
    let results = parallel(jobs, open, |_, &(number, index)| {
        let mutant = &mutants[index];
        let fate = fate(mutant, number, tests)?;
        let mut shared = shared.lock().expect("no thread panics");
        shared.1.step();
        shared.0.add(mutant, fate, None)
    });
    results.into_iter().collect()
}

/// What the tests say of a mutant.
fn fate(mutant: &Mutant, number: usize, tests: &[Test]) -> Result<Fate> {
    let mut met = false;
    for pass in 0..SHARES.len() {
        match fate_in_pass(pass, mutant, number, tests)? {
            Fate::Survived { reached } => met |= reached,
            other => return Ok(other),
        }
    }
    Ok(Fate::Survived { reached: met })
}

fn fate_in_pass(pass: usize, mutant: &Mutant, number: usize, tests: &[Test]) -> Result<Fate> {
    let area = Area::of(&mutant.file);
    let mut asked: Vec<(u8, Duration, &Test)> = tests
        .iter()
        .filter(|test| test.reached.contains(&number))
        .filter_map(|test| {
            Some((area.stage(&test.program.name, &test.name), test.time(pass)?, test))
        })
        .collect();
    asked.sort_by_key(|(stage, time, _)| (*stage, *time));
    let quick = |&(stage, time, _): &(u8, Duration, &Test)| stage == 0 || time <= QUICK;
    if asked.iter().any(quick) {
        asked.retain(quick);
    }
    let mut endless = 0;
    for &(stage, time, test) in &asked {
        let limit = FLOOR_S.max(3 * time.as_secs());
        match run(test, number, SHARES[pass], limit)? {
            End::Passed => (),
            End::Failed => return Ok(Fate::Killed { by: test.name.clone(), stage }),
            End::TimedOut => endless += 1,
        }
        if endless == ENDLESS {
            break;
        }
    }
    Ok(if endless > 0 { Fate::TimedOut } else { Fate::Survived { reached: !asked.is_empty() } })
}

/// How far it is.
struct Progress {
    begun: Instant,
    done: usize,
    all: usize,
}

impl Progress {
    fn step(&mut self) {
        self.done += 1;
        if self.done.is_multiple_of(20) || self.done == self.all {
            let each = self.begun.elapsed() / self.done as u32;
            let left = (each * (self.all - self.done) as u32).as_secs();
            eprintln!("{} of {} mutants, {each:.0?} each, {left} s left", self.done, self.all);
        }
    }
}
