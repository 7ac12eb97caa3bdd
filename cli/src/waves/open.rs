// SPDX-License-Identifier: MIT OR Apache-2.0
//! A core whose samples are those of the scene, traced.
//!
//! It begins with the slot that the window begins in, or a rotation of the pads before it; what the
//! core holds of earlier invalid slots is not there.

use anyhow::Result;
use hapticore_model::blocks::core::Core;
use hapticore_model::fidelity::clock::ClockSimulation;
use hapticore_rtl::netlist;
use hapticore_run::case::Case;
use hapticore_run::engine::Signals;
use hapticore_run::interrupt;
use hapticore_run::maker::Maker;
use hapticore_scene::Truth;
use hapticore_waveforms::tracer::{Trace, Tracer};
use hapticore_waveforms::wave::Wave;
use indicatif::ProgressBar;

use super::{Slots, mark, truth};

/// Traces the slots of a case.
///
/// # Errors
/// A file that cannot be written, an interruption.
pub fn trace<W: Wave>(case: &Case, slots: &Slots, wave: W, bar: &ProgressBar) -> Result<Trace> {
    let profile = &case.profile;
    let mut maker = Maker::new(case.plant()?, profile, true, true);
    let mut core = ClockSimulation::new(profile, case.calibration()?);
    let signals = netlist::signals_of_core(&Core::new(profile));
    let mut tracer = Tracer::of_signals(wave, signals, &truth::variables(), &slots.settings)?;
    tracer.skip(slots.first * profile.slot_clocks());
    let mut before: Option<Truth> = None;
    // Effects may have a state: slots are asked for in rising order.
    for slot in 0..slots.end {
        bar.inc(1);
        let truth = maker.plant().truth(slot as usize);
        // The results of a slot come in the next one, and so does its truth.
        let finished = before.replace(truth);
        if slot >= slots.first {
            interrupt::check()?;
            if let Some(truth) = &finished {
                truth::set(&mut tracer, truth);
            }
            let is_whole = tracer.is_active();
            if let (Signals::Samples { codes, .. }, _) = maker.sample(slot as usize) {
                step(&mut core, &mut tracer, &codes, profile.channels())?;
                // What the next slot brings is the frame of this one.
                core.take_frame();
                if is_whole {
                    tracer.mark_once(mark::WINDOW);
                }
            }
        }
    }
    Ok(tracer.finish()?)
}

fn step<W: Wave>(
    core: &mut ClockSimulation,
    tracer: &mut Tracer<W>,
    codes: &[i32],
    channels: usize,
) -> Result<()> {
    let mut outcome = Ok(());
    for codes in codes.chunks_exact(channels) {
        core.sample_with(codes, |core| {
            if outcome.is_ok() {
                outcome = tracer.clock(core);
            }
            if core.has_frame() {
                tracer.mark_after(mark::WINDOW, mark::FRAME);
            }
        });
    }
    Ok(outcome?)
}
