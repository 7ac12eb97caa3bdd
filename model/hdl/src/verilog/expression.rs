// SPDX-License-Identifier: MIT OR Apache-2.0
//! Operations as Verilog expressions, every operand at the width and sign of its operation.

use super::scope::{Id, Scope};
use super::text::{BREAK, Kind, Text, literal};
use crate::format::Format;
use crate::interpretations::netlist::{Node, Op};

impl Scope<'_> {
    /// The text of a wire, put where it belongs.
    pub fn print(&mut self, node: Node) {
        let op = self.module.wires[node.0 as usize].op.clone();
        let to = self.format(node);
        let text = match op {
            Op::Constant(_)
            | Op::Input(_)
            | Op::Register(_)
            | Op::Data(_)
            | Op::Output(..)
            | Op::Scale(_) => return,
            Op::Add(a, b) => self.binary(a, "+", b, to),
            Op::Sub(a, b) => self.binary(a, "-", b, to),
            Op::Mul(a, b) => return self.product(node, a, b),
            Op::Abs(a) => self.magnitude(a),
            Op::Fit(a, rounding, overflow) => self.fit(node, a, rounding, overflow),
            Op::Bits(a, low) => self.bits(a, low, to.width),
            Op::Concat(a, b) => {
                Text::atom(format!("{{{}, {}}}", self.whole(a).text, self.whole(b).text))
            }
            Op::Less(a, b) => self.less(a, b),
            Op::Equal(a, b) => self.equal(a, b),
            Op::And(a, b) => Text::operation(format!(
                "{} & {}",
                self.whole(a).operand(),
                self.whole(b).operand()
            )),
            Op::Or(a, b) => Text::operation(format!(
                "{} | {}",
                self.whole(a).operand(),
                self.whole(b).operand()
            )),
            Op::Not(a) => Text::operation(format!("~{}", self.whole(a).operand())),
            Op::Select(bit, a, b) => self.select(bit, a, b, to),
        };
        self.keep(node, text, false);
    }

    /// A wire's code over a finer point, as bits of this width.
    pub fn extended(&mut self, node: Node, width: u8, frac: i8) -> Text {
        let format = self.format(node);
        let shift = (frac - format.frac) as u8;
        let above = width - format.width - shift;
        if let Some(code) = self.constant(node) {
            return Text::atom(literal(code << shift, width));
        }
        if shift == 0 && above == 0 {
            return self.whole(node);
        }
        let mut parts = vec![self.whole(node).text];
        if above > 0 && format.signed {
            let id = self.id(node);
            let name = self.slice(id, format.width - 1, 0);
            parts = vec![
                format!("{{{above}{{{}}}}}", self.slice(id, format.width - 1, format.width - 1)),
                name,
            ];
        } else if above > 0 {
            parts.insert(0, format!("{above}'d0"));
        }
        if shift > 0 {
            parts.push(format!("{shift}'d0"));
        }
        Text::atom(format!("{{{}}}", parts.join(", ")))
    }

    fn binary(&mut self, a: Node, sign: &str, b: Node, to: Format) -> Text {
        let [a, b] = [a, b].map(|node| self.extended(node, to.width, to.frac).operand());
        Text::operation(format!("{a} {sign} {b}"))
    }

    /// A product always has a wire of its own, which gives it its width.
    fn product(&mut self, node: Node, a: Node, b: Node) {
        let signed = self.format(a).signed || self.format(b).signed;
        let [a, b] = [a, b].map(|node| self.factor(node, signed));
        self.keep(node, Text::operation(format!("{a} * {b}")), true);
    }

    fn factor(&mut self, node: Node, signed: bool) -> String {
        let id = self.id(node);
        let name = self.slice(id, self.width(id) - 1, 0);
        match (signed, self.signed(id)) {
            (true, false) => format!("$signed({{1'b0, {name}}})"),
            _ => name,
        }
    }

    fn magnitude(&mut self, a: Node) -> Text {
        let width = self.format(a).width;
        let id = self.id(a);
        let (sign, name) = (self.slice(id, width - 1, width - 1), self.slice(id, width - 1, 0));
        if !self.format(a).signed {
            return Text::atom(name);
        }
        Text { text: format!("{sign} ? {width}'d0 - {name} : {name}"), kind: Kind::Select }
    }

    fn bits(&mut self, a: Node, low: u8, width: u8) -> Text {
        let id = self.id(a);
        let id = self.at_least(id, low + width);
        Text::atom(self.slice(id, low + width - 1, low))
    }

    /// The identifier, or a wider one with its sign in front.
    pub fn at_least(&mut self, id: Id, width: u8) -> Id {
        let (own, signed) = (self.width(id), self.signed(id));
        if own >= width {
            return id;
        }
        let name = self.slice(id, own - 1, 0);
        let fill = if signed { self.slice(id, own - 1, own - 1) } else { "1'b0".into() };
        let text = Text::atom(format!("{{{{{}{{{fill}}}}}, {name}}}", width - own));
        self.declare(&format!("{name}_wide"), width, signed, &text, "")
    }

    /// The format that holds both, at the finer point.
    fn common(&self, a: Node, b: Node) -> Format {
        self.format(a).join(self.format(b))
    }

    fn less(&mut self, a: Node, b: Node) -> Text {
        let to = self.common(a, b);
        let [a, b] = [a, b].map(|node| self.compared(node, to));
        Text::operation(format!("{a} < {b}"))
    }

    /// An operand of an order, which depends on its sign.
    fn compared(&mut self, node: Node, to: Format) -> String {
        let text = self.extended(node, to.width, to.frac);
        let as_it_is = !to.signed || (self.format(node) == to && self.is_signed_name(node));
        if as_it_is { text.operand() } else { format!("$signed({})", text.text) }
    }

    fn equal(&mut self, a: Node, b: Node) -> Text {
        let to = self.common(a, b);
        let [a, b] = [a, b].map(|node| self.extended(node, to.width, to.frac).operand());
        Text::operation(format!("{a} == {b}"))
    }

    fn select(&mut self, bit: Node, a: Node, b: Node, to: Format) -> Text {
        let bit = self.whole(bit).operand();
        let [a, b] = [a, b].map(|node| self.extended(node, to.width, to.frac));
        let otherwise = if b.kind == Kind::Select { b.text } else { b.operand() };
        Text { text: format!("{bit} ? {}{BREAK}: {otherwise}", a.operand()), kind: Kind::Select }
    }
}
