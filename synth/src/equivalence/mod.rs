// SPDX-License-Identifier: MIT OR Apache-2.0
//! Designs clocked side by side on unknown codes: a sound one, and mutants of it.
//!
//! A wire carries a term (`Terms`). Inputs are constants, where a schedule says so, or unknowns that are the same for all
//! designs. An output at which a mutant has the sound design's term is equal for all codes.
//!
//! | begins as | what |
//! | --- | --- |
//! | zero, or the code that the mutant starts with | registers of blocks that reset |
//! | an unknown of each design's own | other registers, and the word that a memory has read |
//! | an unknown, the same for all designs | words of memories that are written |
//! | their codes | words of memories that are not |
//!
//! A word that is read while it is written, if the memory declares "don't care", is an unknown of each design's own.
//! Control that does not depend on unknowns stays known: so a schedule is followed without a search.

pub mod block;
mod clock;
mod design;
mod memory;
mod terms;
#[cfg(test)]
mod tests;

use clock::{Done, Run};
use design::Design;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::netlist::mutants::Start;
use hapticore_hdl::interpretations::netlist::{Netlist, Node};
use std::collections::HashMap;
use terms::Terms;

/// The sound design, and mutants of it by their names.
#[derive(Debug, Default)]
pub struct SideBySide {
    terms: Terms,
    designs: Vec<Design>,
    names: Vec<String>,
}

impl SideBySide {
    /// A sound design at reset, and the mutants of it by these names: registers that start with other codes, and netlist.
    pub fn new(
        sound: &Netlist,
        mutants: impl IntoIterator<Item = (String, Netlist, Vec<Start>)>,
    ) -> Self {
        let mut all = SideBySide::default();
        all.add("", sound.clone(), &[]);
        for (name, netlist, starts) in mutants {
            all.add(&name, netlist, &starts);
        }
        all
    }

    fn add(&mut self, name: &str, netlist: Netlist, starts: &[Start]) {
        let sound = self.designs.first();
        let design = Design::new(&mut self.terms, netlist, starts, sound);
        self.designs.push(design);
        self.names.push(name.into());
    }

    /// The names of the mutants that are left.
    pub fn names(&self) -> &[String] {
        &self.names[1..]
    }

    /// An input that is this code.
    pub fn known(&mut self, code: i64, format: Format) -> Node {
        self.terms.constant(code, format)
    }

    /// An input of which nothing is known.
    pub fn unknown(&mut self, format: Format) -> Node {
        self.terms.unknown(format)
    }

    /// The code of a signal, where it is known.
    pub fn code(&self, node: Node) -> Option<i64> {
        self.terms.code(node)
    }

    /// A clock: the sound design's outputs. Mutants are dropped whose outputs differ where `compared` says so, given the
    /// index of the output and the sound design's outputs.
    pub fn clock(
        &mut self,
        inputs: &[Node],
        compared: impl Fn(usize, &[Option<i64>]) -> bool,
    ) -> Vec<Option<i64>> {
        let (sound, mutants) = self.designs.split_first_mut().expect("a sound design");
        let mut run = Run::new(&mut self.terms, &sound.netlist, None);
        let mut outputs = vec![run.clock(&mut sound.top, &mut sound.held, inputs)];
        let did = std::mem::take(&mut run.did);
        for Design { netlist, top, held } in mutants {
            let done = Done { held: &sound.held, did: &did };
            let mut run = Run::new(&mut self.terms, netlist, Some(done));
            outputs.push(run.clock(top, held, inputs));
        }
        let sound: Vec<_> = outputs[0].iter().map(|&node| self.terms.code(node)).collect();
        let equal = |own: &[Node]| {
            (0..own.len()).all(|port| own[port] == outputs[0][port] || !compared(port, &sound))
        };
        let mut equal = outputs.iter().map(|own| equal(own)).collect::<Vec<_>>().into_iter();
        let mut names = equal.clone();
        self.designs.retain(|_| equal.next().expect("one for each"));
        self.names.retain(|_| names.next().expect("one for each"));
        sound
    }

    /// Forgets how what the designs hold has come about, which takes memory, but not what is the same.
    pub fn forget(&mut self, inputs: &mut [Node]) {
        self.designs.iter_mut().for_each(|design| design.top.wake());
        let held = self.designs.iter_mut().flat_map(|design| design.held.each_mut());
        self.terms.forget(held.chain(inputs));
    }

    /// What is known of all that the designs hold: codes, and which unknowns are the same. Two clocks with the same
    /// knowledge are followed by the same.
    pub fn knowledge(&mut self, inputs: &mut [Node]) -> Vec<i64> {
        let mut numbers = HashMap::new();
        let mut number = |node: Node, code: Option<i64>| {
            let next = numbers.len() as i64;
            // Codes and numbers of unknowns apart.
            code.map_or_else(|| 2 * *numbers.entry(node).or_insert(next) + 1, |code| 2 * code)
        };
        let held = self.designs.iter_mut().flat_map(|design| design.held.each_mut());
        held.chain(inputs).map(|node| number(*node, self.terms.code(*node))).collect()
    }
}
