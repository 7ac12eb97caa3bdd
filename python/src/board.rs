// SPDX-License-Identifier: MIT OR Apache-2.0
//! A board, real or virtual, that a thread of its own polls.

use std::cell::RefCell;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use anyhow::{Result, ensure};
use hapticore_board::background::{Background, MOST_ROWS, Seen};
use hapticore_board::bench::RealTime;
use hapticore_board::check::check;
use hapticore_board::source::Board;
use hapticore_board::target::{Asked, Target, columns, target};
use hapticore_host::SlotClock;
use hapticore_host::link::Phase;
use hapticore_live::protocol::Command;
use hapticore_live::source::Source;
use hapticore_run::columns::Columns;
use hapticore_run::record;
use pyo3::prelude::*;

use crate::apart::{apart, held, signals};
use crate::failure::{self, board_error, error, exception, shown};
use crate::rows::Rows;

/// How often a call that waits shows that the program is alive, and listens for signals.
const TURN: Duration = Duration::from_millis(20);
/// Bits a second that a line may have.
const BAUDS: std::ops::RangeInclusive<u32> = 1200..=12_000_000;

/// A board and the thread that polls it.
#[pyclass(frozen, module = "hapticore._core")]
pub struct Link {
    background: Background,
    /// The board once more, never connected: for its check.
    again: Mutex<Target>,
    columns: Arc<Columns>,
    slot_s: f64,
    pads: Vec<String>,
    parts_mm: Vec<(f64, f64)>,
    sheet_mm: (f64, f64),
    title: String,
}

impl Link {
    fn of(asked: &Asked) -> Result<Link> {
        let baud = asked.baud.unwrap_or(*BAUDS.start());
        ensure!(
            BAUDS.contains(&baud),
            "baud: expected {} to {}, got {baud}",
            BAUDS.start(),
            BAUDS.end()
        );
        ensure!(asked.full_scale_v != Some(0), "full_scale_v: expected 1 or more, got 0");
        if asked.dac.is_none() {
            ensure!(asked.wave.is_none(), "wave: expected dac, too");
            ensure!(asked.full_scale_v.is_none(), "full_scale_v: expected dac, too");
        }
        if let Some(scene) = asked.port.strip_prefix("virtual:") {
            failure::scene(scene, &asked.set)?;
        }
        let found = target(asked)?;
        let profile = &found.plan.profile;
        let columns = columns(&found.plan);
        let clock = SlotClock::new(profile, found.device.device.sample_rate_hz, 0.0);
        let described = found.described.clone();
        let again = Mutex::new(found.again()?);
        Ok(Link {
            background: Background::start(found, &asked.port)?,
            again,
            columns: Arc::new(columns),
            slot_s: clock.seconds(1),
            pads: described.pads,
            parts_mm: described.parts_mm.iter().map(|[x_mm, y_mm]| (*x_mm, *y_mm)).collect(),
            sheet_mm: described.sheet_mm.into(),
            title: described.title,
        })
    }

    /// Waits until the board measures.
    fn wait_until_it_measures(&self, timeout: Duration) -> PyResult<()> {
        let begun = Instant::now();
        while begun.elapsed() < timeout {
            let done = |seen: &Seen| is_measuring(seen) || why_not(seen).is_some();
            if self.background.wait(TURN, done) {
                let why = why_not(&self.background.seen());
                return why.map_or(Ok(()), |why| Err(board_error(why)));
            }
            signals()?;
        }
        let seen = self.background.seen();
        let note = seen.notes.back().map_or(String::new(), |note| format!("; {note}"));
        let seconds = timeout.as_secs_f64();
        match timeout.is_zero() {
            true => Ok(()),
            false => Err(board_error(format!(
                "expected a board that measures within {seconds} s, it is {}{note}",
                word(&seen)
            ))),
        }
    }

    /// Does something with the board.
    fn act(
        &self,
        py: Python<'_>,
        act: impl FnOnce(&mut Board) -> Result<(), String> + Send + 'static,
    ) -> PyResult<()> {
        py.detach(|| {
            let done = answer(&self.background.act(act))?;
            done.map_err(board_error)
        })
    }

    /// Rows from now on: this many, or all that have come after a time, or all that are there.
    fn collect(
        &self,
        frames: Option<usize>,
        seconds: Option<f64>,
        timeout_s: f64,
    ) -> PyResult<Vec<record::Row>> {
        let begun = Instant::now();
        let (mut unread, mut came_at) = (0, begun);
        loop {
            self.background.alive();
            let (now, has_ended, why) = {
                let seen = self.background.seen();
                (seen.unread(), seen.has_ended, why_not(&seen))
            };
            if has_ended {
                return Err(board_error(CLOSED));
            }
            let left_s = seconds.map_or(0.0, |seconds| seconds - begun.elapsed().as_secs_f64());
            let taken = match frames {
                Some(frames) => self.background.take_exactly(frames),
                None => (left_s <= 0.0).then(|| self.background.take_rows()),
            };
            if let Some(rows) = taken {
                return Ok(rows);
            }
            if let Some(why) = why {
                return Err(board_error(why));
            }
            if now != unread {
                (unread, came_at) = (now, Instant::now());
            }
            if frames.is_some() && came_at.elapsed().as_secs_f64() > timeout_s {
                return Err(self.no_frame(timeout_s));
            }
            match frames {
                Some(frames) => {
                    self.background.wait(TURN, |seen| seen.unread() >= frames);
                }
                None => std::thread::sleep(TURN.min(Duration::from_secs_f64(left_s))),
            }
            signals()?;
        }
    }

