// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[gap]` of a scene from capacitances that were measured under loads, without voltage.
//!
//!   W/S = P(g) = κ·(g₀ − g) + p₀·e^(−g/λ),   g = ε₀S/C − d
//!
//! | column | is |
//! | --- | --- |
//! | `load_n`, or `load_g` | what presses the pad, N or g |
//! | `capacitance_pf` | between pad and film |
//! | `run` | optional: the number of a run. Each run is then predicted from the others |
//!
//! The setup names pad and insulators by their keys in a scene.

mod fit;
mod setup;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

use anyhow::{Context, Result, bail, ensure};
use hapticore_scene::EPSILON_0;
use serde::Serialize;

use super::loads::check_grams;
use super::table::{Row, Table};
use crate::record::Provenance;
use fit::{fitted, off_percent};
use setup::Setup;

/// Readings at least: of four numbers, two more.
const LEAST: usize = 6;

/// A rest so many times the largest gap is none that these gaps tell.
const FAR: f64 = 20.0;

/// What a run may be off the others' fit before that is said, RMS, %.
const RUN_PERCENT: f64 = 3.0;

/// What a fit may leave of its own capacitances before that is said, RMS, %.
const LEFT_PERCENT: f64 = 5.0;

/// A reading.
#[derive(Debug, Clone, Copy)]
struct Reading {
    pressure_pa: f64,
    gap_m: f64,
    run: f64,
}

/// Readings and the pad that they are of.
pub struct Data {
    file: String,
    setup: Setup,
    readings: Vec<Reading>,
    has_runs: bool,
}

/// How far a run is off what the others predict, RMS, %.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct RunOff {
    /// Its number.
    pub run: f64,
    /// Of its capacitances.
    pub rms_percent: f64,
}

/// A pad's rubber, and how good it is.
#[derive(Debug, Clone, Serialize)]
pub struct Outcome {
    setup: Setup,
    /// How many readings it was fitted to.
    pub readings: usize,
    /// κ, Pa/m.
    pub spring_pa_per_m: f64,
    /// g₀ + d, µm.
    pub rest_um: f64,
    /// p₀, Pa.
    pub contact_pa: f64,
    /// λ, µm.
    pub contact_decay_um: f64,
    /// What the fit leaves of the capacitances, RMS, %.
    pub rms_percent: f64,
    /// Each run by a fit to the others.
    pub runs: Vec<RunOff>,
    /// What a user must know.
    pub warnings: Vec<String>,
    #[serde(skip)]
    insulator_um: f64,
    /// Where it comes from.
    #[serde(flatten)]
    pub provenance: Provenance,
}

/// Whether a table is one of capacitances under loads.
fn is(table: &Table) -> bool {
    table.has("capacitance_pf") && !table.has("haptic_v_rms")
}

impl Data {
    /// The data of texts, each with the name of its file; none where no table is of capacitances without voltage.
    ///
    /// # Errors
    /// A file that is none of them, a column or key that is unknown, numbers that no pad has.
    pub fn of(files: &[(String, String)]) -> Result<Option<Data>> {
        let is_setup = |file: &str| file.to_lowercase().ends_with(".toml");
        let tables = files.iter().filter(|(file, _)| !is_setup(file));
        let tables: Vec<Table> =
            tables.map(|(file, text)| Table::parse(text, file)).collect::<Result<_>>()?;
        if !tables.iter().any(is) {
            return Ok(None);
        }
        let [table] = &tables[..] else {
            bail!("DATA: expected one file of capacitances under loads, got {}", tables.len());
        };
        let mut setups = files.iter().filter(|(file, _)| is_setup(file));
        let setup = setups.next().map(|(file, text)| Setup::parse(text, file)).transpose()?;
        ensure!(setups.next().is_none(), "DATA: expected one setup, got two");
        Data::read(table, setup.unwrap_or_default()).map(Some)
    }

    fn read(table: &Table, setup: Setup) -> Result<Data> {
        let file = table.file.clone();
        let [grams, newtons] = ["load_g", "load_n"].map(|name| table.has(name));
        ensure!(grams != newtons, "{file}:1: expected a column load_g or load_n");
        table.only(&["load_g", "load_n", "capacitance_pf", "run"])?;
        let load = table.column(if grams { "load_g" } else { "load_n" })?;
        if grams {
            check_grams(&file, table.rows().iter().map(|row| row.at(load)))?;
        }
        let newton = if grams { 1e-3 * setup.device.gravity_m_s2 } else { 1.0 };
        let (picofarad, run) = (table.column("capacitance_pf")?, table.column("run").ok());
        let reading = |row: &Row| {
            let (load_n, pf) = (newton * row.at(load), row.at(picofarad));
            let most_pf = 1e12 * EPSILON_0 * setup.area_m2() / setup.insulator_m();
            let at = format!("{file}:{}", row.line);
            let loads = 1e-9..1e6;
            ensure!(
                loads.contains(&load_n),
                "{at}: expected a load above 0, in N or g, got {load_n} N"
            );
            ensure!(
                0.0 < pf && pf < most_pf,
                "{at}: capacitance_pf: expected a number from 0 to {most_pf:.1}, that of the insulators alone, got {pf}; \
                 device.pad_diameter_mm and gap.insulator_um decide it"
            );
            let gap_m = EPSILON_0 * setup.area_m2() / (1e-12 * pf) - setup.insulator_m();
            let pressure_pa = load_n / setup.area_m2();
            Ok(Reading { pressure_pa, gap_m, run: run.map_or(0.0, |run| row.at(run)) })
        };
        let readings: Vec<Reading> = table.rows().iter().map(reading).collect::<Result<_>>()?;
        ensure!(
            readings.len() >= LEAST,
            "{file}: expected {LEAST} readings at least, got {}",
            readings.len()
        );
        Ok(Data { file, setup, readings, has_runs: run.is_some() })
    }

