// SPDX-License-Identifier: MIT OR Apache-2.0
//! A complete board that drives its pads, with an ADC, a converter and a host at its pins. The ADC sees pads whose
//! capacitance and voltage follow a formula, so that the loop is closed. Every voltage of the converter is watched.

use crate::bench::Bench;
use crate::dac::Dac;
use crate::device::{calibration, short_profiles};
use crate::pins::{Adc, Host};
use crate::session::parameters;
use hapticore_contract::control::{Control, Law, Tuning};
use hapticore_contract::profile::Profile;
use hapticore_host::startup::{AdcSetup, prepare};
use hapticore_host::{
    Command, Decoder, DriveWord, Heartbeat, Message, Packet, Setting, drive, encode,
};
use hapticore_rtl::board::drive_output::serial::Frame;
use hapticore_rtl::board::drive_output::{Converter, Wave};
use hapticore_rtl::board::whole::Inputs;
use hapticore_rtl::board::{Board, Parameters};
use std::f64::consts::TAU;
use std::rc::Rc;

/// Pads of the board.
pub const PADS: usize = 4;
/// The voltage of a drive word of full scale, V.
pub const FULL_SCALE_V: f64 = 500.0;
/// Clocks from a cause that acts immediately to 0 V on every channel: a frame in progress, that of the reference, one
/// per channel, of 51 clocks each, and some to begin.
pub const AT_ONCE: u64 = 7 * 51 + 40;
/// What the codes of a converter leave of a fraction.
const ROUNDING: f64 = 2.0 / 65_536.0;
const CONVERTER: Frame = Frame::AD5664R;

/// A pad at the pins of the ADC.
#[derive(Debug, Clone, Copy)]
pub struct Pad {
    /// Its capacitance, as a fraction of the nominal one.
    pub share: f64,
}

/// What may be driven, by the commands that were sent since the last reset, and what has been.
#[derive(Debug, Clone)]
pub struct Watch {
    /// The largest rail and the largest slew, parts of full scale.
    pub rail: f64,
    pub slew: f64,
    /// Each channel's magnitude, part of full scale.
    pub now: [f64; PADS],
    /// The largest magnitude since [`Rig::mark`], V, and clocks from there to it.
    pub largest_v: f64,
    pub largest_at: u64,
    marked: u64,
}

impl Watch {
    fn new() -> Watch {
        Watch { rail: 0.0, slew: 0.0, now: [0.0; PADS], largest_v: 0.0, largest_at: 0, marked: 0 }
    }

    /// A channel takes a magnitude.
    fn takes(&mut self, channel: usize, magnitude: f64, clock: u64) {
        let before = std::mem::replace(&mut self.now[channel], magnitude);
        let (rail, slew) = (self.rail, self.slew);
        assert!(
            magnitude <= rail + ROUNDING || magnitude <= before,
            "clock {clock}: channel {channel} at {magnitude:.4} of full scale, above the rail {rail:.4} since the reset"
        );
        assert!(
            magnitude <= before + slew + ROUNDING,
            "clock {clock}: channel {channel} from {before:.4} to {magnitude:.4} of full scale, above the slew {slew:.4}"
        );
        self.largest(magnitude, clock);
    }

    fn largest(&mut self, magnitude: f64, clock: u64) {
        if magnitude * FULL_SCALE_V > self.largest_v {
            (self.largest_v, self.largest_at) = (magnitude * FULL_SCALE_V, clock - self.marked);
        }
    }
}

/// The board and what is at its pins.
#[derive(Clone)]
pub struct Rig {
    pub bench: Bench<Board>,
    pub profile: Profile,
    pub adc: Adc,
    pub host: Host,
    pub dac: Dac,
    pub pads: [Pad; PADS],
    pub packets: Vec<Packet>,
    pub heartbeats: Vec<Heartbeat>,
    pub watch: Watch,
    pub clock: u64,
    pub enabled: bool,
    decoder: Decoder,
    /// Of each sample of a slot, the terminals' codes at the nominal capacitance and the sensing voltage's.
    tones: Rc<Vec<Vec<f64>>>,
    /// Conversions before the slot of the first pad that began last.
    first: usize,
    seen: usize,
    written: usize,
}

/// A profile with a controller of this law, its slots so short that tests take little time.
pub fn profile(law: Law) -> Profile {
    let mut profile = short_profiles().swap_remove(1);
    // A curve of few words is sent in little time.
    profile.control = Some(Control { cells: 8, ..Control::of(&profile, law) });
    profile.slot.settle += 150;
    (profile.position.columns, profile.position.rows) = (17, 11);
    profile
}

