// SPDX-License-Identifier: MIT OR Apache-2.0
//! A board in device time, whose pads go where they are sent: a virtual one, or one that is clocked.

use std::collections::VecDeque;

use anyhow::{Context, Result, bail};
use hapticore_contract::calibration::Calibration;
use hapticore_contract::profile::Profile;
use hapticore_host::bringup::{BringUp, Step};
use hapticore_host::startup::{AdcSetup, LineFault, StartupError, check, prepare};
use hapticore_host::{Command, Decoder, Heartbeat, Message, Packet, encode};

use super::{Bench, MOVES_S, Place, SWINGS_S, SteppedBoard};
use crate::virtual_board::VirtualBoard;

/// A board in device time, as fast as it computes.
pub struct DeviceTime<B = VirtualBoard> {
    /// The board.
    pub board: B,
    decoder: Decoder,
    profile: Profile,
    parts_mm: Vec<Place>,
    /// Messages that have come and were not yet looked at.
    queue: VecDeque<Message>,
    /// Commands that the board has accepted.
    commands: usize,
}

/// How often the line is looked at, s.
const TICK_S: f64 = 0.002;
/// The longest wait for a packet, s.
const PATIENCE_S: f64 = 2.0;

impl<B: SteppedBoard> DeviceTime<B> {
    /// A board that has just been configured.
    pub fn new(mut board: B) -> Self {
        board.hold_still();
        let profile = board.profile().clone();
        let parts_mm = board.plant().parts_mm().to_vec();
        let (decoder, queue) = (Decoder::new(&profile), VecDeque::new());
        DeviceTime { decoder, queue, profile, board, parts_mm, commands: 0 }
    }

    fn send(&mut self, commands: &[Command]) -> Result<()> {
        self.commands += commands.len();
        self.board.receive(&encode(commands, &self.profile))?;
        // What was sent meanwhile does not know of them all.
        self.queue.clear();
        self.decoder.decode(self.board.take_bytes()).for_each(drop);
        Ok(())
    }

    /// The messages of the next ticks, until one is wanted.
    fn next<T>(&mut self, mut wanted: impl FnMut(Message) -> Option<T>) -> Result<T> {
        let until_s = self.board.now_s() + PATIENCE_S;
        while self.board.now_s() < until_s {
            while let Some(message) = self.queue.pop_front() {
                if let Some(found) = wanted(message) {
                    return Ok(found);
                }
            }
            self.board.advance(self.board.now_s() + TICK_S)?;
            let bytes = self.board.take_bytes();
            self.queue.extend(self.decoder.decode(bytes).flatten());
        }
        bail!("expected a packet within {PATIENCE_S} s")
    }

    /// The first heartbeat that begins after now.
    fn heartbeat(&mut self) -> Result<Heartbeat> {
        let mut skips = 1;
        self.next(|message| {
            let heartbeat = message.heartbeat()?;
            skips -= 1;
            (skips < 0).then_some(heartbeat)
        })
    }

    fn test_lines(
        &mut self,
        calibration: &Calibration,
        adc: &AdcSetup,
    ) -> Result<Vec<(u8, LineFault)>> {
        let output = self.board.output();
        let mut bring_up = BringUp::new(&self.profile, calibration, output).with_all_lines();
        let before = (self.commands % 16) as u8;
        let commands = bring_up.begin(adc, before);
        self.send(&commands)?;
        loop {
            let heartbeat = self.heartbeat()?;
            match bring_up.heartbeat(&heartbeat) {
                Ok(Step::Wait) => (),
                Ok(Step::Send(commands)) => self.send(&commands)?,
                Ok(Step::Ready(enable)) => {
                    self.send(&[enable])?;
                    return Ok(Vec::new());
                }
                Err(StartupError::Line { .. }) => return Ok(bring_up.line_faults().to_vec()),
                Err(error) => return Err(error.into()),
            }
        }
    }
}

impl<B: SteppedBoard> Bench for DeviceTime<B> {
    fn profile(&self) -> &Profile {
        &self.profile
    }

    fn parts_mm(&self) -> &[Place] {
        &self.parts_mm
    }

    fn bring_up(
        &mut self,
        calibration: &Calibration,
        adc: &AdcSetup,
        lines: bool,
    ) -> Result<Vec<(u8, LineFault)>> {
        if lines {
            return self.test_lines(calibration, adc);
        }
        let before = (self.commands % 16) as u8;
        let commands = prepare(&self.profile, calibration, adc);
        self.send(&commands)?;
        let heartbeat = self.heartbeat()?;
        let output = self.board.output();
        let sent = (before, commands.len());
        check(&heartbeat, &self.profile, output.as_ref(), calibration, sent)?;
        self.send(&[Command::ENABLE])?;
        Ok(Vec::new())
    }

    fn put(&mut self, places: &[Place]) -> Result<()> {
        let from_s = self.board.now_s() + TICK_S;
        for (pad, place) in places.iter().enumerate() {
            let led = self.board.plant().lead(pad, *place, from_s, from_s + MOVES_S);
            led.with_context(|| format!("pad {pad}"))?;
        }
        // No slot is simulated meanwhile.
        self.send(&[Command::DISABLE])?;
        self.board.rest(from_s + MOVES_S + SWINGS_S)?;
        self.send(&[Command::ENABLE])
    }

    fn next_frames(&mut self) -> Result<Vec<Packet>> {
        Ok(vec![self.next(Message::frame)?])
    }

    fn tell(&mut self, _: &str) {}
}
