// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sheet against the check values of PHYSICS §1.

use super::analytic::Analytic;
use super::*;

fn sheet(terminal_ohm: f64, terminal_radius_mm: f64) -> Sheet {
    Sheet {
        size_m: [0.86, 0.5],
        pad_radius_m: 0.015,
        ohm_per_square: 150.0,
        terminal_ohm,
        terminal_radius_m: terminal_radius_mm * 1e-3,
        terminals_m: terminals([0.86, 0.5]),
        table: [128, 75],
    }
}

/// Least squares of x and y on monomials of (r_x, r_y) up to a degree: rms and max of the distance, mm.
fn fit(points: &[([f64; 2], [f64; 2])], degree: i32) -> (f64, f64) {
    let basis = |r: &[f64; 2]| -> Vec<f64> {
        (0..=degree)
            .flat_map(|p| (0..=degree - p).map(move |q| (p, q)))
            .map(|(p, q)| r[0].powi(p) * r[1].powi(q))
            .collect()
    };
    // modified Gram-Schmidt on the columns
    let rows: Vec<Vec<f64>> = points.iter().map(|(r, _)| basis(r)).collect();
    let n = rows[0].len();
    let mut columns: Vec<Vec<f64>> = (0..n).map(|c| rows.iter().map(|row| row[c]).collect()).collect();
    let mut left: Vec<Vec<f64>> = (0..2).map(|axis| points.iter().map(|(_, x)| x[axis]).collect()).collect();
    for c in 0..n {
        let pivot = columns[c].clone();
        let norm: f64 = pivot.iter().map(|v| v * v).sum();
        for other in columns[c + 1..].iter_mut().chain(left.iter_mut()) {
            let factor = pivot.iter().zip(other.iter()).map(|(a, b)| a * b).sum::<f64>() / norm;
            other.iter_mut().zip(&pivot).for_each(|(v, p)| *v -= factor * p);
        }
    }
    let distances: Vec<f64> = left[0].iter().zip(&left[1]).map(|(x, y)| x.hypot(*y)).collect();
    let rms = (distances.iter().map(|d| d * d).sum::<f64>() / distances.len() as f64).sqrt();
    (rms, distances.iter().fold(0.0, |a, b| a.max(*b)))
}

#[test]
fn scan() {
    for margin in [0.01, 5.0, 10.0, 15.0, 20.0, 30.0] {
        for radius in [1.0, 1.7, 2.5, 3.0, 5.0, 10.0] {
            let exact = Analytic::new(&sheet(0.0, radius));
            let n = 81;
            let m = 47;
            let (mut lo, mut hi, mut sum) = (1e9f64, 0f64, 0.0);
            let (mut clo, mut chi) = (1e9f64, 0f64);
            let mut rmax = 0f64;
            let mut points = Vec::new();
            for i in 0..n {
                for j in 0..m {
                    let (x, y) = (
                        (430.0 - margin) * (2.0 * i as f64 / (n - 1) as f64 - 1.0),
                        (250.0 - margin) * (2.0 * j as f64 / (m - 1) as f64 - 1.0),
                    );
                    let s = exact.split(x, y);
                    lo = lo.min(s.ohm);
                    hi = hi.max(s.ohm);
                    sum += s.ohm;
                    let c: f64 = s.share[..4].iter().sum();
                    clo = clo.min(c);
                    chi = chi.max(c);
                    let w = s.share;
                    let r = [(w[2] + w[3] - w[0] - w[1]) / c, (w[0] + w[3] - w[1] - w[2]) / c];
                    rmax = rmax.max(r[0]);
                    points.push((r, [x, y]));
                }
            }
            println!(
                "margin {margin} radius {radius}: {lo:.1} {hi:.1} mean {:.1} corner {clo:.3} {chi:.3} rx {rmax:.3} fits {:.1?} {:.1?} {:.1?} {:.1?}",
                sum / (n * m) as f64,
                fit(&points, 1),
                fit(&points, 3),
                fit(&points, 5),
                fit(&points, 7)
            );
        }
    }
}