pub fn parameters_of(profile: &Profile) -> Parameters {
    let drive = (Wave::Square { turn_slots: 1 }, Converter::Serial(CONVERTER)).into();
    Parameters { drive: Some(drive), ..parameters(profile, 4, 0) }
}

/// A lawful tuning: the curve is nine tenths of the root.
pub fn tuning(profile: &Profile, rail: f64, slew: f64) -> Tuning {
    let control = profile.control.as_ref().expect("a controller");
    let cells = control.cells as f64;
    Tuning {
        curve: (0..=control.cells).map(|cell| 0.9 * cell as f64 / cells).collect(),
        full_drive: 1.0 / (HAPTIC * HAPTIC),
        proportional: 0.2,
        correction: 0.1,
        rail,
        slew,
        force_cap: f64::INFINITY,
        walls: None,
    }
}

/// The haptic channel's code at full drive, of the ADC's full scale.
const HAPTIC: f64 = 0.7;

/// What the open loop drives for a force, part of full scale.
pub fn open_drive(profile: &Profile, newtons: f64, rail: f64) -> f64 {
    let control = profile.control.as_ref().expect("a controller");
    (0.9 * newtons.sqrt() / control.root_full_scale()).min(rail)
}

impl Rig {
    pub fn new(law: Law) -> Rig {
        let profile = profile(law);
        Rig::of(profile)
    }

    pub fn of(profile: Profile) -> Rig {
        let parameters = parameters_of(&profile);
        let board = Board::new(&profile, &parameters).expect("a board with a drive");
        let turns = profile.turns_per_sample();
        let full = f64::from(1 << (profile.formats.adc.width - 1));
        let currents = [0.08, 0.05, 0.07, 0.06, 0.09, 0.05];
        let terminals = profile.channels() - 2;
        let tone = |n: u64| -> Vec<f64> {
            let angle = TAU * n as f64 * turns;
            let of_terminals = (0..terminals).map(|k| currents[k] * angle.cos());
            of_terminals.chain([0.8 * angle.cos()]).map(|x| full * x).collect()
        };
        let tones = (0..profile.slot.samples()).map(tone).collect();
        Rig {
            adc: Adc::new(Vec::new(), profile.formats.adc.width, &parameters),
            host: Host::new(parameters.bits().least()),
            dac: Dac::new(),
            pads: [Pad { share: 1.0 }; PADS],
            packets: Vec::new(),
            heartbeats: Vec::new(),
            watch: Watch::new(),
            clock: 0,
            enabled: false,
            decoder: Decoder::new(&profile),
            tones: Rc::new(tones),
            first: 0,
            seen: usize::MAX,
            written: 0,
            bench: Bench::new(board),
            profile,
        }
    }

    /// What the ADC finds at its next conversion.
    fn sample(&self) -> Vec<i32> {
        let samples = self.profile.slot.samples() as usize;
        let since = self.adc.conversions - self.first;
        let pad = since / samples % PADS;
        let tones = &self.tones[since % samples];
        let (sensing, terminals) = tones.split_last().expect("there are channels");
        let full = f64::from(1 << (self.profile.formats.adc.width - 1));
        let voltage = self.dac.voltage(pad).unwrap_or(0) as f64 / 65_536.0;
        let share = self.pads[pad].share;
        let codes = terminals.iter().map(|code| share * code);
        codes.chain([*sensing, full * HAPTIC * voltage]).map(|code| code.round() as i32).collect()
    }

    /// A clock; `pressed`: with the button pressed.
    fn step(&mut self, pressed: bool) {
        self.clock += 1;
        if self.seen != self.adc.conversions {
            self.seen = self.adc.conversions;
            let sample = self.sample();
            self.adc.offer(sample);
        }
        let (busy, dout) = self.adc.pins();
        let rx = self.host.line();
        if pressed {
            self.bench.reset();
        }
        let mut outputs = if pressed {
            self.bench.clone().clock(Inputs { dout, busy, rx })
        } else {
            self.bench.clock(Inputs { dout, busy, rx })
        };
        // As the board's top has it.
        outputs.adc_reset |= i64::from(pressed);
        self.adc.clock(&outputs);
        if outputs.enabled != 0 && !self.enabled {
            self.first = self.adc.conversions;
            self.seen = usize::MAX;
        }
        self.enabled = outputs.enabled != 0;
        if pressed {
            self.dac.is_reset(outputs.dac);
        } else {
            self.dac.serial(&CONVERTER, outputs.dac);
        }
        for (channel, code) in &self.dac.updates[self.written..] {
            self.watch.takes(*channel, *code as f64 / 65_536.0, self.clock);
        }
        self.written = self.dac.updates.len();
        self.host.clock(outputs.tx);
        if !self.host.heard.is_empty() {
            let bytes = std::mem::take(&mut self.host.heard);
            let messages: Vec<_> = self.decoder.decode(bytes).collect();
            for message in messages.into_iter().flatten() {
                match message {
                    Message::Heartbeat(heartbeat) => self.heartbeats.push(heartbeat),
                    Message::Frame(packet) => self.packets.push(packet),
                }
            }
        }
    }

