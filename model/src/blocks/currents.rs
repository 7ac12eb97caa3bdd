// SPDX-License-Identifier: MIT OR Apache-2.0
//! Currents: amplitudes of every channel and of the sum over all terminals, and the sums of eqs. 2 and 3.
//!
//! ```text
//! a_k = √(i_k² + q_k²),   a = √((Σ i_k)² + (Σ q_k)²),   x = Σ ±a_k,   y = Σ ±a_k,   corners = Σ a_k of those in x or y
//! ```
//!
//! ```text
//! sum ─(round half even, saturate)─[iq]─[words]─(²)─(+)─[root]─ amplitude ─(±)─ x, y, corners
//!                                            └─(+ over terminals)─[saturate]─ total
//! ```
//!
//! | signal          | format  | unit           | overflow             |
//! | iq, total       | profile | full scale     | saturates, flagged   |
//! | power           | exact   | full scale²    | cannot (range proof) |
//! | amplitude       | total's | full scale     | cannot (range proof) |
//! | x, y, corners   | exact   | full scale     | cannot (range proof) |
//!
//! Words may be moved up together, so that small currents keep their bits: see `currents/block.rs`. x, y and corners then count what the
//! largest current makes of a word's step; total and sensing voltage are at one point again.
//!
//! Latency: (terminals + 2) · (6 products + root + 1) + 1 clocks from the last sum (the mean square's) to `done`. Source: paper,
//! eqs. 2–5; the sum is that of all terminals' complex currents, for the corners alone carry only a part (PHYSICS §1).

mod block;

use super::multiplier::{self, Multiplier};
use super::root::{self, Root};
use crate::block::{Block, Cell};
use crate::format::{BIT, Format};
use crate::memory::{Memory, Write};
use crate::profile::Profile;
use crate::signal::{Exact, Floor, HalfEven, Lemma, Never, Signal, Value, Wrap, bit, int, zero};
use crate::{bundle, choose, parts, when};

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
    /// The outputs: registers, that hold until the next are there.
    pub struct Outputs {
        /// Set for one clock when all others are there.
        done,
        /// The amplitude of the total current.
        total,
        /// The amplitude of the sensing voltage.
        sense,
        /// The numerator of r_x.
        x,
        /// The numerator of r_y.
        y,
        /// Their denominator.
        corners,
        /// The least amplitude of the terminals, in the unit of the numerators.
        least,
        /// Whether a word is held at a rail.
        saturated,
    }
}

bundle! {
    /// The registers.
    pub struct Registers {
        step: [
            "idle", "read", "in_phase", "read_quadrature", "quadrature", "square", "power", "root",
            "align_read", "align_load", "align_move", "align_keep", "restore",
        ],
        arrived, place, word, waited, channel, total_i, total_q, part, power, root_start,
        sense, x, y, corners, least, saturated, done,
        long, count, limit, other, quadrature, aligning, whole,
    }
}

