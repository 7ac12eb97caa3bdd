// SPDX-License-Identifier: MIT OR Apache-2.0
//! Identities that hold on any sheet, over random devices of three to sixteen terminals anywhere
//! along the edge.

use std::fmt::Write;

use rand_distr::{Distribution, Uniform};

use super::analytic::Analytic;
use super::*;
use crate::format::parse;
use crate::plant::Plant;
use crate::random::{Purpose, Stream, stream};
use crate::scene::Scene;
use crate::terminals::{LEAST_TERMINALS, MOST_TERMINALS};
use crate::timing::Timing;

/// Devices of each number of terminals, and places of a pad on each.
const DEVICES: u64 = 8;
const PLACES: usize = 12;

fn within(random: &mut Stream, low: f64, high: f64) -> f64 {
    Uniform::new(low, high).unwrap().sample(random)
}

/// A place anywhere along the edge of a sheet of half this size.
fn on_edge(random: &mut Stream, [x, y]: [f64; 2]) -> [f64; 2] {
    let along = within(random, -1.0, 1.0);
    match within(random, 0.0, 4.0) as usize {
        0 => [along * x, y],
        1 => [along * x, -y],
        2 => [x, along * y],
        _ => [-x, along * y],
    }
}

/// A device: 120 to 1500 mm long, films of 20 to 500 Ω/sq, up to 2 kΩ in series with each terminal.
struct Drawn {
    scene: String,
    places_mm: Vec<[f64; 2]>,
}

impl Drawn {
    fn new(terminals: usize, number: u64) -> Drawn {
        let mut random = stream(number, [terminals as u64, 0], Purpose::Offset);
        let width = within(&mut random, 120.0, 1500.0);
        let size = [width, width / within(&mut random, 1.0, 2.5)];
        let half = size.map(|size| size / 2.0);
        let mut at: Vec<[f64; 2]> = Vec::new();
        while at.len() < terminals {
            let place = on_edge(&mut random, half);
            // Terminals are patches of 1.7 mm radius: they do not overlap.
            if at.iter().all(|other| (other[0] - place[0]).hypot(other[1] - place[1]) > 5.0) {
                at.push(place);
            }
        }
        let ohm: Vec<f64> = (0..terminals).map(|_| within(&mut random, 0.0, 2000.0)).collect();
        let mut scene = format!(
            "title = \"{terminals} terminals\"\n[device]\nwidth_mm = {}\nheight_mm = {}\n",
            size[0], size[1]
        );
        let film = within(&mut random, 20.0, 500.0);
        write!(
            scene,
            "[sheet]\nrung = \"analytic\"\nterminals_mm = {at:?}\nterminal_ohm = {ohm:?}\nohm_per_square = {film}\n"
        )
        .unwrap();
        let reach = half.map(|half| half - 15.0);
        let place = |_| reach.map(|reach| within(&mut random, -reach, reach));
        Drawn { scene, places_mm: (0..PLACES).map(place).collect() }
    }

    fn sheet(&self) -> Sheet {
        let root = parse(&self.scene).unwrap();
        let device = Device::read(&root).unwrap();
        Sheet::read(root.table("sheet").unwrap().unwrap(), &device).unwrap()
    }

    /// A plant with pads at the first of the places, of different capacitances, and what else is
    /// on.
    fn plant(&self, pads: usize, more: &str) -> Plant {
        let mut scene = self.scene.clone() + more;
        for (n, place) in self.places_mm.iter().take(pads).enumerate() {
            write!(scene, "[[pad]]\nposition_mm = {place:?}\ncapacitance_pf = {}\n", 318 + 200 * n)
                .unwrap();
        }
        let timing = Timing {
            pads,
            slot_samples: 200,
            window_start: 0,
            window_samples: 200,
            samples_per_period: 10.0,
            signs: None,
        };
        Plant::new(&Scene::parse(&scene, "s.toml", &[]).unwrap(), 0, &timing)
            .unwrap_or_else(|error| panic!("{error}"))
    }
}

