// SPDX-License-Identifier: MIT OR Apache-2.0
//! A virtual board: a scene behind the registers and packets of a board, in device time.
//!
//! ```text
//! bytes of the host ─ CommandDecoder ─ words ─┬─ ADC's registers ─ heartbeats ─┐
//!                                             └─ core, controller ─ frames ────┴─ bytes to the host
//!                          plant ─ codes ─[faults]─┘       └─ drives ─ plant
//! ```
//!
//! The core is fidelity `fixed`, calibrated by the words that the host has written and nothing else. In what it is simpler
//! than the gateware, docs/first-light.md lists; `tests/clocked_board` compares the rest with the clocked gateware.

mod commands;
mod core;
mod slots;
mod state;
mod words;

use std::collections::VecDeque;
use std::sync::Arc;

use anyhow::{Result, ensure};
use hapticore_contract::calibration::Calibration;
use hapticore_contract::profile::Profile;
use hapticore_host::{CommandDecoder, Output};
use hapticore_run::case::Case;
use hapticore_run::engine::Fidelity;
use hapticore_run::inputs::{timing, windowed};
use hapticore_run::maker::Maker;
use hapticore_scene::{Plant, Scene, Timing};

use self::core::Core;
use self::state::State;
use crate::faults::Faults;

/// Inputs of the plant begin so much later than now, s: no slot has seen their time.
const MARGIN_S: f64 = 0.01;
/// Clocks between two heartbeats.
const PAUSE_CLOCKS: f64 = 16_384.0;

/// How a virtual board is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Made {
    /// Bits a second of its line.
    pub baud: u32,
    /// Its clock.
    pub clock_hz: f64,
    /// What it drives its pads with; none where the scene has no controller.
    pub output: Option<Output>,
}

/// A virtual board.
pub struct VirtualBoard {
    case: Case,
    profile: Arc<Profile>,
    made: Made,
    maker: Maker,
    like: Calibration,
    /// What is wrong with it.
    pub faults: Faults,
    decoder: CommandDecoder,
    state: State,
    now_s: f64,
    slot: usize,
    /// Milliseconds that the controller has counted.
    ticks: u64,
    /// The latest time that a drive was set for.
    driven_s: f64,
    sent: VecDeque<(f64, Vec<u8>)>,
    waiting: usize,
}

impl VirtualBoard {
    /// A virtual board of case `index` of a scene, at the first point of its sweep, just configured. `made` receives the case and says how it is made.
    ///
    /// # Errors
    /// A case that the profile cannot serve, a calibration that it cannot represent, a scene without samples.
    pub fn new(
        scene: Scene,
        index: usize,
        profile: &Profile,
        made: impl FnOnce(&Case) -> Made,
    ) -> Result<Self> {
        let profile = windowed(profile.clone(), &scene)?;
        let scene = Arc::new(scene.within_budget(&Timing { signs: None, ..timing(&profile) })?);
        let case = Case::new(&scene, index, &profile, &[])?;
        case.check(&scene.name, Fidelity::Clock)?;
        ensure!(
            case.profile.pads <= 16,
            "{}: expected at most 16 pads or parts, as a packet numbers them, got {}",
            scene.name,
            case.profile.pads
        );
        let like = case.calibration()?.clone();
        let mut plant = case.plant()?.at_first_point();
        if case.plan().is_some() {
            (0..plant.served()).try_for_each(|pad| plant.set_drive(pad, 0.0, 0.0))?;
        }
        let (profile, made) = (case.profile.clone(), made(&case));
        let maker = Maker::new(plant, &profile, true, false);
        Ok(VirtualBoard {
            state: State::new(&profile, like.words(&profile).len(), made.clock_hz),
            decoder: CommandDecoder::new(&profile),
            faults: Faults::none(1),
            case,
            profile,
            made,
            maker,
            like,
            now_s: 0.0,
            slot: 0,
            ticks: 0,
            driven_s: 0.0,
            sent: VecDeque::new(),
            waiting: 0,
        })
    }

    /// The case.
    pub fn case(&self) -> &Case {
        &self.case
    }

    /// The profile that the board was printed for.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// How it is made.
    pub fn made(&self) -> Made {
        self.made
    }

