// SPDX-License-Identifier: MIT OR Apache-2.0
//! Stream: frames out over the serial line, each a packet with its sequence number and CRC;
//! heartbeats while disabled.
//!
//! ```text
//! frame words ──────────┐
//! written registers ────┴─[words: a frame, a heartbeat]─┐
//! number, commands, pad, flags ─────────────────────────┼─(group, left)── byte ─┬─[CRC]─┐
//!                                                       └───────────────────────┴───────┴─(zero? distance)─ transmitter ─ tx
//! ```
//!
//! | group   | 15                                | 0 … 7      | 8                          |
//! | bytes   | sequence (2), commands/pad, flags (2) | B a word   | CRC (4), the last link, END |
//!
//! With a drive, groups 8 and 9 are its last drive word and what is said of it, as of the packet's beginning, and the last
//! group is 10.
//!
//! | signal   | format           | overflow                          |
//! | number   | u16              | wraps, meant: losses show as gaps |
//! | group    | u4               | wraps, meant: 15 comes before 0   |
//! | left     | counter 5        | reloaded, by compare; more where a word has more bytes |
//! | distance | counter 8·B + 10, with a drive 10·B + 10 | from a packet's beginning or its last zero byte; no packet is longer |
//! | pause    | u BEAT + 1       | held at zero while anything is sent or the board is enabled; its top bit ends the pause |
//!
//! A zero byte goes out as the distance to the zero byte before it, so links point back: neither the next zero nor any
//! other byte need be known in advance. A packet is as long on the line whatever it contains.
//!
//! A heartbeat is a packet whose words are those that have been written into registers. A word to
//! be kept for it waits until the words of a frame are through, and one clock where the next byte
//! is read: no byte of a packet waits for it. A heartbeat whose words are being sent then ends
//! immediately, too short for a packet. Bytes of the word before and of this one would otherwise
//! stand side by side, under a CRC that is right.
//!
//! A frame that comes while one is being sent is dropped whole, takes its number along, and sets a flag in the next
//! packet. A packet's own number is its first two bytes, gone before another frame comes: [`super::parameters`] asks
//! for slots longer than a byte. What happened since the packet before (late, refused, overrun) is kept until a packet
//! reports it. Latency: (8·B + 11)·(10·D + 1) clocks, with a drive (10·B + 11)·(10·D + 1), from a frame's last word to
//! the end of the packet's last stop bit. Neither the frame's contents nor commands meanwhile change it. Source:
//! [`super::framing`].

use super::bits::{flag, next, previous, word as bits_side_by_side};
use super::crc32;
use super::framing::{
    CRC_BYTES, END, NIBBLE, PLACE, Register, STATUS_BYTES, STUFFING_BYTES, VERSION, board_digest,
    packet_bytes, packet_words, word_bytes,
};
use super::uart::transmitter::{self, Transmitter};
use super::uart::{BYTE, BitClocks};
use hapticore_contract::frame::Field;
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{Signal, Wrap, bit, code, int};
use hapticore_hdl::{block, bundle, call, when};
use hapticore_model::blocks::estimator::FramePort;
use hapticore_protocol::drive;
use hapticore_protocol::output::{CLOCK, FULL_SCALE, Output, SETUP};

bundle! {
    /// The last drive word, and what is said of it: `hapticore_protocol::drive::status`.
    pub struct DrivenPort {
        /// Drive word.
        driven,
        /// Bits of `status`.
        driven_status,
    }
}

