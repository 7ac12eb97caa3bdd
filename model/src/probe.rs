// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a simulation lets others look at: its variables by name, and their codes at this clock.
//!
//! Names, formats, units and state names come from the bundles that declare registers and ports. A probe only looks: it
//! takes no part in the simulation, and costs nothing where nobody asks.

use crate::format::Format;

/// One named variable of a simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// The instances from the top down to the one that owns the variable.
    pub scope: Vec<String>,
    /// Its name within the instance, as declared by its bundle.
    pub name: String,
    /// How its code is read as a number.
    pub format: Format,
    /// The names of its codes, where it is a state: `states[code]`.
    pub states: &'static [&'static str],
}

/// Something whose variables can be looked at after each clock.
pub trait Probe {
    /// The variables, in the order of [`Probe::sample`].
    fn variables(&self) -> Vec<Variable>;

    /// Appends the present code of each variable.
    fn sample(&self, codes: &mut Vec<i64>);
}
