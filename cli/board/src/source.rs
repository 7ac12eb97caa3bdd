// SPDX-License-Identifier: MIT OR Apache-2.0
//! A board as what a live page shows and drives: measured columns only.
//!
//! ```text
//! Session ─ frames ─ Readout ─ rows ─┬─ CSV
//!    ↑                               └─ Pads ─ page
//!    └─ arm, disable, target, wall ─ commands of clients
//! ```

use std::collections::VecDeque;
use std::io::Write;

use hapticore_contract::profile::Profile;
use hapticore_host::link::{Phase, Session, SessionEvent, Statistics};
use hapticore_host::{COLUMNS as CSV_COLUMNS, Packet, Readout, SlotClock};
use hapticore_live::pads::{Pads, Surface};
use hapticore_live::protocol::{
    COLUMNS, Command, Frames, Hello, InputInfo, Limits, LineStatus, Pad, Recorded, Recording,
    Setting, SlotCodes, VERSION, Wall,
};
use hapticore_live::source::{Source, Step};
use hapticore_live::state::State;

use hapticore_run::record::{Driven, Provenance, Row};

use crate::target::{Described, Target};
use crate::virtual_line::Running;

/// How often the line is looked at, s.
const TICK_S: f64 = 0.004;
/// Without a frame for this long a pad's values are not shown as present, s.
const OLD_S: f64 = 1.0;
/// After which time a finger that is led arrives, s: as on a simulated display.
const GLIDE_S: f64 = 0.012;
/// Beyond every sheet, mm: where a wall is that is off.
const FAR_MM: f64 = 1e4;

/// Where rows are written as CSV.
type Csv = Box<dyn Write + Send>;

