// SPDX-License-Identifier: MIT OR Apache-2.0
//! The force table of a device, from readings of its force and from a prior.
//!
//! ```text
//! F/k = (C·V)²·(a(C) + b(C)·V_s + d(C)·(V_s − V_m)) + ε,   a, b, d linear between the rows: θ, 33 numbers
//! θ ~ N(θ₀, Σ) before,   θ = θ₀ + ΣAᵀ·(AΣAᵀ + R)⁻¹·(F/k − Aθ₀) after
//! ```
//!
//! k is that of eq. 8 on the same readings: with it friction coefficient and scales drop out of the
//! prior, which is the mean and the covariance of θ over simulated devices
//! (`examples/force_prior.rs`). Readings are taken one after the other (R is diagonal), which is the
//! same in exact arithmetic (Kalman 1960). Without the prior the table goes anywhere where there are
//! no readings.

use hapticore_contract::calibration::ForceTable;
use hapticore_host::device::{Force, MEAN_S, RECENT_S, RELEASE_V};

/// Numbers of a table.
pub const NUMBERS: usize = 3 * ForceTable::ROWS;

/// Voltages of the numbers are shares of this, so that all are about one, V.
pub const VOLTS: f64 = 400.0;

/// The deviation that a settled reading counts with, N: 5 mN of measurement, and what a table cannot
/// follow. The latter is alike in neighbouring readings, so that together they tell less than as many
/// independent ones. Chosen with [`STEP_N`] so that all limits of the model device hold
/// (`tests/force_table.rs`, the force loop's `tests/tracking.rs`).
pub const SETTLED_N: f64 = 0.0075;

/// The deviation that a reading of a voltage that has changed counts with, N: neighbours are more
/// alike than settled ones.
pub const STEP_N: f64 = 0.016;

/// The numbers of a table: a, b, d of each row, b and d per [`VOLTS`].
pub type Numbers = [f64; NUMBERS];

/// The covariance of numbers.
pub type Covariance = Vec<Numbers>;

/// A force that was measured, and the voltage that the pad has had.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// The pad's capacitance, pF.
    pub capacitance_pf: f64,
    /// The haptic voltage at the pad, V rms.
    pub haptic_v_rms: f64,
    /// V_s, V.
    pub recent_v: f64,
    /// V_m, V.
    pub mean_v: f64,
    /// The haptic force, N.
    pub force_n: f64,
}

/// What is known of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Knowledge {
    /// The expected numbers.
    pub numbers: Numbers,
    /// Their covariance.
    pub covariance: Covariance,
}

/// The prior: what the numbers of simulated devices are.
const PRIOR: &str = include_str!("force_prior.csv");

impl Reading {
    /// A reading of a pad that has had its voltage for long.
    pub fn settled(capacitance_pf: f64, haptic_v_rms: f64, force_n: f64) -> Self {
        let [recent_v, mean_v] = [haptic_v_rms; 2];
        Reading { capacitance_pf, haptic_v_rms, recent_v, mean_v, force_n }
    }

    /// (C·V)², in (F·V)².
    pub fn square(&self) -> f64 {
        (1e-12 * self.capacitance_pf * self.haptic_v_rms).powi(2)
    }

    /// What each number contributes to the factor of k.
    fn shares(&self) -> Numbers {
        let (row, share) = ForceTable::place(self.capacitance_pf);
        let terms = [1.0, self.recent_v / VOLTS, (self.recent_v - self.mean_v) / VOLTS];
        let mut shares = [0.0; NUMBERS];
        for (column, term) in terms.into_iter().enumerate() {
            shares[3 * row + column] = (1.0 - share) * term;
            shares[3 * row + 3 + column] = share * term;
        }
        shares
    }
}

