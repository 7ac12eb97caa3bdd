// SPDX-License-Identifier: MIT OR Apache-2.0
//! Force controllers of other projects beside this project's, as a table in Markdown.
//!
//! `cargo run --release -p hapticore-tests --example rivals [tune]`: with `tune`, looks for the gains
//! with which each law follows 0.2 and 0.7 N best; the table's targets are others.

use hapticore_tests::rivals::laws::Gains;
use hapticore_tests::rivals::table::{KINDS, Row};
use hapticore_tests::rivals::trial::{Kind, Target, Trial, rms_n};
use rayon::prelude::*;

const RAIL_V: f64 = 500.0;

/// Targets that gains are found on.
const TUNED_ON: [Target; 4] =
    [Target::Square(0.2), Target::Square(0.7), Target::Sine(0.2), Target::Sine(0.7)];

/// Powers of √2.
fn powers(from: i32, to: i32) -> impl Iterator<Item = f64> {
    (from..=to).map(|n| 2f64.powf(f64::from(n) / 2.0))
}

/// Pairs of gains that are tried: of the first also none.
fn pairs(second: (i32, i32)) -> Vec<[f64; 2]> {
    let pair = |first| powers(second.0, second.1).map(move |second| [first, second]);
    std::iter::once(0.0).chain(powers(6, 20)).flat_map(pair).collect()
}

fn tune(name: &str, tried: &[[f64; 2]], kind: impl Fn([f64; 2]) -> Kind + Sync) {
    let error = |gains: &[f64; 2]| {
        let of = |target| rms_n(&Trial::new(kind(*gains), target, RAIL_V).run()).powi(2);
        (TUNED_ON.map(of).iter().sum::<f64>().sqrt(), *gains)
    };
    let best = tried.par_iter().map(error).min_by(|a, b| a.0.total_cmp(&b.0));
    println!("{name}: {best:?}");
}

fn main() {
    if std::env::args().nth(1).is_some_and(|word| word == "tune") {
        let of = |[proportional, integral]: [f64; 2]| Gains { proportional, integral };
        let each_frame = pairs((4, 20));
        tune("idsp", &each_frame, |gains| Kind::Idsp(of(gains)));
        tune("PyRPL", &each_frame, |gains| Kind::PyRpl(of(gains)));
        tune("Linien", &each_frame, |gains| Kind::Linien(of(gains)));
        tune("proportional", &pairs((-10, 0)), |gains| Kind::Ours("proportional", gains));
        tune("integral", &pairs((26, 41)), |gains| Kind::Ours("integral", gains));
        return;
    }
    println!("{}", Row::HEAD);
    let rows: Vec<String> = KINDS.par_iter().map(|&kind| Row::of(kind).text()).collect();
    rows.iter().for_each(|row| println!("{row}"));
}
