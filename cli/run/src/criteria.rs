// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a scene claims, measured over the rows of a run.

use std::collections::BTreeMap;

use hapticore_scene::{Criterion, Measure, Per, Quantity};

use crate::record::{self, Row};
use estimate::{Estimate, estimated, truth};

mod affine;
mod departure;
mod estimate;
mod jumps;
mod lines;

/// A case that was run, as criteria see it.
pub struct CaseRows<'a> {
    /// Name of the case.
    pub name: &'a str,
    /// Start of the case, s.
    pub start_s: f64,
    /// The largest sample, as a fraction of full scale.
    pub peak: f64,
    /// Rows of the case.
    pub rows: &'a [Row],
}

/// Measures each criterion that covers a case that was run.
pub fn measure(criteria: &[Criterion], cases: &[CaseRows]) -> Vec<record::Criterion> {
    let covers = |criterion: &&Criterion| cases.iter().any(|case| criterion.covers(case.name));
    criteria.iter().filter(covers).map(|criterion| measure_criterion(criterion, cases)).collect()
}

fn measure_criterion(criterion: &Criterion, cases: &[CaseRows]) -> record::Criterion {
    let covered = || cases.iter().filter(|case| criterion.covers(case.name));
    let sets: Vec<Vec<&Row>> = covered().flat_map(|case| sets(criterion, case)).collect();
    let worst = |of: &dyn Fn(&[&Row]) -> f64| greatest(sets.iter().map(|set| of(set)));
    let jump = |case: &CaseRows| {
        let off = |rows: &Vec<&Row>| jumps::off(rows, criterion, case.start_s);
        greatest(self::sets(criterion, case).iter().map(off))
    };
    let measured = match criterion.measure {
        Measure::MaxPercentOfFullScale => 100.0 * greatest(covered().map(|case| case.peak)),
        Measure::JumpOff => greatest(covered().map(jump)),
        _ => worst(&|rows| value(criterion, rows, Estimate::Core)),
    };
    let applicable = criterion.filters.is_empty() || !sets.is_empty();
    record::Criterion {
        name: criterion.name.clone(),
        measured,
        limit: criterion.limit,
        pass: measured <= criterion.limit || !applicable,
        applicable,
        unit: criterion.unit.clone(),
        baseline: baseline(criterion)
            .map(|(name, of)| (name.to_string(), worst(&|rows| of(criterion, rows)))),
        bounds: bounds(criterion),
    }
}

fn bounds(criterion: &Criterion) -> Option<record::Bounds> {
    let each = criterion.measure == Measure::MaxAbsError && criterion.filters.is_empty();
    each.then(|| record::Bounds { of: criterion.of.name(), cases: criterion.cases.clone() })
}

/// The greatest value; not a number where there is none, or where one of them is none.
fn greatest(values: impl Iterator<Item = f64>) -> f64 {
    let greater = |greatest: Option<f64>, value: f64| match greatest {
        Some(greatest) if greatest.is_nan() || greatest >= value => Some(greatest),
        _ => Some(value),
    };
    values.fold(None, greater).unwrap_or(f64::NAN)
}

/// The sets of rows over each of which the measure is taken.
fn sets<'a>(criterion: &Criterion, case: &'a CaseRows) -> Vec<Vec<&'a Row>> {
    let holds = |row: &&Row| {
        criterion.filters.iter().all(|filter| {
            let truth = truth(row, filter.of, case.start_s);
            (filter.low..=filter.high).contains(&truth)
        })
    };
    let rows = case.rows.iter().filter(holds);
    let mut sets: BTreeMap<usize, Vec<&Row>> = BTreeMap::new();
    for row in rows {
        let group = row.truth.map_or(0, |truth| truth.group);
        sets.entry(if criterion.per == Per::Group { group } else { 0 }).or_default().push(row);
    }
    sets.into_values().collect()
}

type Baseline = fn(&Criterion, &[&Row]) -> f64;

