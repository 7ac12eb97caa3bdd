// SPDX-License-Identifier: MIT OR Apache-2.0
//! The blocks of a board, each alone with a trace: directed input, as its surroundings give it, and
//! what no surroundings should.

use fastrand::Rng;
use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::{Profile, Wall};
use hapticore_hdl::block::Block;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::verilog::Design;
use hapticore_host::Command;
use hapticore_model::blocks::core::Core;
use hapticore_model::blocks::force_loop::ForceLoop;
use hapticore_protocol::drive::{Kind, widest};
use hapticore_rtl::board::adc_reader::AdcReader;
use hapticore_rtl::board::drive_output::parallel::Parallel;
use hapticore_rtl::board::drive_output::pulses::Pulses;
use hapticore_rtl::board::drive_output::serial::{Frame, Serial};
use hapticore_rtl::board::drive_output::sine::Sine;
use hapticore_rtl::board::drive_output::{Converter, DriveOutput, Wave};
use hapticore_rtl::board::drive_registers::DriveRegisters;
use hapticore_rtl::board::framing::{END, Register, STATUS_BYTES};
use hapticore_rtl::board::pads::Pads;
use hapticore_rtl::board::registers::CommandRegisters;
use hapticore_rtl::board::sigma_delta::SigmaDelta;
use hapticore_rtl::board::stream::Stream;
use hapticore_rtl::board::uart::receiver::Receiver;
use hapticore_rtl::board::uart::transmitter::Transmitter;
use hapticore_rtl::board::{Parameters, Target};

use crate::lockstep::Trace;
use crate::stimulus::corner;

/// A block alone: what is printed of it, and what its model did.
pub struct Alone {
    /// Printed Verilog of the block.
    pub design: Design,
    /// Trace of the model.
    pub trace: Trace,
}

