// SPDX-License-Identifier: MIT OR Apache-2.0
//! Command lines made from the command's declaration (docs/fuzzing.md): some hundred here, as many as `LINES` says by
//! `fuzz/lines`.

use std::path::Path;

use clap::CommandFactory;
use hapticore::args::Args;
use hapticore_tests::fuzz::commands::{Desk, Ended, Generator, Tally, run};
use rayon::prelude::*;

/// Lines where the environment's `LINES` does not say how many.
const LINES: usize = 300;

/// Lines that are made before they are run together.
const AT_A_TIME: usize = 64;

fn number(name: &str, default: u64) -> u64 {
    std::env::var(name)
        .map_or(default, |text| text.parse().unwrap_or_else(|_| panic!("{name}={text}")))
}

/// Every subcommand and option comes once in 200 lines, at least half of the lines are accepted, and a tenth runs to its end.
#[test]
fn no_command_line_panics_hangs_or_leaves_half_a_file() {
    let lines = number("LINES", LINES as u64) as usize;
    let mut command = Args::command();
    command.build();
    let desk = Desk::new(Path::new(env!("CARGO_BIN_EXE_hapticore-command")));
    let mut generator = Generator::new(&command, &desk, number("SEED", 1));
    let (mut tally, mut findings) = (Tally::new(&command), Vec::new());
    while tally.lines < lines {
        let made: Vec<_> =
            (0..AT_A_TIME.min(lines - tally.lines)).map(|_| generator.line()).collect();
        let ended: Vec<Ended> = made.par_iter().map(|line| run(&desk, line)).collect();
        for (line, ended) in made.iter().zip(&ended) {
            if tally.count(line) {
                tally.ended(ended);
            }
            for finding in &ended.findings {
                println!("{line:?}\n    {finding}");
                findings.push(line.clone());
            }
        }
    }
    println!("{tally}");
    assert!(findings.is_empty(), "{} findings", findings.len());
    assert!(2 * tally.accepted >= tally.lines, "half of the lines are accepted");
    let (rarest, count) = tally.rarest();
    assert!(200 * count >= tally.lines, "{rarest}: {count} times in {} lines", tally.lines);
    let done: usize = [0, 1].iter().filter_map(|status| tally.statuses.get(status)).sum();
    assert!(10 * done >= tally.lines, "{done} of {} lines run to their end", tally.lines);
}
