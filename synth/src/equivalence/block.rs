// SPDX-License-Identifier: MIT OR Apache-2.0
//! Proves for a block alone, whatever its inputs, that a mutant changes no output.
//!
//! From reset on, both codes of inputs of one bit are followed, clock after clock, until no new state comes. A state is what
//! is known of all registers and memories of the block and its mutant: codes, and which unknowns are the same. Where the
//! number of states grows, nothing is proved.

use super::SideBySide;
use super::design::{Design, Register};
use super::terms::Terms;
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::interpretations::netlist::mutants::{Mutant, Start};
use hapticore_hdl::interpretations::netlist::{Named, Netlist, Node};
use std::collections::{HashMap, HashSet};

/// States that are followed at most.
const MOST_STATES: usize = 3_000;

/// Inputs of one bit of which both codes are followed; of others, nothing is known.
const MOST_BITS: usize = 5;

/// Codes that a register of states has at most, if each is followed.
const MOST_CODES: u64 = 64;

/// The number of an unknown whose code has been forgotten, before unknowns are numbered again.
const FIRST_FORGOTTEN: i64 = 1 << 32;

/// How states are kept few. Each covers reset and all inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Method {
    /// Numbers start with anything, the same in block and mutant, and what they hold is forgotten after each clock, but for
    /// which are the same: counters make no states.
    Equality,
    /// Numbers start with anything, the same in block and mutant.
    Numbers,
    /// The same; bits and states that become unknown are followed code by code.
    Cases,
    /// All registers start with zero.
    Zero,
}

/// Whether no output of a block, the top of `netlist`, differs in the mutant of this name. Where the answer is no, it may
/// still be so.
pub fn is_equivalent(netlist: &Netlist, name: &str) -> bool {
    let Some((mutant, starts)) = Mutant::netlist(netlist, name) else { return false };
    [Method::Equality, Method::Numbers, Method::Zero, Method::Cases].into_iter().any(|method| {
        let mutant = (name.to_string(), mutant.clone(), starts.clone());
        let mut sides = SideBySide::new(netlist, [mutant]);
        if method != Method::Zero {
            sides.free_numbers(&starts);
        }
        Search::new(sides, method).finds_none()
    })
}

/// What is known of all that is held.
type Known = Vec<i64>;

/// A search for an output that differs.
struct Search {
    sides: SideBySide,
    inputs: Vec<Format>,
    formats: Vec<Format>,
    /// The codes of each register that is followed code by code.
    codes: Vec<Option<i64>>,
    /// Whose code is forgotten.
    forgotten: Vec<bool>,
}

impl Search {
    fn new(mut sides: SideBySide, method: Method) -> Self {
        let terms = std::mem::take(&mut sides.terms);
        let held = sides.designs.iter_mut().flat_map(|design| design.held.each_mut());
        let formats: Vec<Format> = held.map(|node| terms.format(*node)).collect();
        sides.terms = terms;
        let (mut codes, mut forgotten) = (Vec::new(), Vec::new());
        for design in &sides.designs {
            let held = design.held.data.len() + design.held.words.iter().flatten().count();
            let of = |named: &Named| control_codes(named).filter(|_| method == Method::Cases);
            codes.extend(design.registers().map(|register| of(register.named)));
            codes.extend(std::iter::repeat_n(None, held));
            let forgets = |named: &Named| method == Method::Equality && !is_control(named);
            forgotten.extend(design.registers().map(|register| forgets(register.named)));
            forgotten.extend(std::iter::repeat_n(false, held));
        }
        let inputs = sides.designs[0].netlist.top().inputs.iter().map(|port| port.format);
        Search { inputs: inputs.collect(), sides, formats, codes, forgotten }
    }

    /// Follows all states; whether no output differs in any.
    fn finds_none(&mut self) -> bool {
        let (mut open, mut seen) = (vec![self.sides.knowledge(&mut [])], HashSet::new());
        let bits = self.inputs.iter().filter(|format| **format == BIT).count().min(MOST_BITS);
        while let Some(state) = open.pop() {
            for given in 0..1 << bits {
                self.sides.restore(&state, &self.formats);
                let inputs = self.given(given);
                self.sides.clock(&inputs, |_, _| true);
                if self.sides.names().is_empty() {
                    return false;
                }
                let known = self.sides.knowledge(&mut []);
                for next in self.cases(self.without_codes(known)) {
                    if seen.insert(next.clone()) {
                        open.push(next);
                    }
                }
            }
            if seen.len() > MOST_STATES {
                return false;
            }
        }
        true
    }

