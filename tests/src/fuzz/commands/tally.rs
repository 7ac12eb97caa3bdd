// SPDX-License-Identifier: MIT OR Apache-2.0
//! How often each subcommand and option came in lines that the parser accepts, and how runs ended.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fmt;

use clap::parser::ValueSource;
use clap::{ArgMatches, Command};

use super::run::Ended;

/// A subcommand or one of its arguments, as `sweep submit --engine` or `sweep submit PLAN`.
pub type Part = String;

/// Counts.
#[derive(Debug, Clone)]
pub struct Tally {
    command: Command,
    /// Lines.
    pub lines: usize,
    /// Lines that the parser accepts.
    pub accepted: usize,
    /// Accepted lines by subcommand and argument.
    pub parts: BTreeMap<Part, usize>,
    /// Runs of accepted lines by exit status.
    pub statuses: BTreeMap<i32, usize>,
}

impl Tally {
    /// Of a command, nothing counted yet.
    pub fn new(command: &Command) -> Self {
        let mut parts = Vec::new();
        declared(command, "", &mut parts);
        let parts = parts.into_iter().map(|part| (part, 0)).collect();
        let command = command.clone();
        Tally { command, lines: 0, accepted: 0, parts, statuses: BTreeMap::new() }
    }

    /// Counts a line; whether the parser accepts it.
    pub fn count(&mut self, line: &[OsString]) -> bool {
        self.lines += 1;
        let name = OsString::from("hapticore");
        let words = std::iter::once(&name).chain(line);
        let Ok(matches) = self.command.clone().try_get_matches_from(words) else { return false };
        self.accepted += 1;
        let mut parts = Vec::new();
        given(&self.command, &matches, "", &mut parts);
        for part in parts {
            *self.parts.get_mut(&part).expect("a declared part") += 1;
        }
        true
    }

    /// Counts how an accepted line's run ended.
    pub fn ended(&mut self, ended: &Ended) {
        *self.statuses.entry(ended.status.unwrap_or(-1)).or_default() += 1;
    }

    /// The part that came most seldom, and how often.
    pub fn rarest(&self) -> (&Part, usize) {
        let (part, count) = self.parts.iter().min_by_key(|(_, count)| **count).expect("parts");
        (part, *count)
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (rarest, count) = self.rarest();
        writeln!(f, "{} lines, {} accepted by the parser", self.lines, self.accepted)?;
        for (status, count) in &self.statuses {
            writeln!(f, "  exit status {status}: {count}")?;
        }
        writeln!(
            f,
            "{} subcommands and arguments; rarest: {rarest}, {count} times",
            self.parts.len()
        )?;
        self.parts.iter().try_for_each(|(part, count)| writeln!(f, "  {count:6} {part}"))
    }
}

/// All subcommands and arguments below a command.
fn declared(command: &Command, path: &str, parts: &mut Vec<Part>) {
    for argument in command.get_arguments().filter(|argument| !is_help(argument)) {
        parts.push(name(path, argument));
    }
    for subcommand in command.get_subcommands().filter(|command| command.get_name() != "help") {
        let path = format!("{path} {}", subcommand.get_name()).trim().to_string();
        parts.push(path.clone());
        declared(subcommand, &path, parts);
    }
}

/// The subcommands and arguments that a line gave.
fn given(command: &Command, matches: &ArgMatches, path: &str, parts: &mut Vec<Part>) {
    for argument in command.get_arguments().filter(|argument| !is_help(argument)) {
        let id = argument.get_id().as_str();
        if matches.value_source(id) == Some(ValueSource::CommandLine) {
            parts.push(name(path, argument));
        }
    }
    let Some((chosen, below)) = matches.subcommand() else { return };
    let path = format!("{path} {chosen}").trim().to_string();
    parts.push(path.clone());
    given(command.find_subcommand(chosen).expect("a subcommand"), below, &path, parts);
}

/// Whether an argument prints something in place of a run.
pub fn is_help(argument: &clap::Arg) -> bool {
    matches!(argument.get_id().as_str(), "help" | "version")
}

/// An argument's name in a tally.
pub fn name(path: &str, argument: &clap::Arg) -> Part {
    match argument.get_long() {
        Some(long) => format!("{path} --{long}"),
        None => format!("{path} {}", argument.get_id().as_str().to_uppercase()),
    }
}