    fn no_frame(&self, timeout_s: f64) -> PyErr {
        let seen = self.background.seen();
        let note = seen.notes.back().map_or(String::new(), |note| format!("; {note}"));
        let phase = word(&seen);
        board_error(format!("expected a frame within {timeout_s} s, the board is {phase}{note}"))
    }

    /// Checks the wiring of a board whose line is free.
    fn check_wiring(&self, ask: &Py<PyAny>) -> PyResult<Vec<String>> {
        let (found, device) = {
            let again = held(&self.again);
            (again.again().map_err(exception)?, again.device.clone())
        };
        let raised: RefCell<Option<PyErr>> = RefCell::default();
        let stop = || {
            self.background.alive();
            if let Err(error) = signals() {
                raised.replace(Some(error));
            }
            raised.borrow().is_some()
        };
        let ask = |what: &str| {
            let asked = Python::attach(|py| ask.call1(py, (what,)).map(drop));
            asked.map_err(|error| {
                raised.replace(Some(error));
                anyhow::anyhow!("interrupted")
            })
        };
        let say = |text: &str| self.background.note(text);
        let report = check(&mut RealTime::new(found, ask, say, &stop), &device);
        if let Some(error) = raised.take() {
            return Err(error);
        }
        let report = report.map_err(|error| board_error(format!("{error:#}")))?;
        Ok(report.findings.iter().map(ToString::to_string).collect())
    }
}

/// Waits for an answer of the thread, and listens for signals meanwhile.
fn answer<T>(from: &Receiver<T>) -> PyResult<T> {
    loop {
        match from.recv_timeout(TURN) {
            Ok(answer) => return Ok(answer),
            Err(RecvTimeoutError::Timeout) => signals()?,
            Err(RecvTimeoutError::Disconnected) => return Err(board_error(CLOSED)),
        }
    }
}

/// What a call finds after the end.
const CLOSED: &str = "expected a board that is open, it was closed";

fn is_measuring(seen: &Seen) -> bool {
    matches!(seen.phase, Some(Phase::Measuring | Phase::Armed))
}

/// Why no frame comes, and none will without a user's help.
fn why_not(seen: &Seen) -> Option<String> {
    match seen.phase {
        _ if seen.has_ended => Some(CLOSED.into()),
        Some(Phase::Refused) => seen.refusal.as_ref().map(|why| format!("refused: {why}")),
        // At first no line was tried yet.
        Some(Phase::Disconnected) => seen.notes.back().cloned(),
        _ => None,
    }
}

fn word(seen: &Seen) -> &'static str {
    match seen.phase {
        _ if seen.has_ended => "closed",
        None => "checking",
        Some(phase) => phase.word(),
    }
}

#[pymethods]
impl Link {
    #[new]
    #[pyo3(signature = (port, *, set, faults, calibration, profile, baud, control, dac, wave, full_scale_v, tuning, timeout_s))]
    #[expect(clippy::too_many_arguments, reason = "as Python's keywords")]
    fn new(
        py: Python<'_>,
        port: String,
        set: Vec<(String, String)>,
        faults: Vec<String>,
        calibration: Option<PathBuf>,
        profile: Option<String>,
        baud: Option<u32>,
        control: Option<String>,
        dac: Option<String>,
        wave: Option<String>,
        full_scale_v: Option<u16>,
        tuning: Option<PathBuf>,
        timeout_s: f64,
    ) -> PyResult<Link> {
        let faults = faults.iter().map(|fault| {
            fault.parse().map_err(|why: String| error(format!("faults: {why}, got {fault:?}")))
        });
        let asked = Asked {
            port,
            set,
            faults: faults.collect::<PyResult<_>>()?,
            calibration,
            profile,
            baud,
            control,
            dac,
            wave,
            full_scale_v,
            tuning,
        };
        let timeout = duration("timeout_s", timeout_s)?;
        let link = apart(py, || Link::of(&asked))?;
        py.detach(|| match link.wait_until_it_measures(timeout) {
            Ok(()) => Ok(link),
            Err(error) => {
                link.background.close();
                Err(error)
            }
        })
    }

    /// Rows from the oldest that was not read yet.
    #[pyo3(signature = (frames, seconds, timeout_s))]
    fn read(
        &self,
        py: Python<'_>,
        frames: Option<usize>,
        seconds: Option<f64>,
        timeout_s: f64,
    ) -> PyResult<Rows> {
        if let Some(frames) = frames.filter(|frames| *frames > MOST_ROWS) {
            return Err(error(format!("frames: expected at most {MOST_ROWS}, got {frames}")));
        }
        if let Some(seconds) = seconds {
            duration("seconds", seconds)?;
        }
        duration("timeout_s", timeout_s)?;
        let rows = py.detach(|| self.collect(frames, seconds, timeout_s))?;
        Ok(Rows::new(self.columns.clone(), record::Rows::of_cases([rows])))
    }

