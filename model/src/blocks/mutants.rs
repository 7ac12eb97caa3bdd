// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tests of each block notice faults of its netlist. `./test` judges a sample, of blocks whose tests are quick; all are
//! judged by `MUTANTS=all cargo test --profile checked -p hapticore-model --lib mutants_of -- --nocapture`.

use crate::support::campaign::{Table, group, wanted};

/// Mutants that no test notices, and that no tool has proved to be equivalent.
const MISSED: &str = include_str!("mutants.txt");

/// Mutants that are proved to be equivalent, in their block or in cores, by `synth/tests/toolchain/mutants/`.
const PROVED: [&str; 2] = [include_str!("equivalent.txt"), include_str!("equivalent_in_cores.txt")];

/// The page with the table of results.
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/mutation.md");

/// Judged always: every n-th mutant of a block.
const SAMPLE: [(&str, usize); 3] = [("multiplexer", 1), ("pace", 1), ("multiplier", 2)];

/// All blocks, each of which has a folder of tests.
fn blocks() -> impl Iterator<Item = &'static str> {
    let lines = include_str!("mod.rs").lines();
    lines.filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'))
}

/// Judges every `step`-th mutant of a block.
fn judge(block: &str, step: usize, table: &mut Table) {
    // The drives' tests are those of the wall on the right, too.
    let tests = if block == "sided_wall" { "drives" } else { block };
    let path = format!("::blocks::{block}::");
    let group = group(&[&format!("blocks::{tests}::")], |of| of.contains(&path));
    group.with_proved(&PROVED.concat()).judge_each(step, table);
}

#[test]
fn mutants_of_the_netlists_are_noticed() {
    let mut table = Table::default();
    if std::env::var_os("MUTANTS").is_none() {
        SAMPLE.iter().for_each(|&(block, step)| judge(block, step, &mut table));
    }
    blocks().filter(|block| wanted(block)).for_each(|block| judge(block, 1, &mut table));
    if std::env::var_os("MUTANTS").is_some() {
        table.write(PAGE, "Blocks of the core:");
    }
    table.check(MISSED);
}
