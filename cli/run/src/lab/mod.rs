// SPDX-License-Identifier: MIT OR Apache-2.0
//! Calibration: from what a lab measures to a device's calibration.
//!
//! ```text
//! places.csv ─ wiring ─ ratios ─┬─ position table ─ residual at its own places, at places held out
//!                               └─ sheet's resistance ──┐
//! loads.csv ─ capacitance ─ eq. 8 by least squares ─────┴─ force_k, current's full scale, each with its 95 % interval
//! device.toml ─ full scales, rates, signs
//! ```
//!
//! | module | does |
//! | --- | --- |
//! | [`table`], [`setup`] | reads CSV, TOML |
//! | [`places`] | what terminals read of a pad at known places |
//! | [`scattered`] | places that are no raster, brought onto one |
//! | [`corrected`] | a calibration corrected by ratios that a board has read |
//! | [`loads`] | friction under known loads and voltages |
//! | [`wiring`] | terminals that are swapped or reversed |
//! | [`gap`] | a scene's `[gap]`, from capacitances under loads |
//! | [`force_table`] | the force table, from readings and a prior |
//! | [`plausible`] | places and currents that are in another unit, or from another origin |
//! | [`shares`] | each terminal's share of the current by place |
//! | [`least_squares`] | coefficients with their intervals |

pub mod corrected;
pub mod force_table;
pub mod gap;
pub mod least_squares;
pub mod loads;
pub mod places;
pub mod plausible;
pub mod scattered;
pub mod setup;
pub mod shares;
pub mod table;
pub mod wiring;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail, ensure};
use hapticore_contract::profile::Profile;
use hapticore_scene::{Complex, Plant};
use serde::Serialize;

use crate::inputs::buildable;
use crate::record::Provenance;
use hapticore_host::device::CONTACT_SHARE;
use hapticore_host::residual::LIMIT_MM;
use hapticore_host::text::read;
use hapticore_host::{
    DeviceCalibration, Found, Raster, Residual, Scales, Signs, found, open_share,
};
use loads::{Force, Loads};
use places::{Place, Places};
use scattered::{Row, Values};
use setup::Setup;
use table::Table;

/// Beyond these the currents' scale is no calibration's but a fault's.
const SCALES: [f64; 2] = [0.8, 1.25];

/// Coefficients of friction beyond these are those of another unit.
const COEFFICIENTS: [f64; 2] = [0.005, 3.0];

/// What a calibration was made from, and how good it is.
#[derive(Debug, Clone, Serialize)]
pub struct Outcome {
    /// The profile that positions were looked up with.
    pub profile: String,
    /// Number of distinct positions.
    pub places: usize,
    /// Places in a row, where they are a raster.
    pub columns: Option<usize>,
    /// Number of terminals.
    pub terminals: usize,
    /// At the places that the table is made from.
    pub own_places: Residual,
    /// At every other place, with a table made from the others.
    pub held_out: Residual,
    /// k of eq. 8 and what else loads tell; none where the setup says it.
    pub force: Option<Force>,
    /// What a user must know.
    pub warnings: Vec<String>,
    /// Where the places were found.
    #[serde(skip)]
    pub found: [Vec<Found>; 2],
    /// Where it comes from.
    #[serde(flatten)]
    pub provenance: Provenance,
}

/// The files of a lab.
pub struct Data {
    setup: Setup,
    places: Table,
    loads: Option<Table>,
}

impl Data {
    /// Reads files, each known by what is in it.
    ///
    /// # Errors
    /// A file that cannot be read, or is of no kind; a kind that is missing or comes twice.
    pub fn read(paths: &[PathBuf]) -> Result<Data> {
        Data::of(&texts(paths)?)
    }

