// SPDX-License-Identifier: MIT OR Apache-2.0
//! Drive output: each pad's drive word as a voltage of either polarity, for a converter.
//!
//! ```text
//! drive word ─[amplitudes]─(· wave)─ level ─┬─ pulses    one bit per pad, sigma-delta
//! slot's end ─ polarity ────────┘           ├─ serial    SPI converter of several channels
//!                                           └─ parallel  word, address and write strobe
//! ```
//!
//! | wave   | level                                                     | V² in a window              |
//! | dc     | d                                                         | constant                    |
//! | square | ±d, turned as the pad's switch opens, every N slots       | constant where it settled   |
//! | sine   | d·sin φ, all pads in phase                                | right over whole periods    |
//!
//! A converter holds the magnitude of a level, so that its code 0, an idle pin and what it powers up with are 0 V. The
//! sign is a pin per channel, `dac_polarity`, low for positive; it changes when the converter has the magnitude.
//!
//! A turn comes right after a window, with the drive word that the window leads to. It then settles while the other
//! pads have their slots; a pad that is alone, or the first part of a split one, has its next slot directly after. It
//! costs 2τ/T of the mean of V², with τ of the pad behind its resistor and T from turn to turn.
//!
//! | signal    | format              | unit             | overflow                |
//! | d         | profile (drive)     | drive's full scale | –                     |
//! | sine      | s18.16              | –                | one is a code           |
//! | level     | d's, and a sign     | drive's full scale | cannot: |sine| ≤ 1    |
//! | point     | counter             | 1/points turn    | wraps, meant            |
//!
//! A converter is written when something changes: a drive word, a turn, the sine's next point. Where
//! several channels change, the first goes first. After reset every channel is set to zero once. All go to
//! zero, too, while the output is off: not enabled, in a fault, or without a drive word for `stale_clocks`. Strobes
//! that cease leave no voltage behind, and `drives_clear` tells the controller to begin anew, from zero. Each time that
//! the output is no longer off, the converter is set up again, first its reference, where it has one, then every channel.
//! `dac_live` is asserted once that is done, and negated in the cycle after the output is off.
//! Latency: 4 clocks from a drive word to that at the converter's pins, or to the beginning of its
//! frame, where nothing else is due. Source: docs/physics.md §7 for the wave.

mod names;
pub mod parallel;
pub mod pulses;
pub mod serial;
pub mod sine;

use self::parallel::Parallel;
use self::pulses::Pulses;
use self::serial::Serial;
use super::bits::{word, xor};
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{HalfEven, Proved, Saturate, Signal, bit, int, zero};
use hapticore_hdl::{block, bundle};
use hapticore_model::blocks::controller::Faults;
pub use hapticore_protocol::output::{Dac, NameError, Wave};
use sine::Sine;

/// Frames of all pads without a drive word after which drives go to zero.
const STALE_FRAMES: u64 = 4;
/// The longest time without a drive word, ms, however long a frame is.
pub const STALE_MS: u64 = 100;

/// The interface to a converter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Converter {
    /// One bit per pad, whose mean is the level: for a low-pass filter.
    Pulses,
    /// A serial line that all channels share.
    Serial(serial::Frame),
    /// A word, an address and a write strobe that all channels share.
    Parallel {
        /// Bits of a word.
        bits: u8,
    },
}

bundle! {
    /// A level for a channel.
    pub struct LevelPort {
        /// Asserted for one cycle with each level.
        valid,
        /// Its channel.
        channel,
        /// Magnitude of the voltage, drive's full scale.
        level,
    }
}

