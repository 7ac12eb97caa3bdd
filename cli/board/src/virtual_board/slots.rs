// SPDX-License-Identifier: MIT OR Apache-2.0
//! Slots and heartbeats of a virtual board, and the packets that they send.

use anyhow::{Context, Result};
use hapticore_host::{Dac, Heartbeat, Message, Packet, Status};
use hapticore_run::engine::Signals;

use super::core::Core;
use super::state::State;
use super::words::DriveWords;
use super::{PAUSE_CLOCKS, VirtualBoard};
use crate::faults::gains;

/// The most bytes that wait for the host; then the oldest are lost.
const MOST_BYTES: usize = 1 << 20;

impl VirtualBoard {
    pub(super) fn run_slot(&mut self) -> Result<()> {
        if self.state.is_core_old {
            self.make_core();
        }
        let (signals, _) = self.maker.signals(self.slot);
        let Signals::Samples { mut codes, .. } = signals else { return Ok(()) };
        let pad = self.slot % self.profile.pads as usize;
        let limit = self.profile.formats.adc.max_code() as i32;
        let gains = gains(self.state.part.inputs().0);
        self.faults.act(pad, &mut codes, (self.profile.channels(), limit), &gains);
        let end_s = self.case.clock.seconds(self.slot + 1);
        self.slot += 1;
        let core = self.state.core.as_mut().context("an enabled board has a core")?;
        let (frame, drive) = core.slot(pad, &codes);
        let is_open = self.is_open(frame.flags.lost);
        if is_open && self.made.output.is_some() {
            let at_s = end_s + self.case.drive_latency_s()?;
            (0..self.profile.pads as usize).for_each(|pad| self.set_drive(pad, at_s, 0.0));
        }
        if let Some(drive) = drive {
            let follows = self.state.drive.as_ref().is_some_and(DriveWords::drives);
            let follows = follows && !is_open;
            let core = self.state.core.as_mut().and_then(Core::driven);
            let core = core.context("a drive word of a core with a controller")?;
            let fraction = core.keep(&drive, follows, &self.profile);
            let at_s = end_s + self.case.drive_latency_s()?;
            let output = self.made.output.context("a board with a controller has a drive")?;
            let volts = f64::from(output.full_scale_v) * converted(fraction, output.dac);
            self.set_drive(drive.pad, at_s, volts);
        }
        self.state.sequence = self.state.sequence.wrapping_add(1);
        if self.state.busy_until_s > end_s {
            self.state.overrun = true;
            return Ok(());
        }
        let status = self.status();
        self.send(end_s, &Message::Frame(Packet { status, frame }));
        Ok(())
    }

    /// Whether a terminal was open in a frame or in the round of pads before it, as the frame says: then drives are at zero,
    /// and the controller begins anew behind it.
    fn is_open(&mut self, lost: bool) -> bool {
        let state = &mut self.state;
        state.open = if lost { self.profile.pads as usize } else { state.open.saturating_sub(1) };
        state.is_core_old |= state.open == 1 && state.drive.is_some();
        state.open > 0
    }

    /// What a packet says of the line; it is said once.
    pub(super) fn status(&mut self) -> Status {
        let state = &mut self.state;
        let core = state.core.as_mut().and_then(Core::driven).map(|core| core.driven);
        Status {
            sequence: state.sequence,
            late: false,
            refused: std::mem::take(&mut state.refused),
            overrun: std::mem::take(&mut state.overrun),
            commands: state.commands,
            driven: self.made.output.map(|_| core.unwrap_or_default()),
        }
    }

    pub(super) fn send_heartbeat(&mut self) {
        let begin_s = self.state.next_heartbeat_s;
        let status = self.status();
        let mut heartbeat = Heartbeat::new(status, &self.profile, self.made.output.as_ref());
        heartbeat.calibrated = self.state.calibrated;
        for (number, bits) in self.state.told.iter().enumerate() {
            if let Some(bits) = bits {
                heartbeat = heartbeat.with_word(number, *bits, &self.profile);
            }
        }
        if let Some((answer, sent)) = self.state.answer {
            heartbeat = heartbeat.with_adc_answer(answer, sent, &self.profile);
        }
        self.send(begin_s, &Message::Heartbeat(heartbeat));
        self.state.next_heartbeat_s = self.state.busy_until_s + PAUSE_CLOCKS / self.made.clock_hz;
    }

    pub(super) fn send(&mut self, begin_s: f64, message: &Message) {
        let bytes = message.encode(&self.profile);
        let begin_s = begin_s.max(self.state.busy_until_s);
        self.state.busy_until_s = begin_s + 10.0 * bytes.len() as f64 / f64::from(self.made.baud);
        self.waiting += bytes.len();
        self.sent.push_back((self.state.busy_until_s, bytes));
        while self.waiting > MOST_BYTES {
            let oldest = self.sent.pop_front().map_or(0, |(_, bytes)| bytes.len());
            self.waiting -= oldest;
        }
    }

    pub(super) fn make_core(&mut self) {
        let State { sensor, drive, .. } = &self.state;
        let calibration = sensor.calibration(&self.profile, &self.like);
        let core = Core::new(&self.profile, &calibration, drive.as_ref());
        // The profile of a case with a controller has one.
        (self.state.core, self.state.is_core_old) = (core.ok(), false);
        self.ticks = (1e3 * self.now_s) as u64;
    }

    /// Milliseconds of the controller.
    pub(super) fn tick(&mut self) {
        let now = (1e3 * self.now_s) as u64;
        let ticks = now.saturating_sub(self.ticks);
        self.ticks = now;
        if let Some(core) = self.state.core.as_mut().and_then(Core::driven) {
            (0..ticks.min(2000)).for_each(|_| core.tick());
        }
    }
}

/// What a converter makes of a drive, fractions of full scale: codes of 16 bits, or pulses whose mean is the drive.
fn converted(fraction: f64, dac: Dac) -> f64 {
    const CODES: f64 = 65_536.0;
    match dac {
        Dac::Pulses => fraction,
        Dac::Ad5664 | Dac::Ad5664r | Dac::Ad5668 | Dac::Parallel => {
            (fraction * CODES).round_ties_even().min(CODES - 1.0) / CODES
        }
    }
}
