// SPDX-License-Identifier: MIT OR Apache-2.0
//! Estimator: from a window's sums to a frame, each stage starting the next.
//!
//! ```text
//! sums ─ currents ─ ratio ─ position ─ capacitance ─ force ─ frames ─ words
//!      └ haptic voltage ───────────────────────────────┘
//! ```
//!
//! One slot is in flight at a time, so that nothing of one pad can meet anything of another; the profile's blanking is longer
//! than the latency. Latency: the sum of the stages', from the last sum to the last word.

use super::capacitance::{self, Capacitance};
use super::currents::{self, Currents};
use super::force::{self, Force};
use super::frames::{self, Frames};
use super::haptic_voltage::{self, HapticVoltage};
use super::position::{self, Position};
use super::ratio::{self, Ratio};
use crate::block::{Block, Cell};
use crate::bundle::Bundle;
use crate::format::{BIT, Format};
use crate::profile::Profile;
use crate::signal::{Signal, Value, zero};
use crate::{bundle, choose, parts};

bundle! {
    /// The inputs: the demodulator's sums and the calibration.
    pub struct Inputs {
        /// Mean squares of windows before count no more.
        clear,
        /// A sum is there.
        valid,
        /// Which.
        index,
        /// The sum.
        sum,
        /// The pad of the window.
        pad,
        /// Whether a code of the window was at a rail.
        clipped,
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
    /// The outputs: a frame's words, and what holds for the whole of it.
    pub struct Outputs {
        /// Set for a clock for each word of a frame.
        valid,
        /// Which field the word is.
        index,
        /// The word.
        word,
        /// Set with the last word.
        done,
        /// The pad of the frame.
        pad,
        /// A code was at a rail of the ADC.
        clipped,
        /// A word was held at a rail.
        saturated,
        /// There is no such position or capacitance; the last valid results stand.
        invalid,
        /// A terminal's current is that of an open one.
        lost,
    }
}

bundle! {
    /// The registers.
    pub struct Registers {
        busy, pad, clipped,
    }
}

parts! {
    /// The blocks within.
    pub struct Parts of Estimator {
        currents: Currents,
        ratio: Ratio,
        position: Position,
        haptic_voltage: HapticVoltage,
        capacitance: Capacitance,
        force_estimator: Force,
        frames: Frames,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct Estimator {
    currents: Currents,
    ratio: Ratio,
    position: Position,
    haptic_voltage: HapticVoltage,
    capacitance: Capacitance,
    force_estimator: Force,
    frames: Frames,
    registers: Registers<Format>,
}

impl Estimator {
    /// The estimator of a profile.
    pub fn new(profile: &Profile) -> Self {
        let currents = Currents::new(profile);
        Estimator {
            ratio: Ratio::new(profile, currents.sums(), currents.least()),
            position: Position::new(profile),
            haptic_voltage: HapticVoltage::new(profile),
            capacitance: Capacitance::new(profile, currents.amplitude()),
            force_estimator: Force::new(profile),
            frames: Frames::new(profile),
            registers: Registers { busy: BIT, pad: Format::counter(profile.pads - 1), clipped: BIT },
            currents,
        }
    }

    /// Clocks from the last sum to the last word.
    pub fn latency(&self) -> u64 {
        let stages = [
            self.currents.latency(),
            self.ratio.latency(),
            self.position.latency(),
            self.capacitance.latency(),
            self.force_estimator.latency(),
            self.frames.latency(),
        ];
        stages.into_iter().sum()
    }

    /// As [`Position::place_at_once`].
    pub(crate) fn place_at_once(&mut self, table: Vec<i64>) {
        self.position.place_at_once(table);
    }

    /// The position.
    pub fn position(&self) -> &Position {
        &self.position
    }

    /// The currents.
    pub fn currents(&self) -> &Currents {
        &self.currents
    }
}

impl Block for Estimator {
    const NAME: &'static str = "estimator";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = Parts<V>;

    #[inline]
    fn inputs(&self) -> Inputs<Format> {
        let haptic = self.haptic_voltage.inputs();
        let position = self.position.inputs();
        Inputs {
            clear: BIT,
            valid: BIT,
            index: haptic.index,
            sum: haptic.sum,
            pad: self.registers.pad,
            clipped: BIT,
            capacitance_gain: self.capacitance.inputs().gain,
            force_gain: self.force_estimator.inputs().gain,
            write: BIT,
            address: position.address,
            word: position.word,
        }
    }

    #[inline]
    fn outputs(&self) -> Outputs<Format> {
        let frames::Outputs { index, word, .. } = self.frames.outputs();
        let pad = self.registers.pad;
        Outputs { valid: BIT, index, word, done: BIT, pad, clipped: BIT, saturated: BIT, invalid: BIT, lost: BIT }
    }

    #[inline(always)]
    fn registers(&self) -> Registers<Format> {
        let r = self.registers;
        Registers { busy: BIT, pad: r.pad.counting(), clipped: BIT }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        if (i.valid | r.busy | i.write | i.clear).idle() {
            return self.quiet(r);
        }
        let Inputs { valid, index, sum, .. } = i;
        let parts = &mut cell.parts;
        let inputs = currents::Inputs { valid, index, sum };
        let currents = self.currents.call("currents", &mut parts.currents, inputs);
        let pad = valid.select(i.pad, r.pad);
        let inputs = haptic_voltage::Inputs { clear: i.clear, pad, valid, index, sum };
        let haptic = self.haptic_voltage.call("haptic_voltage", &mut parts.haptic_voltage, inputs);
        let currents::Outputs { x, y, corners, least, .. } = currents;
        let inputs = ratio::Inputs { start: currents.done, x, y, corners, least };
        let ratio = self.ratio.call("ratio", &mut parts.ratio, inputs);
        let inputs = position::Inputs {
            start: ratio.done,
            r_x: ratio.r_x,
            r_y: ratio.r_y,
            share: ratio.share,
            write: i.write,
            address: i.address,
            word: i.word,
        };
        let position = self.position.call("position", &mut parts.position, inputs);
        let inputs = capacitance::Inputs {
            start: position.done,
            total: currents.total,
            sense: currents.sense,
            sheet: position.sheet,
            gain: i.capacitance_gain,
        };
        let capacitance = self.capacitance.call("capacitance", &mut parts.capacitance, inputs);
        let inputs = force::Inputs {
            start: capacitance.done,
            capacitance: capacitance.capacitance,
            mean_square: haptic.mean_square,
            gain: i.force_gain,
        };
        let force = self.force_estimator.call("force_estimator", &mut parts.force_estimator, inputs);
        let invalid = ratio.invalid | position.invalid | capacitance.invalid;
        let inputs = frames::Inputs {
            start: force.done,
            pad: r.pad,
            invalid,
            r_x: self.frames.ratio(ratio.r_x),
            r_y: self.frames.ratio(ratio.r_y),
            x: position.x,
            y: position.y,
            sheet: position.sheet,
            capacitance: capacitance.capacitance,
            haptic_force: force.haptic_force,
            mean_square: haptic.mean_square,
        };
        let frames = self.frames.call("frames", &mut parts.frames, inputs);
        let held = currents.saturated | haptic.saturated | position.saturated | capacitance.saturated | force.saturated;
        let held = held.named("any_saturated");
        let busy = valid | (r.busy & !frames.done);
        cell.store(self, Registers { busy, pad, clipped: valid.select(i.clipped, r.clipped) });
        let gate = |a: Signal<V>| choose!(V, frames.valid, a, zero(a.format));
        Outputs {
            valid: frames.valid,
            index: gate(frames.index),
            word: gate(frames.word),
            done: frames.done,
            pad: r.pad,
            clipped: r.clipped,
            saturated: gate(held),
            invalid: gate(invalid),
            lost: gate(position.lost),
        }
    }
}

impl Estimator {
    /// The outputs while nothing is under way: no frame, and so nothing about one.
    #[inline(always)]
    fn quiet<V: Value>(&self, r: Registers<Signal<V>>) -> Outputs<Signal<V>> {
        let zero = Outputs::map(self.outputs(), |format| zero(format));
        Outputs { pad: r.pad, clipped: r.clipped, ..zero }
    }
}