block! {
    /// The stream of packets.
    pub struct Stream("stream") {
        pad: Format,
        data: Format,
        /// Bytes of a word.
        bytes: u64,
        /// Bytes of a packet on the line.
        length: u64,
        /// The last group: the CRC, the last link and END.
        trailer: u64,
        /// Of drive words, where there are some.
        driven: DrivenPort<Format>,
    }
    submodules {
        words: Memory,
        transmitter: Transmitter,
    }
    inputs(stream) {
        frames as FramePort: stream.frames(),
        /// Asserted for one cycle when the ADC was late.
        late: BIT,
        /// Asserted for one cycle when a command was refused.
        refused: BIT,
        /// Commands accepted so far, modulo 16.
        commands: NIBBLE,
        /// The board is enabled; no heartbeats are sent.
        enable: BIT,
        /// Asserted for one cycle when a word is to be kept for heartbeats.
        keep: BIT,
        /// The number of the word; stable until the next.
        place: PLACE,
        /// The word; stable until the next.
        data: stream.data,
        /// Flag `calibrated` of heartbeats.
        calibrated: BIT,
        driven as DrivenPort: stream.driven,
    }
    outputs(stream) {
        /// Pin: serial output, high when idle.
        tx: BIT,
    }
    registers(stream) {
        taking: BIT,
        busy: BIT,
        heartbeat: BIT,
        group: Format::counter(STATUS),
        left: Format::counter(TRAILER_BYTES.max(stream.bytes) - 1),
        distance: Format::counter(stream.length - 1),
        crc: crc32::CRC,
        number: Format::unsigned(16, 0),
        pad: stream.pad,
        commands: NIBBLE,
        clipped: BIT,
        saturated: BIT,
        invalid: BIT,
        lost: BIT,
        lifted: BIT,
        late: BIT,
        refused: BIT,
        overrun: BIT,
        keep: BIT,
        pause: Format::unsigned(BEAT + 1, 0),
        told as DrivenPort: stream.driven,
    }
}

/// Words of a frame.
const WORDS: u64 = Field::ALL.len() as u64;
/// The group before the words, by wrapping: the status.
const STATUS: u64 = 15;
/// Bytes of the status behind the one with what happened since the packet before.
const FLAGS_LEFT: u64 = 1;
/// Bytes of the last group.
const TRAILER_BYTES: u64 = CRC_BYTES + STUFFING_BYTES;
/// Heartbeats pause for 2^BEAT clocks.
const BEAT: u8 = 14;

/// A bit of the version, as heartbeats tell it.
fn version<V: Interpretation>(at: u8) -> Signal<V> {
    bit(VERSION >> at & 1 != 0)
}

/// The word whose low bits these are: a word of sixteen bits has them with a sign.
fn as_word(bits: u16, word: Format) -> i32 {
    let bits = i32::from(bits);
    if word.width <= 16 && bits > word.max_code() as i32 { bits - (1 << 16) } else { bits }
}

/// The formats of what packets say of the drive.
fn driven(profile: &Profile) -> DrivenPort<Format> {
    match &profile.control {
        Some(control) => DrivenPort {
            driven: control.drive,
            driven_status: Format::unsigned(drive::status::BITS, 0),
        },
        None => DrivenPort::of(Format::NONE),
    }
}

impl Stream {
    /// The stream of a profile's frames, with bits of these clocks, and of a board whose
    /// commands bring data of this format; heartbeats report its output, where there is one.
    pub fn new(
        profile: &Profile,
        bits: impl Into<BitClocks>,
        data: Format,
        output: Option<&Output>,
    ) -> Self {
        let format = Field::word(profile);
        let mut initial = vec![0.0; 2 * WORDS as usize];
        initial[WORDS as usize + Register::Control.number()] =
            f64::from(as_word(board_digest(profile, output), format));
        let told = output.map_or([0; 3], Output::words);
        for (number, word) in [SETUP, FULL_SCALE, CLOCK].into_iter().zip(told) {
            initial[WORDS as usize + number] = f64::from(as_word(word, format));
        }
        let words =
            Memory { initial: initial.into(), ..Memory::new("words", 2 * WORDS as usize, format) };
        Stream {
            words: words.dont_care_on_collision(),
            data,
            transmitter: Transmitter::new(bits),
            pad: Format::counter(profile.pads - 1),
            bytes: word_bytes(profile),
            length: packet_bytes(profile),
            trailer: packet_words(profile),
            driven: driven(profile),
        }
    }

