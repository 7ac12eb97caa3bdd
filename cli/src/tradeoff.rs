// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore tradeoff`: what accuracy costs.

use anyhow::{Context, Result};
use hapticore_contract::profile::Profile;
use hapticore_run::interrupt;
use hapticore_tradeoff::cost::Family;
use hapticore_tradeoff::errors::Quantity;
use hapticore_tradeoff::loops::LoopErrors;
use hapticore_tradeoff::model::NextBit;
use hapticore_tradeoff::outcome::{Prepared, Request, Tradeoff};
use hapticore_tradeoff::search::Found;
use hapticore_tradeoff::sweep::Point;
use hapticore_tradeoff::synthesis::{self, Synthesised, synthesise};
use hapticore_tradeoff::target::Target;

use crate::args::TradeoffArgs;
use crate::output::Output;
use crate::print::{number, table};
use crate::{console, progress, report, say};

/// Sweeps, searches where there is a target, and prints.
///
/// # Errors
/// No such profile or scene, a target that cannot be read, a folder that cannot be written.
pub fn run(args: &TradeoffArgs) -> Result<bool> {
    let prepared = Prepared::new(request(args)?)?;
    prepared.warnings.iter().for_each(|warning| console::warn(warning));
    if args.synth {
        synthesis::tools().context("--synth")?;
    }
    let output = Output::new(&args.out)?;
    let profile = prepared.profile().clone();
    let bar = progress::bar(Some(prepared.profiles() as u64), "profiles", args.json);
    let points = prepared.sweep(&|| bar.inc(1))?;
    bar.finish_and_clear();
    let mut tradeoff = prepared.outcome(points)?;
    if args.synth {
        tradeoff.synthesised = synthesised(&profile, &tradeoff, args.json)?;
    }
    write(&output, &tradeoff)?;
    let files = output.keep()?;
    if args.json {
        say!("{}", serde_json::to_string_pretty(&tradeoff)?);
    } else {
        print(&tradeoff);
        files.iter().for_each(|file| say!("  {}", file.display()));
    }
    Ok(tradeoff.found.as_ref().is_none_or(Found::holds))
}

fn request(args: &TradeoffArgs) -> Result<Request> {
    Ok(Request {
        profile: args.profile.clone(),
        scenes: args.scene.clone(),
        slots: args.slots,
        target: args.target.as_deref().map(str::parse::<Target>).transpose().context("--target")?,
        family: args.family.clone(),
        explain: args.explain,
    })
}

