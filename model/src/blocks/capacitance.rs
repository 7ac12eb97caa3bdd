// SPDX-License-Identifier: MIT OR Apache-2.0
//! Capacitance: the total current over the sensing voltage, with the sheet's resistance taken out.
//!
//! ```text
//! C = gain · a / √(v² − (a·R)²)        (PHYSICS §2, robust form; R of the pad's place, from the map)
//! C = gain · a / v                     (paper, eq. 6, where the profile asks for it alone)
//! ```
//!
//! ```text
//! a ─(×)─[drop]─(²)─(v² −)─[clamp at 0]─[root]─ a ÷ ─[admittance]─(× gain)─[round half even, saturate]─ capacitance
//! R ─┘
//! ```
//!
//! | signal      | format      | unit        | overflow                                 |
//! | drop        | amplitude's | full scale  | saturates, flagged                       |
//! | radicand    | exact       | full scale² | held at zero from below, then `invalid` |
//! | admittance  | profile     | –           | saturates, flagged                       |
//! | capacitance | profile     | pF          | saturates, flagged                       |
//!
//! One multiplier serves all four products; it works on codes as integers, so that their points need not agree, and a step
//! takes as long as it does. Latency: 7 products + root + divider + 3 clocks from `start` to `done`.

use super::divider::{self, Divider};
use super::multiplier::{self, Multiplier};
use super::root::{self, Root};
use crate::block::{Block, Cell};
use crate::format::{BIT, Format};
use crate::profile::Profile;
use crate::signal::{Exact, HalfEven, Saturate, Signal, Value, Wrap, bit, int, zero};
use crate::{bundle, next, parts};

bundle! {
    /// The inputs.
    pub struct Inputs {
        /// All others are there, and hold.
        start,
        /// The amplitude of the total current.
        total,
        /// The amplitude of the sensing voltage.
        sense,
        /// The sheet's resistance at the pad, in full scales of voltage per current.
        sheet,
        /// Picofarads at an admittance of one.
        gain,
    }
}

bundle! {
    /// The outputs: registers.
    pub struct Outputs {
        /// Set for one clock when the capacitance is there.
        done,
        /// The capacitance.
        capacitance,
        /// Whether there is no such capacitance.
        invalid,
        /// Whether a word is held at a rail.
        saturated,
    }
}

bundle! {
    /// The registers. `left` and `right` are codes as integers.
    pub struct Registers {
        step: [
            "idle", "load", "sense", "drop", "square", "drop_square", "radicand", "root", "divide", "gain_product",
            "finish",
        ],
        waited, left, right, drop, square, root_start, divide, capacitance, invalid, saturated, done,
    }
}

