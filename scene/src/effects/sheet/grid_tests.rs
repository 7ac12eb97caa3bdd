// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finite differences against the exact solution, and terminals that are hard on a mesh.

use super::analytic::Analytic;
use super::film::Film;
use super::geometry::OPEN;
use super::grid::Grid;
use super::mesh::Mesh;
use super::network::{Correction, Network};
use super::own::Solved;
use super::stripes::Stripes;
use super::tests::{MARGIN_MM, TERMINALS_M, assert_near, difference, places, sheet, split_error};
use super::*;
use crate::format::parse;

/// Spacings of the meshes whose convergence is tested, from coarse to fine, m.
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

/// Terminals 5 and 6 between nodes, and nearer to a corner and its terminal than a node: as good as
/// on nodes.
#[test]
fn terminals_between_nodes_converge_as_those_on_nodes_do() {
    for from_left_m in [0.2153, 0.0123, 0.004] {
        let mut sheet = sheet(0.0);
        (sheet.terminals_m[4][0], sheet.terminals_m[5][0]) = (from_left_m, 0.86 - from_left_m);
        let exact = Analytic::new(&sheet);
        let errors =
            SPACINGS_M.map(|spacing| difference(&Grid::new(&sheet, spacing), &exact, MARGIN_MM)[0]);
        println!("{from_left_m} m: {errors:?}");
        assert!(
            errors.windows(2).all(|pair| (3.0..7.5).contains(&(pair[0] / pair[1]))),
            "{from_left_m} m: {errors:?}"
        );
        assert!(errors[3] < 5e-6, "{from_left_m} m: {errors:?}");
    }
}

/// Pads that touch the edges, in front of terminals and in corners, and pads away from them.
#[test]
fn halving_the_spacing_divides_the_error_of_r_p_by_four_at_edges_and_corners_too() {
    let exact = Analytic::new(&sheet(0.0));
    let along = |n: usize, of: usize, reach: f64| reach * (2.0 * n as f64 / of as f64 - 1.0);
    let long = (0..=40).flat_map(|n| [-235.0, 235.0].map(|y| [along(n, 40, 415.0), y]));
    let short = (0..=30).flat_map(|n| [-415.0, 415.0].map(|x| [x, along(n, 30, 235.0)]));
    let edges: Vec<_> = long.chain(short).collect();
    let inside: Vec<_> =
        (0..63).map(|n| [along(n % 9, 8, 360.0), along(n / 9, 6, 200.0)]).collect();
    for (name, places, at_2_5_mm) in [("edges", edges, 1.2e-4), ("inside", inside, 1.2e-5)] {
        let ohm = |level: &dyn Solver| -> Vec<f64> {
            places.iter().map(|[x, y]| level.split(*x, *y).ohm).collect()
        };
        let expected = ohm(&exact);
        let errors = SPACINGS_M
            .map(|spacing| relative_rms(&ohm(&Grid::new(&sheet(0.0), spacing)), &expected));
        println!("{name}: {errors:?}");
        assert!(
            errors.windows(2).all(|pair| (2.4..6.0).contains(&(pair[0] / pair[1]))),
            "{name}: {errors:?}"
        );
        assert!(errors[0] / errors[3] > 35.0 && errors[3] < at_2_5_mm, "{name}: {errors:?}");
    }
}

/// Whether errors over [`SPACINGS_M`] stay below a multiple of what the first one becomes with the
/// square of the spacing. Where a patch ends between two nodes matters as much as the spacing does,
/// so that no two meshes compare.
fn second_order(errors: [f64; 4], slack: f64) -> bool {
    (0..4).all(|n| errors[n] <= slack * errors[0] / f64::powi(4.0, n as i32))
}

/// A stripe of ten times the resistance across the sheet, whose edges are no nodes.
fn striped() -> Sheet {
    let text = "ohm_per_square = 150\n[[patch]]\ncentre_mm = [131.3, 0]\nsize_mm = [120, 600]\n\
                ohm_per_square = 1500";
    Sheet { film: film(text), ..sheet(0.0) }
}

/// R_p as it is solved for at places, before it is looked up between them.
fn solved(sheet: &Sheet, spacing_m: f64, places_mm: &[[f64; 2]]) -> Vec<f64> {
    let mesh = Mesh::new(sheet.size_m, spacing_m);
    let network = Network::new(sheet, mesh, Correction::Peaceman);
    let mut solved = Solved::new(sheet, &network);
    places_mm.iter().map(|[x, y]| solved.ohm(sheet.place_m(*x, *y))).collect()
}

fn relative_rms(got: &[f64], expected: &[f64]) -> f64 {
    let squares = got.iter().zip(expected).map(|(got, expected)| (got / expected - 1.0).powi(2));
    (squares.sum::<f64>() / got.len() as f64).sqrt()
}

/// R_p and the shares of pads in the stripe and beside it, against the exact solution.
#[test]
fn a_tenfold_stripe_converges_at_second_order_to_its_exact_solution() {
    let sheet = striped();
    let exact = Stripes::new(&sheet, vec![(0.5013, 150.0), (0.6213, 1500.0), (0.86, 150.0)]);
    let clear = |x: f64| [71.3, 191.3].into_iter().all(|edge: f64| (x - edge).abs() > 15.0);
    let places: Vec<_> =
        (0..60).map(|n| [52.0 + 4.0 * f64::from(n), 31.0]).filter(|[x, _]| clear(*x)).collect();
    let expected: Vec<Split> = places.iter().map(|[x, y]| exact.split(*x, *y)).collect();
    let ohm: Vec<f64> = expected.iter().map(|split| split.ohm).collect();
    let errors = SPACINGS_M.map(|spacing| relative_rms(&solved(&sheet, spacing, &places), &ohm));
    println!("R_p {errors:?}");
    assert!(second_order(errors, 1.3) && errors[3] < 2e-4, "{errors:?}");
    let grids = SPACINGS_M.map(|spacing| Grid::new(&sheet, spacing));
    let looked_up = grids.each_ref().map(|grid| {
        let got: Vec<f64> = places.iter().map(|[x, y]| grid.split(*x, *y).ohm).collect();
        relative_rms(&got, &ohm)
    });
    println!("looked up {looked_up:?}"); // what a cubic leaves between the places is in it
    assert!(looked_up[1] < 4e-3 && looked_up[3] < 5e-4, "{looked_up:?}");
    let shares = grids.each_ref().map(|grid| {
        let off = |(place, expected): (&[f64; 2], &Split)| {
            let share = grid.split(place[0], place[1]).share;
            let pairs = share.into_iter().zip(expected.share);
            pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        places.iter().zip(&expected).map(off).fold(0.0, f64::max)
    });
    println!("shares {shares:?}");
    assert!(second_order(shares, 1.5) && shares[3] < 5e-4, "{shares:?}");
}

/// Pads that lie partly on the stripe, against a finer mesh.
#[test]
fn pads_on_the_edge_of_a_stripe_converge_at_second_order() {
    let sheet = striped();
    let places: Vec<[f64; 2]> = (0..8).map(|n| [177.5 + 4.0 * f64::from(n), 31.0]).collect();
    let fine = solved(&sheet, 1.25e-3, &places);
    let errors = SPACINGS_M.map(|spacing| relative_rms(&solved(&sheet, spacing, &places), &fine));
    println!("{errors:?}");
    assert!(second_order(errors, 1.5) && errors[3] < 5e-4, "{errors:?}");
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
            assert!(mean < 0.004 && most < 0.03, "{size_m:?} m, {spacing} m: {mean} {most}");
        }
    }
}