/// The profile, and the profile that was found, in the cells of both families.
fn synthesised(profile: &Profile, tradeoff: &Tradeoff, quiet: bool) -> Result<Vec<Synthesised>> {
    let mut cores = vec![(profile, &tradeoff.points[0].cost)];
    cores.extend(tradeoff.found.as_ref().map(|found| (&found.profile, &found.cost)));
    let bar = progress::bar(Some(cores.len() as u64), "cores synthesised", quiet);
    let mut all = Vec::new();
    for (profile, cost) in cores {
        interrupt::check()?;
        all.extend(synthesise(profile, cost)?);
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(all)
}

fn write(output: &Output, tradeoff: &Tradeoff) -> Result<()> {
    output.write("tradeoff.csv", tradeoff.csv())?;
    output.write("tradeoff.json", &serde_json::to_string_pretty(tradeoff)?)?;
    output.write("report.html", report::of_tradeoff(tradeoff))?;
    if let Some(text) = tradeoff.found_profile()? {
        output.write("profile.toml", &text)?;
    }
    Ok(())
}

fn print(tradeoff: &Tradeoff) {
    let looped = looped(&tradeoff.points);
    let mut head = vec!["knob", "bits", "force mN", "pred.", "C %", "pred.", "place µm", "pred."];
    head.extend(looped.iter().map(|(_, head)| *head));
    head.extend(["age µs", "LUT4", "FF", "BRAM", "front"]);
    let row = |point: &Point| {
        let mut cells = vec![
            if point.knob.is_empty() { tradeoff.profile.clone() } else { point.knob.clone() },
            if point.knob.is_empty() { String::new() } else { point.value.to_string() },
        ];
        for (n, measured) in point.measured.iter().enumerate() {
            cells.extend([number(measured.rms), prediction(point, n)]);
        }
        cells.extend(looped.iter().map(|(n, _)| loop_error(point, *n)));
        cells.push(number(point.cost.age_us));
        cells.push(format!("{:.0}", point.cost.luts));
        cells.push(format!("{:.0}", point.cost.flip_flops_of(Family::Ecp5)));
        cells.push(format!("{:.0}", point.cost.block_rams));
        cells.push(front(point));
        cells
    };
    let rows: Vec<_> = tradeoff.points.iter().map(row).collect();
    console::print(format_args!("{}", table(&head, &rows)));
    if tradeoff.points.iter().any(|point| point.is_of_one.contains(&true)) {
        say!("{OF_ONE}");
    }
    if let Some(found) = &tradeoff.found {
        say!("\n{}", found.text());
    }
    if !tradeoff.next_bits.is_empty() {
        say!("\nwhat one more bit would buy, as predicted:");
        console::print(format_args!("{}", table(&NEXT_BIT, &next_bit_rows(&tradeoff.next_bits))));
    }
    if !tradeoff.synthesised.is_empty() {
        say!("\nwhat synthesis makes of it:");
        let rows = synthesised_rows(&tradeoff.synthesised);
        console::print(format_args!("{}", table(&SYNTHESISED, &rows)));
    }
}

/// Which of the errors of loops there are, by their place, and the heads of their columns.
pub fn looped(points: &[Point]) -> Vec<(usize, &'static str)> {
    let there = |n: &usize| points.iter().any(|point| point.looped.all()[*n].is_some());
    let heads = ["loop mN", "drive V", "dir. ppm"];
    (0..heads.len()).filter(there).map(|n| (n, heads[n])).collect()
}

/// An error of loops, RMS; empty where there is none.
pub fn loop_error(point: &Point, n: usize) -> String {
    point.looped.all()[n].map_or(String::new(), |error| number(error.rms))
}

/// The head of the table of what one more bit would buy.
pub const NEXT_BIT: [&str; 6] =
    ["knob", "bits", "force, mN less", "capacitance, % less", "position, µm less", "LUT4 more"];

/// Its rows.
pub fn next_bit_rows(next_bits: &[NextBit]) -> Vec<Vec<String>> {
    let row = |next: &NextBit| {
        let mut cells = vec![next.knob.clone(), next.bits.to_string()];
        cells.extend(next.less.map(number));
        cells.push(format!("{:.0}", next.luts));
        cells
    };
    next_bits.iter().map(row).collect()
}

/// The head of the table of what synthesis makes of profiles.
pub const SYNTHESISED: [&str; 9] = [
    "profile",
    "part",
    "LUT4",
    "estimated",
    "flip-flops",
    "multipliers",
    "block RAM",
    "LUT RAM",
    "clock, MHz",
];

/// Its rows.
pub fn synthesised_rows(synthesised: &[Synthesised]) -> Vec<Vec<String>> {
    let row = |of: &Synthesised| {
        let cells = of.cells;
        let counted = [cells.registers, cells.multipliers, cells.block_rams, cells.lut_rams];
        let mut row = vec![of.profile.clone(), of.part.into(), cells.luts.to_string()];
        row.push(format!("{:.0}", of.estimated_luts));
        row.extend(counted.map(|count| count.to_string()));
        row.push(of.mhz.map_or("does not fit".into(), |mhz| format!("{mhz:.1}")));
        row
    };
    synthesised.iter().map(row).collect()
}

/// The predicted error of a quantity, marked where the prediction may not hold.
pub fn prediction(point: &Point, quantity: usize) -> String {
    let rms = number(point.predicted[quantity].rms);
    if point.is_of_one[quantity] { format!("{rms} ?") } else { rms }
}

/// What the mark of [`prediction`] says.
pub const OF_ONE: &str = "?  one slot in 24 makes most of the predicted error, or a word saturates: other slots may have any, measured is what counts, more --slots show more";

/// The quantities in which a point is on the front.
pub fn front(point: &Point) -> String {
    let quantities = Quantity::ALL.map(Quantity::name).into_iter().zip(point.front);
    let of_loops = LoopErrors::QUANTITIES.map(|(name, _)| name).into_iter();
    let on = quantities.chain(of_loops.zip(point.front_in_loops)).filter(|(_, on)| *on);
    on.map(|(name, _)| name).collect::<Vec<_>>().join(" ")
}
