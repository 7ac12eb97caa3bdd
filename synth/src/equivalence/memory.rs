// SPDX-License-Identifier: MIT OR Apache-2.0
//! A clock of a memory.

use super::terms::Terms;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::netlist::{Node, Op, Ram};
use hapticore_hdl::memory::Collision;

/// One cycle of a memory; whether anything in it changes.
pub(super) fn access(
    terms: &mut Terms,
    ram: &Ram,
    (data, words): (&mut Node, &mut Vec<Node>),
    of: impl Fn(Node) -> Node,
) -> bool {
    let Some(address) = ram.address.map(&of) else { return false };
    let mut read = match terms.code(address) {
        Some(place) => words.get(place as usize).copied(),
        None => Some(terms.word([&words[..], &[address]].concat(), ram.format)),
    };
    let mut changes = false;
    if let Some((enable, place, word)) = ram.write.map(|(a, b, c)| (of(a), of(b), of(c)))
        && terms.code(enable) != Some(0)
    {
        let apart =
            matches!((terms.code(address), terms.code(place)), (Some(a), Some(b)) if a != b);
        if ram.collision == Collision::DontCare && !apart {
            read = None;
        }
        let before = words.clone();
        write(terms, ram, words, [enable, place, word]);
        changes = before != *words;
    }
    let read = read.unwrap_or_else(|| terms.unknown(ram.format));
    changes |= std::mem::replace(data, read) != read;
    changes
}

/// Writes a word, or what may be one.
fn write(terms: &mut Terms, ram: &Ram, words: &mut [Node], [enable, place, word]: [Node; 3]) {
    let word = terms.aligned(word, ram.format);
    match (terms.code(enable), terms.code(place)) {
        (Some(_), Some(place)) => {
            if let Some(own) = words.get_mut(place as usize) {
                *own = word;
            }
        }
        (None, Some(place)) => {
            if let Some(own) = words.get_mut(place as usize) {
                *own = terms.of(Op::Select(enable, word, *own), ram.format);
            }
        }
        _ => {
            for (index, own) in words.iter_mut().enumerate() {
                let index = terms.constant(index as i64, Format::unsigned(32, 0));
                *own = terms.word(vec![*own, enable, place, word, index], ram.format);
            }
        }
    }
}
