// SPDX-License-Identifier: MIT OR Apache-2.0
//! Serial converter: several channels on one SPI line.
//!
//! ```text
//! sync_n ‾\_____________________________________/‾‾
//! sclk   ‾‾‾‾\__/‾‾\__/‾‾          ‾‾\__/‾‾\__/‾‾‾‾     the falling edge takes a bit
//! sdi    ═╳═════╳═════╳═          ═╳═════╳═════╳═══     command, address, word from the top bit, tail
//! ```
//!
//! | signal | format                    | overflow                             |
//! | word   | magnitude                 | saturates: full scale is no code     |
//! | frame  | u command + address + word + tail | shifted out                  |
//!
//! A converter with a reference of its own, which powers up switched off, gets the frame that switches it on before the first
//! level after a reset, and again with `set_up`. Latency: one clock from a level to `sync_n`; (2·bits + 1)·H clocks for a frame, where H is half a
//! period of `sclk`; `sync_n` is then high for H clocks at least. Source: AD5624/AD5664, AD5624R/AD5644R/AD5664R and
//! AD5628/AD5648/AD5668 data sheets, "Input shift register": 24 and 32 bits, taken at falling edges, updated by the last;
//! "Internal reference register": commands 7 and 8, bit 0.

use super::super::bits::previous;
use super::LevelPort;
use super::magnitude;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::{Signal, Wrap, bit, code, int};
use hapticore_hdl::{block, when};
use hapticore_protocol::output::Dac;

/// The layout of a converter's frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame {
    /// The part.
    pub dac: Dac,
    /// The frame that switches its reference on, where it has one.
    pub reference: Option<u64>,
    /// The command that writes and updates a channel.
    pub command: u64,
    /// Bits of the command, with the don't-care bits before it.
    pub command_bits: u8,
    /// Bits of a channel's number.
    pub address_bits: u8,
    /// Bits of a word.
    pub word_bits: u8,
    /// Don't-care bits behind it.
    pub tail_bits: u8,
    /// Channels of the converter.
    pub channels: u64,
    /// Clocks of half a period of the serial clock.
    pub half_clocks: u64,
}

impl Frame {
    /// AD5664: four channels of 16 bits, 24 bits a frame, an external reference; serial clock up to 50 MHz.
    pub const AD5664: Frame = Frame {
        dac: Dac::Ad5664,
        reference: None,
        command: 0b011,
        command_bits: 5,
        address_bits: 3,
        word_bits: 16,
        tail_bits: 0,
        channels: 4,
        half_clocks: 1,
    };
    /// AD5664R: as the AD5664, with a reference.
    pub const AD5664R: Frame =
        Frame { dac: Dac::Ad5664r, reference: Some(0b111 << 19 | 1), ..Frame::AD5664 };
    /// AD5668: eight channels of 16 bits, 32 bits a frame, a reference; serial clock up to 50 MHz.
    pub const AD5668: Frame = Frame {
        dac: Dac::Ad5668,
        reference: Some(0b1000 << 24 | 1),
        command_bits: 8,
        address_bits: 4,
        tail_bits: 4,
        channels: 8,
        ..Frame::AD5664
    };

    /// All bits.
    pub fn bits(&self) -> u8 {
        self.command_bits + self.address_bits + self.word_bits + self.tail_bits
    }
}

block! {
    /// The serial line.
    pub struct Serial("dac_serial") {
        frame: Frame,
        channel: Format,
        level: Format,
    }
    submodules {}
    inputs(block) {
        given as LevelPort: LevelPort { valid: BIT, channel: block.channel, level: block.level },
        /// Asserted for one cycle to switch the reference on again.
        set_up: BIT,
    }
    outputs(block) {
        /// A level may be given in this cycle.
        ready: BIT,
        sync_n: BIT,
        sclk: BIT,
        sdi: BIT,
    }
    registers(block) {
        busy: BIT,
        /// The serial clock is low.
        low: BIT,
        count: Format::counter(block.frame.half_clocks - 1),
        /// Bits that are still to be sent, with this one; none while `sync_n` rests high.
        left: Format::counter(u64::from(block.frame.bits())),
        data: Format::unsigned(block.frame.bits(), 0),
        /// The reference has been switched on, or is being.
        has_reference: BIT.where_present(block.frame.reference.is_some()),
    }
}

impl Serial {
    /// A line with this frame.
    ///
    /// # Panics
    /// Where a frame has more than 48 bits, an address too few bits, or half a bit lasts no clock.
    pub fn new(frame: Frame, channel: Format, level: Format) -> Self {
        let bits = frame.bits();
        assert!((1..=24).contains(&frame.word_bits) && bits <= 48, "{frame:?}: 1 to 24 bits in 48");
        assert!(frame.address_bits >= channel.width, "{frame:?}: channels need {}", channel.width);
        assert!(frame.half_clocks > 0, "{frame:?}: half a bit takes a clock");
        Serial { frame, channel, level }
    }

    /// The bits of a level's frame.
    #[inline(always)]
    fn data<V: Interpretation>(&self, i: &In<V>) -> Signal<V> {
        let Frame { command, command_bits, address_bits, word_bits, tail_bits, .. } = self.frame;
        let command = code::<V>(command as i64, Format::unsigned(command_bits, 0));
        let address = i.given.channel.resize(Format::unsigned(address_bits, 0), Wrap);
        let word = command.concat(address).concat(magnitude(i.given.level, word_bits));
        match tail_bits {
            0 => word,
            tail => word.concat(code(0, Format::unsigned(tail, 0))),
        }
    }

    /// The end of half a period.
    #[inline(always)]
    fn half<V: Interpretation>(&self, r: Regs<V>) -> Regs<V> {
        let bits = r.data.format.width;
        let rests = r.left.is(0);
        let sent = r.low & !rests;
        let shifted = r.data.bits(0, bits - 1).concat(bit(false));
        Registers {
            busy: !rests,
            low: !r.low & !rests,
            count: int(self.frame.half_clocks - 1),
            left: sent.select(previous(r.left), r.left),
            data: sent.select(shifted, r.data),
            ..r
        }
    }
}

impl Block for Serial {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let counting = Registers { count: previous(r.count), ..r };
        let running = when!(r.count.is(0) => self.half(r), else counting);
        let begun = Registers {
            busy: bit(true),
            low: bit(false),
            count: int(self.frame.half_clocks - 1),
            left: int(u64::from(self.frame.bits())),
            data: self.data(&i),
            ..r
        };
        let busy = when!(r.busy => running, else r);
        let next = when!(i.given.valid => begun, else busy);
        let (next, ready) = match self.frame.reference {
            None => (next, !r.busy),
            Some(frame) => {
                let data = code(frame as i64, r.data.format);
                let reference = Registers { data, has_reference: bit(true), ..begun };
                let asked = !r.busy & !i.given.valid & !r.has_reference;
                let next = when!(asked => reference, else next);
                let has_reference = next.has_reference & !i.set_up;
                (Registers { has_reference, ..next }, !r.busy & r.has_reference)
            }
        };
        state.store(self, next);
        Outputs { ready, sync_n: r.left.is(0), sclk: !r.low, sdi: r.data.msb() }
    }
}
