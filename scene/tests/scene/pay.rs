// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pay for what you use: an effect that a scene does not name is not built, never evaluated, holds
//! no memory and leaves the bits of the run alone.

use crate::common::every::{PARTS, Part, optional, scene_of};
use crate::common::{CHANNELS, SENSE, Seen, plant, scene, see, timing};
use allocation_counter::measure;
use hapticore_scene::{Complex, Plant, Scene};

const SLOTS: usize = 6;

/// Effects that one other changes.
const TIED: [[&str; 2]; 2] = [["shunt", "coupling"], ["temperature", "temperature.spring"]];

fn parts(keep: impl Fn(&Part) -> bool) -> Vec<&'static Part> {
    PARTS.iter().filter(|part| keep(part)).collect()
}

/// All effects but one and those that need it.
fn all_but(name: &str) -> Vec<&'static Part> {
    parts(|part| !part.goes_with(name))
}

fn names(parts: &[&Part]) -> Vec<&'static str> {
    parts.iter().map(|part| part.name).collect()
}

fn run(text: &str, overrides: &[(String, String)]) -> Vec<Seen> {
    let scene = Scene::parse(&format!("title = \"t\"\n{text}"), "s.toml", overrides);
    let mut plant =
        Plant::new(&scene.unwrap_or_else(|error| panic!("{error}")), 0, &timing()).unwrap();
    (0..SLOTS).map(|slot| see(&mut plant, slot)).collect()
}

/// Evaluations of each effect over the run.
fn evaluations(parts: &[&Part]) -> Vec<(&'static str, u64)> {
    let mut plant = plant(&scene_of(parts));
    (0..SLOTS).for_each(|slot| drop(see(&mut plant, slot)));
    plant.effects().into_iter().map(|cost| (cost.name, cost.evaluations)).collect()
}

/// An effect on a pad acts once a slot, on each pad where pads are coupled; one on all pads once;
/// one on the channels on amplitudes and on samples.
fn expected(parts: &[&Part]) -> Vec<(&'static str, u64)> {
    let coupled = parts.iter().any(|part| ["coupling", "sensor.others"].contains(&part.name));
    let each = |name: &str| match name {
        "coupling" | "sensor.others" => 1,
        "carrier" | "switching" | "shunt.panel_noise" => 2,
        name if name.starts_with("sensor.") && name != "sensor.inductance" => 2,
        _ => 1 + u64::from(coupled),
    };
    names(parts).into_iter().map(|name| (name, SLOTS as u64 * each(name))).collect()
}

#[test]
fn every_effect_that_a_scene_names_is_evaluated_as_often_as_it_must_be_and_no_other() {
    assert_eq!(evaluations(&parts(|_| true)), expected(&parts(|_| true)));
    for left_out in optional() {
        assert_eq!(
            evaluations(&all_but(left_out.name)),
            expected(&all_but(left_out.name)),
            "without {}",
            left_out.name
        );
    }
    let carrier = parts(|part| part.name == "carrier");
    assert_eq!(evaluations(&carrier), expected(&carrier));
}

#[test]
fn a_run_without_an_effect_has_the_bits_of_one_that_never_had_it() {
    let all = scene_of(&parts(|_| true));
    let full = run(&all, &[]);
    for left_out in optional() {
        let gone = parts(|part| part.goes_with(left_out.name));
        // A key goes before the table that it is in.
        let off: Vec<_> = gone.iter().rev().map(|part| part.off()).collect();
        let never = run(&scene_of(&all_but(left_out.name)), &[]);
        assert!(run(&all, &off) == never, "{} switched off", left_out.name);
        assert!(full != never, "{} changes nothing where it is on", left_out.name);
    }
}

/// Bytes that a plant holds.
fn held(parts: &[&Part]) -> i64 {
    let scene = scene(&scene_of(parts));
    let mut plant = None;
    let memory = measure(|| plant = Some(Plant::new(&scene, 0, &timing()).unwrap()));
    drop(plant);
    memory.bytes_current
}

