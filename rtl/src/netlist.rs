// SPDX-License-Identifier: MIT OR Apache-2.0
//! Netlists of whole designs, and what is read off them. [`Netlist::of`] is generic, and each crate that elaborates a core with
//! it compiles all blocks once more, for ten seconds and longer; these are compiled here.

use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::interpretations::netlist::Netlist;
use hapticore_hdl::probe::Signals;
use hapticore_hdl::verilog::dump;
use hapticore_model::blocks::core::Core;
use hapticore_model::blocks::force_loop::ForceLoop;

#[cfg(feature = "boards")]
use crate::board::Board;

/// The netlist of a core.
///
/// # Panics
/// As [`Netlist::of`] does; so do the others.
pub fn of_core(core: &Core) -> Netlist {
    Netlist::of(core)
}

/// The netlist of a core with its force controller.
pub fn of_force_loop(force_loop: &ForceLoop) -> Netlist {
    Netlist::of(force_loop)
}

/// The netlist of a profile's core, with its force controller where it has one.
///
/// # Errors
/// A core or controller that cannot be.
pub fn of_profile(profile: &Profile) -> Result<Netlist, ProfileError> {
    Ok(match profile.control {
        Some(_) => of_force_loop(&ForceLoop::try_new(profile)?),
        None => of_core(&Core::try_new(profile)?),
    })
}

/// What waves of a [`ClockSimulation`](hapticore_model::fidelity::clock::ClockSimulation) show.
pub fn signals_of_core(core: &Core) -> Signals {
    dump::signals(core, &["bench", "core"])
}

/// What waves of a [`ClockLoop`](hapticore_model::fidelity::force_loop::ClockLoop) show.
pub fn signals_of_force_loop(force_loop: &ForceLoop) -> Signals {
    dump::signals(force_loop, &["bench", "force_loop"])
}

/// The netlist of a board.
#[cfg(feature = "boards")]
pub fn of_board(board: &Board) -> Netlist {
    Netlist::of(board)
}
