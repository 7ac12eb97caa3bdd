// SPDX-License-Identifier: MIT OR Apache-2.0
//! The best affine fit of the true position on the ratios: what position would be without a map.

use crate::record::Row;

/// How far the fit is from the truth, row by row.
pub fn distances<'a>(rows: &'a [&'a Row]) -> impl Iterator<Item = f64> + 'a {
    let [x, y] = [0, 1].map(|axis| fit(rows, axis));
    rows.iter().map(move |row| {
        let terms = terms(row);
        let off = |weights: &[f64; 3], axis| dot(weights, &terms) - place(row)[axis];
        off(&x, 0).hypot(off(&y, 1))
    })
}

/// What the position along `axis` is made of.
fn fit(rows: &[&Row], axis: usize) -> [f64; 3] {
    let mut normal = [[0.0; 4]; 3];
    for row in rows {
        let terms = terms(row);
        for (equation, term) in normal.iter_mut().zip(terms) {
            equation
                .iter_mut()
                .zip(terms.into_iter().chain([place(row)[axis]]))
                .for_each(|(sum, t)| *sum += term * t);
        }
    }
    solve(normal)
}

/// Gauss–Jordan elimination with pivoting; what is not determined is zero.
fn solve(mut rows: [[f64; 4]; 3]) -> [f64; 3] {
    for column in 0..3 {
        let pivot =
            (column..3).max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs()));
        rows.swap(column, pivot.expect("a range that is not empty"));
        let pivot = rows[column];
        if pivot[column].abs() < 1e-12 {
            rows[column][3] = 0.0;
            continue;
        }
        rows[column] = pivot.map(|entry| entry / pivot[column]);
        for other in (0..3).filter(|other| *other != column) {
            let factor = rows[other][column];
            rows[other] = std::array::from_fn(|k| rows[other][k] - factor * rows[column][k]);
        }
    }
    rows.map(|row| row[3])
}

fn terms(row: &Row) -> [f64; 3] {
    [1.0, row.measured.r_x, row.measured.r_y]
}

fn place(row: &Row) -> [f64; 2] {
    row.truth.map_or([f64::NAN; 2], |truth| [truth.quantities.x_mm, truth.quantities.y_mm])
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
