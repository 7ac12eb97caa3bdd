// SPDX-License-Identifier: MIT OR Apache-2.0
//! The whole board: calibrated over its line and fed at its pins, it tells the frames of the core.

use crate::bench::Bench;
use crate::dac::Dac;
use crate::device::{Sight, calibration, codes, short_profiles};
use crate::pins::{Adc, Health, Host};
use crate::random::Random;
use hapticore_contract::calibration::Calibration;
use hapticore_contract::frame::Frame as Measured;
use hapticore_contract::profile::Profile;
use hapticore_host::startup::start;
use hapticore_host::{Command, Damage, Decoder, Heartbeat, Message, Packet, encode};
use hapticore_model::fidelity::clock::ClockSimulation;
use hapticore_rtl::board::drive_output::Converter;
use hapticore_rtl::board::drive_output::serial::Frame;
use hapticore_rtl::board::parameters::Drive;
use hapticore_rtl::board::whole::Inputs;
use hapticore_rtl::board::{Board, Parameters};

/// A board with an ADC and a host.
pub struct Session {
    pub bench: Bench<Board>,
    pub profile: Profile,
    pub adc: Adc,
    pub host: Host,
    /// The level that either end sees while the line is unplugged.
    pub unplugged: Option<i64>,
    decoder: Decoder,
    pub packets: Vec<Result<Packet, Damage>>,
    pub heartbeats: Vec<Heartbeat>,
    /// All bytes that the board has sent.
    pub bytes: Vec<u8>,
    closed: Vec<i64>,
    /// The converter of a board with a drive.
    pub dac: Dac,
    converter: Option<Frame>,
}

const SEED: u64 = 11;

/// A line fast enough for the short slots of the tests.
pub fn parameters(profile: &Profile, divisor: u64, sclk_latency: u64) -> Parameters {
    let clock_hz = if profile.name == "small" { 12_000_000 } else { 25_000_000 };
    Parameters { clock_hz, baud: clock_hz / divisor, sclk_latency, drive: None }
}

impl Session {
    pub fn new(profile: &Profile, parameters: Parameters, samples: &[Vec<i32>]) -> Self {
        let board = Board::new(profile, &parameters).expect("bundled profiles fit their boards");
        let width = profile.formats.adc.width;
        let adc = Adc::new(samples.to_vec(), width, &parameters);
        Session {
            bench: Bench::new(board),
            profile: profile.clone(),
            adc,
            host: Host::new(parameters.bits().least()),
            unplugged: None,
            decoder: Decoder::new(profile),
            packets: Vec::new(),
            heartbeats: Vec::new(),
            bytes: Vec::new(),
            closed: Vec::new(),
            dac: Dac::new(),
            converter: match parameters.drive {
                Some(Drive { converter: Converter::Serial(frame), .. }) => Some(frame),
                _ => None,
            },
        }
    }

    pub fn clock(&mut self) {
        let (busy, dout) = self.adc.pins();
        let rx = self.unplugged.unwrap_or(self.host.line());
        let outputs = self.bench.clock(Inputs { dout, busy, rx });
        self.adc.clock(&outputs);
        if let Some(frame) = &self.converter {
            self.dac.serial(frame, outputs.dac);
        }
        self.host.clock(self.unplugged.unwrap_or(outputs.tx));
        if self.closed.last() != Some(&outputs.select) {
            self.closed.push(outputs.select);
        }
        let bytes = std::mem::take(&mut self.host.heard);
        self.bytes.extend(&bytes);
        for told in self.decoder.decode(bytes) {
            match told {
                Ok(Message::Heartbeat(heartbeat)) => self.heartbeats.push(heartbeat),
                Ok(Message::Frame(packet)) => self.packets.push(Ok(packet)),
                Err(damage) => self.packets.push(Err(damage)),
            }
        }
    }

    pub fn run(&mut self, clocks: u64) {
        (0..clocks).for_each(|_| self.clock());
    }

