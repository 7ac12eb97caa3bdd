// SPDX-License-Identifier: MIT OR Apache-2.0
//! Force estimator with a table: eq. 8 with a gain that follows the capacitance and the voltage that
//! the pad has had.
//!
//! ```text
//! V = √m;   V_s += α·(V − V_s),   V_m += β·(V − V_m)          of each pad; both 0 where V < release
//! factor = a(C) + b(C)·V_s + d(C)·(V_s − V_m)                 a, b, d linear between the rows of the table
//! k = gain · factor,   F = k · C² · m                         (paper, eq. 8, with another k)
//! ```
//!
//! ```text
//! m ─[sqrt]─ V ─(−)─(× α, β)─(+)─ V_s, V_m ─ past (of each pad)
//! C ─(− 320 pF)─[clamp]─┬─ row ─ words ─(× 1, V_s, V_s − V_m)─[Σ]─[round half even]─ below, above
//!                       └─ share ─(× (above − below))─(+ below)─[round half even]─ factor ─(× gain)─ k
//! C ─(²)─ square ─(× m)─ square ─(× k)─[round half even, saturate]─ force
//! ```
//!
//! | signal              | format                    | unit            | overflow                           |
//! | V, V_s, V_m         | profile: force.voltage    | full scale      | saturate, flagged                  |
//! | words               | profile: table, as shares | –               | –                                  |
//! | sum, below, above   | exact; a word, 6 bits     | –               | cannot (range proof)               |
//! | factor              | as below                  | –               | saturates, flagged                 |
//! | k                   | profile: force_gain       | N/pF²           | saturates, also at 0, flagged      |
//! | square, force       | profile                   | pF²; N          | saturate, flagged                  |
//!
//! One multiplier serves all thirteen products, on codes as integers, and one square root. Row and
//! share are bits of the capacitance. A prompt estimate is made of V_s and V_m as the frame's will be,
//! which does not count them twice. Latency: the square root, then for each [`Operation`] three
//! clocks and a product. Source: docs/physics.md §3.

use super::marks;
use super::multiplier::{self, Multiplier};
use super::position::TablePort;
use super::rests::Rests;
use super::sqrt::{self, SquareRoot};
use crate::buildable::{fits, rounds};
use hapticore_contract::calibration::ForceTable as Table;
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{HalfEven, Proved, Saturate, Signal, bit, code, int, zero};
use hapticore_hdl::states::States;
use hapticore_hdl::{block, call, next, states};

states! {
    /// What an estimate waits for. `SquareRoot` waits for its block, `Multiply` for the multiplier.
    pub enum Step {
        Idle, SquareRoot, Fetch, Load, Multiply, Accept,
    }
}

states! {
    /// What an estimate computes, one product after the other.
    pub enum Operation {
        Release, Recent, Mean, A, B, D, NextA, NextB, NextD, Blend, Gain, Square, Energy, Scale,
    }
}

block! {
    /// The force estimator with a table.
    pub struct ForceTable("force_table") {
        /// Whether a slot has a prompt estimate, too.
        prompts: bool,
        capacitance: Format,
        mean_square: Format,
        square: Format,
        gain: Format,
        force: Format,
        voltage: Format,
        /// Of a word of the table, as a fraction.
        word: Format,
        pad: Format,
        pads: u64,
        /// Of the multiplier's operands.
        left: Format,
        right: Format,
    }
    submodules {
        words: Memory,
        past: Memory,
        multiplier: Multiplier,
        sqrt: SquareRoot,
    }
    inputs(force) {
        /// Begins; all others but the table are valid and stable until `done`.
        start: BIT,
        /// Voltages of earlier windows no longer count.
        clear: BIT.where_present(force.prompts),
        /// An estimate that comes before the frame's: what the pad has had stays as it was.
        hold: BIT.where_present(force.prompts),
        pad: force.pad,
        /// The capacitance, in pF.
        capacitance: force.capacitance,
        /// The mean square of the haptic voltage, in full scales squared.
        mean_square: force.mean_square,
        /// Gain of the force, N/pF² at a full-scale haptic mean square.
        gain: force.gain,
        table as TablePort: TablePort { write: BIT, address: force.words.address(), word: force.word },
    }
    outputs(force) {
        /// Asserted for one cycle when the force is valid.
        done: BIT,
        /// The haptic force, in N.
        haptic_force: force.force,
        /// The gain times the table's factor.
        factored_gain: force.gain,
        /// A word is saturated.
        saturated: BIT,
    }
    registers(force) {
        step in Step,
        operation in Operation,
        multiplier_busy: BIT,
        voltage: force.voltage,
        released: BIT,
        recent: force.voltage,
        mean: force.voltage,
        offset: force.offset(),
        /// Operands of the multiplier: codes as integers.
        left: force.left,
        right: force.right,
        sum: force.sum(),
        below: force.factor(),
        above: force.factor(),
        factored_gain: force.gain,
        square: force.square,
        haptic_force: force.force,
        saturated: BIT,
        done: BIT,
        /// Pads with filtered voltages.
        filtered: marks::format(force.pads).where_present(force.prompts),
    }
}

