// SPDX-License-Identifier: MIT OR Apache-2.0
//! Time unrolled: inputs, registers and memories at each clock, each declared where it is first
//! needed.

use super::bits::{extend, literal, width};
use super::places::Place;
use crate::format::Format;
use crate::interpretations::netlist::{Module, Named, Node, Ram};
use crate::memory::Collision;
use std::collections::HashSet;
use std::fmt::Write;

/// A place in the hierarchy at a clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct At {
    /// Clocks from the first state.
    pub clock: usize,
    /// Index of the place; 0 is the block itself.
    pub place: usize,
}

impl At {
    /// The block itself at a clock.
    pub fn top(clock: usize) -> At {
        At { clock, place: 0 }
    }

    fn before(self) -> At {
        At { clock: self.clock - 1, ..self }
    }
}

/// What tells a register from those before it that have its name, as in a bundle and beside it: `_2`.
pub fn number_of(registers: &[Named], index: usize) -> String {
    let name = registers[index].name;
    match registers[..index].iter().filter(|other| other.name == name).count() {
        0 => String::new(),
        before => format!("_{}", before + 1),
    }
}

/// A signal of a counterexample.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Variable {
    /// Its name, with the clock behind `@`.
    pub name: String,
    /// How its bits are read as a number.
    pub format: Format,
}

/// What a problem's text is made of.
pub struct Unrolled<'a> {
    places: &'a [Place<'a>],
    /// The first state is that at reset.
    reset: bool,
    text: String,
    variables: Vec<Variable>,
    declared: HashSet<String>,
}

