// SPDX-License-Identifier: MIT OR Apache-2.0
//! Follows a simulation clock by clock and writes what changed.
//!
//! ```text
//!   clock      0     1     2     3
//!   ticks      0     T     2T    3T      T = clock period
//!   registers  after clock 0, 1, 2, 3: what they hold until the next edge
//!   ports      of clock    1, 2, 3, 4: what they have until the next edge
//! ```
//!
//! So a clock is written when the next one is there. Outside the window a clock costs a comparison:
//! the probe is not sampled. Inside, every signal is compared with its last value and only changes
//! are written. Nothing is allocated per clock here.

use std::ops::Range;

use hapticore_hdl::probe::{Probe, Signals, Variable};

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
    /// Whether to add the clock, in the scope of the ports. It changes twice a clock, so a trace may
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
    /// Names of moments and their ticks.
    pub marks: Vec<(&'static str, u64)>,
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
    /// The clock that is yet to be written, and what registers held after it.
    pending: Option<u64>,
    held: Vec<i64>,
    registers: Codes,
    ports: Codes,
    port_codes: Vec<i64>,
    truth: Truth,
    marks: Vec<(&'static str, u64)>,
    failed: bool,
}

impl<W: Wave> Tracer<W> {
    /// Declares the signals of `probe` and the truth in `wave`.
    ///
    /// # Errors
    /// A signal that a viewer would misread, or a file that cannot be written.
    pub fn new(
        wave: W,
        probe: &impl Probe,
        truth: &[TruthVariable],
        settings: &Settings,
    ) -> Result<Self, Error> {
        Tracer::of_signals(wave, Signals::of(probe), truth, settings)
    }

    /// The same with the signals of a probe's printed design.
    ///
    /// # Errors
    /// As [`Tracer::new`].
    pub fn of_signals(
        mut wave: W,
        signals: Signals,
        truth: &[TruthVariable],
        settings: &Settings,
    ) -> Result<Self, Error> {
        let mut count = 0;
        let mut numbered = |variables: &[Option<Variable>]| {
            let mut number = |variable: &Variable| {
                count += 1;
                (count - 1, variable.format.width)
            };
            Codes::new(variables.iter().map(|of| of.as_ref().map(&mut number)).collect())
        };
        let (registers, ports) = (numbered(&signals.registers), numbered(&signals.ports));
        let declarations =
            Declarations::new(signals, truth, settings.clock_wire, settings.timebase)?;
        wave.begin(&declarations)?;
        Ok(Tracer {
            wave: Timed::new(wave),
            window: settings.window.clone().unwrap_or(0..u64::MAX),
            clock_wire: settings.clock_wire.then(|| declarations.signals().len() - 1),
            declarations,
            clock: 0,
            traced: None,
            pending: None,
            held: Vec::new(),
            registers,
            ports,
            port_codes: Vec::new(),
            truth: Truth::new(count, truth.len()),
            marks: Vec::new(),
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
        let in_window = self.window.contains(&clock);
        if !in_window && self.pending.is_none() {
            return Ok(());
        }
        let outcome = self.write_pending(Some((clock, probe)));
        if in_window {
            self.hold(clock, probe);
        }
        self.failed |= outcome.is_err();
        outcome
    }

    /// Gives the last clock a name, unless one has it already; only where it lies in the window.
    pub fn mark_once(&mut self, name: &'static str) {
        if let Some(clock) = self.pending.filter(|_| !self.is_marked(name)) {
            self.marks.push((name, self.declarations.timebase().ticks(clock)));
        }
    }

    /// As [`Tracer::mark_once`], where there is a mark `first`.
    pub fn mark_after(&mut self, first: &str, name: &'static str) {
        if self.is_marked(first) {
            self.mark_once(name);
        }
    }

    fn is_marked(&self, name: &str) -> bool {
        self.marks.iter().any(|(marked, _)| *marked == name)
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
        self.write_pending(None::<(u64, &NoProbe)>)?;
        let clocks = self.traced.ok_or(Error::Empty { window: self.window, clocks: self.clock })?;
        let timebase = self.declarations.timebase();
        let ticks = timebase.ticks(clocks.start)..timebase.ticks(clocks.end);
        self.wave.finish(ticks.end)?;
        Ok(Trace { declarations: self.declarations, ticks, marks: self.marks })
    }

    /// Keeps what registers hold after a clock, until the next one shows the ports.
    fn hold(&mut self, clock: u64, probe: &impl Probe) {
        self.traced = Some(self.traced.as_ref().map_or(clock, |traced| traced.start)..clock + 1);
        self.held.clear();
        probe.sample(&mut self.held);
        self.truth.hold();
        self.pending = Some(clock);
    }

    /// Writes the clock before `next`, with the ports that `next` has shown.
    fn write_pending(&mut self, next: Option<(u64, &impl Probe)>) -> Result<(), Error> {
        let Some(clock) = self.pending.take() else { return Ok(()) };
        let timebase = self.declarations.timebase();
        self.wave.at(timebase.ticks(clock));
        if let Some(wire) = self.clock_wire {
            self.wave.bits(wire, 1)?;
        }
        self.registers.trace(&self.held, &mut self.wave)?;
        // Of clocks that are passed over nothing is known.
        if let Some((_, probe)) = next.filter(|(next, _)| *next == clock + 1) {
            self.port_codes.clear();
            probe.sample_ports(&mut self.port_codes);
            self.ports.trace(&self.port_codes, &mut self.wave)?;
        }
        self.truth.trace(&mut self.wave)?;
        if let Some(wire) = self.clock_wire {
            self.wave.at(timebase.half_ticks(2 * clock + 1));
            self.wave.bits(wire, 0)?;
        }
        Ok(())
    }
}

/// What shows no ports.
struct NoProbe;

impl Probe for NoProbe {
    fn variables(&self) -> Vec<Variable> {
        Vec::new()
    }

    fn sample(&self, _codes: &mut Vec<i64>) {}
}
