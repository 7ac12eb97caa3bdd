// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whether a command of a document is one: of `hapticore` by its declaration, of cargo by the files that it names.

use std::fs;
use std::path::{Path, PathBuf};

use clap::CommandFactory;
use hapticore::args::Args;

use super::extract::{Snippet, is_script, is_variable};
use super::root;

/// Programs of others in blocks of commands, and who follows those blocks.
const OTHERS: [&str; 11] = [
    "python3",
    "cut",
    "iverilog",
    "vvp",
    "awk",
    "diff", // tutorial.rs runs them
    "mkdir",
    "parallel", // sweep.rs
    "hq",       // a cluster's: cli/sweep/examples/local_hyperqueue.py stands for it
    "recorder", // the reader's own; running.rs has one
    "DIR/build.sh",
];

/// How the command is called from a clone.
const FROM_A_CLONE: [&str; 4] = ["cargo", "run", "--release", "--"];

/// Whether a word is a subcommand of `hapticore`.
pub fn is_subcommand(word: &str) -> bool {
    Args::command().find_subcommand(word).is_some()
}

/// What is wrong with a snippet's commands.
pub fn errors(snippet: &Snippet) -> Vec<String> {
    let commands = commands(&snippet.text);
    let wrong = commands
        .iter()
        .filter_map(|words| error(words, snippet).map(|why| format!("{}: {why}", words.join(" "))));
    wrong.collect()
}

/// The commands of a line, word by word, without redirections.
pub fn commands(line: &str) -> Vec<Vec<String>> {
    let mut commands = vec![Vec::new()];
    let mut words = words(line).into_iter();
    while let Some(word) = words.next() {
        match word.as_str() {
            "&&" | "|" | ";" | "&" => commands.push(Vec::new()),
            ">" | "<" => drop(words.next()),
            _ => commands.last_mut().expect("a command").push(word),
        }
    }
    commands.retain(|command| !command.is_empty());
    commands
}

/// The words of a line of a shell, quotes taken off.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut quote) = (Vec::new(), None::<String>, None);
    for c in line.chars() {
        match (c, quote) {
            ('\'' | '"', None) => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (c, Some(open)) if c == open => quote = None,
            (' ', None) => words.extend(word.take()),
            (c, _) => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    words
}

/// What is wrong with a command.
fn error(words: &[String], snippet: &Snippet) -> Option<String> {
    let words: Vec<&str> =
        words.iter().map(String::as_str).skip_while(|word| is_variable(word)).collect();
    let (first, rest) = words.split_first()?;
    match *first {
        _ if words.starts_with(&FROM_A_CLONE) => of_hapticore(&words[4..], snippet.in_block),
        "hapticore" => of_hapticore(rest, snippet.in_block),
        "cargo" => of_cargo(rest),
        first if is_subcommand(first) => of_hapticore(&words, snippet.in_block),
        first if is_script(first) || !snippet.in_block || OTHERS.contains(&first) => None,
        _ => Some("no command that is known here".into()),
    }
}

/// What is wrong with arguments of `hapticore`: in a block the parser takes them as they are, in prose they may be part
/// of a line, with alternatives as `[--dac pulses|parallel]`.
fn of_hapticore(words: &[&str], in_block: bool) -> Option<String> {
    let parsed = Args::command().try_get_matches_from(std::iter::once(&"hapticore").chain(words));
    match parsed {
        Ok(_) => None,
        Err(error) if in_block => Some(error.to_string()),
        Err(_) => of_part(words),
    }
}

/// Whether the parser takes arguments of `hapticore` as they are.
pub fn is_whole(words: &[String]) -> bool {
    let name = "hapticore".to_string();
    Args::command().try_get_matches_from(std::iter::once(&name).chain(words)).is_ok()
}

/// What is wrong with part of a line: a subcommand or an option that is none, or a word that is not in an option's list.
fn of_part(words: &[&str]) -> Option<String> {
    let bare = |word: &&str| word.trim_matches(['[', ']', '…']).to_string();
    let words: Vec<String> = words.iter().map(bare).filter(|word| !word.is_empty()).collect();
    let mut command = Args::command();
    let mut words = words.iter().peekable();
    while let Some(below) = words.peek().and_then(|word| command.find_subcommand(word)).cloned() {
        command = below;
        words.next();
    }
    while let Some(word) = words.next() {
        let Some(long) = word.strip_prefix("--").filter(|long| !long.is_empty()) else { continue };
        let Some(argument) =
            command.get_arguments().find(|argument| argument.get_long() == Some(long))
        else {
            return (!["help", "version"].contains(&long)).then(|| format!("no option --{long}"));
        };
        let listed = argument.get_possible_values();
        let is_value = |word: &str| listed.iter().any(|value| value.matches(word, false));
        let given = words.next_if(|word| !word.starts_with("--"));
        let wrong = given
            .into_iter()
            .flat_map(|word| word.split('|'))
            .find(|word| !is_value(word) && !is_placeholder(word));
        if let Some(wrong) = wrong.filter(|_| !listed.is_empty()) {
            return Some(format!("--{long}: {wrong} is no value of it"));
        }
    }
    None
}

/// Whether a word stands for what a reader has, as `SCENE`.
pub fn is_placeholder(word: &str) -> bool {
    !word.is_empty() && word.chars().all(|c| c.is_ascii_uppercase() || "…_.".contains(c))
}

/// What is wrong with a cargo command of this workspace: a package, test, bench, example or file that is not there, or
/// a filter that is in no test's name.
fn of_cargo(words: &[&str]) -> Option<String> {
    let after = |option: &str| words.iter().skip_while(|word| **word != option).nth(1).copied();
    let (action, _) = words.split_first()?;
    if !["run", "test", "bench"].contains(action) {
        let path = after("--path")?;
        return (!root().join(path).is_dir()).then(|| format!("no folder {path}"));
    }
    let folder = match after("-p") {
        Some(package) => match package_folder(package) {
            Some(folder) => folder,
            None => return Some(format!("no package {package}")),
        },
        None => root().join("cli"),
    };
    for (option, below) in [
        ("--example", "examples"),
        ("--test", "tests"),
        ("--bench", "benches"),
        ("--bin", "src/bin"),
    ] {
        let Some(name) = after(option).filter(|_| !words.contains(&"--workspace")) else {
            continue;
        };
        if !is_target(&folder, below, name) {
            return Some(format!(
                "{option} {name}: no such file in {}",
                folder.join(below).display()
            ));
        }
    }
    let filter = (*action == "test").then(|| filter(words)).flatten()?;
    (!mentions(&folder, filter)).then(|| format!("{filter}: in no test of {}", folder.display()))
}

fn is_target(folder: &Path, below: &str, name: &str) -> bool {
    let below = folder.join(below);
    let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
    below.join(format!("{name}.rs")).is_file()
        || below.join(name).join("main.rs").is_file()
        || manifest.contains(&format!("name = \"{name}\""))
}

/// The name that a test run is limited to.
fn filter<'a>(words: &[&'a str]) -> Option<&'a str> {
    const WITH_VALUE: [&str; 6] = ["-p", "--test", "--profile", "--example", "--bin", "--bench"];
    let mut words = words[1..].iter();
    while let Some(word) = words.next() {
        match *word {
            word if WITH_VALUE.contains(&word) => {
                words.next();
            }
            word if word.starts_with('-') => (),
            word => return Some(word).filter(|word| !is_placeholder(word)),
        }
    }
    None
}

