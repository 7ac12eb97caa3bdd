// SPDX-License-Identifier: MIT OR Apache-2.0
//! Verilog-2005 from the netlist reading of a block.
//!
//! One module per block, shared by its instances and named after it; ports and registers under their names in the model, with
//! their formats beside them. Every operand is brought to the width of its operation in sight, so that none of Verilog's
//! implicit widths and signs decides anything:
//!
//! | in the model | in Verilog |
//! | --- | --- |
//! | an exact sum, difference | both operands extended to the width of the result |
//! | a product | signed where one factor is; the other then gets a zero in front |
//! | `fit` with `HalfEven` | the kept bits, and one more where the rest is over a half, or a half and the kept part odd |
//! | `fit` with `Saturate` | the low bits where those above agree, else the rail |
//! | a memory | an array with one read register and one write port, in a process of its own: a block RAM |
//! | a register | synchronous reset to zero |
//!
//! Bits that nothing needs are gathered in one wire `unused` per module, as linters expect. Registers that nothing depends on
//! (those that only the real reading wants) are left out.

mod clock;
mod expression;
mod fit;
pub mod header;
mod live;
mod module;
mod names;
mod scope;

use hapticore_model::block::Block;
use hapticore_model::blocks::core::Core;
use hapticore_model::format::Format;
use hapticore_model::interpretations::netlist::{Module, Netlist};
use hapticore_model::profile::Profile;

/// A file of a design: one module.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct File {
    /// The name of the module; the file's, with `.v`.
    pub name: String,
    /// What stands in it.
    pub text: String,
}

/// The direction of a port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Into the module.
    Input,
    /// Out of it.
    Output,
}

/// A port of a printed module, besides `clock` and `reset`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Port {
    /// Its name in Verilog: the field's, with `_out` where an input has the same.
    pub name: String,
    /// Which way.
    pub direction: Direction,
    /// How its bits are read as a number.
    pub format: Format,
    /// The names of its codes, where it is a state.
    pub states: &'static [&'static str],
    /// What the model says of it.
    pub about: &'static str,
}

/// A printed design.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Design {
    /// Its modules, each after those that it instantiates; the top one last.
    pub modules: Vec<File>,
    /// The ports of the top module: inputs, then outputs, in the order of the block's bundles.
    pub ports: Vec<Port>,
}

impl Design {
    /// Prints the core of a profile, as `hapticore hdl --profile` does.
    pub fn of_core(profile: &Profile) -> Design {
        Design::of(&Core::new(profile), &format!("hapticore hdl --profile {}", profile.name))
    }

    /// Prints a block and all within it. `made_by` goes into the head of each file: the command, and the profile.
    ///
    /// # Panics
    /// Where the block does not elaborate (see [`Netlist::of`]).
    pub fn of<B: Block>(block: &B, made_by: &str) -> Design {
        Design::print(&Netlist::of(block), made_by)
    }

    /// Prints a netlist.
    pub fn print(netlist: &Netlist, made_by: &str) -> Design {
        let names = names::of_modules(netlist);
        let print = |(module, name): (&Module, &String)| {
            let text = module::print(netlist, &names, module, name, made_by);
            File { name: name.clone(), text }
        };
        Design { modules: netlist.modules.iter().zip(&names).map(print).collect(), ports: names::ports(netlist.top()) }
    }

    /// The name of the top module.
    pub fn top(&self) -> &str {
        &self.modules.last().expect("a design has a module").name
    }

    /// All modules in one text.
    pub fn text(&self) -> String {
        self.modules.iter().map(|file| file.text.as_str()).collect::<Vec<_>>().join("\n")
    }
}
