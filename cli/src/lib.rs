// SPDX-License-Identifier: MIT OR Apache-2.0
//! The `hapticore` command as a library, so that tests can run it whole.
//!
//! | module | does |
//! | --- | --- |
//! | [`args`] | the command line |
//! | [`simulate`], [`replay`], [`hdl`], [`codes`](mod@codes), [`calibrate`], [`tradeoff`], [`sweep`], [`scenes`], [`mod@reference`], [`new`], [`live`], [`host`] | one command each |
//! | [`output`], [`print`](mod@print), [`report`] | what a run leaves: a folder of files, lines on the terminal, a page of figures |
//! | [`waves`] | waveforms of a case |
//! | `completion` | candidates for a shell |
//! | [`folder`], [`console`], [`progress`] | which folder; standard output that may be closed; how far a run is |
//!
//! Running itself is `hapticore-run`'s.

pub mod args;
pub mod calibrate;
pub mod codes;
mod completion;
pub mod console;
pub mod control_words;
pub mod folder;
pub mod hdl;
pub mod host;
pub mod live;
pub mod new;
pub mod output;
pub mod print;
pub mod progress;
pub mod reference;
pub mod replay;
pub mod report;
pub mod scenes;
pub mod simulate;
pub mod stability;
pub mod sweep;
pub mod tradeoff;
pub mod waves;
mod words;

use std::process::ExitCode;

use args::{Args, Command};
use clap::Parser;
use hapticore_run::interrupt;

/// Runs the command line. The exit code is 0 where all criteria hold, 1 where one fails, 2 on bad
/// input, and 130 where the run was told to stop.
pub fn main() -> ExitCode {
    completion::complete();
    let args = Args::parse();
    interrupt::listen();
    let outcome = match args.command {
        Command::Scenes(args) => scenes::run(&args),
        Command::Reference(args) => reference::run(&args),
        Command::New(args) => new::run(&args),
        Command::Simulate(args) => simulate::run(&args),
        Command::Replay(args) => replay::run(&args),
        Command::Hdl(args) => hdl::run(&args),
        Command::Codes(args) => codes::run(&args),
        Command::Tradeoff(args) => tradeoff::run(&args),
        Command::Sweep(args) => sweep::run(&args),
        Command::Calibrate(args) => calibrate::run(&args),
        Command::Live(args) => live::run(&args),
        Command::Host(args) => host::run(&args),
    };
    match outcome.and_then(|holds| console::finish().map(|()| holds)) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) if interrupt::check().is_err() => {
            // A sweep keeps what it has run.
            match error.downcast_ref::<sweep::Stopped>() {
                Some(stopped) => console::complain(format_args!("{stopped}")),
                None => console::complain(format_args!("{}", interrupt::Interrupted)),
            }
            ExitCode::from(interrupt::STATUS)
        }
        Err(error) => {
            let error = one_line(&error);
            console::complain(format_args!("{} {error}", console::red_of_stderr("error:")));
            ExitCode::from(2)
        }
    }
}

/// The longest message, characters: what an input holds is cited, however long.
const LONGEST: usize = 2000;

/// The error and its causes, joined by colons: one line that a terminal shows as it is, whatever was
/// in the input that it cites.
///
/// ```
/// let error = anyhow::anyhow!("i1: expected a code, got \"\u{1b}[2J\"").context("c.csv:3");
/// assert_eq!(hapticore::one_line(&error), r#"c.csv:3: i1: expected a code, got "\u{1b}[2J""#);
/// ```
pub fn one_line(error: &anyhow::Error) -> String {
    let line = format!("{error:#}").lines().map(str::trim).collect::<Vec<_>>().join(" ");
    let shown = |c: char| match c {
        '"' | '\'' | '\\' => String::from(c),
        // As it is, but for what moves a terminal's cursor or turns its text around.
        c => c.escape_debug().collect(),
    };
    let mut start: String = line.chars().take(LONGEST).map(shown).collect();
    if line.chars().nth(LONGEST).is_some() {
        start.push('…');
    }
    start
}
