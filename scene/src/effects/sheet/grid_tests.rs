// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finite differences against the exact solution, and terminals that are hard on a mesh.

use super::analytic::Analytic;
use super::film::Film;
use super::geometry::OPEN;
use super::grid::Grid;
use super::mesh::Correction;
use super::tests::{MARGIN_MM, TERMINALS_M, assert_near, difference, places, sheet, split_error};
use super::*;
use crate::format::parse;

/// The meshes that convergence is looked at, from coarse to fine, m.
const SPACINGS_M: [f64; 4] = [0.02, 0.01, 0.005, 0.0025];

fn errors(correction: Correction) -> [f64; 4] {
    SPACINGS_M.map(|spacing| {
        split_error(&Grid::corrected(&sheet(0.0), spacing, correction), MARGIN_MM)[0]
    })
}

/// Whether each error is clearly below the one of the mesh before.
fn converges(errors: [f64; 4]) -> bool {
    errors.windows(2).all(|pair| pair[1] < 0.7 * pair[0])
}

#[test]
fn halving_the_spacing_divides_the_error_by_four() {
    let errors = errors(Correction::Peaceman);
    // docs/physics.md §1 at 10 mm, where all terminals are nodes there too; with nodes at the
    // edges' middles 20 mm does better.
    assert_near("10 mm", &errors[1..2], &[6.9e-5], 1e-6);
    assert!(errors.windows(2).all(|pair| (3.3..5.0).contains(&(pair[0] / pair[1]))), "{errors:?}");
}

#[test]
fn terminals_that_are_nodes_do_not_converge_without_peacemans_resistance() {
    let errors = errors(Correction::None);
    assert!(!converges(errors) && errors[3] > 1e-2, "{errors:?}");
    assert!(converges(self::errors(Correction::Peaceman)));
}

#[test]
fn resistance_at_the_pad_is_right_to_a_fifth_of_an_ohm_in_the_mean() {
    let (grid, exact) = (Grid::new(&sheet(0.0), 0.01), Analytic::new(&sheet(0.0)));
    let off = places(MARGIN_MM)
        .into_iter()
        .map(|[x, y]| (grid.split(x, y).ohm - exact.split(x, y).ohm).abs());
    let [_, mean, most] = super::tests::range(off);
    assert!(mean < 0.2 && most < 4.0, "{mean} {most}");
}

/// Below 8.6 mm the mesh is finer than a terminal of 1.7 mm: Peaceman's resistance is negative, and
/// here so is the sum.
#[test]
fn a_terminal_wider_than_the_mesh_has_a_negative_resistance_and_is_still_right() {
    let wide = Sheet { terminal_radius_m: 4e-3, ..sheet(0.0) };
    let [rms, _] = difference(&Grid::new(&wide, 2.5e-3), &Analytic::new(&wide), MARGIN_MM);
    assert!(rms < 1e-5, "{rms:e}");
}

#[test]
fn open_and_shorted_terminals_split_as_the_exact_solution_says_and_sum_to_one() {
    for (ohm, shorted, open) in [(0.0, 0, 4), (500.0, 2, 5), (500.0, 5, 0)] {
        let mut sheet = sheet(ohm);
        sheet.terminal_ohm[shorted] = 0.0;
        sheet.terminal_ohm[open] = OPEN;
        let (grid, exact) = (Grid::new(&sheet, 5e-3), Analytic::new(&sheet));
        let [rms, _] = difference(&grid, &exact, MARGIN_MM);
        assert!(rms < 2e-5, "terminal {} shorted, {} open: {rms:e}", shorted + 1, open + 1);
        for [x, y] in places(15.0) {
            for split in [grid.split(x, y), exact.split(x, y)] {
                assert!(
                    (split.share.iter().sum::<f64>() - 1.0).abs() < 1e-9
                        && split.share[open].abs() < 1e-12
                );
            }
        }
    }
}

fn film(text: &str) -> Film {
    Film::read(&parse(text).unwrap(), [0.86, 0.5]).unwrap()
}

#[test]
fn a_film_that_resists_twice_as_much_everywhere_is_an_even_one() {
    let patch = film(
        "ohm_per_square = 150\n[[patch]]\ncentre_mm = [0, 0]\nsize_mm = [900, 600]\nohm_per_square = 300",
    );
    let patched = Grid::new(&Sheet { film: patch, ..sheet(0.0) }, 0.01);
    let uniform = Grid::new(&Sheet { film: Film::uniform(300.0), ..sheet(0.0) }, 0.01);
    assert!(difference(&patched, &uniform, MARGIN_MM)[1] < 1e-9);
    let [a, b] = [&patched, &uniform].map(|grid| grid.split(100.0, 50.0).ohm);
    assert!((a / b - 1.0).abs() < 0.01, "{a} {b}");
}

/// A film that resists more on the right sends more of the current to the left.
#[test]
fn a_sloping_film_shifts_the_split_and_converges_at_second_order() {
    let sloping =
        Sheet { film: film("ohm_per_square = 150\nslope_percent = [40, 0]"), ..sheet(0.0) };
    let fine = Grid::new(&sloping, 1.25e-3);
    let errors = [0.02, 0.01, 0.005]
        .map(|spacing| difference(&Grid::new(&sloping, spacing), &fine, MARGIN_MM)[0]);
    assert!(errors.windows(2).all(|pair| (3.2..5.5).contains(&(pair[0] / pair[1]))), "{errors:?}");
    let [left, right] = [-200.0, 200.0].map(|x| fine.split(x, 0.0).share);
    assert!(left[0] + left[1] > right[2] + right[3] + 0.01, "{left:?} {right:?}");
}

/// On a sheet as small as a telephone's, 10 mm are few cells: R_p's mesh is finer then.
#[test]
fn resistance_at_the_pad_is_right_on_small_sheets_too() {
    for size_m in [[0.13, 0.06], [0.1, 0.04], [0.05, 0.05]] {
        let to_corner = |place: [f64; 2]| {
            [0, 1].map(|axis| place[axis] / sheet(0.0).size_m[axis] * size_m[axis])
        };
        let small =
            Sheet { size_m, terminals_m: TERMINALS_M.map(to_corner).to_vec(), ..sheet(0.0) };
        let exact = Analytic::new(&small);
        for spacing in GRID_LEVELS.map(|level| level.1 * 1e-3) {
            let grid = Grid::new(&small, spacing);
            let reach = small.reach_mm();
            let places = (0..35).map(|n| [(n % 7) as f64 / 3.0 - 1.0, (n / 7) as f64 / 2.0 - 1.0]);
            let off = places.map(|[u, v]| {
                let (x, y) = (u * reach[0], v * reach[1]);
                (grid.split(x, y).ohm / exact.split(x, y).ohm - 1.0).abs()
            });
            let [_, mean, most] = super::tests::range(off);
            println!("{size_m:?} {spacing}: {mean:.4} {most:.4}");
            assert!(mean < 0.01 && most < 0.05, "{size_m:?} m, {spacing} m: {mean} {most}");
        }
    }
}
