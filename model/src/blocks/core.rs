// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core: ADC codes in, frames out.
//!
//! ```text
//! strobe ─ multiplexer ─ oscillator ─ demodulator ─ estimator ─ frames
//!            └ pad, closed      code ──┘      calibration ──┘
//! ```
//!
//! The answer to `channel` is expected as `code` one clock later. Pads are selected by `pad` and `closed`, break before make.

use super::demodulator::{self, Demodulator};
use super::estimator::{self, Estimator};
use super::multiplexer::{self, Multiplexer};
use super::oscillator::{self, Oscillator};
use super::pace::{self, Pace};
use crate::block::{Block, Cell};
use crate::bundle::Nothing;
use crate::format::{BIT, Format};
use crate::profile::Profile;
use crate::signal::{Signal, Value};
use crate::{bundle, parts};

bundle! {
    /// The inputs.
    pub struct Inputs {
        /// A set of ADC codes is there.
        strobe,
        /// Abandons the slot under way: the next strobe is the first of the first pad's slot.
        clear,
        /// The code of the channel asked for in the clock before.
        code,
        /// Calibration: picofarads at an admittance of one.
        capacitance_gain,
        /// Calibration: newtons per square picofarad at full haptic mean square.
        force_gain,
        /// Calibration: writes a word of the position table.
        write,
        /// Calibration: where.
        address,
        /// Calibration: what.
        word,
    }
}

bundle! {
    /// The outputs.
    pub struct Outputs {
        /// The channel whose code is wanted.
        channel,
        /// The pad that is served.
        serve,
        /// Whether its switch is made.
        closed,
        /// The carrier.
        carrier,
        /// Set for a clock for each word of a frame.
        valid,
        /// Which field the word is.
        index,
        /// The word.
        frame,
        /// Set with a frame's last word.
        done,
        /// The pad of the frame.
        pad,
        /// A code was at a rail of the ADC.
        clipped,
        /// A word was held at a rail.
        saturated,
        /// The last valid results stand.
        invalid,
        /// A terminal's current is that of an open one.
        lost,
        /// Strobes have come closer than the profile's clocks a sample since reset or `clear`: frames are wrong.
        overrun,
    }
}

parts! {
    /// The blocks within.
    pub struct Parts of Core {
        multiplexer: Multiplexer,
        pace: Pace,
        oscillator: Oscillator,
        demodulator: Demodulator,
        estimator: Estimator,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct Core {
    multiplexer: Multiplexer,
    pace: Pace,
    oscillator: Oscillator,
    demodulator: Demodulator,
    estimator: Estimator,
}

impl Core {
    /// The core of a profile.
    pub fn new(profile: &Profile) -> Self {
        Core {
            multiplexer: Multiplexer::new(profile),
            pace: Pace::new(profile),
            oscillator: Oscillator::new(profile),
            demodulator: Demodulator::new(profile),
            estimator: Estimator::new(profile),
        }
    }

    /// The multiplexer.
    pub fn multiplexer(&self) -> &Multiplexer {
        &self.multiplexer
    }

    /// The oscillator.
    pub fn oscillator(&self) -> &Oscillator {
        &self.oscillator
    }

    /// The demodulator.
    pub fn demodulator(&self) -> &Demodulator {
        &self.demodulator
    }

    /// The estimator.
    pub fn estimator(&self) -> &Estimator {
        &self.estimator
    }

    /// From now on readings of codes have positions at once, without their clocks, from a position table of these codes.
    pub(crate) fn place_at_once(&mut self, table: Vec<i64>) {
        self.estimator.place_at_once(table);
    }

    /// Clocks from the strobe of a window's last sample to the last word of its frame.
    pub fn latency(&self) -> u64 {
        1 + self.oscillator.latency() + self.demodulator.latency() + self.estimator.latency()
    }
}

impl Block for Core {
    const NAME: &'static str = "hapticore";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Nothing;
    type Parts<V: Value> = Parts<V>;

    #[inline]
    fn inputs(&self) -> Inputs<Format> {
        let estimator::Inputs { capacitance_gain, force_gain, address, word, .. } = self.estimator.inputs();
        let code = self.demodulator.inputs().code;
        Inputs { strobe: BIT, clear: BIT, code, capacitance_gain, force_gain, write: BIT, address, word }
    }

    #[inline]
    fn outputs(&self) -> Outputs<Format> {
        let estimator::Outputs { valid, index, word: frame, done, pad, clipped, saturated, invalid, lost } =
            self.estimator.outputs();
        let channel = self.demodulator.outputs().channel;
        let carrier = self.oscillator.outputs().cosine;
        Outputs {
            channel,
            serve: pad,
            closed: BIT,
            carrier,
            valid,
            index,
            frame,
            done,
            pad,
            clipped,
            saturated,
            invalid,
            lost,
            overrun: BIT,
        }
    }

    #[inline(always)]
    fn registers(&self) -> Nothing<Format> {
        Nothing::default()
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let parts = &mut cell.parts;
        let inputs = multiplexer::Inputs { strobe: i.strobe, clear: i.clear };
        let slot = self.multiplexer.call("multiplexer", &mut parts.multiplexer, inputs);
        let inputs = pace::Inputs { strobe: i.strobe, clear: i.clear };
        let pace = self.pace.call("pace", &mut parts.pace, inputs);
        let inputs = oscillator::Inputs { sample: slot.sample, restart: slot.restart, first: slot.first };
        let oscillator = self.oscillator.call("oscillator", &mut parts.oscillator, inputs);
        let inputs = demodulator::Inputs {
            start: oscillator.ready & slot.integrate,
            first: slot.first,
            last: slot.last,
            pad: slot.pad,
            code: i.code,
            cosine: oscillator.cosine,
            sine: oscillator.sine,
            window: oscillator.window,
            phase: oscillator.phase,
        };
        let demodulator = self.demodulator.call("demodulator", &mut parts.demodulator, inputs);
        let inputs = estimator::Inputs {
            clear: i.clear,
            valid: demodulator.valid,
            index: demodulator.index,
            sum: demodulator.sum,
            pad: demodulator.pad,
            clipped: demodulator.clipped,
            capacitance_gain: i.capacitance_gain,
            force_gain: i.force_gain,
            write: i.write,
            address: i.address,
            word: i.word,
        };
        let frame = self.estimator.call("estimator", &mut parts.estimator, inputs);
        Outputs {
            channel: demodulator.channel,
            serve: slot.pad,
            closed: slot.closed,
            carrier: oscillator.cosine,
            valid: frame.valid,
            index: frame.index,
            frame: frame.word,
            done: frame.done,
            pad: frame.pad,
            clipped: frame.clipped,
            saturated: frame.saturated,
            invalid: frame.invalid,
            lost: frame.lost,
            overrun: pace.overrun,
        }
    }
}
