// SPDX-License-Identifier: MIT OR Apache-2.0
//! A device as a core is told of it: full scales, the force law, and a raster of places with what is read there.
//!
//! The file is TOML and holds nothing of a profile, so that one capture can be replayed with any:
//!
//! ```toml
//! pads = 1
//! [terminals]                     # signs in the ratios; those of eqs. 2 and 3 where the table is left out
//! x = [-1, -1, 1, 1, 0, 0]
//! y = [1, -1, -1, 1, -1, 1]
//! [device]
//! sample_rate_hz = 1000000.0      # of the ADC while the capture was taken
//! carrier_hz = 100000.0
//! current_full_scale_a = 0.004    # at the end of the ADC's range, as the next two
//! sense_full_scale_v = 8.0
//! haptic_full_scale_v = 600.0
//! force_k = 9.6e12                # eq. 8, N/(F·V)²
//! pad_diameter_mm = 30.0          # pads that are nearer to each other touch; never told where it is left out
//! [map]
//! columns = 121                   # places in a row
//! open_share = 0.01               # of the ratios' denominator: a terminal with less current is open; none ever where it is left out
//! places = [[x_mm, y_mm, r_x, r_y, sheet_ohm], …]
//! ```

mod refine;

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

use anyhow::{Result, anyhow, ensure};
use hapticore_contract::calibration::{Calibration, Point, PositionTable};
use hapticore_contract::profile::Profile;
use hapticore_scene::{ForcePoint, Plant, Scene};
use serde::Deserialize;

use crate::inputs;
use crate::residual::Residual;

/// Places in a row and rows of the raster that a simulated device is calibrated with.
const RASTER: [usize; 2] = [121, 71];

/// Loads, g, and haptic voltages, V rms, at which the friction of a simulated device is measured, as for the paper's Fig. 6.
const LOADS_G: [f64; 2] = [20.0, 100.0];
const HAPTIC_V_RMS: [f64; 8] = [0.0, 50.0, 100.0, 150.0, 200.0, 250.0, 300.0, 350.0];

/// A device as a core is told of it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeviceCalibration {
    /// Pads served in turn.
    pub pads: u64,
    /// The signs of the terminals' currents in the ratios of `map`.
    #[serde(default)]
    pub terminals: Signs,
    /// Full scales and the force law.
    pub device: Scales,
    /// Places and what is read there.
    pub map: Raster,
}

/// The signs of the terminals' currents in the numerators of both ratios.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Signs {
    /// Of r_x.
    pub x: Vec<i8>,
    /// Of r_y.
    pub y: Vec<i8>,
}

/// Those of eqs. 2 and 3, of which calibrations without signs are.
impl Default for Signs {
    fn default() -> Self {
        Signs { x: vec![-1, -1, 1, 1, 0, 0], y: vec![1, -1, -1, 1, 0, 0] }
    }
}

/// A place, mm, and where it was found.
pub type Found = ([f64; 2], [f64; 2]);

/// Full scales, frequencies and the force law.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scales {
    /// ADC samples a second.
    pub sample_rate_hz: f64,
    /// The sensing carrier.
    pub carrier_hz: f64,
    /// Current at full scale.
    pub current_full_scale_a: f64,
    /// Sensing voltage at full scale.
    pub sense_full_scale_v: f64,
    /// Haptic voltage at full scale.
    pub haptic_full_scale_v: f64,
    /// k of eq. 8, N/(F·V)².
    pub force_k: f64,
    /// Of a pad, where it is known.
    pub pad_diameter_mm: Option<f64>,
}

/// Places in whole rows: `[x_mm, y_mm, r_x, r_y, sheet_ohm]`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Raster {
    /// Places in a row.
    pub columns: usize,
    /// A terminal whose current is a smaller share of the ratios' denominator counts as open.
    #[serde(default)]
    pub open_share: f64,
    /// The places.
    pub places: Vec<[f64; 5]>,
}

impl Scales {
    /// Ohms of one full scale of voltage per current.
    pub fn ohm(&self) -> f64 {
        self.sense_full_scale_v / self.current_full_scale_a
    }

    /// Picofarads at an admittance of one full scale of current per voltage.
    fn capacitance_gain(&self) -> f64 {
        self.current_full_scale_a / (TAU * self.carrier_hz * self.sense_full_scale_v) * 1e12
    }

