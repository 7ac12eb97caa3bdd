// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pad's rubber as `[gap]` writes it: heights, shares of area and load, and the law's numbers.
//!
//! ```toml
//! [gap]
//! rest_um = [12, 30, 40]          # heights g₀ + d of the patches
//! area_shares = [0.4, 0.3, 0.3]   # of the pad's area, their sum 1
//! load_shares = [2.5, 0, 0]       # load per area over the pad's; each times its area share, their sum 1
//! contact_hardness_pa = 3.6e6     # opt-in: parts of a patch touch the film, and attract as across the insulators alone
//! haptic_permittivity = 3.2       # of the insulators at the haptic frequency; insulator_permittivity is the carrier's
//! ```
//!
//! The defaults are a device that shows what the paper says (docs/physics.md §3). A single height needs no shares. Other
//! heights need shares of their own: which patches are crests and which spots is part of the device.

use std::f64::consts::PI;

use super::law::{Law, Patch};
use super::rubber::Rubber;
use crate::device::Device;
use crate::error::SceneError;
use crate::format::{Limits, Table};

/// Heights g₀ + d of the patches, µm: the sixth and the seventh are fitted to the jumps of the paper's Fig. 7
/// (docs/physics.md §3).
const REST_UM: [f64; 8] = [12.0, 26.4, 27.7, 29.3, 33.6, 38.191, 39.847, 55.0];

/// Shares of the pad's area: crests of the rough rubber first, then the spots between them.
const AREA_SHARES: [f64; 8] = [0.365, 0.11, 0.065, 0.04, 0.025, 0.10, 0.10, 0.195];

/// Load per area over the pad's: crests bear the finger, spots between them nothing.
const LOAD_SHARES: [f64; 8] = [1.0 / 0.365, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];

/// How far sums of shares may be off 1: rounding of what a scene writes.
const SHARES_OFF: f64 = 1e-3;

/// Viscosity of air, Pa·s.
const AIR_PA_S: f64 = 1.8e-5;

pub(super) fn read_rubber(table: &Table, device: &Device) -> Result<Rubber, SceneError> {
    let thickness_um = table.number_or("insulator_um", Limits::within(0.01, 1e4), 16.0)?;
    let permittivity = table.number_or("insulator_permittivity", Limits::within(1.0, 1e5), 3.2)?;
    let insulator_um = thickness_um / permittivity;
    let rest_um = read_heights(table, insulator_um)?;
    let shares = Shares::read(table, &rest_um)?;
    let haptic_permittivity =
        table.number_or("haptic_permittivity", Limits::within(1.0, 1e5), permittivity)?;
    let haptic_insulator_um = thickness_um / haptic_permittivity;
    let law = read_law(table, [insulator_um, haptic_insulator_um], device)?;
    let rest_m = rest_um.iter().map(|um| 1e-6 * (um - insulator_um));
    let patch = |(rest_m, load_share): (f64, &f64)| Patch { rest_m, load_share: *load_share };
    let patches = rest_m.zip(&shares.load).map(patch).collect();
    let areas_m2 = shares.area.iter().map(|share| share * device.pad_area_m2).collect();
    Ok(Rubber::new(law, patches, areas_m2, device.weight_n(1.0) / device.pad_area_m2))
}

/// g₀ + d of the patches, above the insulators.
fn read_heights(table: &Table, insulator_um: f64) -> Result<Vec<f64>, SceneError> {
    let heights = Limits::above(insulator_um, 1e4);
    let rest_um = table.numbers("rest_um", heights)?.unwrap_or(REST_UM.to_vec());
    let Some(height) = rest_um.iter().find(|height| !heights.holds(**height)) else {
        return Ok(rest_um);
    };
    let message = format!(
        "expected insulators that are thinner than air by permittivity than the lowest patch, {height} µm \
         above the film, got {insulator_um} µm; set gap.rest_um, too"
    );
    Err(table.error("insulator_um", message))
}

