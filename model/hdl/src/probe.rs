// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a simulation exposes: its variables by name, and their codes at this clock.
//!
//! Names, formats, units and state names come from the bundles that declare registers and ports. A
//! probe only observes: it takes no part in the simulation, and costs nothing where no tracer reads
//! it. The [signals of a block's printed design](crate::verilog::dump), registers and ports, are read off
//! its netlist, so that its waves and a dump of the Verilog have the same names.
//!
//! ```text
//! clock      n         n+1
//! edge       |         |
//! registers  ⟨ sample after clock n    ⟩
//! ports      ⟨ sample_ports after n+1  ⟩     inputs of clock n+1, outputs that follow from them
//! ```

use crate::block::{Block, Inputs, Interface, Interpretation, Outputs, State, Submodule, Visitor};
use crate::bundle::{Bundle, Field};
use crate::format::Format;

/// One named variable of a simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// The instances from the top down to the owner of the variable.
    pub scope: Vec<String>,
    /// Its name within the instance, as declared by its bundle; with a number where another's is the same.
    pub name: String,
    /// How its code is read as a number.
    pub format: Format,
    /// The names of its codes, where it is a state: `states[code]`.
    pub states: &'static [&'static str],
}

/// A simulation whose variables can be read after each clock.
pub trait Probe {
    /// The variables, in the order of [`Probe::sample`].
    fn variables(&self) -> Vec<Variable>;

    /// Appends the present code of each variable.
    fn sample(&self, codes: &mut Vec<i64>);

    /// Appends the code that each of [`Signals::ports`] had until the edge of the last clock.
    fn sample_ports(&self, _codes: &mut Vec<i64>) {}
}

/// What waves show of a simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct Signals {
    /// For each code of [`Probe::sample`], its signal; none where it is not shown.
    pub registers: Vec<Option<Variable>>,
    /// For each code of [`Probe::sample_ports`], likewise.
    pub ports: Vec<Option<Variable>>,
    /// Scope and name of the clock, where it is known.
    pub clock: Option<(Vec<String>, &'static str)>,
}

impl Signals {
    /// The variables of a simulation that has no printed design.
    pub fn of(probe: &impl Probe) -> Self {
        let registers = probe.variables().into_iter().map(Some).collect();
        Signals { registers, ports: Vec::new(), clock: None }
    }
}

/// The variables of a block and all within it, the block itself being the scope `name`.
pub fn variables<B: Block>(block: &B, name: &'static str) -> Vec<Variable> {
    struct Names {
        scope: Vec<String>,
        found: Vec<Variable>,
    }
    impl Names {
        /// The name, with a number where a variable of this scope has it.
        fn unique(&self, name: &str) -> String {
            let taken = |name: &String| {
                self.found.iter().any(|of| of.scope == self.scope && of.name == *name)
            };
            let numbered = (2..).map(|number| format!("{name}_{number}"));
            let mut names = std::iter::once(name.to_owned()).chain(numbered);
            names.find(|name| !taken(name)).expect("there are numbers enough")
        }
    }
    impl Visitor<i64> for Names {
        fn enter(&mut self, name: &'static str) {
            self.scope.push(name.into());
        }
        fn register(&mut self, field: &'static Field, format: Format, _value: i64) {
            let (scope, name) = (self.scope.clone(), self.unique(field.name));
            self.found.push(Variable { scope, name, format, states: field.states });
        }
        fn leave(&mut self) {
            self.scope.pop();
        }
    }
    let mut names = Names { scope: Vec::new(), found: Vec::new() };
    block.visit(name, &block.reset(), &mut names);
    names.found
}

/// Appends the reset, which a running simulation does not assert, and the ports of a block, in the order of
/// [`crate::verilog::dump::signals`].
pub fn sample_ports<B: Interface>(
    block: &B,
    (inputs, outputs): &(Inputs<B, i64>, Outputs<B, i64>),
    into: &mut Vec<i64>,
) {
    into.push(0);
    let mut port = |(format, code): (Format, i64)| {
        if !format.is_none() {
            into.push(code);
        }
    };
    B::Inputs::each(B::Inputs::zip(block.inputs(), *inputs), |_, code| port(code));
    B::Outputs::each(B::Outputs::zip(block.outputs(), *outputs), |_, code| port(code));
}

/// Appends what the registers of a block and of all within it hold, in the order of [`variables`].
pub fn sample<B: Block, V: Interpretation>(block: &B, state: &State<B, V>, into: &mut Vec<V>) {
    struct Codes<'a, V>(&'a mut Vec<V>);
    impl<V: Interpretation> Visitor<V> for Codes<'_, V> {
        fn enter(&mut self, _name: &'static str) {}
        fn register(&mut self, _: &'static Field, _: Format, value: V) {
            self.0.push(value);
        }
        fn leave(&mut self) {}
    }
    block.visit("", state, &mut Codes(into));
}
