// SPDX-License-Identifier: MIT OR Apache-2.0
//! Names of wires that the block does not name: made of what they compute, so that they change only
//! where that does.
//!
//! `phase_plus_1`, `not_ready`, `sum_is_0`; where that would be long, the kind of the operation and
//! four digits of a hash of everything below it: `choice_3fa2`.

use crate::interpretations::netlist::{Module, Node, Op};
use std::hash::{Hash, Hasher};

/// The longest name that is spelled out.
const LONGEST: usize = 16;

/// What to call a wire.
pub fn name(module: &Module, hashes: &[u64], node: Node) -> String {
    let spelled = spell(module, node, LONGEST).filter(|name| name.len() <= LONGEST);
    let kind = kind(&module.wires[node.0 as usize].op);
    match spelled {
        Some(name) if !name.starts_with(|first: char| first.is_ascii_digit()) => name,
        Some(name) => format!("{kind}_{name}"),
        None => format!("{kind}_{:04x}", hashes[node.0 as usize] & 0xffff),
    }
}

/// The expression of a wire in words, none where it would take more than `most` letters.
fn spell(module: &Module, node: Node, most: usize) -> Option<String> {
    let wire = &module.wires[node.0 as usize];
    if let Some(name) = leaf(module, node).or_else(|| wire.name.map(str::to_owned)) {
        return Some(name);
    }
    let rest = most.checked_sub(4)?;
    let of = |node: Node| spell(module, node, rest);
    let two = |a: Node, word: &str, b: Node| Some(format!("{}_{word}_{}", of(a)?, of(b)?));
    match wire.op {
        Op::Add(a, b) => two(a, "plus", b),
        Op::Sub(a, b) => two(a, "minus", b),
        Op::Mul(a, b) => two(a, "times", b),
        Op::Less(a, b) => two(a, "below", b),
        Op::Equal(a, b) => two(a, "is", b),
        Op::And(a, b) => two(a, "and", b),
        Op::Or(a, b) => two(a, "or", b),
        Op::Concat(a, b) => two(a, "beside", b),
        Op::Not(a) => Some(format!("not_{}", of(a)?)),
        Op::Abs(a) => Some(format!("magnitude_of_{}", of(a)?)),
        Op::Fit(a, ..) => Some(format!("{}_to_{}", of(a)?, wire.format.width)),
        Op::Bits(a, low) => Some(format!("{}_from_{low}", of(a)?)),
        Op::Scale(a) => of(a),
        _ => None,
    }
}

/// The name of what is no operation.
fn leaf(module: &Module, node: Node) -> Option<String> {
    match module.wires[node.0 as usize].op {
        Op::Constant(code) if code < 0 => Some(format!("minus_{}", code.unsigned_abs())),
        Op::Constant(code) => Some(code.to_string()),
        Op::Input(port) => Some(module.inputs[port].name.into()),
        Op::Register(register) => Some(module.registers[register].name.into()),
        Op::Data(ram) => Some(format!("{}_word", module.memories[ram].name)),
        _ => None,
    }
}

/// What to call a wire of an operation.
pub fn kind(op: &Op) -> &'static str {
    match op {
        Op::Add(..) => "sum",
        Op::Sub(..) => "difference",
        Op::Mul(..) => "product",
        Op::Abs(_) => "magnitude",
        Op::Fit(..) => "quantized",
        Op::Bits(..) => "bits",
        Op::Concat(..) => "joined",
        Op::Less(..) => "less",
        Op::Equal(..) => "equal",
        Op::Select(..) => "choice",
        Op::And(..) | Op::Or(..) | Op::Not(_) => "bit",
        _ => "constant",
    }
}

/// FNV-1a, so that a name does not change with the compiler.
struct Fnv(u64);

impl Hasher for Fnv {
    fn finish(&self) -> u64 {
        self.0 ^ self.0 >> 16 ^ self.0 >> 32 ^ self.0 >> 48
    }

    fn write(&mut self, bytes: &[u8]) {
        let step = |hash: u64, &byte: &u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        self.0 = bytes.iter().fold(self.0, step);
    }
}

/// For each wire a hash of its expression down to ports, registers and memories, by their names.
pub fn hashes(module: &Module) -> Vec<u64> {
    let mut hashes: Vec<u64> = Vec::with_capacity(module.wires.len());
    for (index, wire) in module.wires.iter().enumerate() {
        let mut hasher = Fnv(0xcbf2_9ce4_8422_2325);
        format!("{}", wire.format).hash(&mut hasher);
        kind(&wire.op).hash(&mut hasher);
        match leaf(module, Node(index as u32)) {
            Some(name) => name.hash(&mut hasher),
            None => operands(module, &wire.op, &hashes).hash(&mut hasher),
        }
        hashes.push(hasher.finish());
    }
    hashes
}

/// What an operation depends on, as text.
fn operands(module: &Module, op: &Op, hashes: &[u64]) -> String {
    let of = |node: &Node| hashes[node.0 as usize];
    match op {
        Op::Output(instance, port) => format!("{} {port}", module.instances[*instance].name),
        Op::Abs(a) | Op::Scale(a) => of(a).to_string(),
        Op::Not(a) => format!("~{}", of(a)),
        Op::Fit(a, rounding, overflow) => format!("{} {rounding:?} {overflow:?}", of(a)),
        Op::Bits(a, low) => format!("{} {low}", of(a)),
        Op::Select(bit, a, b) => format!("{} {} {}", of(bit), of(a), of(b)),
        Op::Add(a, b) | Op::Sub(a, b) | Op::Mul(a, b) | Op::Concat(a, b) => {
            format!("{} {}", of(a), of(b))
        }
        Op::Less(a, b) | Op::Equal(a, b) => format!("{} {}", of(a), of(b)),
        Op::And(a, b) => format!("{} & {}", of(a), of(b)),
        Op::Or(a, b) => format!("{} | {}", of(a), of(b)),
        Op::Constant(_) | Op::Input(_) | Op::Register(_) | Op::Data(_) => String::new(),
    }
}

#[cfg(test)]
mod tests;
