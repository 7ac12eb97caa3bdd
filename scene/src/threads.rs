// SPDX-License-Identifier: MIT OR Apache-2.0
//! Lists made on several threads, for what a scene waits for before its first slot.
//!
//! The threads are scoped, not those of a pool: a table is made while others wait for it, and a pool's thread that
//! waited there for the pool could be waiting for itself.

use std::ops::Range;
use std::sync::OnceLock;
use std::thread;

/// Threads at most: to start one takes as long as some hundredths of what they share.
const MOST: usize = 4;

/// A list of `count` items; each thread makes a part of at least `least` of them.
pub(crate) fn in_parts<T: Send>(
    count: usize,
    least: usize,
    make: impl Fn(Range<usize>) -> Vec<T> + Sync,
) -> Vec<T> {
    let parts = (count / least).clamp(1, threads());
    let part = |n: usize| make(n * count / parts..(n + 1) * count / parts);
    thread::scope(|scope| {
        let part = &part;
        let others: Vec<_> = (1..parts).map(|n| scope.spawn(move || part(n))).collect();
        let mut list = part(0);
        for other in others {
            list.extend(other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        }
        list
    })
}

fn threads() -> usize {
    static THREADS: OnceLock<usize> = OnceLock::new();
    *THREADS.get_or_init(|| thread::available_parallelism().map_or(1, |all| all.get().min(MOST)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_item_is_made_once_in_its_place() {
        for count in [0, 1, 7, 8, 9, 31, 100] {
            for least in [1, 3, 8, 1000] {
                let list = in_parts(count, least, Iterator::collect::<Vec<_>>);
                assert_eq!(list, (0..count).collect::<Vec<_>>(), "{count}, {least}");
            }
        }
    }

    #[test]
    fn a_part_has_the_least_that_is_worth_a_thread() {
        let parts = in_parts(100, 40, |part| vec![part.len()]);
        assert!(parts.iter().all(|length| *length >= 40), "{parts:?}");
    }
}