    fn check(&self) -> Result<(), String> {
        let values = [
            ("sample_rate_hz", self.sample_rate_hz),
            ("carrier_hz", self.carrier_hz),
            ("current_full_scale_a", self.current_full_scale_a),
            ("sense_full_scale_v", self.sense_full_scale_v),
            ("haptic_full_scale_v", self.haptic_full_scale_v),
            ("force_k", self.force_k),
            ("pad_diameter_mm", self.pad_diameter_mm.unwrap_or(1.0)),
        ];
        let bad = values.into_iter().find(|(_, value)| !(value.is_finite() && *value > 0.0));
        bad.map_or(Ok(()), |(key, value)| Err(format!("device.{key}: expected a number above 0, got {value}")))
    }
}

/// A terminal whose share of the current is below this at every place is open.
pub const OPEN: f64 = 1e-4;

/// The share of the ratios' denominator below which a terminal counts as open: half of the least that any has anywhere that is
/// not open already. `shares` are those of each terminal, place by place.
pub fn open_share(shares: &[Vec<f64>]) -> f64 {
    let of = |terminal: usize| shares.iter().map(move |place| place[terminal]);
    let terminals = 0..shares.first().map_or(0, Vec::len);
    let connected = terminals.filter(|&terminal| of(terminal).fold(0.0, f64::max) >= OPEN);
    connected.flat_map(of).fold(1.0, f64::min) / 2.0
}

impl Raster {
    fn check(&self) -> Result<(), String> {
        if !(0.0..1.0).contains(&self.open_share) {
            return Err(format!("map.open_share: expected 0 to 1, got {}", self.open_share));
        }
        let places = self.places.len();
        if self.columns < 2 || !places.is_multiple_of(self.columns) || places / self.columns < 2 {
            let expected = "expected two whole rows or more of two columns or more";
            return Err(format!("map.columns: {expected}, got {places} places in rows of {}", self.columns));
        }
        match self.places.iter().position(|place| place.iter().any(|number| !number.is_finite())) {
            Some(index) => Err(format!("map.places: expected finite numbers, got {:?}", self.places[index])),
            None => Ok(()),
        }
    }
}

/// Where the position table of a calibration finds places, `[x_mm, y_mm, r_x, r_y, sheet_ohm]`.
pub fn found(places: &[[f64; 5]], calibration: &Calibration) -> Vec<Found> {
    let found = |&[x, y, r_x, r_y, _]: &[f64; 5]| {
        let found = calibration.position.look_up(r_x, r_y);
        ([x, y], [found.x, found.y])
    };
    places.iter().map(found).collect()
}

/// k of eq. 8 that fits the device's friction best.
fn force_k(plant: &Plant) -> f64 {
    let points = plant.friction_calibration(&LOADS_G, &HAPTIC_V_RMS);
    let square = |point: &ForcePoint| (point.capacitance_pf * 1e-12 * point.haptic_v_rms).powi(2);
    let product: f64 = points.iter().map(|point| square(point) * point.force_n).sum();
    product / points.iter().map(|point| square(point).powi(2)).sum::<f64>()
}

impl DeviceCalibration {
    /// What the builder of the simulated device knows of it.
    pub fn of_plant(plant: &Plant, profile: &Profile) -> Self {
        let device = plant.device();
        // A pad goes no further: places beyond would be read as those at the edge.
        let map = plant.calibration_map(RASTER[0], RASTER[1], device.pad_diameter_mm / 2.0);
        let open_share = open_share(&map.iter().map(|point| point.shares.clone()).collect::<Vec<_>>());
        let places = map.iter().map(|point| [point.x_mm, point.y_mm, point.r_x, point.r_y, point.sheet_ohm]);
        DeviceCalibration {
            pads: plant.pad_names().len() as u64,
            terminals: Signs { x: profile.terminals.x.clone(), y: profile.terminals.y.clone() },
            map: Raster { columns: RASTER[0], places: places.collect(), open_share },
            device: Scales {
                sample_rate_hz: device.sample_rate_hz,
                carrier_hz: device.carrier_hz,
                current_full_scale_a: device.current_full_scale_a,
                sense_full_scale_v: device.sense_full_scale_v,
                haptic_full_scale_v: device.haptic_full_scale_v,
                force_k: force_k(plant),
                pad_diameter_mm: Some(device.pad_diameter_mm),
            },
        }
    }

