// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore-synth`: bitstreams and reports.

use anyhow::{Context, Result};
use clap::{Parser, Subcommand};
use hapticore_contract::profile::Profile;
use hapticore_hdl::verilog::Design;
use hapticore_synth::flow::Flow;
use hapticore_synth::harness;
use hapticore_synth::loops::{Loop, LoopsReport, Measured};
use hapticore_synth::report::{BoardReport, CoreRow, CoresReport, limits, median};
use hapticore_synth::sources::{self, File};
use hapticore_synth::target::{self, Family};
use hapticore_synth::tools::{Tools, root};
use serde::Serialize;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Parser)]
#[command(about = "Bitstreams of boards, and reports of area and timing", version)]
struct Args {
    #[command(subcommand)]
    what: What,
    /// Where to work, and to leave bitstreams.
    #[arg(long, global = true, default_value = "target/synth")]
    work: PathBuf,
    /// Where reports go.
    #[arg(long, global = true, default_value = "synth/reports")]
    reports: PathBuf,
}

#[derive(Subcommand)]
enum What {
    /// Synthesise, place with several seeds, pack, report.
    Board {
        /// ulx3s or icebreaker.
        name: String,
        /// Seeds to place with.
        #[arg(long, default_value_t = 5)]
        seeds: u64,
    },
    /// Vectors for users of the Verilog, into rtl/verilog/vectors.
    Vectors,
    /// Force loops: cores with controller and walls.
    Loops {
        /// Seeds to place with.
        #[arg(long, default_value_t = 5)]
        seeds: u64,
        /// Only loops whose names begin so, such as `small, inverse`; the others stay as reported.
        #[arg(long, default_value = "")]
        only: String,
    },
    /// Every bundled profile's core on every family.
    Cores {
        /// Seeds to place with.
        #[arg(long, default_value_t = 3)]
        seeds: u64,
    },
}

