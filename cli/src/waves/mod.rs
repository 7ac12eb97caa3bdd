// SPDX-License-Identifier: MIT OR Apache-2.0
//! Waveforms of a case: the core stepped clock by clock through a window, beside the plant's truth.
//!
//! The truth of a slot stands from the end of the slot to that of the next, beside the results of
//! the slot; before the first slot has ended there is none. The window is a run of its own: tracing
//! never alters the core that makes the frames.
//!
//! | module | traces |
//! | --- | --- |
//! | `open` | a core, its samples those of the scene |
//! | `closed` | a core with its force controller, whose drives the plant follows |
//! | `truth` | the plant's truth beside either |

mod closed;
mod open;
mod truth;

use std::fmt;
use std::ops::Range;
use std::path::Path;

use anyhow::{Result, bail};
use hapticore_waveforms::gtkwave;
use hapticore_waveforms::kind::Kind;
use hapticore_waveforms::timebase::Timebase;
use hapticore_waveforms::tracer::{Settings, Trace};
use hapticore_waveforms::view::View;

use crate::print::number;
use crate::progress;
use hapticore_model::blocks::core::Core;
use hapticore_run::case::Case;

/// Slots traced where no window is named, and of a case whose pads have targets.
const SLOTS: u64 = 2;
const SLOTS_OF_LOOP: u64 = 4;

/// What a clock takes in a file, about, as measured on `hockey` with profile `standard`.
const VCD_BYTES_PER_CLOCK: f64 = 128.0;
const FST_BYTES_PER_CLOCK: f64 = 10.0;

/// A file of more bytes is worth a warning.
const LARGE_BYTES: f64 = 2e8;

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
    let clocks = clocks(case, window, clock_hz)?;
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

/// Writes `waves.vcd` or `waves.fst` into `folder`: the window in seconds, the first slots where
/// none is named. `waves.gtkw` shows all of it, `waves.results.gtkw` what follows the first window.
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
    let slots = slots(case, window)?;
    let name = format!("waves.{}", kind.extension());
    let wave = kind.create(&folder.join(&name))?;
    let bar = progress::bar(Some(slots.end), "slots", quiet);
    let (trace, view) = match case.tuning(&case.plant()?)? {
        None => (open::trace(case, &slots, wave, &bar)?, "slot"),
        Some(tuning) => (closed::trace(case, &tuning, &slots, wave, &bar)?, "force_loop"),
    };
    bar.finish_and_clear();
    let mut view = View::bundled(view)?;
    gtkwave::save(&view, &trace, &name, &trace.ticks, &folder.join("waves.gtkw"))?;
    if let Some(ticks) = results(&trace) {
        view.close_windows();
        gtkwave::save(&view, &trace, &name, &ticks, &folder.join("waves.results.gtkw"))?;
    }
    Ok(())
}

/// Marks of a trace: the last sample of the first window that is traced as a whole, and what the core gives of that slot.
mod mark {
    pub const WINDOW: &str = "window end";
    pub const DRIVE: &str = "drive word";
    pub const FRAME: &str = "frame";
}

/// The microseconds from the end of a window to the last of its results, with a tenth around them.
fn results(trace: &Trace) -> Option<Range<u64>> {
    let [(_, first), .., (_, last)] = trace.marks[..] else { return None };
    let around = (last - first) / 10;
    Some(first.saturating_sub(around)..last + around)
}

/// The slots that a window lies in.
struct Slots {
    /// The first of the rotation of the pads that the window begins in.
    first: u64,
    /// After the last.
    end: u64,
    settings: Settings,
}

fn slots(case: &Case, window: Option<&Range<f64>>) -> Result<Slots> {
    let (profile, clock_hz) = (&case.profile, clock_hz(case));
    let clocks = clocks(case, window, clock_hz)?;
    let first = clocks.start / profile.slot_clocks() / profile.pads * profile.pads;
    let end = clocks.end.div_ceil(profile.slot_clocks()).min(case.slots as u64);
    if first >= end {
        bail!("--waves-window: expected a window within the case's {} s", case.seconds());
    }
    let timebase = Timebase::of_clock(clock_hz.round() as u64)?;
    let settings = Settings { timebase, window: Some(clocks), clock_wire: true };
    Ok(Slots { first, end, settings })
}

/// The clocks to trace: by default the first slots and as much of the next as it takes for their
/// frames to be there. A case whose pads have targets begins with the slot whose end has the first of them.
fn clocks(case: &Case, window: Option<&Range<f64>>, clock_hz: f64) -> Result<Range<u64>> {
    let profile = &case.profile;
    if let Some(seconds) = window {
        return Ok(
            (seconds.start * clock_hz).floor() as u64..(seconds.end * clock_hz).ceil() as u64
        );
    }
    let (first, slots) = match first_target(case)? {
        Some(slot) => (slot / profile.pads * profile.pads, SLOTS_OF_LOOP),
        None => (0, SLOTS),
    };
    let blanking = profile.slot.blanking() * profile.clocks_per_sample;
    let frame = Core::new(profile).latency();
    let start = first * profile.slot_clocks();
    Ok(start..start + slots * profile.slot_clocks() + blanking.max(frame))
}

/// The first slot at whose end a pad has a target.
fn first_target(case: &Case) -> Result<Option<u64>> {
    if case.profile.control.is_none() {
        return Ok(None);
    }
    let (plant, pads) = (case.plant()?, case.profile.pads);
    let slot_s = case.seconds() / case.slots as f64;
    let has_target = |slot: &u64| {
        let (pad, end_s) = ((slot % pads) as usize, (slot + 1) as f64 * slot_s);
        plant.target_n(pad, end_s) > 0.0
    };
    Ok((0..case.slots as u64).find(has_target))
}
