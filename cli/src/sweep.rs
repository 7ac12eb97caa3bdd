// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore sweep`: a plan of many points, on all cores or by an engine.

use std::io::BufRead;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use hapticore_run::interrupt;
use hapticore_sweep::collect::{Collected, settings};
use hapticore_sweep::engines::{Engine, Job};
use hapticore_sweep::plan::Plan;
use hapticore_sweep::store::Store;
use hapticore_sweep::work::{Chunk, Work};
use hapticore_tradeoff::errors::Quantity;
use serde_json::json;

use crate::args::{SweepArgs, SweepEngine, SweepPlaces, SweepStep};
use crate::output::{Output, names};
use crate::print::{number, table};
use crate::{console, progress, report, say};

/// The sweep was told to stop; what was run is kept.
#[derive(Debug, thiserror::Error)]
#[error(
    "interrupted: points that were run are in {store}; the same command goes on with the others"
)]
pub struct Stopped {
    store: String,
}

/// A plan, its store, and where results go.
struct Places {
    plan: Plan,
    store: Store,
    out: PathBuf,
    json: bool,
}

/// Runs a plan or a step of it; whether every point is there.
///
/// # Errors
/// A plan or line that is none, a store that cannot be read or written, a host that differs, an
/// interruption.
pub fn run(args: &SweepArgs) -> Result<bool> {
    match (&args.step, &args.places) {
        (Some(SweepStep::Run { store, line }), _) => run_lines(store, line),
        (Some(SweepStep::Collect(places)), _) => collect(&Places::new(places)?),
        (Some(SweepStep::Submit { places, engine, dry_run }), _) => {
            submit(places, *engine, *dry_run)
        }
        (None, Some(places)) if args.list => list(&Places::new(places)?),
        (None, Some(places)) => run_plan(&Places::new(places)?, args.threads),
        (None, None) => anyhow::bail!("expected a plan: hapticore sweep PLAN; see --help"),
    }
}

impl Places {
    fn new(places: &SweepPlaces) -> Result<Self> {
        let plan = Plan::read(&places.plan)?;
        let store = store_of(places);
        let beside = store.parent().unwrap_or(Path::new("")).join("results");
        Ok(Places {
            plan,
            store: Store::open(&store)?,
            out: places.out.clone().unwrap_or(beside),
            json: places.json,
        })
    }
}

fn store_of(places: &SweepPlaces) -> PathBuf {
    let named = places.plan.file_stem().unwrap_or_default();
    places.store.clone().unwrap_or_else(|| Path::new("out/sweep").join(named).join("store"))
}

fn warn_of_torn(work: &Work) {
    for message in work.torn() {
        console::warn(&format!("{message}; the part is put aside, its other points are kept"));
    }
}

fn run_plan(places: &Places, threads: Option<u16>) -> Result<bool> {
    let work = Work::new(&places.store, &places.plan)?;
    let missing = work.missing(0..places.plan.len())?;
    warn_of_torn(&work);
    let bar = progress::bar(Some(missing.len() as u64), "points", places.json);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0).into()).build()?;
    let ran = pool.install(|| work.run_all(&missing, &|| bar.inc(1)));
    bar.finish_and_clear();
    warn_of_torn(&work);
    ran.map_err(|error| stopped(error, &places.store))?;
    collect(places)
}

/// The error, or [`Stopped`] instead where the user asked to stop.
fn stopped(error: anyhow::Error, store: &Store) -> anyhow::Error {
    match interrupt::check() {
        Err(_) => Stopped { store: store.folder().display().to_string() }.into(),
        Ok(()) => error,
    }
}

fn list(places: &Places) -> Result<bool> {
    let work = Work::new(&places.store, &places.plan)?;
    let chunks = work.chunks();
    warn_of_torn(&work);
    for chunk in chunks.map_err(|error| stopped(error, &places.store))? {
        say!("{}", chunk.text());
    }
    Ok(true)
}

fn run_lines(store: &Path, line: &str) -> Result<bool> {
    let store = Store::open(store)?;
    if line != "-" {
        return run_line(&store, line).map(|()| true);
    }
    for line in std::io::stdin().lock().lines() {
        run_line(&store, &line.context("standard input")?)?;
    }
    Ok(true)
}