    /// The rubber of these readings.
    ///
    /// # Errors
    /// Readings that no rubber has.
    pub fn fit(&self) -> Result<Outcome> {
        let insulator_m = self.setup.insulator_m();
        let found = fitted(&self.readings, insulator_m).with_context(|| {
            format!("{}: expected a capacitance that rises with the load, less and less", self.file)
        })?;
        let runs = self.runs(insulator_m);
        let largest_m = self.readings.iter().map(|of| of.gap_m).fold(0.0, f64::max);
        let constant = (found.rest_m > FAR * largest_m).then(|| {
            let pressure_pa = found.spring_pa_per_m * found.rest_m;
            format!(
                "over these gaps the spring is a constant pressure of {pressure_pa:.3e} Pa: κ and the rest are known by their \
                 product alone; measure at smaller loads, too"
            )
        });
        let rms_percent = off_percent(&found, &self.readings, insulator_m);
        let poor = (rms_percent > LEFT_PERCENT).then(|| {
            format!("one patch leaves {rms_percent:.1} % RMS of the capacitances: it does not describe this pad")
        });
        let differ = runs.iter().filter(|of| of.rms_percent > RUN_PERCENT).map(|of| {
            format!(
                "run {} is {:.1} % RMS off what the others predict: runs differ by more than {RUN_PERCENT} %",
                of.run, of.rms_percent
            )
        });
        Ok(Outcome {
            setup: self.setup.clone(),
            readings: self.readings.len(),
            spring_pa_per_m: found.spring_pa_per_m,
            rest_um: 1e6 * (found.rest_m + insulator_m),
            contact_pa: found.contact_pa,
            contact_decay_um: 1e6 * found.contact_decay_m,
            rms_percent,
            warnings: differ.chain(poor).chain(constant).collect(),
            runs,
            insulator_um: 1e6 * insulator_m,
            provenance: Provenance::new(),
        })
    }

    /// Each run by a fit to the others, where there are several.
    fn runs(&self, insulator_m: f64) -> Vec<RunOff> {
        let numbers: BTreeSet<u64> = self.readings.iter().map(|of| of.run.to_bits()).collect();
        if !self.has_runs || numbers.len() < 2 {
            return Vec::new();
        }
        let of = |bits: &u64| {
            let (own, others): (Vec<_>, Vec<_>) =
                self.readings.iter().partition(|of| of.run.to_bits() == *bits);
            let found = fitted(&others, insulator_m)?;
            let rms_percent = off_percent(&found, &own, insulator_m);
            Some(RunOff { run: f64::from_bits(*bits), rms_percent })
        };
        numbers.iter().filter_map(of).collect()
    }
}

impl Outcome {
    /// Its results, a line each.
    pub fn lines(&self) -> Vec<String> {
        let mut lines = vec![format!(
            "gap: κ = {:.4e} Pa/m, rest {:.4} µm, p0 = {:.4e} Pa, λ = {:.4} µm; leaves {:.2} % RMS of {} capacitances",
            self.spring_pa_per_m,
            self.rest_um,
            self.contact_pa,
            self.contact_decay_um,
            self.rms_percent,
            self.readings
        )];
        lines.extend(
            self.runs.iter().map(|of| {
                format!("run {}: {:.2} % RMS off the others' fit", of.run, of.rms_percent)
            }),
        );
        lines
    }

    /// The tables of a scene.
    pub fn text(&self) -> String {
        let Setup { device, gap } = &self.setup;
        let mut text = format!(
            "[device]\npad_diameter_mm = {:?}\n\n[gap]\ninsulator_um = {:?}\ninsulator_permittivity = {:?}\n\
             rest_um = [{:.5e}]\nspring_pa_per_m = {:.5e}\ncontact_pa = {:.5e}\ncontact_decay_um = {:.5e}\n",
            device.pad_diameter_mm,
            gap.insulator_um,
            gap.insulator_permittivity,
            self.rest_um,
            self.spring_pa_per_m,
            self.contact_pa,
            self.contact_decay_um
        );
        if self.contact_decay_um > 0.5 * self.insulator_um {
            text += "# The contact decays over more than half of the insulators: any hardness makes a scene follow the gap in steps. \
                     Such a one that nothing touches.\ncontact_hardness_pa = 1e15\n";
        }
        text
    }
}
