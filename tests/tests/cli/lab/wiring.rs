// SPDX-License-Identifier: MIT OR Apache-2.0
//! Terminals that are swapped or reversed are named.

use hapticore_scene::{Complex, Plant};

use super::{
    Files, Measurement, Noise, SETUP, SHEET, TERMINALS, measurements, places_csv, plant, raster,
};

fn measured(plant: &Plant) -> Vec<Measurement> {
    measurements(plant, &raster([13, 9], [140.0, 90.0]), 1e-3, &mut Noise::of(7))
}

fn refused(setup: &str, measurements: &[Measurement], phases: bool, words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    Files {
        places: places_csv(measurements, phases),
        setup: setup.into(),
        ..Files::new(folder.path())
    }
    .refused(words);
}

#[test]
fn swapped_terminals_are_named() {
    let sloping = ["sheet.slope_percent=[10, 5]"];
    for set in [&SHEET[..], &[&SHEET[..], &sloping].concat()] {
        let setup = format!("{SETUP}{TERMINALS}");
        let all = measured(&plant("minimal-sheet", set));
        for (a, b) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            let mut swapped = all.clone();
            swapped.iter_mut().for_each(|measurement| measurement.currents_a.swap(a, b));
            let name = format!("places.csv: i{} and i{} are swapped: their shares", a + 1, b + 1);
            refused(&setup, &swapped, false, &[&name]);
        }
        let mut turned = all.clone();
        turned.iter_mut().for_each(|measurement| measurement.currents_a.rotate_left(1));
        refused(
            &setup,
            &turned,
            false,
            &["i1 reads as i2's terminal at [-150.0, -100.0] mm", "i4 reads as i1's"],
        );
        let mut mirrored = all.clone();
        mirrored.iter_mut().for_each(|measurement| measurement.at_mm[0] *= -1.0);
        refused(
            &setup,
            &mirrored,
            false,
            &["i1 and i4 are swapped", "or x_mm of the places runs the other way"],
        );
    }
}

#[test]
fn of_six_terminals_the_middle_ones_too() {
    let setup = format!(
        "{SETUP}[sheet]\nwidth_mm = 300\nheight_mm = 200\npad_diameter_mm = 20\n[terminals]\nplaces_mm = [[-150, 100], [-150, -100], [150, -100], [150, 100], [0, -100], [0, 100]]\n"
    );
    let set = [&SHEET[..3], &["sheet.terminal_ohm=500"]].concat();
    let all = measured(&plant("minimal-sheet", &set));
    for a in 0..6 {
        for b in 0..a {
            let mut swapped = all.clone();
            swapped.iter_mut().for_each(|measurement| measurement.currents_a.swap(a, b));
            refused(&setup, &swapped, false, &[&format!("i{} and i{} are swapped", b + 1, a + 1)]);
        }
    }
}

#[test]
fn signs_alone_see_swaps_across_an_axis() {
    let setup = format!("{SETUP}[terminals]\nx = [-1, -1, 1, 1]\ny = [1, -1, -1, 1]\n");
    let all = measured(&plant("minimal-sheet", &SHEET));
    for ((a, b), name) in
        [((1, 2), "terminals.x"), ((0, 1), "terminals.y"), ((0, 2), "terminals.x")]
    {
        let mut swapped = all.clone();
        swapped.iter_mut().for_each(|measurement| measurement.currents_a.swap(a, b));
        let message = format!("i{} and i{} are on the other side than {name} says", a + 1, b + 1);
        refused(&setup, &swapped, false, &[&message]);
    }
}

#[test]
fn reversed_terminals_are_named_where_phases_are_known() {
    let setup = format!("{SETUP}{TERMINALS}");
    let all = measured(&plant("minimal-sheet", &SHEET));
    let reverse = |terminals: &[usize]| {
        let mut reversed = all.clone();
        for measurement in &mut reversed {
            terminals.iter().for_each(|k| measurement.currents_a[*k] *= Complex::new(-1.0, 0.0));
        }
        reversed
    };
    refused(&setup, &reverse(&[3]), true, &["places.csv: i4 is reversed"]);
    refused(&setup, &reverse(&[0, 2]), true, &["places.csv: i1 and i3 are reversed"]);
    refused(&setup, &reverse(&[0, 1, 2, 3]), true, &["v_sense is reversed"]);
}
