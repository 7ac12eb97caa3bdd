// SPDX-License-Identifier: MIT OR Apache-2.0
//! The program from one of its jumps to a later one in one step, where no caller observes the clocks between.
//!
//! Control does not depend on data: at a jump the registers of control hold the same in each run, and one run is
//! recorded. If no operation is in progress there, a run's data are its words, the base, the quotient and the outputs;
//! the instructions between two jumps make new ones of them as in `at_once.rs`. Operands and products from before a
//! jump are not known after a leap; the program replaces them within a few clocks, which are carried out.

use super::at_once::{Followed, Placed};
use super::trace::Jump;
use super::{Held, In, Inputs, Position, Registers};
use hapticore_hdl::block::{Block, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::signal::{Clocked, Signal, bit, zero};

/// A program, and the registers at its jumps.
#[derive(Debug, Clone)]
pub(super) struct Leaps {
    program: Followed,
    jumps: Vec<(Jump, Registers<i64>)>,
}

impl Leaps {
    /// Those of a block, of which a run is recorded.
    pub fn new(position: &Position) -> Self {
        let program = Followed::new(position);
        let (mut state, quiet) = (position.reset(), Inputs::map(position.inputs(), zero));
        position.run_to_jump(&mut state, &Inputs { start: bit(true), ..quiet }, 1);
        let (mut clocks, mut jumps) = (0, Vec::new());
        for &jump in &program.trace.jumps {
            while clocks < jump.clocks + 1 {
                clocks += position.run_to_jump(&mut state, &quiet, jump.clocks + 1 - clocks);
            }
            jumps.push((jump, state.registers));
        }
        Leaps { program, jumps }
    }
}

impl Position {
    /// The recorded registers of control, with the data of another run.
    fn with_data(control: Registers<i64>, data: &Registers<i64>) -> Registers<i64> {
        let &Registers { left, factor, word, base, quotient, .. } = data;
        let &Registers { x, y, sheet, invalid, lost, saturated, .. } = data;
        let held = Held { read_word: data.held.read_word, ..control.held };
        let pipeline = Registers { left, factor, word, held, base, quotient, ..control };
        Registers { x, y, sheet, invalid, lost, saturated, ..pipeline }
    }

    /// Leaps from a jump to the last later one after which all operands are replaced within `most` clocks from now: how
    /// many clocks that is; none where there is no such jump.
    pub(super) fn leap(
        &self,
        state: &mut State<Self, Clocked>,
        i: &In<Clocked>,
        most: u64,
    ) -> Option<u64> {
        let Leaps { program, jumps } = self.leaps.get_or_init(|| Leaps::new(self));
        let r = state.registers;
        let is_at = |(_, control): &(Jump, _)| Self::with_data(*control, &r) == r;
        let from = jumps.iter().position(is_at)?;
        let ((from, _), later) = jumps[from..].split_first()?;
        let (to, control) = later.iter().rfind(|(to, _)| to.replaced - from.clocks <= most)?;
        let within = &mut state.submodules;
        let table = match (&within.table, &within.banks) {
            (Some(words), _) => [words.words(), &[]],
            (_, Some(banks)) => banks.submodules.words(),
            _ => unreachable!("a table or its banks"),
        };
        let ratios = [i.r_x, i.r_y, i.share].map(|ratio| ratio.value);
        let words = Followed::words(table, within.scratch.words());
        let mut run = program.run(table, words, ratios);
        (run.base, run.quotient) = (r.base, r.quotient);
        run.placed = Placed {
            outputs: [r.x, r.y, r.sheet],
            invalid: r.invalid != 0,
            lost: r.lost != 0,
            saturated: r.saturated != 0,
        };
        run.execute(
            &program.trace.statements[from.statements..to.statements],
            &program.trace.terms[from.terms..to.terms],
        );
        within.scratch.words_mut().copy_from_slice(run.scratch());
        // The instruction that control has asked for.
        let fetched = Signal { value: control.fetched, format: self.program.address() };
        self.program.read(&mut within.program, fetched);
        let ([x, y, sheet], quotient) = (run.placed.outputs, run.quotient);
        let base = to.scalars.map_or(run.base, i64::from);
        let [invalid, lost, saturated] =
            [run.placed.invalid, run.placed.lost, run.placed.saturated].map(i64::from);
        let data = Registers { x, y, sheet, invalid, lost, saturated, base, quotient, ..r };
        state.registers = Self::with_data(*control, &data);
        Some(to.clocks - from.clocks)
    }
}
