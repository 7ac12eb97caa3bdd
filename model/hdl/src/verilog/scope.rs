// SPDX-License-Identifier: MIT OR Apache-2.0
//! A module while it is printed: which wires have a declaration, which text stands for the others,
//! which bits are needed.

use super::describe;
use super::live::Live;
use super::names::Names;
use super::text::{Kind, Text, broken, literal};
use crate::format::Format;
use crate::interpretations::netlist::{Module, Named, Node, Op};

/// An identifier of the module.
pub struct Declared {
    pub name: String,
    pub width: u8,
    pub signed: bool,
    /// The bits that something needs.
    used: u64,
}

/// A declared identifier.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Id(usize);

/// A module while it is printed.
pub struct Scope<'a> {
    pub module: &'a Module,
    pub live: Live,
    pub names: Names,
    declared: Vec<Declared>,
    ids: Vec<Option<Id>>,
    texts: Vec<Option<Text>>,
    hints: Vec<Option<String>>,
    hashes: Vec<u64>,
    /// The declarations, in their order.
    pub body: Vec<String>,
}

/// Beyond this an expression gets a wire of its own.
const LONG: usize = 90;

impl<'a> Scope<'a> {
    pub fn new(module: &'a Module, names: Names) -> Self {
        let count = module.wires.len();
        Scope {
            module,
            live: Live::of(module),
            names,
            declared: Vec::new(),
            ids: vec![None; count],
            texts: vec![None; count],
            hints: vec![None; count],
            hashes: describe::hashes(module),
            body: Vec::new(),
        }
    }

    /// An identifier that stands for a wire and is declared elsewhere.
    pub fn bind(&mut self, node: Node, name: &str, format: Format) -> Id {
        let id = self.identifier(name.to_owned(), format.width, format.signed);
        self.ids[node.0 as usize] = Some(id);
        id
    }

    /// What to call a wire if it is declared.
    pub fn hint(&mut self, node: Node, name: String) {
        let node = self.source(node);
        self.hints[node.0 as usize].get_or_insert(name);
    }

    fn identifier(&mut self, name: String, width: u8, signed: bool) -> Id {
        self.declared.push(Declared { name, width, signed, used: 0 });
        Id(self.declared.len() - 1)
    }

    /// The wire whose bits these are: a moved point moves no bit.
    pub fn source(&self, node: Node) -> Node {
        match self.module.wires[node.0 as usize].op {
            Op::Scale(a) => self.source(a),
            _ => node,
        }
    }

    pub fn format(&self, node: Node) -> Format {
        self.module.wires[node.0 as usize].format
    }

    /// The code of a wire that is constant.
    pub fn constant(&self, node: Node) -> Option<i64> {
        match self.module.wires[self.source(node).0 as usize].op {
            Op::Constant(code) => Some(code),
            _ => None,
        }
    }

    /// Keeps the text of a wire; declares it where several need it, where it has a name, or where
    /// it is long.
    pub fn keep(&mut self, node: Node, text: Text, alone: bool) {
        let index = node.0 as usize;
        let named = self.module.wires[index].name.is_some();
        let plain = text.kind == Kind::Atom && !text.text.contains('{');
        let shared = self.live.uses[index] > 1 && !plain;
        let declare =
            alone || named || shared || (text.text.len() > LONG && text.kind != Kind::Select);
        self.texts[index] = Some(text);
        if declare {
            self.id(node);
        }
    }

    /// The identifier of a wire, declared if need be.
    pub fn id(&mut self, node: Node) -> Id {
        let node = self.source(node);
        let index = node.0 as usize;
        if let Some(id) = self.ids[index] {
            return id;
        }
        let text = self.texts[index].take().unwrap_or_else(|| Text::atom(self.literal(node)));
        let format = self.format(node);
        let name = self.module.wires[index].name.map(str::to_owned);
        let name = name.or_else(|| self.hints[index].clone()).or_else(|| self.state(node));
        let name = name.unwrap_or_else(|| describe::name(self.module, &self.hashes, node));
        let id = self.declare(&name, format.width, format.signed, &text, &format.to_string());
        self.ids[index] = Some(id);
        id
    }

