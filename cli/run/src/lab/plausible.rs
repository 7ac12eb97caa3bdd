// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whether places and currents are what their columns' names say: units, origin, gains.
//!
//! | fault | is seen by | needs |
//! | --- | --- | --- |
//! | places in cm, m or inches | the largest of them beside half of the sheet | `[sheet]`; without it places within `SMALL_MM` are warned of |
//! | places from a corner | no place is negative, and the ratio has both signs, or the largest place is beyond half of the sheet | – |
//! | a current that reads a part of what it is | the sum of all currents, which is the pad's admittance at every place: Σ w_k·|I_k|/V = 1 by least squares, a_k = median(w)/w_k | places for each terminal |

use anyhow::{Result, bail};
use nalgebra::{DMatrix, DVector};

use super::places::Places;
use super::setup::Setup;
use hapticore_host::Signs;

/// Units that places may be in by mistake, and the millimetres of one.
const UNITS: [(&str, f64); 3] = [("cm", 10.0), ("inches", 25.4), ("m", 1000.0)];

/// Places reach less than this part of half of a sheet where their unit is none of mm.
const SHORT: f64 = 0.2;

/// Places reach at most this part beyond half of the sheet.
const BEYOND: f64 = 1.02;

/// Places that reach no further, from the first to the last, are those of a small device or in cm, mm.
const SMALL_MM: f64 = 60.0;

/// A ratio that is as far from 0 on either side is that of places on both sides of the middle.
const BOTH_SIDES: f64 = 0.15;

/// A current that reads more than this factor of the others is named.
const GAIN: f64 = 1.15;

/// And is this many standard errors off.
const ERRORS: f64 = 4.0;

/// Fewest places for each terminal from which gains are estimated.
const PLACES_PER_TERMINAL: usize = 4;

/// Checks units and origin of places.
///
/// # Errors
/// Places in another unit, or from a corner, by name.
pub fn check_places(places: &Places, setup: &Setup, signs: &Signs) -> Result<()> {
    let along = |axis: usize| places.places.iter().map(move |place| place.at_mm[axis]);
    let low = [0, 1].map(|axis| along(axis).fold(f64::INFINITY, f64::min));
    let high = [0, 1].map(|axis| along(axis).fold(f64::NEG_INFINITY, f64::max));
    let sheet_mm = setup.sheet.as_ref().map(|sheet| [sheet.width_mm, sheet.height_mm]);
    if let Some(sheet_mm) = sheet_mm {
        let reach = |axis: usize| low[axis].abs().max(high[axis]) / (sheet_mm[axis] / 2.0);
        let reach = reach(0).max(reach(1));
        let off = |mm: f64| (reach * mm).ln().abs();
        let unit = UNITS.into_iter().min_by(|a, b| off(a.1).total_cmp(&off(b.1)));
        if let Some((unit, mm)) = unit.filter(|_| reach < SHORT) {
            bail!(
                "{}: x_mm, y_mm: the places are in {unit}: they reach {:.4} and {:.4} on a sheet of {} × {} mm; expected mm: multiply by {mm}",
                places.file,
                high[0],
                high[1],
                sheet_mm[0],
                sheet_mm[1]
            );
        }
    }
    for (axis, (name, of_axis)) in [("x_mm", &signs.x), ("y_mm", &signs.y)].into_iter().enumerate()
    {
        let ratios = || {
            places
                .places
                .iter()
                .map(move |place| Places::ratios(&place.siemens, [&signs.x, &signs.y])[axis])
        };
        let [least, most] =
            [ratios().fold(f64::INFINITY, f64::min), ratios().fold(f64::NEG_INFINITY, f64::max)];
        let is_signed = of_axis.iter().any(|sign| *sign != 0);
        let half = sheet_mm.map(|mm| mm[axis] / 2.0);
        let span = high[axis] - low[axis];
        let is_one_sided =
            low[axis] >= -0.02 * span && is_signed && least < -BOTH_SIDES && most > BOTH_SIDES;
        if is_one_sided {
            let middle = half.unwrap_or((low[axis] + high[axis]) / 2.0);
            bail!(
                "{}: {name}: the places are measured from a corner: they run from {} to {}, while the currents show both sides of the middle; \
                 expected from the sheet's middle: subtract {middle}",
                places.file,
                low[axis],
                high[axis]
            );
        }
        if let Some(half) = half.filter(|half| low[axis].abs().max(high[axis]) > BEYOND * half) {
            bail!(
                "{}: {name}: expected places on the sheet, from -{half} to {half} mm, got {} to {}; the unit, the origin or [sheet] is another",
                places.file,
                low[axis],
                high[axis]
            );
        }
    }
    Ok(())
}

/// What may be wrong with places whose sheet is not known, and with gains of currents.
pub fn warnings(places: &Places, setup: &Setup) -> Vec<String> {
    let file = &places.file;
    let mut warnings = Vec::new();
    let span = |axis: usize| {
        let along = || places.places.iter().map(move |place| place.at_mm[axis]);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    };
    if setup.sheet.is_none() && span(0).max(span(1)) < SMALL_MM {
        warnings.push(format!(
            "{file}: x_mm, y_mm: the places span {} × {} mm: are they in cm? [sheet] in the setup would tell",
            span(0),
            span(1)
        ));
    }
    for (terminal, gain) in gains(places).into_iter().enumerate() {
        if !(1.0 / GAIN..=GAIN).contains(&gain) {
            warnings.push(format!(
                "{file}: i{} READS {gain:.2} TIMES as much as the other currents: only so is their sum, the pad's admittance, the same at all \
                 places; check its gain, range and unit",
                terminal + 1
            ));
        }
    }
    warnings
}

/// What each current reads of what it is, beside the others; 1 where that cannot be told.
fn gains(places: &Places) -> Vec<f64> {
    let (count, terminals) = (places.places.len(), places.terminals());
    let none = vec![1.0; terminals];
    if count < PLACES_PER_TERMINAL * terminals {
        return none;
    }
    let rows = DMatrix::from_fn(count, terminals, |row, k| places.places[row].siemens[k].norm());
    let scale = rows.row_sum().sum() / count as f64;
    let rows = rows / scale;
    let ones = DVector::from_element(count, 1.0);
    let Some(inverse) = (rows.transpose() * &rows).try_inverse() else { return none };
    let weights = &inverse * rows.tr_mul(&ones);
    let squares = (&rows * &weights - &ones).norm_squared();
    let noise = (squares / (count - terminals) as f64).sqrt();
    let mut sorted: Vec<f64> = weights.iter().copied().collect();
    sorted.sort_by(f64::total_cmp);
    let median = (sorted[(terminals - 1) / 2] + sorted[terminals / 2]) / 2.0;
    let gain = |k: usize| {
        let is_sure = (weights[k] - median).abs() > ERRORS * noise * inverse[(k, k)].sqrt();
        if is_sure && median > 0.0 && weights[k] > 0.0 { median / weights[k] } else { 1.0 }
    };
    (0..terminals).map(gain).collect()
}
