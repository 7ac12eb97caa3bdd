// SPDX-License-Identifier: MIT OR Apache-2.0
//! Loads: friction under known loads and voltages, from which come k of eq. 8 and, where the
//! capacitance was measured otherwise, too, the scale of the currents.
//!
//!   F = k·(C·V)²                          from `force_n`, or from `friction_n` less μ·m·g where μ is known
//!   friction = k·(C·V)² + μ·m·g           where μ is not: both are fitted
//!   C_reference = s·|I|/(ω·√(v² − |I|²·R²))
//!
//! | columns | are |
//! | --- | --- |
//! | `haptic_v_rms` | the haptic voltage at the pad, V rms |
//! | `force_n`, or `friction_n` and `load_g` | the haptic force, the increment of friction, N; or all of the friction, and the load, g |
//! | `capacitance_pf` | measured otherwise, by a bridge |
//! | `i_total` or `i1` … `iN`, `v_sense` | amplitudes as for places, of the sum or of each terminal |
//! | `x_mm`, `y_mm` | where the pad is; the sheet's middle without them |
//! | `time_s` | since the voltage was switched on, of a step or of a rise and fall; −1 of settled readings. With it a force table is fitted, too |

use std::f64::consts::TAU;

use anyhow::{Result, anyhow, bail, ensure};
use hapticore_host::device::Force as ForceTable;
use serde::Serialize;

use super::force_table::{self, Reading};
use super::least_squares::{Estimate, Fit, Unfit};
use super::setup::Setup;
use super::table::{Row, Table};

/// Grams to kilograms.
const KILO: f64 = 1e-3;

/// Picofarads to farads.
const PICO: f64 = 1e-12;

/// Readings of a force table at least.
const TABLE_READINGS: usize = 60;

/// Loads that are all lighter are in kilograms, g.
const LIGHTEST_G: f64 = 1.0;

/// Loads beyond this are in milligrams, g.
const HEAVIEST_G: f64 = 1e4;

/// (C·V)² whose least and largest differ by less than this share tell no k.
const ALIKE: f64 = 0.02;

/// A measurement under a load.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Load {
    /// Haptic voltage at the pad, V RMS.
    pub haptic_v_rms: f64,
    /// The force, or the friction.
    pub newtons: f64,
    /// What lies on the pad, where it was told.
    pub load_g: Option<f64>,
    /// Capacitance measured with a bridge, pF.
    pub reference_pf: Option<f64>,
    /// From the currents, with the full scale of the setup.
    pub sensed_pf: Option<f64>,
    /// Since the voltage was switched on, in a record of a step; none of a settled reading.
    pub time_s: Option<f64>,
}

/// The measurements of a file.
#[derive(Debug, Clone)]
pub struct Loads {
    /// Name of the file, for messages.
    pub file: String,
    /// Measurements, one per row.
    pub loads: Vec<Load>,
    /// Whether `newtons` are all of the friction.
    pub friction: bool,
    /// Whether there are times, so that a force table is asked for.
    pub timed: bool,
}

/// What follows from loads.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Force {
    /// k of eq. 8, N/(F·V)².
    pub force_k: Estimate,
    /// The coefficient of friction, where it was fitted.
    pub mu: Option<Estimate>,
    /// What the currents' full scale is to be multiplied by, where both capacitances were measured.
    pub current_scale: Option<Estimate>,
    /// The standard deviation of a measurement's noise, N, by the residuals.
    pub noise_n: f64,
    /// Data points of the fit.
    #[serde(skip)]
    pub points: Vec<Point>,
    /// The force table, where step records were measured, too.
    #[serde(skip)]
    pub table: Option<ForceTable>,
    /// What the table leaves of its own readings, N (largest, rms); likewise eq. 8.
    pub table_residual_n: Option<[[f64; 2]; 2]>,
}