/// Exit status: 0 all limits hold, 1 one does not, 2 it did not come to that.
fn main() -> ExitCode {
    let args = Args::parse();
    let result = match &args.what {
        What::Board { name, seeds } => board(&args, name, *seeds),
        What::Vectors => vectors(),
        What::Loops { seeds, only } => loops(&args, *seeds, only),
        What::Cores { seeds } => cores(&args, *seeds),
    };
    match result {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

fn save(folder: &Path, name: &str, report: &impl Serialize, text: &str) -> Result<()> {
    fs::create_dir_all(folder)?;
    write(&folder.join(format!("{name}.json")), &(serde_json::to_string_pretty(report)? + "\n"))?;
    write(&folder.join(format!("{name}.md")), text)
}

/// Writes a whole file atomically.
fn write(path: &Path, text: &str) -> Result<()> {
    hapticore_files::write(path, text).with_context(|| path.display().to_string())
}

fn board(args: &Args, name: &str, seeds: u64) -> Result<bool> {
    let board = target::board(name).context("no such board; there are ulx3s and icebreaker")?;
    let (tools, files) = (Tools::find()?, sources::board(board.target));
    let flow = Flow::new(&tools, board.family, target::TOP, &files, &args.work.join(name))?;
    eprintln!("{name}: synthesis");
    let (cells, modules) = (flow.synthesise()?, flow.modules()?);
    eprintln!("{name}: placing and routing with {seeds} seeds");
    let placed = flow.place_all(seeds)?;
    let (bitstream, hash) = flow.pack(1)?;
    let timings: Vec<_> = placed.iter().map(|placed| placed.timing).collect();
    let (used, median_mhz) = (placed[0].used, median(&timings));
    let report = BoardReport {
        made_by: format!("synth/run {name}"),
        board: name.into(),
        part: board.family.part().into(),
        sources: sources::hash_of(&files),
        cells,
        used,
        timings,
        median_mhz,
        bitstream: hash,
        limits: limits(board, &used, median_mhz),
        modules,
    };
    save(&args.reports, name, &report, &report.markdown())?;
    print!("{}", report.markdown());
    eprintln!("bitstream: {}", bitstream.display());
    Ok(report.limits.iter().all(|limit| limit.holds))
}

fn vectors() -> Result<bool> {
    let folder = root().join("rtl/verilog/vectors");
    fs::create_dir_all(&folder)?;
    for file in hapticore_synth::vectors::files() {
        write(&folder.join(&file.name), &file.text)?;
    }
    Ok(true)
}

fn cores(args: &Args, seeds: u64) -> Result<bool> {
    let tools = Tools::find()?;
    let mut rows = Vec::new();
    for profile in Profile::all() {
        for family in Family::ALL {
            eprintln!("{} on {}", profile.name, family.part());
            rows.push(core(args, &tools, &profile, family, seeds)?);
        }
    }
    let report = CoresReport { made_by: "synth/run cores".into(), rows };
    save(&args.reports, "cores", &report, &report.markdown())?;
    print!("{}", report.markdown());
    Ok(true)
}

/// Measures the loops whose names begin with `only`; the rows of the others are the report's.
fn loops(args: &Args, seeds: u64, only: &str) -> Result<bool> {
    let tools = Tools::find()?;
    let mut rows = Vec::new();
    for of in Loop::all().iter().filter(|of| of.name().starts_with(only)) {
        eprintln!("{} on {}", of.name(), of.family.part());
        rows.push(of.row(measured(args, &tools, of, seeds)?));
    }
    let text = fs::read_to_string(args.reports.join("loops.json")).unwrap_or_default();
    let old = serde_json::from_str(&text).map_or(Vec::new(), |report: LoopsReport| report.rows);
    let find = |of: &Loop| rows.iter().chain(&old).find(|row| of.is_of(row)).cloned();
    let rows = Loop::all().iter().filter_map(find).collect();
    let report = LoopsReport { made_by: "synth/run loops".into(), rows };
    save(&args.reports, "loops", &report, &report.markdown())?;
    print!("{}", report.markdown());
    Ok(true)
}

fn measured(args: &Args, tools: &Tools, of: &Loop, seeds: u64) -> Result<Measured> {
    let (design, files) = (of.design(), of.files());
    let adds = of.adds.replace(", ", "-").replace(' ', "-");
    let folder = args.work.join(format!("{}-{adds}", of.profile.name));
    let flow = Flow::new(tools, of.family, design.top(), &files, &folder.join("bare"))?.unshared();
    let cells = flow.synthesise()?;
    let modules = if of.profile.control.is_some() { flow.modules()? } else { Vec::new() };
    let flow = harnessed(tools, of.family, &design, files, &folder)?.unshared();
    flow.synthesise()?;
    let used = flow.packed()?;
    let fits = used.logic[0] <= used.logic[1];
    let placed = if of.placed && fits { flow.place_all(seeds)? } else { Vec::new() };
    let timings = placed.iter().map(|placed| placed.timing).collect();
    Ok(Measured { cells, used, timings, modules })
}

/// A design in its harness.
fn harnessed<'a>(
    tools: &'a Tools,
    family: Family,
    design: &Design,
    mut files: Vec<File>,
    folder: &Path,
) -> Result<Flow<'a>> {
    files.push(File { name: "harness.v".into(), text: harness::verilog(design) });
    Flow::new(tools, family, harness::TOP, &files, &folder.join("harness"))
}

fn core(
    args: &Args,
    tools: &Tools,
    profile: &Profile,
    family: Family,
    seeds: u64,
) -> Result<CoreRow> {
    let design = hapticore_rtl::header::design(profile);
    let files = sources::files(&design);
    let folder = args.work.join(format!("{}-{family:?}", profile.name));
    let cells =
        Flow::new(tools, family, design.top(), &files, &folder.join("bare"))?.synthesise()?;
    let flow = harnessed(tools, family, &design, files.clone(), &folder)?;
    flow.synthesise()?;
    let (timings, unplaced) = match flow.place_all(seeds) {
        Ok(placed) => (placed.iter().map(|placed| placed.timing).collect(), None),
        Err(error)
            if error.to_string().contains("Unable to place")
                || error.to_string().contains("no more") =>
        {
            (Vec::new(), Some("does not fit".into()))
        }
        Err(error) => return Err(error),
    };
    let (profile, part) = (profile.name.clone(), family.part().into());
    Ok(CoreRow { profile, part, sources: sources::hash_of(&files), cells, timings, unplaced })
}
