// SPDX-License-Identifier: MIT OR Apache-2.0
//! A board without a page: rows to files, its state on the console.

use std::io::ErrorKind;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Result, anyhow, bail};
use hapticore_board::source::Board;
use hapticore_host::link::Phase;
use hapticore_live::protocol::{Command, Frames};
use hapticore_live::source::Source;
use hapticore_run::interrupt;

use crate::args::HostArgs;
use crate::{console, say};

/// How often the line is looked at.
const PAUSE: Duration = Duration::from_millis(3);
/// How often the state is printed.
const STATE: Duration = Duration::from_secs(1);
/// A board that is not brought up within this time is given up, where the command ends by itself.
const PATIENCE: Duration = Duration::from_secs(30);

/// A board with what the command line wants of it.
pub(super) struct Watched<'a> {
    pub(super) board: Board,
    args: &'a HostArgs,
    begun: Instant,
    measuring_since: Option<Instant>,
    wants_arm: bool,
    is_over: bool,
    printed: Instant,
}

impl<'a> Watched<'a> {
    pub(super) fn new(board: Board, args: &'a HostArgs) -> Self {
        let now = Instant::now();
        Watched {
            board,
            args,
            begun: now,
            measuring_since: None,
            wants_arm: args.arm,
            is_over: false,
            printed: now,
        }
    }

    /// Runs without a page.
    pub(super) fn run(&mut self, quiet: bool) -> Result<bool> {
        loop {
            while self.step()? {}
            if let Some(outcome) = self.outcome() {
                self.print_state();
                return Ok(outcome);
            }
            if !quiet && self.printed.elapsed() > STATE {
                self.printed = Instant::now();
                self.print_state();
            }
            thread::sleep(PAUSE);
        }
    }

    /// A step of the board; whether more has happened already.
    fn step(&mut self) -> Result<bool> {
        let step = self.board.advance().map_err(anyhow::Error::msg)?;
        if let Some(note) = &step.note {
            console::complain(format_args!("{note}"));
        }
        if let Some(event) = &step.event {
            console::complain(format_args!(
                "{:.2} s: pad {}: {}",
                event.time_s, event.pad, event.what
            ));
        }
        match self.board.record_error() {
            // A reader that has gone wants no more.
            Some(error) if error.kind() == ErrorKind::BrokenPipe => self.is_over = true,
            Some(error) if self.args.csv.is_some() => bail!("standard output: {error}"),
            Some(error) => bail!("--record: {error}"),
            None => (),
        }
        let is_measuring = matches!(self.board.phase(), Phase::Measuring | Phase::Armed);
        if is_measuring && self.measuring_since.is_none() {
            self.measuring_since = Some(Instant::now());
        }
        if self.wants_arm && self.board.phase() == Phase::Measuring {
            self.arm()?;
        }
        Ok(step.more)
    }

    fn arm(&mut self) -> Result<()> {
        self.wants_arm = false;
        self.board.apply(&Command::Arm { on: true }).map_err(|why| anyhow!("--arm: {why}"))?;
        for (pad, newtons) in &self.args.target {
            self.board.set_target(*pad, *newtons).map_err(|why| anyhow!("--target: {why}"))?;
        }
        console::complain(format_args!("armed: the drive follows its targets; Ctrl-C ends it"));
        Ok(())
    }

    /// Whether it is over, and how.
    fn outcome(&self) -> Option<bool> {
        if self.is_over {
            return Some(true);
        }
        if interrupt::check().is_err() {
            return Some(self.measuring_since.is_some());
        }
        let seconds = self.args.seconds?;
        let patience_s = PATIENCE.as_secs_f64().max(seconds);
        match self.measuring_since {
            Some(since) => (since.elapsed().as_secs_f64() >= seconds).then_some(true),
            None => (self.begun.elapsed().as_secs_f64() >= patience_s).then_some(false),
        }
    }

    /// A line with state, losses and pads, on standard error where rows go to standard output.
    fn print_state(&self) {
        let counts = self.board.statistics();
        let is_measuring = matches!(self.board.phase(), Phase::Measuring | Phase::Armed);
        let pads = if is_measuring { pads(&self.board.frames()) } else { Vec::new() };
        let line = format!(
            "{}: {} frames, {} lost, {} dropped, {} damaged{}{}",
            self.board.phase().word(),
            counts.frames,
            counts.lost,
            counts.dropped,
            counts.damaged,
            if pads.is_empty() { "" } else { "; " },
            pads.join("; ")
        );
        match self.args.csv {
            Some(_) => console::complain(format_args!("{line}")),
            None => {
                say!("{line}");
                console::flush();
            }
        }
    }
}

/// Each pad in words.
fn pads(frames: &Frames) -> Vec<String> {
    let value = |value: Option<f64>, digits: usize| {
        value.map_or_else(|| "–".to_string(), |value| format!("{value:.digits$}"))
    };
    let words = |row: &hapticore_live::protocol::PadRow| {
        format!(
            "pad {} {} at {}, {} mm, {} pF, {} N",
            row.pad,
            row.state.word(),
            value(row.x_mm, 1),
            value(row.y_mm, 1),
            value(row.capacitance_pf, 0),
            value(row.force_n, 3)
        )
    };
    frames.pads.iter().map(words).collect()
}