/// What an effect holds is gone with it: as much among all others as on the least scene that has
/// it. So none keeps anything for another, and none anything for itself where it is not named.
/// (Shunt and coupling are measured one without the other: pads are coupled through what the shunt
/// makes of the sheet. So are film and rubber, which a scene's text has in one table.)
#[test]
fn an_effect_that_a_scene_leaves_out_holds_no_memory() {
    held(&parts(|_| true)); // whatever a library keeps for ever is there now
    println!("all effects hold {} bytes", held(&parts(|_| true)));
    for one in optional() {
        let needed = |part: &Part| part.name == "carrier" || one.needs(part.name);
        let alone =
            held(&parts(|part| part.name == one.name || needed(part))) - held(&parts(needed));
        let partners = TIED.iter().filter(|pair| pair.contains(&one.name)).flatten();
        let partners: Vec<_> = partners.filter(|partner| **partner != one.name).collect();
        let tied = |part: &Part| {
            part.needs(one.name) || partners.iter().any(|partner| part.goes_with(partner))
        };
        let with_others = held(&parts(|part| !tied(part)))
            - held(&parts(|part| !tied(part) && part.name != one.name));
        println!("{}: {alone} bytes alone, {with_others} among all others", one.name);
        assert!(
            alone > 0 && alone == with_others,
            "{}: {alone} bytes alone, {with_others} among all others",
            one.name
        );
    }
}

/// Allocations of a slot: truth, amplitudes, and samples into a buffer that is there.
fn allocations(parts: &[&Part]) -> u64 {
    let mut plant = Plant::new(&scene(&scene_of(parts)), 0, &timing()).unwrap();
    let mut samples = Vec::with_capacity(timing().window_samples * CHANNELS);
    let mut phasors = [Complex::default(); SENSE + 1];
    let mut slot = |slot: usize| {
        samples.clear();
        plant.truth(slot);
        plant.phasors(slot, &mut phasors);
        plant.samples(slot, 0..timing().window_samples, &mut samples);
    };
    (0..SLOTS).for_each(&mut slot); // states that grow with the pads are there now
    measure(|| (SLOTS..2 * SLOTS).for_each(&mut slot)).count_total
}

#[test]
fn a_slot_allocates_nothing_but_for_transients_and_coupled_pads() {
    const ALLOCATE: [&str; 2] = ["coupling", "switching"];
    for one in optional() {
        let with =
            parts(|part| part.name == "carrier" || part.name == one.name || one.needs(part.name));
        let count = allocations(&with);
        assert_eq!(count > 0, ALLOCATE.contains(&one.name), "{}: {count} allocations", one.name);
    }
    assert_eq!(
        allocations(&parts(|part| !ALLOCATE.contains(&part.name))),
        0,
        "all others together"
    );
}

#[test]
fn a_driven_pad_allocates_nothing_once_it_has_been_driven_for_some_slots() {
    let coupled = |part: &Part| ["coupling", "switching"].contains(&part.name);
    let mut plant =
        Plant::new(&scene(&scene_of(&parts(|part| !coupled(part)))), 0, &timing()).unwrap();
    let mut slot = |slot: usize| {
        let slot_s = plant.truth(slot).time_s;
        for pad in 0..2 {
            plant.set_drive(pad, slot_s + 1e-4, 50.0 + slot as f64).unwrap();
        }
    };
    (0..SLOTS).for_each(&mut slot);
    assert_eq!(measure(|| (SLOTS..4 * SLOTS).for_each(&mut slot)).count_total, 0);
}

/// Tables of the sheet and the shunt are the case's: plants share them, and so does what calibrates
/// beside a run.
#[test]
fn a_second_plant_of_a_case_builds_no_table_anew() {
    let scene = scene(&scene_of(&parts(|part| {
        part.name != "sensor.quantisation" && part.name != "sensor.dither"
    })));
    let mut plants = Vec::new();
    let [first, second] = [0, 1]
        .map(|_| measure(|| plants.push(Plant::new(&scene, 0, &timing()).unwrap())).bytes_total);
    let map = measure(|| drop(plants[0].calibration_map(2, 2, 15.0))).bytes_total;
    println!("{first} bytes, then {second}; {map} for a calibration");
    assert!(
        first > 1_000_000 && second < 50_000 && map < 50_000,
        "{first}, then {second}; {map} for a calibration"
    );
}