parts! {
    /// The blocks within.
    pub struct Parts of Capacitance {
        multiplier: Multiplier,
        root: Root,
        divider: Divider,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct Capacitance {
    multiplier: Multiplier,
    root: Root,
    divider: Divider,
    correct: bool,
    amplitude: Format,
    sheet: Format,
    admittance: Format,
    gain: Format,
    registers: Registers<Format>,
}

impl Capacitance {
    /// The capacitance of a profile, for amplitudes of a format.
    pub fn new(profile: &Profile, amplitude: Format) -> Self {
        let f = &profile.formats;
        let (sheet, admittance, gain) = (profile.sheet(), f.admittance, f.capacitance_gain);
        let square = Format::unsigned(2 * amplitude.width, 2 * amplitude.frac);
        let root = Root::new(square, amplitude.frac);
        let divider = Divider::new(amplitude, root.root(), admittance);
        let left = Format::unsigned(amplitude.width.max(admittance.width), 0);
        let right = Format::unsigned(amplitude.width.max(sheet.width).max(gain.width), 0);
        let registers = Registers {
            step: Format::unsigned(4, 0),
            waited: BIT,
            left,
            right,
            drop: amplitude,
            square,
            root_start: BIT,
            divide: BIT,
            capacitance: f.capacitance,
            invalid: BIT,
            saturated: BIT,
            done: BIT,
        };
        let correct = profile.capacitance.sheet_correction;
        let multiplier = Multiplier::new(left, right, profile.multiplier);
        Capacitance { multiplier, root, divider, correct, amplitude, sheet, admittance, gain, registers }
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        7 * self.multiplier.latency() + self.root.latency() + self.divider.latency() + 3
    }

    /// The multiplier's operands of this step, as integers.
    #[inline(always)]
    fn operands<V: Value>(
        &self,
        r: &Registers<Signal<V>>,
        i: &Inputs<Signal<V>>,
        admittance: Signal<V>,
    ) -> (Signal<V>, Signal<V>) {
        let [total, sense, drop, admittance] = [i.total, i.sense, r.drop, admittance].map(Signal::integer);
        let sheet = if self.correct { i.sheet } else { zero(self.sheet) }.integer();
        let at = |step: u64| r.step.is(step);
        let left = at(1).select(total, at(2).select(sense, at(4).select(drop, admittance)));
        let right = at(1).select(sheet, at(2).select(sense, at(4).select(drop, i.gain.integer())));
        (left, right)
    }

    /// v² − (a·R)², held at zero from below, and whether nothing is left.
    #[inline(always)]
    fn radicand<V: Value>(&self, r: &Registers<Signal<V>>, product: Signal<V>) -> (Signal<V>, Signal<V>) {
        let drop = product.as_code(self.amplitude.product(self.amplitude));
        let left = (r.square - drop).named("left_over").fit(r.square.format, Exact, Saturate);
        (left, left.equals(zero(left.format)))
    }

    #[inline(always)]
    fn step<V: Value>(
        &self,
        r: Registers<Signal<V>>,
        i: Inputs<Signal<V>>,
        (product, nothing_left, rooted, divided): (Signal<V>, Signal<V>, Signal<V>, divider::Outputs<Signal<V>>),
    ) -> Registers<Signal<V>> {
        let at = |step: u64| r.step.is(step);
        let (drop, drop_held) = product.as_code(self.amplitude.product(self.sheet)).saturate(self.amplitude, HalfEven);
        let square = product.as_code(self.amplitude.product(self.amplitude));
        let (result, held) =
            product.as_code(self.admittance.product(self.gain)).saturate(r.capacitance.format, HalfEven);
        let (left, right) = self.operands(&r, &i, divided.quotient);
        let waits = (at(7) & !rooted) | (at(8) & !divided.done);
        let onward = at(10).select(int(0), r.step + int(1));
        let saturated = (at(3) & drop_held) | (at(8) & divided.done & divided.saturated) | (at(10) & held);
        Registers {
            step: waits.select(r.step, onward).fit(r.step.format, Exact, Wrap),
            waited: bit(false),
            left,
            right,
            drop: at(3).select(drop, r.drop),
            square: at(4).select(square, r.square),
            root_start: at(5),
            divide: at(7) & rooted,
            capacitance: at(10).select(result, r.capacitance),
            invalid: at(6).select(nothing_left, r.invalid),
            saturated: r.saturated | saturated,
            done: at(10),
        }
    }
}

impl Block for Capacitance {
    const NAME: &'static str = "capacitance";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = Parts<V>;

    #[inline]
    fn inputs(&self) -> Inputs<Format> {
        let (total, sheet, gain) = (self.amplitude, self.sheet, self.gain);
        Inputs { start: BIT, total, sense: total, sheet, gain }
    }

    #[inline]
    fn outputs(&self) -> Outputs<Format> {
        let Registers { done, capacitance, invalid, saturated, .. } = self.registers;
        Outputs { done, capacitance, invalid, saturated }
    }

    #[inline(always)]
    fn registers(&self) -> Registers<Format> {
        let r = self.registers;
        Registers {
            done: BIT,
            root_start: BIT,
            divide: BIT,
            invalid: BIT,
            saturated: BIT,
            waited: BIT,
            step: r.step.counting(),
            left: r.left.counting(),
            right: r.right.counting(),
            drop: self.amplitude,
            square: r.square.with_point(2 * self.amplitude.frac),
            capacitance: r.capacitance,
        }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let Registers { done, capacitance, invalid, saturated, .. } = r;
        let outputs = Outputs { done, capacitance, invalid, saturated };
        if (i.start | !r.step.is(0) | r.done).idle() {
            return outputs;
        }
        let inputs = multiplier::Inputs { enable: !r.step.is(0), left: r.left, right: r.right };
        let product = self.multiplier.call("multiplier", &mut cell.parts.multiplier, inputs).product;
        let (radicand, nothing_left) = self.radicand(&r, product);
        let inputs = root::Inputs { start: r.root_start, radicand };
        let root = self.root.call("root", &mut cell.parts.root, inputs);
        let inputs = divider::Inputs { start: r.divide, numerator: i.total, denominator: root.root };
        let divided = self.divider.call("divider", &mut cell.parts.divider, inputs);
        let idle = Registers { root_start: bit(false), divide: bit(false), done: bit(false), ..r };
        let begin = Registers { step: int(1), waited: bit(false), saturated: bit(false), ..idle };
        let waits = Registers { waited: bit(true), ..idle };
        let acts = self.multiplier.paces(r.waited) | r.step.is(7) | r.step.is(8);
        let results = (product, nothing_left, root.done, divided);
        next!(
            V,
            Registers,
            self,
            cell,
            i.start => begin,
            r.step.is(0) => idle,
            acts => self.step(idle, i, results),
            else waits
        );
        outputs
    }
}
