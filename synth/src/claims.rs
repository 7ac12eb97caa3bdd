// SPDX-License-Identifier: MIT OR Apache-2.0
//! Claims of a block, decided by a solver: its invariants by induction, and every `Assumed`
//! narrowing from them ([`hapticore_hdl::smt`]).

use crate::tools::Tools;
use anyhow::{Context, Result, bail};
use hapticore_hdl::format::Format;
use hapticore_hdl::smt::{Problem, Property, System, Variable};
use std::fmt;

/// A solver of bit-vector problems.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Solver {
    /// Bitwuzla: also multiplies.
    Bitwuzla,
    /// cvc5, for a second opinion.
    Cvc5,
}

/// What a solver found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    /// There is no counterexample.
    Proved,
    /// A counterexample: what each signal is, by name and clock.
    Refuted(Counterexample),
}

/// The code of each signal of a counterexample, in its format.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Counterexample(pub Vec<(String, Format, i64)>);

impl fmt::Display for Counterexample {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let signals = self.0.iter().map(|(name, format, code)| format!("{name} {code} ({format})"));
        f.write_str(&signals.collect::<Vec<_>>().join(", "))
    }
}

/// Asks a solver, one problem after the other.
///
/// # Errors
/// It does not run, or cannot decide.
pub fn decide(tools: &Tools, solver: Solver, problems: &[Problem]) -> Result<Vec<Answer>> {
    let folder = tempfile::tempdir()?;
    let name = if solver == Solver::Bitwuzla { "bitwuzla" } else { "cvc5" };
    let mut arguments = vec![name.to_owned()];
    for (index, problem) in problems.iter().enumerate() {
        let file = format!("{index}.smt2");
        hapticore_files::write(&folder.path().join(&file), &problem.text)?;
        arguments.push(file);
    }
    let log = tools.run("decide", &arguments, folder.path())?;
    let mut lines = log.lines().peekable();
    let mut answer = |problem: &Problem| match lines.next() {
        Some("unsat") => Ok(Answer::Proved),
        Some("sat") => {
            let mut signals = Vec::new();
            while let Some(line) = lines.next_if(|line| line.contains(' ')) {
                signals.push(signal(line, &problem.variables)?);
            }
            Ok(Answer::Refuted(Counterexample(signals)))
        }
        other => bail!("{name}: {other:?}"),
    };
    problems.iter().map(&mut answer).collect()
}

/// A signal of a counterexample, from a line `NAME BITS`.
fn signal(line: &str, variables: &[Variable]) -> Result<(String, Format, i64)> {
    let (name, bits) = line.rsplit_once(' ').context("a name and bits")?;
    let variable = variables.iter().find(|variable| variable.name == name);
    let format = variable.with_context(|| format!("no signal {name}"))?.format;
    let code = i64::from_str_radix(bits, 2).with_context(|| format!("{name} {bits}"))?;
    let negative = format.signed && code > format.max_code() as i64;
    Ok((name.to_owned(), format, if negative { code - (1 << format.width) } else { code }))
}

/// The most clocks over which a claim's induction goes: a product of two clocks has gone through.
const MOST_CLOCKS: usize = 2;

/// A property that a solver has proved.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Proved {
    /// Its name.
    pub name: &'static str,
    /// The clocks over which the induction goes.
    pub clocks: usize,
}

/// Proves all invariants and claims of a block: the invariants by induction over one clock, the
/// claims from them, over as few clocks as suffice.
///
/// # Errors
/// What cannot be proved, with the counterexample.
pub fn prove(tools: &Tools, solver: Solver, system: &System) -> Result<Vec<Proved>> {
    let invariants = system.invariants();
    by_induction(tools, solver, system, &invariants, 1)?;
    let mut proved: Vec<_> =
        invariants.iter().map(|&(name, _)| Proved { name, clocks: 1 }).collect();
    let claims = system.claims();
    for clocks in 0.. {
        match by_induction(tools, solver, system, &claims, clocks) {
            Err(error) if clocks == MOST_CLOCKS => return Err(error),
            Err(_) => continue,
            Ok(()) => proved.extend(claims.iter().map(|&(name, _)| Proved { name, clocks })),
        }
        break;
    }
    Ok(proved)
}

/// Proves properties by induction over `clocks` clocks.
fn by_induction(
    tools: &Tools,
    solver: Solver,
    system: &System,
    properties: &[(&'static str, Property)],
    clocks: usize,
) -> Result<()> {
    let parts = |&(name, property): &(&'static str, Property)| {
        let (step, base) = (system.step(property, clocks), system.base(property, clocks));
        [(name, "step", step), (name, "base", base)]
    };
    let (names, problems): (Vec<_>, Vec<_>) = properties
        .iter()
        .flat_map(parts)
        .map(|(name, part, problem)| ((name, part), problem))
        .unzip();
    for ((name, part), answer) in names.iter().zip(decide(tools, solver, &problems)?) {
        if let Answer::Refuted(example) = answer {
            bail!("{name}: {part} over {clocks} clocks fails: {example}");
        }
    }
    Ok(())
}