/// Readings of a record of one pad, in its order: times since the voltage was switched on, s, and
/// settled readings where there are none. A time that does not rise begins another record.
pub fn follow(record: &[(Option<f64>, [f64; 3])]) -> Vec<Reading> {
    let (mut before_s, mut past) = (0.0, [0.0; 2]);
    let mut reading =
        |&(time_s, [capacitance_pf, haptic_v_rms, force_n]): &(Option<f64>, [f64; 3])| {
            let Some(time_s) = time_s else {
                return Reading::settled(capacitance_pf, haptic_v_rms, force_n);
            };
            if time_s <= before_s || haptic_v_rms < RELEASE_V {
                (before_s, past) = (0.0, [0.0; 2]);
            }
            for (past, constant_s) in past.iter_mut().zip([RECENT_S, MEAN_S]) {
                *past -= (-(time_s - before_s) / constant_s).exp_m1() * (haptic_v_rms - *past);
            }
            before_s = time_s;
            let [recent_v, mean_v] = past;
            Reading { capacitance_pf, haptic_v_rms, recent_v, mean_v, force_n }
        };
    record.iter().map(&mut reading).collect()
}

/// k of eq. 8 over readings, by least squares.
pub fn eq8(readings: &[Reading]) -> f64 {
    gain(readings, |reading| reading.square())
}

/// What a model of the force is to be multiplied by, by least squares.
pub fn gain(readings: &[Reading], model: impl Fn(&Reading) -> f64) -> f64 {
    let product: f64 = readings.iter().map(|reading| model(reading) * reading.force_n).sum();
    product / readings.iter().map(|reading| model(reading).powi(2)).sum::<f64>()
}

impl Knowledge {
    /// The prior that is committed.
    ///
    /// # Panics
    /// Where its file is damaged.
    pub fn prior() -> Self {
        let row = |line: &str| -> Numbers {
            let numbers: Vec<f64> =
                line.split(',').map(|x| x.parse().expect("a number of the prior")).collect();
            numbers.try_into().expect("as many numbers as a table has")
        };
        let mut rows = PRIOR.lines().filter(|line| !line.starts_with('#')).map(row);
        let numbers = rows.next().expect("the prior's mean");
        let covariance: Covariance = rows.collect();
        assert_eq!(covariance.len(), NUMBERS, "the prior's covariance is square");
        Knowledge { numbers, covariance }
    }

    /// Takes a reading of the factor: numbers with these shares, its value, its variance.
    pub fn learn(&mut self, shares: &Numbers, value: f64, variance: f64) {
        let dot = |row: &Numbers| row.iter().zip(shares).map(|(a, b)| a * b).sum::<f64>();
        let reach: Vec<f64> = self.covariance.iter().map(dot).collect();
        let total = reach.iter().zip(shares).map(|(a, b)| a * b).sum::<f64>() + variance;
        let miss = value - dot(&self.numbers);
        for (number, reach) in self.numbers.iter_mut().zip(&reach) {
            *number += reach * miss / total;
        }
        for (row, a) in self.covariance.iter_mut().zip(&reach) {
            for (entry, b) in row.iter_mut().zip(&reach) {
                *entry -= a * b / total;
            }
        }
    }

    /// Takes readings, whose forces have this deviation, N, as multiples of `force_k`.
    pub fn learn_all(&mut self, readings: &[Reading], force_k: f64, deviation_n: f64) {
        for reading in readings.iter().filter(|reading| reading.haptic_v_rms >= RELEASE_V) {
            let scale = force_k * reading.square();
            let shares = reading.shares().map(|share| share * scale);
            self.learn(&shares, reading.force_n, deviation_n.powi(2));
        }
    }

    /// The table of the expected numbers, for filters of these times.
    pub fn table(&self, recent_s: f64) -> Force {
        let row = |row: usize| {
            let [a, b, d] = std::array::from_fn(|column| self.numbers[3 * row + column]);
            [a, b / VOLTS, d / VOLTS]
        };
        let rows = std::array::from_fn(row);
        Force { recent_s, mean_s: MEAN_S, release_v: RELEASE_V, rows }
    }
}

