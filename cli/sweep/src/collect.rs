// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a plan's points left, sorted by their names, the Pareto front marked: the same bytes in
//! whatever order, on however many hosts they were run.

use std::collections::{BTreeMap, HashSet};

use anyhow::Result;
use hapticore_tradeoff::errors::{Error, Quantity};
use hapticore_tradeoff::front::front;
use hapticore_tradeoff::loops::LoopErrors;
use rayon::prelude::*;
use serde::Serialize;
use serde_json::Value;

use crate::axis::{Axis, Side};
use crate::canonical;
use crate::host;
use crate::plan::{Plan, plain};
use crate::result::{Line, Results, Three, Times};
use crate::store::Store;

/// What a plan left in a store.
#[derive(Debug)]
pub struct Collected {
    /// The plan's name.
    pub plan: String,
    /// Points that were run, sorted by name.
    pub points: Vec<Collect>,
    /// How long they took, by name.
    pub times: BTreeMap<String, Times>,
    /// Names of points without a line, in the plan's order.
    pub missing: Vec<String>,
    /// Parts that cannot be read, and hosts that differ.
    pub problems: Vec<String>,
}

/// A point and where it is on the front.
#[derive(Debug, Clone, Serialize)]
pub struct Collect {
    /// Its line.
    #[serde(flatten)]
    pub line: Line,
    /// The quantities in whose error, area and age together no other point beats it.
    pub front: Vec<Quantity>,
}

impl Collected {
    /// Collects a plan's points.
    ///
    /// # Errors
    /// A store that cannot be read; results of one point that differ.
    pub fn of(store: &Store, plan: &Plan) -> Result<Self> {
        let (name, names) = (plan.name(), plan.names());
        let contents = store.contents()?;
        let (mut lines, mut times) = (contents.lines, store.times()?);
        let keys = (0..plan.len()).into_par_iter().map(|index| names.of(&plan.point(index)));
        let keys: Vec<String> = keys.collect();
        let (mut points, mut missing, mut own) = (Vec::new(), Vec::new(), BTreeMap::new());
        // Draws may meet: points that set the same are one.
        let mut seen = HashSet::new();
        for key in keys.iter().filter(|key| seen.insert(*key)) {
            own.extend(times.remove_entry(key));
            match lines.remove(key) {
                Some(line) => points.push(Collect { line, front: Vec::new() }),
                None => missing.push(key.clone()),
            }
        }
        points.sort_by(|a, b| a.line.key.cmp(&b.line.key));
        mark_front(&mut points);
        let mut problems: Vec<_> = contents.torn.into_iter().map(|torn| torn.message).collect();
        problems.extend(host::differing(store, &name)?);
        Ok(Collected { plan: name, points, times: own, missing, problems })
    }

    /// Points that cannot be run, each with why.
    pub fn failed(&self) -> impl Iterator<Item = (&Line, &str)> {
        self.points.iter().filter_map(|of| Some((&of.line, of.line.error.as_deref()?)))
    }

    /// `results.json`.
    pub fn json(&self, plan: &Plan) -> String {
        let points: Vec<_> = self.points.par_iter().map(canonical::text).collect();
        let head = format!(
            "{{\"schema\":{},\"plan\":\"{}\",\"scene\":{},\"case\":{},\"base\":{},\"fidelity\":\"{}\",\"slots\":{},\"points\":[",
            plan.schema,
            self.plan,
            canonical::text(&plan.scene.file),
            canonical::text(&plan.case),
            canonical::text(&plan.profile.name),
            plan.fidelity,
            plan.slots
        );
        format!("{head}\n{}\n]}}\n", points.join(",\n"))
    }

    /// `results.csv`.
    pub fn csv(&self, plan: &Plan) -> String {
        let axes = plan.axes();
        let rows = self.points.iter().map(|point| row(axes, point));
        table([head(axes)].into_iter().chain(rows))
    }

    /// `results.parquet`: what `results.csv` has.
    ///
    /// # Errors
    /// A plan that sets one key twice.
    #[cfg(feature = "parquet")]
    pub fn parquet(&self, plan: &Plan) -> Result<Vec<u8>> {
        let axes = plan.axes();
        let rows: Vec<_> = self.points.iter().map(|point| row(axes, point)).collect();
        crate::parquet::file(&head(axes), &rows)
    }

    /// `times.csv`.
    pub fn times_csv(&self) -> String {
        let head = ["key", "seconds", "plant_s_per_s", "core_s_per_s"].map(String::from);
        let row = |of: &Times| {
            let numbers = [of.seconds, of.plant, of.core].map(|number| format!("{number:.6}"));
            [vec![of.key.clone()], numbers.to_vec()].concat()
        };
        table([head.to_vec()].into_iter().chain(self.times.values().map(row)))
    }
}

