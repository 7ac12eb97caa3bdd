// SPDX-License-Identifier: MIT OR Apache-2.0
//! The netlist of a block, with a mutant or without, clocked in place of the block.

use std::collections::BTreeSet;
use std::fs::File;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::Write;
use std::sync::Mutex;

use hapticore_hdl::block::Block;
use hapticore_hdl::interpretations::netlist::Netlist;
use hapticore_hdl::interpretations::netlist::mutants::Mutant;
use hapticore_hdl::interpretations::netlist::simulation::Simulation;

/// The netlist of a block to be clocked in its place, where a test of the block is judged: with the mutant that
/// `HAPTICORE_MUTANT` names, or unchanged where that is `none`. `None` where no module of the block has the mutant.
/// The names of all its mutants go to the file `HAPTICORE_MUTANTS`, with the test and the block that each is in.
///
/// # Panics
/// Where the file cannot be written.
pub fn in_place_of<B: Block>(block: &B) -> Option<Simulation> {
    let name = std::env::var("HAPTICORE_MUTANT").ok()?;
    let netlist = Netlist::of(block);
    if let Ok(path) = std::env::var("HAPTICORE_MUTANTS") {
        list(&netlist, &path);
    }
    if name == "none" {
        Some(Simulation::new(netlist))
    } else {
        Mutant::simulation(&netlist, &name)
    }
}

/// Appends the mutants of a design to a file, those of each test and design once. A line has: test, path of the block,
/// `own` for the design's top (`equivalent` where that is proved) or `within`, name of the mutant.
fn list(netlist: &Netlist, path: &str) {
    static LISTED: Mutex<BTreeSet<(String, u64)>> = Mutex::new(BTreeSet::new());
    let thread = std::thread::current();
    let (test, mut text) = (thread.name().unwrap_or_default(), String::new());
    let mut hasher = DefaultHasher::new();
    netlist.modules.hash(&mut hasher);
    // Other threads wait: they may ask for the same.
    let mut listed = LISTED.lock().expect("no test panics here");
    if !listed.insert((test.into(), hasher.finish())) {
        return;
    }
    for (index, module) in netlist.modules.iter().enumerate() {
        let own = index + 1 == netlist.modules.len();
        for mutant in Mutant::all(netlist, module) {
            let place = match own {
                false => "within",
                true if mutant.is_equivalent(netlist) => "equivalent",
                true => "own",
            };
            text += &format!("{test}\t{}\t{place}\t{mutant}\n", module.path);
        }
    }
    let file = File::options().append(true).create(true).open(path);
    file.and_then(|mut file| file.write_all(text.as_bytes()))
        .expect("the list of mutants is written");
}
