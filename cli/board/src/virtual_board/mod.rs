// SPDX-License-Identifier: MIT OR Apache-2.0
//! A virtual board: a scene behind the registers and packets of a board, in device time.
//!
//! ```text
//! bytes of the host ─ CommandDecoder ─ words ─┬─ ADC's registers ─ heartbeats ─┐
//!                                             └─ core, controller ─ frames ────┴─ bytes to the host
//!                          plant ─ codes ─[faults]─┘       └─ drives ─ plant
//! ```
//!
//! The core is fidelity `fixed`, calibrated by the words that the host has written and nothing else. Simplified against
//! the gateware: commands are taken without the time that their bytes need, a heartbeat is never cut, a new setting of
//! the controller makes it begin anew at 0 V, and a frame's packet begins as its slot ends.

mod core;
mod words;

use std::collections::VecDeque;
use std::sync::Arc;

use anyhow::{Context, Result, ensure};
use hapticore_contract::calibration::Calibration;
use hapticore_contract::profile::Profile;
use hapticore_host::ad7606c::Part;
use hapticore_host::{
    Command, CommandDecoder, DriveWord, Heartbeat, Message, Output, Packet, Register, Status,
};
use hapticore_protocol::Control;
use hapticore_run::case::Case;
use hapticore_run::engine::{Fidelity, Signals};
use hapticore_run::inputs::{timing, windowed};
use hapticore_run::maker::Maker;
use hapticore_scene::{Plant, Scene, Timing};

use self::core::Core;
use self::words::{DriveWords, SensorWords};
use crate::faults::Faults;

/// The ID of an AD7606C-18.
const ADC_ID: u8 = 0x31;
/// Clocks between two heartbeats.
const PAUSE_CLOCKS: f64 = 16_384.0;
/// Samples of the test of a data line.
const TEST_SAMPLES: f64 = 67.0;
/// The most bytes that wait for the host; then the oldest are lost.
const MOST_BYTES: usize = 1 << 20;

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

/// What a reset clears.
struct State {
    sensor: SensorWords,
    drive: Option<DriveWords>,
    part: Part,
    control: i64,
    commands: u8,
    calibrated: bool,
    refused: bool,
    overrun: bool,
    sequence: u16,
    /// Words of heartbeats that were written.
    told: [Option<u64>; Register::ALL.len()],
    /// What the ADC put out during the last word that was sent to it, and that word; none during a test of a line.
    answer: Option<(u16, u16)>,
    /// When the test of a line is over, and the line.
    test: Option<(f64, usize)>,
    core: Option<Core>,
    /// Words were written since it was made.
    is_core_old: bool,
    /// When the packet on the line ends.
    busy_until_s: f64,
    next_heartbeat_s: f64,
}

impl VirtualBoard {
    /// A virtual board of case `index` of a scene, just configured. `made` receives the case and says how it is made.
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
        let mut plant = case.plant()?;
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