/// A board with its session.
pub struct Board {
    session: Session,
    readout: Readout,
    device: hapticore_host::DeviceCalibration,
    hello: Hello,
    parts_mm: Vec<[f64; 2]>,
    running: Option<Running>,
    pads: Pads,
    walls: Vec<Surface>,
    targets_n: Vec<f64>,
    clock: SlotClock,
    /// Sequence number of the first frame since the board was enabled, and the time of the last.
    base: Option<u16>,
    time_s: f64,
    ticks: usize,
    rows: usize,
    inputs: usize,
    queue: VecDeque<SessionEvent>,
    csv: Option<Csv>,
    /// Why rows are no longer written.
    csv_error: Option<String>,
    notes: Vec<String>,
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
            targets_n: vec![0.0; pads],
            clock,
            base: None,
            time_s: 0.0,
            ticks: 0,
            rows: 0,
            inputs: 0,
            queue: VecDeque::new(),
            csv: None,
            csv_error: None,
            notes: Vec::new(),
        }
    }

    /// The same, which writes each row as CSV, the columns of `frames.csv`.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn with_csv(mut self, mut csv: Csv) -> std::io::Result<Board> {
        writeln!(csv, "{}", CSV_COLUMNS.join(","))?;
        self.csv = Some(csv);
        Ok(self)
    }

    /// The session.
    pub fn session(&mut self) -> &mut Session {
        &mut self.session
    }

    /// Where it is.
    pub fn phase(&self) -> Phase {
        self.session.phase()
    }

    /// What has come so far.
    pub fn statistics(&self) -> Statistics {
        self.session.statistics()
    }

    /// What has been noted since it was asked last.
    pub fn take_notes(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notes)
    }

    /// Why rows are no longer written, where that is so.
    pub fn csv_error(&self) -> Option<&str> {
        self.csv_error.as_deref()
    }

    /// Sets the target of a pad, N: of each of its parts.
    ///
    /// # Errors
    /// No such pad, a force beyond the cap.
    pub fn set_target(&mut self, pad: usize, newtons: f64) -> Result<(), String> {
        let pads = self.targets_n.len();
        if pad >= pads {
            return Err(format!("pad: expected below {pads}, got {pad}"));
        }
        let parts = self.parts_mm.len();
        for part in pad * parts..(pad + 1) * parts {
            self.session.set_target(part, newtons).map_err(|error| error.to_string())?;
        }
        self.targets_n[pad] = newtons;
        Ok(())
    }

    /// Moves the wall along x: it is known by the number of each pad's last part.
    fn set_wall(&mut self, x_mm: Option<f64>, y_mm: Option<f64>, off: bool) -> Result<(), String> {
        let Some(wall) = self.walls.first().copied() else {
            return Err("wall: expected a board whose profile has walls".into());
        };
        if y_mm.is_some() {
            return Err("wall: expected x_mm: walls along y are not set from here".into());
        }
        let mm = if off { if wall.above { FAR_MM } else { -FAR_MM } } else { x_mm.unwrap_or(0.0) };
        let (parts, last_mm) = (self.parts_mm.len(), self.parts_mm.last().map_or(0.0, |of| of[0]));
        for pad in 0..self.targets_n.len() {
            let number = pad * parts + parts - 1;
            let set = self.session.set_surface(number, mm + last_mm, wall.above);
            set.map_err(|error| error.to_string())?;
        }
        self.walls[0].mm = (!off).then_some(mm);
        Ok(())
    }

    fn lead(&mut self, pad: usize, mm: [f64; 2], within_s: Option<f64>) -> Result<(), String> {
        let Some(running) = &self.running else {
            return Err(
                "lead: expected a virtual board: the pads of this one are led by hand".into()
            );
        };
        let within_s = within_s.unwrap_or(GLIDE_S);
        running.lead(pad, mm, within_s).map_err(|error| format!("{error:#}"))
    }

    fn row(&mut self, packet: &Packet) -> Row {
        let Packet { status, frame } = packet;
        let base = *self.base.get_or_insert(status.sequence);
        let number = status.sequence.wrapping_sub(base).wrapping_add(1);
        self.time_s = self.clock.time_of(number);
        let profile = &self.session.plan().profile;
        let measurement = frame.measurement(profile);
        let (measured, flags) = self.readout.convert(&measurement);
        let driven = status.driven.map(|driven| {
            let pad = usize::from(driven.pad) / self.parts_mm.len();
            let full_scale_v =
                self.session.plan().output.map_or(0.0, |output| f64::from(output.full_scale_v));
            let format = profile.control.as_ref().map(|control| control.drive);
            let fraction = format.map_or(0.0, |format| format.real(driven.word));
            Driven {
                target_n: self.targets_n.get(pad).copied().unwrap_or(0.0),
                drive_v_rms: full_scale_v * fraction,
                limited: driven.low || driven.high,
                fault: driven.faults.any(),
                free: profile.wall.map(|_| driven.free),
                core_n: None,
            }
        });
        Row {
            case: 0,
            time_s: self.time_s,
            pad: frame.pad,
            measured,
            flags,
            laws: None,
            truth: None,
            driven,
            reference: None,
        }
    }

    fn write(&mut self, row: &Row) {
        let Some(csv) = &mut self.csv else { return };
        let numbers = row.measured.values().map(|number| number.to_string());
        let numbers: Vec<_> = numbers.into_iter().collect();
        let written =
            writeln!(csv, "{},{},{},{}", row.time_s, row.pad, numbers.join(","), row.flags);
        if let Err(error) = written {
            (self.csv, self.csv_error) = (None, Some(error.to_string()));
        }
    }

    /// Frames count anew: the board was brought up.
    fn begin(&mut self) {
        let rate_hz = self.device.device.sample_rate_hz;
        let start_s = if self.base.is_some() { self.time_s } else { 0.0 };
        self.clock = SlotClock::new(&self.session.plan().profile, rate_hz, start_s);
        self.base = None;
    }

    fn flush(&mut self) {
        if let Some(csv) = &mut self.csv
            && let Err(error) = csv.flush()
        {
            (self.csv, self.csv_error) = (None, Some(error.to_string()));
        }
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
            Command::Arm { on: false } => {
                self.targets_n.fill(0.0);
                self.session.disarm();
            }
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
                self.flush();
            }
        }
        let mut step = Step::default();
        match self.queue.pop_front() {
            Some(SessionEvent::Frame(packet)) => {
                let row = self.row(&packet);
                self.write(&row);
                step.event = self.pads.add(&row, &self.walls);
                self.rows += 1;
                step.row = Some((self.rows - 1, row));
            }
            Some(SessionEvent::Note(note)) => {
                self.notes.push(note.clone());
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

/// What a page must know of a board.
fn hello(
    profile: &Profile,
    device: &hapticore_host::DeviceCalibration,
    described: &Described,
    (name, is_virtual): (&str, bool),
) -> Hello {
    let clock = SlotClock::new(profile, device.device.sample_rate_hz, 0.0);
    let provenance = Provenance::new();
    let pad = |name: &String| Pad { name: name.clone(), parts_mm: described.parts_mm.clone() };
    let target = profile.control.as_ref().map(|control| InputInfo {
        name: "pad.target_n",
        unit: "N",
        label: "Target force",
        least: 0.0,
        most: control.target.real(control.target.max_code() as i64).min(1.0),
        value: 0.0,
        per: "pad",
    });
    let wall = profile.wall.map(|_| Wall { axis: "x", mm: 0.0, inside: "below" });
    Hello {
        protocol: VERSION,
        version: provenance.version,
        commit: provenance.commit,
        source: "board",
        scene: name.to_string(),
        title: described.title.clone(),
        profile: profile.name.clone(),
        fidelity: if is_virtual { "virtual board’s" } else { "board’s" }.into(),
        command: format!("hapticore host {name} --page"),
        slot_us: 1e6 * clock.seconds(1),
        parts: described.parts_mm.len(),
        pads: described.pads.iter().map(pad).collect(),
        sheet_mm: described.sheet_mm,
        pad_diameter_mm: described.pad_diameter_mm,
        terminals_mm: described.terminals_mm.clone(),
        columns: COLUMNS.to_vec(),
        inputs: target.into_iter().collect(),
        controller: profile.control.is_some(),
        walls: wall.into_iter().collect(),
        limits: Limits { rail_v: described.rail_v, ..Limits::default() },
        leads: is_virtual,
        truth: false,
        speed: 1.0,
        ..Hello::default()
    }
}