    /// The nominal device, served by a core of the profile.
    ///
    /// # Errors
    /// A profile for another number of terminals than the paper's device has.
    pub fn nominal(profile: &Profile) -> Result<Self> {
        const NOMINAL: &str = "title = \"nominal\"\n[[pad]]\nposition_mm = [0, 0]\n[sheet]\n";
        let scene = Scene::parse(NOMINAL, "nominal", &[]).expect("a valid scene");
        let plant = Plant::new(&scene, 0, &inputs::timing(profile)).map_err(|_| {
            let terminals = profile.terminals.x.len();
            anyhow!("expected --calibration FILE: the paper's display has six terminals, the profile {terminals}")
        })?;
        Ok(DeviceCalibration { pads: profile.pads, ..DeviceCalibration::of_plant(&plant, profile) })
    }

    /// Reads a calibration file.
    ///
    /// # Errors
    /// It is not there or no calibration; the message names file, line and key.
    pub fn read(path: &Path) -> Result<Self> {
        let text = inputs::read(path)?;
        let file = path.display();
        let read: DeviceCalibration = toml::from_str(&text).map_err(|error| {
            let line = error.span().map_or(1, |span| text[..span.start].matches('\n').count() + 1);
            anyhow!("{file}:{}", inputs::with_key(&text, &format!("{line}: {}", error.message())))
        })?;
        let pads = read.pads;
        ensure!((1..=256).contains(&pads), "{file}: pads: expected 1 to 256, got {pads}");
        read.device.check().and_then(|()| read.map.check()).map_err(|message| anyhow!("{file}: {message}"))?;
        Ok(read)
    }

    /// The text of a calibration file, one place a line.
    pub fn text(&self) -> String {
        let device = &self.device;
        let mut text = format!(
            "# A device's calibration for `hapticore replay`.\npads = {}\n\n[terminals]\nx = {:?}\ny = {:?}\n\n[device]\n\
             sample_rate_hz = {:?}\ncarrier_hz = {:?}\ncurrent_full_scale_a = {:?}\nsense_full_scale_v = {:?}\n\
             haptic_full_scale_v = {:?}\nforce_k = {:?}\n{}\n[map]\ncolumns = {}\nopen_share = {:?}\n\
             places = [ # x_mm, y_mm, r_x, r_y, sheet_ohm\n",
            self.pads,
            self.terminals.x,
            self.terminals.y,
            device.sample_rate_hz,
            device.carrier_hz,
            device.current_full_scale_a,
            device.sense_full_scale_v,
            device.haptic_full_scale_v,
            device.force_k,
            device.pad_diameter_mm.map(|mm| format!("pad_diameter_mm = {mm:?}\n")).unwrap_or_default(),
            self.map.columns,
            self.map.open_share
        );
        for place in &self.map.places {
            writeln!(text, "{place:?},").expect("a string takes all");
        }
        text.push_str("]\n");
        text
    }

    /// What is left of the calibration's own places, looked up in the table that was fitted to them.
    pub fn residual(&self, calibration: &Calibration) -> Residual {
        Residual::of(found(&self.map.places, calibration).into_iter())
    }

    /// The profile of a core for the device: with its terminals, and serving its pads.
    ///
    /// # Errors
    /// As [`inputs::for_terminals`].
    pub fn profile(&self, profile: &Profile) -> Result<Profile> {
        let signs = [self.terminals.x.clone(), self.terminals.y.clone()];
        Ok(inputs::serving(&inputs::for_terminals(profile, &signs)?, self.pads as usize))
    }

    /// The calibration for a core of the profile.
    ///
    /// # Errors
    /// A number that the profile's formats do not hold.
    pub fn of(&self, profile: &Profile) -> Result<Calibration> {
        let device = &self.device;
        let place = |&[x, y, r_x, r_y, sheet_ohm]: &[f64; 5]| Point { x, y, r_x, r_y, sheet: sheet_ohm / device.ohm() };
        let (_, places) = refine::refine(self.map.columns, &self.map.places);
        let points: Vec<_> = places.iter().map(place).collect();
        let table = PositionTable::fit(profile, &points).map_err(|error| anyhow!("calibration map: {error}"))?;
        let calibration = Calibration {
            position: table.with_open_share(self.map.open_share),
            capacitance_gain: device.capacitance_gain(),
            force_gain: device.force_k * 1e-24 * device.haptic_full_scale_v.powi(2) / profile.square_gain(),
        };
        calibration.check(profile)?;
        Ok(calibration)
    }
}
