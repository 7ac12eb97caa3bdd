// SPDX-License-Identifier: MIT OR Apache-2.0
//! Mutation tests of the model and its language: all mutants in one build, enabled one at a time.
//!
//! | module | does |
//! | --- | --- |
//! | [`area`] | says which code belongs together, and which tests judge it |
//! | [`mutant`] | lists the mutants, with cargo-mutants |
//! | [`weave`], [`edits`], [`tokens`] | puts all mutants of a file into one text |
//! | [`tree`], [`compile`], [`errors`] | copies the tree, weaves and builds it, leaves out what does not compile |
//! | [`run`], [`judge`] | runs tests: which mutants each meets; whether one notices a mutant |
//! | [`plain`] | judges what could not be woven, one build each |
//! | [`verdict`], [`report`] | keeps what became of mutants, and counts it |

mod area;
mod compile;
mod edits;
mod errors;
mod judge;
mod mutant;
mod plain;
mod report;
mod run;
mod tokens;
mod tree;
mod verdict;
mod weave;

use anyhow::{Context, Result, bail};
use area::Area;
use mutant::Mutant;
use run::Test;
use std::process::ExitCode;
use std::{fs, thread};
use verdict::{Fate, Kept, Verdicts};

/// What the command line asks for.
struct Request {
    areas: Vec<Area>,
    jobs: usize,
    kept: Kept,
    compare: bool,
    sample: usize,
    options: Vec<String>,
}

impl Request {
    fn parse(mut words: impl Iterator<Item = String>) -> Result<Self> {
        let jobs = thread::available_parallelism().map_or(1, |count| count.get());
        let mut request = Request {
            areas: Vec::new(),
            jobs,
            kept: Kept::Nothing,
            compare: false,
            sample: usize::MAX,
            options: Vec::new(),
        };
        let count = |word: Option<String>, option: &'static str| {
            word.context("how many?").and_then(|word| Ok(word.parse()?)).context(option)
        };
        while let Some(word) = words.next() {
            match &*word {
                "--" => request.options.extend(words.by_ref()),
                "--resume" => request.kept = Kept::Settled,
                "--report" => request.kept = Kept::All,
                "--compare" => request.compare = true,
                "--jobs" => request.jobs = count(words.next(), "--jobs")?,
                "--sample" => request.sample = count(words.next(), "--sample")?,
                area => request.areas.extend(Area::named(area)?),
            }
        }
        if request.areas.is_empty() {
            bail!("which area? see mutants/run --help");
        }
        Ok(request)
    }
}

fn main() -> ExitCode {
    match judge_all() {
        Ok(false) => ExitCode::SUCCESS,
        Ok(true) => ExitCode::from(1),
        Err(error) => {
            eprintln!("{error:#}");
            ExitCode::from(2)
        }
    }
}

/// Does what is asked for; whether a mutant survives that is not argued about.
fn judge_all() -> Result<bool> {
    let request = Request::parse(std::env::args().skip(1))?;
    let files: Vec<String> = request.areas.iter().flat_map(Area::files).collect();
    let (lists, options): (Vec<_>, Vec<_>) =
        request.options.into_iter().partition(|option| option == "--list");
    let mutants = mutant::list(&files, &options)?;
    if !lists.is_empty() {
        mutants.iter().for_each(|mutant| println!("{}", mutant.name));
        return Ok(false);
    }
    fs::create_dir_all("target/mutants")?;
    let mut verdicts = Verdicts::open(&mutants, request.kept)?;
    if request.kept != Kept::All {
        settle(&mutants, request.jobs.max(1), request.sample, &mut verdicts)?;
    }
    if request.compare {
        return compare(&mutants, &verdicts);
    }
    report::report(&mutants, &verdicts)
}

/// Judges mutants about which nothing is known: all, or those in a sample.
fn settle(mutants: &[Mutant], jobs: usize, sample: usize, verdicts: &mut Verdicts) -> Result<()> {
    if mutants.iter().all(|mutant| verdicts.known.contains_key(&mutant.name)) {
        return Ok(());
    }
    let known = |fate: &Fate, index: &usize| {
        verdicts.known.get(&mutants[*index].name).is_some_and(|verdict| verdict.fate == *fate)
    };
    let uncompiled = (0..mutants.len()).filter(|index| known(&Fate::Uncompiled, index)).collect();
    let build = compile::build(mutants, uncompiled)?;
    for &index in &build.uncompiled {
        if !verdicts.known.contains_key(&mutants[index].name) {
            verdicts.add(&mutants[index], Fate::Uncompiled, None)?;
        }
    }
    let tests = run::baseline(&build.programs, jobs)?;
    fs::write("target/mutants/tests.txt", tests.iter().map(Test::line).collect::<String>())?;
    eprintln!("{} tests pass", tests.len());
    let mut open: Vec<_> = (1..).zip(build.numbers.0.iter().copied()).collect();
    open.sort_by_key(|(_, index)| mutants[*index].draw());
    open.truncate(sample);
    open.retain(|(_, index)| !verdicts.known.contains_key(&mutants[*index].name));
    judge::judge(mutants, &open, &tests, jobs, verdicts)?;
    if sample < build.numbers.0.len() {
        return Ok(());
    }
    let unwoven = build.unwoven.iter().map(|(&index, &reason)| (&mutants[index], reason));
    let unwoven: Vec<_> =
        unwoven.filter(|(mutant, _)| !verdicts.known.contains_key(&mutant.name)).collect();
    let fates = plain::judge(&unwoven.iter().map(|(mutant, _)| *mutant).collect::<Vec<_>>())?;
    for (mutant, reason) in unwoven {
        if let Some(fate) = fates.get(&mutant.name) {
            verdicts.add(mutant, fate.clone(), Some(reason))?;
        }
    }
    Ok(())
}

/// Judges all mutants in builds of their own, too, and prints where the area's own unit tests say
/// something else of them; whether they do.
fn compare(mutants: &[Mutant], verdicts: &Verdicts) -> Result<bool> {
    let plain = plain::judge(&mutants.iter().collect::<Vec<_>>())?;
    let mut differ = 0;
    for mutant in mutants {
        let [woven, plain] =
            [verdicts.known.get(&mutant.name).map(|v| &v.fate), plain.get(&mutant.name)]
                .map(|fate| fate.map_or("not judged", Fate::of_own_tests));
        if woven != plain {
            differ += 1;
            println!("{}: woven {woven}, in a build of its own {plain}", mutant.name);
        }
    }
    println!("{} mutants judged in both ways, {differ} verdicts differ", mutants.len());
    Ok(differ > 0)
}