/// The baseline that a measure is compared with: its name and how it is measured.
fn baseline(criterion: &Criterion) -> Option<(&'static str, Baseline)> {
    match (criterion.measure, criterion.of) {
        (
            Measure::MaxPercentOfFullScale
            | Measure::InvalidPercent
            | Measure::JumpOff
            | Measure::RmsOffTarget
            | Measure::MaxAboveTarget
            | Measure::MaxBelowTarget,
            _,
        ) => None,
        (Measure::MaxAbsError | Measure::RmsError, Quantity::PositionMm) => {
            Some(("best affine fit", |criterion, rows| {
                errors(criterion.measure, affine::distances(rows))
            }))
        }
        (
            Measure::SpreadPercent | Measure::MaxPercentError,
            Quantity::ForceN | Quantity::CapacitancePf,
        ) => Some(("eq. 6 alone", |criterion, rows| value(criterion, rows, Estimate::Eq6))),
        _ => {
            Some(("floating point", |criterion, rows| value(criterion, rows, Estimate::Reference)))
        }
    }
}

/// The measure over one set of rows.
fn value(criterion: &Criterion, rows: &[&Row], estimate: Estimate) -> f64 {
    let of = criterion.of;
    let pairs = || rows.iter().map(|row| (estimated(row, of, estimate), truth(row, of, 0.0)));
    match criterion.measure {
        Measure::MaxAbsError | Measure::RmsError => {
            let distance = |row: &&Row| distance(row, of, estimate);
            errors(criterion.measure, rows.iter().map(distance))
        }
        Measure::MeanError => mean(pairs().map(|(estimated, truth)| estimated - truth)).abs(),
        Measure::MaxPercentError => {
            let true_ones = pairs().filter(|(_, truth)| *truth != 0.0);
            greatest(
                true_ones.map(|(estimated, truth)| 100.0 * ((estimated - truth) / truth).abs()),
            )
        }
        Measure::SpreadPercent => spread(rows.iter().map(|row| estimated(row, of, estimate))),
        Measure::IncreasesWith => lines::rise(rows, of, criterion.with.unwrap_or(of), estimate),
        Measure::NonlinearityPercent => {
            lines::nonlinearity(rows, of, criterion.with.unwrap_or(of), estimate)
        }
        Measure::InvalidPercent => {
            100.0 * mean(rows.iter().map(|row| f64::from(row.flags.contains("invalid"))))
        }
        Measure::MaxOff => {
            let expected = criterion.expected.unwrap_or(f64::NAN);
            greatest(rows.iter().map(|row| (estimated(row, of, estimate) - expected).abs()))
        }
        Measure::MeanOff => {
            let expected = criterion.expected.unwrap_or(f64::NAN);
            (mean(rows.iter().map(|row| estimated(row, of, estimate))) - expected).abs()
        }
        Measure::RmsOffTarget => mean(rows.iter().map(|row| off_target(row).powi(2))).sqrt(),
        Measure::MaxAboveTarget => greatest(rows.iter().map(|row| off_target(row))),
        Measure::MaxBelowTarget => greatest(rows.iter().map(|row| -off_target(row))),
        Measure::DepartureOff => departure::off(rows, criterion, estimate),
        Measure::MaxPercentOfFullScale | Measure::JumpOff => f64::NAN,
    }
}

/// By how much the true force is more than its target, N: that which a wall gives, where the pad has
/// one, else that of the scene at the time.
fn off_target(row: &Row) -> f64 {
    let of_wall = row.driven.filter(|driven| driven.free.is_some());
    row.truth.map_or(f64::NAN, |truth| match of_wall {
        Some(driven) => truth.quantities.force_n - driven.target_n,
        None => truth.off_target_n(),
    })
}

fn errors(measure: Measure, distances: impl Iterator<Item = f64>) -> f64 {
    match measure {
        Measure::MaxAbsError => greatest(distances),
        _ => mean(distances.map(|distance| distance * distance)).sqrt(),
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0usize), |(sum, count), value| (sum + value, count + 1));
    sum / count as f64
}

fn spread(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let highest = greatest(values.clone());
    let lowest = -greatest(values.clone().map(|value| -value));
    100.0 * (highest - lowest) / mean(values)
}

/// How far the estimate is from the truth.
fn distance(row: &Row, of: Quantity, estimate: Estimate) -> f64 {
    match of {
        Quantity::PositionMm => {
            let off = |of| estimated(row, of, estimate) - truth(row, of, 0.0);
            off(Quantity::XMm).hypot(off(Quantity::YMm))
        }
        _ => (estimated(row, of, estimate) - truth(row, of, 0.0)).abs(),
    }
}
