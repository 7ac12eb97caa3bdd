// SPDX-License-Identifier: MIT OR Apache-2.0
//! What synthesis makes of random profiles' cores, beside what their netlists are made of, as CSV:
//! `area [RUNS] > synthesised.csv`. Needs what synth/tools fetches; about a quarter of a minute a run.
//!
//! `tests/area.rs` compares the estimates with the file that is kept beside it.

use anyhow::Result;
use hapticore_contract::profile::Profile;
use hapticore_hdl::area::Operations;
use hapticore_rtl::netlist::of_profile;
use hapticore_synth::cells::Cells;
use hapticore_synth::flow::Flow;
use hapticore_synth::sources;
use hapticore_synth::target::Family;
use hapticore_synth::tools::Tools;
use hapticore_tradeoff::knobs::Knob;

/// Bundled profiles that random ones are made of.
const BASES: [&str; 2] = ["standard", "small"];

fn main() -> Result<()> {
    let runs: usize = std::env::args().nth(1).map_or(Ok(100), |runs| runs.parse())?;
    let tools = Tools::find()?;
    let knobs: Vec<&str> = Knob::words().map(Knob::key).collect();
    println!(
        "family,base,{},adders,selects,luts,carries,registers,multipliers,block_rams,lut_rams",
        knobs.join(",")
    );
    let mut random = fastrand::Rng::with_seed(1);
    for run in 0..runs {
        let (base, family) = (BASES[run / 2 % 2], Family::ALL[run % 2]);
        let profile = random_profile(&Profile::bundled(base)?, &mut random);
        let cells = synthesise(&tools, family, &profile)?;
        let of = Operations::of(&of_profile(&profile)?);
        let bits: Vec<String> =
            Knob::words().map(|knob| knob.value(&profile).to_string()).collect();
        let Cells { luts, carries, registers, multipliers, block_rams, lut_rams } = cells;
        println!(
            "{family:?},{base},{},{},{},{luts},{carries},{registers},{multipliers},{block_rams},{lut_rams}",
            bits.join(","),
            of.adders,
            of.selects
        );
    }
    Ok(())
}

/// A profile with words of other lengths.
fn random_profile(base: &Profile, random: &mut fastrand::Rng) -> Profile {
    Knob::words().fold(base.clone(), |profile, knob| {
        let bits = knob.value(&profile).saturating_add_signed(random.i64(-6..=2));
        knob.set(&profile, bits).unwrap_or(profile)
    })
}

fn synthesise(tools: &Tools, family: Family, profile: &Profile) -> Result<Cells> {
    let folder = tempfile::tempdir()?;
    let design = hapticore_rtl::header::design(profile);
    Flow::new(tools, family, design.top(), &sources::files(&design), folder.path())?.synthesise()
}
