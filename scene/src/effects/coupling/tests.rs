// SPDX-License-Identifier: MIT OR Apache-2.0
//! Coupling against the check values of docs/physics.md §1.

use rand_distr::{Distribution, Uniform};

use super::*;
use crate::effects::sheet::Solver;
use crate::effects::sheet::tests::sheet;
use crate::pad::resting;
use crate::random::{Purpose, stream};
use crate::ratios::Ratios;

pub(crate) fn device() -> Device {
    Device::read(&crate::format::parse("").unwrap()).unwrap()
}

/// A pad that the sheet alone has acted on.
fn pad(exact: &Analytic, [x, y]: [f64; 2], capacitance_f: f64) -> Pad {
    let split = exact.split(x, y);
    Pad {
        capacitance_f,
        split: split.share.map(Complex64::from),
        sheet_ohm: split.ohm.into(),
        ..resting([x, y], 20.0, 0.0, &device())
    }
}

fn coupling(once: bool) -> Coupling {
    let field = OfSheet::new(sheet(0.0), |sheet| field(sheet, None));
    Coupling { field: Following::new(&field), once, device: device() }
}

/// Four places at random, their centres so far off the edges, none touching another.
pub(crate) fn placements(count: usize, margin_mm: f64) -> Vec<[[f64; 2]; 4]> {
    let mut random = stream(1, [0, 0], Purpose::Offset);
    let [x, y] = [
        Uniform::new(margin_mm - 430.0, 430.0 - margin_mm).unwrap(),
        Uniform::new(margin_mm - 250.0, 250.0 - margin_mm).unwrap(),
    ];
    let mut placements = Vec::new();
    while placements.len() < count {
        let places: [[f64; 2]; 4] =
            std::array::from_fn(|_| [x.sample(&mut random), y.sample(&mut random)]);
        let near = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) < 30.0;
        if (0..4).all(|k| (0..k).all(|l| !near(&places[k], &places[l]))) {
            placements.push(places);
        }
    }
    placements
}

/// The paper's ratios, of the corners' currents.
fn eqs_2_and_3() -> Ratios {
    Ratios::new([vec![-1, -1, 1, 1, 0, 0], vec![1, -1, -1, 1, 0, 0]])
}

/// Where an isolated pad would read these ratios: Newton's steps on the exact map.
pub(crate) fn place_of(
    exact: &impl Solver,
    ratios: &Ratios,
    [r_x, r_y]: [f64; 2],
    from: [f64; 2],
) -> [f64; 2] {
    let read = |[x, y]: [f64; 2]| {
        let [a, b] = ratios.of_amplitudes(&exact.split(x, y).share);
        [a - r_x, b - r_y]
    };
    let mut at = from;
    for _ in 0..20 {
        let here = read(at);
        let columns = [0, 1].map(|axis| {
            let mut moved = at;
            moved[axis] += 1e-3;
            let there = read(moved);
            [0, 1].map(|n| (there[n] - here[n]) / 1e-3)
        });
        let det = columns[0][0] * columns[1][1] - columns[0][1] * columns[1][0];
        let step = [
            (here[0] * columns[1][1] - here[1] * columns[1][0]) / det,
            (columns[0][0] * here[1] - columns[0][1] * here[0]) / det,
        ];
        let reach = device().reach_mm();
        at = [0, 1]
            .map(|axis| (at[axis] - step[axis].clamp(-5.0, 5.0)).clamp(-reach[axis], reach[axis]));
    }
    at
}

/// Mean, 95th percentile and greatest shift of the first of four pads, mm; least and greatest
/// change of its force by the amplitude of the sum, percent.
fn shifts(picofarad: f64, margin_mm: f64) -> ([f64; 3], [f64; 2]) {
    let exact = Analytic::new(&sheet(0.0));
    let ratios = eqs_2_and_3();
    let (mut shifts, mut forces) = (Vec::new(), Vec::new());
    for places in placements(500, margin_mm) {
        let [mut first, others @ ..] = places.map(|place| pad(&exact, place, picofarad * 1e-12));
        coupling(false).act(&mut first, &others);
        let read = place_of(&exact, &ratios, ratios.of_amplitudes(&first.amplitudes()), places[0]);
        shifts.push((read[0] - places[0][0]).hypot(read[1] - places[0][1]));
        let total: Complex64 = first.transfer.unwrap().iter().sum();
        let alone = first.admittance(device().carrier_rad_s).norm();
        forces.push(100.0 * ((total.norm() / alone).powi(2) - 1.0));
    }
    shifts.sort_by(f64::total_cmp);
    let mean = shifts.iter().sum::<f64>() / shifts.len() as f64;
    let force = [f64::INFINITY, f64::NEG_INFINITY];
    let force = forces.iter().fold(force, |[low, high], f| [low.min(*f), high.max(*f)]);
    ([mean, shifts[shifts.len() * 95 / 100], shifts[shifts.len() - 1]], force)
}