    pub fn send(&mut self, commands: &[Command]) {
        self.host.send(encode(commands, &self.profile));
        while !self.host.can_skip() {
            self.clock();
        }
    }

    /// Runs until the end of a packet.
    pub fn next_packet(&mut self) {
        let before = self.packets.len();
        while self.packets.len() == before {
            self.clock();
        }
    }

    /// Runs until `count` packets are there.
    pub fn packets(&mut self, count: usize) -> Vec<Packet> {
        let mut left = (count as u64 + 4) * (self.profile.slot_clocks() + 60_000);
        while self.packets.len() < count {
            left -= 1;
            assert!(left > 0, "{}: {} of {count} packets", self.profile.name, self.packets.len());
            self.clock();
        }
        self.packets.iter().map(|packet| packet.expect("the line is clean")).collect()
    }
}

/// Samples of some slots, whatever the ADC may see.
pub fn samples(profile: &Profile, slots: usize) -> Vec<Vec<i32>> {
    samples_of(profile, &Sight::ALL, slots)
}

/// Samples of some slots, of these sights in turn.
pub fn samples_of(profile: &Profile, sights: &[Sight], slots: usize) -> Vec<Vec<i32>> {
    let mut random = Random::new(SEED);
    let sights = sights.iter().copied().cycle().take(slots);
    sights
        .flat_map(|sight| {
            let codes = codes(profile, sight, &mut random);
            codes.chunks(profile.channels()).map(<[i32]>::to_vec).collect::<Vec<_>>()
        })
        .collect()
}

pub fn simulated(
    profile: &Profile,
    calibration: &Calibration,
    samples: &[Vec<i32>],
) -> Vec<Measured> {
    let mut simulation = ClockSimulation::new(profile, calibration);
    let mut frames = Vec::new();
    for sample in samples {
        simulation.samples(sample);
        frames.extend(simulation.take_frame());
    }
    frames.extend(simulation.finish_slot());
    frames
}

#[test]
fn over_the_line_come_the_frames_of_the_core() {
    for (profile, latency) in short_profiles().into_iter().zip([0, 3, 1]) {
        let calibration = calibration(&profile);
        let samples = samples(&profile, 9);
        let mut session = Session::new(&profile, parameters(&profile, 4, latency), &samples);
        let commands = start(&profile, &calibration);
        session.send(&commands);
        let packets = session.packets(9);
        let expected = simulated(&profile, &calibration, &samples);
        for (number, (packet, expected)) in packets.iter().zip(&expected).enumerate() {
            assert_eq!(packet.frame, *expected, "{}: frame {number}", profile.name);
            assert_eq!(usize::from(packet.status.sequence), number + 1);
            assert!(
                !(packet.status.late || packet.status.refused || packet.status.overrun),
                "{}: {packet:?}",
                profile.name
            );
            assert_eq!(packet.status.commands, commands.len() as u8 % 16);
        }
        assert_eq!(expected.len(), 9);
        assert!(
            expected.iter().any(|frame| frame.flags.lost)
                && expected.iter().any(|frame| frame.flags.invalid)
        );
        assert_eq!(session.adc.wrong, Vec::<&str>::new(), "{}", profile.name);
        assert_eq!(session.adc.part.lines(), 8, "{}: eight data lines", profile.name);
        let (pads, opened): (Vec<i64>, Vec<i64>) =
            session.closed.iter().partition(|&&select| select != 0);
        assert_eq!(pads[..8], [1, 2, 4, 8, 1, 2, 4, 8], "pads in turn");
        assert!(opened.len() >= pads.len(), "and none between two");
    }
}

pub fn small() -> Profile {
    short_profiles().swap_remove(0)
}