bundle! {
    /// Pins of a converter; absent those that it does not have.
    pub struct DacPort {
        /// Pins: one bit per pad, sigma-delta.
        dac_pulses,
        /// Pin: frame of the serial line, active low.
        dac_sync_n,
        /// Pin: clock of the serial line; its falling edge takes a bit.
        dac_sclk,
        /// Pin: data of the serial line.
        dac_sdi,
        /// Pins: word, a magnitude: zero is 0 V.
        dac_word,
        /// Pins: channel of the word.
        dac_address,
        /// Pin: write strobe, active low; word and address are stable a cycle before and after.
        dac_write_n,
        /// Pins: one bit per channel, its voltage is negative.
        dac_polarity,
        /// The converter is set up, all its channels are as they should be, and nothing is off.
        dac_live,
    }
}

block! {
    /// The drive output of all pads.
    pub struct DriveOutput("drive_output") {
        wave: Wave,
        /// Number of channels, each of a pad or of all parts of a split one.
        channels: u64,
        /// Numbers in the multiplexer that belong to a channel.
        parts: u64,
        pad: Format,
        drive: Format,
        /// Clocks without a drive word after which all channels go to zero.
        stale_clocks: u64,
    }
    submodules {
        amplitudes: Memory,
        sine: Option<Sine>,
        pulses: Option<Pulses>,
        serial: Option<Serial>,
        parallel: Option<Parallel>,
    }
    inputs(block) {
        /// Asserted for one cycle with each drive word.
        drive_valid: BIT,
        /// Its pad; of a split one the last part.
        drive_pad: block.pad,
        /// Drive word, drive's full scale.
        drive: block.drive,
        /// The selected pad.
        serve: block.pad,
        /// Its switch is closed.
        closed: BIT,
        /// Drive words count.
        enable: BIT,
        faults as Faults: Faults::of(BIT),
    }
    outputs(block) {
        dac as DacPort: block.pins(),
        /// Asserted for one cycle once the last drive word is stale: the force loop begins anew, at zero.
        drives_clear: BIT,
    }
    registers(block) {
        /// Channels that have been written with what they are to have.
        settled: block.mask(),
        /// Channels that have had a drive word since reset.
        known: block.mask(),
        /// Channels whose level is negative.
        negative: block.mask().where_present(block.turn_slots().is_some()),
        /// Slots until the channels' next turn, counted by the first channel.
        slots: Format::counter(block.turn_slots().unwrap_or(1) - 1)
            .where_present(block.turn_slots().is_some()),
        closed: BIT.where_present(block.turn_slots().is_some()),
        serve: block.pad.where_present(block.turn_slots().is_some()),
        /// Clocks until the last drive word is stale.
        fresh: Format::counter(block.stale_clocks),
        /// A channel's amplitude has been asked for.
        asked: BIT,
        channel: block.channel(),
        given as LevelPort: block.level_port(),
        /// The level that is given is negative.
        given_negative: BIT,
        /// Channels whose pin says that they are negative.
        polarity: block.mask(),
        /// The output was off.
        off: BIT,
        /// The last drive word has become stale.
        stale: BIT,
        live: BIT,
    }
}

impl DriveOutput {
    /// The output for pads of these drive words, `parts` numbers of the multiplexer for each.
    ///
    /// # Panics
    /// Where the wave or the converter cannot be.
    pub fn new(
        [pads, parts]: [u64; 2],
        drive: Format,
        stale_clocks: u64,
        wave: Wave,
        converter: Converter,
    ) -> Self {
        let (channels, pad) = (pads / parts, Format::counter(pads - 1));
        assert!((1..=16).contains(&channels), "channels: expected 1 to 16, got {channels}");
        let channel = Format::counter(channels - 1);
        let sine = match wave {
            Wave::Sine { points, point_clocks } => Some(Sine::new(points, point_clocks)),
            _ => None,
        };
        let mut block = DriveOutput {
            wave,
            channels,
            parts,
            pad,
            drive,
            stale_clocks,
            amplitudes: Memory::new("amplitudes", 1 << channel.width, drive),
            sine,
            pulses: None,
            serial: None,
            parallel: None,
        };
        match converter {
            Converter::Pulses => block.pulses = Some(Pulses::new(channels, drive)),
            Converter::Serial(frame) => block.serial = Some(Serial::new(frame, channel, drive)),
            Converter::Parallel { bits } => {
                block.parallel = Some(Parallel::new(bits, channel, drive));
            }
        }
        block
    }

