// SPDX-License-Identifier: MIT OR Apache-2.0
//! Command lines of a declared command: the argument that came most seldom, some others, in any order; one line in
//! ten has a word too many, too few or elsewhere.

use std::collections::BTreeMap;
use std::ffi::OsString;

use clap::{Arg, ArgAction, Command, Id};
use fastrand::Rng;

use super::desk::Desk;
use super::tally::{is_help, name};
use super::values::{self, Values};

/// Subcommands of many options or inputs come oftener than others.
const OFTEN: [(&str, u32); 6] =
    [("simulate", 8), ("replay", 5), ("hdl", 6), ("host", 4), ("codes", 3), ("new", 2)];

/// What the parser takes only beside another option: subcommand, option, the other.
const BESIDE: [(&str, &str, &str); 10] = [
    ("hdl", "baud", "board"),
    ("hdl", "clock_hz", "dac"),
    ("hdl", "full_scale_v", "dac"),
    ("live", "listen", "token"),
    ("live", "token", "listen"),
    ("host", "page_port", "page"),
    ("host", "open", "page"),
    ("host", "target", "arm"),
    ("host", "wave", "dac"),
    ("host", "full_scale_v", "dac"),
];

/// All but one line in this many are made for the argument that came most seldom.
const FOR_RAREST: u8 = 3;

/// One value in this many is hostile.
const HOSTILE: u32 = 12;

/// One line in this many may have options that exclude each other.
const EXCLUDING: u32 = 8;

/// What keeps scenes short that go on in time.
const SHORT: &str = "--set=duration_s=0.01";

/// What ends a run of `tradeoff` as soon as its options are read, in all but one of `RUN` lines: a run takes many
/// seconds.
const REFUSED: &str = "--scene=no-such-scene";
const RUN: u32 = 60;

/// What keeps the others short.
const FEW: [(&str, &str); 2] = [("--scene", "minimal-sheet"), ("--slots", "1")];

/// Words that are in the wrong place.
const WORDS: [&str; 10] =
    ["--", "-", "-h", "--help", "--version", "--no-such-option", "simulate", "", "--out", "-x"];

/// Makes lines without end.
pub struct Generator<'a> {
    rng: Rng,
    values: Values<'a>,
    command: Command,
    leaves: Vec<(String, Command)>,
    /// Lines that the parser accepts, by argument.
    used: BTreeMap<String, usize>,
}

impl<'a> Generator<'a> {
    /// Of a command; the same seed makes the same lines.
    pub fn new(command: &Command, desk: &'a Desk, seed: u64) -> Self {
        let mut leaves = Vec::new();
        add_leaves(command, "", &mut leaves);
        Generator {
            rng: Rng::with_seed(seed),
            values: Values::new(desk),
            command: command.clone(),
            leaves,
            used: BTreeMap::new(),
        }
    }

    /// A line, without the command's own name.
    pub fn line(&mut self) -> Vec<OsString> {
        let seldom = self.rng.u8(..FOR_RAREST) > 0;
        let (path, leaf) = if seldom { self.rarest() } else { self.leaf() };
        let scene = self.values.scene(&mut self.rng);
        let mut groups: Vec<Vec<OsString>> = Vec::new();
        let mut positionals = Vec::new();
        let arguments = self.arguments(&path, &leaf, seldom);
        for argument in &arguments {
            let words = self.words(&path, argument, &scene);
            // Positional ones keep their order, wherever options stand.
            let group = if argument.is_positional() { &mut positionals } else { &mut groups };
            group.extend(words);
        }
        self.rng.shuffle(&mut groups);
        let at = self.rng.usize(..=groups.len());
        groups.splice(at..at, positionals);
        let short = self.shortened(&path, &scene, &groups);
        let mut line: Vec<OsString> = path.split(' ').map(OsString::from).collect();
        line.extend(groups.into_iter().flatten());
        if self.rng.u8(..10) == 0 {
            self.misplace(&mut line);
        }
        // Behind what is misplaced, so that no such line runs in full.
        line.extend(short.into_iter().flatten());
        if self.is_accepted(&line) {
            for argument in &arguments {
                *self.used.entry(name(&path, argument)).or_default() += 1;
            }
        }
        line
    }

    fn is_accepted(&self, line: &[OsString]) -> bool {
        let name = OsString::from("hapticore");
        let words = std::iter::once(&name).chain(line);
        self.command.clone().try_get_matches_from(words).is_ok()
    }

    fn leaf(&mut self) -> (String, Command) {
        let weight = |(path, _): &(String, Command)| {
            OFTEN.iter().find(|(name, _)| name == path).map_or(1, |(_, weight)| *weight)
        };
        let all: u32 = self.leaves.iter().map(weight).sum();
        let mut left = self.rng.u32(..all);
        let chosen = self.leaves.iter().find(|leaf| match left.checked_sub(weight(leaf)) {
            Some(less) => {
                left = less;
                false
            }
            None => true,
        });
        chosen.expect("the weights' sum").clone()
    }

    /// The subcommand of the optional argument that came most seldom.
    fn rarest(&self) -> (String, Command) {
        let count = |(path, leaf): &&(String, Command)| {
            let optional = leaf
                .get_arguments()
                .filter(|argument| !is_help(argument) && !argument.is_required_set());
            let used = |argument: &Arg| self.used.get(&name(path, argument)).copied();
            optional.map(|argument| used(argument).unwrap_or(0)).min().unwrap_or(usize::MAX)
        };
        self.leaves.iter().min_by_key(count).expect("a subcommand").clone()
    }

