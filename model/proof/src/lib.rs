// SPDX-License-Identifier: MIT OR Apache-2.0
//! The proof that no signal of a core overflows where its format says that it cannot.
//!
//! The range interpretation runs the core through whole rounds of all pads, as many as there are
//! windows in a mean, with every ADC code, every calibration and every table word anywhere in its
//! format. Control is data-independent, so it is known exactly; data are intervals. Once the state
//! after a round lies within the state before it, no further round can leave what has been seen,
//! and the proof holds for all time. What relates several signals is beyond intervals: those places
//! name an assumption, and tests hold the assumptions.

use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{self, Block, Submodule, Visitor};
use hapticore_hdl::bundle::{Bundle, Field};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::interpretations::range::{
    Range, Violation, take_assumptions, take_violations, whole,
};
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

/// Rounds after which a proof that has not closed is given up.
const MOST_ROUNDS: u64 = 6;

/// Tries to prove a profile's core.
pub fn prove(profile: &Profile) -> Proof {
    let core = Core::new(profile);
    let mut run = Run { profile, inputs: any_inputs(&core), state: core.reset(), core, clocks: 0 };
    take_violations();
    take_assumptions();
    run.any_tables();
    let (mut before, mut closed, mut rounds) = (run.state(), false, 0);
    while !closed && rounds < MOST_ROUNDS {
        (0..profile.haptic.windows).for_each(|_| run.round());
        rounds += 1;
        let after = run.state();
        closed = rounds > 1 && before.holds(&after);
        before = after;
    }
    let registers = before.registers;
    Proof {
        violations: take_violations(),
        assumptions: take_assumptions(),
        closed,
        rounds,
        clocks: run.clocks,
        registers,
    }
}

struct Run<'a> {
    profile: &'a Profile,
    core: Core,
    state: block::State<Core, Range>,
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
    fn any_tables(&mut self) {
        let maybe = Signal { value: Range { low: 0, high: 1 }, format: BIT };
        let words = self.core.estimator().position().table().words as i128;
        let mut inputs = self.inputs;
        let table = &mut inputs.calibration.table;
        (table.write, table.address.value) = (maybe, Range { low: 0, high: words - 1 });
        self.run(inputs);
        self.run(self.inputs);
    }

    /// A slot of every pad, and clocks enough for the last frame to be finished.
    fn round(&mut self) {
        for _ in 0..self.profile.pads * self.profile.slot.samples() {
            self.clock(true);
            (1..self.profile.clocks_per_sample).for_each(|_| self.clock(false));
        }
        (0..self.core.latency()).for_each(|_| self.clock(false));
    }

    fn clock(&mut self, strobe: bool) {
        self.run(Inputs { strobe: bit(strobe), ..self.inputs });
        self.clocks += 1;
    }

    /// The core in intervals is some megabytes of instructions: once is enough.
    #[inline(never)]
    fn run(&mut self, inputs: Inputs<Signal<Range>>) {
        self.core.clock(&mut self.state, inputs);
    }

    fn state(&self) -> Snapshot {
        let mut state = Snapshot::default();
        self.core.visit("core", &self.state, &mut state);
        state
    }
}

/// Everything that a core keeps from clock to clock.
#[derive(Default)]
struct Snapshot {
    scope: Vec<&'static str>,
    registers: Vec<(String, Format, Range)>,
    words: Vec<Range>,
}

impl Snapshot {
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

    fn memory(&mut self, _memory: &hapticore_hdl::memory::Memory, words: &(Vec<Range>, Range)) {
        self.words.extend(&words.0);
        self.words.push(words.1);
    }

    fn leave(&mut self) {
        self.scope.pop();
    }
}