/// A measurement as eq. 8 has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Regressor (C·V)², in (F·V)².
    pub square: f64,
    /// Less the friction without voltage.
    pub force_n: f64,
    /// Measured force minus eq. 8, N.
    pub residual_n: f64,
    /// Haptic voltage at the pad, V RMS.
    pub haptic_v_rms: f64,
    /// What lies on the pad.
    pub load_g: Option<f64>,
}

/// Refuses loads of a file that are in kilograms, which are below a gram, or in milligrams.
///
/// # Errors
/// They are; the message names the unit.
pub(super) fn check_grams(file: &str, loads: impl Iterator<Item = f64>) -> Result<()> {
    let loads = loads.filter(|load| *load > 0.0);
    let (least, most) = loads.fold((f64::INFINITY, 0.0), |(low, high), load| {
        (f64::min(low, load), f64::max(high, load))
    });
    let unit = match most {
        0.0 => return Ok(()),
        ..LIGHTEST_G => "kilograms",
        HEAVIEST_G.. => "milligrams",
        _ => return Ok(()),
    };
    bail!(
        "{file}: load_g: the loads are in {unit}: they run from {least} to {most}; expected grams, such as 20 and 100"
    );
}

/// Whether a table is one of loads.
pub fn is(table: &Table) -> bool {
    table.has("haptic_v_rms")
}

impl Loads {
    /// The measurements of a table; `sheet_ohm` is the sheet's resistance at a place.
    ///
    /// # Errors
    /// Columns or numbers that are not as above.
    pub fn of(table: &Table, setup: &Setup, sheet_ohm: impl Fn([f64; 2]) -> f64) -> Result<Loads> {
        let optional = |name: &str| table.has(name).then(|| table.column(name)).transpose();
        let (force, friction) = (optional("force_n")?, optional("friction_n")?);
        let load = optional("load_g")?;
        let newtons = match (force, friction, load) {
            (Some(force), None, _) => force,
            (None, Some(friction), Some(_)) => friction,
            (None, Some(_), None) => bail!(
                "{}:1: expected a column load_g with friction_n: what friction would be without voltage is not known",
                table.file
            ),
            (Some(_), Some(_), _) => {
                bail!("{}:1: expected force_n or friction_n, got both", table.file)
            }
            (None, None, _) => {
                bail!("{}:1: expected a column force_n, or friction_n and load_g", table.file)
            }
        };
        let haptic = table.column("haptic_v_rms")?;
        let reference = optional("capacitance_pf")?;
        let time = optional("time_s")?;
        let sensed = Sensed::of(table)?;
        ensure!(
            reference.is_some() || sensed.is_some(),
            "{}:1: expected a column capacitance_pf, or i_total (or i1 …) and v_sense",
            table.file
        );
        let measurement = |row: &Row| {
            let negative = [(haptic, "haptic_v_rms")]
                .into_iter()
                .chain(load.map(|column| (column, "load_g")))
                .find(|(column, _)| row.at(*column) < 0.0);
            if let Some((column, name)) = negative {
                bail!(
                    "{}:{}: {name}: expected a number not below 0, got {}",
                    table.file,
                    row.line,
                    row.at(column)
                );
            }
            Ok(Load {
                haptic_v_rms: row.at(haptic),
                newtons: row.at(newtons),
                load_g: load.map(|column| row.at(column)),
                reference_pf: reference.map(|column| row.at(column)),
                sensed_pf: sensed
                    .as_ref()
                    .map(|sensed| sensed.capacitance_pf(table, row, setup, &sheet_ohm))
                    .transpose()?,
                time_s: time.map(|column| row.at(column)).filter(|time_s| *time_s >= 0.0),
            })
        };
        let loads = table.rows().iter().map(measurement).collect::<Result<_>>()?;
        let timed = time.is_some();
        Ok(Loads { file: table.file.clone(), loads, friction: force.is_none(), timed })
    }

