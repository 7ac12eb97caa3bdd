// SPDX-License-Identifier: MIT OR Apache-2.0
//! A core with its force controller, traced, the plant closed around it.
//!
//! The loop runs from the case's first slot on, wherever the window begins: what the plant does
//! depends on every drive before. It is stepped from a window's first sample to the end of the
//! blanking after it, when the drive word is there; the first blanking has no results and is passed
//! over. A target is written in a clock of its own between two samples, which the trace leaves out.

use anyhow::Result;
use hapticore_contract::control::{Drive, Tuning};
use hapticore_model::blocks::force_loop::ForceLoop;
use hapticore_model::fidelity::force_loop::ClockLoop;
use hapticore_rtl::netlist;
use hapticore_run::case::Case;
use hapticore_run::control::plant::LoopSlot;
use hapticore_run::interrupt;
use hapticore_run::maker::Maker;
use hapticore_waveforms::tracer::{Trace, Tracer};
use hapticore_waveforms::wave::Wave;
use indicatif::ProgressBar;

use super::{Slots, mark, truth};

/// Traces the slots of a case with a controller.
///
/// # Errors
/// A file that cannot be written, an interruption.
pub fn trace<W: Wave>(
    case: &Case,
    tuning: &Tuning,
    slots: &Slots,
    wave: W,
    bar: &ProgressBar,
) -> Result<Trace> {
    let profile = &case.profile;
    let mut plant = case.loop_plant(Maker::new(case.plant()?, profile, true, false))?;
    let mut core = ClockLoop::new(profile, case.calibration()?, tuning)?;
    let signals = netlist::signals_of_force_loop(&ForceLoop::try_new(profile)?);
    let mut tracer = Tracer::of_signals(wave, signals, &truth::variables(), &slots.settings)?;
    let blanking = profile.slot.blanking() * profile.clocks_per_sample;
    tracer.skip(blanking);
    for number in 0..slots.end {
        interrupt::check()?;
        bar.inc(1);
        let made = plant.slot(number as usize);
        let drive = step(&mut core, &mut tracer, &made, profile.slot_clocks() - blanking)?;
        plant.drive(&made, drive)?;
    }
    Ok(tracer.finish()?)
}

/// Runs the core to the slot's drive. The slot's truth stands from its end on.
fn step<W: Wave>(
    core: &mut ClockLoop,
    tracer: &mut Tracer<W>,
    made: &LoopSlot,
    window_clocks: u64,
) -> Result<Option<Drive>> {
    let mut outcome = Ok(());
    let mut clocks = 0..;
    let is_whole = tracer.is_active();
    core.set_target(made.slot.pad, made.target_n);
    if let Some(surface) = made.surface {
        core.set_surface(made.slot.pad, surface);
    }
    let (_, drive) = core.slot_with(made.slot.window(), |core| {
        let ends = clocks.next() == Some(window_clocks);
        if ends {
            truth::set(tracer, &made.truth);
        }
        if outcome.is_ok() {
            outcome = tracer.clock(core);
        }
        if ends && is_whole {
            tracer.mark_once(mark::WINDOW);
        }
        if core.has_drive() {
            tracer.mark_after(mark::WINDOW, mark::DRIVE);
        }
        if core.has_frame() {
            tracer.mark_after(mark::WINDOW, mark::FRAME);
        }
    });
    outcome?;
    Ok(drive)
}