    /// The data of texts, each with the name of its file.
    ///
    /// # Errors
    /// As [`Data::read`].
    pub fn of(files: &[(String, String)]) -> Result<Data> {
        let (mut setup, mut places, mut loads) = (None, None, None);
        for (file, text) in files {
            let extension = Path::new(file).extension();
            if extension.is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
                ensure!(
                    setup.replace(Setup::parse(text, file)?).is_none(),
                    "{file}: expected one setup, got two"
                );
                continue;
            }
            let table = Table::parse(text, file)?;
            let (known, what) = match () {
                () if loads::is(&table) => (&mut loads, "loads"),
                () if places::is(&table) => (&mut places, "places"),
                () => bail!(
                    "{file}:1: expected columns of places (x_mm, y_mm, i1 …, v_sense) or of loads (haptic_v_rms, force_n or friction_n, …)"
                ),
            };
            ensure!(known.replace(table).is_none(), "{file}: expected one file of {what}, got two");
        }
        let missing = |what: &str| anyhow!("DATA: expected {what}, got none");
        Ok(Data {
            setup: setup.ok_or_else(|| {
                missing("a setup, a file of the device's full scales and rates that ends in .toml")
            })?,
            places: places
                .ok_or_else(|| missing("places, a CSV file of x_mm, y_mm, i1 …, v_sense"))?,
            loads,
        })
    }
}

/// The texts of files, each with its name.
///
/// # Errors
/// A file that cannot be read.
pub fn texts(paths: &[PathBuf]) -> Result<Vec<(String, String)>> {
    let read = |path: &PathBuf| Ok((path.display().to_string(), read(path)?));
    paths.iter().map(read).collect()
}

/// The calibration of a lab's data.
///
/// # Errors
/// Data that make none, with what is missing.
pub fn calibrate(data: &Data, profile: &Profile) -> Result<(DeviceCalibration, Outcome)> {
    let setup = &data.setup;
    let mut places = Places::of(&data.places, setup.current_full_scale_a)?;
    let columns = places.raster();
    let signs = setup.signs(places.terminals())?;
    plausible::check_places(&places, setup, &signs)?;
    let uniform = wiring::uniform_sheet(setup)?;
    wiring::check(&places, setup, &signs, uniform.as_ref())?;
    let mut warnings = plausible::warnings(&places, setup);
    let (sheet, from) = resistances(&places, setup, uniform.as_ref());
    warnings.extend((from == Resistance::Unknown).then(|| no_resistance(&places.file)));
    let nearest = |at: [f64; 2]| nearest(&places.places, &sheet, at);
    let force = data
        .loads
        .as_ref()
        .map(|table| Loads::of(table, setup, nearest)?.fit(setup))
        .transpose()?;
    let force_k = force.as_ref().map(|force| force.force_k.value).or(setup.force_k);
    let force_k = force_k.ok_or_else(|| {
        anyhow!(
            "DATA: expected loads, a CSV file of haptic_v_rms and force_n, or force_k in the setup"
        )
    })?;
    let scale =
        force.as_ref().and_then(|force| force.current_scale).map_or(1.0, |scale| scale.value);
    let mu = force.as_ref().and_then(|force| force.mu);
    warnings.extend(
        mu.filter(|mu| !(COEFFICIENTS[0]..COEFFICIENTS[1]).contains(&mu.value))
            .map(|mu| no_friction(mu.value)),
    );
    warnings.extend((!(SCALES[0]..SCALES[1]).contains(&scale)).then(|| far_off(scale)));
    let sheet: Vec<_> = sheet
        .iter()
        .map(|ohm| if from == Resistance::Currents { ohm / scale } else { *ohm })
        .collect();
    let shares = |place: &Place| Places::shares(&place.siemens, [&signs.x, &signs.y]);
    let shares: Vec<_> = places.places.iter().map(shares).collect();
    let open_share = open_share(shares.iter().map(Vec::as_slice));
    let measured = Measured {
        rows: rows(&places, &sheet, &signs),
        columns,
        open_share,
        uniform: uniform.as_ref(),
        signs: &signs,
    };
    let mut device = DeviceCalibration {
        pads: setup.pads,
        parts: 1,
        map: Raster { columns: 0, places: Vec::new(), open_share: 0.0 },
        device: Scales {
            contact_pf: Some(CONTACT_SHARE * scale * places.capacitance_pf(setup.carrier_hz)),
            ..scales(setup, scale, force_k)
        },
        force: force.as_ref().and_then(|force| force.table.clone()),
        terminals: signs.clone(),
        shares: shares::of(&normalised(&places)),
    };
    let profile = buildable(device.profile(profile)?)?;
    device.force_gain(&profile).context(match &data.loads {
        Some(loads) => loads.file.clone(),
        None => "force_k of the setup".into(),
    })?;
    let (measured, held_out) =
        measured.best(&device, &profile).with_context(|| places.file.clone())?;
    device.map = measured.raster().with_context(|| places.file.clone())?;
    let calibration = device.for_profile(&profile).with_context(|| places.file.clone())?;
    let found = [found(&measured.rows, &calibration), held_out];
    let [own_places, held_out] = [0, 1].map(|k| Residual::of(found[k].iter().copied()));
    warnings.extend(own_places.warning(LIMIT_MM));
    warnings.extend(own_places.warning(LIMIT_MM).is_none().then(|| coarse(&held_out)).flatten());
    let outcome = Outcome {
        profile: profile.name.clone(),
        places: places.places.len(),
        columns,
        terminals: places.terminals(),
        own_places,
        held_out,
        force,
        warnings,
        found,
        provenance: Provenance::new(),
    };
    Ok((device, outcome))
}

