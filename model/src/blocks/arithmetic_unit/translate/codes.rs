// SPDX-License-Identifier: MIT OR Apache-2.0
//! The codes that nodes have: their ranges, and which have that of another.

use super::Translation;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::expression::{Expression, Op, Place, Term};
use hapticore_hdl::interpretations::range::{Range, take_assumptions, take_violations, whole};
use hapticore_hdl::signal::{Exact, Overflow, Proved, Rounding, Value};
use std::collections::HashMap;

impl Translation<'_> {
    /// Which words hold nothing but a signed code, whose bits are read in its format again: such a code is
    /// stored as it is.
    pub(super) fn look_at_words(&mut self) {
        let written = self.expression.written.iter();
        let signed = written.filter_map(|(place, term)| {
            let (of, format) = self.all_bits_of(*term)?;
            let reads = |user: Term| self.reads_again(user, format);
            let word = self.word_of(*place)?;
            let is_signed = self.format(of).signed && self.users_of(word).into_iter().all(reads);
            is_signed.then_some((*place, format))
        });
        self.signed = signed.collect();
    }

    fn word_of(&self, place: Place) -> Option<Term> {
        let nodes = &self.expression.nodes;
        nodes.iter().position(|node| node.op == Op::Word(place)).map(|word| Term(word as u32))
    }

    /// The code all of whose bits a word is given, and its format as an integer.
    fn all_bits_of(&self, term: Term) -> Option<(Term, Format)> {
        match self.op(term) {
            Op::Fit(bits, Rounding::Exact, Proved) => self.all_bits_of(bits),
            Op::Bits(of, 0) if self.format(of).width == self.format(term).width => {
                Some((of, self.format(of).integer()))
            }
            _ => None,
        }
    }

    /// Whether bits of a word are those of a signed code, and are read in its format alone.
    fn reads_again(&self, bits: Term, format: Format) -> bool {
        let again = |user: Term| {
            let to = self.format(user);
            matches!(self.op(user), Op::Fit(_, Rounding::Exact, Overflow::Wrap)) && to == format
        };
        matches!(self.op(bits), Op::Bits(_, 0))
            && self.format(bits).width == format.width
            && self.users_of(bits).into_iter().all(again)
    }

    /// The nodes that depend on one, of those that matter.
    fn users_of(&self, term: Term) -> Vec<Term> {
        let all = (0..self.expression.nodes.len() as u32).map(Term);
        let live = all.filter(|user| self.live[user.0 as usize]);
        live.filter(|user| self.op(*user).operands().contains(&term)).collect()
    }

    /// What a word is given, as it holds it.
    pub(super) fn kept(&self, place: Place, term: Term) -> Term {
        let code = self.signed.contains_key(&place).then(|| self.all_bits_of(term)).flatten();
        self.base(code.map_or(term, |(of, _)| of))
    }

    pub(super) fn find_ranges(&mut self) {
        let words = self.width_of_words();
        for number in 0..self.expression.nodes.len() {
            let node = self.expression.nodes[number];
            let range = match node.op {
                Op::Word(place) => match (self.signed.get(&place), words.get(&place)) {
                    (Some(format), _) => whole(*format),
                    (_, Some(Some(width))) => whole(Format::unsigned(*width, 0)),
                    _ => whole(node.format),
                },
                _ => self.range_of(node.op, node.format),
            };
            self.ranges.push(range);
        }
        // What is declared impossible is so for reasons that intervals do not see.
        take_violations();
        take_assumptions();
    }

    /// Whether what a word is given has no more bits than these.
    fn is_given_within(&self, place: Place, width: u8) -> bool {
        let Some(mut term) = self.expression.written.get(&place).copied() else { return true };
        while let Op::Fit(of, Rounding::Exact, Proved) = self.op(term) {
            term = of;
        }
        let format = self.format(term);
        !format.signed && format.frac == 0 && format.width <= width
    }

    /// Of words that are read by their low bits alone, and hold no more, how many.
    fn width_of_words(&self) -> HashMap<Place, Option<u8>> {
        let mut widths = HashMap::new();
        for (node, _) in self.expression.nodes.iter().zip(&self.live).filter(|(_, live)| **live) {
            if let Op::Bits(word, low) = node.op
                && let Op::Word(place) = self.op(word)
            {
                let width = node.format.width;
                let fits = low == 0 && self.is_given_within(place, width);
                let width = fits.then_some(width);
                let known = widths.entry(place).or_insert(width);
                *known = if *known == width { width } else { None };
            }
        }
        widths
    }

    fn range_of(&self, op: Op, to: Format) -> Range {
        let of = |term: Term| self.signal(term);
        match op {
            Op::Constant(code) => Range::point(code.into()),
            Op::Input(_) | Op::Word(_) | Op::Lookup(..) | Op::Quotient(..) | Op::Root(_) => {
                whole(to)
            }
            Op::Add(a, b) => Range::add(of(a), of(b), to),
            Op::Sub(a, b) => Range::sub(of(a), of(b), to),
            Op::Mul(a, b) => Range::mul(of(a), of(b), to),
            Op::Abs(a) => <Range as Value>::abs(of(a), to),
            Op::Fit(a, rounding, overflow) => Range::quantize(of(a), to, rounding, overflow),
            Op::Scale(a) => self.range(a),
            Op::Bits(a, low) => Range::bits(of(a), low, to),
            Op::Concat(a, b) => Range::concat(of(a), of(b), to),
            Op::Less(a, b) => Range::less(of(a), of(b)),
            Op::Equal(a, b) => Range::equal(of(a), of(b)),
            Op::And(a, b) => Range::and(self.range(a), self.range(b)),
            Op::Or(a, b) => Range::or(self.range(a), self.range(b)),
            Op::Not(a) => Range::not(self.range(a)),
            Op::Select(_, a, b) => self.range(a).join(self.range(b)),
        }
    }

    /// What a narrowing has before it overflows.
    pub(super) fn before_overflow(&self, a: Term, to: Format, rounding: Rounding) -> Range {
        let wide = Format { signed: true, width: 120, ..to };
        Range::quantize(self.signal(a), wide, rounding, Proved)
    }

    /// The node whose code this one's is.
    pub(in super::super) fn base(&self, term: Term) -> Term {
        let to = self.format(term);
        match self.op(term) {
            Op::Scale(a) => self.base(a),
            Op::Fit(bits, Exact, Overflow::Wrap) if self.signed_word(bits).is_some() => {
                self.signed_word(bits).expect("just seen")
            }
            Op::Fit(a, rounding, overflow) if self.format(a).frac == to.frac => {
                let fits = whole(to).holds(self.before_overflow(a, to, rounding));
                let sure = matches!(overflow, Proved | Overflow::Assumed(_));
                if fits || sure { self.base(a) } else { term }
            }
            Op::Bits(a, 0) if whole(to).holds(self.range(a)) => self.base(a),
            _ => term,
        }
    }

    /// The word, where bits are those of one that holds a signed code.
    fn signed_word(&self, bits: Term) -> Option<Term> {
        let Op::Bits(word, 0) = self.op(bits) else { return None };
        let Op::Word(place) = self.op(word) else { return None };
        self.signed.contains_key(&place).then_some(word)
    }
}

/// Which nodes results depend on.
pub(super) fn live(expression: &Expression) -> Vec<bool> {
    let mut live = vec![false; expression.nodes.len()];
    let results = expression.results.iter().map(|(_, term)| term);
    let mut open: Vec<Term> = results.chain(expression.written.values()).copied().collect();
    while let Some(term) = open.pop() {
        if !std::mem::replace(&mut live[term.0 as usize], true) {
            open.extend(expression.node(term).op.operands());
        }
    }
    live
}
