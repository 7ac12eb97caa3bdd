// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sheets of three to sixteen terminals anywhere on the edge: balance, reciprocity, symmetry, and
//! all levels against the exact one.

use super::analytic::Analytic;
use super::grid::Grid;
use super::tests::{MARGIN_MM, assert_near, difference, places, sheet};
use super::*;

/// Terminals, m from the bottom left corner. Of an even number the corners come first, then places
/// along the long edges, mirrored in the sheet's middle. Three are the left corners and the right
/// edge's middle, five all corners and that middle.
fn terminals_m(count: usize) -> Vec<[f64; 2]> {
    let corners = [[0.0, 0.5], [0.0, 0.0], [0.86, 0.0], [0.86, 0.5]];
    let odd = |from: &[[f64; 2]]| from.iter().copied().chain([[0.86, 0.25]]).collect();
    let along = |count: usize| (0..count).map(move |n| 0.86 * (n + 1) as f64 / (count + 1) as f64);
    match count {
        3 => odd(&corners[..2]),
        5 => odd(&corners),
        even => {
            let long = (even - 4) / 2;
            corners.into_iter().chain(along(long).flat_map(|x| [[x, 0.0], [x, 0.5]])).collect()
        }
    }
}

fn sheet_of(count: usize, terminal_ohm: f64) -> Sheet {
    Sheet { terminals_m: terminals_m(count), terminal_ohm: vec![terminal_ohm; count], ..sheet(0.0) }
}

const COUNTS: [usize; 5] = [3, 4, 5, 8, 16];

#[test]
fn shares_of_any_number_of_terminals_sum_to_one_at_every_level() {
    for count in COUNTS {
        let sheet = sheet_of(count, 300.0);
        let mut levels: Vec<_> =
            UNIFORM_LEVELS.map(|(word, _)| exact_or_table(word, &sheet)).into();
        levels.push(grid(&sheet, 10.0));
        for (level, [x, y]) in levels
            .iter()
            .flat_map(|level| places(15.0).into_iter().step_by(7).map(move |at| (level, at)))
        {
            let split = level.split(x, y);
            assert_eq!(split.share.len(), count);
            assert_near("sum", &[split.share.iter().sum::<f64>()], &[1.0], 1e-9);
            assert!(
                split.ohm > 0.0 && split.share.iter().all(|share| *share > -1e-3),
                "{count}: {split:?}"
            );
        }
    }
}

#[test]
fn potentials_between_places_are_reciprocal_with_any_number_of_terminals() {
    for count in COUNTS {
        let exact = Analytic::new(&sheet_of(count, 50.0));
        let [a, b] = [[-310.0, 140.0], [95.0, -60.0]].map(|[x, y]| exact.source(x, y));
        assert_near("ohm", &[exact.between(&a, &b)], &[exact.between(&b, &a)], 1e-8);
    }
}

/// A pad mirrored in the sheet's middle has the mirrored terminals' shares.
#[test]
fn symmetric_sheets_have_symmetric_shares() {
    for count in [4, 8, 16] {
        let sheet = sheet_of(count, 0.0);
        let mirror = |[x, y]: [f64; 2]| {
            let there =
                |at: &[f64; 2]| (at[0] - 0.86 + x).abs() < 1e-9 && (at[1] - 0.5 + y).abs() < 1e-9;
            sheet.terminals_m.iter().position(there).unwrap()
        };
        let exact = Analytic::new(&sheet);
        for [x, y] in places(15.0).into_iter().step_by(11) {
            let (share, mirrored) = (exact.split(x, y).share, exact.split(-x, -y).share);
            let mirrored: Vec<f64> =
                sheet.terminals_m.iter().map(|at| mirrored[mirror(*at)]).collect();
            assert_near("mirrored", &share, &mirrored, 1e-9);
        }
    }
}

/// The terminals of 3, 4 and 5 are nodes of every mesh; of 8 and 16, most lie between nodes.
#[test]
fn tables_and_meshes_approach_the_exact_split_of_any_number_of_terminals() {
    for (count, limits) in COUNTS.into_iter().zip([
        [2e-6, 2e-5],
        [2e-6, 2e-5],
        [2e-6, 2e-5],
        [2e-6, 4e-5],
        [2e-6, 4e-5],
    ]) {
        let sheet = sheet_of(count, 0.0);
        let exact = Analytic::new(&sheet);
        let [table, mesh] = [
            difference(exact_or_table("bicubic", &sheet).as_ref(), &exact, MARGIN_MM)[0],
            difference(&Grid::new(&sheet, 5e-3), &exact, MARGIN_MM)[0],
        ];
        println!("{count}: {table:e} {mesh:e}");
        assert!(table < limits[0] && mesh < limits[1], "{count}: table {table:e}, mesh {mesh:e}");
    }
}
