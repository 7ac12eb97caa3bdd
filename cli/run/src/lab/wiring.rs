// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whether each current comes from the terminal that its column names: a self-test at calibration.
//!
//! | fault | is seen by | needs |
//! | --- | --- | --- |
//! | reversed terminal, reversed sensing voltage | a current that lags the voltage; through a pad it leads by up to a quarter turn | phases |
//! | swapped terminals | a share of the current that goes over the sheet as another terminal's would on a uniform sheet | `terminals.places_mm` and `[sheet]` |
//! | the same, across an axis of the sheet | a share that falls towards the side on which its sign says the terminal is | nothing more |

use std::fmt::Write;

use anyhow::{Result, anyhow, bail, ensure};
use hapticore_contract::profile::Profile;
use hapticore_scene::{PadMeasurement, Plant, Scene, Timing};

use super::places::{Place, Places, total};
use super::setup::Setup;
use crate::inputs;
use hapticore_host::Signs;

/// A current that is so much better correlated with another terminal's on the uniform sheet is not
/// of its own.
const BETTER: f64 = 0.05;

/// A share counts as falling towards its terminal's side from this correlation on.
const FALLS: f64 = -0.3;

/// Checks the terminals of places, with a uniform sheet of the setup where it says enough.
///
/// # Errors
/// Terminals that are swapped or reversed, by name.
pub fn check(places: &Places, setup: &Setup, signs: &Signs, uniform: Option<&Plant>) -> Result<()> {
    check_polarity(places)?;
    if let Some(uniform) = uniform {
        let at: Vec<_> = places.places.iter().map(|place| place.at_mm).collect();
        check_order(places, &uniform.measurements(&at), setup)?;
    }
    check_sides(places, signs)
}

/// A uniform sheet of the setup, where it says enough.
///
/// # Errors
/// A sheet that cannot be.
pub fn uniform_sheet(setup: &Setup) -> Result<Option<Plant>> {
    let (Some(sheet), Some(terminals)) = (&setup.sheet, &setup.terminals.places_mm) else {
        return Ok(None);
    };
    let mut scene = String::from("title = \"a uniform sheet\"\n[[pad]]\nposition_mm = [0, 0]\n");
    let _ = writeln!(
        scene,
        "[device]\nwidth_mm = {:?}\nheight_mm = {:?}\npad_diameter_mm = {:?}",
        sheet.width_mm, sheet.height_mm, sheet.pad_diameter_mm
    );
    let _ = writeln!(
        scene,
        "[sheet]\nterminals_mm = {terminals:?}\nterminal_ohm = {:?}",
        sheet.terminal_ohm
    );
    let _ = sheet.ohm_per_square.map(|ohm| writeln!(scene, "ohm_per_square = {ohm:?}"));
    let fail = |error| anyhow!("the setup's sheet and terminals.places_mm: {error}");
    let scene = Scene::parse(&scene, "sheet", &[]).map_err(fail)?;
    let timing = Timing { signs: None, ..inputs::timing(&Profile::bundled("standard")?) };
    Ok(Some(Plant::new(&scene, 0, &timing).map_err(fail)?))
}

fn check_polarity(places: &Places) -> Result<()> {
    if !places.phases {
        return Ok(());
    }
    let lags = |k: &usize| {
        let lagging = places.places.iter().filter(|place| place.siemens[*k].im < 0.0).count();
        2 * lagging > places.places.len()
    };
    let reversed: Vec<_> = (0..places.terminals()).filter(lags).collect();
    ensure!(
        reversed.len() < places.terminals(),
        "{}: v_sense is reversed, or all currents are: they lag it, where the current through a pad leads",
        places.file
    );
    ensure!(
        reversed.is_empty(),
        "{}: {} reversed: the current lags v_sense, where that through a pad leads; turn the sensor's leads, or correct the sign",
        places.file,
        list(&reversed, "is", "are")
    );
    Ok(())
}

