// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sigma-delta: the carrier as one bit a clock, for a pin and a low-pass filter.
//!
//! ```text
//! s[n] = rest[n−1] + x[n] + ½ full scale,   pulse = carry of s,   rest = the others
//! ```
//!
//! | signal | format              | unit       | overflow                     |
//! | x      | s W.W−1 (carrier)   | full scale | –                            |
//! | rest   | u W                 | –          | wraps, meant: that is a pulse |
//!
//! First order: over any stretch of clocks the sum of pulses differs from the sum of `(x + 1) / 2` by less than one, so the mean
//! over a sample of 25 clocks is within 4 % of full scale and that over a window of thousands within parts per million. The
//! error repeats with the carrier, whose slots are all alike, and capacitance is a ratio to the voltage that is sensed, so
//! that its share in band cancels. A second order would need 40 cells and a limiter for carriers near full scale.
//! Latency: one clock. Source: Schreier and Temes, Understanding Delta-Sigma Data Converters, §2.

use super::bits::read_as;
use hapticore_model::block::{Block, Cell};
use hapticore_model::bundle;
use hapticore_model::format::{BIT, Format};
use hapticore_model::signal::{Signal, Value, code};

bundle! {
    /// The inputs.
    pub struct Inputs {
        /// What is to be put out.
        carrier,
    }
}

bundle! {
    /// The output: a register.
    pub struct Outputs {
        /// One bit of it.
        pulse,
    }
}

bundle! {
    /// The registers.
    pub struct Registers {
        rest, pulse,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct SigmaDelta {
    carrier: Format,
}

impl SigmaDelta {
    /// A modulator for carriers of a signed format.
    pub fn new(carrier: Format) -> Self {
        assert!(carrier.signed, "a carrier has both signs");
        SigmaDelta { carrier }
    }

    fn rest(&self) -> Format {
        Format::unsigned(self.carrier.width, 0)
    }
}

impl Block for SigmaDelta {
    const NAME: &'static str = "sigma_delta";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = ();

    fn inputs(&self) -> Inputs<Format> {
        Inputs { carrier: self.carrier }
    }

    fn outputs(&self) -> Outputs<Format> {
        Outputs { pulse: BIT }
    }

    fn registers(&self) -> Registers<Format> {
        Registers { rest: self.rest(), pulse: BIT }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let width = self.carrier.width;
        let half = code::<V>(1 << (width - 1), self.rest());
        let offset = read_as(i.carrier.integer() + half, self.rest());
        let sum = r.rest + offset;
        cell.store(self, Registers { rest: sum.bits(0, width), pulse: sum.bits(width, 1) });
        Outputs { pulse: r.pulse }
    }
}
