// SPDX-License-Identifier: MIT OR Apache-2.0
//! What every campaign of faults needs: two processors, and the list of faults that change nothing.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Mutex;

use hapticore_synth::certificates::Subject;

/// Whether every place is to be tried, not a sample: `FAULTS=all`.
pub fn all() -> bool {
    std::env::var("FAULTS").is_ok_and(|which| which == "all")
}

/// The faults of a list, each as it is displayed on a line of its own under the reason (`#`) why it
/// changes nothing.
pub fn equivalent(list: &str) -> BTreeSet<&str> {
    list.lines().filter(|line| !line.is_empty() && !line.starts_with('#')).collect()
}

/// What decides whether a fault is noticed, besides the design and what it is given.
const HARNESS: [&str; 2] = ["tests/src/faults", "tests/src/lockstep"];

/// The numbers of the faults that nobody notices: those of the certificate about this, or what `ask` finds.
///
/// # Panics
/// Where `ask` does.
pub fn missed(who: &str, subject: Subject, ask: impl FnOnce() -> Vec<usize>) -> Vec<usize> {
    let words = |numbers: Vec<usize>| numbers.iter().map(usize::to_string).collect::<Vec<_>>();
    let verdict = subject
        .and_files(&HARNESS)
        .verdict(&format!("faults that survive in {who}"), || words(ask()).join(" "));
    verdict.split_whitespace().map(|number| number.parse().expect("a number")).collect()
}

/// What two threads make of all of these, in any order.
///
/// # Panics
/// Where one does.
pub fn two_at_a_time<T: Sync, R: Send>(all: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let (open, done) = (Mutex::new(all.iter().enumerate()), Mutex::new(BTreeMap::new()));
    let next = || open.lock().expect("no panic").next();
    let work = || {
        while let Some((index, item)) = next() {
            let result = work(item);
            done.lock().expect("no panic").insert(index, result);
        }
    };
    std::thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(work))));
    done.into_inner().expect("no panic").into_values().collect()
}
