// SPDX-License-Identifier: MIT OR Apache-2.0
//! The proof that no signal of a core overflows where its format says that it cannot.
//!
//! The range interpretation runs the core through whole rounds of all pads, as many as there are
//! windows in a mean, with every ADC code, every calibration and every table word anywhere in its
//! format. Control is data-independent, so it is known exactly; data are intervals. Once the state
//! after a round lies within the state before it, no further round can leave what has been seen,
//! and the proof holds for all time. A word that still grows, as a filter's does, is widened to its
//! whole format on that side (Cousot and Cousot, 1977), and the next round is run from there. What
//! relates several signals is beyond intervals: those places name an assumption, which solvers
//! prove from the same netlist (`hapticore_hdl::smt`).

use std::slice;

use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Block, Edit, State, Submodule, Visitor};
use hapticore_hdl::bundle::{Bundle, Field};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::interpretations::range::{
    Range, Violation, take_assumptions, take_violations, whole,
};
use hapticore_hdl::memory::Memory;
use hapticore_hdl::signal::{Signal, bit, zero};
use hapticore_model::blocks::core::{Core, Inputs};

/// What was proved, or what stands in the way.
#[derive(Debug, Clone, PartialEq)]
pub struct Proof {
    /// Narrowings whose range does not fit; none where the proof holds.
    pub violations: Vec<Violation>,
    /// Whether the state after the last round lies within the state before it.
    pub closed: bool,
    /// Assumptions relied on.
    pub assumptions: Vec<&'static str>,
    /// Rounds run, from reset.
    pub rounds: u64,
    /// Number of clocks that the proof ran.
    pub clocks: u64,
    /// Registers, with the range that each has between rounds.
    pub registers: Vec<(String, Format, Range)>,
}

impl Proof {
    /// Whether nothing can overflow.
    pub fn holds(&self) -> bool {
        self.closed && self.violations.is_empty()
    }
}

/// Rounds after which words that still grow are widened: what starts at reset has filled by then.
const FILLED: u64 = 2;
/// Bits by which a range is widened at a time.
const STRIDE: u32 = 12;

/// The prover stops after this number of rounds if the proof has not closed.
const MOST_ROUNDS: u64 = 8;

/// Tries to prove a profile's core.
pub fn prove(profile: &Profile) -> Proof {
    let core = Core::new(profile);
    let mut state = core.reset();
    let mut run = Run { profile, inputs: any_inputs(&core), core: &core, clocks: 0 };
    take_violations();
    take_assumptions();
    run.any_tables(&mut state);
    let windows = profile.haptic.windows;
    let (closed, rounds) = close(&core, &mut state, |state| {
        (0..windows).for_each(|_| run.round(state));
    });
    Proof {
        violations: take_violations(),
        assumptions: take_assumptions(),
        closed,
        rounds,
        clocks: run.clocks,
        registers: Snapshot::of(&core, &state).registers,
    }
}

/// Runs rounds until the state after one lies within the state before it: whether that was reached,
/// and how many rounds it took.
pub fn close<B: Block>(
    block: &B,
    state: &mut State<B, Range>,
    mut round: impl FnMut(&mut State<B, Range>),
) -> (bool, u64) {
    let mut before = Snapshot::of(block, state);
    for rounds in 1..=MOST_ROUNDS {
        round(state);
        if rounds > FILLED {
            before.widen(block, state);
        }
        let after = Snapshot::of(block, state);
        if rounds > 1 && before.holds(&after) {
            return (true, rounds);
        }
        before = after;
    }
    (false, MOST_ROUNDS)
}

struct Run<'a> {
    profile: &'a Profile,
    core: &'a Core,
    inputs: Inputs<Signal<Range>>,
    clocks: u64,
}

/// Every code and calibration that the formats allow, and no writing.
fn any_inputs(core: &Core) -> Inputs<Signal<Range>> {
    let any = Inputs::map(core.inputs(), |format| Signal { value: whole(format), format });
    let mut quiet = Inputs { strobe: bit(false), clear: bit(false), ..any };
    let table = &mut quiet.calibration.table;
    (table.write, table.address) = (bit(false), zero(table.address.format));
    quiet
}

