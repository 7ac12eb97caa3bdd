// SPDX-License-Identifier: MIT OR Apache-2.0
//! What accuracy costs.

use anyhow::Result;
use hapticore_tradeoff::outcome::{Prepared, Request};
use hapticore_tradeoff::target::Target;
use pyo3::prelude::*;

use crate::apart::apart;
use crate::failure::{self, shown};

/// The texts of a tradeoff: its rows as CSV, all of it as JSON, the profile that was found as TOML.
type Texts = (String, String, Option<String>);

/// Tries a profile and its neighbours on scenes: texts, and what a user must know. Targets are mN, % and µm.
#[pyfunction]
#[pyo3(signature = (scenes, *, profile, slots, target, family, explain))]
pub fn tradeoff(
    py: Python<'_>,
    scenes: Vec<String>,
    profile: Option<String>,
    slots: usize,
    target: Option<[Option<f64>; 3]>,
    family: Option<String>,
    explain: bool,
) -> PyResult<(Texts, Vec<String>)> {
    apart(py, || {
        scenes.iter().try_for_each(|name| failure::scene(name, &[]).map(drop))?;
        let target = target.map(Target);
        let request = Request { profile, scenes, slots, target, family, explain };
        let prepared = Prepared::new(request)?;
        let warnings = prepared.warnings.iter().map(|warning| shown(warning)).collect();
        let points = prepared.sweep(&|| ())?;
        let tradeoff = prepared.outcome(points)?;
        let texts: Result<Texts> =
            Ok((tradeoff.csv(), serde_json::to_string(&tradeoff)?, tradeoff.found_profile()?));
        Ok((texts?, warnings))
    })
}
