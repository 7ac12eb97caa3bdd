// SPDX-License-Identifier: MIT OR Apache-2.0
//! A wire with what drives it: which of its faults are none, because the printed text says so.
//!
//! - A bit that the module's wire `unused` names, or a zero that is printed as one, is not missed.
//! - An extension that does not reach the bits that are needed has no sign to lose.
//! - Of a sum whose upper bits are not needed, the rest may be the same with the other sign: modulo
//!   2^n, half of the range may be added or subtracted.
//! - A product of unsigned words has no sign to lose.

use std::collections::HashSet;

use super::Kind;
use super::kinds::{Variant, variants};

/// A declared wire of the printed Verilog.
pub struct Word<'a> {
    name: &'a str,
    value: &'a str,
    signed: bool,
    /// The highest bit.
    top: u8,
    /// How many of the upper bits nothing needs.
    above: u8,
    lowest_unused: bool,
}

impl<'a> Word<'a> {
    /// A wire of a range (`signed [7:0] `), in a module with these unused bits.
    pub fn new(range: &str, name: &'a str, value: &'a str, unused: &HashSet<String>) -> Self {
        let top = range.split(['[', ':']).nth(1).and_then(|top| top.parse().ok()).unwrap_or(0);
        let dead = |bit: u8| unused.iter().any(|part| has(part, name, bit));
        let above = (0..=top).rev().take_while(|&bit| dead(bit)).count() as u8;
        Word {
            name,
            value,
            signed: range.starts_with("signed"),
            top,
            above,
            lowest_unused: dead(0),
        }
    }

    /// What drives it, with each of its faults.
    pub fn variants(&self) -> Vec<Variant> {
        variants(self.value).into_iter().filter(|variant| self.matters(variant)).collect()
    }

    fn matters(&self, Variant { kind, printed, instead, .. }: &Variant) -> bool {
        let extension = printed.strip_prefix("{{").and_then(|rest| rest.split_once('{'));
        let extension: Option<u8> = extension.and_then(|(bits, _)| bits.parse().ok());
        match (kind, extension) {
            (Kind::Sign, Some(bits)) => bits > self.above,
            (Kind::Sign, None) if printed.len() == 1 => self.above < 2,
            (Kind::Sign, None) if instead.contains("* $unsigned") => self.signed,
            _ => true,
        }
    }

    /// Without its top bit, and without its lowest.
    pub fn narrow(&self) -> Vec<String> {
        let Word { name, top, .. } = *self;
        let mut all = Vec::new();
        if top > 0 && self.above == 0 && !self.value.starts_with("{1'd0, ") {
            let sign =
                if self.signed { format!("{name}_true[{}]", top - 1) } else { "1'b0".into() };
            all.push(format!("{{{sign}, {name}_true[{}:0]}}", top - 1));
        }
        if top > 0 && !self.lowest_unused && !self.value.ends_with("'d0}") {
            all.push(format!("{{{name}_true[{top}:1], 1'b0}}"));
        }
        all
    }
}

/// Whether a part of the wire `unused`, `name[high:low]` or `name[bit]`, has this bit.
fn has(part: &str, name: &str, bit: u8) -> bool {
    let bits = part.strip_prefix(name).and_then(|rest| rest.strip_prefix('[')?.strip_suffix(']'));
    let Some((high, low)) = bits.map(|bits| bits.split_once(':').unwrap_or((bits, bits))) else {
        return false;
    };
    matches!((low.parse::<u8>(), high.parse::<u8>()), (Ok(low), Ok(high)) if (low..=high).contains(&bit))
}
