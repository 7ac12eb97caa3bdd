// SPDX-License-Identifier: MIT OR Apache-2.0
//! Haptic voltage: its mean square over the demodulator's window.
//!
//! ```text
//! m = Σ w[n]·h[n]² · 2^-shift        (the weighted sum comes from the demodulator; the host knows Σ w)
//! ```
//!
//! ```text
//! sum ─[round half even, saturate]─ mean_square
//! ```
//!
//! | signal      | format  | unit             | overflow           |
//! | mean_square | profile | full scale²      | saturates, flagged |
//!
//! Latency: one clock. Source: paper, eq. 7 (the force follows the square); PHYSICS §3 (the gap follows the RMS).

use super::demodulator::Demodulator;
use crate::block::{Block, Cell};
use crate::bundle;
use crate::format::{BIT, Format};
use crate::profile::Profile;
use crate::signal::{HalfEven, Signal, Value};

bundle! {
    /// The inputs: the demodulator's sums.
    pub struct Inputs {
        /// A sum is there.
        valid,
        /// Which.
        index,
        /// The sum.
        sum,
    }
}

bundle! {
    /// The outputs: registers.
    pub struct Outputs {
        /// The mean square.
        mean_square,
        /// Whether it is held at its rail.
        saturated,
    }
}

bundle! {
    /// The registers.
    pub struct Registers {
        mean_square, saturated,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct HapticVoltage {
    shift: i8,
    sums: u64,
    sum: Format,
    registers: Registers<Format>,
}

impl HapticVoltage {
    /// The haptic voltage of a profile.
    pub fn new(profile: &Profile) -> Self {
        let demodulator = Demodulator::new(profile);
        let registers = Registers { mean_square: profile.formats.mean_square, saturated: BIT };
        HapticVoltage { shift: profile.square_shift(), sums: demodulator.sums(), sum: demodulator.sum(), registers }
    }
}

impl Block for HapticVoltage {
    const NAME: &'static str = "haptic_voltage";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = ();

    #[inline]
    fn inputs(&self) -> Inputs<Format> {
        Inputs { valid: BIT, index: Format::counter(self.sums - 1), sum: self.sum }
    }

    #[inline]
    fn outputs(&self) -> Outputs<Format> {
        let Registers { mean_square, saturated } = self.registers;
        Outputs { mean_square, saturated }
    }

    #[inline(always)]
    fn registers(&self) -> Registers<Format> {
        self.registers
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let outputs = Outputs { mean_square: r.mean_square, saturated: r.saturated };
        if i.valid.idle() {
            return outputs;
        }
        let squares = i.valid & i.index.is(self.sums - 1);
        let (mean_square, saturated) = i.sum.scaled(-self.shift).saturate(r.mean_square.format, HalfEven);
        let mean_square = squares.select(mean_square, r.mean_square);
        cell.store(self, Registers { mean_square, saturated: squares.select(saturated, r.saturated) });
        outputs
    }
}
