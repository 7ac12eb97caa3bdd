// SPDX-License-Identifier: MIT OR Apache-2.0
//! A board as what a live page shows and drives: measured columns only.
//!
//! ```text
//! Session ─ frames ─ Readout ─ rows ─┬─ Recorder
//!    ↑                               └─ Pads ─ page
//!    └─ arm, disable, target, wall ─ commands of clients
//! ```

mod commands;
mod hello;
mod rows;

use std::collections::VecDeque;
use std::io;

use hapticore_host::link::{Phase, Session, SessionEvent, Statistics};
use hapticore_host::{DeviceCalibration, Readout, SlotClock};
use hapticore_live::pads::{Pads, Surface};
use hapticore_live::protocol::{
    Command, Frames, Hello, LineStatus, Recorded, Recording, Setting, SlotCodes, State,
};
use hapticore_live::source::{Source, Step};
use hapticore_run::columns::Columns;

use crate::recording::Recorder;
use crate::target::{Target, columns};
use crate::virtual_line::Running;
use hello::hello;

/// How often the line is looked at, s.
const TICK_S: f64 = 0.004;
/// Without a frame for this long a pad's values are not shown as present, s.
const OLD_S: f64 = 1.0;

/// Receives notes.
type Listener = Box<dyn FnMut(&str) + Send>;

/// A board with its session.
pub struct Board {
    session: Session,
    readout: Readout,
    device: DeviceCalibration,
    hello: Hello,
    parts_mm: Vec<[f64; 2]>,
    running: Option<Running>,
    pads: Pads,
    walls: Vec<Surface>,
    clock: SlotClock,
    /// Sequence number of the first frame since the board was enabled, and the time of the last.
    base: Option<u16>,
    time_s: f64,
    ticks: usize,
    rows: usize,
    inputs: usize,
    queue: VecDeque<SessionEvent>,
    recorder: Option<Box<dyn Recorder>>,
    /// Why nothing is recorded any more.
    record_error: Option<io::Error>,
    /// Is told every note.
    listener: Option<Listener>,
}

impl Board {
    /// A board that is not yet connected.
    pub fn new(target: Target, name: &str) -> Board {
        let Target { line, plan, device, described, running } = target;
        let hello = hello(&plan.profile, &device, &described, (name, running.is_some()));
        let pads = hello.pads.len();
        let clock = SlotClock::new(&plan.profile, device.device.sample_rate_hz, 0.0);
        let right = plan.tuning.as_ref().and_then(|tuning| tuning.walls.as_ref());
        let walls = plan.profile.wall.map(|_| Surface {
            axis: 0,
            mm: None,
            above: right.is_some_and(|walls| walls.right),
        });
        Board {
            readout: Readout::new(&plan.profile, &device),
            pads: Pads::new(pads, &described.parts_mm, false),
            session: Session::new(line, plan),
            device,
            hello,
            parts_mm: described.parts_mm,
            running,
            walls: walls.into_iter().collect(),
            clock,
            base: None,
            time_s: 0.0,
            ticks: 0,
            rows: 0,
            inputs: 0,
            queue: VecDeque::new(),
            recorder: None,
            record_error: None,
            listener: None,
        }
    }

    /// The same, whose rows and notes are recorded.
    pub fn with_recorder(mut self, recorder: Box<dyn Recorder>) -> Board {
        self.recorder = Some(recorder);
        self
    }

    /// The same, which passes on each note: for a console beside a page.
    pub fn with_listener(mut self, listener: impl FnMut(&str) + Send + 'static) -> Board {
        self.listener = Some(Box::new(listener));
        self
    }

    /// Columns of its rows.
    pub fn columns(&self) -> Columns {
        columns(self.session.plan())
    }

    /// How many pads the board serves.
    pub fn pads(&self) -> usize {
        self.session.plan().profile.pads as usize
    }

    /// Where it is.
    pub fn phase(&self) -> Phase {
        self.session.phase()
    }

    /// What the board has said that it is.
    pub fn identity(&self) -> Option<&str> {
        self.session.identity()
    }