    /// The arguments of a line: those required, the rarest in two of three lines and always in a line that is made for it
    /// (`seldom`), and one in six of the others; most lines have none that exclude each other.
    fn arguments(&mut self, path: &str, leaf: &Command, seldom: bool) -> Vec<Arg> {
        let all: Vec<&Arg> = leaf.get_arguments().filter(|argument| !is_help(argument)).collect();
        let used = |argument: &&&Arg| self.used.get(&name(path, argument)).copied().unwrap_or(0);
        let optional = all.iter().filter(|argument| !argument.is_required_set());
        let rarest = optional.min_by_key(used).map(|argument| argument.get_id().clone());
        let rarest = rarest.filter(|_| seldom || self.rng.u8(..3) > 0);
        let mut chosen = Vec::new();
        for argument in &all {
            let share =
                if argument.is_required_set() || argument.is_positional() { 0.98 } else { 0.17 };
            if rarest.as_ref() == Some(argument.get_id()) || self.rng.f64() < share {
                chosen.push((*argument).clone());
            }
        }
        if self.rng.u32(..EXCLUDING) > 0 {
            chosen = together(leaf, chosen, rarest.as_ref());
        }
        let has = |chosen: &[Arg], id: &str| chosen.iter().any(|argument| argument.get_id() == id);
        for (_, id, other) in BESIDE.iter().filter(|(of, ..)| *of == path) {
            if has(&chosen, id) && !has(&chosen, other) {
                let other = all.iter().find(|argument| argument.get_id() == other);
                chosen.extend(other.map(|argument| (*argument).clone()));
            }
        }
        chosen
    }

    /// An argument's words, once or several times.
    fn words(&mut self, path: &str, argument: &Arg, scene: &str) -> Vec<Vec<OsString>> {
        let several = matches!(argument.get_action(), ArgAction::Append)
            || argument.get_num_args().is_some_and(|number| number.max_values() > 1);
        let times = if several { self.rng.usize(1..4) } else { 1 };
        (0..times).map(|_| self.word(path, argument, scene)).collect()
    }

    fn word(&mut self, path: &str, argument: &Arg, scene: &str) -> Vec<OsString> {
        let long = argument.get_long().map(|long| OsString::from(format!("--{long}")));
        let takes = argument.get_action().takes_values();
        let value = takes.then(|| match self.rng.u32(..HOSTILE) {
            0 => values::hostile(&mut self.rng),
            _ => self.values.value(&mut self.rng, path, argument, scene),
        });
        match (long, value) {
            (Some(long), Some(value)) if self.rng.bool() => vec![join(long, value)],
            (long, value) => long.into_iter().chain(value).collect(),
        }
    }

    /// What keeps a run short.
    fn shortened(
        &mut self,
        path: &str,
        scene: &str,
        given: &[Vec<OsString>],
    ) -> Vec<Vec<OsString>> {
        let has = |option: &str| {
            given.iter().flatten().any(|word| word.to_string_lossy().starts_with(option))
        };
        match path {
            "simulate" if self.values.is_timed(scene) => vec![vec![SHORT.into()]],
            "tradeoff" if self.rng.u32(..RUN) > 0 => vec![vec![REFUSED.into()]],
            "tradeoff" => {
                let missing = FEW.iter().filter(|(option, _)| !has(option));
                missing.map(|(option, value)| vec![option.into(), value.into()]).collect()
            }
            _ => Vec::new(),
        }
    }

    /// A word twice, left out, exchanged with another, cut, or one that does not belong there.
    fn misplace(&mut self, line: &mut Vec<OsString>) {
        let (at, to) = (self.rng.usize(..line.len()), self.rng.usize(..line.len()));
        match self.rng.u8(..5) {
            0 => line.insert(to, line[at].clone()),
            // Without a word the command prints its help.
            1 if line.len() > 1 => drop(line.remove(at)),
            2 => line.swap(at, to),
            3 => {
                let text = line[at].to_string_lossy().into_owned();
                line[at] =
                    text.chars().take(text.chars().count() / 2 + 1).collect::<String>().into();
            }
            _ => line.insert(at, self.rng.choice(WORDS).expect("a word").into()),
        }
    }
}

/// The arguments that the parser takes together: `first`, then each that none before it excludes.
fn together(leaf: &Command, mut chosen: Vec<Arg>, first: Option<&Id>) -> Vec<Arg> {
    chosen.sort_by_key(|argument| Some(argument.get_id()) != first);
    let mut kept: Vec<Arg> = Vec::new();
    for argument in chosen {
        let excludes = |a: &Arg, b: &Arg| {
            leaf.get_arg_conflicts_with(a).iter().any(|of| of.get_id() == b.get_id())
        };
        if !kept.iter().any(|of| excludes(of, &argument) || excludes(&argument, of)) {
            kept.push(argument);
        }
    }
    let index =
        |argument: &Arg| leaf.get_arguments().position(|of| of.get_id() == argument.get_id());
    kept.sort_by_key(index);
    kept
}

fn join(mut long: OsString, value: OsString) -> OsString {
    long.push("=");
    long.push(value);
    long
}

/// Commands that can be run: those without subcommands, and those that need none.
fn add_leaves(command: &Command, path: &str, leaves: &mut Vec<(String, Command)>) {
    let below: Vec<_> =
        command.get_subcommands().filter(|command| command.get_name() != "help").collect();
    if !command.is_subcommand_required_set() && !path.is_empty() || below.is_empty() {
        leaves.push((path.into(), command.clone()));
    }
    for subcommand in below {
        add_leaves(subcommand, format!("{path} {}", subcommand.get_name()).trim(), leaves);
    }
}
