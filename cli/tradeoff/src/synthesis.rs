// SPDX-License-Identifier: MIT OR Apache-2.0
//! What synthesis makes of a profile's core, beside what is estimated: `tradeoff --synth`.

use super::cost::Cost;
use anyhow::{Context, Result};
use hapticore_contract::profile::Profile;
use hapticore_synth::cells::Cells;
use hapticore_synth::flow::Flow;
use hapticore_synth::harness;
use hapticore_synth::sources::{self, File};
use hapticore_synth::target::Family;
use hapticore_synth::tools::Tools;
use serde::Serialize;
use std::path::Path;

/// A core in the cells of a family.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Synthesised {
    /// Name of the profile.
    pub profile: String,
    /// The part.
    pub part: &'static str,
    /// Estimated LUT4.
    pub estimated_luts: f64,
    /// Cells of the core alone.
    pub cells: Cells,
    /// Its clock between shift registers, placed with one seed, MHz; none where the part is too small.
    pub mhz: Option<f64>,
}

/// The seed of the placer.
const SEED: u64 = 1;

/// The tools that synthesis takes.
///
/// # Errors
/// They are not there: says what fetches them.
pub fn tools() -> Result<Tools> {
    Tools::find()
}

/// The core of a profile in the cells of both families. Needs the tools that `synth/tools` fetches;
/// takes a minute or two.
///
/// # Errors
/// Tools that are not there, or refuse the core.
pub fn synthesise(profile: &Profile, cost: &Cost) -> Result<Vec<Synthesised>> {
    let tools = tools()?;
    let folder = tempfile::tempdir().context("a folder for temporary files")?;
    let one = |family: Family| {
        let (cells, mhz) = placed(&tools, family, profile, folder.path())
            .with_context(|| format!("profile {} on {}", profile.name, family.part()))?;
        let estimated_luts = cost.luts_of(family);
        let profile = profile.name.clone();
        Ok(Synthesised { profile, part: family.part(), estimated_luts, cells, mhz })
    };
    Family::ALL.into_iter().map(one).collect()
}

fn placed(
    tools: &Tools,
    family: Family,
    profile: &Profile,
    folder: &Path,
) -> Result<(Cells, Option<f64>)> {
    let design = hapticore_rtl::header::design(profile);
    let mut files = sources::files(&design);
    let folder = folder.join(format!("{family:?}"));
    let cells =
        Flow::new(tools, family, design.top(), &files, &folder.join("bare"))?.synthesise()?;
    files.push(File { name: "harness.v".into(), text: harness::verilog(&design) });
    let flow = Flow::new(tools, family, harness::TOP, &files, &folder.join("harness"))?;
    flow.synthesise()?;
    let used = flow.packed()?;
    let fits = [used.logic, used.multipliers, used.block_rams].iter().all(|[of, all]| of <= all);
    let mhz = fits.then(|| flow.place(SEED)).transpose()?.map(|placed| placed.timing.mhz);
    Ok((cells, mhz))
}
