// SPDX-License-Identifier: MIT OR Apache-2.0
//! Waveforms of a case: the core stepped clock by clock through a window, beside the plant's truth.
//!
//! The truth of a slot stands from the end of the slot to that of the next, beside the results of
//! the slot; before the first slot has ended there is none. The window is a run of its own: the
//! core that makes the frames is never altered by being looked at. It begins with the slot that the
//! window begins in, or a rotation of the pads before it; what the core holds of earlier invalid
//! slots is not there.

use std::fmt;
use std::ops::Range;
use std::path::Path;

use anyhow::{Result, bail};
use hapticore_host::{QUANTITIES, Quantity, quantities_of};
use hapticore_model::fidelity::clock::ClockSimulation;
use hapticore_scene::Truth;
use hapticore_waveforms::declarations::TruthVariable;
use hapticore_waveforms::gtkwave;
use hapticore_waveforms::kind::Kind;
use hapticore_waveforms::timebase::Timebase;
use hapticore_waveforms::tracer::{Settings, Tracer};
use hapticore_waveforms::view::View;
use hapticore_waveforms::wave::Wave;

use crate::print::number;
use crate::progress;
use hapticore_run::case::{Case, Maker};
use hapticore_run::engine::Signals;
use hapticore_run::interrupt;

/// Slots traced where no window is named.
const SLOTS: u64 = 2;

/// What a clock takes in a file, about, as measured on `hockey` with profile `standard`.
const VCD_BYTES_PER_CLOCK: f64 = 85.0;
const FST_BYTES_PER_CLOCK: f64 = 8.0;

/// A file of more bytes is worth a warning.
const LARGE_BYTES: f64 = 2e8;

/// The load on the pad: known to the plant alone.
const LOAD: (&str, &str) = ("load_g", "g");

/// The truth beside the core's signals: quantities that waveforms name with these units, and the
/// load.
fn truth_variables() -> Vec<TruthVariable> {
    let traced = traced()
        .map(|quantity| (quantity.name, if quantity.unit == "Ω" { "Ohm" } else { quantity.unit }));
    traced.chain([LOAD]).map(|(name, unit)| TruthVariable::new(name, unit)).collect()
}

/// The quantities that are traced: all but the direction, which no core computes.
fn traced() -> impl Iterator<Item = &'static Quantity> {
    QUANTITIES.iter().filter(|quantity| quantity.name != "direction")
}

/// The values of [`truth_variables`], in the same order.
fn truth_values(truth: &Truth) -> impl Iterator<Item = f64> {
    let quantities = quantities_of!(truth);
    traced().map(move |quantity| quantity.value_in(&quantities)).chain([truth.load_g])
}

/// What is going to be traced, and how large the file will be, about.
pub struct Extent {
    seconds: Range<f64>,
    clocks: u64,
    bytes: f64,
    kind: Kind,
}

impl Extent {
    /// Whether the file will be worth a warning.
    pub fn is_large(&self) -> bool {
        self.bytes > LARGE_BYTES
    }
}

impl fmt::Display for Extent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (from, to) = (number(self.seconds.start), number(self.seconds.end));
        let (clocks, megabytes, extension) =
            (self.clocks, number(self.bytes / 1e6), self.kind.extension());
        write!(f, "waves: {from} to {to} s, {clocks} clocks, about {megabytes} MB of {extension}")?;
        match self.kind {
            Kind::Vcd if self.is_large() => {
                write!(f, "; --waves fst takes a tenth of that, --waves-window says which")
            }
            _ => Ok(()),
        }
    }
}

/// What is going to be traced of a case.
///
/// # Errors
/// A window in which the case has no slot.
pub fn extent(case: &Case, kind: Kind, window: Option<&Range<f64>>) -> Result<Extent> {
    let clock_hz = clock_hz(case);
    let clocks = clocks(case, window, clock_hz);
    let clocks = clocks.start..clocks.end.min(case.slots as u64 * case.profile.slot_clocks());
    if clocks.is_empty() {
        bail!("--waves-window: expected a window within the case's {} s", case.seconds());
    }
    let per_clock = if kind == Kind::Vcd { VCD_BYTES_PER_CLOCK } else { FST_BYTES_PER_CLOCK };
    let (seconds, count) =
        (clocks.start as f64 / clock_hz..clocks.end as f64 / clock_hz, clocks.end - clocks.start);
    Ok(Extent { seconds, clocks: count, bytes: per_clock * count as f64, kind })
}

fn clock_hz(case: &Case) -> f64 {
    case.device.device.sample_rate_hz * case.profile.clocks_per_sample as f64
}

/// Writes `waves.vcd` or `waves.fst` and `waves.gtkw` into `folder`: the window in seconds, the
/// first slots where none is named.
///
/// # Errors
/// A window in which the case has no slot, a file that cannot be written, an interruption.
pub fn trace(
    case: &Case,
    kind: Kind,
    window: Option<&Range<f64>>,
    folder: &Path,
    quiet: bool,
) -> Result<()> {
    let (profile, clock_hz) = (&case.profile, clock_hz(case));
    let clocks = clocks(case, window, clock_hz);
    let pads = profile.pads;
    let first = clocks.start / profile.slot_clocks() / pads * pads;
    let end = clocks.end.div_ceil(profile.slot_clocks()).min(case.slots as u64);
    if first >= end {
        bail!("--waves-window: expected a window within the case's {} s", case.seconds());
    }
    let mut maker = Maker::new(case.plant()?, profile, true, true);
    let mut core = ClockSimulation::new(profile, &case.device.for_profile(profile)?);
    let settings = Settings {
        timebase: Timebase::of_clock(clock_hz.round() as u64)?,
        window: Some(clocks),
        clock_wire: false,
    };
    let truth = truth_variables();
    let name = format!("waves.{}", kind.extension());
    let mut tracer = Tracer::new(kind.create(&folder.join(&name))?, &core, &truth, &settings)?;
    tracer.skip(first * profile.slot_clocks());
    let bar = progress::bar(Some(end), quiet);
    let mut before: Option<Truth> = None;
    // Effects may have a state: slots are asked for in rising order.
    for slot in 0..end {
        bar.inc(1);
        let truth = maker.plant().truth(slot as usize);
        // The results of a slot come in the next one, and so does its truth.
        let finished = before.replace(truth);
        if slot >= first {
            interrupt::check()?;
            if let Some(truth) = &finished {
                truth_values(truth)
                    .enumerate()
                    .for_each(|(index, value)| tracer.set_truth(index, value));
            }
            if let (Signals::Samples { codes, .. }, _) = maker.sample(slot as usize) {
                step(&mut core, &mut tracer, &codes, profile.channels())?;
            }
        }
    }
    bar.finish_and_clear();
    let trace = tracer.finish()?;
    Ok(gtkwave::save(&View::bundled("slot")?, &trace, &name, &folder.join("waves.gtkw"))?)
}

/// The clocks to trace: by default the first slots and as much of the next as it takes for their
/// frames to be there.
fn clocks(case: &Case, window: Option<&Range<f64>>, clock_hz: f64) -> Range<u64> {
    let profile = &case.profile;
    match window {
        Some(seconds) => {
            (seconds.start * clock_hz).floor() as u64..(seconds.end * clock_hz).ceil() as u64
        }
        None => {
            0..SLOTS * profile.slot_clocks() + profile.slot.blanking() * profile.clocks_per_sample
        }
    }
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
        });
    }
    Ok(outcome?)
}
