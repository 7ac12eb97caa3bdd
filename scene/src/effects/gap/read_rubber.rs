// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pad's rubber as `[gap]` writes it: heights, shares of area and load, and the law's numbers.
//!
//! The defaults are a device that shows what the paper says (docs/physics.md §3). A single height needs no shares. Other
//! heights need shares of their own: which patches are crests and which spots is part of the device.

use std::f64::consts::PI;

use super::law::{Law, Patch};
use super::rubber::Rubber;
use crate::device::Device;
use crate::error::SceneError;
use crate::format::{Key, Limits, Table, keys};

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

keys! { RUBBER_KEYS:
    /// Thickness of the insulators between pad and film.
    INSULATOR_UM: f64 = Key::number("insulator_um", Limits::within(0.01, 1e4)).or(16.0);
    /// Relative permittivity of the insulators at the carrier's frequency.
    INSULATOR_PERMITTIVITY: f64 = Key::number("insulator_permittivity", Limits::within(1.0, 1e5)).or(3.2);
    /// Relative permittivity of the insulators at the haptic frequency.
    HAPTIC_PERMITTIVITY: Option<f64> =
        Key::number("haptic_permittivity", Limits::within(1.0, 1e5)).usually("`insulator_permittivity`");
    /// Heights of the patches above the film, without load, more than the insulators by their permittivity.
    REST: Vec<f64> = Key::numbers("rest_um", Limits::above(0.0, 1e4)).or(&REST_UM);
    /// Share of the pad's area that each patch has; their sum is 1.
    AREA: Option<Vec<f64>> = Key::numbers("area_shares", Limits::above(0.0, 1.0)).usually("those of the default heights");
    /// Load per area of each patch over the pad's; each times its area share, their sum is 1.
    LOAD: Option<Vec<f64>> = Key::numbers("load_shares", Limits::within(0.0, 1e6)).usually("those of the default heights");
    /// Viscosity of the air film.
    FILM_PA_S: f64 = Key::number("film_pa_s", Limits::within(1e-9, 1e3)).or(AIR_PA_S);
    /// Area of the air film's disc, over the pad's.
    FILM_AREA_SHARE: f64 = Key::number("film_area_share", Limits::within(1e-6, 10.0)).or(0.4);
    /// Air film that is left in contact.
    FILM_REST_UM: f64 = Key::number("film_rest_um", Limits::within(1e-3, 1e3)).or(0.7);
    /// Hardness of contact spots, which attract as across the insulators alone.
    CONTACT_HARDNESS_PA: Option<f64> = Key::number("contact_hardness_pa", Limits::within(1e3, 1e15));
    /// Stiffness of the rubber under a patch.
    SPRING_PA_PER_M: f64 = Key::number("spring_pa_per_m", Limits::within(1e3, 1e15)).or(4.5e7);
    /// Pressure of the contact at a gap of zero.
    CONTACT_PA: f64 = Key::number("contact_pa", Limits::within(0.0, 1e10)).or(2e5);
    /// Gap over which the contact's pressure falls to 1/e.
    CONTACT_DECAY_UM: f64 = Key::number("contact_decay_um", Limits::within(1e-3, 1e3)).or(1.25);
    /// Creep of the rubber, as a share of its spring.
    CREEP_SHARE: f64 = Key::number("creep_share", Limits::within(0.0, 1e4)).or(0.6);
    /// Time constant of the creep.
    CREEP_S: f64 = Key::number("creep_s", Limits::within(1e-6, 1e6)).or(1.5);
    /// Mass per area that moves with a patch.
    INERTIA_KG_M2: f64 = Key::number("inertia_kg_m2", Limits::within(1e-3, 1e6)).or(7.0);
}

pub(super) fn read_rubber(table: &Table, device: &Device) -> Result<Rubber, SceneError> {
    let thickness_um = table.get(&INSULATOR_UM)?;
    let permittivity = table.get(&INSULATOR_PERMITTIVITY)?;
    let insulator_um = thickness_um / permittivity;
    let rest_um = read_heights(table, insulator_um)?;
    let shares = Shares::read(table, &rest_um)?;
    let haptic_permittivity = table.get(&HAPTIC_PERMITTIVITY.or(permittivity))?;
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
    let rest_um = table.get(&REST.within(heights))?;
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
    let film_pa_s = table.get(&FILM_PA_S)?;
    let film_area_share = table.get(&FILM_AREA_SHARE)?;
    let [insulator_m, haptic_insulator_m] = insulators_um.map(|um| 1e-6 * um);
    let hardness_pa = table.get(&CONTACT_HARDNESS_PA)?;
    Ok(Law {
        spring_pa_per_m: table.get(&SPRING_PA_PER_M)?,
        contact_pa: table.get(&CONTACT_PA)?,
        contact_decay_m: 1e-6 * read_contact_decay_um(table, insulators_um[1], hardness_pa)?,
        creep_share: table.get(&CREEP_SHARE)?,
        creep_s: table.get(&CREEP_S)?,
        insulator_m,
        haptic_insulator_m,
        contact_hardness_pa: hardness_pa.unwrap_or(f64::INFINITY),
        film_n_s: 1.5 * film_pa_s * film_area_share * device.pad_area_m2 / PI,
        film_rest_m: 1e-6 * table.get(&FILM_REST_UM)?,
        inertia_kg_m2: table.get(&INERTIA_KG_M2)?,
    })
}

/// λ; with a hardness the gap is followed in steps, and λ may be any.
fn read_contact_decay_um(
    table: &Table,
    insulator_um: f64,
    hardness_pa: Option<f64>,
) -> Result<f64, SceneError> {
    let decay_um = table.get(&CONTACT_DECAY_UM)?;
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
        let read = |key: &Key<Option<Vec<f64>>>, of_eight| {
            let name = key.about.name;
            let message = |got: &str| {
                format!("expected {heights} numbers, one for each height of gap.rest_um, got {got}")
            };
            let shares = match table.get(key)? {
                Some(shares) => shares,
                None => usual(of_eight).ok_or_else(|| {
                    let got = "none, and the default shares are for the default heights only";
                    table.error(name, message(&format!("{got}; set gap.{name}")))
                })?,
            };
            let got = shares.len();
            if got == heights {
                Ok(shares)
            } else {
                Err(table.error(name, message(&got.to_string())))
            }
        };
        let mut area = read(&AREA, AREA_SHARES)?;
        let mut load = read(&LOAD, LOAD_SHARES)?;
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