    /// k, and what else they tell.
    ///
    /// # Errors
    /// Data that do not tell it, with what is missing.
    pub fn fit(&self, setup: &Setup) -> Result<Force> {
        self.check(setup)?;
        let current_scale = self.current_scale()?;
        let scale = current_scale.map_or(1.0, |scale| scale.value);
        let capacitance_f = |load: &Load| {
            PICO * load.sensed_pf.map_or(load.reference_pf.unwrap_or(0.0), |pf| pf * scale)
        };
        let square = |load: &Load| (capacitance_f(load) * load.haptic_v_rms).powi(2);
        let weight = |load: &Load| load.load_g.map_or(0.0, |load| KILO * load * setup.gravity_m_s2);
        let squares: Vec<_> = self.loads.iter().map(square).collect();
        self.check_squares(&squares)?;
        let (force_k, mu, residuals, noise_n) = if self.friction && setup.mu.is_none() {
            let rows: Vec<_> = self
                .loads
                .iter()
                .map(|load| ([square(load), weight(load)], load.newtons))
                .collect();
            let Fit { estimates: [k, mu], residuals, noise } =
                Fit::of(&rows).map_err(|why| self.unfit(why))?;
            (k, Some(mu), residuals, noise)
        } else {
            let mu = if self.friction { setup.mu.unwrap_or(0.0) } else { 0.0 };
            let rows: Vec<_> = self
                .loads
                .iter()
                .map(|load| ([square(load)], load.newtons - mu * weight(load)))
                .collect();
            let Fit { estimates: [k], residuals, noise } =
                Fit::of(&rows).map_err(|why| self.unfit(why))?;
            (k, None, residuals, noise)
        };
        let [low, high] = force_k.interval;
        ensure!(
            low > 0.0,
            "{}: the force does not rise with (C·V)²: force_k = {:.3e} N/(F·V)², 95 %: {low:.3e} to {high:.3e}, which holds 0: expected higher voltages, or more measurements",
            self.file,
            force_k.value
        );
        let point = |((load, &square), &residual_n): ((&Load, &f64), &f64)| Point {
            square,
            force_n: force_k.value * square + residual_n,
            residual_n,
            haptic_v_rms: load.haptic_v_rms,
            load_g: load.load_g,
        };
        let points = self.loads.iter().zip(&squares).zip(&residuals).map(point).collect();
        let friction = mu.map_or(setup.mu, |mu| Some(mu.value)).filter(|_| self.friction);
        let reading = |load: &Load| {
            let force_n = load.newtons - friction.unwrap_or(0.0) * weight(load);
            (load.time_s, [capacitance_f(load) / PICO, load.haptic_v_rms, force_n])
        };
        let readings = force_table::follow(&self.loads.iter().map(reading).collect::<Vec<_>>());
        let table = self.timed.then(|| self.table(&readings, force_k.value)).transpose()?;
        let table_residual_n =
            table.as_ref().map(|table| force_table::residuals(&readings, force_k.value, table));
        Ok(Force { force_k, mu, current_scale, noise_n, points, table, table_residual_n })
    }

    /// The force table of readings, multiples of k.
    fn table(&self, readings: &[Reading], force_k: f64) -> Result<ForceTable> {
        let count = readings.len();
        ensure!(
            count >= TABLE_READINGS,
            "{}: time_s: expected {TABLE_READINGS} readings at least for a force table, better 510, got {count}",
            self.file
        );
        Ok(force_table::fit(readings, force_k))
    }

    fn check(&self, setup: &Setup) -> Result<()> {
        let (file, count) = (&self.file, self.loads.len());
        let least = if self.friction && setup.mu.is_none() { 4 } else { 3 };
        ensure!(
            count >= least,
            "{file}: too few measurements: expected {least} at least, better 10 or more, got {count}"
        );
        ensure!(
            self.loads.iter().any(|load| load.haptic_v_rms > 0.0),
            "{file}: haptic_v_rms: all are 0: force_k is seen with voltage only; expected several, up to the highest that is used"
        );
        check_grams(&self.file, self.loads.iter().filter_map(|load| load.load_g))?;
        if let Some(first) = self.loads[0].load_g {
            let alike = self
                .loads
                .iter()
                .all(|load| load.load_g.is_some_and(|load| (load - first).abs() <= ALIKE * first));
            let needs = if self.friction && setup.mu.is_none() {
                "they do not tell friction from load, and "
            } else {
                ""
            };
            ensure!(
                !alike,
                "{file}: load_g: all loads are alike ({first} g): {needs}k of one load need not be that of others; expected two loads at least, such as 20 g and 100 g"
            );
        }
        Ok(())
    }

