// SPDX-License-Identifier: MIT OR Apache-2.0
//! Serial port: bytes to and from a line, 8N1.
//!
//! ```text
//! line  ‾‾‾‾┐___⟨0⟩⟨1⟩⟨2⟩⟨3⟩⟨4⟩⟨5⟩⟨6⟩⟨7⟩‾‾‾‾        start, eight bits from the least significant, stop
//! ```
//!
//! | signal   | format        | overflow             |
//! | count    | counter D − 1 | reloaded, by compare |
//! | position | counter 9     | reloaded, by compare |
//!
//! A bit takes D clocks, the divisor. The receiver looks at the middle of each bit and drops a byte without a stop bit; the
//! line passes two registers first. Latency: 10·D clocks a byte. Source: the usual asynchronous serial line (EIA-232 character).

use super::bits::{next, previous};
use hapticore_model::block::{Block, Cell};
use hapticore_model::format::{BIT, Format};
use hapticore_model::signal::{Signal, Value, bit, int};
use hapticore_model::{bundle, when};

/// The format of a byte.
pub const BYTE: Format = Format::unsigned(8, 0);

/// The position of the stop bit; that of the start bit is 0.
const STOP: u64 = 9;

/// A receiver.
pub mod receiver {
    use super::*;

    bundle! {
        /// The inputs.
        pub struct Inputs {
            /// Pin: the line, high at rest.
            rx,
        }
    }

    bundle! {
        /// The outputs: registers.
        pub struct Outputs {
            /// Set for a clock when a byte is there.
            valid,
            /// The byte.
            octet,
        }
    }

    bundle! {
        /// The registers. The line is kept inverted, so that it rests at reset.
        pub struct Registers {
            pin, low, busy, count, position, octet, valid,
        }
    }

    /// The configuration.
    #[derive(Debug, Clone)]
    pub struct Receiver {
        divisor: u64,
    }

    impl Receiver {
        /// A receiver with so many clocks a bit.
        pub fn new(divisor: u64) -> Self {
            Receiver { divisor }
        }

        /// Waits for a start bit.
        #[inline(always)]
        fn wait<V: Value>(&self, r: Registers<Signal<V>>) -> Registers<Signal<V>> {
            Registers { busy: r.low, count: int(self.divisor / 2), position: int(0), ..r }
        }

        /// The middle of a bit.
        #[inline(always)]
        fn sample<V: Value>(&self, r: Registers<Signal<V>>) -> Registers<Signal<V>> {
            let (start, stop) = (r.position.is(0), r.position.is(STOP));
            let shifted = (!r.low).concat(r.octet.bits(1, 7));
            Registers {
                busy: !(stop | (start & !r.low)),
                count: int(self.divisor - 1),
                position: next(r.position),
                octet: (start | stop).select(r.octet, shifted),
                valid: stop & !r.low,
                ..r
            }
        }
    }

    impl Block for Receiver {
        const NAME: &'static str = "receiver";
        type Inputs = Inputs;
        type Outputs = Outputs;
        type Registers = Registers;
        type Parts<V: Value> = ();

        fn inputs(&self) -> Inputs<Format> {
            Inputs { rx: BIT }
        }

        fn outputs(&self) -> Outputs<Format> {
            Outputs { valid: BIT, octet: BYTE }
        }

        fn registers(&self) -> Registers<Format> {
            let (count, position) = (Format::counter(self.divisor - 1), Format::counter(STOP));
            Registers { pin: BIT, low: BIT, busy: BIT, count, position, octet: BYTE, valid: BIT }
        }

        #[inline(always)]
        fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
            let r = cell.load(self);
            let quiet = Registers { valid: bit(false), ..r };
            let counting = Registers { count: previous(r.count), ..quiet };
            let busy = when!(V, Registers, r.count.is(0), self.sample(quiet), counting);
            let next = when!(V, Registers, r.busy, busy, self.wait(quiet));
            cell.store(self, Registers { pin: !i.rx, low: r.pin, ..next });
            Outputs { valid: r.valid, octet: r.octet }
        }
    }
}

/// A transmitter.
pub mod transmitter {
    use super::*;

    bundle! {
        /// The inputs.
        pub struct Inputs {
            /// A byte is to be sent.
            valid,
            /// The byte.
            octet,
        }
    }

    bundle! {
        /// The outputs.
        pub struct Outputs {
            /// The byte is taken in this clock.
            taken,
            /// Pin: the line, high at rest.
            tx,
        }
    }

    bundle! {
        /// The registers. The line is kept inverted, so that it rests at reset.
        pub struct Registers {
            low, busy, count, position, octet,
        }
    }

    /// The configuration.
    #[derive(Debug, Clone)]
    pub struct Transmitter {
        divisor: u64,
    }

    impl Transmitter {
        /// A transmitter with so many clocks a bit.
        pub fn new(divisor: u64) -> Self {
            Transmitter { divisor }
        }

        /// The start bit.
        #[inline(always)]
        fn begin<V: Value>(&self, i: &Inputs<Signal<V>>) -> Registers<Signal<V>> {
            Registers { low: i.valid, busy: i.valid, count: int(self.divisor - 1), position: int(0), octet: i.octet }
        }

        /// The end of a bit: ones follow the last, and so the stop bit is one.
        #[inline(always)]
        fn advance<V: Value>(&self, r: Registers<Signal<V>>) -> Registers<Signal<V>> {
            Registers {
                low: !r.octet.bits(0, 1),
                busy: !r.position.is(STOP),
                count: int(self.divisor - 1),
                position: next(r.position),
                octet: bit(true).concat(r.octet.bits(1, 7)),
            }
        }
    }

    impl Block for Transmitter {
        const NAME: &'static str = "transmitter";
        type Inputs = Inputs;
        type Outputs = Outputs;
        type Registers = Registers;
        type Parts<V: Value> = ();

        fn inputs(&self) -> Inputs<Format> {
            Inputs { valid: BIT, octet: BYTE }
        }

        fn outputs(&self) -> Outputs<Format> {
            Outputs { taken: BIT, tx: BIT }
        }

        fn registers(&self) -> Registers<Format> {
            let (count, position) = (Format::counter(self.divisor - 1), Format::counter(STOP));
            Registers { low: BIT, busy: BIT, count, position, octet: BYTE }
        }

        #[inline(always)]
        fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
            let r = cell.load(self);
            let counting = Registers { count: previous(r.count), ..r };
            let busy = when!(V, Registers, r.count.is(0), self.advance(r), counting);
            let next = when!(V, Registers, r.busy, busy, self.begin(&i));
            cell.store(self, next);
            Outputs { taken: i.valid & !r.busy, tx: !r.low }
        }
    }
}
