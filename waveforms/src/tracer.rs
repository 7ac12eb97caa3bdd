// SPDX-License-Identifier: MIT OR Apache-2.0
//! Follows a simulation clock by clock and writes what changed.
//!
//! ```text
//!   clock      0     1     2     3
//!   ticks      0     T     2T    3T      T = clock period
//!   values    after clock 0, 1, 2, 3: what the registers hold until the next edge
//! ```
//!
//! Outside the window a clock costs a comparison: the probe is not sampled. Inside, every variable
//! is compared with its last value and only changes are written. Nothing is allocated per clock
//! here.

use std::ops::Range;

use hapticore_hdl::probe::Probe;

use crate::Error;
use crate::changes::{Codes, Timed, Truth};
use crate::declarations::{Declarations, TruthVariable};
use crate::timebase::Timebase;
use crate::wave::Wave;

/// What to trace of a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Settings {
    /// The tick of the trace's time axis.
    pub timebase: Timebase,
    /// The clocks to trace, counted from 0; all where `None`.
    pub window: Option<Range<u64>>,
    /// Whether to add a wire `clk` to the first scope. It changes twice a clock, so a trace may
    /// double in size.
    pub clock_wire: bool,
}

impl Settings {
    /// The whole run at `clock_hz`, without a clock wire.
    ///
    /// # Errors
    /// As [`Timebase::of_clock`].
    pub fn of_clock(clock_hz: u64) -> Result<Self, Error> {
        Ok(Settings { timebase: Timebase::of_clock(clock_hz)?, window: None, clock_wire: false })
    }
}

/// What was traced: what a save file is made from.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// The signals in the file.
    pub declarations: Declarations,
    /// The ticks that the file covers.
    pub ticks: Range<u64>,
}

/// Writes the waves of one simulation into one file.
pub struct Tracer<W: Wave> {
    wave: Timed<W>,
    declarations: Declarations,
    window: Range<u64>,
    clock_wire: Option<usize>,
    /// The number of the clock to come.
    clock: u64,
    /// The clocks traced so far.
    traced: Option<Range<u64>>,
    codes: Codes,
    truth: Truth,
    failed: bool,
}

impl<W: Wave> Tracer<W> {
    /// Declares the variables of `probe` and the truth in `wave`.
    ///
    /// # Errors
    /// A variable that a viewer would misread, or a file that cannot be written.
    pub fn new(
        mut wave: W,
        probe: &impl Probe,
        truth: &[TruthVariable],
        settings: &Settings,
    ) -> Result<Self, Error> {
        let variables = probe.variables();
        let codes = Codes::new(variables.iter().map(|variable| variable.format.width).collect());
        let declarations =
            Declarations::new(variables, truth, settings.clock_wire, settings.timebase)?;
        wave.begin(&declarations)?;
        Ok(Tracer {
            wave: Timed::new(wave),
            window: settings.window.clone().unwrap_or(0..u64::MAX),
            clock_wire: settings.clock_wire.then(|| declarations.signals().len() - 1),
            declarations,
            clock: 0,
            traced: None,
            truth: Truth::new(codes.signals(), truth.len()),
            codes,
            failed: false,
        })
    }

    /// Follows one clock of the simulation, which `probe` has just done.
    ///
    /// # Errors
    /// The file cannot be written; it will not be kept.
    ///
    /// # Panics
    /// `probe` has not the variables that were declared.
    pub fn clock(&mut self, probe: &impl Probe) -> Result<(), Error> {
        let clock = self.clock;
        self.clock += 1;
        if !self.window.contains(&clock) {
            return Ok(());
        }
        let outcome = self.trace(clock, probe);
        self.failed |= outcome.is_err();
        outcome
    }

    /// Passes over clocks that the simulation did untraced. The trace holds its values there.
    pub fn skip(&mut self, clocks: u64) {
        self.clock += clocks;
    }

    /// Whether the next clock lies in the window.
    pub fn is_active(&self) -> bool {
        self.window.contains(&self.clock)
    }

    /// From the next clock on, truth variable number `index` is `value`.
    ///
    /// # Panics
    /// There is no such truth variable.
    pub fn set_truth(&mut self, index: usize, value: f64) {
        self.truth.set(index, value);
    }

    /// Completes the file and gives it its name.
    ///
    /// # Errors
    /// The file cannot be written, now or at an earlier clock, or nothing was traced; then none is
    /// kept.
    pub fn finish(mut self) -> Result<Trace, Error> {
        if self.failed {
            return Err(Error::Incomplete);
        }
        let clocks = self.traced.ok_or(Error::Empty { window: self.window, clocks: self.clock })?;
        let timebase = self.declarations.timebase();
        let ticks = timebase.ticks(clocks.start)..timebase.ticks(clocks.end);
        self.wave.finish(ticks.end)?;
        Ok(Trace { declarations: self.declarations, ticks })
    }

    fn trace(&mut self, clock: u64, probe: &impl Probe) -> Result<(), Error> {
        let timebase = self.declarations.timebase();
        self.traced = Some(self.traced.as_ref().map_or(clock, |traced| traced.start)..clock + 1);
        self.wave.at(timebase.ticks(clock));
        if let Some(wire) = self.clock_wire {
            self.wave.bits(wire, 1)?;
        }
        self.codes.trace(probe, &mut self.wave)?;
        self.truth.trace(&mut self.wave)?;
        if let Some(wire) = self.clock_wire {
            self.wave.at(timebase.half_ticks(2 * clock + 1));
            self.wave.bits(wire, 0)?;
        }
        Ok(())
    }
}
