// SPDX-License-Identifier: MIT OR Apache-2.0
//! Completion in a shell, which asks the command itself: `source <(COMPLETE=bash hapticore)`. Bundled scenes, profiles, keys of
//! scenes and the words that they take are completed, beside commands, options and files.

use std::ffi::OsStr;

use clap::{Arg, Command, CommandFactory as _};
use clap_complete::engine::{
    ArgValueCompleter, CompletionCandidate, PathCompleter, ValueCompleter as _,
};
use clap_complete::env::CompleteEnv;
use hapticore_contract::profile::BUNDLED;
use hapticore_scene::gallery;
use hapticore_scene::reference::{KeyInfo, Kind, SECTIONS, Section};

use crate::args::Args;
use crate::reference::PAGES;

/// Prints candidates, or the script by which a shell asks for them, and ends, where a shell has set `COMPLETE`.
pub fn complete() {
    CompleteEnv::with_factory(|| completed(Args::command())).complete();
}

fn completed(command: Command) -> Command {
    command.mut_args(with_values).mut_subcommands(completed)
}

/// An argument with the values that it may take, by its name, which is the same in all commands.
fn with_values(argument: Arg) -> Arg {
    let values: fn() -> Vec<CompletionCandidate> = match argument.get_id().as_str() {
        "scene" => scenes,
        "profile" => profiles,
        "set" => keys,
        "key" => topics,
        _ => return argument,
    };
    let takes_files = ["scene", "profile"].contains(&argument.get_id().as_str());
    let complete = move |current: &OsStr| {
        let start = current.to_string_lossy();
        let is_near =
            |value: &CompletionCandidate| value.get_value().to_string_lossy().starts_with(&*start);
        let files = takes_files.then(|| PathCompleter::file().complete(current));
        values().into_iter().filter(is_near).chain(files.into_iter().flatten()).collect()
    };
    argument.add(ArgValueCompleter::new(complete))
}

fn candidate(value: impl Into<String>, says: &str) -> CompletionCandidate {
    CompletionCandidate::new(value.into()).help(Some(says.to_string().into()))
}

fn scenes() -> Vec<CompletionCandidate> {
    gallery::all().iter().map(|(name, _)| candidate(*name, "bundled scene")).collect()
}

fn profiles() -> Vec<CompletionCandidate> {
    BUNDLED.iter().map(|(name, _)| candidate(*name, "bundled profile")).collect()
}

/// Keys as `--set` takes them, of the first entry of a list; with their words, where they take words.
fn keys() -> Vec<CompletionCandidate> {
    tables().flat_map(|table| table.keys().flat_map(move |key| settings(table, key))).collect()
}

fn settings(table: &Section, key: &KeyInfo) -> Vec<CompletionCandidate> {
    let name = format!("{}{}=", prefix(table), key.name);
    let words = match key.kind {
        Kind::Words(words) => words(),
        Kind::Flag => vec!["true", "false"],
        _ => Vec::new(),
    };
    let of = |word: &str| candidate(format!("{name}{word}"), key.says());
    std::iter::once("").chain(words).map(of).collect()
}

/// What stands before a table's keys: `pad.0.` of `[[pad]]`.
fn prefix(table: &Section) -> String {
    match (table.path, table.is_list) {
        ("", _) => String::new(),
        (path, true) => format!("{path}.0."),
        (path, false) => format!("{path}."),
    }
}

/// What `reference` explains.
fn topics() -> Vec<CompletionCandidate> {
    let pages = PAGES.iter().map(|(name, title, _)| candidate(*name, title));
    let is_page = |path: &str| path.is_empty() || PAGES.iter().any(|(name, ..)| *name == path);
    let tables = tables().filter(|table| !is_page(table.path));
    pages.chain(tables.map(|table| candidate(table.path, table.says))).collect()
}

/// Tables whose keys have a place of their own in a scene.
fn tables() -> impl Iterator<Item = &'static Section> {
    SECTIONS.iter().filter(|table| !table.is_form())
}