    fn literal(&self, node: Node) -> String {
        let code = self.constant(node).expect("a wire has a text before it is needed");
        literal(code, self.format(node).width)
    }

    /// What to call the bit that says that a register is in a state.
    fn state(&self, node: Node) -> Option<String> {
        let Op::Equal(a, b) = self.module.wires[node.0 as usize].op else { return None };
        let Op::Register(index) = self.module.wires[self.source(a).0 as usize].op else {
            return None;
        };
        let Named { name, states, .. } = self.module.registers[index];
        let code = self.constant(b)?;
        Some(
            states
                .get(code as usize)
                .map_or(format!("{name}_is_{code}"), |state| format!("{name}_is_{state}")),
        )
    }

    /// Declares a wire.
    pub fn declare(
        &mut self,
        name: &str,
        width: u8,
        signed: bool,
        text: &Text,
        comment: &str,
    ) -> Id {
        let name = self.names.unique(name);
        let range = range(width, signed);
        let note = if comment.is_empty() { String::new() } else { format!(" // {comment}") };
        self.body.push(format!("    wire {range}{name} ={};{note}", broken(text, 8)));
        self.identifier(name, width, signed)
    }

    /// Bits of an identifier.
    pub fn slice(&mut self, id: Id, high: u8, low: u8) -> String {
        let declared = &mut self.declared[id.0];
        assert!(
            low <= high && high < declared.width,
            "{}[{high}:{low}] of {} bits",
            declared.name,
            declared.width
        );
        declared.used |= (u64::MAX >> (63 - (high - low))) << low;
        let name = &declared.name;
        match (high - low + 1 == declared.width, high == low) {
            (true, _) => name.clone(),
            (_, true) => format!("{name}[{high}]"),
            _ => format!("{name}[{high}:{low}]"),
        }
    }

    pub fn width(&self, id: Id) -> u8 {
        self.declared[id.0].width
    }

    pub fn signed(&self, id: Id) -> bool {
        self.declared[id.0].signed
    }

    /// All bits of a wire: its name, or its text in place.
    pub fn whole(&mut self, node: Node) -> Text {
        let node = self.source(node);
        let index = node.0 as usize;
        if let (None, Some(text)) = (self.ids[index], &self.texts[index]) {
            return text.clone();
        }
        if self.ids[index].is_none() {
            return Text::atom(self.literal(node));
        }
        let id = self.id(node);
        Text::atom(self.slice(id, self.width(id) - 1, 0))
    }

    /// The alternatives of a wire that is needed once and has no declaration.
    pub fn alternatives(&self, node: Node) -> Option<(Node, Node, Node)> {
        let index = self.source(node).0 as usize;
        match self.module.wires[index].op {
            Op::Select(bit, a, b) if self.ids[index].is_none() => Some((bit, a, b)),
            _ => None,
        }
    }

    /// Whether a wire is declared, and as a signed number.
    pub fn is_signed_name(&self, node: Node) -> bool {
        self.ids[self.source(node).0 as usize].is_some_and(|id| self.signed(id))
    }

    /// The bits that nothing needs.
    pub fn unused(&mut self) -> Vec<String> {
        let mut all = Vec::new();
        for index in 0..self.declared.len() {
            let Declared { width, used, .. } = self.declared[index];
            let mut low = 0;
            while low < width {
                let needed = |bit: u8| used >> bit & 1 == 1;
                let high = (low..width)
                    .take_while(|&bit| needed(bit) == needed(low))
                    .last()
                    .expect("its first");
                if !needed(low) {
                    all.push(self.slice(Id(index), high, low));
                }
                low = high + 1;
            }
        }
        all
    }
}

/// `signed [7:0] `, with a space behind, as a declaration has it.
pub fn range(width: u8, signed: bool) -> String {
    let sign = if signed { "signed " } else { "" };
    if width == 1 && !signed { String::new() } else { format!("{sign}[{}:0] ", width - 1) }
}
