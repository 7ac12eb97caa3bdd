// SPDX-License-Identifier: MIT OR Apache-2.0
//! Quotients and square roots as lines of a program, digit by digit.

use super::translate::Translation;
use super::writer::Slot;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::expression::Term;
use hapticore_hdl::interpretations::range::Range;

/// Bits of remainder and digits side by side: a quotient of more is made in parts.
const SIDE_BY_SIDE: u32 = 31;
/// Digits of a part at least, whatever the remainder has.
const LEAST_DIGITS: u32 = 4;

impl Translation<'_> {
    /// Restoring division, as the divider's: remainder and digits are side by side in the sum, and
    /// quotients with many digits are made part by part.
    pub(super) fn quotient(&mut self, numerator: Term, denominator: Term, to: Format) {
        let (n, d) = (self.format(numerator), self.format(denominator));
        let pad = i32::from(to.frac) - i32::from(n.frac) + i32::from(d.frac);
        let digits = u32::from(to.width);
        let most = SIDE_BY_SIDE.saturating_sub(d.width.into()).max(LEAST_DIGITS);
        let parts = digits.div_ceil(most);
        let part = digits.div_ceil(parts);
        let [numerator, denominator] = [numerator, denominator].map(|term| self.operand(term));
        let fits = self.fits(numerator, denominator, pad - digits as i32);
        let dividend = self.where_it_fits(numerator, denominator, fits, pad - digits as i32);
        let (mut quotient, mut rest, mut left) = (Slot::Constant(0), Slot::Constant(0), digits);
        while left > 0 {
            let now = part.min(left);
            left -= now;
            self.scaled_word(denominator, now as i32);
            let divisor = self.writer.keep();
            match left + now == digits {
                true => self.scaled_word(dividend, pad - left as i32),
                false => self.next_part(dividend, pad - left as i32, now, rest),
            }
            self.writer.digits(now as u8, divisor);
            let both = self.writer.keep();
            self.writer.shift(-(now as i32));
            rest = self.writer.keep();
            self.writer.load(both);
            self.writer.low_bits(now);
            quotient = self.joined(quotient, now);
        }
        self.rounded_quotient(quotient, rest, denominator);
        let most = Slot::Constant(to.max_code() as i64);
        self.writer.at_most(most);
        let rounded = self.writer.keep();
        self.writer.load(most);
        self.writer.test(fits);
        self.writer.load_if(rounded);
    }

    /// sum ← word · 2^by, rounded down
    fn scaled_word(&mut self, word: Slot, by: i32) {
        self.writer.load(word);
        self.writer.shift(by);
    }

    /// Whether the quotient is not too large: numerator · 2^by, rounded down, is below the denominator.
    fn fits(&mut self, numerator: Slot, denominator: Slot, by: i32) -> Slot {
        if by > 0 {
            // That is, numerator ≤ (denominator − 1) / 2^by, rounded down.
            self.writer.load(denominator);
            self.writer.subtract(Slot::Constant(1));
            self.writer.shift(-by);
            let most = self.writer.keep();
            self.writer.load(numerator);
            self.writer.subtract(most);
            self.writer.subtract(Slot::Constant(1));
        } else {
            self.scaled_word(numerator, by);
            self.writer.subtract(denominator);
        }
        self.writer.negative();
        self.writer.keep()
    }

    /// The numerator, or 0 where the quotient is too large.
    fn where_it_fits(&mut self, numerator: Slot, denominator: Slot, fits: Slot, by: i32) -> Slot {
        self.writer.load(Slot::Constant(0));
        self.writer.test(fits);
        self.writer.load_if(numerator);
        let most = self.writer.range(denominator).high;
        self.writer.know(Range { low: 0, high: if by > 0 { most >> by } else { most << -by } });
        self.writer.keep()
    }

    /// sum ← the remainder with the dividend's bits of the next part behind it.
    fn next_part(&mut self, dividend: Slot, by: i32, now: u32, rest: Slot) {
        if by >= now as i32 {
            return self.scaled_word(rest, now as i32);
        }
        self.scaled_word(dividend, by);
        self.writer.low_bits(now);
        let bits = self.writer.keep();
        self.scaled_word(rest, now as i32);
        self.writer.add(bits);
    }

    /// The digits so far, with those of the sum behind them.
    fn joined(&mut self, quotient: Slot, digits: u32) -> Slot {
        if quotient == Slot::Constant(0) {
            return self.writer.keep();
        }
        let last = self.writer.keep();
        self.scaled_word(quotient, digits as i32);
        self.writer.add(last);
        self.writer.keep()
    }

    /// sum ← the quotient, rounded up where twice the remainder is past the denominator, or just there
    /// and the quotient odd.
    fn rounded_quotient(&mut self, quotient: Slot, rest: Slot, denominator: Slot) {
        self.scaled_word(rest, 1);
        self.writer.subtract(denominator);
        let past = self.writer.keep();
        self.writer.zero();
        let there = self.writer.keep();
        self.writer.load(quotient);
        self.writer.low_bits(1);
        self.writer.at_most(there);
        let tie = self.writer.keep();
        self.writer.load(Slot::Constant(0));
        self.writer.subtract(past);
        self.writer.negative();
        self.writer.at_least(tie);
        self.writer.add(quotient);
    }

    /// Bit by bit from above: a bit is set where the square still is not larger than the radicand.
    pub(super) fn root(&mut self, radicand: Term, to: Format) {
        let of = self.format(radicand);
        let digits = (of.integer_bits() + 1) / 2 + i16::from(to.frac);
        self.sum(radicand);
        self.writer.shift(2 * i32::from(to.frac) - i32::from(of.frac));
        let whole = self.writer.keep();
        self.writer.add(Slot::Constant(1));
        let limit = self.writer.keep();
        let (most, all) = ((1 << digits) - 1, Range { low: 0, high: 1 << digits });
        let roots = Range { low: 0, high: most };
        self.writer.load(Slot::Constant(1 << digits));
        let bit = self.writer.variable(all);
        self.writer.load(Slot::Constant(0));
        let root = self.writer.variable(roots);
        self.writer.turns(digits as u8, all, |writer| {
            writer.load(bit);
            writer.shift(-1);
            writer.store(bit);
            writer.add(root);
            writer.know(roots);
            let trial = writer.keep();
            writer.multiply(trial);
            writer.subtract(limit);
            writer.test_negative();
            writer.load(root);
            writer.load_if(trial);
            writer.store(root);
        });
        // Up where the radicand is past n² + n, for (n + ½)² = n² + n + ¼.
        self.writer.load(root);
        self.writer.multiply(root);
        self.writer.add(root);
        self.writer.subtract(whole);
        self.writer.negative();
        self.writer.add(root);
        self.writer.know(Range { low: 0, high: 1 << digits });
    }
}