    fn check_squares(&self, squares: &[f64]) -> Result<()> {
        let most = squares.iter().copied().fold(0.0, f64::max);
        let least = squares.iter().copied().fold(f64::INFINITY, f64::min);
        ensure!(most > 0.0, "{}: capacitance_pf: all are 0", self.file);
        ensure!(
            most - least > ALIKE * most,
            "{}: (C·V)² is the same in all measurements, so that any error of the force's zero goes into force_k; expected several voltages, 0 among them",
            self.file
        );
        Ok(())
    }

    /// What the currents' full scale is to be multiplied by.
    fn current_scale(&self) -> Result<Option<Estimate>> {
        let rows: Option<Vec<_>> =
            self.loads.iter().map(|load| Some(([load.sensed_pf?], load.reference_pf?))).collect();
        let fit = rows.map(|rows| Fit::of(&rows).map_err(|why| self.unfit(why))).transpose()?;
        Ok(fit.map(|fit| fit.estimates[0]))
    }

    fn unfit(&self, why: Unfit) -> anyhow::Error {
        match why {
            Unfit::Few(least) => {
                anyhow!("{}: too few measurements: expected {least} at least", self.file)
            }
            Unfit::Zero(0) => anyhow!("{}: capacitances are all 0", self.file),
            Unfit::Zero(_) => {
                anyhow!("{}: load_g: all are 0: they do not tell friction from load", self.file)
            }
            Unfit::Alike => anyhow!(
                "{}: load_g and (C·V)² rise together: they do not tell μ from force_k; expected several voltages under each load, or mu in the setup",
                self.file
            ),
        }
    }
}

/// Where currents and the sensing voltage are.
struct Sensed {
    currents: Vec<usize>,
    sense: usize,
    place: Option<[usize; 2]>,
}

impl Sensed {
    fn of(table: &Table) -> Result<Option<Sensed>> {
        let terminals = table.count("i", "");
        if terminals == 0 && !table.has("i_total") {
            return Ok(None);
        }
        let names = if table.has("i_total") {
            vec!["i_total".into()]
        } else {
            (1..=terminals).map(|k| format!("i{k}")).collect()
        };
        let place = (table.has("x_mm") && table.has("y_mm"))
            .then(|| Ok::<_, anyhow::Error>([table.column("x_mm")?, table.column("y_mm")?]));
        let currents =
            names.iter().map(|name: &String| table.column(name)).collect::<Result<_>>()?;
        Ok(Some(Sensed { currents, sense: table.column("v_sense")?, place: place.transpose()? }))
    }

    fn capacitance_pf(
        &self,
        table: &Table,
        row: &Row,
        setup: &Setup,
        sheet_ohm: &impl Fn([f64; 2]) -> f64,
    ) -> Result<f64> {
        let current: f64 = self.currents.iter().map(|column| row.at(*column)).sum();
        let drop = current
            * sheet_ohm(self.place.map_or([0.0; 2], |place| place.map(|column| row.at(column))));
        let sense = row.at(self.sense);
        ensure!(
            current >= 0.0 && sense > drop.abs(),
            "{}:{}: v_sense: expected more than the current drops across the sheet, {drop:.3} V, got {sense}",
            table.file,
            row.line
        );
        Ok(current / (TAU * setup.carrier_hz * (sense * sense - drop * drop).sqrt()) / PICO)
    }
}