    /// The output for the force loop of a profile at a clock of `clock_hz` hertz.
    ///
    /// # Errors
    /// A profile without a controller; more pads than the converter has channels; drive words that come further apart than
    /// [`STALE_MS`].
    ///
    /// # Panics
    /// As [`DriveOutput::new`].
    pub fn of_profile(
        profile: &Profile,
        wave: Wave,
        converter: Converter,
        clock_hz: u64,
    ) -> Result<Self, ProfileError> {
        let Some(control) = &profile.control else {
            return Err(ProfileError::value("control", "a table", "none"));
        };
        let parts = profile.wall.map_or(1, |wall| wall.parts);
        let (channels, most) = (profile.pads / parts, converter.most_channels());
        if channels > most {
            let expected = format!("at most {most}, a channel of the converter each");
            return Err(ProfileError::value("pads", expected, channels));
        }
        let most = STALE_MS * clock_hz / 1_000;
        let between_words = parts * profile.slot_clocks();
        if between_words >= most {
            let expected =
                format!("fewer than {most} clocks, {STALE_MS} ms, from drive word to drive word");
            return Err(ProfileError::value("slot", expected, between_words));
        }
        let stale = (STALE_FRAMES * profile.pads * profile.slot_clocks()).min(most);
        Ok(DriveOutput::new([profile.pads, parts], control.drive, stale, wave, converter))
    }

    /// Clocks from a drive word to that at the converter's pins, where nothing else is due.
    pub fn latency(&self) -> u64 {
        4
    }

    fn mask(&self) -> Format {
        Format::unsigned(self.channels as u8, 0)
    }

    fn channel(&self) -> Format {
        Format::counter(self.channels - 1)
    }

    fn level_port(&self) -> LevelPort<Format> {
        LevelPort { valid: BIT, channel: self.channel(), level: self.drive }
    }

    fn turn_slots(&self) -> Option<u64> {
        match self.wave {
            Wave::Square { turn_slots } => Some(turn_slots),
            _ => None,
        }
    }

    fn pins(&self) -> DacPort<Format> {
        let none =
            DacPort { dac_polarity: self.mask(), dac_live: BIT, ..DacPort::of(Format::NONE) };
        match (&self.serial, &self.parallel) {
            (Some(_), _) => DacPort { dac_sync_n: BIT, dac_sclk: BIT, dac_sdi: BIT, ..none },
            (_, Some(parallel)) => DacPort {
                dac_word: parallel.outputs().word,
                dac_address: self.channel(),
                dac_write_n: BIT,
                ..none
            },
            _ => DacPort { dac_pulses: self.mask(), ..none },
        }
    }
}

/// What changes a channel's level, one bit per channel, and the registers that say so.
struct Changes<V: Interpretation> {
    /// A drive word.
    words: Signal<V>,
    /// A turn of the polarity, where the wave has some.
    turns: Option<Signal<V>>,
    slots: Signal<V>,
}

impl DriveOutput {
    /// One bit per channel.
    #[inline(always)]
    fn mask_of<V: Interpretation>(&self, set: impl Fn(u64) -> Signal<V>) -> Signal<V> {
        word((0..self.channels).map(set))
    }

    /// The bit of a channel.
    #[inline(always)]
    fn bit_of<V: Interpretation>(&self, mask: Signal<V>, channel: Signal<V>) -> Signal<V> {
        let of = |n: u64| mask.bits(n as u8, 1) & channel.is(n);
        (1..self.channels).fold(of(0), |any, n| any | of(n))
    }