/// Where the sheet's resistance comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Resistance {
    Measured,
    Currents,
    UniformSheet,
    Unknown,
}

/// The sheet's resistance at each place: measured, from currents with their phases, or that of a
/// uniform film.
fn resistances(places: &Places, setup: &Setup, uniform: Option<&Plant>) -> (Vec<f64>, Resistance) {
    let all = || places.places.iter();
    let film = setup.sheet.as_ref().and_then(|sheet| sheet.ohm_per_square);
    if let Some(measured) = all().map(|place| place.sheet_ohm).collect() {
        return (measured, Resistance::Measured);
    }
    if places.phases {
        let ohm = |place: &Place| (1.0 / place.siemens.iter().sum::<Complex>()).re;
        return (all().map(ohm).collect(), Resistance::Currents);
    }
    match uniform.filter(|_| film.is_some()) {
        Some(uniform) => {
            let at: Vec<_> = all().map(|place| place.at_mm).collect();
            (
                uniform.measurements(&at).iter().map(|measurement| measurement.sheet_ohm).collect(),
                Resistance::UniformSheet,
            )
        }
        None => (vec![0.0; places.places.len()], Resistance::Unknown),
    }
}

/// Each place with its terminals' shares of all current.
fn normalised(places: &Places) -> Vec<([f64; 2], Vec<f64>)> {
    let share = |place: &Place| {
        let total = places::total(place);
        place.siemens.iter().map(|siemens| siemens.norm() / total).collect()
    };
    places.places.iter().map(|place| (place.at_mm, share(place))).collect()
}

fn no_resistance(file: &str) -> String {
    format!(
        "{file}: the sheet's resistance is not in the data and is taken as 0: the capacitance then reads low by (ωCR)²/2, 0.1 % at 200 Ω and \
         318 pF, the force by twice that. Phases of the currents, a column sheet_ohm, or sheet.ohm_per_square and terminals.places_mm tell it"
    )
}

fn no_friction(mu: f64) -> String {
    format!(
        "the coefficient of friction comes out as {mu:.4}: expected {} to {}: load_g is not in grams, or friction_n not in newtons",
        COEFFICIENTS[0], COEFFICIENTS[1]
    )
}

fn far_off(scale: f64) -> String {
    format!(
        "the currents' full scale comes out as {scale:.3} times that of the setup: as a reversed terminal would make it, or a wrong \
         current_full_scale_a, sense_full_scale_v or carrier_hz"
    )
}

/// A table made from every other place is at least so many times as far off as that of all places: errors of
/// interpolation grow with the area that a place stands for, or faster.
const THINNED: f64 = 2.0;

fn coarse(held_out: &Residual) -> Option<String> {
    let text = || {
        format!(
            "places that the table was not made from are found less well ({}): measure places nearer to each other",
            held_out.errors()
        )
    };
    (held_out.rms_mm > THINNED * LIMIT_MM).then(text)
}

