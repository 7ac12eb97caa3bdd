// SPDX-License-Identifier: MIT OR Apache-2.0
//! Names: of modules, of ports, and of all else within a module, each once.

use super::{Direction, PREFIX, Port};
use crate::interpretations::netlist::{Module, Named, Netlist};
use std::collections::HashSet;

/// What a signal may not be called, although it might be: the words of Verilog (IEEE 1364-2005,
/// annex B), ...
const VERILOG: &str = "\
    always and assign begin buf case cell config deassign default design disable edge else end event for force \
    forever fork function generate if initial inout input instance integer join large library medium module nand \
    negedge nor not or output parameter posedge primitive real reg release repeat scalared signed small strong0 \
    strong1 supply0 supply1 table task time tri unsigned use vectored wait wand weak0 weak1 while wire wor xnor \
    xor";
/// ... those that SystemVerilog has besides (IEEE 1800-2017, annex B), for most tools read the one
/// as the other, ...
const SYSTEM_VERILOG: &str = "\
    alias assert assume before bit bins break byte chandle checker class constraint context continue cover cross \
    dist do enum expect export extends extern final global iff implies import inside int interface intersect local \
    logic longint matches modport new null packed package priority program property protected pure rand randc ref \
    restrict return sequence shortint shortreal soft solve static string strong struct super tagged this \
    throughout type typedef union unique untyped uwire var virtual void weak wildcard with within";
/// ... and what every module has.
const OWN: [&str; 3] = ["clock", "reset", "unused"];

/// The names of a netlist's modules: the blocks' behind a prefix, with a number where several
/// differ.
pub fn of_modules(netlist: &Netlist, prefix: &str) -> Vec<String> {
    let mut names = Names { taken: HashSet::new() };
    netlist.modules.iter().map(|module| names.unique(&prefixed(module.name, prefix))).collect()
}

/// A block's name behind the prefix, which stands in place of the usual one where the name begins with that.
fn prefixed(block: &str, prefix: &str) -> String {
    match block.strip_prefix(PREFIX) {
        Some(rest) => format!("{prefix}{rest}"),
        None => format!("{prefix}_{block}"),
    }
}

/// The ports of a module: inputs, then outputs.
pub fn ports(module: &Module) -> Vec<Port> {
    let mut names = Names::default();
    let mut port = |named: &Named, direction: Direction| {
        let name = match direction {
            Direction::Output if names.taken.contains(named.name) => {
                names.unique(&format!("{}_out", named.name))
            }
            _ => names.unique(named.name),
        };
        Port { name, direction, format: named.format, states: named.states, about: named.about }
    };
    let mut all: Vec<Port> =
        module.inputs.iter().map(|named| port(named, Direction::Input)).collect();
    all.extend(module.outputs.iter().map(|named| port(named, Direction::Output)));
    all
}

/// The name of a memory's read register.
pub fn read_register(memory: &str) -> String {
    format!("{memory}_word")
}

/// The names taken in a module.
pub struct Names {
    taken: HashSet<String>,
}

impl Default for Names {
    fn default() -> Self {
        let words = [VERILOG, SYSTEM_VERILOG].into_iter().flat_map(str::split_whitespace);
        Names { taken: words.chain(OWN).map(str::to_owned).collect() }
    }
}

impl Names {
    /// The name, with a number where it is taken.
    pub fn unique(&mut self, name: &str) -> String {
        let numbered = (2..).map(|n| format!("{name}_{n}"));
        let free = std::iter::once(name.to_owned())
            .chain(numbered)
            .find(|name| !self.taken.contains(name));
        let free = free.expect("there are numbers enough");
        self.taken.insert(free.clone());
        free
    }

    /// The name of a memory, whose read register's is free, too, and taken with it.
    pub fn of_memory(&mut self, name: &str) -> String {
        loop {
            let memory = self.unique(name);
            if self.taken.insert(read_register(&memory)) {
                return memory;
            }
        }
    }

    /// Takes a name that is known to be free, or to be shared on purpose.
    pub fn reserve(&mut self, name: &str) {
        self.taken.insert(name.to_owned());
    }

    /// Whether a name is taken.
    pub fn has(&self, name: &str) -> bool {
        self.taken.contains(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_begins_with_the_prefix() {
        assert_eq!(prefixed("divider", PREFIX), "hapticore_divider");
        assert_eq!(prefixed("hapticore_loop", PREFIX), "hapticore_loop");
        assert_eq!(prefixed("divider", "hapticore_small"), "hapticore_small_divider");
        assert_eq!(prefixed("hapticore", "hapticore_small"), "hapticore_small");
        assert_eq!(prefixed("hapticore_loop", "mine"), "mine_loop");
    }

    #[test]
    fn a_memory_is_numbered_where_its_read_register_has_the_name_of_another_thing() {
        let mut names = Names::default();
        assert_eq!(names.unique("scratch_word"), "scratch_word");
        assert_eq!(names.of_memory("scratch"), "scratch_2");
        assert!(names.has("scratch_2_word"));
        assert_eq!(names.unique("scratch_2_word"), "scratch_2_word_2");
    }
}