    /// The first channel whose bit is clear.
    #[inline(always)]
    fn first_clear<V: Interpretation>(&self, mask: Signal<V>) -> Signal<V> {
        let last: Signal<V> = int(self.channels - 1);
        let first = (0..self.channels - 1)
            .rev()
            .fold(last, |other, n| mask.bits(n as u8, 1).select(other, int(n)));
        first.resize(self.channel(), Proved)
    }

    #[inline(always)]
    fn changes<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> Changes<V> {
        let last_part = |n: u64| (n + 1) * self.parts - 1;
        let words = self.mask_of(|n| i.drive_valid & i.drive_pad.is(last_part(n)));
        let Some(turn_slots) = self.turn_slots() else {
            return Changes { words, turns: None, slots: r.slots };
        };
        let opens = r.closed & !i.closed;
        let first = opens & r.serve.is(last_part(0));
        let due = r.slots.is(0);
        let down = (r.slots - int(1)).bits(0, r.slots.format.width);
        let counted = due.select(int(turn_slots - 1), down).resize(r.slots.format, Proved);
        let turns = self.mask_of(|n| match n {
            0 => first & due,
            n => opens & r.serve.is(last_part(n)) & r.slots.is(turn_slots - 1),
        });
        Changes { words, turns: Some(turns), slots: first.select(counted, r.slots) }
    }

    /// Clocks until the last drive word is stale, from now on.
    #[inline(always)]
    fn fresh<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> Signal<V> {
        let down = r.fresh.is(0).select(r.fresh, (r.fresh - int(1)).bits(0, r.fresh.format.width));
        i.drive_valid.select(int(self.stale_clocks), down).resize(r.fresh.format, Proved)
    }

    /// The level of an amplitude: its magnitude, and whether it is negative.
    #[inline(always)]
    fn level_of<V: Interpretation>(
        &self,
        amplitude: Signal<V>,
        negative: Signal<V>,
        sine: Signal<V>,
    ) -> [Signal<V>; 2] {
        match self.wave {
            Wave::Dc => [amplitude, bit(false)],
            Wave::Square { .. } => [amplitude, negative],
            Wave::Sine { .. } => {
                let negative = sine.msb();
                let magnitude = negative.select(-sine, sine);
                let level =
                    amplitude * magnitude.bits(0, sine::MAGNITUDE.width).as_code(sine::MAGNITUDE);
                [level.quantize(self.drive, HalfEven, Saturate), negative]
            }
        }
    }

    /// Gives a level to the converter, and takes its pins; whether it can take another.
    #[inline(always)]
    fn convert<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        given: LevelPort<Signal<V>>,
        set_up: Signal<V>,
    ) -> (DacPort<Signal<V>>, Signal<V>) {
        let none = DacPort::map(DacPort::of(Format::NONE), zero);
        let within = &mut state.submodules;
        if let Some((block, within)) = self.serial.as_ref().zip(within.serial.as_mut()) {
            let line = block.call("serial", within, serial::Inputs { given, set_up });
            let pins =
                DacPort { dac_sync_n: line.sync_n, dac_sclk: line.sclk, dac_sdi: line.sdi, ..none };
            return (pins, line.ready);
        }
        if let Some((block, within)) = self.parallel.as_ref().zip(within.parallel.as_mut()) {
            let line = block.call("parallel", within, parallel::Inputs { given });
            let pins = DacPort {
                dac_word: line.word,
                dac_address: line.address,
                dac_write_n: line.write_n,
                ..none
            };
            return (pins, line.ready);
        }
        let both = self.pulses.as_ref().zip(within.pulses.as_mut());
        let (block, within) = both.expect("there is a converter");
        let line = block.call("pulses", within, pulses::Inputs { given });
        (DacPort { dac_pulses: line.pulses, ..none }, bit(true))
    }
}