    /// Takes the scene's haptic voltage to zero, where no controller drives the pads.
    pub fn switch_haptic_off(&mut self) {
        for pad in 0..self.profile.pads as usize {
            self.set_drive(pad, self.now_s, 0.0);
        }
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

    fn command(&mut self, command: Option<Command>) {
        let is_adc = matches!(command, Some(Command::Register(Register::Adc, _)));
        if is_adc && (self.is_enabled() || self.state.is_test()) {
            self.state.refused = true;
            return;
        }
        self.state.commands = (self.state.commands + 1) % 16;
        match command {
            Some(Command::Register(Register::Control, code)) => self.control(code),
            Some(Command::Register(register, code)) => self.register(register, code),
            Some(Command::Table { address, code }) => self.table(address, code),
            Some(Command::Drive(word, code)) => self.drive_word(word, code),
            None => (),
        }
    }

    fn register(&mut self, register: Register, code: i64) {
        let state = &mut self.state;
        state.told[register.number()] = Some(code as u64);
        match register {
            Register::Constant(constant) => {
                state.sensor.constants[constant as usize] = code;
                state.calibrated |= register == Register::LAST_CONSTANT;
                self.calibrate();
            }
            Register::Adc => {
                let answer = self.faults.answer(state.part.answer());
                let bits: Vec<_> = (0..16).rev().map(|bit| code >> bit & 1).collect();
                // The part refuses it silently, as it does at its pins.
                let _ = state.part.word(&bits);
                state.told[register.number()] = None;
                state.answer = Some((answer, code as u16));
            }
            Register::Control => (),
        }
    }

    fn table(&mut self, address: u16, code: i64) {
        let address_bits = usize::BITS - (self.state.sensor.table.len() - 1).leading_zeros();
        let address = usize::from(address) & ((1 << address_bits) - 1);
        if let Some(word) = self.state.sensor.table.get_mut(address) {
            *word = code;
            self.calibrate();
        }
    }

    /// Words of the calibration hold immediately.
    fn calibrate(&mut self) {
        self.state.is_core_old = true;
    }

    fn drive_word(&mut self, word: DriveWord, code: i64) {
        let Some(drive) = &mut self.state.drive else { return };
        self.state.is_core_old |= drive.write(word, code);
        let pad = match word {
            DriveWord::Target(pad) | DriveWord::Surface { pad, .. } => usize::from(pad),
            _ => 0,
        };
        let (state, profile) = (&mut self.state, &self.profile);
        if let (Some(drive), Some(core)) =
            (&state.drive, state.core.as_mut().and_then(Core::driven))
            && pad < drive.targets.len()
        {
            core.hear(pad, drive, profile);
        }
    }

    fn control(&mut self, code: i64) {
        let was_enabled = self.is_enabled();
        self.state.control = code;
        if code >> Control::ADC_RESET & 1 != 0 {
            self.state.part.reset();
        }
        if self.state.is_test() {
            let samples_s = TEST_SAMPLES / self.case.clock.sample_rate_hz();
            let line = (code >> Control::LINE & 7) as usize;
            self.state.test = Some((self.now_s + samples_s, line));
            (self.state.told[Register::Adc.number()], self.state.answer) = (Some(0), None);
        } else {
            self.state.test = None;
        }
        match (was_enabled, self.is_enabled()) {
            (false, true) => {
                // Enabling begins with a slot of the first pad, the plant's slots are at fixed times.
                let slots = (self.now_s / self.case.clock.seconds(1)).ceil() as usize;
                let served = self.profile.pads as usize;
                self.slot = slots.next_multiple_of(served).max(self.slot.next_multiple_of(served));
                self.state.is_core_old = true;
            }
            (true, false) => self.disable(),
            (false, false) => self.state.drive.iter_mut().for_each(DriveWords::disable),
            (true, true) => (),
        }
    }

    fn disable(&mut self) {
        self.state.core = None;
        self.state.drive.iter_mut().for_each(DriveWords::disable);
        self.state.next_heartbeat_s =
            self.state.busy_until_s.max(self.now_s) + PAUSE_CLOCKS / self.made.clock_hz;
        self.quieten();
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

    fn make_core(&mut self) {
        let State { sensor, drive, .. } = &self.state;
        let calibration = sensor.calibration(&self.profile, &self.like);
        let core = Core::new(&self.profile, &calibration, drive.as_ref());
        // The profile of a case with a controller has one.
        (self.state.core, self.state.is_core_old) = (core.ok(), false);
        self.ticks = (1e3 * self.now_s) as u64;
    }

    /// Milliseconds of the controller.
    fn tick(&mut self) {
        let now = (1e3 * self.now_s) as u64;
        let ticks = now.saturating_sub(self.ticks);
        self.ticks = now;
        if let Some(core) = self.state.core.as_mut().and_then(Core::driven) {
            (0..ticks.min(2000)).for_each(|_| core.tick());
        }
    }

    fn end_test(&mut self) {
        let Some((at_s, line)) = self.state.test.filter(|(at_s, _)| *at_s <= self.now_s) else {
            return;
        };
        let _ = at_s;
        self.state.test = None;
        let bits = u32::from(self.profile.formats.adc.width);
        // Samples of a display at work are not the same 64 times.
        let Some(mut codes) = self.state.part.fixed_codes(bits) else { return };
        codes.truncate(self.profile.channels());
        self.faults.on_lines(&mut codes);
        let code = codes.get(line).copied().unwrap_or(0);
        let code = u64::from(code as u32) & ((1 << bits) - 1);
        self.state.told[Register::Adc.number()] = Some(code);
    }

    fn run_slot(&mut self) -> Result<()> {
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
        if let Some(drive) = drive {
            let follows = self.state.drive.as_ref().is_some_and(DriveWords::drives);
            let core = core.driven().context("a drive word of a core with a controller")?;
            let fraction = core.keep(&drive, follows, &self.profile);
            let full_scale_v =
                self.made.output.map_or(0.0, |output| f64::from(output.full_scale_v));
            let at_s = end_s + self.case.drive_latency_s()?;
            self.set_drive(drive.pad, at_s, full_scale_v * fraction);
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

    /// What a packet says of the line; it is said once.
    fn status(&mut self) -> Status {
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

    fn send_heartbeat(&mut self) {
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

    fn send(&mut self, begin_s: f64, message: &Message) {
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
}

/// Codes of the ADC's channels by those at ±10 V, of the registers of its ranges.
fn gains(ranges: [u8; 4]) -> [f64; 8] {
    const VOLTS: [f64; 5] = [2.5, 5.0, 6.25, 10.0, 12.5];
    std::array::from_fn(|channel| {
        let range = ranges[channel / 2] >> (4 * (channel % 2)) & 0xf;
        VOLTS.get(usize::from(range)).map_or(1.0, |volts| 10.0 / volts)
    })
}

impl State {
    fn new(profile: &Profile, words: usize, clock_hz: f64) -> Self {
        let pads = profile.pads as usize;
        State {
            sensor: SensorWords::new(words),
            drive: profile.control.as_ref().map(|control| DriveWords::new(control, pads)),
            part: Part::new(ADC_ID),
            control: 0,
            commands: 0,
            calibrated: false,
            refused: false,
            overrun: false,
            sequence: 0,
            told: [None; Register::ALL.len()],
            answer: None,
            test: None,
            core: None,
            is_core_old: true,
            busy_until_s: 0.0,
            next_heartbeat_s: PAUSE_CLOCKS / clock_hz,
        }
    }

    fn is_enabled(&self) -> bool {
        self.control >> Control::ENABLE & 1 != 0
    }

    fn is_test(&self) -> bool {
        self.control >> Control::LINE_TEST & 1 != 0 && !self.is_enabled()
    }
}
