// SPDX-License-Identifier: MIT OR Apache-2.0
//! Four pads of 760 pF, measured by an ideal core that is calibrated on its device, their crosstalk
//! cancelled by a host that knows the nominal sheet and that calibration.

use std::sync::Mutex;

use hapticore_host::CrosstalkCanceller;

use super::*;
use crate::effects::coupling::tests::{place_of, placements};
use crate::effects::sheet::{Solver, Split};
use crate::plant::Plant;
use crate::scene::Scene;
use crate::timing::Timing;

/// With the paper's ratios, eqs. 2 and 3: the shifts that are cancelled are those of
/// docs/physics.md §1.
fn timing() -> Timing {
    let signs = Some([vec![-1, -1, 1, 1, 0, 0], vec![1, -1, -1, 1, 0, 0]]);
    Timing {
        pads: 4,
        slot_samples: 200,
        window_start: 0,
        window_samples: 200,
        samples_per_period: 10.0,
        signs,
    }
}

/// The raster of the calibration.
const COLUMNS: usize = 121;
const ROWS: usize = 71;

const NOMINAL: &str = "[sheet]\nrung = \"analytic\"\n";

/// The pads' capacitance.
const PICOFARAD: f64 = 760.0;

fn plant(places: &[[f64; 2]], sheet: &str) -> Plant {
    let pad = |[x, y]: &[f64; 2]| {
        format!("[[pad]]\nposition_mm = [{x}, {y}]\ncapacitance_pf = {PICOFARAD}\n")
    };
    let pads: String = places.iter().map(pad).collect();
    let text = format!("title = \"t\"\nuncouple = true\n{pads}{sheet}[coupling]\n");
    Plant::new(&Scene::parse(&text, "s.toml", &[]).unwrap(), 0, &timing()).unwrap()
}

fn at([x_mm, y_mm]: [f64; 2]) -> PadEstimate {
    PadEstimate { x_mm, y_mm, capacitance_pf: PICOFARAD }
}

fn without<T: Copy>(all: &[T], one: usize) -> Vec<T> {
    (0..all.len()).filter(|n| *n != one).map(|n| all[n]).collect()
}

/// The device as it is, which only its calibration knows.
struct Exact(Mutex<NominalSheet>);

impl Exact {
    fn of(plant: &Plant) -> Exact {
        let (effects, device, ratios) = (plant.fresh_effects(), plant.device(), plant.ratios());
        Exact(Mutex::new(NominalSheet { effects, device, ratios }))
    }

    /// What the core reads of each pad: where an isolated one has its ratios, and the capacitance
    /// by the sum's amplitude.
    fn read(&self, plant: &mut Plant, places: &[[f64; 2]]) -> Vec<(PadEstimate, [f64; 2])> {
        let pads: Vec<_> = places.iter().map(|place| at(*place)).collect();
        let one = |slot: usize| {
            let truth = plant.truth(slot);
            let place = place_of(self, &plant.ratios(), [truth.r_x, truth.r_y], places[slot]);
            let mut exact = self.0.lock().unwrap();
            let share = exact.with_neighbours(&pads[slot], &without(&pads, slot)).1
                / exact.with_neighbours(&pads[slot], &[]).1;
            (PadEstimate { capacitance_pf: PICOFARAD * share, ..at(place) }, [truth.r_x, truth.r_y])
        };
        (0..places.len()).map(one).collect()
    }
}

impl Solver for Exact {
    fn split(&self, x_mm: f64, y_mm: f64) -> Split {
        let mut exact = self.0.lock().unwrap();
        let mut pad = pad_of_frame([x_mm, y_mm], PICOFARAD, &exact.device);
        exact.effects.on_resting_pad(&mut pad);
        Split { share: pad.split.map(|share| share.re), ohm: pad.sheet_ohm.re }
    }
}

