// SPDX-License-Identifier: MIT OR Apache-2.0
//! Effects together: those of no size change no bit, and none depends on what else is asked for, on
//! which thread.

use crate::common::every::{PARTS, scene_of};
use crate::common::{plant, scene, see, timing};
use hapticore_scene::{Complex, Plant};

/// Two pads of a case.
const PADS: &str = "dwell_slots = 6\n[[pad]]\nposition_mm = [120, -60]\nhaptic_v_rms = 150\n\
                    [[pad]]\nposition_mm = [-200, 90]\ncapacitance_pf = 760\n";

/// A scene with all effects that have no state: a slot can then be asked for in any order.
fn all_without_state() -> String {
    let states = ["charge", "temperature.spring", "gap", "halves", "hand", "release", "friction"];
    scene_of(&PARTS.iter().filter(|part| !states.contains(&part.name)).collect::<Vec<_>>())
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

/// Of the sensor chain: a key at zero costs nothing.
#[test]
fn an_effect_of_no_size_is_not_built() {
    let sized = |size: f64| {
        let keys = [
            "crosstalk_percent",
            "gain_error_percent",
            "gain_mismatch_percent",
            "offset_percent",
            "jitter_ns_rms",
            "noise_ppm_rms",
            "noise_density_na_per_rthz",
            "series_inductance_mh",
            "dither_lsb_rms",
        ];
        let lines: String = keys.iter().map(|key| format!("{key} = {size:?}\n")).collect();
        let text = format!(
            "{PADS}[carrier]\nrung = \"samples\"\n[sensor]\nquantisation_bits = 16\n{lines}"
        );
        let mut plant = Plant::new(&scene(&text), 0, &timing()).unwrap().metered();
        see(&mut plant, 0);
        plant.effects().iter().filter(|cost| cost.name.starts_with("sensor.")).count()
    };
    assert_eq!((sized(0.0), sized(0.01)), (1, 10));
}

#[test]
fn a_metered_plant_and_one_that_is_not_tell_the_same() {
    let scene = scene(&all_without_state());
    let mut silent = Plant::new(&scene, 0, &timing()).unwrap();
    let mut metered = Plant::new(&scene, 0, &timing()).unwrap().metered();
    assert_eq!(see(&mut silent, 1), see(&mut metered, 1));
    assert!(silent.effects().is_empty() && !metered.effects().is_empty());
}

#[test]
fn slots_are_the_same_on_any_number_of_threads_and_in_any_order() {
    let scene = scene(&all_without_state());
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
                        (first..12)
                            .step_by(threads)
                            .map(|slot| see(&mut plant, slot))
                            .collect::<Vec<_>>()
                    })
                })
                .collect();
            workers.into_iter().map(|worker| worker.join().unwrap()).collect()
        });
        for (slot, expected) in one_by_one.iter().enumerate() {
            assert_eq!(
                &seen[slot % threads][slot / threads],
                expected,
                "slot {slot} of {threads} threads"
            );
        }
    }
}

#[test]
fn a_pad_over_the_edge_is_taken_as_at_the_edge_and_flagged() {
    let truth = |x: f64| {
        plant(&format!("[[pad]]\nposition_mm = [{x}, 0]\nover_edge = true\n[sheet]\n")).truth(0)
    };
    let (at, over) = (truth(415.0), truth(425.0));
    assert!(!at.over_edge && over.over_edge && over.x_mm == 425.0);
    assert_eq!((over.r_x, over.r_y, over.sheet_ohm), (at.r_x, at.r_y, at.sheet_ohm));
}

#[test]
fn four_terminals_are_all_there_is_and_short_edges_have_their_middles_left_and_right() {
    let currents = |sheet: &str| {
        let mut plant = plant(&format!("[[pad]]\nposition_mm = [300, 0]\n[sheet]\n{sheet}"));
        let mut phasors = vec![Complex::default(); plant.channels() - 1];
        plant.phasors(0, &mut phasors);
        let terminals = plant.terminals().len();
        phasors[..terminals].iter().map(|phasor| phasor.norm()).collect::<Vec<_>>()
    };
    let four = currents("terminals = 4\n");
    assert!(four.len() == 4 && four.iter().all(|current| *current > 0.0), "{four:?}");
    let (long, short) = (currents(""), currents("middles = \"short\"\n"));
    assert!(
        (long[4] / long[5] - 1.0).abs() < 1e-6 && short[5] > 2.0 * short[4],
        "{long:?} {short:?}"
    );
}

/// Without a capacitance its solution would be a division by zero.
#[test]
fn a_shunt_of_no_capacitance_is_no_shunt() {
    let seen = |shunt: &str| {
        let mut plant = plant(&format!("{PADS}[sheet]\n[coupling]\n{shunt}"));
        (0..6).map(|slot| see(&mut plant, slot)).collect::<Vec<_>>()
    };
    let none = seen("");
    for rung in ["", "rung = \"table\"\n", "rung = \"series\"\n"] {
        assert_eq!(seen(&format!("[shunt]\nnanofarad_per_m2 = 0\n{rung}")), none, "{rung}");
    }
}
