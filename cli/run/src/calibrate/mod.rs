// SPDX-License-Identifier: MIT OR Apache-2.0
//! The calibration of a simulated device: what its builder knows of it.

pub mod bench;
pub mod random;

use anyhow::{Result, anyhow};
use hapticore_contract::profile::{ForceLaw, Profile};
use hapticore_host::device::{CONTACT_SHARE, Force};
use hapticore_host::{DeviceCalibration, Raster, Scales, Signs, open_share};
use hapticore_scene::{ForcePoint, Plant, Scene};

use crate::inputs;
use crate::lab::force_table::fit;
use crate::lab::shares;
use bench::Bench;

/// Places in a row and rows of the raster that a simulated device is calibrated with.
const RASTER: [usize; 2] = [121, 71];

/// Of them the shares of the currents are kept at every such column and row.
const EVERY: usize = 5;

/// Loads, g, and haptic voltages, V rms, at which the friction of a simulated device is measured,
/// as for the paper's Fig. 6.
const LOADS_G: [f64; 2] = [20.0, 100.0];
const HAPTIC_V_RMS: [f64; 8] = [0.0, 50.0, 100.0, 150.0, 200.0, 250.0, 300.0, 350.0];

/// k of eq. 8 that fits the device's friction best.
fn force_k(plant: &Plant) -> f64 {
    let points = plant.friction_calibration(&LOADS_G, &HAPTIC_V_RMS);
    let square = |point: &ForcePoint| (point.capacitance_pf * 1e-12 * point.haptic_v_rms).powi(2);
    let product: f64 = points.iter().map(|point| square(point) * point.force_n).sum();
    product / points.iter().map(|point| square(point).powi(2)).sum::<f64>()
}

/// The force table of a device from readings on its bench, as multiples of its `force_k`. A static
/// gap gives filters without time constants. Without a bench (a scene without a gap) the table is
/// that of eq. 8.
///
/// # Errors
/// A device that cannot be simulated.
pub fn force_table(bench: Option<&Bench>, force_k: f64) -> Result<Force> {
    let Some(bench) = bench else { return Ok(Force::default()) };
    let readings = bench.readings()?;
    let mut force = fit(&readings, force_k);
    if bench.is_static() {
        force.recent_s = 0.0;
        force.rows.iter_mut().for_each(|[_, _, d]| *d = 0.0);
    }
    Ok(force)
}

/// What the builder of the simulated device knows of it.
pub fn of_plant(plant: &Plant, profile: &Profile) -> DeviceCalibration {
    let device = plant.device();
    // A pad goes no further: places beyond would be read as those at the edge.
    let map = plant.calibration_map(RASTER[0], RASTER[1], device.pad_diameter_mm / 2.0);
    // Without a sheet, what a terminal between the corners carries is nothing, and no fault.
    let shares = map.iter().map(|point| &*point.shares);
    let open_share = if plant.has_sheet() { open_share(shares) } else { 0.0 };
    let normalised = |shares: &[f64]| {
        let sum: f64 = shares.iter().sum();
        shares.iter().map(|share| share / sum).collect()
    };
    let coarse = |index: &usize| {
        (index / RASTER[0]).is_multiple_of(EVERY) && (index % RASTER[0]).is_multiple_of(EVERY)
    };
    let by_place: Vec<_> = (0..map.len())
        .filter(coarse)
        .map(|index| &map[index])
        .map(|point| ([point.x_mm, point.y_mm], normalised(&point.shares)))
        .collect();
    let places =
        map.iter().map(|point| [point.x_mm, point.y_mm, point.r_x, point.r_y, point.sheet_ohm]);
    DeviceCalibration {
        pads: plant.served() as u64,
        parts: plant.parts() as u64,
        terminals: Signs { x: profile.terminals.x.clone(), y: profile.terminals.y.clone() },
        map: Raster { columns: RASTER[0], places: places.collect(), open_share },
        force: None,
        shares: shares::of(&by_place),
        device: Scales {
            sample_rate_hz: device.sample_rate_hz,
            carrier_hz: device.carrier_hz,
            current_full_scale_a: device.current_full_scale_a,
            sense_full_scale_v: device.sense_full_scale_v,
            haptic_full_scale_v: device.haptic_full_scale_v,
            force_k: force_k(plant),
            pad_diameter_mm: Some(device.pad_diameter_mm),
            contact_pf: Some(CONTACT_SHARE * plant.least_rest_capacitance_pf(LOADS_G[0])),
        },
    }
}

/// The nominal device with a core of the profile.
///
/// # Errors
/// A profile for another number of terminals than the paper's device has.
pub fn nominal(profile: &Profile) -> Result<DeviceCalibration> {
    const NOMINAL: &str = "title = \"nominal\"\n[[pad]]\nposition_mm = [0, 0]\n[sheet]\n";
    let scene = Scene::parse(NOMINAL, "nominal", &[]).expect("a valid scene");
    let plant = Plant::new(&scene, 0, &inputs::timing(profile)).map_err(|_| {
        let terminals = profile.terminals.x.len();
        anyhow!("expected --calibration FILE: the paper's display has six terminals, the profile {terminals}")
    })?;
    // Without a bench the force is that of eq. 8, as a table where the profile has one.
    let force = (profile.force.law == ForceLaw::Table).then(Force::default);
    Ok(DeviceCalibration { pads: profile.pads, parts: 1, force, ..of_plant(&plant, profile) })
}