/// docs/physics.md §1: the prototype's pad positions are not known; 50 mm off the edges gives its
/// figures, found by trying margins; the limits were set after that.
#[test]
fn four_pads_shift_a_position_as_physics_says() {
    let near = |got: [f64; 3], expected: [f64; 3]| {
        let off: [f64; 3] = std::array::from_fn(|n| (got[n] / expected[n] - 1.0).abs());
        assert!(off[0] < 0.1 && off[1] < 0.1 && off[2] < 0.25, "{got:?}"); // the greatest depends on the draw
    };
    near(shifts(318.0, 50.0).0, [0.23, 0.59, 1.0]);
    let (at_760_pf, [low, high]) = shifts(760.0, 50.0);
    near(at_760_pf, [1.2, 3.3, 6.4]);
    assert!((low + 3.1).abs() < 0.5 && (high + 0.9).abs() < 0.1, "force {low} to {high} %");
}

/// The prototype has 6.4 mm, the paper's authors "a few millimeters" (docs/physics.md §1); 11.5 mm
/// was measured before the limits were set.
#[test]
fn up_to_the_edges_a_position_shifts_by_a_centimetre() {
    let [_, _, most] = shifts(760.0, 20.0).0;
    assert!(most > 10.0 && most < 13.0, "{most} mm");
}

#[test]
fn a_pad_alone_is_not_coupled() {
    let exact = Analytic::new(&sheet(0.0));
    let isolated = pad(&exact, [120.0, -60.0], 318e-12);
    let mut coupled = isolated.clone();
    coupling(false).act(&mut coupled, &[]);
    let pairs = coupled.transfer.unwrap().into_iter().zip(isolated.transfer(&device()));
    assert!(pairs.into_iter().all(|(a, b)| (a - b).norm() < 1e-15 * a.norm().max(1e-6)));
}

#[test]
fn answering_once_errs_in_second_order_of_the_capacitance() {
    let exact = Analytic::new(&sheet(0.0));
    let error = |farad: f64| {
        let places = [[100.0, 50.0], [-50.0, 100.0], [200.0, -80.0], [30.0, -10.0]];
        let [first, others @ ..] = places.map(|place| pad(&exact, place, farad));
        let [once, full] = [true, false].map(|once| {
            let mut pad = first.clone();
            coupling(once).act(&mut pad, &others);
            pad.transfer.unwrap()
        });
        let sum = full.iter().sum::<Complex64>().norm();
        once.iter().zip(full).map(|(a, b)| (a - b).norm() / sum).fold(0.0, f64::max)
    };
    let ratio = error(100e-12) / error(50e-12);
    assert!((3.8..4.2).contains(&ratio), "{ratio}");
}

#[test]
fn potentials_are_reciprocal_and_a_mesh_has_them_too() {
    let places = [[100.0, 50.0], [-300.0, 150.0], [200.0, -80.0]];
    let exact = Analytic::new(&sheet(0.0));
    let mesh = Network::new(&sheet(0.0), Mesh::new([0.86, 0.5], 5e-3), Correction::Peaceman);
    let [a, b] = [100.0, -250.0].map(|x| exact.source(x, 40.0));
    assert!((exact.between(&a, &b) - exact.between(&b, &a)).abs() < 1e-9);
    let [solved, meshed] = [Field::ohm(&exact, &places), Field::ohm(&mesh, &places)];
    for (k, l) in [(0, 1), (0, 2), (1, 2)] {
        assert!(
            (solved[k][l] - meshed[k][l]).norm() < 2e-3 * solved[k][l].norm(),
            "{solved:?} {meshed:?}"
        );
    }
}

#[test]
fn pads_that_touch_or_lie_on_each_other_are_flagged_and_finite() {
    let exact = Analytic::new(&sheet(0.0));
    for (distance, touching) in [(30.0, false), (29.0, true), (1e-9, true), (0.0, true)] {
        let [mut first, second] = [0.0, distance].map(|x| pad(&exact, [x, 20.0], 760e-12));
        coupling(false).act(&mut first, &[second]);
        assert_eq!(first.touching, touching, "{distance} mm");
        let total: Complex64 = first.transfer.unwrap().iter().sum();
        assert!(
            (0.8..1.0).contains(&(total.norm() / first.admittance(device().carrier_rad_s).norm())),
            "{total}"
        );
    }
}
