// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tests of a board's blocks notice faults of their netlists. `./test` judges a sample of blocks whose tests are quick; all
//! are judged by `MUTANTS=all cargo test --profile checked -p hapticore-rtl --test board mutants_of -- --nocapture`.

use crate::campaign::{Table, group, wanted};

/// Mutants that no test notices, and that no tool has proved to be equivalent.
const MISSED: &str = include_str!("mutants.txt");

/// Judged always: every n-th mutant of a block, by these tests.
const SAMPLE: [(&str, &str, usize); 2] = [("pads", "blocks::", 4), ("sigma_delta", "blocks::", 1)];

#[test]
fn mutants_of_the_netlists_are_noticed() {
    let mut table = Table::default();
    if std::env::var_os("MUTANTS").is_none() {
        for (block, tests, step) in SAMPLE {
            let path = format!("hapticore_rtl::board::{block}::");
            group(tests, |of| of.starts_with(&path)).judge_each(step, &mut table);
        }
    } else {
        // All tests of this program: which of them clock a block says the list.
        let board = |of: &str| of.split("::").nth(2).is_some_and(wanted);
        let own = |of: &str| of.starts_with("hapticore_rtl::board::") && board(of);
        group("", own).judge_each(1, &mut table);
    }
    table.check(MISSED);
}