impl<'a> Unrolled<'a> {
    pub fn new(places: &'a [Place<'a>], reset: bool) -> Self {
        let (text, variables) = (String::new(), Vec::new());
        Unrolled { places, reset, text, variables, declared: HashSet::new() }
    }

    pub fn module(&self, at: At) -> &'a Module {
        self.places[at.place].module
    }

    pub fn format(&self, at: At, node: Node) -> Format {
        self.module(at).wires[node.0 as usize].format
    }

    /// The text, and what a counterexample gives values of.
    pub fn finish(self) -> (String, Vec<Variable>) {
        (self.text, self.variables)
    }

    pub fn assert(&mut self, term: &str) {
        let _ = writeln!(self.text, "(assert {term})");
    }

    /// The name of something of a place at a clock.
    fn name(&self, at: At, name: &str) -> String {
        format!("|{}{name}@{}|", self.places[at.place].path, at.clock)
    }

    /// As in Verilog: a register with the name of an input gets `_q`, and one of several with a name, as in a bundle and
    /// beside it, a number.
    fn register_name(&self, at: At, index: usize) -> String {
        let module = self.module(at);
        let name = module.registers[index].name;
        let taken = module.inputs.iter().any(|port| port.name == name);
        let q = if taken { "_q" } else { "" };
        self.name(at, &format!("{name}{q}{}", number_of(&module.registers, index)))
    }

    /// Declares a variable, unless it is.
    fn declare(&mut self, name: &str, format: Format) {
        if self.declared.insert(name.to_owned()) {
            let _ = writeln!(self.text, "(declare-const {name} (_ BitVec {}))", width(format));
            self.variables.push(Variable { name: name.trim_matches('|').to_owned(), format });
        }
    }

    /// A term by a name and the number of a wire, defined where it is first needed.
    pub fn define(
        &mut self,
        at: At,
        (what, node): (&str, Node),
        sort: &str,
        make: impl FnOnce(&mut Self) -> String,
    ) -> String {
        let name = self.name(at, &format!("{what} {}", node.0));
        if !self.declared.contains(&name) {
            let term = make(self);
            let _ = writeln!(self.text, "(define-fun {name} () {sort} {term})");
            self.declared.insert(name.clone());
        }
        name
    }

    pub fn input(&mut self, at: At, port: usize) -> String {
        match self.places[at.place].parent {
            Some((place, instance)) => {
                let parent = At { place, ..at };
                let node = self.module(parent).instances[instance].inputs[port];
                self.term(parent, node)
            }
            None => {
                let named = &self.module(at).inputs[port];
                let name = self.name(at, named.name);
                self.declare(&name, named.format);
                name
            }
        }
    }

    pub fn output(&mut self, at: At, instance: usize, port: usize) -> String {
        let place = self.places[at.place].children[instance];
        let within = At { place, ..at };
        let node = self.module(within).outputs[port].node;
        self.term(within, node)
    }

    /// A register: anything in the first state, zero where that is the state at reset and it has
    /// one, and afterwards what it took.
    pub fn register(&mut self, at: At, index: usize) -> String {
        let (module, named) = (self.module(at), &self.module(at).registers[index]);
        let name = self.register_name(at, index);
        if self.declared.contains(&name) {
            return name;
        }
        if at.clock > 0 {
            let next = self.term(at.before(), named.node);
            self.declare(&name, named.format);
            self.assert(&format!("(= {name} {next})"));
        } else {
            self.declare(&name, named.format);
            if self.reset && module.resets {
                self.assert(&format!("(= {name} {})", literal(0, width(named.format))));
            }
        }
        name
    }

    /// The read register of a memory.
    pub fn word(&mut self, at: At, index: usize) -> String {
        let ram = &self.module(at).memories[index];
        let name = self.name(at, &format!("{}_word", ram.name));
        if self.declared.contains(&name) {
            return name;
        }
        let Some(address) = ram.address.filter(|_| at.clock > 0) else {
            self.declare(&name, ram.format);
            return name;
        };
        let (before, memory) = (at.before(), self.memory(at.before(), index));
        let address = self.address(before, ram, address);
        let reads = format!("(= {name} (select {memory} {address}))");
        let reads = match ram.write.filter(|_| ram.collision == Collision::DontCare) {
            Some((enable, place, _)) => {
                let (enable, place) =
                    (self.is_set(before, enable), self.address(before, ram, place));
                format!("(or (and {enable} (= {address} {place})) {reads})")
            }
            None => reads,
        };
        self.declare(&name, ram.format);
        self.assert(&reads);
        name
    }

    /// The words of a memory: anything in the first state.
    fn memory(&mut self, at: At, index: usize) -> String {
        let ram = &self.module(at).memories[index];
        let name = self.name(at, ram.name);
        if self.declared.contains(&name) {
            return name;
        }
        let sort = format!(
            "(Array (_ BitVec {}) (_ BitVec {}))",
            self.address_bits(at, ram),
            width(ram.format)
        );
        let written = (at.clock > 0).then(|| self.written(at.before(), index));
        self.declared.insert(name.clone());
        let _ = match written {
            Some(words) => writeln!(self.text, "(define-fun {name} () {sort} {words})"),
            None => writeln!(self.text, "(declare-const {name} {sort})"),
        };
        name
    }

    /// A word of a memory in the first state.
    pub fn initial_word(&mut self, at: At, index: usize, address: usize) -> String {
        let bits = self.address_bits(at, &self.module(at).memories[index]);
        let words = self.memory(at, index);
        format!("(select {words} {})", literal(address as i128, bits))
    }

    /// The words of a memory at the end of a clock.
    fn written(&mut self, at: At, index: usize) -> String {
        let ram = &self.module(at).memories[index];
        let words = self.memory(at, index);
        let Some((enable, place, data)) = ram.write else { return words };
        let (enable, place) = (self.is_set(at, enable), self.address(at, ram, place));
        let data = self.term(at, data);
        format!("(ite {enable} (store {words} {place} {data}) {words})")
    }

    fn address_bits(&self, at: At, ram: &Ram) -> u32 {
        let nodes = ram.address.into_iter().chain(ram.write.map(|(_, place, _)| place));
        nodes.map(|node| width(self.format(at, node))).max().unwrap_or(1)
    }

    fn address(&mut self, at: At, ram: &Ram, node: Node) -> String {
        extend(&self.term(at, node), self.format(at, node), self.address_bits(at, ram))
    }
}
