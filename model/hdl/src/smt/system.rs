// SPDX-License-Identifier: MIT OR Apache-2.0
//! A block as a transition system, and the problems that decide its properties.

use super::bits::{any, literal, width};
use super::fit;
use super::places::Place;
use super::state::{At, Unrolled, Variable, number_of};
use super::used::Uses;
use crate::format::Format;
use crate::interpretations::netlist::{Module, Netlist, Node, Op, Wire};
use crate::signal::Overflow;
use crate::verilog::live::Live;

/// A block and all within it.
pub struct System<'a> {
    places: Vec<Place<'a>>,
    live: Live,
    uses: Uses,
}

/// What shall hold at every clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Property {
    /// The invariant of this index.
    Invariant(usize),
    /// The `Assumed` narrowing at this wire fits its format, or one that lacks this number of bits,
    /// to see that a solver refutes it.
    Claim(Node, u8),
}

/// A bit-vector problem.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// SMT-LIB 2, up to `(check-sat)`.
    pub text: String,
    /// What a counterexample has values of.
    pub variables: Vec<Variable>,
}

impl<'a> System<'a> {
    /// A module of a netlist, with all its instances in place.
    pub fn of(netlist: &'a Netlist, module: usize) -> System<'a> {
        let top = &netlist.modules[module];
        let live = Live::of(top);
        let uses = Uses::of(top, &live);
        System { places: Place::all(netlist, top), live, uses }
    }

    fn top(&self) -> &'a Module {
        self.places[0].module
    }