/// Fractional bits of the capacitance's row: picofarads between two rows.
const STEP_BITS: u8 = 6;
const _: () = assert!((1 << STEP_BITS) as f64 == Table::STEP_PF);

/// Bits of the number of a row.
const ROW_BITS: u8 = 4;

/// Powers of two by which words are shares of their numbers.
const ROW_SHARE: i8 = 4;
const RECENT_SHARE: i8 = 1;
const MEAN_SHARE: i8 = -4;
const _: () = assert!(16.0 * Table::ROW_SHARE == 1.0 && 2.0 * Table::RECENT_SHARE == 1.0);
const _: () = assert!(16.0 * Table::MOST_MEAN == 1.0);

impl ForceTable {
    /// The force estimator of a profile.
    ///
    /// # Errors
    /// A format to which no word of the model can be rounded.
    pub fn try_new(profile: &Profile) -> Result<Self, ProfileError> {
        let (f, voltage) = (&profile.formats, profile.force.voltage);
        let (capacitance, mean_square, word) = (f.capacitance, f.mean_square, f.table);
        let pad = Format::counter(profile.pads - 1);
        let frac = voltage.frac.max((mean_square.frac + 1) / 2);
        let digits = 2 * ((mean_square.integer_bits() + 1) / 2 + i16::from(frac));
        fits("formats.mean_square", "the radicand of its root", digits.clamp(0, 255) as u8)?;
        let factor = factor(word);
        let signed =
            |widths: &[u8]| Format::signed(1 + widths.iter().copied().max().expect("widths"), 0);
        let left = signed(&[voltage.width + 1, factor.width, capacitance.width, f.square.width]);
        let share = STEP_BITS + capacitance.frac as u8;
        let right =
            signed(&[word.width, share, f.force_gain.width, capacitance.width, mean_square.width]);
        fits("formats.table", "products of the force table", left.product(right).width)?;
        let block = ForceTable {
            prompts: profile.control.is_some(),
            words: Memory::new("words", Table::WORDS.next_power_of_two(), word)
                .dont_care_on_collision(),
            past: Memory::new("past", 2 << pad.width, voltage).dont_care_on_collision(),
            multiplier: Multiplier::new(left, right, profile.multiplier),
            sqrt: SquareRoot::new(mean_square, frac),
            capacitance,
            mean_square,
            square: f.square,
            gain: f.force_gain,
            force: f.force,
            voltage,
            word,
            pad,
            pads: profile.pads,
            left,
            right,
        };
        for (field, name, product, to) in block.roundings() {
            rounds(field, name, product, to)?;
        }
        Ok(block)
    }

    /// The field that makes a signal as wide as it is, the signal, and what it is rounded to.
    fn roundings(&self) -> [(&'static str, &'static str, Format, Format); 7] {
        let [square, energy, force] = self.powers();
        let gain = self.factor().product(self.gain);
        let share = self.difference().product(self.word.scaled(MEAN_SHARE));
        [
            ("formats.square", "the square of the capacitance", square, self.square),
            ("formats.square", "the product of square and mean square", energy, self.square),
            ("formats.force", "the product of energy and gain", force, self.force),
            ("formats.force_gain", "the product of factor and gain", gain, self.gain),
            ("formats.table", "a row's sum", self.sum(), self.factor()),
            ("formats.table", "the blend of two rows", self.blended(), self.factor()),
            ("formats.table", "the share of a voltage", share, self.voltage),
        ]
    }