parts! {
    /// The blocks within.
    pub struct Parts of Currents {
        words: Memory,
        multiplier: Multiplier,
        root: Root,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct Currents {
    words: Memory,
    multiplier: Multiplier,
    root: Root,
    terminals: u64,
    signs: [Vec<i8>; 2],
    /// Bits by which a sum over the window is scaled down to full scale.
    shift: i8,
    sum: Format,
    iq: Format,
    /// Of the sums over all terminals.
    total: Format,
    /// Of what is squared.
    part: Format,
    /// Bits by which words may be moved up, together; none where they all have one point.
    block: u8,
    /// The amplitudes that are given out.
    given: Format,
    registers: Registers<Format>,
}

const SQUARE: &str = "a square is not negative";

impl Currents {
    /// The currents of a profile.
    pub fn new(profile: &Profile) -> Self {
        let (iq, block) = (profile.formats.iq, profile.formats.block_shift);
        let terminals = profile.terminals.x.len() as u64;
        let (part, total) = match block {
            0 => (profile.formats.total, profile.formats.total),
            _ => (iq, Format::signed(iq.width + Format::counter(terminals).width, iq.frac)),
        };
        let wide = Format::signed(iq.width + block, iq.frac + block as i8);
        let power = Format::unsigned(2 * part.width, 2 * part.frac);
        let root = Root::new(power, part.frac);
        let amplitude = root.root();
        let sums = Format::signed(amplitude.width + 1 + Format::counter(terminals).width, amplitude.frac);
        let channels = terminals + 1;
        let demodulator = super::demodulator::Demodulator::new(profile);
        let words = Memory::new("words", (2 * channels + 2).next_power_of_two() as usize, wide).never_colliding();
        let registers = Registers {
            step: Format::unsigned(if block == 0 { 3 } else { 4 }, 0),
            arrived: BIT,
            place: words.address(),
            word: wide,
            waited: BIT,
            channel: Format::counter(channels),
            total_i: total,
            total_q: total,
            part,
            power,
            root_start: BIT,
            sense: amplitude,
            x: sums,
            y: sums,
            corners: Format { signed: false, width: sums.width - 1, ..sums },
            least: amplitude,
            saturated: BIT,
            done: BIT,
            long: wide,
            count: Format::counter(block.into()),
            limit: Format::counter(block.into()),
            other: Format::counter(block.into()),
            quadrature: BIT,
            aligning: BIT,
            whole: Format::unsigned(amplitude.width + Format::counter(terminals).width, amplitude.frac),
        };
        Currents {
            words,
            multiplier: Multiplier::new(part.integer(), part.integer(), profile.multiplier),
            root,
            terminals,
            signs: [profile.terminals.x.clone(), profile.terminals.y.clone()],
            shift: profile.sum_shift() - demodulator.shift(),
            sum: demodulator.sum(),
            iq,
            total,
            part,
            block,
            given: if block == 0 { amplitude } else { profile.amplitude_format() },
            registers,
        }
    }

    /// The format of an amplitude.
    pub fn amplitude(&self) -> Format {
        self.given
    }

    /// The formats of the numerators and of the denominator of eqs. 2 and 3.
    pub fn sums(&self) -> (Format, Format) {
        (self.registers.x, self.registers.corners)
    }

    /// The format of the least amplitude.
    pub fn least(&self) -> Format {
        self.registers.least
    }

    /// Clocks from the last sum to `done`.
    pub fn latency(&self) -> u64 {
        (self.terminals + 2) * (6 * self.multiplier.latency() + self.root.latency() + 1) + 1 + self.block_latency()
    }

    /// The in-phase or quadrature word of a sum, and whether it is held at a rail.
    #[inline(always)]
    fn word<V: Value>(&self, sum: Signal<V>) -> (Signal<V>, Signal<V>) {
        let rounding = if self.block == 0 { HalfEven } else { Floor };
        sum.scaled(-self.shift).saturate(self.wide(), rounding)
    }

    /// A sum arrives: its word goes into the memory, and with the last the loop over channels begins.
    #[inline(always)]
    fn take<V: Value>(&self, r: Registers<Signal<V>>, i: Inputs<Signal<V>>, held: Signal<V>) -> Registers<Signal<V>> {
        let among = i.index.less_than(int(2 * (self.terminals + 1)));
        let begin = if self.block == 0 { int(1) } else { int(block::READ) };
        let r = if self.block == 0 { r } else { self.unaligned(r) };
        Registers {
            step: i.index.is(2 * self.terminals + 2).select(begin, r.step),
            waited: bit(false),
            channel: int(0),
            total_i: zero(self.total),
            total_q: zero(self.total),
            saturated: (!i.index.is(0) & r.saturated) | (among & held),
            ..r
        }
    }

    /// A total with a terminal's word more, and whether it is held at a rail.
    #[inline(always)]
    fn more<V: Value>(&self, r: &Registers<Signal<V>>) -> (Signal<V>, Signal<V>) {
        (r.total_i + r.part).named("more").saturate(self.total, Exact)
    }

    /// A step of the loop over channels: words, squares, root, sums.
    #[inline(always)]
    fn step<V: Value>(
        &self,
        r: Registers<Signal<V>>,
        word: Signal<V>,
        product: Signal<V>,
        root: root::Outputs<Signal<V>>,
    ) -> Registers<Signal<V>> {
        let at = |step: u64| r.step.is(step);
        let all = r.channel.is(self.terminals + 1);
        let terminal = r.channel.less_than(int(self.terminals));
        let square = product.fit(self.square(), Exact, Lemma(SQUARE)).scaled(-2 * self.part.frac);
        let power = at(6).select(r.power + square, square).fit(r.power.format, Exact, Never);
        let adds = ((at(3) | at(5)) & terminal).named("adds");
        let (more, held) = self.more(&r);
        let rooted = (at(7) & root.done).named("rooted");
        let r = when!(V, Registers, rooted, self.sum_up(r, root.root), r);
        let total = |total: Signal<V>| if self.block == 0 { total } else { self.narrow_total(total) };
        let (in_phase, quadrature) = (all.select(total(r.total_i), word), all.select(total(r.total_q), word));
        let part = at(2).select(in_phase, at(4).select(quadrature, r.part));
        let after = if self.block == 0 { int(0) } else { int(block::RESTORE) };
        let following = at(7).select(r.step, r.step + int(1));
        Registers {
            step: rooted.select(all.select(after, int(1)), following).fit(r.step.format, Exact, Wrap),
            waited: bit(false),
            // The totals change places with every addition: one adder, one register that takes its result.
            total_i: adds.select(r.total_q, r.total_i),
            total_q: choose!(V, adds, more, r.total_q),
            part,
            power: {
                let squared = at(4) | at(6);
                choose!(V, squared, power, r.power)
            },
            root_start: at(6),
            saturated: r.saturated | (adds & held),
            done: if self.block == 0 { rooted & all } else { bit(false) },
            ..r
        }
    }

    /// The format of a square as an integer.
    #[inline(always)]
    fn square(&self) -> Format {
        self.registers.power.integer()
    }

    /// An amplitude is there: of a terminal, of the sensing voltage, and last of the total.
    #[inline(always)]
    fn sum_up<V: Value>(&self, r: Registers<Signal<V>>, amplitude: Signal<V>) -> Registers<Signal<V>> {
        let opening = r.channel.is(0);
        let terminal = r.channel.less_than(int(self.terminals));
        let smaller = opening | (terminal & amplitude.less_than(r.least));
        let negative = (-amplitude).named("negative");
        let with = |sum: Signal<V>, sign: &dyn Fn(usize) -> i8| {
            let plus = self.among(r.channel, |k| sign(k) > 0).select(amplitude, zero(amplitude.format));
            let more = self.among(r.channel, |k| sign(k) < 0).select(negative, plus);
            (opening.select(zero(sum.format), sum) + more).fit(sum.format, Exact, Never)
        };
        let [x, y] = &self.signs;
        Registers {
            channel: (r.channel + int(1)).fit(r.channel.format, Exact, Wrap),
            whole: self.whole(&r, amplitude),
            sense: r.channel.is(self.terminals).select(amplitude, r.sense),
            x: with(r.x, &|k| x[k]),
            y: with(r.y, &|k| y[k]),
            corners: with(r.corners, &|k| i8::from(x[k] != 0 || y[k] != 0)),
            least: smaller.select(amplitude, r.least),
            ..r
        }
    }

    /// Whether the channel is one of the terminals that `choose` names.
    fn among<V: Value>(&self, channel: Signal<V>, choose: impl Fn(usize) -> bool) -> Signal<V> {
        let chosen = (0..self.terminals).filter(|&k| choose(k as usize));
        chosen.map(|k| channel.is(k)).reduce(|a, b| a | b).unwrap_or(bit(false))
    }

    #[inline(always)]
    fn results<V: Value>(&self, r: &Registers<Signal<V>>, total: Signal<V>) -> Outputs<Signal<V>> {
        let Registers { done, x, y, corners, least, .. } = *r;
        if self.block == 0 {
            return Outputs { done, total, sense: r.sense, x, y, corners, least, saturated: r.saturated };
        }
        let ((total, beyond), (sense, too)) = (self.rounded(r.whole), self.rounded(r.sense));
        Outputs { done, total, sense, x, y, corners, least, saturated: r.saturated | beyond | too }
    }

    /// The total's amplitude, to be moved back.
    #[inline(always)]
    fn whole<V: Value>(&self, r: &Registers<Signal<V>>, amplitude: Signal<V>) -> Signal<V> {
        if self.block == 0 { r.whole } else { amplitude.scaled(self.down()).fit(r.whole.format, Exact, Never) }
    }
}

impl Currents {
    /// A clock on the way from words to results.
    #[inline(always)]
    fn busy<V: Value>(
        &self,
        r: Registers<Signal<V>>,
        data: Signal<V>,
        product: Signal<V>,
        root: root::Outputs<Signal<V>>,
    ) -> Registers<Signal<V>> {
        let waits = Registers { waited: bit(true), ..r };
        let acts = self.multiplier.paces(r.waited) | r.step.is(7);
        if self.block == 0 {
            return when!(V, Registers, acts, self.step(r, data.aligned(r.part.format), product, root), waits);
        }
        let aligns = r.step.at_least(int(block::READ)) & r.step.less_than(int(block::RESTORE));
        let restores = r.step.is(block::RESTORE);
        when!(
            V,
            Registers,
            aligns,
            self.align(r, data),
            when!(
                V,
                Registers,
                restores,
                self.restore(r),
                when!(V, Registers, acts, self.step(r, self.narrow(data), product, root), waits)
            )
        )
    }
}

impl Block for Currents {
    const NAME: &'static str = "currents";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = Parts<V>;

    #[inline]
    fn inputs(&self) -> Inputs<Format> {
        Inputs { valid: BIT, index: Format::counter(2 * (self.terminals + 1)), sum: self.sum }
    }

    #[inline]
    fn outputs(&self) -> Outputs<Format> {
        let Registers { done, x, y, corners, least, saturated, .. } = self.registers;
        Outputs { done, total: self.given, sense: self.given, x, y, corners, least, saturated }
    }

    #[inline(always)]
    fn registers(&self) -> Registers<Format> {
        let (r, total, part) = (self.registers, self.total, self.part);
        let amplitude = |format: Format| format.with_point(part.frac);
        Registers {
            done: BIT,
            root_start: BIT,
            saturated: BIT,
            arrived: BIT,
            place: r.place.counting(),
            waited: BIT,
            step: r.step.counting(),
            channel: r.channel.counting(),
            word: self.wide(),
            total_i: total,
            total_q: total,
            part,
            power: r.power.with_point(2 * part.frac),
            sense: amplitude(r.sense),
            x: amplitude(r.x),
            y: amplitude(r.y),
            corners: amplitude(r.corners),
            least: amplitude(r.least),
            long: self.wide(),
            count: r.count.counting(),
            limit: r.limit.counting(),
            other: r.other.counting(),
            quadrature: BIT,
            aligning: BIT,
            whole: amplitude(r.whole),
        }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        // The last root, the total's, stays until the next slot's first.
        let inputs = root::Inputs { start: r.root_start, radicand: r.power };
        let root::Outputs { done, root } = self.root.call("root", &mut cell.parts.root, inputs);
        let root = root::Outputs { done, root: root.aligned(r.sense.format) };
        let outputs = self.results(&r, root.root);
        let busy = !r.step.is(0);
        if (i.valid | r.arrived | busy | r.done).idle() {
            return outputs;
        }
        let (word, held) = self.word(i.sum);
        let inputs = multiplier::Inputs { enable: busy, left: r.part.integer(), right: r.part.integer() };
        let product = self.multiplier.call("multiplier", &mut cell.parts.multiplier, inputs).product;
        let among = i.index.less_than(int(2 * (self.terminals + 1))).named("among");
        let data = self.words.data(&mut cell.parts.words);
        let second = !r.step.less_than(int(3));
        let second = if self.block == 0 { second } else { r.step.less_than(int(8)).select(second, r.quadrature) };
        let address = r.channel.concat(second);
        let address = address.bits(0, self.words.address().width);
        let write = Write { enable: r.arrived, address: r.place, data: r.word };
        self.words.access(&mut cell.parts.words, address, write);
        let idle = Registers { done: bit(false), root_start: bit(false), ..r };
        let next = when!(
            V,
            Registers,
            i.valid,
            self.take(idle, i, held),
            when!(V, Registers, busy, self.busy(idle, data, product, root), idle)
        );
        let arrived = i.valid & among;
        let place = i.index.bits(0, self.words.address().width);
        let (place, word) = (arrived.select(place, r.place), choose!(V, arrived, word, r.word));
        let (arrived, place, word) = if self.block == 0 {
            (arrived, place, word)
        } else {
            let (moved, keeps) = self.moved(&r);
            let here = r.channel.concat(r.quadrature).bits(0, self.words.address().width);
            (arrived | keeps, keeps.select(here, place), choose!(V, keeps, moved.fit(word.format, Exact, Never), word))
        };
        cell.store(self, Registers { arrived, place, word, ..next });
        outputs
    }
}
