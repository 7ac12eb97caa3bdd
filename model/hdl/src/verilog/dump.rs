// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a dump of a printed design calls its signals: `bench.core.u_oscillator.cosine`.

use super::module::register_names;
use super::names::ports;
use crate::block::{Block, Submodule, Visitor};
use crate::bundle::Field;
use crate::format::{BIT, Format};
use crate::interpretations::netlist::{Module, Netlist};
use crate::probe::{Signals, Variable};

/// The signals of a block's design, whose top module has the path `scope`.
///
/// # Panics
/// Where the block does not elaborate (see [`Netlist::of`]).
pub fn signals<B: Block>(block: &B, scope: &[&str]) -> Signals {
    let netlist = Netlist::of(block);
    let names = netlist.modules.iter().map(register_names).collect();
    let scope: Vec<String> = scope.iter().map(ToString::to_string).collect();
    let mut walk =
        Walk { netlist: &netlist, names, path: scope.clone(), open: Vec::new(), found: Vec::new() };
    block.visit::<i64>("", &block.reset(), &mut walk);
    let registers = walk.found;
    let variable = |name: &str, format: Format, states| {
        let (scope, name) = (scope.clone(), name.to_owned());
        Variable { scope, name, format, states }
    };
    let is_register = |name: &str| {
        registers.iter().flatten().any(|found| found.scope == scope && found.name == name)
    };
    let of_module = ports(netlist.top()).into_iter().map(|port| {
        (!is_register(&port.name)).then(|| variable(&port.name, port.format, port.states))
    });
    let ports = std::iter::once(Some(variable("reset", BIT, &[]))).chain(of_module).collect();
    Signals { registers, ports, clock: Some((scope, "clock")) }
}

/// A walk over the registers of a block, beside the modules of its netlist.
struct Walk<'a> {
    netlist: &'a Netlist,
    /// Of each module, the names of its registers.
    names: Vec<Vec<Option<String>>>,
    path: Vec<String>,
    /// From the top down: the module, none where the design has no such instance, and its registers so far.
    open: Vec<(Option<usize>, usize)>,
    found: Vec<Option<Variable>>,
}

impl Walk<'_> {
    /// The module of an instance within a module.
    fn within(&self, module: usize, name: &str) -> Option<usize> {
        let Module { instances, .. } = &self.netlist.modules[module];
        instances.iter().find(|instance| instance.name == name).map(|instance| instance.module)
    }
}

impl Visitor<i64> for Walk<'_> {
    fn enter(&mut self, name: &'static str) {
        let module = match self.open.last() {
            None => Some(self.netlist.modules.len() - 1),
            Some((module, _)) => {
                self.path.push(super::instance(name));
                module.and_then(|module| self.within(module, name))
            }
        };
        self.open.push((module, 0));
    }

    fn register(&mut self, field: &'static Field, format: Format, _value: i64) {
        let (module, index) = self.open.last_mut().expect("a register is within an instance");
        let name = module.and_then(|module| self.names[module][*index].clone());
        *index += 1;
        let scope = &self.path;
        let variable =
            name.map(|name| Variable { scope: scope.clone(), name, format, states: field.states });
        self.found.push(variable);
    }

    fn leave(&mut self) {
        self.open.pop();
        if !self.open.is_empty() {
            self.path.pop();
        }
    }
}