    /// The products square, energy and force.
    #[inline(always)]
    fn powers(&self) -> [Format; 3] {
        [
            self.capacitance.product(self.capacitance),
            self.square.product(self.mean_square),
            self.square.product(self.gain),
        ]
    }

    /// The format of the factor, and of both rows' before it.
    #[inline(always)]
    fn factor(&self) -> Format {
        factor(self.word)
    }

    /// The format of a voltage less another.
    #[inline(always)]
    fn difference(&self) -> Format {
        self.voltage.difference(self.voltage)
    }

    /// The format of what a row's words are multiplied by: 1, a voltage, or a difference of two.
    #[inline(always)]
    fn operand(&self) -> Format {
        Format::signed(self.voltage.width + 2, self.voltage.frac)
    }

    /// The format of a row's sum.
    #[inline(always)]
    fn sum(&self) -> Format {
        let product = self.operand().product(self.word.scaled(ROW_SHARE));
        Format { width: product.width + 2, ..product }
    }

    /// The format of the capacitance from the first row on.
    #[inline(always)]
    fn offset(&self) -> Format {
        Format::unsigned(ROW_BITS + STEP_BITS + self.capacitance.frac as u8, self.capacitance.frac)
    }

    /// The format of the share of the row above.
    #[inline(always)]
    fn share(&self) -> Format {
        let width = STEP_BITS + self.capacitance.frac as u8;
        Format::unsigned(width, width as i8)
    }

    /// The format of the difference of both rows' factors times the share.
    #[inline(always)]
    fn blended(&self) -> Format {
        self.factor().difference(self.factor()).product(self.share())
    }

