// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pay for what you use: an effect that a scene does not name is never evaluated and changes no bit, and none depends on
//! what else is asked for, on which thread.

mod common;

use common::{plant, scene, timing};
use hapticore_scene::{CHANNELS, Complex, Plant, SENSE, Truth};

/// Two pads of a case with every effect of the sheet and the sensor chain.
const PADS: &str = "dwell_slots = 6\n[[pad]]\nposition_mm = [120, -60]\nhaptic_v_rms = 150\n\
                    [[pad]]\nposition_mm = [-200, 90]\ncapacitance_pf = 760\n";

const TABLES: [(&str, &str); 5] = [
    ("sheet", "[sheet]\n"),
    ("shunt", "[shunt]\nnanofarad_per_m2 = 9\n"),
    ("coupling", "[coupling]\n"),
    ("carrier", "[carrier]\nrung = \"samples\"\n"),
    ("switching", "[switching]\n"),
];

const SENSORS: [(&str, &str); 11] = [
    ("sensor.leakage", "haptic_leakage = true\n"),
    ("sensor.bandwidth", "bandwidth_khz = 900\n"),
    ("sensor.jitter", "jitter_ns_rms = 0.1\n"),
    ("sensor.crosstalk", "crosstalk_percent = 0.1\n"),
    ("sensor.scale", "gain_error_percent = 1\n"),
    ("sensor.gain", "gain_mismatch_percent = 1\n"),
    ("sensor.noise_density", "noise_density_na_per_rthz = 1\n"),
    ("sensor.offset", "offset_percent = 0.01\n"),
    ("sensor.noise", "noise_ppm_rms = 18\n"),
    ("sensor.dither", "dither_lsb_rms = 0.5\n"),
    ("sensor.quantisation", "quantisation_bits = 16\n"),
];

/// The scene with all effects but one.
fn without(left_out: &str) -> String {
    let keep = |(name, text): &(&str, &'static str)| (*name != left_out).then_some(*text);
    let (tables, keys): (String, String) =
        (TABLES.iter().filter_map(keep).collect(), SENSORS.iter().filter_map(keep).collect());
    format!("{PADS}{tables}[sensor]\n{keys}")
}

#[derive(Debug, PartialEq)]
struct Seen(Truth, f64, [Complex; SENSE + 1], Vec<f64>);

fn see(plant: &mut Plant, slot: usize) -> Seen {
    let (mut phasors, mut samples) = ([Complex::default(); SENSE + 1], Vec::new());
    let truth = plant.truth(slot);
    let mean_square = plant.phasors(slot, &mut phasors);
    plant.samples(slot, 0..timing().window_samples, &mut samples);
    assert_eq!(samples.len(), timing().window_samples * CHANNELS);
    Seen(truth, mean_square, phasors, samples)
}

fn evaluated(plant: &Plant) -> Vec<&'static str> {
    plant.effects().iter().filter(|cost| cost.evaluations > 0).map(|cost| cost.name).collect()
}

#[test]
fn every_effect_named_is_evaluated_and_no_other() {
    let all: Vec<_> = TABLES.iter().chain(&SENSORS).map(|(name, _)| *name).collect();
    let mut full = plant(&without(""));
    see(&mut full, 0);
    assert_eq!(evaluated(&full), all);
    for left_out in all.iter().filter(|name| !["sheet", "carrier", "sensor.quantisation"].contains(name)) {
        let mut plant = plant(&without(left_out));
        see(&mut plant, 0);
        let rest: Vec<_> = all.iter().filter(|name| *name != left_out).copied().collect();
        assert_eq!(evaluated(&plant), rest);
    }
}

/// The slots of one pad: the other's effects, and effects of no size, change no bit of it.
#[test]
fn effects_that_do_nothing_change_no_bit() {
    let bare = format!("{PADS}[sheet]\n[carrier]\nrung = \"samples\"\n");
    let nothing = "[sensor]\ncrosstalk_percent = 0\ngain_error_percent = 0\njitter_ns_rms = 0\nnoise_ppm_rms = 0\n";
    let (mut with, mut without) = (plant(&format!("{bare}{nothing}")), plant(&bare));
    for slot in 0..6 {
        assert_eq!(see(&mut with, slot).3, see(&mut without, slot).3);
    }
}

#[test]
fn a_metered_plant_and_one_that_is_not_tell_the_same() {
    let scene = scene(&without(""));
    let mut silent = Plant::new(&scene, 0, &timing()).unwrap();
    let mut metered = Plant::new(&scene, 0, &timing()).unwrap().metered();
    assert_eq!(see(&mut silent, 1), see(&mut metered, 1));
    assert!(silent.effects().is_empty() && !metered.effects().is_empty());
}

#[test]
fn slots_are_the_same_on_any_number_of_threads_and_in_any_order() {
    let scene = scene(&without(""));
    let one_by_one: Vec<_> = {
        let mut plant = Plant::new(&scene, 0, &timing()).unwrap();
        (0..12).map(|slot| see(&mut plant, slot)).collect()
    };
    for threads in [1, 3, 5] {
        let seen: Vec<_> = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..threads)
                .map(|first| {
                    let mut plant = Plant::new(&scene, 0, &timing()).unwrap();
                    scope.spawn(move || {
                        (first..12).step_by(threads).map(|slot| see(&mut plant, slot)).collect::<Vec<_>>()
                    })
                })
                .collect();
            workers.into_iter().map(|worker| worker.join().unwrap()).collect()
        });
        for (slot, expected) in one_by_one.iter().enumerate() {
            assert_eq!(&seen[slot % threads][slot / threads], expected, "slot {slot} of {threads} threads");
        }
    }
}

#[test]
fn a_pad_over_the_edge_is_taken_as_at_the_edge_and_flagged() {
    let truth = |x: f64| plant(&format!("[[pad]]\nposition_mm = [{x}, 0]\nover_edge = true\n[sheet]\n")).truth(0);
    let (at, over) = (truth(415.0), truth(425.0));
    assert!(!at.over_edge && over.over_edge && over.x_mm == 425.0);
    assert_eq!((over.r_x, over.r_y, over.sheet_ohm), (at.r_x, at.r_y, at.sheet_ohm));
}

#[test]
fn four_terminals_leave_the_middles_without_current_and_short_edges_have_them_left_and_right() {
    let currents = |sheet: &str| {
        let mut phasors = [Complex::default(); SENSE + 1];
        plant(&format!("[[pad]]\nposition_mm = [300, 0]\n[sheet]\n{sheet}")).phasors(0, &mut phasors);
        phasors.map(|phasor| phasor.norm())
    };
    let four = currents("terminals = 4\n");
    assert!(four[4] == 0.0 && four[5] == 0.0 && four[..4].iter().all(|current| *current > 0.0));
    let (long, short) = (currents(""), currents("middles = \"short\"\n"));
    assert!((long[4] / long[5] - 1.0).abs() < 1e-6 && short[5] > 2.0 * short[4], "{long:?} {short:?}");
}
