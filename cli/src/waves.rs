// SPDX-License-Identifier: MIT OR Apache-2.0
//! Waveforms of a case: the core stepped clock by clock through a window, beside the plant's truth.
//!
//! The window is a run of its own: the core that makes the frames is never altered by being looked at. It begins with the slot
//! that the window begins in, or a rotation of the pads before it; what the core holds of earlier invalid slots is not there.

use std::ops::Range;
use std::path::Path;

use anyhow::{Result, bail};
use hapticore_model::fidelity::clock::ClockSimulation;
use hapticore_scene::Truth;
use hapticore_waveforms::declarations::TruthVariable;
use hapticore_waveforms::gtkwave;
use hapticore_waveforms::timebase::Timebase;
use hapticore_waveforms::tracer::{Settings, Tracer};
use hapticore_waveforms::view::View;
use hapticore_waveforms::wave::{Kind, Wave};

use crate::case::{Case, Maker};
use crate::engine::Signals;
use crate::interrupt;

/// Slots traced where no window is named.
const SLOTS: u64 = 2;

/// The truth beside the core's signals: name, unit, value.
type Known = (&'static str, &'static str, fn(&Truth) -> f64);

const TRUTH: [Known; 9] = [
    ("r_x", "", |truth| truth.r_x),
    ("r_y", "", |truth| truth.r_y),
    ("x_mm", "mm", |truth| truth.x_mm),
    ("y_mm", "mm", |truth| truth.y_mm),
    ("capacitance_pf", "pF", |truth| truth.capacitance_pf),
    ("sheet_ohm", "Ohm", |truth| truth.sheet_ohm),
    ("haptic_v_rms", "V", |truth| truth.haptic_v_rms),
    ("force_n", "N", |truth| truth.force_n),
    ("load_g", "g", |truth| truth.load_g),
];

/// Writes `waves.vcd` or `waves.fst` and `waves.gtkw` into `folder`: the window in seconds, the first slots where none is named.
///
/// # Errors
/// A window in which the case has no slot, a file that cannot be written, an interruption.
pub fn trace(case: &Case, kind: Kind, window: Option<&Range<f64>>, folder: &Path) -> Result<()> {
    let profile = &case.profile;
    let clock_hz = case.device.device.sample_rate_hz * profile.clocks_per_sample as f64;
    let clocks = clocks(case, window, clock_hz);
    let pads = profile.pads;
    let first = clocks.start / profile.slot_clocks() / pads * pads;
    let end = clocks.end.div_ceil(profile.slot_clocks()).min(case.slots as u64);
    if first >= end {
        bail!("--waves-window: expected a window within the case's {} s", case.seconds());
    }
    let mut maker = Maker::new(case.plant()?, profile, true, true);
    let mut core = ClockSimulation::new(profile, &case.device.of(profile)?);
    let settings =
        Settings { timebase: Timebase::of_clock(clock_hz.round() as u64)?, window: Some(clocks), clock_wire: false };
    let truth = TRUTH.map(|(name, unit, _)| TruthVariable::new(name, unit));
    let name = format!("waves.{}", kind.extension());
    let mut tracer = Tracer::new(kind.create(&folder.join(&name))?, &core, &truth, &settings)?;
    tracer.skip(first * profile.slot_clocks());
    // Effects may have a state: slots are asked for in rising order.
    for slot in 0..end {
        let truth = maker.plant().truth(slot as usize);
        if slot >= first {
            interrupt::check()?;
            TRUTH.iter().enumerate().for_each(|(index, (_, _, of))| tracer.set_truth(index, of(&truth)));
            if let (Signals::Samples { codes, .. }, _) = maker.sample(slot as usize) {
                step(&mut core, &mut tracer, &codes, profile.channels())?;
            }
        }
    }
    let trace = tracer.finish()?;
    Ok(gtkwave::save(&View::bundled("slot")?, &trace, &name, &folder.join("waves.gtkw"))?)
}

/// The clocks to trace: by default the first slots and as much of the next as it takes for their frames to be there.
fn clocks(case: &Case, window: Option<&Range<f64>>, clock_hz: f64) -> Range<u64> {
    let profile = &case.profile;
    match window {
        Some(seconds) => (seconds.start * clock_hz).floor() as u64..(seconds.end * clock_hz).ceil() as u64,
        None => 0..SLOTS * profile.slot_clocks() + profile.slot.blanking() * profile.clocks_per_sample,
    }
}

fn step<W: Wave>(core: &mut ClockSimulation, tracer: &mut Tracer<W>, codes: &[i32], channels: usize) -> Result<()> {
    let mut outcome = Ok(());
    for codes in codes.chunks_exact(channels) {
        core.sample_with(codes, |core| {
            if outcome.is_ok() {
                outcome = tracer.clock(core);
            }
        });
    }
    Ok(outcome?)
}