    /// The formats of a frame.
    fn frames(&self) -> FramePort<Format> {
        FramePort {
            index: Format::counter(WORDS - 1),
            frame: self.words.format,
            pad: self.pad,
            ..FramePort::of(BIT)
        }
    }

    /// Clocks of a packet, from a frame's last word to the end of its last stop bit.
    pub fn packet_clocks(&self, divisor: u64) -> u64 {
        self.length * (10 * divisor + 1)
    }

    /// The word of the packet that is due: of the frame or heartbeat, or of the drive.
    #[inline(always)]
    fn word<V: Interpretation>(&self, r: &Regs<V>, data: Signal<V>) -> Signal<V> {
        if self.driven.driven.is_none() {
            return data;
        }
        let word = Format::signed(8 * self.bytes as u8, 0);
        let [data, driven, status] = [data, r.told.driven.integer(), r.told.driven_status]
            .map(|signal| signal.resize(word, Wrap));
        r.group.is(WORDS).select(driven, r.group.is(WORDS + 1).select(status, data))
    }

    /// The byte of the packet that is due.
    #[inline(always)]
    fn byte<V: Interpretation>(&self, r: &Regs<V>, data: Signal<V>) -> Signal<V> {
        let wide = self.word(r, data).resize(Format::signed(8 * self.bytes as u8, 0), Wrap);
        let pick = |bytes: &[Signal<V>]| {
            let (first, rest) = bytes.split_first().expect("a group has bytes");
            (1..).zip(rest).fold(*first, |other, (left, byte)| r.left.is(left).select(*byte, other))
        };
        let words: Vec<_> = (0..self.bytes).map(|left| wide.bits(8 * left as u8, 8)).collect();
        // Bits of the second byte that are none of a flag are zero.
        let more = r.lifted.resize(BYTE, Wrap);
        let flags = bits_side_by_side([
            r.clipped,
            r.saturated,
            r.invalid,
            r.lost,
            r.late,
            r.refused,
            r.overrun,
            r.heartbeat,
        ]);
        let pad = r.pad.resize(NIBBLE, Wrap);
        let (low, high) = (r.number.bits(0, 8), r.number.bits(8, 8));
        let status = pick(&[more, flags, r.commands.concat(pad), low, high]);
        // The CRC moves on by each of its bytes. Both the last link and END are zero bytes.
        let check = bits_side_by_side((0..8).map(|k| !r.crc.bits(k, 1)));
        let trailer = r.left.less_than(int(STUFFING_BYTES)).select(code(0, BYTE), check);
        r.group.is(self.trailer).select(trailer, r.group.is(STATUS).select(status, pick(&words)))
    }

    /// What is written: a frame's word, or, between frames and where no byte is read, the word that is kept for
    /// heartbeats.
    #[inline(always)]
    fn write<V: Interpretation>(
        &self,
        r: &Regs<V>,
        i: &In<V>,
        [taking, free]: [Signal<V>; 2],
    ) -> Write<V> {
        let (format, address) = (self.words.format, self.words.address());
        let kept = i.data.resize(Format::unsigned(format.width, 0), Wrap).as_code(format);
        Write {
            enable: i.frames.valid.select(taking, r.keep & free),
            address: (!i.frames.valid)
                .concat(i.frames.valid.select(i.frames.index, i.place))
                .as_code(address),
            data: i.frames.valid.select(i.frames.frame, kept),
        }
    }

    /// What the packet says of the drive: as of its beginning, so that the bytes of a word belong together.
    #[inline(always)]
    fn told<V: Interpretation>(
        &self,
        held: DrivenPort<Signal<V>>,
        now: DrivenPort<Signal<V>>,
        begin: Signal<V>,
    ) -> DrivenPort<Signal<V>> {
        DrivenPort::map(DrivenPort::zip(now, held), |(now, held)| match held.format.is_none() {
            true => held,
            false => begin.select(now, held),
        })
    }

    /// The CRC behind a byte: of its own bytes it takes none in, but moves on.
    #[inline(always)]
    fn check<V: Interpretation>(&self, r: &Regs<V>, byte: Signal<V>) -> Signal<V> {
        crc32::with(r.crc, r.group.is(self.trailer).select(r.crc.bits(0, 8), byte))
    }

