// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whole runs: of scenes, of captures; a calibration from a lab's data.

use std::path::PathBuf;
use std::sync::Arc;

use anyhow::Result;
use hapticore_run::case::Settings;
use hapticore_run::columns::{Columns, OfScene};
use hapticore_run::control::prediction;
use hapticore_run::lab::{self, Data};
use hapticore_run::record::{self, Record};
use hapticore_run::replay::{Plan, run as run_capture};
use hapticore_run::simulation;
use pyo3::prelude::*;

use crate::apart::apart;
use crate::failure::{self, fidelity};
use crate::rows::Rows;

/// Runs a scene: its rows, and the text of summary.json.
#[pyfunction]
#[pyo3(signature = (scene, *, set, core, case, profile, errors, unstable))]
#[expect(clippy::too_many_arguments, reason = "as Python's keywords")]
pub fn simulate(
    py: Python<'_>,
    scene: String,
    set: Vec<(String, String)>,
    core: String,
    case: Vec<String>,
    profile: Option<String>,
    errors: bool,
    unstable: bool,
) -> PyResult<(Rows, String)> {
    apart(py, || {
        let settings = Settings { fidelity: fidelity(&core)?, errors };
        let found = failure::scene(&scene, &set)?;
        let (found, profile) = simulation::prepare(found, profile.as_deref())?;
        let of = (&found, scene.as_str());
        let cases = simulation::cases(of, &case, &profile, settings.fidelity)?;
        let stability = prediction::of_cases(&cases, unstable)?;
        let (record, _) =
            simulation::run((&found, &set), (&cases, stability), &settings, None, &|| ())?;
        let columns = Arc::new(Columns::new(Some(OfScene::of(&record))));
        let summary = serde_json::to_string(&record)?;
        Ok((Rows::of_run(columns, record), summary))
    })
}

/// Replays a capture: its rows, and the text of summary.json.
#[pyfunction]
#[pyo3(signature = (capture, *, calibration, profile, core, pads, channels, bits, full_scale_v, skip, truncated))]
#[expect(clippy::too_many_arguments, reason = "as Python's keywords")]
pub fn replay(
    py: Python<'_>,
    capture: PathBuf,
    calibration: Option<PathBuf>,
    profile: Option<String>,
    core: String,
    pads: Option<u64>,
    channels: Option<Vec<String>>,
    bits: Option<u8>,
    full_scale_v: Option<f64>,
    skip: u64,
    truncated: bool,
) -> PyResult<(Rows, String)> {
    apart(py, || {
        let plan = Plan {
            capture,
            calibration,
            profile,
            fidelity: fidelity(&core)?,
            errors: false,
            reference: false,
            pads,
            channels,
            bits,
            full_scale_v,
            skip,
            truncated,
        };
        let mut rows = Vec::new();
        let mut sink = |row| -> Result<()> {
            rows.push(row);
            Ok(())
        };
        let replayed = run_capture(&plan, &mut sink, &|| ())?;
        let summary = serde_json::to_string(&replayed.record)?;
        let record = Record { rows: record::Rows::of_cases([rows]), ..replayed.record };
        Ok((Rows::of_run(Arc::new(Columns::new(None)), record), summary))
    })
}

/// Makes a calibration: its text, and what it was made from as JSON.
#[pyfunction]
#[pyo3(signature = (data, *, profile))]
pub fn calibrate(
    py: Python<'_>,
    data: Vec<PathBuf>,
    profile: String,
) -> PyResult<(String, String)> {
    apart(py, || {
        let profile = failure::profile(&profile)?;
        let (device, outcome) = lab::calibrate(&Data::read(&data)?, &profile)?;
        Ok((device.text(), serde_json::to_string(&outcome)?))
    })
}
