// SPDX-License-Identifier: MIT OR Apache-2.0
//! A calibration corrected by ratios that were read at some places of the device itself.
//!
//! ```text
//!   r'(p) = s·r(p) + f(p),   s by least squares for each axis,   f a spline of r_read(p_i) − s·r(p_i)
//! ```
//!
//! Few places are enough where the calibration is that of a device like this one: its map has what changes fast near the
//! terminals, and the rest is smooth. s is for resistance in series with the terminals, which shrinks all ratios: of 24 places
//! on a sheet behind 100 Ω, whose calibration knew of none, 1.1 mm rms are left elsewhere, 2.8 mm without s.

use anyhow::{Context, Result, ensure};
use hapticore_contract::profile::Profile;
use hapticore_host::device::CONTACT_SHARE;
use hapticore_host::{DeviceCalibration, Found, Residual, Scales};

use super::scattered::{Row, corrected};

/// Places that a correction needs at least.
pub const LEAST: usize = 9;

/// Places within this part of the range of all are inner ones.
const INNER: f64 = 0.8;

/// What a board has read of a pad, or of a part of one, at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Where it was, mm from the sheet's centre.
    pub at_mm: [f64; 2],
    /// Both ratios.
    pub ratios: [f64; 2],
    /// Its capacitance, pF.
    pub capacitance_pf: f64,
}

/// A corrected calibration, and how good it is.
#[derive(Debug, Clone)]
pub struct Corrected {
    /// The calibration.
    pub device: DeviceCalibration,
    /// Of the calibration before, at the places that were read.
    pub before: Residual,
    /// At each of these places but the outermost, with a correction from the others.
    pub held_out: Residual,
}

/// A calibration corrected by readings, `profile` that of the board.
///
/// # Errors
/// Fewer than [`LEAST`] places, places on a line, a reading beyond the calibration's map, a map that no position table
/// fits.
pub fn correct(
    device: &DeviceCalibration,
    profile: &Profile,
    readings: &[Reading],
) -> Result<Corrected> {
    ensure!(
        readings.len() >= LEAST,
        "expected readings at {LEAST} places or more, got {}",
        readings.len()
    );
    let before = found(device, profile, readings)?;
    let held_out = inner(readings).map(|index| {
        let mut others = readings.to_vec();
        let left_out = others.remove(index);
        Ok(found(&with_map(device, &others)?, profile, &[left_out])?[0])
    });
    let held_out: Vec<Found> = held_out.collect::<Result<_>>()?;
    let mut capacitances: Vec<f64> = readings.iter().map(|of| of.capacitance_pf).collect();
    capacitances.sort_by(f64::total_cmp);
    let contact_pf = Some(CONTACT_SHARE * capacitances[capacitances.len() / 2]);
    let made = with_map(device, readings)?;
    let made = DeviceCalibration { device: Scales { contact_pf, ..made.device }, ..made };
    made.for_profile(profile)?;
    Ok(Corrected {
        device: made,
        before: Residual::of(before.into_iter()),
        held_out: Residual::of(held_out.into_iter()),
    })
}

/// The readings that have others on all sides.
fn inner(readings: &[Reading]) -> impl Iterator<Item = usize> {
    let of = |axis: usize| readings.iter().map(move |of| of.at_mm[axis]);
    let ranges =
        [0, 1].map(|axis| [of(axis).fold(f64::MAX, f64::min), of(axis).fold(f64::MIN, f64::max)]);
    let is_inner = move |of: &Reading| {
        (0..2).all(|axis| {
            let [least, most] = ranges[axis];
            (of.at_mm[axis] - (least + most) / 2.0).abs() < INNER * (most - least) / 2.0
        })
    };
    readings.iter().enumerate().filter(move |(_, of)| is_inner(of)).map(|(index, _)| index)
}

/// Where a calibration finds the pad of each reading.
fn found(
    device: &DeviceCalibration,
    profile: &Profile,
    readings: &[Reading],
) -> Result<Vec<Found>> {
    let calibration = device.for_profile(profile)?;
    let rows =
        readings.iter().map(|of| [of.at_mm[0], of.at_mm[1], of.ratios[0], of.ratios[1], 0.0]);
    Ok(hapticore_host::found(&rows.collect::<Vec<_>>(), &calibration))
}

fn with_map(device: &DeviceCalibration, readings: &[Reading]) -> Result<DeviceCalibration> {
    let own = |of: &Reading| {
        let [x, y] = of.at_mm;
        let ratios = device.map.ratios_at(of.at_mm);
        ratios.with_context(|| {
            format!("expected places within the calibration's, got {x} mm, {y} mm")
        })
    };
    let own: Vec<[f64; 2]> = readings.iter().map(own).collect::<Result<_>>()?;
    let scale = [0, 1].map(|axis| {
        let read = readings.iter().map(|of| of.ratios[axis]);
        let product: f64 = own.iter().zip(read).map(|(own, read)| own[axis] * read).sum();
        let square: f64 = own.iter().map(|own| own[axis].powi(2)).sum();
        if square > 0.0 { product / square } else { 1.0 }
    });
    let off = |(of, own): (&Reading, &[f64; 2])| {
        let off = |axis: usize| of.ratios[axis] - scale[axis] * own[axis];
        [of.at_mm[0], of.at_mm[1], off(0), off(1), 0.0]
    };
    let off: Vec<Row> = readings.iter().zip(&own).map(off).collect();
    let mut made = device.clone();
    for [_, _, r_x, r_y, _] in &mut made.map.places {
        (*r_x, *r_y) = (scale[0] * *r_x, scale[1] * *r_y);
    }
    made.map.places = corrected(&made.map.places, &off)?;
    Ok(made)
}