/// The farthest that a place is off as read and as freed, mm, and how far off the freed capacitance
/// is at most.
fn off(sheet: &str, count: usize) -> [f64; 3] {
    let isolated = plant(&[[0.0, 0.0]], sheet);
    let exact = Exact::of(&isolated);
    let nominal = plant(&[[0.0, 0.0]], NOMINAL).nominal_sheet().unwrap();
    let calibration = isolated.calibration_map(COLUMNS, ROWS, 15.0);
    let places = calibration
        .iter()
        .map(|point| [point.x_mm, point.y_mm, point.r_x, point.r_y, point.sheet_ohm]);
    let mut host = CrosstalkCanceller::with_map(nominal, COLUMNS, &places.collect::<Vec<_>>());
    let mut worst = [0.0f64; 3];
    for places in placements(count, 20.0) {
        let read = exact.read(&mut plant(&places, sheet), &places);
        let mut known: Vec<_> = read.iter().map(|(pad, _)| *pad).collect();
        for pad in (0..12).map(|slot| slot % 4) {
            known[pad] = host.cancel(read[pad].0, read[pad].1, &without(&known, pad));
        }
        for (((read, _), known), [x, y]) in read.iter().zip(&known).zip(places) {
            let far = |pad: &PadEstimate| (pad.x_mm - x).hypot(pad.y_mm - y);
            let now = [far(read), far(known), (known.capacitance_pf / PICOFARAD - 1.0).abs()];
            worst = [0, 1, 2].map(|n| worst[n].max(now[n]));
        }
    }
    worst
}

#[test]
fn a_centimetre_of_shift_among_four_pads_of_760_pf_is_taken_out_to_a_millimetre() {
    let [raw, left, capacitance] = off(NOMINAL, 300);
    assert!(
        raw > 10.0 && left < 1.0 && capacitance < 1e-3,
        "{raw} mm, {left} mm left, {capacitance}"
    );
}

/// The host's sheet is not the device's: meshed instead of exact, other terminals, a film that
/// resists more, or is not even. A film with 20 % from left to right leaves 1.05 mm in a corner.
#[test]
fn a_sheet_that_is_not_the_nominal_one_leaves_less_than_a_millimetre_too() {
    for (sheet, count) in [
        ("rung = \"grid-5-mm\"", 40),
        ("terminal_radius_mm = 3", 100),
        ("terminal_ohm = 20", 100),
        ("ohm_per_square = 165", 100),
        ("slope_percent = [10, 5]\nrung = \"grid-10-mm\"", 40),
    ] {
        let [raw, left, capacitance] = off(&format!("[sheet]\n{sheet}\n"), count);
        println!(
            "{sheet:?}: {raw:.1} mm, {left:.3} mm left, capacitance {:.3} %",
            100.0 * capacitance
        );
        assert!(
            left < 1.0 && capacitance < 1e-2,
            "{sheet:?}: {raw} mm, {left} mm left, {capacitance}"
        );
    }
}

#[test]
fn a_pad_alone_stays_as_it_is_read() {
    let read = PadEstimate { x_mm: 120.0, y_mm: -60.0, capacitance_pf: 318.0 };
    let mut nominal = plant(&[[0.0, 0.0]], NOMINAL).nominal_sheet().unwrap();
    let (ratios, _) = nominal.with_neighbours(&read, &[]);
    let freed = CrosstalkCanceller::nominal(nominal).cancel(read, ratios, &[]);
    assert!(
        (freed.x_mm - 120.0).abs() < 1e-9 && (freed.capacitance_pf - 318.0).abs() < 1e-9,
        "{freed:?}"
    );
}

/// What a host of a real board has of the sheet is what the simulation's `analytic` and `full`
/// levels compute.
#[test]
fn the_hosts_own_nominal_sheet_is_the_simulated_one() {
    let mut simulated = plant(&[[0.0, 0.0]], NOMINAL).nominal_sheet().unwrap();
    let device = simulated.device.clone();
    let sheet = hapticore_sheet::UniformSheet {
        size_m: [0.86, 0.5],
        ohm_per_square: 150.0,
        pad_radius_m: 0.015,
        terminals_m: device
            .terminals_mm
            .iter()
            .map(|[x, y]| [0.43 + 1e-3 * x, 0.25 + 1e-3 * y])
            .collect(),
        terminal_ohm: vec![0.0; 6],
        terminal_radius_m: 1.7e-3,
    };
    let mut own =
        hapticore_sheet::NominalSheet::new(sheet, device.carrier_hz, simulated.ratios.clone());
    for places in placements(40, 20.0) {
        let pads = places.map(at);
        let ([r_x, r_y], amplitude) = simulated.with_neighbours(&pads[0], &pads[1..]);
        let (ratios, sum) = own.with_neighbours(&pads[0], &pads[1..]);
        let off = [ratios[0] - r_x, ratios[1] - r_y, sum / amplitude - 1.0];
        assert!(off.iter().all(|off| off.abs() < 1e-9), "{off:?}");
        let (a, b) = (simulated.isolated(&pads[0]), own.isolated(&pads[0]));
        assert!((a.1 - b.1).abs() < 1e-6 && (a.0[0] - b.0[0]).abs() < 1e-9, "{a:?} {b:?}");
    }
}