/// The resistance at the place that is nearest.
fn nearest(places: &[Place], ohm: &[f64], at: [f64; 2]) -> f64 {
    let distance = |place: &Place| (place.at_mm[0] - at[0]).hypot(place.at_mm[1] - at[1]);
    let nearest = places.iter().zip(ohm).min_by(|a, b| distance(a.0).total_cmp(&distance(b.0)));
    nearest.map_or(0.0, |(_, ohm)| *ohm)
}

fn rows(places: &Places, ohm: &[f64], signs: &Signs) -> Vec<Row> {
    let row = |(place, ohm): (&Place, &f64)| {
        let [r_x, r_y] = Places::ratios(&place.siemens, [&signs.x, &signs.y]);
        [place.at_mm[0], place.at_mm[1], r_x, r_y, *ohm]
    };
    places.places.iter().zip(ohm).map(row).collect()
}

fn scales(setup: &Setup, current_scale: f64, force_k: f64) -> Scales {
    Scales {
        sample_rate_hz: setup.sample_rate_hz,
        carrier_hz: setup.carrier_hz,
        current_full_scale_a: setup.current_full_scale_a * current_scale,
        sense_full_scale_v: setup.sense_full_scale_v,
        haptic_full_scale_v: setup.haptic_full_scale_v,
        force_k,
        pad_diameter_mm: setup.sheet.as_ref().map(|sheet| sheet.pad_diameter_mm),
        contact_pf: None,
    }
}

/// What was measured, as a position table is made from it.
#[derive(Clone)]
struct Measured<'a> {
    rows: Vec<Row>,
    columns: Option<usize>,
    open_share: f64,
    uniform: Option<&'a Plant>,
    signs: &'a Signs,
}

impl Measured<'_> {
    /// The places as a raster: as they are, or brought onto one.
    fn raster(&self) -> Result<Raster> {
        match self.columns {
            Some(columns) => {
                Ok(Raster { columns, places: self.rows.clone(), open_share: self.open_share })
            }
            None => self.scattered(&self.rows),
        }
    }

    fn scattered(&self, rows: &[Row]) -> Result<Raster> {
        let (columns, places) = scattered::raster(rows, |places| self.uniform(places))?;
        Ok(Raster { columns, places, open_share: self.open_share })
    }

    /// The ratios that a uniform sheet has at places; its resistance is not asked for.
    fn uniform(&self, places: &[[f64; 2]]) -> Vec<Values> {
        let Some(uniform) = self.uniform else { return vec![[0.0; 3]; places.len()] };
        let values = |siemens: &[Complex]| {
            let [r_x, r_y] = Places::ratios(siemens, [&self.signs.x, &self.signs.y]);
            [r_x, r_y, 0.0]
        };
        uniform
            .measurements(places)
            .iter()
            .map(|measurement| values(&measurement.siemens))
            .collect()
    }

    /// With the uniform sheet or without, whichever finds places better that are held out; and
    /// these.
    fn best(self, device: &DeviceCalibration, profile: &Profile) -> Result<(Self, Vec<Found>)> {
        let without = Measured { uniform: None, ..self.clone() };
        let found = without.hold_out(device, profile);
        let rms_mm = |found: &Vec<Found>| Residual::of(found.iter().copied()).rms_mm;
        match self.uniform.and_then(|_| self.hold_out(device, profile).ok()) {
            Some(with) if found.as_ref().map_or(true, |found| rms_mm(&with) < rms_mm(found)) => {
                Ok((self, with))
            }
            _ => Ok((without, found?)),
        }
    }

    /// Every other place, looked up in a table that was made from the others: of a raster the white
    /// squares of its board.
    fn hold_out(&self, device: &DeviceCalibration, profile: &Profile) -> Result<Vec<Found>> {
        let columns = self.columns.unwrap_or(self.rows.len());
        let is_kept = |index: &usize| (index / columns + index % columns).is_multiple_of(2);
        let (kept, held): (Vec<_>, Vec<_>) = (0..self.rows.len()).partition(is_kept);
        let [kept, held] = [kept, held]
            .map(|half| half.into_iter().map(|index| self.rows[index]).collect::<Vec<_>>());
        let from = DeviceCalibration { map: self.scattered(&kept)?, ..device.clone() };
        let calibration = from.for_profile(profile).context("with every other place held out")?;
        Ok(found(&held, &calibration))
    }
}
