// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs tests, each in a process of its own, on some threads.

use crate::compile::Program;
use anyhow::{Context, Result, ensure};
use std::collections::BTreeSet;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};
use std::{fs, thread};

/// A test, and what the unmutated build showed of it.
pub struct Test {
    /// Its program.
    pub program: Program,
    /// Its name within that.
    pub name: String,
    /// Processor time that it takes in each pass, none where it does not pass.
    times: [Option<Duration>; SHARES.len()],
    /// The numbers of the mutants that it meets.
    pub reached: BTreeSet<usize>,
}

/// The passes: of a test's random operations one of so many is done, what `HAPTICORE_SHARE` tells
/// `operations` of `model/tests/equality/harness.rs`.
pub const SHARES: [u64; 2] = [200, 20];

impl Test {
    /// A line of `tests.txt`.
    pub fn line(&self) -> String {
        format!("{} {:?} {}\n", self.name, self.times, self.reached.len())
    }

    /// What it takes in a pass in which it is asked: it does more than in the pass before.
    pub fn time(&self, pass: usize) -> Option<Duration> {
        let time = self.times[pass]?;
        let before = self.times[..pass].last().copied().flatten();
        let more = before.is_none_or(|before| time < MEASURABLE || time > before.mul_f64(1.3));
        more.then_some(time)
    }
}

/// How a test ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// It passes.
    Passed,
    /// It fails, or its process does.
    Failed,
    /// It does not end in time.
    TimedOut,
}

/// A test process may take this much memory, in KiB: a mutant may ask for any.
const MEMORY: u64 = 8 << 20;
/// Where a machine is busy, a second of its processor may take so many.
const PATIENCE: u32 = 60;
/// Tests that take more seconds of the processor are not asked.
const SLOW_S: u64 = 100;
/// What is measured of shorter times says nothing.
const MEASURABLE: Duration = Duration::from_millis(100);
/// Tests that take longer in a pass are not asked in the next.
const LONG: Duration = Duration::from_secs(5);
/// The signal of a process that has used up its processor time.
const SIGXCPU: i32 = 24;

/// The tests of all programs that pass with no mutant enabled, in a pass at least. Others are named and not
/// asked: for a statistic a pass may have too few operations.
pub fn baseline(programs: &[Program], jobs: usize) -> Result<Vec<Test>> {
    let mut names = Vec::new();
    for program in programs {
        let output = Command::new(&program.path).args(["--list", "--format", "terse"]).output()?;
        ensure!(output.status.success(), "{} --list does not succeed", program.path.display());
        let listed = String::from_utf8(output.stdout)?;
        names.extend(
            listed
                .lines()
                .filter_map(|line| line.strip_suffix(": test"))
                .map(|name| (program.clone(), name.to_string())),
        );
    }
    let folder = std::path::absolute("target/mutants/reached")?;
    fs::create_dir_all(&folder)?;
    let tests = parallel(jobs, &names, |number, (program, name)| {
        let record = folder.join(number.to_string());
        let mut test = Test {
            program: program.clone(),
            name: name.clone(),
            times: [None; SHARES.len()],
            reached: BTreeSet::new(),
        };
        for (time, share) in test.times.iter_mut().zip(SHARES) {
            *time = passes(program, name, share, &record)?;
            test.reached.extend(read(&record)?);
            match time {
                Some(time) if *time > LONG => break,
                Some(_) => (),
                None => eprintln!("fails or is slow with no mutant enabled, 1/{share}: {name}"),
            }
        }
        Ok(test.times.iter().any(Option::is_some).then_some(test))
    });
    tests.into_iter().filter_map(Result::transpose).collect()
}

/// The processor time of a test that passes with no mutant enabled, and does not take too much of it. The
/// mutants that it meets are written into a record.
fn passes(program: &Program, name: &str, share: u64, record: &Path) -> Result<Option<Duration>> {
    // Which prints its processor time and that of the test.
    let script = format!("ulimit -S -t {SLOW_S}; \"$0\" \"$@\" >&2 || exit; times");
    let output =
        command(&script, program, name, share).env("HAPTICORE_REACHED", record).output()?;
    if !output.status.success() {
        return Ok(None);
    }
    seconds(&String::from_utf8(output.stdout)?).context("what `times` prints").map(Some)
}

