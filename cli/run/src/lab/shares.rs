// SPDX-License-Identifier: MIT OR Apache-2.0
//! The shares of the terminals' currents at any place, from those at known places: a local quadratic
//! by weighted least squares.
//!
//! ```text
//!   s(p) = c_0,   c minimises Σ w_i²·|c_0 + c_1·u + c_2·v + c_3·u² + c_4·uv + c_5·v² − s_i|²,   (u, v) = (p_i − p)/d
//!   w_i = (1 − |p_i − p|²/d²)^1.5 over the NEAREST places, d the distance of the farthest of them
//! ```
//!
//! Source: Cleveland, Devlin, "Locally weighted regression", 1988.

use hapticore_host::device::Shares;
use nalgebra::{DMatrix, SMatrix, SVector};

/// Places that a prediction is made from.
const NEAREST: usize = 16;

/// Places that are kept at most.
const MOST_PLACES: usize = 700;

/// Places at which the error is measured at most.
const TRIED: usize = 150;

/// 1, u, v, u², uv, v².
const COEFFICIENTS: usize = 6;

/// The shares of some places, as a calibration keeps them; none where places are too few.
pub fn of(places: &[([f64; 2], Vec<f64>)]) -> Option<Shares> {
    let every = places.len().div_ceil(MOST_PLACES).max(1);
    let row = |(at, shares): &([f64; 2], Vec<f64>)| at.iter().chain(shares).copied().collect();
    let mut shares = Shares { error: 0.0, places: places.iter().step_by(every).map(row).collect() };
    if shares.places.len() <= NEAREST {
        return None;
    }
    let tried = (0..shares.places.len()).step_by(shares.places.len().div_ceil(TRIED));
    let mut errors: Vec<f64> = tried
        .filter_map(|index| {
            let row = &shares.places[index];
            let told = predicted(&shares, [row[0], row[1]], Some(index))?;
            Some(off(&told, &row[2..]))
        })
        .collect();
    errors.sort_by(f64::total_cmp);
    shares.error = *errors.get(errors.len() / 2)?;
    // More digits than a measurement has make files long.
    shares.places.iter_mut().flatten().for_each(|number| *number = (1e5 * *number).round() / 1e5);
    Some(shares)
}

/// Half of the sum of the distances of shares from others: the part of the current that is not where it should be.
pub fn off(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f64>() / 2.0
}

/// The shares at a place, without those of the place of a number; none where the places about it are on a line.
pub fn predicted(known: &Shares, at_mm: [f64; 2], without: Option<usize>) -> Option<Vec<f64>> {
    let square = |row: &Vec<f64>| (row[0] - at_mm[0]).powi(2) + (row[1] - at_mm[1]).powi(2);
    let mut near: Vec<(f64, usize)> = known
        .places
        .iter()
        .enumerate()
        .filter(|(index, _)| Some(*index) != without)
        .map(|(index, row)| (square(row), index))
        .collect();
    if near.len() < NEAREST {
        return None;
    }
    near.select_nth_unstable_by(NEAREST - 1, |a, b| a.0.total_cmp(&b.0));
    near.truncate(NEAREST);
    let farthest = near.iter().map(|(square, _)| *square).fold(0.0, f64::max);
    let terminals = known.places[0].len() - 2;
    let mut normal = SMatrix::<f64, COEFFICIENTS, COEFFICIENTS>::zeros();
    let mut sides = DMatrix::<f64>::zeros(COEFFICIENTS, terminals);
    for (square, index) in near {
        let row = &known.places[index];
        let [u, v] = [0, 1].map(|axis| (row[axis] - at_mm[axis]) / farthest.sqrt());
        let weight = (1.0 - 0.999 * square / farthest).powi(3);
        let terms = SVector::<f64, COEFFICIENTS>::from([1.0, u, v, u * u, u * v, v * v]);
        normal += weight * terms * terms.transpose();
        for k in 0..terminals {
            for term in 0..COEFFICIENTS {
                sides[(term, k)] += weight * terms[term] * row[2 + k];
            }
        }
    }
    let inverse = normal.try_inverse()?;
    let share =
        |k: usize| (0..COEFFICIENTS).map(|term| inverse[(0, term)] * sides[(term, k)]).sum::<f64>();
    let shares: Vec<f64> = (0..terminals).map(share).collect();
    shares.iter().all(|share| share.is_finite()).then_some(shares)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadratic_shares_are_told_exactly_between_the_places() {
        let share = |[x, y]: [f64; 2]| 0.3 + 0.002 * x - 1e-5 * x * y + 1e-6 * y * y;
        let places: Vec<_> = (0..20 * 12)
            .map(|n| [f64::from(n % 20) * 20.0 - 190.0, f64::from(n / 20) * 20.0 - 110.0])
            .map(|at| (at, vec![share(at), 1.0 - share(at)]))
            .collect();
        let shares = of(&places).unwrap();
        assert!(shares.error < 1e-9, "{}", shares.error);
        let told = predicted(&shares, [33.0, -44.0], None).unwrap();
        // To the digits that are kept.
        assert!((told[0] - share([33.0, -44.0])).abs() < 1e-5 && told.len() == 2, "{told:?}");
        assert!(of(&places[..10]).is_none());
        let line: Vec<_> = places.iter().map(|([x, _], s)| ([*x, 2.0 * x], s.clone())).collect();
        assert!(of(&line).is_none());
    }
}