/// The table of a device, from readings and the prior, as multiples of `force_k`. The prior's are
/// those of the k of eq. 8 on settled readings.
pub fn fit(readings: &[Reading], force_k: f64) -> Force {
    let (settled, steps): (Vec<Reading>, Vec<_>) =
        readings.iter().partition(|r| r.recent_v == r.haptic_v_rms);
    let own_k = eq8(if settled.is_empty() { readings } else { &settled });
    let mut knowledge = Knowledge::prior();
    knowledge.learn_all(&settled, own_k, SETTLED_N);
    knowledge.learn_all(&steps, own_k, STEP_N);
    let mut table = knowledge.table(RECENT_S);
    table.rows.iter_mut().flatten().for_each(|number| *number *= own_k / force_k);
    table
}

/// What a table leaves of readings, N (largest, rms); and what eq. 8 leaves.
pub fn residuals(readings: &[Reading], force_k: f64, table: &Force) -> [[f64; 2]; 2] {
    let of = |factor: &dyn Fn(&Reading) -> f64| {
        let off = |r: &Reading| force_k * r.square() * factor(r) - r.force_n;
        let squares: f64 = readings.iter().map(|reading| off(reading).powi(2)).sum();
        let largest = readings.iter().map(|reading| off(reading).abs()).fold(0.0, f64::max);
        [largest, (squares / readings.len() as f64).sqrt()]
    };
    [of(&|r| table.factor(r.capacitance_pf, r.recent_v, r.mean_v)), of(&|_| 1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    /// One reading after the other, against the formula over all of them and its inverse.
    #[test]
    fn readings_one_by_one_are_all_at_once() {
        let prior = Knowledge::prior();
        let reading = |k: u32| {
            let k = f64::from(k);
            let [capacitance_pf, haptic_v_rms] = [330.0 + 14.0 * k, 120.0 + 7.0 * k];
            let recent_v = 0.9 * haptic_v_rms;
            Reading { capacitance_pf, haptic_v_rms, recent_v, mean_v: 5.0 * k, force_n: 0.015 * k }
        };
        let readings: Vec<_> = (1..40).map(reading).collect();
        let mut one_by_one = prior.clone();
        one_by_one.learn_all(&readings, 9e12, 0.01);
        let rows = readings.iter().map(|r| r.shares().map(|share| 9e12 * r.square() * share));
        let rows: Vec<f64> = rows.flatten().collect();
        let a = DMatrix::from_row_slice(readings.len(), NUMBERS, &rows);
        let sigma = DMatrix::from_fn(NUMBERS, NUMBERS, |i, j| prior.covariance[i][j]);
        let mean = DVector::from_row_slice(&prior.numbers);
        let forces = DVector::from_iterator(readings.len(), readings.iter().map(|r| r.force_n));
        let noise = DMatrix::identity(readings.len(), readings.len()) * 1e-4;
        let inverse = (&a * &sigma * a.transpose() + noise).try_inverse().expect("positive");
        let at_once = &mean + &sigma * a.transpose() * inverse * (forces - &a * &mean);
        for (a, b) in one_by_one.numbers.iter().zip(at_once.iter()) {
            assert!((a - b).abs() < 1e-7, "{a} {b}");
        }
    }

    #[test]
    fn a_record_is_followed_from_its_start() {
        let at = |time_s, volt| (time_s, [400.0, volt, 0.1]);
        let record =
            [at(Some(0.01), 300.0), at(Some(0.03), 300.0), at(Some(0.01), 200.0), at(None, 100.0)];
        let readings = follow(&record);
        let expected = |time: f64, volt: f64| volt * (1.0 - (-time / RECENT_S).exp());
        assert!((readings[1].recent_v - expected(0.03, 300.0)).abs() < 1e-9, "two steps are one");
        assert!((readings[2].recent_v - expected(0.01, 200.0)).abs() < 1e-9, "another record");
        assert_eq!((readings[3].recent_v, readings[3].mean_v), (100.0, 100.0), "settled");
    }
}