/// Marks the points that none beats in error, area and age together, for each quantity.
fn mark_front(points: &mut [Collect]) {
    for (n, quantity) in Quantity::ALL.into_iter().enumerate() {
        let ran: Vec<usize> =
            (0..points.len()).filter(|at| points[*at].line.results.is_some()).collect();
        let numbers = |at: &usize| {
            let of = points[*at].line.results.as_ref().expect("it was run");
            [of.measured.all()[n].rms, of.cost.luts, of.cost.age_us]
        };
        let on = front(&ran.iter().map(numbers).collect::<Vec<_>>());
        for at in ran.into_iter().zip(on).filter_map(|(at, on)| on.then_some(at)) {
            points[at].front.push(quantity);
        }
    }
}

/// The name of an axis' column.
pub fn column(axis: &Axis) -> String {
    let side = if axis.side == Side::Profile { "profile" } else { "scene" };
    format!("{side}.{}", axis.key)
}

/// Columns of cost and slots.
const COSTS: [&str; 15] = [
    "latency_clocks",
    "age_us",
    "frames_per_second",
    "luts_ecp5",
    "luts_ice40",
    "flip_flops",
    "multipliers",
    "memory_bits",
    "multipliers_ice40",
    "block_rams_ecp5",
    "block_rams_ice40",
    "slots",
    "flagged",
    "plant_percent",
    "least_codes",
];

/// Columns of errors: predicted, measured and true ones, then measured and true ones of loops; three
/// quantities each, three numbers of each.
const ERRORS: usize = (3 + 2) * 3 * 3;

fn head(axes: &[Axis]) -> Vec<String> {
    let mut head = vec!["key".to_string(), "seed".to_string()];
    head.extend(axes.iter().map(column));
    head.extend(COSTS.map(String::from));
    for kind in ["predicted", "measured", "truth"] {
        for quantity in Quantity::ALL {
            let name = |what: &str| format!("{kind}_{}_{what}", quantity.name());
            head.extend(["rms", "mean", "largest"].map(name));
        }
    }
    for kind in ["measured", "truth"] {
        for (quantity, _) in LoopErrors::QUANTITIES {
            let name = |what: &str| format!("{kind}_{quantity}_{what}");
            head.extend(["rms", "mean", "largest"].map(name));
        }
    }
    head.extend(["front", "error"].map(String::from));
    head
}

fn row(axes: &[Axis], Collect { line, front }: &Collect) -> Vec<String> {
    let mut row = vec![line.key.clone(), line.seed.to_string()];
    let set = |axis: &Axis| {
        let of = if axis.side == Side::Profile { &line.profile } else { &line.scene };
        of.get(&axis.key).map_or(String::new(), plain)
    };
    row.extend(axes.iter().map(set));
    let none = || vec![String::new(); COSTS.len() + ERRORS];
    row.extend(line.results.as_ref().map_or_else(none, numbers));
    let names: Vec<_> = front.iter().map(|quantity| quantity.name()).collect();
    row.extend([names.join(" "), line.error.clone().unwrap_or_default()]);
    row
}

fn numbers(of: &Results) -> Vec<String> {
    let cost = &of.cost;
    let numbers = [
        cost.latency_clocks as f64,
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
        of.slots as f64,
        of.flagged as f64,
    ];
    let mut cells: Vec<_> = numbers.iter().map(f64::to_string).collect();
    cells.push(of.plant_percent().map_or(String::new(), |percent| format!("{percent:e}")));
    let predicted = of.predicted.as_ref();
    cells.push(predicted.map_or(String::new(), |of| of.least_codes.to_string()));
    cells.extend(predicted.map_or_else(|| vec![String::new(); 9], |of| three(&of.errors)));
    cells.extend(three(&of.measured));
    cells.extend(three(&of.truth));
    let [measured, truth] =
        of.looped.map_or_else(Default::default, |looped| [looped.measured, looped.truth]);
    cells.extend(measured.all().into_iter().chain(truth.all()).flat_map(looped));
    cells
}

/// An error of a loop, where there is one.
fn looped(of: Option<Error>) -> [String; 3] {
    of.map_or_else(Default::default, number)
}

fn three(of: &Three) -> Vec<String> {
    of.all().into_iter().flat_map(number).collect()
}

fn number(of: Error) -> [String; 3] {
    [of.rms, of.mean, of.largest].map(|number| format!("{number:e}"))
}

fn table(rows: impl Iterator<Item = Vec<String>>) -> String {
    let mut table = csv::Writer::from_writer(Vec::new());
    rows.for_each(|row| table.write_record(row).expect("rows of one length, in memory"));
    let bytes = table.into_inner().expect("memory takes all");
    String::from_utf8(bytes).expect("texts")
}

/// The settings of a point in words, of those keys that a plan varies.
pub fn settings(line: &Line) -> String {
    let pair = |(key, value): (&String, &Value)| format!("{key}={}", plain(value));
    let mut words: Vec<_> = line.scene.iter().chain(&line.profile).map(pair).collect();
    words.push(format!("seed={}", line.seed));
    words.join(" ")
}