/// The law, of insulators that are so much air at the carrier's and at the haptic frequency.
fn read_law(table: &Table, insulators_um: [f64; 2], device: &Device) -> Result<Law, SceneError> {
    let film_pa_s = table.number_or("film_pa_s", Limits::within(1e-9, 1e3), AIR_PA_S)?;
    let film_area_share = table.number_or("film_area_share", Limits::within(1e-6, 10.0), 0.4)?;
    let [insulator_m, haptic_insulator_m] = insulators_um.map(|um| 1e-6 * um);
    let hardness_pa = table.number("contact_hardness_pa", Limits::within(1e3, 1e15))?;
    Ok(Law {
        spring_pa_per_m: table.number_or("spring_pa_per_m", Limits::within(1e3, 1e15), 4.5e7)?,
        contact_pa: table.number_or("contact_pa", Limits::within(0.0, 1e10), 2e5)?,
        contact_decay_m: 1e-6 * read_contact_decay_um(table, insulators_um[1], hardness_pa)?,
        creep_share: table.number_or("creep_share", Limits::within(0.0, 1e4), 0.6)?,
        creep_s: table.number_or("creep_s", Limits::within(1e-6, 1e6), 1.5)?,
        insulator_m,
        haptic_insulator_m,
        contact_hardness_pa: hardness_pa.unwrap_or(f64::INFINITY),
        film_n_s: 1.5 * film_pa_s * film_area_share * device.pad_area_m2 / PI,
        film_rest_m: 1e-6 * table.number_or("film_rest_um", Limits::within(1e-3, 1e3), 0.7)?,
        inertia_kg_m2: table.number_or("inertia_kg_m2", Limits::within(1e-3, 1e6), 7.0)?,
    })
}

/// λ; with a hardness the gap is followed in steps, and λ may be any.
fn read_contact_decay_um(
    table: &Table,
    insulator_um: f64,
    hardness_pa: Option<f64>,
) -> Result<f64, SceneError> {
    let decay_um = table.number_or("contact_decay_um", Limits::within(1e-3, 1e3), 1.25)?;
    if hardness_pa.is_some() || decay_um <= 0.5 * insulator_um {
        return Ok(decay_um);
    }
    let message = format!(
        "expected at most half of the insulators' {insulator_um} µm of air, beyond which contact and attraction \
         balance at several gaps, got {decay_um}; set gap.insulator_um or gap.contact_hardness_pa, too"
    );
    Err(table.error("contact_decay_um", message))
}

/// What part of the pad's area each patch has, and what load per area it bears over the pad's.
struct Shares {
    area: Vec<f64>,
    load: Vec<f64>,
}

impl Shares {
    /// Reads a share of either kind for each height. A single patch needs none; the default ones are for the default
    /// heights.
    fn read(table: &Table, rest_um: &[f64]) -> Result<Shares, SceneError> {
        let usual = |of_eight: [f64; 8]| match rest_um {
            [_] => Some(vec![1.0]),
            heights => (heights == REST_UM).then(|| of_eight.to_vec()),
        };
        let heights = rest_um.len();
        let read = |key: &'static str, limits, of_eight| {
            let message = |got: &str| {
                format!("expected {heights} numbers, one for each height of gap.rest_um, got {got}")
            };
            let shares = match table.numbers(key, limits)? {
                Some(shares) => shares,
                None => usual(of_eight).ok_or_else(|| {
                    let got = "none, and the default shares are for the default heights only";
                    table.error(key, message(&format!("{got}; set gap.{key}")))
                })?,
            };
            let got = shares.len();
            if got == heights {
                Ok(shares)
            } else {
                Err(table.error(key, message(&got.to_string())))
            }
        };
        let mut area = read("area_shares", Limits::above(0.0, 1.0), AREA_SHARES)?;
        let mut load = read("load_shares", Limits::within(0.0, 1e6), LOAD_SHARES)?;
        let all: f64 = area.iter().sum();
        check_sum(table, "area_shares", "shares of the pad's area whose sum is 1", all)?;
        area.iter_mut().for_each(|share| *share /= all);
        let borne: f64 = area.iter().zip(&load).map(|(area, load)| area * load).sum();
        let what = "loads per area whose sum, each times its share of the area, is 1";
        check_sum(table, "load_shares", what, borne)?;
        load.iter_mut().for_each(|share| *share /= borne);
        Ok(Shares { area, load })
    }
}

/// Refuses a sum that is further off 1 than rounding.
fn check_sum(table: &Table, key: &str, what: &str, sum: f64) -> Result<(), SceneError> {
    if (sum - 1.0).abs() <= SHARES_OFF {
        return Ok(());
    }
    Err(table.error(key, format!("expected {what}, got {sum}; divide each by that")))
}
