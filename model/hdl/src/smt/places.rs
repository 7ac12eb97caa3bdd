// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hierarchy of a block: every instance within it, at its place.

use crate::interpretations::netlist::{Module, Netlist};

/// An instance of a module, at its place in the hierarchy.
pub struct Place<'a> {
    /// The module.
    pub module: &'a Module,
    /// Its instances' names, with a dot behind each.
    pub path: String,
    /// The place that it is within, and which instance it is there.
    pub parent: Option<(usize, usize)>,
    /// The places within.
    pub children: Vec<usize>,
}

impl<'a> Place<'a> {
    /// A module and all within it; the module itself is the first place.
    pub fn all(netlist: &'a Netlist, module: &'a Module) -> Vec<Place<'a>> {
        let mut places = Vec::new();
        add(&mut places, netlist, (module, String::new(), None));
        places
    }
}

/// Adds an instance and all within it; the index of its place.
fn add<'a>(
    places: &mut Vec<Place<'a>>,
    netlist: &'a Netlist,
    (module, path, parent): (&'a Module, String, Option<(usize, usize)>),
) -> usize {
    let index = places.len();
    places.push(Place { module, path: path.clone(), parent, children: Vec::new() });
    for (nth, instance) in module.instances.iter().enumerate() {
        let path = format!("{path}{}.", instance.name);
        let within = &netlist.modules[instance.module];
        let child = add(places, netlist, (within, path, Some((index, nth))));
        places[index].children.push(child);
    }
    index
}
