// SPDX-License-Identifier: MIT OR Apache-2.0
//! A board over a session in real time: a hand puts the pads where it is asked to.

use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use hapticore_contract::calibration::Calibration;
use hapticore_contract::profile::Profile;
use hapticore_host::link::{Phase, Plan, Session, SessionEvent};
use hapticore_host::startup::{AdcSetup, LineFault, StartupError};
use hapticore_host::{Packet, SlotClock};

use super::{Bench, MOVES_S, Place, SWINGS_S};
use crate::target::Target;
use crate::virtual_board::VirtualBoard;
use crate::virtual_line::Running;

/// How long a board may take for a start-up, and for the frames of a place.
const PATIENCE: Duration = Duration::from_secs(30);
/// How often the line is looked at.
const PAUSE: Duration = Duration::from_millis(2);

/// Asks a user for something, and returns once it is done.
type Ask<'a> = Box<dyn FnMut(&str) -> Result<()> + 'a>;

/// A board over a line, and who moves its pads.
pub struct RealTime<'a> {
    session: Session,
    parts_mm: Vec<Place>,
    running: Option<Running>,
    /// Frames until pads that were moved have come to rest: a virtual board's time may go slower than the clock's.
    moving: usize,
    ask: Ask<'a>,
    stop: &'a dyn Fn() -> bool,
    say: Box<dyn FnMut(&str) + 'a>,
}

impl<'a> RealTime<'a> {
    /// A board that is not yet connected. `ask` has the user of a real board move pads; `say` reports progress.
    pub fn new(
        target: Target,
        ask: impl FnMut(&str) -> Result<()> + 'a,
        say: impl FnMut(&str) + 'a,
        stop: &'a dyn Fn() -> bool,
    ) -> Self {
        let Target { line, plan, device, described, running } = target;
        let slot_s = SlotClock::new(&plan.profile, device.device.sample_rate_hz, 0.0).seconds(1);
        if let Some(running) = &running {
            running.with(VirtualBoard::hold_still);
        }
        RealTime {
            session: Session::new(line, Plan { all_lines: true, tuning: None, ..plan }),
            parts_mm: described.parts_mm,
            running,
            moving: ((MOVES_S + SWINGS_S) / slot_s).ceil() as usize,
            ask: Box::new(ask),
            stop,
            say: Box::new(say),
        }
    }

    /// Polls once; the frames that have come.
    fn poll(&mut self) -> Result<Vec<Packet>> {
        if (self.stop)() {
            bail!("interrupted");
        }
        let (mut frames, mut notes) = (Vec::new(), Vec::new());
        self.session.poll(|event| match event {
            SessionEvent::Frame(packet) => frames.push(packet),
            SessionEvent::Note(note) => notes.push(note),
            SessionEvent::Phase(_) => (),
        });
        notes.iter().for_each(|note| (self.say)(note));
        if frames.is_empty() {
            thread::sleep(PAUSE);
        }
        Ok(frames)
    }
}

impl Bench for RealTime<'_> {
    fn profile(&self) -> &Profile {
        &self.session.plan().profile
    }

    fn parts_mm(&self) -> &[Place] {
        &self.parts_mm
    }

    fn bring_up(
        &mut self,
        calibration: &Calibration,
        adc: &AdcSetup,
        _lines: bool,
    ) -> Result<Vec<(u8, LineFault)>> {
        let plan = self.session.plan().clone();
        self.session.begin_again(Plan { calibration: calibration.clone(), adc: *adc, ..plan });
        let begun = Instant::now();
        while begun.elapsed() < PATIENCE {
            self.poll()?;
            match (self.session.phase(), self.session.refusal()) {
                (Phase::Measuring, _) => return Ok(Vec::new()),
                (Phase::Refused, Some(StartupError::Line { .. })) => {
                    return Ok(self.session.line_faults().to_vec());
                }
                (Phase::Refused, Some(error)) => return Err(error.clone().into()),
                _ => (),
            }
        }
        bail!("expected a board that starts up within {} s", PATIENCE.as_secs())
    }

    fn put(&mut self, places: &[Place]) -> Result<()> {
        for (pad, [x, y]) in places.iter().enumerate() {
            match &self.running {
                Some(running) => running.lead(pad, [*x, *y], MOVES_S)?,
                None => (self.ask)(&format!("put pad {pad} at x = {x:.0} mm, y = {y:.0} mm"))
                    .with_context(|| format!("pad {pad}"))?,
            }
        }
        let mut frames = 0;
        while frames < self.moving {
            frames += self.next_frames()?.len();
        }
        Ok(())
    }

    fn next_frames(&mut self) -> Result<Vec<Packet>> {
        let begun = Instant::now();
        while begun.elapsed() < PATIENCE {
            let packets = self.poll()?;
            if !packets.is_empty() {
                return Ok(packets);
            }
        }
        bail!("expected frames of each pad, the board is {}", self.session.phase().word())
    }

    fn tell(&mut self, text: &str) {
        (self.say)(text);
    }
}