    /// Why it was refused last, in words; none where it starts up.
    pub fn refusal(&self) -> Option<String> {
        self.session.refusal().map(ToString::to_string)
    }

    /// What has come so far.
    pub fn statistics(&self) -> Statistics {
        self.session.statistics()
    }

    /// Why nothing is recorded any more, where that is so.
    pub fn record_error(&self) -> Option<&io::Error> {
        self.record_error.as_ref()
    }
}

impl Source for Board {
    fn hello(&self) -> Hello {
        self.hello.clone()
    }

    fn slot(&self) -> usize {
        self.ticks
    }

    fn slot_s(&self) -> f64 {
        TICK_S
    }

    fn inputs(&self) -> usize {
        self.inputs
    }

    fn apply(&mut self, command: &Command) -> Result<(), String> {
        match *command {
            Command::Arm { on: true } => self.session.arm().map_err(|error| error.to_string())?,
            Command::Arm { on: false } => self.session.disarm(),
            Command::Disable => self.session.disable(),
            Command::Enable => self.session.enable(),
            Command::Target { pad, n } | Command::Set { pad, setting: Setting::TargetN(n) } => {
                self.set_target(pad, n)?
            }
            Command::Wall { x_mm, y_mm, off } => self.set_wall(x_mm, y_mm, off)?,
            Command::Lead { pad, mm, within_s } => self.lead(pad, mm, within_s)?,
            _ => {
                return Err("expected arm, disable, enable, target or wall: this is a board".into());
            }
        }
        self.inputs += 1;
        Ok(())
    }

    fn advance(&mut self) -> Result<Step, String> {
        if self.queue.is_empty() {
            self.ticks += 1;
            let queue = &mut self.queue;
            self.session.poll(|event| queue.push_back(event));
            if self.queue.is_empty() {
                self.flush_record();
            }
        }
        let mut step = Step::default();
        match self.queue.pop_front() {
            Some(SessionEvent::Frame(packet)) => {
                let row = self.row(&packet);
                self.record_row(&row);
                step.event = self.pads.add(&row, &self.walls);
                self.rows += 1;
                step.row = Some((self.rows - 1, row));
            }
            Some(SessionEvent::Note(note)) => {
                self.record_note(&note);
                self.listener.iter_mut().for_each(|listener| listener(&note));
                step.note = Some(note);
            }
            Some(SessionEvent::Phase(Phase::Measuring)) => self.begin(),
            Some(SessionEvent::Phase(_)) | None => (),
        }
        step.more = !self.queue.is_empty();
        Ok(step)
    }

    fn frames(&self) -> Frames {
        let age_s = self.session.link().age().as_secs_f64();
        let mut pads = self.pads.rows(self.time_s + age_s);
        // What is old is not shown as if it were so.
        if !self.session.is_measuring() || age_s > OLD_S {
            pads.iter_mut().for_each(|row| row.state = State::Lost);
        }
        Frames {
            slot: self.rows,
            time_s: self.time_s,
            pads,
            terminals: Vec::new(),
            voltages: Vec::new(),
            walls: self.walls.iter().map(|wall| wall.mm).collect(),
            game: None,
        }
    }

    fn codes(&self) -> SlotCodes {
        SlotCodes {
            slot: self.rows,
            pad: 0,
            channels: Vec::new(),
            full_scale: 1,
            sample_rate_hz: self.device.device.sample_rate_hz,
            codes: Vec::new(),
        }
    }

    fn record(&self, _: Recording) -> Result<Recorded, String> {
        Err("record: expected a scene; --record FILE.csv of hapticore host writes a board's rows"
            .into())
    }

    fn is_real(&self) -> bool {
        true
    }

    fn line(&self) -> Option<LineStatus> {
        let counts = self.session.statistics();
        Some(LineStatus {
            name: self.session.link().name(),
            phase: self.session.phase().word(),
            armed: self.session.phase() == Phase::Armed,
            age_ms: (1e3 * self.session.link().age().as_secs_f64()).round(),
            packets: counts.frames + counts.heartbeats,
            lost: counts.lost,
            dropped: counts.dropped,
            damaged: counts.damaged,
            refused: counts.refused,
        })
    }
}
