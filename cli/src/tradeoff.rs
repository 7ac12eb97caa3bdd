// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore tradeoff`: what accuracy costs.

use anyhow::{Context, Result, ensure};
use hapticore_contract::profile::Profile;
use hapticore_run::record::Provenance;
use hapticore_run::{inputs, interrupt};
use hapticore_scene::{Scene, Timing};
use hapticore_tradeoff::cost::{self, Family};
use hapticore_tradeoff::errors::{Error, Quantity};
use hapticore_tradeoff::loops::{self, LoopErrors, case_of};
use hapticore_tradeoff::model::{Model, NextBit};
use hapticore_tradeoff::points;
use hapticore_tradeoff::search::{Found, models, search};
use hapticore_tradeoff::sweep::{Point, Trial};
use hapticore_tradeoff::synthesis::{self, Synthesised, synthesise};
use hapticore_tradeoff::target::Target;
use serde::Serialize;

use crate::args::TradeoffArgs;
use crate::output::Output;
use crate::print::{number, table};
use crate::{console, progress, report, say};

/// The profile where none is named.
const PROFILE: &str = "standard";
/// The scenes where none are: places all over the sheet, forces over load and voltage, motion.
const SCENES: [&str; 3] = ["fig3", "fig6", "hockey"];

/// All that a run leaves.
#[derive(Debug, Serialize)]
pub struct Tradeoff {
    /// The profile that was varied.
    pub profile: String,
    /// The scenes whose slots it was tried on.
    pub scenes: Vec<String>,
    /// Slots of each scene.
    pub slots: usize,
    /// The profile itself, then each of its neighbours.
    pub points: Vec<Point>,
    /// The cheapest profile for a target, where there was one.
    pub found: Option<Found>,
    /// What one more bit would buy, of the profile that was found or else of the profile itself; where
    /// it was asked for.
    pub next_bits: Vec<NextBit>,
    /// What synthesis makes of the profile, and of the profile that was found; where it was asked
    /// for.
    pub synthesised: Vec<Synthesised>,
    /// Version, command and such.
    pub provenance: Provenance,
}