fn check_order(places: &Places, model: &[PadMeasurement], setup: &Setup) -> Result<()> {
    let expected = |k: usize| {
        let share = move |measurement: &PadMeasurement| {
            measurement.siemens[k].norm()
                / measurement.siemens.iter().map(|s| s.norm()).sum::<f64>()
        };
        model.iter().map(share).collect::<Vec<_>>()
    };
    let expected: Vec<_> = (0..places.terminals()).map(expected).collect();
    let best = |k: usize| {
        let measured = shares(places, k);
        let near: Vec<_> =
            expected.iter().map(|expected| correlation(&measured, expected)).collect();
        let best = (0..near.len()).max_by(|a, b| near[*a].total_cmp(&near[*b])).unwrap_or(k);
        if near[best] - near[k] > BETTER { best } else { k }
    };
    let best: Vec<_> = (0..places.terminals()).map(best).collect();
    let wrong: Vec<_> = (0..best.len()).filter(|k| best[*k] != *k).collect();
    if wrong.is_empty() {
        return Ok(());
    }
    let at = |k: usize| setup.terminals.places_mm.as_ref().map_or([0.0; 2], |places| places[k]);
    let mut told = Vec::new();
    for &k in &wrong {
        let (a, b) = (k + 1, best[k] + 1);
        match best[best[k]] == k {
            true if k < best[k] => told.push(format!("i{a} and i{b} are swapped")),
            true => (),
            false => {
                told.push(format!("i{a} reads as i{b}'s terminal at {:?} mm would", at(best[k])))
            }
        }
    }
    let mirrored = |axis: usize| {
        let mirror = |mut place: [f64; 2]| {
            place[axis] = -place[axis];
            place
        };
        (0..best.len()).all(|k| at(best[k]) == mirror(at(k)))
    };
    let hint = [0, 1].into_iter().find(|axis| mirrored(*axis)).map_or(String::new(), |axis| {
        format!(" (or {} of the places runs the other way)", ["x_mm", "y_mm"][axis])
    });
    bail!(
        "{}: {}{hint}: their shares of the current go over the sheet as each other's would on a uniform sheet",
        places.file,
        told.join(", ")
    );
}

/// By the signs in the ratios alone.
fn check_sides(places: &Places, signs: &Signs) -> Result<()> {
    for (axis, (signs, name)) in [(&signs.x, "x"), (&signs.y, "y")].into_iter().enumerate() {
        let along: Vec<_> = places.places.iter().map(|place| place.at_mm[axis]).collect();
        let falls =
            |k: &usize| f64::from(signs[*k]) * correlation(&shares(places, *k), &along) < FALLS;
        let wrong: Vec<_> = (0..places.terminals()).filter(falls).collect();
        ensure!(
            wrong.is_empty(),
            "{}: {} on the other side than terminals.{name} says: the share of the current rises the other way along {name}_mm; terminals are swapped, or the signs are not theirs",
            places.file,
            list(&wrong, "is", "are")
        );
    }
    Ok(())
}

fn shares(places: &Places, k: usize) -> Vec<f64> {
    places.places.iter().map(|place: &Place| place.siemens[k].norm() / total(place)).collect()
}

/// `i1 is`, `i1 and i4 are`.
fn list(terminals: &[usize], one: &str, more: &str) -> String {
    let names: Vec<_> = terminals.iter().map(|k| format!("i{}", k + 1)).collect();
    match names.as_slice() {
        [name] => format!("{name} {one}"),
        [names @ .., last] => format!("{} and {last} {more}", names.join(", ")),
        [] => String::new(),
    }
}

/// Pearson's correlation coefficient.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (mean_a, mean_b) = (mean(a), mean(b));
    let sum = |f: &dyn Fn(f64, f64) -> f64| {
        a.iter().zip(b).map(|(a, b)| f(a - mean_a, b - mean_b)).sum::<f64>()
    };
    sum(&|a, b| a * b) / (sum(&|a, _| a * a) * sum(&|_, b| b * b)).sqrt()
}
