// SPDX-License-Identifier: MIT OR Apache-2.0
//! Estimated area beside what synthesis made of random profiles (`area.csv`, by
//! `cargo run --release -p hapticore-tradeoff --example area > cli/tradeoff/tests/area.csv`).
//!
//! Of four profiles two were fitted to; the other two are judged here.

use hapticore_contract::profile::Profile;
use hapticore_synth::loops::{Loop, LoopsReport};
use hapticore_synth::target::Family;
use hapticore_tradeoff::cost::{Cost, cost};
use hapticore_tradeoff::knobs::Knob;
use std::collections::BTreeMap;

type Row = BTreeMap<&'static str, &'static str>;

fn rows() -> Vec<Row> {
    let mut lines = include_str!("area.csv").lines();
    let heads: Vec<&str> = lines.next().expect("heads").split(',').collect();
    lines.map(|line| heads.iter().copied().zip(line.split(',')).collect()).collect()
}

fn number(row: &Row, name: &str) -> f64 {
    row[name].parse().expect("a number")
}

/// The core of a row, estimated.
fn estimated(row: &Row) -> Cost {
    let base = Profile::bundled(row["base"]).expect("bundled");
    // A word that must not be longer than another's waits for it.
    let profile = (0..2).flat_map(|_| Knob::words()).fold(base, |profile, knob| {
        knob.set(&profile, number(row, knob.key()) as u64).unwrap_or(profile)
    });
    for knob in Knob::words() {
        assert_eq!(knob.value(&profile), number(row, knob.key()) as u64, "{}", knob.key());
    }
    cost(&profile).expect("a core")
}

#[test]
fn areas_are_those_of_synthesis() {
    let rows = rows();
    assert!(rows.len() >= 100, "{} runs of synthesis", rows.len());
    for family in Family::ALL {
        check(&rows, family, "luts", |of, family| of.luts_of(family), [5.0, 12.0]);
        check(&rows, family, "registers", |of, family| of.flip_flops_of(family), [2.0, 4.0]);
    }
}

/// Holds what estimates are off what synthesis made: in the median and at 95 %, in per cent.
fn check(rows: &[Row], family: Family, what: &str, of: fn(&Cost, Family) -> f64, most: [f64; 2]) {
    let of_family = rows.iter().filter(|row| row["family"] == format!("{family:?}"));
    let judged = of_family.enumerate().filter(|(n, _)| n % 4 >= 2).map(|(_, row)| row);
    let mut off: Vec<f64> =
        judged.map(|row| (of(&estimated(row), family) / number(row, what) - 1.0).abs()).collect();
    off.sort_by(f64::total_cmp);
    let at = |part: f64| 100.0 * off[((off.len() - 1) as f64 * part).round() as usize];
    println!(
        "{family:?}: {what} of {} cores off by {:.1} % in the median, {:.1} % at 95 %, {:.1} % at most",
        off.len(),
        at(0.5),
        at(0.95),
        at(1.0)
    );
    let [median, high] = [at(0.5), at(0.95)];
    assert!(median <= most[0] && high <= most[1], "{family:?}, {what}: {median} %, {high} %");
}

/// Loops of `synth/reports/loops.json`, to which one number of each family was fitted.
#[test]
fn force_loops_are_estimated_too() {
    let report = include_str!("../../../synth/reports/loops.json");
    let report: LoopsReport = serde_json::from_str(report).expect("a report");
    for of in Loop::all() {
        let row = report.rows.iter().find(|row| of.is_of(row)).expect("a row of the report");
        let (estimated, ice40) = (cost(&of.profile).expect("a loop"), of.family == Family::Ice40);
        let counted = match ice40 {
            true => [estimated.multipliers_ice40, estimated.block_rams_ice40],
            false => [estimated.multipliers, estimated.block_rams],
        };
        let cells = row.measured.cells;
        let synthesised = [cells.multipliers, cells.block_rams].map(|count| count as f64);
        assert_eq!(counted, synthesised, "{}, {}", row.profile, row.adds);
        let off = 100.0 * (estimated.luts_of(of.family) / cells.luts as f64 - 1.0);
        println!("{}, {}: LUT4 off by {off:.1} %", row.profile, row.adds);
        assert!(off.abs() < 9.0, "{}, {}: {off} %", row.profile, row.adds);
    }
}

#[test]
fn multipliers_and_block_rams_are_counted() {
    let mut wrong = Vec::new();
    for (n, row) in rows().iter().enumerate() {
        let of = estimated(row);
        let counted = match row["family"] {
            "Ecp5" => [of.multipliers, of.block_rams],
            _ => [of.multipliers_ice40, of.block_rams_ice40],
        };
        for (counted, what) in counted.into_iter().zip(["multipliers", "block_rams"]) {
            if counted != number(row, what) {
                let family = row["family"];
                wrong.push(format!("row {n}, {family} {what}: {counted} for {}", row[what]));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
