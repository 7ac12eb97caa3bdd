// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pulses: each channel's level as the density of one bit, for a pin and a low-pass filter.
//!
//! ```text
//! channel c, each turn:  s = rest[c] + level[c],   pulse[c] = carry of s,   rest[c] = the others
//! ```
//!
//! | signal | format | unit       | overflow                      |
//! | level  | u W    | full scale | –                             |
//! | rest   | u W    | –          | wraps, meant: that is a pulse |
//!
//! As [`super::super::sigma_delta`], one adder for all channels: a pin takes its next bit after
//! 2·channels clocks, 320 ns with four pads at 25 MHz. Bits and levels summed differ by less than one
//! bit, so that a path of τ = 96 µs leaves less than 320 ns/τ = 0.33 % of full scale of it. No pulses, a
//! pin that is low, are 0 V. Latency: a turn of all channels. Source: Schreier and Temes, Understanding Delta-Sigma
//! Data Converters, §2.

use super::super::bits::{next, word};
use super::LevelPort;
use hapticore_hdl::block;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::int;

block! {
    /// The sigma-delta modulator of all channels.
    pub struct Pulses("dac_pulses") {
        channels: u64,
        level: Format,
    }
    submodules {
        levels: Memory,
        rests: Memory,
    }
    inputs(block) {
        given as LevelPort: LevelPort {
            valid: BIT, channel: Format::counter(block.channels - 1), level: block.level
        },
    }
    outputs(block) {
        /// The density of a channel's bit is its level.
        pulses: Format::unsigned(block.channels as u8, 0),
    }
    registers(block) {
        /// The channel's words have been asked for.
        asked: BIT,
        channel: Format::counter(block.channels - 1),
        pulses: Format::unsigned(block.channels as u8, 0),
    }
}

impl Pulses {
    /// A modulator for `channels` channels of unsigned levels.
    pub fn new(channels: u64, level: Format) -> Self {
        let words = 1 << Format::counter(channels - 1).width;
        let rest = Format::unsigned(level.width, 0);
        Pulses {
            channels,
            level,
            levels: Memory::new("levels", words, level),
            rests: Memory::new("rests", words, rest),
        }
    }
}

impl Block for Pulses {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let within = &mut state.submodules;
        let (level, rest) =
            (self.levels.data(&mut within.levels), self.rests.data(&mut within.rests));
        let width = self.level.width;
        let sum = rest + level.integer();
        let LevelPort { valid, channel, level } = i.given;
        self.levels.access(
            &mut within.levels,
            r.channel,
            Write { enable: valid, address: channel, data: level },
        );
        let write = Write { enable: r.asked, address: r.channel, data: sum.bits(0, width) };
        self.rests.access(&mut within.rests, r.channel, write);
        let pulse = sum.bits(width, 1);
        let of = |n: u64| {
            let before = r.pulses.bits(n as u8, 1);
            (r.asked & r.channel.is(n)).select(pulse, before)
        };
        let last = r.channel.is(self.channels - 1);
        let following = last.select(int(0), next(r.channel));
        let registers = Registers {
            asked: !r.asked,
            channel: r.asked.select(following, r.channel).bits(0, r.channel.format.width),
            pulses: word((0..self.channels).map(of)),
        };
        state.store(self, registers);
        Outputs { pulses: r.pulses }
    }
}
