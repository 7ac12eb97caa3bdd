// SPDX-License-Identifier: MIT OR Apache-2.0
//! What registers take at a clock, as a designer would write it: alternatives that several
//! registers share become `if … else`, and a register that keeps its value is not mentioned.

use super::scope::Scope;
use super::text::broken;
use crate::format::Format;
use crate::interpretations::netlist::{Node, Op};
use std::fmt::Write;

/// What a register takes next.
#[derive(Debug, Clone)]
pub struct Next {
    pub name: String,
    /// The register as a wire's source: taking that is to keep the value.
    pub own: Op,
    pub node: Node,
    pub format: Format,
}

impl Scope<'_> {
    /// The statements for these registers.
    pub fn statements(&mut self, mut nexts: Vec<Next>, indent: usize) -> String {
        nexts.retain(|next| !self.keeps(next));
        let Some(bit) = self.shared_condition(&nexts) else {
            return nexts.iter().map(|next| self.assignment(next, indent)).collect();
        };
        let decided = |scope: &Self, next: &Next| {
            scope.alternatives(next.node).is_some_and(|(own, ..)| own == bit)
        };
        let (branched, others): (Vec<Next>, Vec<Next>) =
            nexts.into_iter().partition(|next| decided(self, next));
        let mut text = self.statements(others, indent);
        let side = |scope: &Self, set: bool| -> Vec<Next> {
            branched
                .iter()
                .map(|next| {
                    scope.sides(next).expect("they are branched")[usize::from(!set)].clone()
                })
                .collect()
        };
        let (set, unset) = (side(self, true), side(self, false));
        let (set, unset) = (self.statements(set, indent + 4), self.statements(unset, indent + 4));
        let condition = self.whole(bit);
        text += &alternatives(&condition.text, &condition.operand(), &set, &unset, indent);
        text
    }

    fn keeps(&self, next: &Next) -> bool {
        let op = &self.module.wires[self.source(next.node).0 as usize].op;
        *op == next.own && self.format(next.node).frac == next.format.frac
    }

    /// What the register takes in either case. A point that was moved after the choice moves in
    /// both.
    fn sides(&self, next: &Next) -> Option<[Next; 2]> {
        let (_, a, b) = self.alternatives(next.node)?;
        let moved = self.format(self.source(next.node)).frac - self.format(next.node).frac;
        let format = Format { frac: next.format.frac + moved, ..next.format };
        Some([a, b].map(|node| Next { node, format, ..next.clone() }))
    }

    fn assignment(&mut self, next: &Next, indent: usize) -> String {
        let value = self.extended(next.node, next.format.width, next.format.frac);
        format!("{:indent$}{} <={};\n", "", next.name, broken(&value, indent + 4))
    }

    /// The condition that most of them hang on, where an `if` says more than an expression.
    fn shared_condition(&self, nexts: &[Next]) -> Option<Node> {
        let mut counts: Vec<(Node, usize)> = Vec::new();
        for next in nexts {
            let Some(((bit, ..), sides)) = self.alternatives(next.node).zip(self.sides(next))
            else {
                continue;
            };
            let weight = if sides.iter().any(|side| self.keeps(side)) { 2 } else { 1 };
            match counts.iter_mut().find(|(known, _)| *known == bit) {
                Some((_, count)) => *count += weight,
                None => counts.push((bit, weight)),
            }
        }
        let most = counts.iter().map(|&(_, count)| count).max().filter(|&count| count > 1)?;
        counts.iter().find(|&&(_, count)| count == most).map(|&(bit, _)| bit)
    }
}

/// `if … else …`, with what is empty left out and an `if` alone in the other branch pulled up.
fn alternatives(condition: &str, operand: &str, set: &str, unset: &str, indent: usize) -> String {
    let mut text = String::new();
    let (condition, set, unset) = match (set.is_empty(), unset.is_empty()) {
        (true, true) => return text,
        (true, false) => (format!("~{operand}"), unset, ""),
        _ => (condition.to_owned(), set, unset),
    };
    let _ = write!(text, "{:indent$}if ({condition}) begin\n{set}{:indent$}end", "", "");
    if unset.is_empty() {
        return text + "\n";
    }
    let inner = format!("{:width$}if (", "", width = indent + 4);
    let close = format!("\n{:width$}end\n", "", width = indent + 4);
    let alone = unset.starts_with(&inner)
        && unset.find(&close).is_some_and(|at| at + close.len() == unset.len());
    if alone {
        let pulled: Vec<&str> = unset.lines().map(|line| &line[4..]).collect();
        return text + " else " + pulled.join("\n").trim_start() + "\n";
    }
    let _ = writeln!(text, " else begin\n{unset}{:indent$}end", "");
    text
}

#[cfg(test)]
mod tests;