fn run_line(store: &Store, line: &str) -> Result<()> {
    if line.trim().is_empty() {
        return Ok(());
    }
    let chunk = Chunk::read(line)?;
    let plan = store.plan(&chunk.plan)?;
    plan.check_program()?;
    let work = Work::new(store, &plan)?;
    let ran = work.run_chunk(&chunk, &|| ());
    warn_of_torn(&work);
    ran.map(drop).map_err(|error| stopped(error, store))
}

/// Writes results and says what is missing.
fn collect(places: &Places) -> Result<bool> {
    let Places { plan, store, out, json } = places;
    let collected = Collected::of(store, plan)?;
    collected.problems.iter().for_each(|problem| console::warn(problem));
    let output = Output::new(out)?;
    output.write("results.csv", collected.csv(plan))?;
    output.write("results.json", collected.json(plan))?;
    #[cfg(feature = "parquet")]
    output.write("results.parquet", collected.parquet(plan)?)?;
    output.write("times.csv", collected.times_csv())?;
    output.write("report.html", report::of_sweep(plan, &collected))?;
    let files = output.keep()?;
    let failed: Vec<_> = collected.failed().collect();
    if *json {
        let missing = &collected.missing;
        let failed: Vec<_> =
            failed.iter().map(|(line, error)| json!({"key": line.key, "error": error})).collect();
        let told = json!({"plan": collected.plan, "points": collected.points.len(), "missing": missing, "failed": failed, "problems": collected.problems, "files": names(&files)});
        say!("{}", serde_json::to_string_pretty(&told)?);
    } else {
        print(plan, &collected);
        files.iter().for_each(|file| say!("  {}", file.display()));
    }
    Ok(collected.missing.is_empty())
}

/// The most rows and names that are printed.
const MOST_SHOWN: usize = 20;

fn print(plan: &Plan, collected: &Collected) {
    say!(
        "{} of {} points · {} · profile {} · core {} · plan {:.16}",
        collected.points.len(),
        collected.points.len() + collected.missing.len(),
        plan.scene.file,
        plan.profile.name,
        plan.fidelity,
        collected.plan
    );
    let shown = |what: &str, count: usize, lines: Vec<String>| {
        if count > 0 {
            say!("{count} {what}:");
            lines.iter().for_each(|line| say!("  {line}"));
        }
    };
    let failed = collected.failed().map(|(line, why)| format!("{}: {why}", settings(line)));
    shown("cannot be run", collected.failed().count(), failed.take(MOST_SHOWN).collect());
    let missing = collected.missing.iter().take(MOST_SHOWN).cloned();
    shown("missing", collected.missing.len(), missing.collect());
    let rows = report::sweep_plan::front_rows(collected, MOST_SHOWN, number);
    if !rows.is_empty() {
        say!("\nthe Pareto front of error, area and age, by {}:", Quantity::Force.name());
        console::print(format_args!("{}", table(&report::sweep_plan::FRONT, &rows)));
    }
}

fn submit(places: &SweepPlaces, engine: SweepEngine, dry_run: bool) -> Result<bool> {
    let engine = match engine {
        SweepEngine::Hq => Engine::HyperQueue,
        SweepEngine::Slurm => Engine::Slurm,
        SweepEngine::Parallel => Engine::Parallel,
        SweepEngine::Snakemake => Engine::Snakemake,
    };
    Plan::read(&places.plan)?;
    let program = std::env::current_exe().context("this program's file")?;
    let [program, plan, store] =
        [&program, &places.plan, &store_of(places)].map(|path| path.display().to_string());
    let commands = Job::new(&program, &plan, &store).commands(engine);
    if dry_run {
        console::print(format_args!("{commands}"));
        return Ok(true);
    }
    let status =
        Command::new("sh").args(["-ec", &commands]).stdin(Stdio::null()).status().context("sh")?;
    ensure!(matches!(status.code(), Some(0 | 1)), "the commands of --dry-run ended with {status}");
    Ok(status.success())
}