fn drawn() -> impl Iterator<Item = (usize, Drawn)> {
    (LEAST_TERMINALS..=MOST_TERMINALS).flat_map(|terminals| {
        (0..DEVICES).map(move |number| (terminals, Drawn::new(terminals, number)))
    })
}

/// Kirchhoff: the terminals' currents are the pad's, jωC/(1 + jωC·R_p) of a volt, and no terminal
/// feeds current in.
#[test]
fn currents_of_all_terminals_sum_to_the_pads() {
    for (terminals, device) in drawn() {
        let plant = device.plant(1, "");
        let capacitive = Complex64::new(0.0, plant.device().carrier_rad_s * 318e-12);
        for measurement in plant.measurements(&device.places_mm) {
            assert_eq!(measurement.siemens.len(), terminals);
            let total: Complex64 = measurement.siemens.iter().sum();
            let expected = capacitive / (capacitive * measurement.sheet_ohm + 1.0);
            assert!(
                (total / expected - 1.0).norm() < 1e-9,
                "{}: {total} for {expected}",
                device.scene
            );
            let shares: Vec<Complex64> =
                measurement.siemens.iter().map(|siemens| siemens / total).collect();
            assert!(
                shares.iter().all(|share| share.re > -1e-9 && share.im.abs() < 1e-9),
                "{}: {shares:?}",
                device.scene
            );
            assert!(measurement.sheet_ohm > 0.0);
        }
    }
}

/// Ratios are weighted means of signs, at every place of a calibration.
#[test]
fn ratios_lie_within_one_and_shares_are_of_one() {
    for (terminals, device) in drawn() {
        for point in device.plant(1, "").calibration_map(9, 7, 15.0) {
            assert!(
                point.r_x.abs() <= 1.0 && point.r_y.abs() <= 1.0,
                "{}: {point:?}",
                device.scene
            );
            assert_eq!(point.shares.len(), terminals);
            assert!(
                point.shares.iter().sum::<f64>() > 1.0 - 1e-9,
                "those without a sign come on top: {point:?}"
            );
        }
    }
}

/// What a current into one place lifts another by is the same the other way round, though neither
/// formula is symmetric.
#[test]
fn potentials_between_two_places_are_reciprocal() {
    for (_, device) in drawn() {
        let exact = Analytic::new(&device.sheet());
        let sources: Vec<_> = device.places_mm.iter().map(|[x, y]| exact.source(*x, *y)).collect();
        for pair in sources.windows(2) {
            let [there, back] =
                [exact.between(&pair[0], &pair[1]), exact.between(&pair[1], &pair[0])];
            assert!(
                (there - back).abs() < 1e-9 * exact.between(&pair[0], &pair[0]),
                "{}: {there} and {back}",
                device.scene
            );
        }
    }
}

/// Two coupled pads, 1 V on the selected one: Z·I = V has one Z_12 that explains what the terminals
/// get in both slots.
#[test]
fn two_coupled_pads_are_a_reciprocal_two_port() {
    for (terminals, device) in drawn() {
        let mut plant = device.plant(2, "[coupling]\n");
        let of = plant.device();
        let scale = of.current_full_scale_a / of.carrier_v;
        let mut slot = |slot: usize| {
            let mut phasors = vec![Complex64::ZERO; terminals + 1];
            plant.phasors(slot, &mut phasors);
            let truth = plant.truth(slot);
            let own = 1.0 / Complex64::new(0.0, of.carrier_rad_s * truth.capacitance_pf * 1e-12)
                + truth.sheet_ohm;
            (own, phasors[..terminals].iter().sum::<Complex64>() * scale, truth.touching)
        };
        let ((a, sum_a, touching), (b, sum_b, _)) = (slot(0), slot(1));
        if touching {
            continue; // pads that overlap are moved apart, each as the other is selected
        }
        let mutual = (b * sum_b - a * sum_a) / (sum_b - sum_a);
        let off = (sum_a * (a * b - mutual * mutual) - (b - mutual)).norm() / b.norm();
        assert!(off < 1e-7, "{}: {off:e}", device.scene);
    }
}
