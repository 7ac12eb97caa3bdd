// SPDX-License-Identifier: MIT OR Apache-2.0
//! Proves that no output ever depends on what a register starts with.
//!
//! Two runs of a design from reset have the same inputs, and one register starts with different codes. Each wire is known, or
//! unknown but the same in both runs, or may differ. All combinations of the inputs of one bit are followed, clock after
//! clock, until no new state comes: where no output may differ in any of them, none ever does.

use super::simulation::{Unit, operate, units};
use super::{Module, Netlist, Node, Op};
use std::collections::{HashMap, HashSet};

/// States that are followed at most; where there are more, nothing is proved.
const MOST_STATES: usize = 4_000;

/// Wires of a design at most, its instances included.
const MOST_WIRES: usize = 3_000;

/// Inputs of one bit of which both codes are followed; of others, nothing is known.
const MOST_BITS: usize = 5;

/// A wire in two runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Word {
    /// This code in both.
    Known(i64),
    /// The same in both.
    Same,
    /// Anything in either.
    Differs,
}

use Word::{Differs, Known, Same};

impl Word {
    fn code(self) -> i64 {
        if let Known(code) = self { code } else { 0 }
    }

    /// What an operation makes of words that are not all known.
    fn of(words: impl IntoIterator<Item = Word>) -> Word {
        if words.into_iter().any(|word| word == Differs) { Differs } else { Same }
    }
}

/// What registers, read registers of memories, and memories hold.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
struct Held {
    registers: Vec<Word>,
    data: Vec<Word>,
    /// The words of a memory may differ.
    differs: Vec<bool>,
}

/// Whether no output of the design depends on what a register of its top module starts with. Where the answer is no, it
/// may still be so.
pub fn is_irrelevant(netlist: &Netlist, register: usize) -> bool {
    let (unit, registers, memories) = units(netlist);
    if unit.wires() > MOST_WIRES {
        return false;
    }
    // Where registers start with anything, states are few: the search is short if the register is irrelevant.
    [Same, Known(0)].into_iter().any(|others| {
        let mut start = Held {
            registers: vec![others; registers],
            data: vec![others; memories],
            differs: vec![false; memories],
        };
        start.registers[register] = Differs;
        no_output_differs(netlist, &unit, start)
    })
}

/// Follows all states from this one, until both runs hold the same.
fn no_output_differs(netlist: &Netlist, unit: &Unit, start: Held) -> bool {
    let (mut open, mut seen) = (vec![start], HashSet::new());
    let inputs = inputs(netlist.top());
    while let Some(held) = open.pop() {
        for inputs in &inputs {
            let mut next = held.clone();
            if clock(netlist, unit, &held, &mut next, inputs).contains(&Differs) {
                return false;
            }
            let words = next.registers.iter().chain(&next.data);
            let differs =
                next.differs.contains(&true) || words.into_iter().any(|word| *word == Differs);
            if differs && seen.insert(next.clone()) {
                open.push(next);
            }
        }
        if seen.len() > MOST_STATES {
            return false;
        }
    }
    true
}

/// All combinations of the inputs of one bit.
fn inputs(top: &Module) -> Vec<Vec<Word>> {
    let mut all = vec![Vec::new()];
    let mut bits = 0;
    for port in &top.inputs {
        let both = port.format.width == 1 && bits < MOST_BITS;
        bits += usize::from(both);
        let words: &[Word] = if both { &[Known(0), Known(1)] } else { &[Same] };
        let longer = |inputs: &Vec<Word>| {
            let longer = |&word| [&inputs[..], &[word]].concat();
            words.iter().map(longer).collect::<Vec<_>>()
        };
        all = all.iter().flat_map(longer).collect();
    }
    all
}

/// One cycle of an instance: its outputs, and what it holds next.
fn clock(
    netlist: &Netlist,
    unit: &Unit,
    held: &Held,
    next: &mut Held,
    inputs: &[Word],
) -> Vec<Word> {
    let module = &netlist.modules[unit.module];
    let (mut words, mut codes): (Vec<Word>, Vec<i64>) = (Vec::new(), vec![0; module.wires.len()]);
    let mut outputs: HashMap<usize, Vec<Word>> = HashMap::new();
    let given = |words: &[Word], own: usize| -> Vec<Word> {
        module.instances[own].inputs.iter().map(|node| words[node.0 as usize]).collect()
    };
    for (index, wire) in module.wires.iter().enumerate() {
        let word = match wire.op {
            Op::Input(port) => inputs[port],
            Op::Register(own) => held.registers[unit.registers + own],
            Op::Data(own) => held.data[unit.memories + own],
            Op::Output(own, port) => outputs.entry(own).or_insert_with(|| {
                clock(netlist, &unit.instances[own], held, next, &given(&words, own))
            })[port],
            ref op => result(op, module, &words, &codes, index),
        };
        codes[index] = word.code();
        words.push(word);
    }
    for own in (0..module.instances.len()).filter(|own| !outputs.contains_key(own)) {
        clock(netlist, &unit.instances[own], held, next, &given(&words, own));
    }
    for (own, register) in module.registers.iter().enumerate() {
        next.registers[unit.registers + own] = words[register.node.0 as usize];
    }
    let of = |node: Node| words[node.0 as usize];
    for (own, ram) in module.memories.iter().enumerate() {
        let (at, Some(address)) = (unit.memories + own, ram.address) else { continue };
        let dirty = if held.differs[at] { Differs } else { Same };
        next.data[at] = Word::of([dirty, of(address)]);
        if let Some((enable, address, data)) = ram.write
            && of(enable) != Known(0)
        {
            next.differs[at] |= Word::of([of(enable), of(address), of(data)]) == Differs;
        }
    }
    module.outputs.iter().map(|port| of(port.node)).collect()
}

/// What an operation gives.
fn result(op: &Op, module: &Module, words: &[Word], codes: &[i64], index: usize) -> Word {
    let of = |node: Node| words[node.0 as usize];
    let to = module.wires[index].format;
    let operands: Vec<Word> = op.operands().into_iter().map(of).collect();
    if operands.iter().all(|word| matches!(word, Known(_))) {
        return Known(operate(op, module, codes, to));
    }
    match *op {
        Op::And(a, b) if of(a) == Known(0) || of(b) == Known(0) => Known(0),
        Op::Or(a, b) if of(a) == Known(1) || of(b) == Known(1) => Known(1),
        Op::Mul(a, b) if of(a) == Known(0) || of(b) == Known(0) => Known(0),
        Op::Select(bit, a, b) => match of(bit) {
            Known(set) => {
                let chosen = of(if set == 0 { b } else { a });
                if chosen == Known(chosen.code()) {
                    Known(operate(op, module, codes, to))
                } else {
                    chosen
                }
            }
            bit => Word::of([bit, of(a), of(b)]),
        },
        _ => Word::of(operands),
    }
}

#[cfg(test)]
mod tests;