    /// Inputs of a clock, with these codes of bits.
    fn given(&mut self, codes: usize) -> Vec<Node> {
        let mut bit = 0;
        let mut given = Vec::new();
        for &format in &self.inputs {
            let known = format == BIT && bit < MOST_BITS;
            given.push(match known {
                true => self.sides.known(codes as i64 >> bit & 1, BIT),
                false => self.sides.unknown(format),
            });
            bit += usize::from(known);
        }
        given
    }

    /// A state in which numbers with the same code have the same unknown one.
    fn without_codes(&self, mut state: Known) -> Known {
        let mut unknowns = HashMap::new();
        let places = state.iter_mut().zip(&self.formats).zip(&self.forgotten);
        for ((of, format), _) in places.filter(|((of, _), forgotten)| **forgotten && **of & 1 == 0)
        {
            let next = FIRST_FORGOTTEN + unknowns.len() as i64;
            *of = 2 * *unknowns.entry((*of, *format)).or_insert(next) + 1;
        }
        state
    }

    /// The states of which this one stands, with each code of registers that are followed code by code.
    fn cases(&self, state: Known) -> Vec<Known> {
        let mut followed = state.iter().zip(&self.codes);
        let found = followed.find_map(|(of, codes)| codes.filter(|_| of & 1 == 1).zip(Some(*of)));
        let Some((codes, unknown)) = found else { return vec![renumbered(state)] };
        let with =
            |code: i64| state.iter().map(|&of| if of == unknown { 2 * code } else { of }).collect();
        (0..codes).flat_map(|code| self.cases(with(code))).collect()
    }
}

/// How many codes a register of control has, from zero on.
fn control_codes(named: &Named) -> Option<i64> {
    let all = 1u64.checked_shl(named.format.width.into()).unwrap_or(u64::MAX);
    (is_control(named) && all <= MOST_CODES).then_some(all as i64)
}

fn is_control(named: &Named) -> bool {
    named.format == BIT || !named.states.is_empty()
}

/// The same knowledge, with unknowns numbered in their order.
fn renumbered(state: Known) -> Known {
    let mut numbers = HashMap::new();
    let mut number = |of: i64| {
        let next = numbers.len() as i64;
        2 * *numbers.entry(of).or_insert(next) + 1
    };
    state.into_iter().map(|of| if of & 1 == 0 { of } else { number(of) }).collect()
}

impl SideBySide {
    /// Lets numbers start with anything: the same in all designs, but for registers that only a mutant has.
    fn free_numbers(&mut self, starts: &[Start]) {
        let Some((sound, mutants)) = self.designs.split_first_mut() else { return };
        let modules = sound.netlist.modules.clone();
        // Where it is held, and where the sound design holds it.
        let free = |design: &Design| -> Vec<(usize, Option<usize>, Format)> {
            let is_free = |of: &Register| {
                let starts =
                    starts.iter().any(|at| (at.module, at.register) == (of.module, of.own));
                modules[of.module].resets && !is_control(of.named) && !starts
            };
            let places = design.registers().filter(is_free).map(|of| {
                let in_sound = of.own < modules[of.module].registers.len();
                (of.place, in_sound.then_some(of.in_sound), of.named.format)
            });
            places.collect()
        };
        for (place, _, format) in free(sound) {
            sound.held.registers[place] = self.terms.unknown(format);
        }
        for mutant in mutants {
            for (place, in_sound, format) in free(mutant) {
                let same = in_sound.map(|place| sound.held.registers[place]);
                mutant.held.registers[place] = same.unwrap_or_else(|| self.terms.unknown(format));
            }
        }
    }

    /// Goes back to a state.
    fn restore(&mut self, state: &[i64], formats: &[Format]) {
        let (mut terms, mut unknowns) = (Terms::default(), HashMap::new());
        let held = self.designs.iter_mut().flat_map(|design| design.held.each_mut());
        for ((node, &of), &format) in held.zip(state).zip(formats) {
            *node = match of & 1 {
                0 => terms.constant(of / 2, format),
                _ => *unknowns.entry(of).or_insert_with(|| terms.unknown(format)),
            };
        }
        self.terms = terms;
        self.designs.iter_mut().for_each(|design| design.top.renew());
    }
}

#[cfg(test)]
mod tests;
