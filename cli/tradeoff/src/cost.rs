// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a profile's core costs, with its controller where it has one: time from the core's latency, area from
//! the netlist.

use anyhow::Result;
use hapticore_contract::profile::Profile;
use hapticore_hdl::area::Operations;
use hapticore_model::blocks::core::Core;
pub use hapticore_rtl::netlist::of_profile as netlist;
pub use hapticore_synth::target::Family;
use serde::{Deserialize, Serialize};

/// Time and area of a core.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cost {
    /// From the strobe of a window's last sample to the frame's last word, clocks.
    pub latency_clocks: u64,
    /// From the middle of a slot's window to its frame, µs: how old a result is, at a megasample per
    /// second.
    pub age_us: f64,
    /// A pad's frames per second, at a megasample per second.
    pub frames_per_second: f64,
    /// LUT4 of an ECP5, estimated.
    pub luts: f64,
    /// LUT4 of an iCE40, estimated.
    pub luts_ice40: f64,
    /// Bits of registers in the netlist, of which synthesis makes [`Cost::flip_flops_of`].
    pub flip_flops: f64,
    /// Multipliers of 18 × 18, as an ECP5 has.
    pub multipliers: f64,
    /// Multipliers of 16 × 16, as an iCE40 has.
    pub multipliers_ice40: f64,
    /// Bits of memories.
    pub memory_bits: f64,
    /// Block RAMs of 18 kbit, as an ECP5 has.
    pub block_rams: f64,
    /// Block RAMs of 4 kbit, as an iCE40 has.
    pub block_rams_ice40: f64,
}

impl Cost {
    /// Estimated LUT4 of a family.
    pub fn luts_of(&self, family: Family) -> f64 {
        match family {
            Family::Ecp5 => self.luts,
            Family::Ice40 => self.luts_ice40,
        }
    }

    /// Estimated flip-flops of a family.
    pub fn flip_flops_of(&self, family: Family) -> f64 {
        let [per_bit, every] = FLIP_FLOPS[usize::from(family == Family::Ice40)];
        per_bit * self.flip_flops + every
    }
}

/// Flip-flops by bits of registers, and those of every core, on ECP5 and on iCE40: fitted to half of the cores that [`LUTS`] are judged
/// on. Multipliers and block RAMs of an iCE40 take some registers in.
const FLIP_FLOPS: [[f64; 2]; 2] = [[1.006, 71.7], [0.791, 102.8]];

/// The family that a profile is for: that with multipliers as wide as it says.
pub fn family(profile: &Profile) -> Family {
    if profile.multiplier <= 16 { Family::Ice40 } else { Family::Ecp5 }
}

/// The family of a name.
pub fn named(name: &str) -> Option<Family> {
    Family::ALL.into_iter().find(|family| family.name() == name)
}

/// Samples per second of the nominal board (docs/decisions.md §14).
const SAMPLE_HZ: f64 = 1e6;

/// LUT4 by bits of adders and of selections, and those of every core, on ECP5 and on iCE40: fitted to
/// what synthesis made of profiles (docs/tradeoff.md; `tests/area.rs` judges it). Adders of an ECP5 lie
/// in its carry cells, and take logic with them.
const LUTS: [[f64; 3]; 2] = [[-0.191, 0.246, 780.0], [0.955, 0.218, 612.0]];

fn luts(of: &Operations, [adders, selects, every]: [f64; 3]) -> f64 {
    adders * of.adders + selects * of.selects + every
}

/// LUT4 of an ECP5 by bits of selections beyond a core: fitted to the force loops of `standard`, whose controller alone
/// takes 0.46. A controller and walls do not have once more what every core has, and a price of adders that is below zero
/// does not hold for their comparisons.
const BEYOND_A_CORE: f64 = 0.40;

/// LUT4 of an iCE40 beyond a core, over those of the lines of cores: fitted to the force loops of `small`, which those lines
/// estimate 7 to 10 % too low.
const BEYOND_A_CORE_ICE40: f64 = 1.15;

/// LUT4 of an ECP5 and of an iCE40: those of the core, and of what is around it.
fn luts_of_families(profile: &Profile, whole: &Operations) -> Result<[f64; 2]> {
    if profile.control.is_none() {
        return Ok(LUTS.map(|of| luts(whole, of)));
    }
    let alone = Profile { control: None, wall: None, ..profile.clone() };
    let core = Operations::of(&netlist(&alone)?);
    let ecp5 = luts(&core, LUTS[0]) + BEYOND_A_CORE * (whole.selects - core.selects);
    let [core, all] = [luts(&core, LUTS[1]), luts(whole, LUTS[1])];
    Ok([ecp5, core + BEYOND_A_CORE_ICE40 * (all - core)])
}

/// What a profile's core costs.
///
/// # Errors
/// A core that cannot be.
pub fn cost(profile: &Profile) -> Result<Cost> {
    let operations = Operations::of(&netlist(profile)?);
    let [luts, luts_ice40] = luts_of_families(profile, &operations)?;
    let latency_clocks = Core::try_new(profile)?.latency();
    let sample_s = 1.0 / SAMPLE_HZ;
    let clock_s = sample_s / profile.clocks_per_sample as f64;
    let window_s = profile.slot.integrate as f64 * sample_s;
    let slot_s = profile.slot.samples() as f64 * sample_s;
    Ok(Cost {
        latency_clocks,
        age_us: 1e6 * (0.5 * window_s + latency_clocks as f64 * clock_s),
        frames_per_second: 1.0 / (slot_s * profile.pads as f64),
        luts,
        luts_ice40,
        flip_flops: operations.flip_flops,
        multipliers: operations.multipliers[1],
        multipliers_ice40: operations.multipliers[0],
        memory_bits: operations.memory_bits,
        block_rams: operations.block_rams[1],
        block_rams_ice40: operations.block_rams[0],
    })
}