/// A stimulus: the inputs of a clock by their names, the others zero.
type Given = Vec<(&'static str, i64)>;

fn alone<B: Block>(block: &B, clocks: usize, mut given: impl FnMut(&mut Rng) -> Given) -> Alone {
    let (design, mut rng, mut left) = (Design::of(block, "a test"), Rng::with_seed(1), clocks);
    let trace = Trace::record(block, design.ports.clone(), |_| {
        left = left.checked_sub(1)?;
        let given = given(&mut rng);
        let code =
            |name: &&str| given.iter().find(|(of, _)| of == name).map_or(0, |(_, code)| *code);
        let mut codes = Vec::with_capacity(B::Inputs::FIELDS.len());
        B::Inputs::each(block.inputs(), |field, format| {
            codes.extend((!format.is_none()).then(|| code(&field.name)));
        });
        Some(codes)
    });
    Alone { design, trace }
}

/// A bit that stays for a while, of so many clocks at most.
#[derive(Default)]
struct Level {
    value: i64,
    left: u32,
}

impl Level {
    fn next(&mut self, rng: &mut Rng, most: u32) -> i64 {
        if self.left == 0 {
            (self.value, self.left) = (1 - self.value, rng.u32(1..=most));
        }
        self.left -= 1;
        self.value
    }
}

/// Whether something happens that does every so many clocks.
fn now(rng: &mut Rng, clocks: u32) -> i64 {
    i64::from(rng.u32(..clocks) == 0)
}

fn any(rng: &mut Rng, format: Format) -> i64 {
    rng.i64(format.min_code() as i64..=format.max_code() as i64)
}

/// A byte: often END, or as small as links are.
fn octet(rng: &mut Rng) -> u8 {
    match rng.u8(..6) {
        0 => END,
        1 => rng.u8(..20),
        _ => rng.u8(..),
    }
}

/// Bits that are too long or too short, bytes without a stop bit, glitches, breaks.
fn receiver(divisor: u64) -> Alone {
    let (mut levels, mut at) = (Vec::new(), 0);
    alone(&Receiver::new(divisor), 60_000, move |rng| {
        if at == levels.len() {
            (levels, at) = (Vec::new(), 0);
            let bit = divisor as usize + rng.usize(..3) - 1;
            let byte = rng.u8(..);
            let bits = (0..8).map(|k| i64::from(byte >> k & 1));
            let frame: Vec<i64> =
                [0].into_iter().chain(bits).chain([i64::from(rng.u8(..8) != 0)]).collect();
            frame.iter().for_each(|&level| levels.extend(std::iter::repeat_n(level, bit)));
            let breaks = frame[9] == 0 && rng.bool();
            levels.extend(std::iter::repeat_n(0, usize::from(breaks) * rng.usize(..4 * bit)));
            levels.extend(std::iter::repeat_n(1, rng.usize(..3 * bit)));
            levels.extend(std::iter::repeat_n(0, rng.usize(..8) / 7 * rng.usize(..bit)));
            levels.extend(std::iter::repeat_n(1, 1 + rng.usize(..2) * bit));
        }
        at += 1;
        vec![("rx", levels[at - 1])]
    })
}

fn transmitter(divisor: u64) -> Alone {
    let mut valid = Level::default();
    alone(&Transmitter::new(divisor), 40_000, move |rng| {
        vec![("valid", valid.next(rng, 30 * divisor as u32)), ("octet", octet(rng).into())]
    })
}

fn pads(count: u64, dead: u64) -> Alone {
    let (mut serve, mut closed) = (0, Level::default());
    alone(&Pads::new(count, dead), 40_000, move |rng| {
        if rng.u64(..2 * dead) == 0 {
            serve = rng.i64(0..count as i64);
        }
        vec![("serve", serve), ("closed", closed.next(rng, 4 * dead as u32))]
    })
}

fn sigma_delta(carrier: Format) -> Alone {
    alone(&SigmaDelta::new(carrier), 20_000, move |rng| vec![("carrier", corner(rng, carrier))])
}

/// Enabled now and then; the ADC is done in time, late, or absent; words at any time.
fn adc_reader(block: &AdcReader, parameters: &Parameters) -> Alone {
    let (mut enable, mut busy) = (Level::default(), Level::default());
    let conversion = parameters.conversion() as u32;
    alone(block, 120_000, move |rng| {
        let most = if enable.value == 0 { 1200 } else { 90 };
        let enable = enable.next(rng, most);
        let write = if enable == 1 { now(rng, 50) } else { now(rng, 20) };
        let busy = busy.next(rng, 2 * conversion);
        vec![("enable", enable), ("busy", busy), ("dout", rng.u8(..).into()), ("write", write)]
    })
}

/// The bytes of a command that may be damaged: too long, too short, or changed, its links among them.
fn command(block: &CommandRegisters, profile: &Profile, words: u16, rng: &mut Rng) -> Vec<u8> {
    let data = block.outputs().data;
    let address = match rng.u8(..8) {
        0 => words - 1 + rng.u16(..3),
        1..4 => rng.u16(..0x800),
        _ => rng.u16(..0x8000),
    };
    let code = if rng.bool() {
        any(rng, data)
    } else {
        i64::from(octet(rng)) << (8 * rng.u8(..data.width / 8))
    };
    let command = match rng.u8(..8) {
        0..3 => Command::Table { address, code },
        3 => [Command::ENABLE, Command::DISABLE, Command::RESET_ADC][rng.usize(..3)],
        _ => Command::Register(Register::ALL[rng.usize(..Register::ALL.len())], code),
    };
    let mut bytes = command.encode(profile);
    let at = rng.usize(..bytes.len());
    match rng.u8(..24) {
        0 => bytes[at] ^= 1 << rng.u8(..8),
        1 => drop(bytes.remove(at)),
        2 => bytes.insert(at, octet(rng)),
        3 => bytes.insert(at, END),
        4 => bytes.splice(at..at, (0..24).map(|_| 1)).for_each(drop),
        _ => (),
    }
    bytes
}

/// Commands, and the moves that the ADC reader makes of their data.
fn registers(block: &CommandRegisters, profile: Profile, words: u64) -> Alone {
    let (mut bytes, mut shift) = (Vec::new(), Level::default());
    alone(block, 150_000, move |rng| {
        let valid = now(rng, 2) == 1;
        if valid && bytes.is_empty() {
            bytes = command(block, &profile, words as u16, rng);
        }
        let octet = if valid { bytes.remove(0) } else { octet(rng) };
        let shift = i64::from(shift.next(rng, 200) == 1 && rng.u8(..16) == 0);
        vec![
            ("valid", valid.into()),
            ("octet", octet.into()),
            ("shift", shift),
            ("answer", now(rng, 2)),
        ]
    })
}

/// Frames, now and then too early, words for heartbeats, and times without frames in which these
/// come.
fn stream(block: &Stream, divisor: u64) -> Alone {
    let of = block.inputs();
    let packet = block.packet_clocks(divisor) as u32;
    // The first packet is a heartbeat, which comes after 2^14 clocks.
    let first = 20_000 + packet;
    let (mut enable, mut wait, mut index) = (Level { value: 0, left: first }, first, 0);
    // Frames come without a pause until the next one's number has a zero byte, so that heartbeats
    // with that number follow.
    let (mut number, mut hurries) = (0u16, false);
    // Frames without a zero byte: no link leads further.
    let mut dense = false;
    let (mut place, mut data, mut pad) = (0, 0, 0);
    // Clocks until something is to be told just when the flags are sent, the last byte but one of the status.
    let (flags, mut told) = ((STATUS_BYTES - 2) as u32 * (10 * divisor as u32 + 1) - 2, u32::MAX);
    // Clocks until a word is to be kept just when the next byte of a frame's words is read.
    let (byte, mut kept) = (10 * divisor as u32 + 1, u32::MAX);
    alone(block, 100_000 * divisor as usize, move |rng| {
        let enabled = enable.next(rng, 20 * packet);
        if index == 8 {
            // In any clock of the packet before, as soon as it is gone, or later: while disabled,
            // after some heartbeats.
            let zero = number & 0xff == 0;
            hurries = !zero && (hurries || enabled == 0 && rng.u8(..3) == 0);
            dense = rng.u8(..3) == 0;
            wait = match rng.u8(..4) {
                _ if hurries => 0,
                0 if !zero => rng.u32(..packet),
                1 if !zero => 0,
                _ => packet + rng.u32(..packet) + (1 - enabled as u32) * 12 * packet,
            };
            (index, pad) = (0, any(rng, of.frames.pad));
        }
        wait = wait.saturating_sub(1);
        let valid = wait == 0 && rng.u8(..3) != 0;
        kept = kept.saturating_sub(1);
        let keep = if kept == 0 { 1 } else { now(rng, 6 * packet) };
        if keep == 1 {
            kept = u32::MAX;
            (place, data) = (any(rng, of.place), any(rng, of.data));
        }
        let frame = match rng.u8(..4) {
            _ if dense => {
                let format = of.frames.frame;
                any(rng, format) | format.min_code() as i64 | 0x01_0101
            }
            0 => any(rng, of.frames.frame),
            _ => i64::from(octet(rng)) << (8 * rng.u8(..2)) & of.frames.frame.max_code() as i64,
        };
        let mut given = vec![
            ("valid", valid.into()),
            ("index", index % 8),
            ("frame", frame),
            ("done", i64::from(valid && index == 7)),
            ("pad", pad),
            ("commands", rng.i64(0..16)),
            ("enable", enabled),
            ("keep", keep),
            ("place", place),
            ("data", data),
            ("driven", any(rng, of.driven.driven)),
            ("driven_status", any(rng, of.driven.driven_status)),
        ];
        told = if valid && index == 7 { flags + rng.u32(1..4) } else { told.saturating_sub(1) };
        if valid && index == 7 {
            kept = rng.u32(4..20) * byte - rng.u32(0..3);
        }
        for name in ["late", "refused"] {
            given.push((name, if told == 0 { 1 } else { now(rng, 12 * packet) }));
        }
        told = if told == 0 { u32::MAX } else { told };
        for name in ["clipped", "saturated", "invalid", "lost", "lifted", "calibrated"] {
            given.push((name, now(rng, 2)));
        }
        index += i64::from(valid);
        number = number.wrapping_add((valid && index == 8).into());
        given
    })
}

/// Slots of all pads, words at any time; now and then none, or the output is off.
fn drive_output(block: &DriveOutput) -> Alone {
    let of = block.inputs();
    let (mut enable, mut closed, mut quiet, mut fault) =
        (Level::default(), Level::default(), Level::default(), Level::default());
    let mut serve = 0;
    alone(block, 60_000, move |rng| {
        let before = closed.value;
        let closed = closed.next(rng, 120);
        if before > closed {
            serve = if rng.u8(..8) == 0 {
                any(rng, of.serve)
            } else {
                (serve + 1) & of.serve.max_code() as i64
            };
        }
        let words = if quiet.next(rng, 2_000) == 1 { 0 } else { now(rng, 60) };
        let most = if enable.value == 0 { 4_000 } else { 90 };
        vec![
            ("drive_valid", words),
            ("drive_pad", any(rng, of.drive_pad)),
            ("drive", amplitude(rng, of.drive)),
            ("serve", serve),
            ("closed", closed),
            ("enable", enable.next(rng, most)),
            ("silence_fault", fault.next(rng, 20_000)),
            ("sensor_fault", now(rng, 4_000)),
            ("force_fault", now(rng, 4_000)),
        ]
    })
}

/// An amplitude: a corner, or one whose product with a sine of 32 points is half a step of a level off
/// an even level, or the least more or less.
fn amplitude(rng: &mut Rng, drive: Format) -> i64 {
    // Odd codes of sin 5π/16 and sin 7π/16 in steps of 2⁻¹⁶.
    let sines = [54_491, 64_277];
    let inverse = |of: i64| (0..5).fold(of, |x, _| (x * (2 - of * x)) & 0xffff);
    match rng.u8(..8) {
        0 => 0x8000,
        1 => ((0x7fff + 2 * now(rng, 2)) * inverse(sines[rng.usize(..2)])) & 0xffff,
        _ => corner(rng, drive),
    }
}

/// A level whenever the line is free, or a little later.
fn given<B: Block>(block: &B, [channel, level]: [Format; 2], busy: u32) -> Alone {
    let mut wait = 0;
    alone(block, 40_000, move |rng| {
        wait = if wait == 0 { busy + rng.u32(..2) * rng.u32(..20) } else { wait - 1 };
        vec![
            ("valid", (wait == 0).into()),
            ("channel", any(rng, channel)),
            ("level", corner(rng, level)),
            ("set_up", now(rng, 500)),
        ]
    })
}

/// The drive output with each wave and converter, and the converters alone.
fn drive_outputs() -> Vec<Alone> {
    let (drive, level) = (Format::unsigned(16, 16), Format::unsigned(16, 16));
    let channel = Format::counter(2);
    let of = |shape, wave, converter| {
        drive_output(&DriveOutput::new(shape, drive, 900, wave, converter))
    };
    let slow = Frame { half_clocks: 4, ..Frame::AD5664 };
    let busy = (2 * u32::from(slow.bits()) + 2) * 4;
    vec![
        of([3, 1], Wave::Square { turn_slots: 6 }, Converter::Pulses),
        of([6, 2], Wave::Square { turn_slots: 4 }, Converter::Serial(Frame::AD5668)),
        of([2, 1], Wave::Sine { points: 32, point_clocks: 40 }, Converter::Parallel { bits: 17 }),
        of([2, 1], Wave::Dc, Converter::Parallel { bits: 12 }),
        alone(&Sine::new(64, 11), 2_000, |_| Vec::new()),
        given(&Pulses::new(3, level), [channel, level], 3),
        given(&Parallel::new(12, channel, level), [channel, level], 4),
        given(&Serial::new(slow, channel, level), [channel, level], busy),
    ]
}

/// Words at any place, with any data.
fn drive_registers(block: &DriveRegisters) -> Alone {
    let of = block.inputs();
    alone(block, 20_000, move |rng| {
        let kind = rng.i64(0..4) << Kind::AT;
        let number = if rng.bool() { rng.i64(0..12) } else { rng.i64(0..1 << Kind::AT) };
        vec![("write", now(rng, 2)), ("place", kind | number), ("data", corner(rng, of.data))]
    })
}

/// Clocks of a bit of the serial line, so few that Icarus comes to an end.
const DIVISOR: u64 = 4;

/// What a board that drives its pads has besides, or otherwise.
pub fn blocks_of_a_drive(target: Target) -> Vec<Alone> {
    let mut profile = target.profile();
    profile.control = Some(Control::of(&profile, Law::Inverse));
    let force_loop = ForceLoop::try_new(&profile).expect("a force loop");
    let words = force_loop.core.estimator().table().words as u64;
    let calibration = force_loop.core.inputs().calibration;
    let block = CommandRegisters::new(calibration, words, Some(widest(&profile)));
    let data = block.outputs().data;
    let walled = Profile { wall: Some(Wall { parts: 2, ..Wall::B }), ..profile.clone() };
    let walled = ForceLoop::try_new(&walled).expect("a force loop with walls");
    vec![
        drive_registers(&DriveRegisters::new(&force_loop, data)),
        drive_registers(&DriveRegisters::new(&walled, data)),
        stream(&Stream::new(&profile, DIVISOR, data, None), DIVISOR),
        registers(&block, profile, words),
    ]
}

/// The blocks of a board, with its own parameters, and those that no board's parameters change.
pub fn blocks(target: Target) -> Vec<Alone> {
    let (profile, parameters) = (target.profile(), target.parameters());
    let (core, divisor) = (Core::new(&profile), parameters.bits().least());
    let words = core.estimator().table().words as u64;
    let block = CommandRegisters::new(core.inputs().calibration, words, None);
    let mut all = drive_outputs();
    all.extend([
        stream(&Stream::new(&profile, divisor, block.outputs().data, None), divisor),
        registers(&block, profile.clone(), words),
        adc_reader(&AdcReader::new(&profile, &parameters), &parameters),
        receiver(divisor),
        transmitter(divisor),
        pads(profile.pads, parameters.dead()),
        sigma_delta(core.outputs().carrier),
    ]);
    all
}
