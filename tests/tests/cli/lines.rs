// SPDX-License-Identifier: MIT OR Apache-2.0
//! Command lines made from the command's declaration (docs/fuzzing.md): 300 here, as many as `LINES` says by
//! `fuzz/lines`.

use std::ffi::OsStr;
use std::path::Path;
use std::time::Duration;

use clap::{Arg, ArgAction, Command, CommandFactory};
use hapticore::args::Args;
use hapticore_tests::fuzz::commands::{Desk, Ended, Generator, Tally, run};
use rayon::prelude::*;

/// Lines where the environment's `LINES` does not say how many.
const LINES: usize = 300;

/// Lines that are made before they are run together.
const AT_A_TIME: usize = 64;

/// Lines that take so long are printed.
const SLOW: Duration = Duration::from_secs(5);

/// The command's file.
fn program() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_hapticore-command"))
}

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
    let desk = Desk::new(program());
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
            if ended.took >= SLOW {
                println!("{line:?}\n    took {} s", ended.took.as_secs());
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

/// Lines of a command with a flag and an option.
fn lines_with(option: Arg) -> Vec<String> {
    let flag = Arg::new("fresh").long("fresh").action(ArgAction::SetTrue);
    let new = Command::new("new").arg(flag).arg(option);
    let mut command = Command::new("hapticore").subcommand(new).subcommand_required(true);
    command.build();
    let desk = Desk::of_seeds(program());
    let mut generator = Generator::new(&command, &desk, 1);
    let lines = (0..200).map(|_| generator.line());
    lines.map(|line| line.join(OsStr::new(" ")).to_string_lossy().into_owned()).collect()
}

#[test]
fn a_new_subcommand_its_flag_and_its_listed_values_are_generated() {
    let option = Arg::new("level").long("level").value_parser(["low", "high"]);
    let lines = lines_with(option);
    for word in ["--fresh", "--level low", "--level=high"] {
        assert!(lines.iter().any(|line| line.contains(word)), "{word}: in none of {lines:#?}");
    }
}

#[test]
#[should_panic(expected = "a new option, whose values are to be added")]
fn a_new_option_without_known_values_stops_the_test() {
    lines_with(Arg::new("thing").long("thing").value_name("THING"));
}
