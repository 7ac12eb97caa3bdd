// SPDX-License-Identifier: MIT OR Apache-2.0
//! An estimate against a quantity that is swept: one line for each value of load and haptic voltage.

use std::collections::BTreeMap;

use hapticore_scene::Quantity;

use super::estimate::{Estimate, estimated, truth};
use super::{greatest, mean};
use crate::record::Row;

/// Means of the estimate over equal values of `with`, in their order.
type Line = Vec<[f64; 2]>;

fn lines(rows: &[&Row], of: Quantity, with: Quantity, estimate: Estimate) -> Vec<Line> {
    let key = |value: f64| (value * 1e6).round() as i64;
    let mut lines: BTreeMap<Vec<i64>, BTreeMap<i64, Vec<[f64; 2]>>> = BTreeMap::new();
    for row in rows {
        let others = [Quantity::LoadG, Quantity::HapticVRms];
        let fixed = others.into_iter().filter(|other| *other != with);
        let line = lines.entry(fixed.map(|other| key(truth(row, other, 0.0))).collect());
        let at = truth(row, with, 0.0);
        let points = line.or_default().entry(key(at)).or_default();
        points.push([at, estimated(row, of, estimate)]);
    }
    let average = |points: Vec<[f64; 2]>| [0, 1].map(|n| mean(points.iter().map(|point| point[n])));
    lines.into_values().map(|line| line.into_values().map(average).collect()).collect()
}

/// The smallest step, negated, between neighbouring values of `with`, in percent of the mean.
pub fn rise(rows: &[&Row], of: Quantity, with: Quantity, estimate: Estimate) -> f64 {
    let overall = mean(rows.iter().map(|row| estimated(row, of, estimate)));
    let lines = lines(rows, of, with, estimate);
    let falls = lines.iter().flat_map(|line| line.windows(2).map(|pair| pair[0][1] - pair[1][1]));
    100.0 * greatest(falls) / overall.abs()
}

/// The largest departure from the best straight line, in percent of what it spans.
pub fn nonlinearity(rows: &[&Row], of: Quantity, with: Quantity, estimate: Estimate) -> f64 {
    greatest(lines(rows, of, with, estimate).iter().map(|line| of_line(line)))
}

fn of_line(line: &[[f64; 2]]) -> f64 {
    let [at, value] = [0, 1].map(|n| mean(line.iter().map(|point| point[n])));
    let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
        line.iter().map(|[x, y]| of(x - at, y - value)).sum()
    };
    let slope = sum(&|x, y| x * y) / sum(&|x, _| x * x);
    let off = line.iter().map(|[x, y]| (y - value - slope * (x - at)).abs());
    let (first, last) = (line.first().map_or(0.0, |it| it[0]), line.last().map_or(0.0, |it| it[0]));
    100.0 * greatest(off) / (slope * (last - first)).abs()
}
