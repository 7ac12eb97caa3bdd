// SPDX-License-Identifier: MIT OR Apache-2.0
//! Deliberate faults in printed Verilog, to see that lock-step notices them.
//!
//! A [`Planted`] design holds every fault at once, each beside what was printed, and `+fault=N` on
//! the command line of the simulator wakes number N: one compilation serves them all. Without a
//! fault it is the printed design.
//!
//! | file | does |
//! | --- | --- |
//! | [`kinds`] | which shapes of the printer become what |
//! | `word` | which faults of a wire are none |
//! | `statements` | finds the statements of a module |
//! | `plant` | writes the faults in |
//! | [`campaign`] | which change nothing, and two processors |

pub mod campaign;
pub mod kinds;
mod plant;
pub mod statements;
pub mod word;

pub use kinds::Kind;
pub use plant::Planted;

use std::fmt;

/// A mutant of the printed Verilog.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Module that the mutant is in.
    pub module: String,
    /// The wire, register or condition that is wrong.
    pub name: String,
    /// What is wrong.
    pub kind: Kind,
    /// What was printed.
    pub printed: String,
    /// What is there instead.
    pub instead: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Fault { module, name, kind, printed, instead } = self;
        write!(f, "{kind:?} in {module}, {name}: {instead} instead of {printed}")
    }
}
