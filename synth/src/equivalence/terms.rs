// SPDX-License-Identifier: MIT OR Apache-2.0
//! Terms: what wires carry, as expressions of constants and unknowns. Equal expressions are one term,
//! so that wires with the same term carry the same code, whatever the unknowns are.

use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::netlist::simulation::operate;
use hapticore_hdl::interpretations::netlist::{Module, Node, Op, Wire};
use hapticore_hdl::signal::{Overflow, Rounding};
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::hash::{BuildHasherDefault, Hasher};

/// What a term is.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
enum Kind {
    /// An operation on terms; a constant among them.
    Of(Op),
    /// Any code.
    Unknown(u64),
    /// An unknown function of these: the word of a memory at an unknown address.
    Word(Vec<Node>),
}

/// A quick hash: nobody chooses terms so that they collide.
#[derive(Debug, Default, Clone)]
struct Mixer(u64);

impl Hasher for Mixer {
    fn write(&mut self, bytes: &[u8]) {
        for part in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..part.len()].copy_from_slice(part);
            self.write_u64(u64::from_le_bytes(word));
        }
    }

    fn write_u64(&mut self, word: u64) {
        self.0 = (self.0.rotate_left(5) ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }

    fn write_u8(&mut self, word: u8) {
        self.write_u64(word.into());
    }

    fn write_u32(&mut self, word: u32) {
        self.write_u64(word.into());
    }

    fn write_usize(&mut self, word: usize) {
        self.write_u64(word as u64);
    }

    fn write_i64(&mut self, word: i64) {
        self.write_u64(word as u64);
    }

    fn write_isize(&mut self, word: isize) {
        self.write_u64(word as u64);
    }

    fn finish(&self) -> u64 {
        // The table takes its place from the low bits.
        self.0 ^ self.0 >> 32
    }
}

/// All terms so far: wires of a module that is no block's.
#[derive(Debug, Default)]
pub(super) struct Terms {
    module: Module,
    codes: Vec<i64>,
    known: HashMap<(Kind, Format), Node, BuildHasherDefault<Mixer>>,
    unknowns: u64,
}

impl Terms {
    fn add(&mut self, kind: Kind, format: Format) -> Node {
        let new = match self.known.entry((kind, format)) {
            Entry::Occupied(known) => return *known.get(),
            Entry::Vacant(new) => new,
        };
        let (op, code) = match new.key() {
            (Kind::Of(op @ Op::Constant(code)), _) => (op.clone(), *code),
            (Kind::Of(op), _) => (op.clone(), 0),
            _ => (Op::Input(0), 0),
        };
        let node = Node(self.codes.len() as u32);
        new.insert(node);
        self.module.wires.push(Wire { op, format, name: None });
        self.codes.push(code);
        node
    }

    /// A code.
    pub(super) fn constant(&mut self, code: i64, format: Format) -> Node {
        self.add(Kind::Of(Op::Constant(code)), format)
    }

    /// A new unknown.
    pub(super) fn unknown(&mut self, format: Format) -> Node {
        self.unknowns += 1;
        self.add(Kind::Unknown(self.unknowns), format)
    }

    /// An unknown function of terms.
    pub(super) fn word(&mut self, of: Vec<Node>, format: Format) -> Node {
        self.add(Kind::Word(of), format)
    }

    fn wire(&self, node: Node) -> &Wire {
        &self.module.wires[node.0 as usize]
    }

    /// The format of a term.
    pub(super) fn format(&self, node: Node) -> Format {
        self.wire(node).format
    }

    /// The code of a constant.
    pub(super) fn code(&self, node: Node) -> Option<i64> {
        matches!(self.wire(node).op, Op::Constant(_)).then(|| self.codes[node.0 as usize])
    }

    /// The same code in another format.
    pub(super) fn with_format(&mut self, node: Node, format: Format) -> Node {
        let Wire { ref op, format: from, .. } = *self.wire(node);
        match *op {
            _ if from == format => node,
            Op::Constant(code) => self.constant(code, format),
            Op::Scale(of) => self.with_format(of, format),
            _ => self.add(Kind::Of(Op::Scale(node)), format),
        }
    }

    /// The term of an operation on terms.
    pub(super) fn of(&mut self, op: Op, format: Format) -> Node {
        if op.operands().iter().all(|&node| self.code(node).is_some()) {
            let code = operate(&op, &self.module, &self.codes, format);
            return self.constant(code, format);
        }
        let is = |node: Node, code: i64| self.code(node) == Some(code);
        match op {
            Op::Scale(a) => self.with_format(a, format),
            Op::And(a, b) if is(a, 0) || is(b, 0) => self.constant(0, format),
            Op::And(a, b) | Op::Or(a, b) if a == b => self.with_format(a, format),
            Op::And(a, b) if format.width == 1 && is(a, 1) => self.with_format(b, format),
            Op::And(a, b) if format.width == 1 && is(b, 1) => self.with_format(a, format),
            Op::Or(a, b) if format.width == 1 && (is(a, 1) || is(b, 1)) => self.constant(1, format),
            Op::Or(a, b) if is(a, 0) => self.with_format(b, format),
            Op::Or(a, b) if is(b, 0) => self.with_format(a, format),
            Op::Mul(a, b) if is(a, 0) || is(b, 0) => self.constant(0, format),
            Op::Select(_, a, b) if a == b => self.aligned(a, format),
            Op::Select(bit, a, b) => match self.code(bit) {
                Some(0) => self.aligned(b, format),
                Some(_) => self.aligned(a, format),
                None => self.add(Kind::Of(op), format),
            },
            Op::Fit(a, ..) if self.wire(a).format == format => a,
            op => self.add(Kind::Of(op), format),
        }
    }

    /// The same number in a format with at least as many fractional bits.
    pub(super) fn aligned(&mut self, node: Node, format: Format) -> Node {
        if self.wire(node).format.frac == format.frac {
            return self.with_format(node, format);
        }
        self.of(Op::Fit(node, Rounding::Exact, Overflow::Wrap), format)
    }

    /// Forgets how the terms that are held have come about: each but a constant is an unknown, the same terms the same one.
    pub(super) fn forget<'a>(&mut self, held: impl Iterator<Item = &'a mut Node>) {
        let before = std::mem::take(self);
        self.unknowns = before.unknowns;
        let mut renamed = HashMap::new();
        for node in held {
            *node = *renamed.entry(*node).or_insert_with(|| {
                let format = before.wire(*node).format;
                match before.code(*node) {
                    Some(code) => self.constant(code, format),
                    None => self.unknown(format),
                }
            });
        }
    }
}
