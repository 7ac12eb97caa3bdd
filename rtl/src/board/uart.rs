// SPDX-License-Identifier: MIT OR Apache-2.0
//! Serial port: bytes to and from a line, 8N1.
//!
//! ```text
//! line  ‾‾‾‾┐___⟨0⟩⟨1⟩⟨2⟩⟨3⟩⟨4⟩⟨5⟩⟨6⟩⟨7⟩‾‾‾‾        start, eight bits from the least significant, stop
//! ```
//!
//! | signal   | format        | overflow             |
//! | count    | counter D − 1 | reloaded, by compare |
//! | position | counter 10    | reloaded, by compare |
//!
//! A bit takes D clocks, the divisor; where a rate asks for it, some bits of a byte take one more ([`BitClocks`]). The receiver samples the middle of each bit; the line passes two registers first.
//! It reports a character without a stop bit as a zero byte, which ends a packet, and then nothing until the line is
//! high. So a line that stays low is one such byte. A receiver that has taken another bit for a start bit finds the
//! right one behind the next zero byte, nine low bits. Latency: 10·D clocks a byte, and one more from byte to byte for
//! the transmitter to take the next.
//!
//! **Clocks that differ.** The receiver samples the stop bit ⌊9½·D⌋ clocks behind the clock that sees the start bit's
//! edge, which is up to a clock late. The sample must be within the sender's bit from 9 to 10. So a sender's bit of b
//! clocks is heard from b = (⌊9½·D⌋ + 1)/10 to b = ⌊9½·D⌋/9. That is −4.2 % to +5.6 % with 12 clocks a bit, −4.8 % to
//! +5.3 % with 25 (`rtl/tests/board/clock_error.rs` measures it). Source: the usual asynchronous serial line (EIA-232
//! character).

use super::bits::{next, previous};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::{Signal, Wrap, bit, code, int};
use hapticore_hdl::{block, when};

/// The format of a byte.
pub const BYTE: Format = Format::unsigned(8, 0);

/// The position of the stop bit; that of the start bit is 0.
const STOP: u64 = 9;

/// The position behind a stop bit that was low, until the line is high.
const BROKEN: u64 = 10;

/// Clocks of each bit of a byte, from the start bit to the stop bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct BitClocks {
    /// Of most bits.
    divisor: u64,
    /// Those that take one clock more, a bit for each position.
    long: u16,
}

/// All bits are as long.
impl From<u64> for BitClocks {
    fn from(divisor: u64) -> Self {
        BitClocks { divisor, long: 0 }
    }
}

impl BitClocks {
    /// A whole divisor may be off by this part of a rate.
    const OFF: f64 = 0.02;

    /// Of a rate of `baud` bits a second: all as long where a whole divisor is near enough, else each edge within half a
    /// clock of its time.
    pub fn of(clock_hz: u64, baud: u64) -> Self {
        let baud = baud.max(1);
        let nearest = (clock_hz + baud / 2) / baud;
        let off = (nearest * baud).abs_diff(clock_hz) as f64 / clock_hz as f64;
        if off < Self::OFF {
            return nearest.into();
        }
        let edge = |bit: u64| (bit * clock_hz + baud / 2) / baud;
        let divisor = clock_hz / baud;
        let is_long = |bit: &u64| edge(bit + 1) - edge(*bit) > divisor;
        BitClocks { divisor, long: (0..=STOP).filter(is_long).map(|bit| 1 << bit).sum() }
    }

    /// Of the shortest bit.
    pub fn least(self) -> u64 {
        self.divisor
    }

    /// Of the longest.
    pub fn most(self) -> u64 {
        self.divisor + u64::from(self.long != 0)
    }

    /// Of a byte, start and stop bit included.
    pub fn byte(self) -> u64 {
        (STOP + 1) * self.divisor + u64::from(self.long.count_ones())
    }

    /// What a counter of the start bit begins with.
    #[inline(always)]
    fn first<V: Interpretation>(self) -> Signal<V> {
        self.sized(int(self.divisor - 1 + u64::from(self.long & 1)))
    }

    /// What a counter of the bit at a position begins with.
    #[inline(always)]
    fn count<V: Interpretation>(self, position: impl FnOnce() -> Signal<V>) -> Signal<V> {
        let short = int(self.divisor - 1);
        if self.long == 0 {
            return short;
        }
        let (position, long) = (position(), int(self.divisor));
        let at = (0..=STOP).filter(|bit| self.long >> bit & 1 != 0);
        let is_long = at.map(|bit| position.is(bit)).reduce(|a, b| a | b);
        self.sized(is_long.map_or(short, |is_long| is_long.select(long, short)))
    }

    /// In the format of the counter.
    #[inline(always)]
    fn sized<V: Interpretation>(self, count: Signal<V>) -> Signal<V> {
        if self.long == 0 { count } else { count.resize(Format::counter(self.most() - 1), Wrap) }
    }
}

/// Receiver: 8N1 line to bytes.
pub mod receiver {
    use super::*;

