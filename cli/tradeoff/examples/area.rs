// SPDX-License-Identifier: MIT OR Apache-2.0
//! Operations of profiles' cores as CSV, to fit LUTs to: `area [PROFILE.toml]…`, else of the bundled
//! profiles.

use hapticore_contract::profile::Profile;
use hapticore_hdl::area::Operations;
use hapticore_hdl::interpretations::netlist::Netlist;
use hapticore_model::blocks::core::Core;
use hapticore_run::inputs;

fn main() -> anyhow::Result<()> {
    let files: Vec<String> = std::env::args().skip(1).collect();
    let profiles = match files.is_empty() {
        true => Profile::all(),
        false => files.iter().map(|file| inputs::profile(file)).collect::<Result<_, _>>()?,
    };
    println!(
        "profile,flip_flops,adders,selects,equals,gates,fits,memory_bits,products_16,products_18"
    );
    for profile in profiles {
        let of = Operations::of(&Netlist::of(&Core::try_new(&profile)?));
        let [by_16, by_18] = of.products;
        println!(
            "{},{},{},{},{},{},{},{},{by_16},{by_18}",
            profile.name,
            of.flip_flops,
            of.adders,
            of.selects,
            of.equals,
            of.gates,
            of.fits,
            of.memory_bits
        );
    }
    Ok(())
}