/// The numbers in a record; there is none where no mutant is met.
fn read(record: &Path) -> Result<BTreeSet<usize>> {
    let mut numbers = BTreeSet::new();
    let Ok(text) = fs::read_to_string(record) else { return Ok(numbers) };
    for line in text.lines() {
        let (first, last) = line.split_once(' ').context("two numbers")?;
        numbers.extend(first.parse::<usize>()?..=last.parse()?);
    }
    fs::remove_file(record)?;
    Ok(numbers)
}

/// The user time of child processes in what `times` of a shell prints: `0m1.23s 0m0.04s` in the second
/// line.
fn seconds(times: &str) -> Option<Duration> {
    let (minutes, seconds) = times.lines().nth(1)?.split(' ').next()?.split_once('m')?;
    let seconds: f64 = seconds.strip_suffix('s')?.parse().ok()?;
    Some(Duration::from_secs_f64(60.0 * minutes.parse::<f64>().ok()? + seconds))
}

/// A script that runs a test with a share of its operations, in the folder where cargo would.
fn command(script: &str, program: &Program, test: &str, share: u64) -> Command {
    let mut command = Command::new("sh");
    command
        .args(["-c", &format!("ulimit -v {MEMORY}; ulimit -c 0; {script}")])
        .arg(&program.path)
        .args(["--exact", test, "--test-threads", "1"])
        .env("RUST_BACKTRACE", "0")
        .env("HAPTICORE_SHARE", share.to_string())
        .current_dir(&program.folder)
        .stdin(Stdio::null())
        .stderr(Stdio::null());
    command
}

/// Runs a test with a mutant enabled and a share of its operations, for so many seconds of processor time.
pub fn run(test: &Test, mutant: usize, share: u64, limit: u64) -> Result<End> {
    let script = format!("ulimit -S -t {limit}; exec \"$0\" \"$@\"");
    let mut child = command(&script, &test.program, &test.name, share)
        .env("HAPTICORE_MUTANT", mutant.to_string())
        .stdout(Stdio::null())
        .spawn()?;
    wait(&mut child, PATIENCE * Duration::from_secs(limit))
}

fn wait(child: &mut Child, limit: Duration) -> Result<End> {
    let (begun, mut pause) = (Instant::now(), Duration::from_micros(500));
    loop {
        match child.try_wait()? {
            Some(status) if status.success() => return Ok(End::Passed),
            Some(status) if status.signal() == Some(SIGXCPU) => return Ok(End::TimedOut),
            Some(_) => return Ok(End::Failed),
            None if begun.elapsed() > limit => {
                child.kill()?;
                child.wait()?;
                return Ok(End::TimedOut);
            }
            None => thread::sleep(pause),
        }
        pause = (pause * 2).min(Duration::from_millis(10));
    }
}

/// Does something with each item, on some threads; the results in the order of the items.
pub fn parallel<T: Sync, R: Send>(
    jobs: usize,
    items: &[T],
    work: impl Fn(usize, &T) -> R + Sync,
) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let lane = || {
        let mut done = Vec::new();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(index) else { return done };
            done.push((index, work(index, item)));
        }
    };
    let mut results: Vec<_> = thread::scope(|scope| {
        let lanes: Vec<_> = (0..jobs).map(|_| scope.spawn(lane)).collect();
        lanes
            .into_iter()
            .flat_map(|lane| lane.join().expect("a thread that does not panic"))
            .collect()
    });
    results.sort_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_the_order_of_items() {
        let items: Vec<usize> = (0..100).collect();
        let squares = parallel(3, &items, |index, item| index * item);
        assert!((0..100).all(|n| squares[n] == n * n));
    }

    #[test]
    fn a_shell_prints_times() {
        let times = seconds("0m0.01s 0m0.02s\n2m3.50s 0m0.10s\n");
        assert_eq!(times, Some(Duration::from_millis(123_500)));
        assert_eq!(seconds("nothing"), None);
    }

    #[test]
    fn a_test_ends_by_its_status_or_its_time() {
        let end = |script: &str| {
            let mut child = Command::new("sh").args(["-c", script]).spawn().expect("a shell");
            wait(&mut child, Duration::from_secs(2)).expect("it is waited for")
        };
        assert_eq!(end("exit 0"), End::Passed);
        assert_eq!(end("exit 101"), End::Failed);
        assert_eq!(end("kill -ABRT $$"), End::Failed);
        assert_eq!(end("kill -XCPU $$"), End::TimedOut);
        assert_eq!(end("exec sleep 60"), End::TimedOut);
    }
}