    /// Where the packet goes on after a byte: the bytes of a group are counted down.
    #[inline(always)]
    fn advance<V: Interpretation>(&self, r: &Regs<V>) -> (Signal<V>, Signal<V>) {
        let last = r.left.is(0);
        let of_next =
            r.group.is(self.trailer - 1).select(int(TRAILER_BYTES - 1), int(self.bytes - 1));
        (last.select(next(r.group), r.group), last.select(of_next, previous(r.left)))
    }
}

impl Block for Stream {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let taking = (i.frames.valid & i.frames.index.is(0)).select(!r.busy, r.taking);
        let data = self.words.data(&mut state.submodules.words);
        let byte = self.byte(&r, data).named("plain");
        let at_end = r.group.is(self.trailer) & r.left.is(0);
        let zero = byte.is(0);
        let link = r.distance.resize(BYTE, Wrap);
        let line = at_end.select(code(END.into(), BYTE), zero.select(link, byte));
        let transmitter =
            call!(self.transmitter, state, transmitter::Inputs { valid: r.busy, octet: line });
        let sent = transmitter.taken;

        let free = !transmitter.ending;
        let write = self.write(&r, &i, [taking, free]);
        // A word is never read while it is written, and in plain sight: the block RAM then needs no
        // logic for that case.
        let address = write
            .enable
            .select(next(write.address), r.heartbeat.concat(r.group.bits(0, PLACE.width)));
        self.words.access(&mut state.submodules.words, address, write);

        let told = sent & r.group.is(STATUS) & r.left.is(FLAGS_LEFT);
        let frame = i.frames.done & taking;
        let heartbeat = r.pause.msb() & !r.busy & !i.enable & !i.frames.valid;
        let begin = frame | heartbeat;
        let (group, left) = self.advance(&r);
        let cut =
            (write.enable & !i.frames.valid & r.busy & r.heartbeat & !r.group.msb()).named("cuts");
        let onward =
            |end, next: Signal<V>, now: Signal<V>| cut.select(int(end), sent.select(next, now));
        let take = |now: Signal<V>, held: Signal<V>| begin.select(now, held);
        state.store(
            self,
            Registers {
                taking,
                busy: flag(r.busy, begin, sent & at_end),
                heartbeat: take(heartbeat, r.heartbeat),
                group: take(int(STATUS), onward(self.trailer, group, r.group))
                    .resize(r.group.format, Wrap),
                left: take(int(STATUS_BYTES - 1), onward(0, left, r.left))
                    .resize(r.left.format, Wrap),
                distance: (begin | (sent & zero))
                    .select(int(1), sent.select(next(r.distance), r.distance))
                    .resize(r.distance.format, Wrap),
                crc: take(crc32::begin(), when!(sent => self.check(&r, byte), else r.crc)),
                number: i.frames.done.select(next(r.number), r.number),
                pad: take(i.frames.pad, r.pad),
                commands: take(i.commands, r.commands),
                clipped: take(heartbeat.select(i.calibrated, i.frames.clipped), r.clipped),
                saturated: take(heartbeat.select(version(0), i.frames.saturated), r.saturated),
                invalid: take(heartbeat.select(version(1), i.frames.invalid), r.invalid),
                lost: take(heartbeat.select(version(2), i.frames.lost), r.lost),
                lifted: take(!heartbeat & i.frames.lifted, r.lifted),
                late: flag(r.late, i.late, told),
                refused: flag(r.refused, i.refused, told),
                overrun: flag(r.overrun, i.frames.done & !taking, told),
                keep: flag(r.keep, i.keep, !i.frames.valid & free),
                pause: (i.enable | r.busy)
                    .select(int(0), next(r.pause))
                    .resize(r.pause.format, Wrap),
                told: self.told(r.told, i.driven, begin),
            },
        );
        Outputs { tx: transmitter.tx }
    }
}
