// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tests of a board's blocks notice faults of their netlists. `./test` judges a sample of blocks whose tests are quick; all
//! are judged by `MUTANTS=all cargo test --profile checked -p hapticore-rtl --test board mutants_of -- --nocapture`.

use crate::campaign::{Table, group, wanted};

/// Mutants that no test notices, and that no tool has proved to be equivalent.
const MISSED: &str = include_str!("mutants.txt");

/// Mutants that are proved to be equivalent in their block, by `synth/tests/toolchain/mutants/`.
const PROVED: &str = include_str!("equivalent.txt");

/// The page with the table of results.
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/mutation.md");

/// Blocks, and the names of the tests that judge them: those that clock the block alone and take seconds with its netlist.
const BLOCKS: [(&str, &[&str]); 5] = [
    ("pads", &["blocks::"]),
    ("sigma_delta", &["blocks::"]),
    ("uart", &["blocks::"]),
    ("registers", &["blocks::"]),
    ("drive_output", &DRIVE_OUTPUT),
];

/// Of a drive output.
const DRIVE_OUTPUT: [&str; 9] = [
    "drive_output::a_disabled_output",
    "drive_output::a_fault",
    "drive_output::a_reference",
    "drive_output::a_sine",
    "drive_output::a_word",
    "drive_output::code_zero",
    "drive_output::every_channel",
    "drive_output::live_falls",
    "drive_output::without_drive_words",
];

/// Judged always: every n-th mutant of these blocks.
const SAMPLE: [(&str, usize); 2] = [("pads", 4), ("sigma_delta", 1)];

/// Judges every `step`-th mutant of a block.
fn judge(block: &str, step: usize, table: &mut Table) {
    let (_, tests) = BLOCKS.iter().find(|(name, _)| *name == block).expect("a block with tests");
    let path = format!("hapticore_rtl::board::{block}::");
    let group = group(tests, |of| of.starts_with(&path));
    group.with_proved(PROVED).judge_each(step, table);
}

#[test]
fn mutants_of_the_netlists_are_noticed() {
    let mut table = Table::default();
    if std::env::var_os("MUTANTS").is_none() {
        SAMPLE.iter().for_each(|&(block, step)| judge(block, step, &mut table));
    } else {
        let blocks = BLOCKS.iter().filter(|(block, _)| wanted(block));
        blocks.for_each(|(block, _)| judge(block, 1, &mut table));
        table.write(PAGE, "Blocks of boards:");
    }
    table.check(MISSED);
}
