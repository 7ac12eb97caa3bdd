// SPDX-License-Identifier: MIT OR Apache-2.0
//! Devices drawn at random, and how well a calibrated core finds a pad on them.

use std::fmt::Write;
use std::sync::Arc;

use fastrand::Rng;
use hapticore_contract::profile::Profile;
use hapticore_host::Residual;
use hapticore_run::case::{Case, record_truth};
use hapticore_run::engine::Fidelity;
use hapticore_run::engine::{Signals, Slot};
use hapticore_run::maker::Maker;
use hapticore_run::record::{Quantities, Row};
use hapticore_run::session::Options;
use hapticore_run::session::Session;
use hapticore_scene::Scene;

/// A sheet with terminals.
#[derive(Debug, Clone)]
pub struct Device {
    /// Its number among those drawn.
    pub number: usize,
    /// Along x and y.
    pub size_mm: [f64; 2],
    /// Where the terminals are, from the middle.
    pub terminals_mm: Vec<[f64; 2]>,
    /// In series with each.
    pub terminal_ohm: Vec<f64>,
    /// Sheet resistance in the middle, Ω per square.
    pub ohm_per_square: f64,
    /// Of the film, along x and y.
    pub slope_percent: [f64; 2],
}

/// Places of a pad: of columns × rows, 15 mm off the edges and evenly between, one in `every`.
#[derive(Debug, Clone, Copy)]
pub struct Raster {
    /// Positions along x.
    pub columns: usize,
    /// Positions along y.
    pub rows: usize,
    /// One in this many of them, row by row.
    pub every: usize,
}

impl Raster {
    /// A pad's `position_mm` in a scene.
    pub fn position(&self, size_mm: [f64; 2]) -> String {
        let along = |k: usize, count: usize, size: f64| {
            (size - 30.0) * (k as f64 / (count - 1) as f64 - 0.5)
        };
        let place = |k: usize| {
            let (column, row) = (k % self.columns, k / self.columns);
            [along(column, self.columns, size_mm[0]), along(row, self.rows, size_mm[1])]
        };
        let places: Vec<_> = (0..self.columns * self.rows).step_by(self.every).map(place).collect();
        format!("position_mm = {{ sweep = {places:?} }}\n")
    }
}

/// What came of a pad at many places of a device.
#[derive(Debug, Clone)]
pub struct Found {
    /// Device that is calibrated and read.
    pub device: Device,
    /// Distances from where the pad is, mm, of frames without *invalid*.
    pub errors_mm: Vec<f64>,
    /// The same of the floating-point reference, which has the table's error alone.
    pub reference_mm: Vec<f64>,
    /// Frames that are *invalid*.
    pub invalid: usize,
    /// What the calibration's report says of its own places.
    pub residual: Residual,
}

impl Device {
    /// Device `number`: 100 to 1500 mm long, 1 to 2.5 times as long as high, with 4, 5, 6 and 8
    /// terminals in turn. Four terminals are at the corners; every terminal has 0 to 2 kΩ ± 5 %.
    /// The film has 20 to 500 Ω/sq; every other film slopes by up to 20 %.
    pub fn draw(number: usize) -> Device {
        let mut rng = Rng::with_seed(0xDE71CE + number as u64);
        let rounded = |x: f64| (10.0 * x).round() / 10.0;
        let width = rounded(100.0 * 15f64.powf(rng.f64()));
        let height = rounded(width / (1.0 + 1.5 * rng.f64()));
        let (right, top) = (width / 2.0, height / 2.0);
        let mut terminals_mm = vec![[-right, top], [-right, -top], [right, -top], [right, top]];
        while terminals_mm.len() < [4, 5, 6, 8][number % 4] {
            let along = 0.9 * (rng.f64() - 0.5);
            let edges = [
                [along * width, top],
                [along * width, -top],
                [right, along * height],
                [-right, along * height],
            ];
            terminals_mm.push(edges[rng.usize(0..4)]);
        }
        let ohm = 2000.0 * rng.f64();
        let slope = if number.is_multiple_of(2) { 0.0 } else { 20.0 };
        Device {
            number,
            size_mm: [width, height],
            terminal_ohm: terminals_mm.iter().map(|_| ohm * within(&mut rng, 0.95, 1.05)).collect(),
            terminals_mm,
            ohm_per_square: within(&mut rng, 20.0, 500.0),
            slope_percent: [0, 1].map(|_| slope * within(&mut rng, -1.0, 1.0)),
        }
    }