    /// Sets a word of the table, without a clock.
    pub(crate) fn set_word<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        address: usize,
        word: Signal<V>,
    ) {
        let address = int(address as u64).resize(self.words.address(), Proved);
        let write = Write { enable: bit(true), address, data: word };
        self.words.access(&mut state.submodules.words, address, write);
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        let operation = 3 + self.multiplier.latency();
        self.sqrt.latency() + Operation::ALL.len() as u64 * operation + 1
    }

    /// The capacitance from the first row on, in the table.
    #[inline(always)]
    fn clamp<V: Interpretation>(&self, capacitance: Signal<V>) -> Signal<V> {
        let last = (((Table::ROWS - 1) as i64) << (STEP_BITS + self.capacitance.frac as u8)) - 1;
        let offset = capacitance - int(Table::FIRST_PF as u64);
        offset.resize(self.offset(), Saturate).at_most(code(last, self.offset()))
    }

    /// The row below the capacitance and the share of the one above.
    #[inline(always)]
    fn place<V: Interpretation>(&self, offset: Signal<V>) -> (Signal<V>, Signal<V>) {
        let row = offset.bits(self.share().width, ROW_BITS);
        let share = offset.bits(0, self.share().width).scaled(-self.share().frac);
        let share = share.golden(&[offset, row], |of| of[0] / Table::STEP_PF - of[1]);
        (row, share)
    }

    /// The address of the word that an operation needs.
    #[inline(always)]
    fn address<V: Interpretation>(&self, operation: Signal<V>, row: Signal<V>) -> Signal<V> {
        use Operation::*;
        let at = |of: Operation| operation.at(of);
        let others = [(Release, 2), (Recent, 0)]
            .into_iter()
            .fold(int(1), |rest, (of, number)| at(of).select(int(number), rest))
            + int(3 * Table::ROWS as u64);
        let within = [A, B, D, NextA, NextB].into_iter().enumerate();
        let within =
            within.fold(int(5), |rest, (number, of)| at(of).select(int(number as u64), rest));
        let of_row = row + row.scaled(1) + within;
        let first = operation.less_than(int(A.code()));
        let to = self.words.address();
        first.select(others, of_row).resize(to, Proved)
    }

    /// The multiplier's operands of an operation, as integers.
    #[inline(always)]
    fn operands<V: Interpretation>(
        &self,
        r: &Regs<V>,
        i: &In<V>,
        [word, past]: [Signal<V>; 2],
    ) -> [Signal<V>; 2] {
        use Operation::*;
        let at = |of: Operation| r.operation.at(of);
        let either = |a: Operation, b: Operation| at(a) | at(b);
        let (_, share) = self.place(r.offset);
        let one = code(
            1 << self.voltage.frac,
            Format::unsigned(self.voltage.width + 1, self.voltage.frac),
        );
        let filtered = either(Recent, Mean).select((r.voltage - past).integer(), one.integer());
        let left = at(Scale).select(r.square.integer(), filtered);
        let left = at(Energy).select(r.square.integer(), left);
        let left = at(Square).select(i.capacitance.integer(), left);
        let left = at(Gain).select(r.above.integer(), left);
        let left = at(Blend).select((r.above - r.below).integer(), left);
        let left = either(B, NextB).select(r.recent.integer(), left);
        let left = either(D, NextD).select((r.recent - r.mean).integer(), left);
        let right = at(Scale).select(r.factored_gain.integer(), word.integer());
        let right = at(Energy).select(i.mean_square.integer(), right);
        let right = at(Square).select(i.capacitance.integer(), right);
        let right = at(Gain).select(i.gain.integer(), right);
        let right = at(Blend).select(share.integer(), right);
        [left.resize(self.left, Proved), right.resize(self.right, Proved)]
    }

    /// A filter's next value: `past` and a share of the difference, nothing where released.
    #[inline(always)]
    fn filter<V: Interpretation>(
        &self,
        r: &Regs<V>,
        past: Signal<V>,
        product: Signal<V>,
    ) -> (Signal<V>, Signal<V>) {
        let difference = self.difference();
        let step = |share: i8| {
            product.as_code(difference.product(self.word.scaled(share))).quantize(
                Format { width: self.voltage.width + 4, ..difference },
                HalfEven,
                Proved,
            )
        };
        let step = r.operation.at(Operation::Recent).select(step(RECENT_SHARE), step(MEAN_SHARE));
        let (next, held) = (past + step).saturate(self.voltage, HalfEven);
        (r.released.select(zero(self.voltage), next), !r.released & held)
    }

    /// What an operation leaves, its product being there; and whether a word is saturated.
    #[inline(always)]
    fn accept<V: Interpretation>(
        &self,
        r: Regs<V>,
        product: Signal<V>,
        [word, past]: [Signal<V>; 2],
    ) -> Regs<V> {
        use Operation::*;
        let at = |of: Operation| r.operation.at(of);
        let (filtered, filter_held) = self.filter(&r, past, product);
        let filters = at(Recent) | at(Mean);
        let term = product.as_code(self.operand().product(self.word.scaled(ROW_SHARE)));
        let continues = at(B) | at(D) | at(NextB) | at(NextD);
        let sum = continues.select(r.sum, zero(r.sum.format)) + term;
        let sum = sum.resize(r.sum.format, Proved);
        let row = sum.quantize(self.factor(), HalfEven, Saturate);
        let blend = product.as_code(self.blended());
        let (factor, factor_held) = (r.below + blend).saturate(self.factor(), HalfEven);
        let (gain, gain_held) =
            product.as_code(self.factor().product(self.gain)).saturate(self.gain, HalfEven);
        let [square, energy, force] = self.powers();
        let (square, square_held) = product.as_code(square).saturate(self.square, HalfEven);
        let (energy, energy_held) = product.as_code(energy).saturate(self.square, HalfEven);
        let (force, force_held) = product.as_code(force).saturate(self.force, HalfEven);
        let held = (filters & filter_held)
            | (at(Blend) & factor_held)
            | (at(Gain) & gain_held)
            | (at(Square) & square_held)
            | (at(Energy) & energy_held)
            | (at(Scale) & force_held);
        let last = at(Scale);
        Registers {
            step: last
                .select(Step::Idle.signal(), Step::Fetch.signal())
                .resize(r.step.format, Proved),
            operation: r.operation.increment(),
            released: at(Release).select(r.voltage.less_than(word), r.released),
            recent: at(Recent).select(filtered, r.recent),
            mean: at(Mean).select(filtered, r.mean),
            sum,
            below: at(D).select(row, r.below),
            above: at(Blend).select(factor, at(NextD).select(row, r.above)),
            factored_gain: at(Gain).select(gain, r.factored_gain),
            square: at(Square).select(square, at(Energy).select(energy, r.square)),
            haptic_force: last.select(force, r.haptic_force),
            saturated: r.saturated | held,
            done: last,
            ..r
        }
    }
}