#[test]
fn a_damaged_command_changes_nothing_and_is_told() {
    let profile = small();
    let samples = samples(&profile, 3);
    let mut session = Session::new(&profile, parameters(&profile, 4, 0), &samples);
    let commands = start(&profile, &calibration(&profile));
    let good = encode(&[Command::ENABLE], &profile);
    session.send(&commands[..20]);
    for (position, flip) in [(1, 0x80), (4, 1), (6, 0x10), (3, 0xff)] {
        let mut bad = good.clone();
        bad[position] ^= flip;
        session.host.send(bad);
    }
    session.host.send(good[..5].iter().copied().chain(good.last().copied()));
    session.run(5_000);
    assert_eq!(
        session.bench.clock(Inputs { dout: 0, busy: 0, rx: 1 }).enabled,
        0,
        "none of them enables"
    );
    session.send(&commands[20..]);
    let refusals = session.heartbeats.iter().filter(|heartbeat| heartbeat.status.refused).count();
    assert!((1..=5).contains(&refusals), "told once each, or several together: {refusals}");
    let packets = session.packets(2);
    assert!(!packets[0].status.refused && !packets[1].status.refused, "and not again");
    assert_eq!(packets[0].status.commands, commands.len() as u8 % 16);
    let expected = simulated(&profile, &calibration(&profile), &samples);
    assert_eq!(packets[1].frame, expected[1]);
}

#[test]
fn a_late_or_absent_adc_is_told_and_hangs_nothing() {
    for health in [Health::Slow, Health::Absent] {
        let profile = small();
        let mut session = Session::new(&profile, parameters(&profile, 4, 0), &samples(&profile, 4));
        session.send(&start(&profile, &calibration(&profile)));
        let well = session.packets(1);
        assert!(!well[0].status.late);
        session.adc.health = health;
        assert!(session.packets(3)[2].status.late, "{health:?}");
        session.adc.health = Health::Well;
        assert!(!session.packets(5)[4].status.late, "{health:?} and over");
        let lamp =
            |session: &mut Session| session.bench.clock(Inputs { dout: 0, busy: 0, rx: 1 }).late;
        assert_eq!(lamp(&mut session), 1, "the lamp stays on");
        session.send(&[Command::DISABLE]);
        session.run(50);
        assert_eq!(lamp(&mut session), 0, "until the board is disabled");
    }
}

#[test]
fn a_line_too_slow_drops_whole_frames_and_says_so() {
    let profile = small();
    let samples = samples(&profile, 12);
    let calibration = calibration(&profile);
    let mut session = Session::new(&profile, parameters(&profile, 40, 0), &samples);
    session.send(&start(&profile, &calibration));
    let packets = session.packets(4);
    let expected = simulated(&profile, &calibration, &samples);
    assert!(
        packets.windows(2).any(|pair| pair[1].status.sequence > pair[0].status.sequence + 1),
        "some are dropped"
    );
    for pair in packets.windows(2) {
        assert!(pair[0].status.overrun || pair[1].status.overrun, "and that is said: {pair:?}");
    }
    for packet in &packets {
        assert_eq!(
            packet.frame,
            expected[usize::from(packet.status.sequence) - 1],
            "those that come are whole"
        );
    }
}

#[test]
fn disabled_the_board_is_still() {
    let profile = small();
    let mut session = Session::new(&profile, parameters(&profile, 4, 0), &samples(&profile, 4));
    session.run(3_000);
    session.send(&start(&profile, &calibration(&profile)));
    session.packets(1);
    session.send(&[Command::DISABLE]);
    session.run(2 * profile.slot_clocks());
    let (frames, wrong) = (session.packets.len(), session.adc.wrong.clone());
    for _ in 0..2 * profile.slot_clocks() {
        let (busy, dout) = session.adc.pins();
        let outputs = session.bench.clock(Inputs { dout, busy, rx: 1 });
        assert_eq!((outputs.convst, outputs.cs_n, outputs.sclk_run, outputs.select), (0, 1, 0, 0));
    }
    assert_eq!((session.packets.len(), wrong), (frames, vec![]));
}