    /// A scene with one pad at these places.
    pub fn scene(&self, places: &Raster) -> String {
        let mut text = format!(
            "title = \"device {}\"\n[device]\nwidth_mm = {:?}\nheight_mm = {:?}\n[[pad]]\n{}haptic_v_rms = 150\n\
             [carrier]\nrung = \"phasor\"\n[sheet]\nterminals_mm = {:?}\nterminal_ohm = {:?}\nohm_per_square = {:?}\n",
            self.number,
            self.size_mm[0],
            self.size_mm[1],
            places.position(self.size_mm),
            self.terminals_mm,
            self.terminal_ohm,
            self.ohm_per_square
        );
        let level = if self.slope_percent == [0.0; 2] { "bicubic-fine" } else { self.mesh() };
        let slope = self.slope_percent;
        writeln!(text, "slope_percent = {slope:?}\nrung = \"{level}\"")
            .expect("a string takes all");
        text
    }

    /// A mesh of some hundred nodes along the sheet.
    fn mesh(&self) -> &'static str {
        match self.size_mm[0] {
            ..150.0 => "grid-1.25-mm",
            ..300.0 => "grid-2.5-mm",
            ..800.0 => "grid-5-mm",
            _ => "grid-10-mm",
        }
    }

    /// A line that names it.
    pub fn label(&self) -> String {
        let Device {
            number,
            size_mm: [width, height],
            terminals_mm,
            ohm_per_square,
            terminal_ohm,
            slope_percent,
        } = self;
        let [along, across] = slope_percent;
        format!(
            "#{number:<3} {width:6.1} × {height:6.1} mm, {} terminals behind {:4.0} Ω, {ohm_per_square:3.0} Ω/sq {along:+3.0} {across:+3.0} %",
            terminals_mm.len(),
            terminal_ohm[0]
        )
    }
}

fn within(rng: &mut Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * rng.f64()
}

impl Found {
    /// Over all frames without *invalid*, mm.
    pub fn rms_mm(&self) -> f64 {
        rms(&self.errors_mm)
    }

    /// Largest position error, mm.
    pub fn worst_mm(&self) -> f64 {
        self.errors_mm.iter().copied().fold(0.0, f64::max)
    }
}

/// The measurements of a core of the profile, at `fixed`, of every slot of a scene with one pad,
/// and what its calibration's report says.
///
/// # Panics
/// A scene or device that the profile cannot serve.
pub fn rows(profile: &Profile, scene: &str) -> (Vec<Row>, Residual) {
    disturbed_rows(profile, scene, |_, _| ())
}

/// As [`rows`], where each slot's signals go through `disturb` first, with the slot's number.
///
/// # Panics
/// As [`rows`].
pub fn disturbed_rows(
    profile: &Profile,
    scene: &str,
    disturb: impl Fn(usize, &mut Signals),
) -> (Vec<Row>, Residual) {
    let scene = Arc::new(Scene::parse(scene, "device", &[]).expect("a scene"));
    let case = Case::new(&scene, 0, profile, &[]).expect("a case");
    let mut maker =
        Maker::new(case.plant().expect("a plant"), &case.profile, scene.cases[0].sampled(), false);
    let at = (0, case.clock);
    let device = (&**case.device, case.calibration().expect("a calibration"));
    let options = Options { fidelity: Fidelity::Fixed, errors: false, reference: true };
    let mut session = Session::new(&case.profile, device, (options, None), at).expect("a session");
    let row = |slot| {
        let truth = maker.plant().truth(slot);
        let (mut signals, _) = maker.signals(slot);
        disturb(slot, &mut signals);
        let slot = Slot { pad: truth.pad, signals };
        let row = session.slot(&slot, Some(record_truth(&truth))).expect("a slot of the case");
        row.expect("a measurement with each slot")
    };
    let rows = (0..case.slots).map(row).collect();
    (rows, case.residual().expect("a calibration"))
}

/// How far a row's position is from where the pad is, mm.
///
/// # Panics
/// A row of a recording: nothing knows where its pad was.
pub fn error_mm(row: &Row) -> f64 {
    distance_mm(row, row.measured)
}

fn distance_mm(row: &Row, found: Quantities) -> f64 {
    let truth = row.truth.expect("a plant knows").quantities;
    (found.x_mm - truth.x_mm).hypot(found.y_mm - truth.y_mm)
}

/// A pad at places of a device.
///
/// # Panics
/// As [`rows`].
pub fn find(profile: &Profile, device: Device, places: &Raster) -> Found {
    let (rows, residual) = rows(profile, &device.scene(places));
    let (invalid, valid): (Vec<_>, Vec<_>) =
        rows.iter().partition(|row| row.flags.contains("invalid"));
    let reference = |row: &Row| distance_mm(row, row.reference.expect("asked for").quantities);
    Found {
        device,
        errors_mm: valid.iter().copied().map(error_mm).collect(),
        reference_mm: valid.iter().copied().map(reference).collect(),
        invalid: invalid.len(),
        residual,
    }
}

/// Root mean square of the position error, mm.
pub fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}