    /// A sign of life.
    fn alive(&self, py: Python<'_>) -> PyResult<()> {
        py.detach(|| match self.background.seen().has_ended {
            true => Err(board_error(CLOSED)),
            false => {
                self.background.alive();
                Ok(())
            }
        })
    }

    /// Lets the drives follow their targets.
    fn arm(&self, py: Python<'_>) -> PyResult<()> {
        self.act(py, |board| board.apply(&Command::Arm { on: true }))
    }

    /// Takes all drives to 0 V.
    fn disarm(&self, py: Python<'_>) -> PyResult<()> {
        self.act(py, |board| board.apply(&Command::Arm { on: false }))
    }

    /// The target of a pad, N.
    fn target(&self, py: Python<'_>, pad: usize, newtons: f64) -> PyResult<()> {
        self.act(py, move |board| board.set_target(pad, newtons))
    }

    /// Where walls begin, mm.
    #[pyo3(signature = (x_mm, y_mm, off))]
    fn wall(
        &self,
        py: Python<'_>,
        x_mm: Option<f64>,
        y_mm: Option<f64>,
        off: bool,
    ) -> PyResult<()> {
        if off == (x_mm.is_some() || y_mm.is_some()) {
            return Err(error("wall: expected either a place or off"));
        }
        self.act(py, move |board| board.apply(&Command::Wall { x_mm, y_mm, off }))
    }

    /// Leads a pad of a virtual board to a place, mm, within a time, s.
    fn lead(
        &self,
        py: Python<'_>,
        pad: usize,
        x_mm: f64,
        y_mm: f64,
        within_s: f64,
    ) -> PyResult<()> {
        let lead = Command::Lead { pad, mm: [x_mm, y_mm], within_s: Some(within_s) };
        self.act(py, move |board| board.apply(&lead))
    }

    /// What is wrong with the wiring, in words; the board is brought up again afterwards.
    fn check(&self, py: Python<'_>, ask: Py<PyAny>) -> PyResult<Vec<String>> {
        py.detach(|| {
            answer(&self.background.release())?;
            let findings = self.check_wiring(&ask);
            self.background.resume(held(&self.again).again().map_err(exception)?);
            findings
        })
    }

    /// Disables the board and closes its line.
    fn close(&self, py: Python<'_>) {
        py.detach(|| self.background.close());
    }

    /// Where the board is.
    #[getter]
    fn phase(&self, py: Python<'_>) -> &'static str {
        py.detach(|| word(&self.background.seen()))
    }

    /// What the board has said that it is.
    #[getter]
    fn identity(&self, py: Python<'_>) -> Option<String> {
        let identity = py.detach(|| self.background.seen().identity.clone());
        identity.map(|of| of.trim_start_matches("board found: ").to_string())
    }

    /// What a user should read, the oldest first.
    #[getter]
    fn notes(&self, py: Python<'_>) -> Vec<String> {
        py.detach(|| self.background.seen().notes.iter().map(|note| shown(note)).collect())
    }

    /// Counts of what has come, by their names.
    #[getter]
    fn statistics(&self, py: Python<'_>) -> Vec<(&'static str, u64)> {
        let (counts, unread, dropped) = py.detach(|| {
            let seen = self.background.seen();
            (seen.statistics, seen.unread() as u64, seen.dropped_rows)
        });
        vec![
            ("frames", counts.frames),
            ("heartbeats", counts.heartbeats),
            ("lost", counts.lost),
            ("dropped", counts.dropped),
            ("damaged", counts.damaged),
            ("refused", counts.refused),
            ("late", counts.late),
            ("bytes", counts.bytes),
            ("connections", counts.connections),
            ("overflowed", counts.overflowed),
            ("unread", unread),
            ("unread_dropped", dropped),
        ]
    }

    /// What the board is.
    #[getter]
    fn title(&self) -> &str {
        &self.title
    }

    /// The length of a slot, s.
    #[getter]
    fn slot_s(&self) -> f64 {
        self.slot_s
    }

    /// Names of the pads.
    #[getter]
    fn pads(&self) -> Vec<String> {
        self.pads.clone()
    }

    /// Centres of a pad's parts relative to its own, mm.
    #[getter]
    fn parts_mm(&self) -> Vec<(f64, f64)> {
        self.parts_mm.clone()
    }

    /// Width and height of the sheet, mm.
    #[getter]
    fn sheet_mm(&self) -> (f64, f64) {
        self.sheet_mm
    }
}

/// A time that can be waited for.
fn duration(name: &str, seconds: f64) -> PyResult<Duration> {
    const MOST_S: f64 = 1e6;
    if !(0.0..=MOST_S).contains(&seconds) {
        return Err(error(format!("{name}: expected 0 to {MOST_S} s, got {seconds}")));
    }
    Ok(Duration::from_secs_f64(seconds))
}