impl ForceTable {
    /// A filtered voltage of the pad; nothing where it has none.
    #[inline(always)]
    fn past_of<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>, past: Signal<V>) -> Signal<V> {
        if !self.prompts {
            return past;
        }
        marks::is_marked(r.filtered, i.pad).select(past, zero(past.format))
    }

    /// Pads with filtered voltages after this clock: with its second one a pad has both.
    #[inline(always)]
    fn filtered<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>, both: Signal<V>) -> Signal<V> {
        if !self.prompts {
            return r.filtered;
        }
        marks::unless(i.clear, marks::written(r.filtered, (both, i.pad), bit(true)))
    }
}

/// The format of a factor: what three words of a row make, and as fine as a word.
#[inline(always)]
const fn factor(word: Format) -> Format {
    Format::signed(word.width + 6, word.frac)
}

impl Rests for ForceTable {
    #[inline(always)]
    fn under_way<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        !r.step.at(Step::Idle) | r.done
    }
}

impl Block for ForceTable {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let Registers { done, haptic_force, factored_gain, saturated, .. } = r;
        let outputs = Outputs { done, haptic_force, factored_gain, saturated };
        let clear = if self.prompts { i.clear } else { bit(false) };
        if (i.start | clear | i.table.write | self.under_way(&r)).can_skip() {
            return outputs;
        }
        let multiplies = r.step.at(Step::Multiply);
        let inputs = multiplier::Inputs { enable: multiplies, left: r.left, right: r.right };
        let product = call!(self.multiplier, state, inputs).product;
        let inputs = sqrt::Inputs { start: i.start, radicand: i.mean_square };
        let sqrt = call!(self.sqrt, state, inputs);
        let read = [
            self.words.data(&mut state.submodules.words),
            self.past_of(&r, &i, self.past.data(&mut state.submodules.past)),
        ];
        let (row, _) = self.place(r.offset);
        let TablePort { write, address, word } = i.table;
        let write = Write { enable: write, address, data: word };
        self.words.access(&mut state.submodules.words, self.address(r.operation, row), write);
        let of_mean = r.operation.at(Operation::Mean);
        let place = i.pad.concat(of_mean);
        let (filtered, _) = self.filter(&r, read[1], product);
        let filters = r.operation.at(Operation::Recent) | of_mean;
        let accepts = r.step.at(Step::Accept);
        let keeps = if self.prompts { accepts & !i.hold } else { accepts };
        let write = Write { enable: keeps & filters, address: place, data: filtered };
        self.past.access(&mut state.submodules.past, place, write);
        let filtered = self.filtered(&r, &i, keeps & of_mean);
        let idle = Registers { multiplier_busy: bit(false), done: bit(false), filtered, ..r };
        let at = |step: Step| step.signal::<V>().resize(r.step.format, Proved);
        let begin = Registers {
            step: at(Step::SquareRoot),
            operation: Operation::Release.signal(),
            offset: self.clamp(i.capacitance),
            saturated: bit(false),
            ..idle
        };
        let (voltage, held) = sqrt.sqrt.saturate(self.voltage, HalfEven);
        let rooted = Registers { step: at(Step::Fetch), voltage, saturated: held, ..idle };
        let fetched = Registers { step: at(Step::Load), ..idle };
        let [left, right] = self.operands(&r, &i, read);
        let loaded = Registers { step: at(Step::Multiply), left, right, ..idle };
        let ready = self.multiplier.ready(r.multiplier_busy);
        let multiplied = Registers { step: at(Step::Accept), ..idle };
        let waits = Registers { multiplier_busy: bit(true), ..idle };
        next!(self, state,
            i.start => begin,
            sqrt.done => rooted,
            r.step.at(Step::Fetch) => fetched,
            r.step.at(Step::Load) => loaded,
            multiplies & ready => multiplied,
            multiplies => waits,
            accepts => self.accept(idle, product, read),
            else idle
        );
        outputs
    }
}

#[cfg(test)]
mod tests;