impl Run<'_> {
    /// Every word that the format allows, at every address.
    fn any_tables(&self, state: &mut State<Core, Range>) {
        let maybe = Signal { value: Range { low: 0, high: 1 }, format: BIT };
        let words = self.core.estimator().table().words as i128;
        let mut inputs = self.inputs;
        let table = &mut inputs.calibration.table;
        (table.write, table.address.value) = (maybe, Range { low: 0, high: words - 1 });
        self.run(state, inputs);
        self.run(state, self.inputs);
    }

    /// A slot of every pad, and clocks enough for the last frame to be finished.
    fn round(&mut self, state: &mut State<Core, Range>) {
        for _ in 0..self.profile.pads * self.profile.slot.samples() {
            self.clock(state, true);
            (1..self.profile.clocks_per_sample).for_each(|_| self.clock(state, false));
        }
        (0..self.core.latency()).for_each(|_| self.clock(state, false));
    }

    fn clock(&mut self, state: &mut State<Core, Range>, strobe: bool) {
        self.run(state, Inputs { strobe: bit(strobe), ..self.inputs });
        self.clocks += 1;
    }

    /// The core in intervals is some megabytes of instructions: once is enough.
    #[inline(never)]
    fn run(&self, state: &mut State<Core, Range>, inputs: Inputs<Signal<Range>>) {
        self.core.clock(state, inputs);
    }
}

/// Everything that a block keeps from clock to clock.
#[derive(Default)]
struct Snapshot {
    scope: Vec<&'static str>,
    registers: Vec<(String, Format, Range)>,
    words: Vec<Range>,
}

impl Snapshot {
    fn of<B: Block>(block: &B, state: &State<B, Range>) -> Snapshot {
        let mut snapshot = Snapshot::default();
        block.visit(B::NAME, state, &mut snapshot);
        snapshot
    }

    /// Widens what `state` holds beyond this.
    fn widen<B: Block>(&self, block: &B, state: &mut State<B, Range>) {
        let (registers, words) = (self.registers.iter(), self.words.iter());
        block.edit(state, &mut Widen { registers, words });
    }

    fn holds(&self, other: &Snapshot) -> bool {
        let registers = self.registers.iter().zip(&other.registers).all(|(a, b)| a.2.holds(b.2));
        registers && self.words.iter().zip(&other.words).all(|(a, b)| a.holds(*b))
    }
}

impl Visitor<Range> for Snapshot {
    fn enter(&mut self, name: &'static str) {
        self.scope.push(name);
    }

    fn register(&mut self, field: &'static Field, format: Format, value: Range) {
        self.registers.push((format!("{}.{}", self.scope.join("."), field.name), format, value));
    }

    fn memory(&mut self, _memory: &Memory, words: &(Vec<Range>, Range)) {
        self.words.extend(&words.0);
        self.words.push(words.1);
    }

    fn leave(&mut self) {
        self.scope.pop();
    }
}

/// The state before a round, against which the state after it is widened.
struct Widen<'a> {
    registers: slice::Iter<'a, (String, Format, Range)>,
    words: slice::Iter<'a, Range>,
}

impl Edit<Range> for Widen<'_> {
    fn word(&mut self, format: Format, value: Range) -> Range {
        widened(format, self.registers.next().map(|(.., range)| range), value)
    }

    fn memory(&mut self, memory: &Memory, (words, read): &mut (Vec<Range>, Range)) {
        for word in words.iter_mut().chain([read]) {
            *word = widened(memory.format, self.words.next(), *word);
        }
    }
}

/// Both ranges joined, and on a side where `after` exceeds `before` up to the next multiple of [`STRIDE`] bits, so that a
/// word that grows slowly and then saturates does not fill a register that holds wider words, too.
fn widened(format: Format, before: Option<&Range>, after: Range) -> Range {
    let before = *before.expect("a state has the words that it had");
    let most = |code: i128| (1 << (bits(code).div_ceil(STRIDE) * STRIDE).min(126)) - 1;
    let low = match after.low < before.low {
        true => format.min_code().max(-most(after.low) - 1),
        false => before.low,
    };
    let high = match after.high > before.high {
        true => format.max_code().min(most(after.high)),
        false => before.high,
    };
    Range { low, high }
}

/// Bits of a code's magnitude.
fn bits(code: i128) -> u32 {
    i128::BITS - code.unsigned_abs().leading_zeros()
}
