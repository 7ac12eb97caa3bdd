// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sigma-delta: the carrier as one bit per clock, for a pin and a low-pass filter.
//!
//! ```text
//! s[n] = rest[n−1] + x[n] + ½ full scale,   pulse = carry of s,   rest = the others
//! ```
//!
//! | signal | format              | unit       | overflow                     |
//! | x      | s W.W−1 (carrier)   | full scale | –                            |
//! | rest   | u W                 | –          | wraps, meant: that is a pulse |
//!
//! First order: over any stretch of clocks the sum of pulses differs from the sum of `(x + 1) / 2`
//! by less than one. So the mean over a sample of 25 clocks is within 4 % of full scale, and that
//! over a window of thousands within parts per million. The error repeats with the carrier, whose
//! slots are all alike, and capacitance is a ratio to the voltage that is sensed, so that its share
//! in band cancels. A second order would need 40 cells and a limiter for carriers near full scale.
//! Latency: one clock. Source: Schreier and Temes, Understanding Delta-Sigma Data Converters, §2.

use super::bits::read_as;
use hapticore_hdl::block;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::code;

block! {
    /// The sigma-delta modulator of the carrier.
    pub struct SigmaDelta("sigma_delta") {
        carrier: Format,
    }
    submodules {}
    inputs(modulator) {
        carrier: modulator.carrier,
    }
    outputs(modulator) {
        /// The carrier as a density of pulses.
        pulse: BIT,
    }
    registers(modulator) {
        rest: modulator.rest(),
        pulse: BIT,
    }
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
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let width = self.carrier.width;
        let half = code::<V>(1 << (width - 1), self.rest());
        let offset = read_as(i.carrier.integer() + half, self.rest());
        let sum = r.rest + offset;
        state.store(self, Registers { rest: sum.bits(0, width), pulse: sum.bits(width, 1) });
        Outputs { pulse: r.pulse }
    }
}