    /// Its device time, s.
    pub fn now_s(&self) -> f64 {
        self.now_s
    }

    /// The device that it stands for.
    pub fn plant(&mut self) -> &mut Plant {
        self.maker.plant()
    }

    /// Whether it converts and measures.
    pub fn is_enabled(&self) -> bool {
        self.state.is_enabled()
    }

    /// The voltage of each pad's drive word, V; nothing without a drive.
    pub fn drive_v(&mut self) -> f64 {
        let full_scale_v = self.made.output.map_or(0.0, |output| f64::from(output.full_scale_v));
        let control = self.profile.control.clone();
        let driven = self.state.core.as_mut().and_then(Core::driven).map(|core| core.driven.word);
        match (driven, control) {
            (Some(word), Some(control)) => full_scale_v * control.drive.real(word),
            _ => 0.0,
        }
    }

    /// Has the scene's user hold the pads still, with its mean load and without a push, and takes the haptic voltage to
    /// zero where no controller drives the pads.
    pub fn hold_still(&mut self) {
        for pad in 0..self.profile.pads as usize {
            self.set_drive(pad, self.now_s, 0.0);
        }
        let from_s = self.now_s + MARGIN_S;
        hold_still(self.plant(), from_s);
    }

    /// The reset button, or a new configuration.
    pub fn reboot(&mut self) {
        let words = self.state.sensor.table.len();
        self.state = State::new(&self.profile, words, self.made.clock_hz);
        self.state.next_heartbeat_s += self.now_s;
        self.decoder = CommandDecoder::new(&self.profile);
        self.quieten();
    }

    /// Takes bytes of the host, now.
    pub fn receive(&mut self, bytes: &[u8]) {
        for byte in bytes {
            match self.decoder.push(*byte) {
                None => (),
                Some(Err(_)) => self.state.refused = true,
                Some(Ok(command)) => self.command(command),
            }
        }
    }

    /// Lets time pass up to a device time, s.
    ///
    /// # Errors
    /// A drive that the plant does not take.
    pub fn advance(&mut self, until_s: f64) -> Result<()> {
        loop {
            self.tick();
            self.end_test();
            let next_s = match self.is_enabled() {
                true => self.case.clock.seconds(self.slot + 1),
                false => self.state.next_heartbeat_s,
            };
            if next_s > until_s {
                break;
            }
            self.now_s = self.now_s.max(next_s);
            match self.is_enabled() {
                true => self.run_slot()?,
                false => self.send_heartbeat(),
            }
        }
        self.now_s = self.now_s.max(until_s);
        self.tick();
        self.end_test();
        Ok(())
    }

    /// The bytes that have been on the line up to now.
    pub fn take_bytes(&mut self) -> Vec<u8> {
        let mut bytes = Vec::new();
        while self.sent.front().is_some_and(|(at_s, _)| *at_s <= self.now_s) {
            let (_, packet) = self.sent.pop_front().expect("it was there");
            self.waiting -= packet.len();
            bytes.extend(packet);
        }
        self.faults.on_serial_line(&mut bytes);
        bytes
    }

    /// Nobody reads the line: what is on it is lost.
    pub fn lose_bytes(&mut self) {
        self.sent.clear();
        self.waiting = 0;
    }

    /// Drives of all pads to zero, where a controller has them.
    fn quieten(&mut self) {
        if self.made.output.is_none() {
            return;
        }
        for pad in 0..self.profile.pads as usize {
            self.set_drive(pad, self.now_s, 0.0);
        }
    }

    fn set_drive(&mut self, pad: usize, at_s: f64, volts: f64) {
        self.driven_s = self.driven_s.max(at_s);
        let at_s = self.driven_s;
        let set = self.maker.plant().set_drive(pad, at_s, volts);
        debug_assert!(set.is_ok(), "{set:?}");
    }
}

/// Has the scene's user hold the pads of a device still from a time on, s, with its mean load and without a push.
pub fn hold_still(plant: &mut Plant, from_s: f64) {
    let load_g = plant.mean_load_g();
    for pad in 0..plant.served() / plant.parts() {
        // A scene's load is within the range of loads; a pad without a hand has no push.
        let _ = plant.press(pad, load_g, from_s);
        let _ = plant.push(pad, [0.0; 2], from_s);
    }
}