    block! {
        /// The receiver. The line is kept inverted, so that it rests at reset.
        pub struct Receiver("receiver") {
            /// Cycles per bit.
            bits: BitClocks,
        }
        submodules {}
        inputs(receiver) {
            /// Pin: the line, high at rest.
            rx: BIT,
        }
        outputs(receiver) {
            /// Asserted for one cycle with each byte.
            valid: BIT,
            /// Byte, least significant bit first on the line; zero where the stop bit was low.
            octet: BYTE,
        }
        registers(receiver) {
            pin: BIT,
            low: BIT,
            busy: BIT,
            count: Format::counter(receiver.bits.most() - 1),
            position: Format::counter(BROKEN),
            octet: BYTE,
            valid: BIT,
        }
    }

    impl Receiver {
        /// A receiver of bits of these clocks.
        pub fn new(bits: impl Into<BitClocks>) -> Self {
            Receiver { bits: bits.into() }
        }

        /// Waits for a start bit.
        #[inline(always)]
        fn wait<V: Interpretation>(&self, r: Regs<V>) -> Regs<V> {
            // The start bit has been low for a clock when this is seen.
            let half = int(self.bits.least() / 2 - 1);
            Registers { busy: r.low, count: half, position: int(0), ..r }
        }

        /// The middle of a bit, or any clock behind a stop bit that was low.
        #[inline(always)]
        fn sample<V: Interpretation>(&self, r: Regs<V>) -> Regs<V> {
            let (start, stop) = (r.position.is(0), r.position.is(STOP));
            let broken = r.position.is(BROKEN);
            let heard = r.low.select(code(0, BYTE), r.octet);
            let shifted = (!r.low).concat(r.octet.bits(1, 7));
            Registers {
                busy: r.low | !(start | stop | broken),
                count: (stop | broken)
                    .select(int(0), self.bits.count(|| r.position))
                    .resize(r.count.format, Wrap),
                position: broken.select(r.position, next(r.position)),
                octet: stop.select(heard, shifted),
                valid: stop,
                ..r
            }
        }
    }

    impl Block for Receiver {
        #[inline(always)]
        fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
            let r = state.load(self);
            let quiet = Registers { valid: bit(false), ..r };
            let counting = Registers { count: previous(r.count), ..quiet };
            let busy = when!(r.count.is(0) => self.sample(quiet), else counting);
            let next = when!(r.busy => busy, else self.wait(quiet));
            state.store(self, Registers { pin: !i.rx, low: r.pin, ..next });
            Outputs { valid: r.valid, octet: r.octet }
        }
    }
}

/// Transmitter: bytes to 8N1 line.
pub mod transmitter {
    use super::*;

    block! {
        /// The transmitter. The line is kept inverted, so that it rests at reset.
        pub struct Transmitter("transmitter") {
            /// Cycles per bit.
            bits: BitClocks,
        }
        submodules {}
        inputs(transmitter) {
            /// A byte is to be sent.
            valid: BIT,
            /// Byte, least significant bit first on the line.
            octet: BYTE,
        }
        outputs(transmitter) {
            /// The byte is accepted in this cycle.
            taken: BIT,
            /// A byte may be accepted in the next cycle, as not in this one.
            ending: BIT,
            /// Pin: the line, high at rest.
            tx: BIT,
        }
        registers(transmitter) {
            low: BIT,
            busy: BIT,
            count: Format::counter(transmitter.bits.most() - 1),
            position: Format::counter(STOP),
            octet: BYTE,
        }
    }

    impl Transmitter {
        /// A transmitter of bits of these clocks.
        pub fn new(bits: impl Into<BitClocks>) -> Self {
            Transmitter { bits: bits.into() }
        }

        /// The start bit.
        #[inline(always)]
        fn begin<V: Interpretation>(&self, i: &In<V>) -> Regs<V> {
            Registers {
                low: i.valid,
                busy: i.valid,
                count: self.bits.first(),
                position: int(0),
                octet: i.octet,
            }
        }

        /// The end of a bit: ones follow the last, and so the stop bit is one.
        #[inline(always)]
        fn advance<V: Interpretation>(&self, r: Regs<V>) -> Regs<V> {
            Registers {
                low: !r.octet.bits(0, 1),
                busy: !r.position.is(STOP),
                count: self.bits.count(|| next(r.position)),
                position: next(r.position),
                octet: bit(true).concat(r.octet.bits(1, 7)),
            }
        }
    }

    impl Block for Transmitter {
        #[inline(always)]
        fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
            let r = state.load(self);
            let counting = Registers { count: previous(r.count), ..r };
            let busy = when!(r.count.is(0) => self.advance(r), else counting);
            let next = when!(r.busy => busy, else self.begin(&i));
            state.store(self, next);
            let ending = r.busy & r.count.is(0) & r.position.is(STOP);
            Outputs { taken: i.valid & !r.busy, ending, tx: !r.low }
        }
    }
}