/// Sweeps, searches where there is a target, and prints.
///
/// # Errors
/// No such profile or scene, a target that cannot be read, a folder that cannot be written.
pub fn run(args: &TradeoffArgs) -> Result<bool> {
    let profile = inputs::profile(args.profile.as_deref().unwrap_or(PROFILE))?;
    let target =
        args.target.as_deref().map(str::parse::<Target>).transpose().context("--target")?;
    let (names, scenes) = scenes(&args.scene)?;
    let profile = windowed(profile, &scenes)?;
    let timing = Timing { signs: None, ..inputs::timing(&profile) };
    let scenes = scenes.into_iter().map(|scene| scene.within_budget(&timing));
    let scenes = scenes.collect::<Result<Vec<_>, _>>()?;
    ensure!(args.slots >= 1, "--slots: expected at least 1");
    if args.synth {
        synthesis::tools().context("--synth")?;
    }
    let output = Output::new(&args.out)?;
    let trial = Trial::new(scenes, profile, args.slots);
    let plan = trial.plan();
    let bar = progress::bar(Some(plan.len() as u64), "profiles", args.json);
    let points = trial.run(&plan, &|| bar.inc(1))?;
    bar.finish_and_clear();
    let family = args.family.as_deref().and_then(cost::named);
    let family = family.unwrap_or_else(|| cost::family(trial.profile()));
    let models = match target {
        Some(_) => models(&trial, family, &points)?,
        None if args.explain => vec![Model::new(trial.profile(), family, &points)],
        None => Vec::new(),
    };
    let found = target.map(|target| search(&trial, &points, &models, &target)).transpose()?;
    let of = found.as_ref().map_or(trial.profile(), |found| &found.profile);
    let explained = models.iter().find(|model| args.explain && model.is_about(of));
    let next_bits = explained.map(|model| model.next_bits(of)).unwrap_or_default();
    let synthesised = match args.synth {
        true => synthesised(trial.profile(), &points[0], found.as_ref(), args.json)?,
        false => Vec::new(),
    };
    let tradeoff = Tradeoff {
        profile: trial.profile().name.clone(),
        scenes: names,
        slots: args.slots,
        points,
        found,
        next_bits,
        synthesised,
        provenance: Provenance::new(),
    };
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

/// The profile, and the profile that was found, in the cells of both families.
fn synthesised(
    profile: &Profile,
    itself: &Point,
    found: Option<&Found>,
    quiet: bool,
) -> Result<Vec<Synthesised>> {
    let mut cores = vec![(profile, &itself.cost)];
    cores.extend(found.map(|found| (&found.profile, &found.cost)));
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

/// The scenes that were named, with their names. Those whose slots depend on the core show what its words
/// change of drives and directions; where all are such, the usual ones show all else.
fn scenes(named: &[String]) -> Result<(Vec<String>, Vec<Scene>)> {
    let mut scenes = named.iter().map(|name| scene(name)).collect::<Result<Vec<_>>>()?;
    let mut names = named.to_vec();
    if scenes.iter().all(is_loop) {
        for (n, name) in SCENES.iter().enumerate() {
            scenes.insert(n, scene(name)?);
            names.insert(n, name.to_string());
        }
    }
    Ok((names, scenes))
}

fn is_loop(scene: &Scene) -> bool {
    loops::is_loop(&scene.cases[case_of(scene)])
}

/// A scene whose sensors leave the rounding to the core's ADC.
fn scene(name: &str) -> Result<Scene> {
    let scene = inputs::scene(name, &[])?;
    inputs::scene(name, &points::unrounded(&scene.cases[case_of(&scene)])?)
}

/// The profile with the slot that the scenes ask for, as `simulate` runs them. Where they do not all
/// ask for the same, it keeps its own: all scenes are to try one profile.
fn windowed(profile: Profile, scenes: &[Scene]) -> Result<Profile> {
    let slot = |scene: &Scene| (scene.window_samples, scene.settle_samples);
    let asking = |scene: &&Scene| slot(scene) != (None, None);
    // Force loops are run in their own.
    let scenes: Vec<&Scene> = scenes.iter().filter(|scene| !is_loop(scene)).collect();
    match scenes.iter().copied().find(asking) {
        None => Ok(profile),
        Some(first) if scenes.iter().all(|scene| slot(scene) == slot(first)) => {
            inputs::windowed(profile, first)
        }
        Some(_) => {
            let names = scenes.iter().copied().filter(asking).map(|scene| scene.name.as_str());
            console::warn(&format!(
                "{}: window_samples and settle_samples are not taken, since not all scenes ask for the same; slots are those of profile {}",
                names.collect::<Vec<_>>().join(", "),
                profile.name
            ));
            Ok(profile)
        }
    }
}

fn write(output: &Output, tradeoff: &Tradeoff) -> Result<()> {
    output.write("tradeoff.csv", csv(&tradeoff.points))?;
    output.write("tradeoff.json", &serde_json::to_string_pretty(tradeoff)?)?;
    output.write("report.html", report::of_tradeoff(tradeoff))?;
    if let Some(found) = &tradeoff.found {
        output.write("profile.toml", &text_of(&found.profile)?)?;
    }
    Ok(())
}

fn text_of(profile: &Profile) -> Result<String> {
    Ok(format!("# Found by hapticore tradeoff.\n{}", toml::to_string(profile)?))
}

const COLUMNS: &str = "knob,value,latency_clocks,age_us,frames_per_second,luts_ecp5,luts_ice40,flip_flops,multipliers,memory_bits,multipliers_ice40,block_rams_ecp5,block_rams_ice40,least_codes";

fn csv(points: &[Point]) -> String {
    let mut head = COLUMNS.to_string();
    for kind in ["predicted", "measured"] {
        for quantity in Quantity::ALL {
            for what in ["rms", "mean", "largest"] {
                head += &format!(",{kind}_{}_{what}", quantity.name());
            }
        }
    }
    for (name, _) in LoopErrors::QUANTITIES {
        for what in ["rms", "mean", "largest"] {
            head += &format!(",measured_{name}_{what}");
        }
    }
    let row = |point: &Point| {
        let cost = &point.cost;
        let mut row = format!(
            "{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
            point.knob,
            point.value,
            cost.latency_clocks,
            cost.age_us,
            cost.frames_per_second,
            cost.luts.round(),
            cost.luts_ice40.round(),
            cost.flip_flops,
            cost.multipliers,
            cost.memory_bits,
            cost.multipliers_ice40,
            cost.block_rams,
            cost.block_rams_ice40,
            point.least_codes
        );
        for error in point.predicted.iter().chain(&point.measured) {
            row += &format!(",{:e},{:e},{:e}", error.rms, error.mean, error.largest);
        }
        for error in point.looped.all() {
            let of =
                |error: Error| format!(",{:e},{:e},{:e}", error.rms, error.mean, error.largest);
            row += &error.map_or(",,,".into(), of);
        }
        row + "\n"
    };
    points.iter().fold(head + "\n", |text, point| text + &row(point))
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
pub const OF_ONE: &str = "?  one slot makes most of the predicted error, so that other slots may have any: measured is what counts, more --slots show more";

/// The quantities in which a point is on the front.
pub fn front(point: &Point) -> String {
    let quantities = Quantity::ALL.map(Quantity::name).into_iter().zip(point.front);
    let of_loops = LoopErrors::QUANTITIES.map(|(name, _)| name).into_iter();
    let on = quantities.chain(of_loops.zip(point.front_in_loops)).filter(|(_, on)| *on);
    on.map(|(name, _)| name).collect::<Vec<_>>().join(" ")
}