    /// Name of the block.
    pub fn name(&self) -> &'static str {
        self.top().name
    }

    /// The block's invariants: their names.
    pub fn invariants(&self) -> Vec<(&'static str, Property)> {
        let named = self.top().invariants.iter().enumerate();
        named.map(|(index, &(name, _))| (name, Property::Invariant(index))).collect()
    }

    /// The block's own `Assumed` narrowings, not of those within: what they assume.
    pub fn claims(&self) -> Vec<(&'static str, Property)> {
        let wires = self.top().wires.iter().enumerate();
        let live = wires.filter(|(index, _)| self.live.uses[*index] > 0);
        let assumed = |(index, wire): (usize, &Wire)| match wire.op {
            Op::Fit(_, _, Overflow::Assumed(name)) => {
                Some((name, Property::Claim(Node(index as u32), 0)))
            }
            _ => None,
        };
        live.filter_map(assumed).collect()
    }

    /// Whether a property can fail within `clocks` clocks after reset.
    pub fn base(&self, property: Property, clocks: usize) -> Problem {
        let mut unrolled = Unrolled::new(&self.places, true);
        let fails: Vec<String> = (0..clocks)
            .map(|clock| {
                self.keep_inputs(&mut unrolled, clock);
                format!("(not {})", self.holds(&mut unrolled, property, clock))
            })
            .collect();
        unrolled.assert(&any(&fails));
        problem(unrolled)
    }

    /// Whether a property can fail after `clocks` clocks, where it held so far and all invariants
    /// hold from the first state to the last; an invariant itself is then in question.
    pub fn step(&self, property: Property, clocks: usize) -> Problem {
        let mut unrolled = Unrolled::new(&self.places, false);
        for clock in 0..=clocks {
            self.keep_inputs(&mut unrolled, clock);
            for (_, invariant) in self.invariants() {
                if clock < clocks || invariant_is_proved(property) {
                    let holds = self.holds(&mut unrolled, invariant, clock);
                    unrolled.assert(&holds);
                }
            }
            let holds = self.holds(&mut unrolled, property, clock);
            unrolled.assert(&if clock < clocks { holds } else { format!("(not {holds})") });
        }
        problem(unrolled)
    }

    /// Whether this relation can differ from a trace of the model from reset on: registers of the
    /// block and all within at each clock, by name, and what each clock was given.
    pub fn replay(&self, registers: &[Vec<(String, i64)>], inputs: &[Vec<i64>]) -> Problem {
        let mut unrolled = Unrolled::new(&self.places, false);
        let mut differs = Vec::new();
        self.initial_words(&mut unrolled);
        for (clock, (registers, inputs)) in registers.iter().zip(inputs).enumerate() {
            for (port, code) in inputs.iter().enumerate() {
                let (name, format) =
                    (unrolled.input(At::top(clock), port), self.top().inputs[port].format);
                unrolled.assert(&is(&name, *code, format));
            }
            for equal in self.equal(&mut unrolled, clock, registers) {
                match clock {
                    0 => unrolled.assert(&equal),
                    _ => differs.push(format!("(not {equal})")),
                }
            }
        }
        unrolled.assert(&any(&differs));
        problem(unrolled)
    }

    /// Every memory begins with its words at reset, as in the model.
    fn initial_words(&self, unrolled: &mut Unrolled) {
        for (place, Place { module, .. }) in self.places.iter().enumerate() {
            let (at, live) = (At { clock: 0, place }, Live::of(module));
            for (index, ram) in
                module.memories.iter().enumerate().filter(|(n, _)| live.memories[*n])
            {
                for (address, code) in ram.initial.iter().enumerate() {
                    let word = unrolled.initial_word(at, index, address);
                    unrolled.assert(&is(&word, *code, ram.format));
                }
                let read = unrolled.word(at, index);
                unrolled.assert(&is(&read, 0, ram.format));
            }
        }
    }

    /// For each register that the circuit has whether it holds the model's code.
    fn equal(&self, unrolled: &mut Unrolled, clock: usize, codes: &[(String, i64)]) -> Vec<String> {
        let mut equal = Vec::new();
        for (index, place) in self.places.iter().enumerate() {
            let (at, live) = (At { clock, place: index }, Live::of(place.module));
            let all = &place.module.registers;
            for (register, named) in all.iter().enumerate().filter(|(n, _)| live.registers[*n]) {
                let name = format!("{}{}{}", place.path, named.name, number_of(all, register));
                let (_, code) = codes.iter().find(|(of, _)| *of == name).expect("the model has it");
                equal.push(is(&unrolled.register(at, register), *code, named.format));
            }
        }
        equal
    }

    /// Whether a property holds at a clock, as a Boolean term.
    fn holds(&self, unrolled: &mut Unrolled, property: Property, clock: usize) -> String {
        let at = At::top(clock);
        let (wire, less) = match property {
            Property::Invariant(index) => {
                return unrolled.is_set(at, self.top().invariants[index].1);
            }
            Property::Claim(wire, less) => (wire, less),
        };
        let Op::Fit(a, rounding, _) = self.top().wires[wire.0 as usize].op else {
            panic!("a claim is a narrowing");
        };
        let (term, from, to) =
            (unrolled.term(at, a), unrolled.format(at, a), unrolled.format(at, wire));
        let rounded = fit::round(&term, from, to, rounding);
        let narrower = Format { width: to.width - less, ..to };
        let matters = unrolled.matters(at, &self.uses, wire);
        format!("(=> {matters} {})", rounded.is_in(narrower))
    }

    /// What the caller keeps to between the clock before and this one.
    fn keep_inputs(&self, unrolled: &mut Unrolled, clock: usize) {
        let Some((when, ports)) = self.top().held.as_ref().filter(|_| clock > 0) else { return };
        let when = unrolled.is_set(At::top(clock), *when);
        for &port in ports {
            let [now, before] =
                [clock, clock - 1].map(|clock| unrolled.input(At::top(clock), port));
            unrolled.assert(&format!("(=> {when} (= {now} {before}))"));
        }
    }
}

/// Whether a term has this code.
fn is(term: &str, code: i64, format: Format) -> String {
    format!("(= {term} {})", literal(code.into(), width(format)))
}

/// Whether invariants may be used at the clock in question: they are proved first, on their own.
fn invariant_is_proved(property: Property) -> bool {
    matches!(property, Property::Claim(..))
}

fn problem(unrolled: Unrolled) -> Problem {
    let (text, variables) = unrolled.finish();
    Problem { text: format!("(set-logic QF_ABV)\n{text}(check-sat)\n"), variables }
}
