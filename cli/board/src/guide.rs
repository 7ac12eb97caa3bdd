// SPDX-License-Identifier: MIT OR Apache-2.0
//! A guided calibration: a pad is put at places, one after the other, and what the board reads there corrects the
//! calibration of a device like this one.
//!
//! Frames carry no currents, so the correction is one of the ratios ([`corrected`]). The force law, the sheet's resistance
//! and the shares of the currents stay those of the calibration that it begins with.
//!
//! [`corrected`]: hapticore_run::lab::corrected

use anyhow::{Result, bail};
use hapticore_host::DeviceCalibration;
use hapticore_host::startup::AdcSetup;
use hapticore_run::lab::corrected::{Corrected, Reading, correct};

use crate::bench::{Bench, Place, for_any_ratios, mean_of};

/// Columns and rows of places.
const GRID: [usize; 2] = [6, 4];
/// How far the outermost places are from the sheet's centre, of those that pads reach.
const REACH: f64 = 0.95;
/// Frames of a place, after those of the motion.
const FRAMES: usize = 32;
/// The pad that is put at the places.
const PAD: usize = 0;

/// Corrects a calibration by what a board reads of its first pad at places all over the sheet. The drive stays off.
///
/// # Errors
/// A board that does not start up, a pad that is lifted or lost at a place, readings that make no calibration.
pub fn guide(bench: &mut dyn Bench, device: &DeviceCalibration) -> Result<Corrected> {
    let profile = bench.profile().clone();
    let calibration = for_any_ratios(&profile, device)?;
    let lines = bench.bring_up(&calibration, &AdcSetup::default(), true)?;
    if let Some((line, _)) = lines.first() {
        bail!("data line {line} of the ADC has failed: check the wiring first (--check)");
    }
    let parts_mm = bench.parts_mm().to_vec();
    let places = places(device, &parts_mm);
    let mut readings = Vec::new();
    for (number, place) in places.iter().enumerate() {
        bench.put(&[*place])?;
        let packets = bench.frames(FRAMES)?;
        for (part, part_mm) in parts_mm.iter().enumerate() {
            let pad = PAD * parts_mm.len() + part;
            let Some([r_x, r_y, capacitance_pf]) = mean_of(&packets, pad, &profile) else {
                bail!(
                    "expected pad {PAD} on the sheet at {:.0}, {:.0} mm: it reads nothing",
                    place[0],
                    place[1]
                );
            };
            let at_mm = [place[0] + part_mm[0], place[1] + part_mm[1]];
            readings.push(Reading { at_mm, ratios: [r_x, r_y], capacitance_pf });
        }
        let read = readings[readings.len() - 1];
        bench.tell(&format!(
            "place {} of {}: ratios {:.4}, {:.4}; {:.0} pF",
            number + 1,
            places.len(),
            read.ratios[0],
            read.ratios[1],
            read.capacitance_pf
        ));
    }
    correct(device, &profile, &readings)
}

/// Places all over the calibration's map, which each part of a pad reaches, row by row in turns.
fn places(device: &DeviceCalibration, parts_mm: &[Place]) -> Vec<Place> {
    let range = |axis: usize| {
        let of = |sign: f64| device.map.places.iter().map(move |place| sign * place[axis]);
        let part = parts_mm.iter().map(|part| part[axis].abs()).fold(0.0, f64::max);
        let [least, most] = [-of(-1.0).fold(f64::MIN, f64::max), of(1.0).fold(f64::MIN, f64::max)];
        let middle = (least + most) / 2.0;
        (middle, REACH * ((most - least) / 2.0 - part))
    };
    let [(x, width), (y, height)] = [range(0), range(1)];
    let along = |k: usize, count: usize| 2.0 * k as f64 / (count - 1) as f64 - 1.0;
    let place = |n: usize| {
        let (row, k) = (n / GRID[0], n % GRID[0]);
        // The way back is shorter than a new line.
        let column = if row.is_multiple_of(2) { k } else { GRID[0] - 1 - k };
        [x + width * along(column, GRID[0]), y + height * along(row, GRID[1])]
    };
    (0..GRID[0] * GRID[1]).map(place).map(|place| place.map(f64::round)).collect()
}