fn package_folder(package: &str) -> Option<PathBuf> {
    let manifest: toml::Table = fs::read_to_string(root().join("Cargo.toml")).ok()?.parse().ok()?;
    let members = manifest["workspace"]["members"].as_array()?.clone();
    let folders = members.into_iter().filter_map(|member| Some(root().join(member.as_str()?)));
    let is_it = |folder: &PathBuf| {
        fs::read_to_string(folder.join("Cargo.toml"))
            .is_ok_and(|text| text.contains(&format!("name = \"{package}\"")))
    };
    folders.into_iter().find(is_it)
}

/// Whether a source below a folder has a name in which the filter is.
fn mentions(folder: &Path, filter: &str) -> bool {
    let last = filter.rsplit("::").next().unwrap_or(filter);
    let has = |text: &str| {
        text.lines().any(|line| {
            let named = ["fn ", "mod ", "\""].iter().any(|head| line.contains(head));
            named && line.contains(last)
        })
    };
    fs::read_dir(folder).into_iter().flatten().flatten().any(|entry| {
        let path = entry.path();
        match path.is_dir() {
            true => !path.ends_with("target") && mentions(&path, filter),
            false => {
                path.extension().is_some_and(|of| of == "rs")
                    && fs::read_to_string(&path).is_ok_and(|text| has(&text))
            }
        }
    })
}

#[test]
fn what_is_no_command_is_found() {
    let wrong = |text: &str, in_block: bool| {
        errors(&Snippet { place: "d.md:1".into(), text: text.into(), in_block }).len()
    };
    for text in [
        "hapticore simulate",
        "hapticore simulate fig6 --wave vcd",
        "ls",
        "cargo run --release -- simulat fig6",
    ] {
        assert_eq!(wrong(text, true), 1, "{text}");
    }
    for text in [
        "hapticore simulate SCENE --wave vcd",
        "hapticore sweep submit PLAN --engine hq|pbs",
        "simulate … --core klock",
        "cargo test -p hapticore-none",
        "cargo test -p hapticore-tests --test none",
        "cargo test -p hapticore-model no_such_test_at_all",
        "cargo run --release -p hapticore-tests --example none",
    ] {
        assert_eq!(wrong(text, false), 1, "{text}");
    }
    for text in [
        "hapticore calibrate DATA… --out FILE",
        "sweep collect PLAN",
        "simulate --bode",
        "CI=true cargo test -p hapticore-model",
    ] {
        assert_eq!(wrong(text, false), 0, "{text}");
    }
}