    pub fn run(&mut self, clocks: u64) {
        (0..clocks).for_each(|_| self.step(false));
    }

    /// Runs `frames` frames of all pads.
    pub fn frames(&mut self, frames: u64) {
        self.run(frames * self.frame_clocks());
    }

    pub fn frame_clocks(&self) -> u64 {
        PADS as u64 * self.profile.slot_clocks()
    }

    /// The button, for `clocks` clocks; all commands are forgotten.
    pub fn reset(&mut self, clocks: u64) {
        (self.watch.rail, self.watch.slew) = (0.0, 0.0);
        (0..clocks).for_each(|_| self.step(true));
    }

    /// Sends commands, and waits until they have been sent.
    pub fn send(&mut self, commands: &[Command]) {
        self.allow(commands);
        self.host.send(encode(commands, &self.profile));
        while !self.host.can_skip() {
            self.step(false);
        }
        self.run(8);
    }

    /// What commands allow from now on.
    fn allow(&mut self, commands: &[Command]) {
        let format = self.profile.control.as_ref().expect("a controller").drive;
        for command in commands {
            if let Command::Drive(DriveWord::Setting(setting), code) = command {
                let value = format.real(*code);
                match setting {
                    Setting::Rail => self.watch.rail = self.watch.rail.max(value),
                    Setting::Slew => self.watch.slew = self.watch.slew.max(value),
                    _ => (),
                }
            }
        }
    }

    /// Sends bytes as they are.
    pub fn send_bytes(&mut self, bytes: Vec<u8>) {
        self.host.send(bytes);
        while !self.host.can_skip() {
            self.step(false);
        }
        self.run(8);
    }

    /// All that makes a sensor of the board; its table only where `table` asks for it, since memories outlive a reset.
    pub fn prepare(&mut self, table: bool) {
        let commands = prepare(&self.profile, &calibration(&self.profile), &AdcSetup::default());
        let commands: Vec<Command> = commands
            .into_iter()
            .filter(|command| table || !matches!(command, Command::Table { .. }))
            .collect();
        // An ADC takes a while after its reset.
        self.send(&commands[..2]);
        self.run(7_000);
        self.send(&commands[2..]);
    }

    pub fn targets(&mut self, newtons: f64) {
        let commands: Vec<_> = (0..PADS as u8)
            .map(|pad| drive::target(&self.profile, pad, newtons).expect("a controller"))
            .collect();
        self.send(&commands);
    }

    pub fn tune(&mut self, tuning: &Tuning) {
        let commands = drive::tune(&self.profile, tuning).expect("a controller");
        self.send(&commands);
    }

    /// From a reset to a loop that drives: everything that a host sends.
    pub fn start(&mut self, tuning: &Tuning, newtons: f64, table: bool) {
        self.prepare(table);
        self.targets(newtons);
        self.tune(tuning);
        self.send(&[Command::ENABLE]);
    }

    /// Forgets the largest voltage.
    pub fn mark(&mut self) {
        (self.watch.largest_v, self.watch.largest_at, self.watch.marked) = (0.0, 0, self.clock);
        let now = self.watch.now;
        now.into_iter().for_each(|magnitude| self.watch.largest(magnitude, self.clock));
    }

    pub fn is_zero(&self) -> bool {
        self.watch.now == [0.0; PADS]
    }

    /// Runs until all channels are at zero; clocks that this took.
    pub fn until_zero(&mut self, most: u64) -> u64 {
        let from = self.clock;
        while !self.is_zero() {
            assert!(self.clock - from < most, "{:?} after {most} clocks", self.watch.now);
            self.step(false);
        }
        self.clock - from
    }

    /// What the last packet says of the drive.
    pub fn driven(&self) -> hapticore_host::Driven {
        self.packets.last().and_then(|packet| packet.status.driven).expect("a packet of a drive")
    }

    pub fn is_live(&self) -> bool {
        self.dac.pins.dac_live != 0
    }
}
