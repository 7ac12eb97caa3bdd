// SPDX-License-Identifier: MIT OR Apache-2.0
//! Operations as terms of bit vectors, every operand at the width of its operation.

use super::bits::{extend, literal, width};
use super::fit;
use super::state::{At, Unrolled};
use crate::format::Format;
use crate::interpretations::netlist::{Node, Op};

/// One bit as a vector, of a Boolean term.
fn bit(term: &str) -> String {
    format!("(ite {term} #b1 #b0)")
}

impl Unrolled<'_> {
    /// The term of a wire at a clock: its name, defined where it is first needed.
    pub fn term(&mut self, at: At, node: Node) -> String {
        let wire = &self.module(at).wires[node.0 as usize];
        match wire.op {
            Op::Constant(code) => literal(code.into(), width(wire.format)),
            Op::Input(port) => self.input(at, port),
            Op::Register(index) => self.register(at, index),
            Op::Data(index) => self.word(at, index),
            Op::Output(instance, port) => self.output(at, instance, port),
            Op::Scale(a) => self.term(at, a),
            ref op => {
                let (op, format) = (op.clone(), wire.format);
                let sort = format!("(_ BitVec {})", width(format));
                self.define(at, ("wire", node), &sort, |unrolled| {
                    unrolled.operation(at, op, format)
                })
            }
        }
    }

    /// Whether a bit is set at a clock, as a Boolean term.
    pub fn is_set(&mut self, at: At, node: Node) -> String {
        format!("(= {} #b1)", self.term(at, node))
    }

    fn operation(&mut self, at: At, op: Op, to: Format) -> String {
        match op {
            Op::Add(a, b) => self.binary(at, "bvadd", (a, b), to),
            Op::Sub(a, b) => self.binary(at, "bvsub", (a, b), to),
            Op::Mul(a, b) => {
                let [a, b] = [a, b].map(|node| self.code(at, node, width(to)));
                format!("(bvmul {a} {b})")
            }
            Op::Abs(a) => self.magnitude(at, a),
            Op::Fit(a, rounding, overflow) => {
                let (term, from) = (self.term(at, a), self.format(at, a));
                fit::round(&term, from, to, rounding).narrow(to, overflow)
            }
            Op::Bits(a, low) => {
                let high = u32::from(low) + width(to) - 1;
                let wide = width(self.format(at, a)).max(high + 1);
                format!("((_ extract {high} {low}) {})", self.code(at, a, wide))
            }
            Op::Concat(a, b) => format!("(concat {} {})", self.term(at, a), self.term(at, b)),
            Op::Less(a, b) => {
                let join = self.format(at, a).join(self.format(at, b));
                let less = if join.signed { "bvslt" } else { "bvult" };
                bit(&self.binary(at, less, (a, b), join))
            }
            Op::Equal(a, b) => {
                let join = self.format(at, a).join(self.format(at, b));
                bit(&self.binary(at, "=", (a, b), join))
            }
            Op::And(a, b) => format!("(bvand {} {})", self.term(at, a), self.term(at, b)),
            Op::Or(a, b) => format!("(bvor {} {})", self.term(at, a), self.term(at, b)),
            Op::Not(a) => format!("(bvnot {})", self.term(at, a)),
            Op::Select(bit, a, b) => {
                let bit = self.is_set(at, bit);
                let [a, b] = [a, b].map(|node| self.number(at, node, to));
                format!("(ite {bit} {a} {b})")
            }
            Op::Constant(_)
            | Op::Input(_)
            | Op::Register(_)
            | Op::Data(_)
            | Op::Output(..)
            | Op::Scale(_) => unreachable!("not an operation"),
        }
    }

    fn binary(&mut self, at: At, operation: &str, (a, b): (Node, Node), to: Format) -> String {
        let [a, b] = [a, b].map(|node| self.number(at, node, to));
        format!("({operation} {a} {b})")
    }

    fn magnitude(&mut self, at: At, a: Node) -> String {
        let (term, format) = (self.term(at, a), self.format(at, a));
        if !format.signed {
            return term;
        }
        format!("(ite (bvslt {term} {}) (bvneg {term}) {term})", literal(0, width(format)))
    }

    /// A wire's code in this many bits.
    fn code(&mut self, at: At, node: Node, to: u32) -> String {
        extend(&self.term(at, node), self.format(at, node), to)
    }

    /// A wire's number as a code of a format with as many fractional bits or more.
    fn number(&mut self, at: At, node: Node, to: Format) -> String {
        let format = self.format(at, node);
        if format.is_none() {
            return literal(0, width(to));
        }
        match (i32::from(to.frac) - i32::from(format.frac)) as u32 {
            0 => self.code(at, node, width(to)),
            zeros => {
                let code = self.code(at, node, width(to) - zeros);
                format!("(concat {code} {})", literal(0, zeros))
            }
        }
    }
}