impl Block for DriveOutput {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let (turned, sine) = match (&self.sine, &mut state.submodules.sine) {
            (Some(block), Some(within)) => {
                let sine = block.call("sine", within, sine::Inputs::map(block.inputs(), zero));
                (sine.turned, sine.sine)
            }
            _ => (bit(false), zero(sine::SINE)),
        };
        let changes = self.changes(&r, &i);
        let amplitude = self.amplitudes.data(&mut state.submodules.amplitudes);
        let off = self.off(&r, &i);
        let set_up = r.off & !off;
        let (pins, ready) = self.convert(state, r.given, set_up);
        let written = ready & !r.given.valid;

        let all = r.settled.is((1 << self.channels) - 1);
        let ask = written & !r.asked & !all & !set_up;
        let channel = self.first_clear(r.settled);
        let to = changes.words;
        let address = self.mask_index(to);
        let write = Write { enable: i.drive_valid & !to.is(0), address, data: i.drive };
        self.amplitudes.access(&mut state.submodules.amplitudes, channel, write);

        let negative = match self.turn_slots() {
            Some(_) => self.bit_of(r.negative, r.channel),
            None => bit(false),
        };
        let [level, negative] = self.level_of(amplitude, negative, sine);
        let known = self.bit_of(r.known, r.channel) & !off;
        let bits = |mask: Signal<V>, n: u64| mask.bits(n as u8, 1);
        let falls = |n: u64| set_up | (off & bits(r.known, n));
        let has_turned = |n: u64| {
            let given = written & r.given.channel.is(n);
            given.select(r.given_negative, bits(r.polarity, n))
        };
        let registers = Registers {
            settled: self.mask_of(|n| {
                let changed = bits(changes.words, n) | turned | falls(n);
                let changed = changes.turns.map_or(changed, |turns| changed | bits(turns, n));
                (bits(r.settled, n) | (ask & channel.is(n))) & !changed
            }),
            known: self.mask_of(|n| (bits(r.known, n) | bits(changes.words, n)) & !off),
            negative: changes.turns.map_or(r.negative, |turns| {
                self.mask_of(|n| xor(bits(r.negative, n), bits(turns, n)))
            }),
            slots: changes.slots,
            closed: i.closed.where_present(r.closed.format),
            serve: i.serve.where_present(r.serve.format),
            fresh: self.fresh(&r, &i),
            asked: ask,
            channel: ask.select(channel, r.channel),
            given: LevelPort {
                valid: r.asked,
                channel: r.asked.select(r.channel, r.given.channel),
                level: r.asked.select(known.select(level, zero(level.format)), r.given.level),
            },
            given_negative: r.asked.select(known & negative, r.given_negative),
            polarity: self.mask_of(has_turned),
            off,
            stale: r.fresh.is(1) & !i.drive_valid,
            live: !off & !set_up & (r.live | (all & written & !r.asked)),
        };
        state.store(self, registers);
        let dac = DacPort { dac_polarity: r.polarity, dac_live: r.live, ..pins };
        Outputs { dac, drives_clear: r.stale }
    }
}

impl DriveOutput {
    /// Whether all channels are to be zero.
    #[inline(always)]
    fn off<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> Signal<V> {
        let Faults { silence_fault, sensor_fault, force_fault } = i.faults;
        let stale = r.fresh.is(0) & !i.drive_valid;
        !i.enable | stale | silence_fault | sensor_fault | force_fault
    }

    /// The number of the bit that is set in a mask of at most one.
    #[inline(always)]
    fn mask_index<V: Interpretation>(&self, mask: Signal<V>) -> Signal<V> {
        let first: Signal<V> = int(0);
        let index =
            (1..self.channels).fold(first, |other, n| mask.bits(n as u8, 1).select(int(n), other));
        index.resize(self.amplitudes.address(), Proved)
    }
}

/// A level as a converter's word, rounded: zero is 0 V.
#[inline(always)]
fn magnitude<V: Interpretation>(level: Signal<V>, bits: u8) -> Signal<V> {
    level.quantize(Format::unsigned(bits, bits as i8), HalfEven, Saturate).bits(0, bits)
}
