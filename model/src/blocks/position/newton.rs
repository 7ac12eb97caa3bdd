// SPDX-License-Identifier: MIT OR Apache-2.0
//! A Newton step: the determinant of the slopes, and for either axis a minor over it.
//!
//! ```text
//! det = X_u·Y_v − X_v·Y_u,   Δu = (Y_v·e_x − X_v·e_y) / det,   Δv = (X_u·e_y − Y_u·e_x) / det      (e = measured − value)
//! ```
//!
//! | clock of a minor, L clocks a product | what is made |
//! | --- | --- |
//! | 0 … 3 | asks for the four factors, which are `word` in clocks 2 … 5 |
//! | 2, 3; 4, 5 | left and right of the first product; of the second |
//! | 4 + L | minor = the first product |
//! | 6 + L | minor = minor − the second product |
//! | 7 + L | the determinant is taken, or the division begins |

use super::layout::Axis;
use super::slots::{ALONG_U, ALONG_V, RESIDUAL};
use super::{Position, Registers, task};
use crate::signal::{Exact, Never, Saturate, Signal, Value, Wrap, bit, code, int};
use crate::when;

/// The minors, in their order.
pub const DETERMINANT: u64 = 0;
pub const ALONG_U_STEP: u64 = 1;
pub const ALONG_V_STEP: u64 = 2;

/// Of each minor the factors' places in the scratch memory: the first product's, then the second's.
const FACTORS: [[u64; 4]; 3] = [
    [ALONG_U, ALONG_V + 1, ALONG_V, ALONG_U + 1],
    [ALONG_V + 1, RESIDUAL, ALONG_V, RESIDUAL + 1],
    [ALONG_U, RESIDUAL + 1, ALONG_U + 1, RESIDUAL],
];

impl Position {
    /// Clocks of a minor.
    pub(super) fn cross_clocks(&self) -> u64 {
        8 + self.multiplier.latency()
    }

    /// Where the factor that a clock asks for lies.
    #[inline(always)]
    pub(super) fn operand_slot<V: Value>(&self, now: &Registers<Signal<V>>) -> Signal<V> {
        let factor = |of: &[u64; 4]| {
            let slot = |k: usize| code(of[k] as i64, now.slot.format);
            let pair = |k: usize| now.clock.bits(0, 1).select(slot(k + 1), slot(k));
            now.clock.bits(1, 1).select(pair(2), pair(0))
        };
        let [determinant, u, v] = [0, 1, 2].map(|which: usize| factor(&FACTORS[which]));
        now.cross.is(DETERMINANT).select(determinant, now.cross.is(ALONG_U_STEP).select(u, v))
    }

    /// A clock of a minor.
    #[inline(always)]
    pub(super) fn cross<V: Value>(
        &self,
        next: Registers<Signal<V>>,
        now: &Registers<Signal<V>>,
        product: Signal<V>,
    ) -> Registers<Signal<V>> {
        let at = |clock: u64| now.clock.is(clock);
        let wait = self.multiplier.latency();
        let end = at(self.cross_clocks() - 1);
        let minor = self.of_slopes(product);
        let difference = (now.minor - minor).fit(now.minor.format, Exact, Never);
        let next = Registers {
            left: (at(2) | at(4)).select(now.word, now.left),
            right: (at(3) | at(5)).select(now.word, now.right),
            ..next
        };
        when!(
            V,
            Registers,
            at(4 + wait) => Registers { minor, ..next },
            at(6 + wait) => Registers { minor: difference, ..next },
            end => self.take_minor(next, now),
            else next
        )
    }

    /// The last clock of a minor: the determinant is taken, or the division begins.
    #[inline(always)]
    fn take_minor<V: Value>(&self, next: Registers<Signal<V>>, now: &Registers<Signal<V>>) -> Registers<Signal<V>> {
        let of_determinant = now.cross.is(DETERMINANT);
        let taken = Registers {
            determinant: self.magnitude(now),
            negative: now.minor.msb(),
            cross: int(ALONG_U_STEP),
            clock: int(0),
            ..next
        };
        let divides = self.enter(Registers { divide: bit(true), ..next }, task::DIVIDE);
        when!(V, Registers, of_determinant, taken, divides)
    }

    /// The place moves along one axis; then along the other, or the surfaces are looked up again.
    #[inline(always)]
    pub(super) fn step<V: Value>(&self, r: Registers<Signal<V>>, quotient: Signal<V>) -> Registers<Signal<V>> {
        let of_v = r.cross.is(ALONG_V_STEP).named("of_v");
        let backwards = (r.minor.msb() & !r.negative) | (!r.minor.msb() & r.negative);
        let by = backwards.named("backwards").select(-quotient, quotient);
        let moved = self.held(of_v.select(r.place_v, r.place_u) + by, of_v);
        let stepped = Registers {
            place_u: of_v.select(r.place_u, moved),
            place_v: of_v.select(moved, r.place_v),
            cross: int(ALONG_V_STEP),
            ..r
        };
        let again = Registers { pass: (r.pass + int(1)).fit(r.pass.format, Exact, Wrap), surface: int(0), ..stepped };
        when!(V, Registers, of_v, self.enter(again, task::ADDRESS), self.enter(stepped, task::CROSS))
    }

    /// A place held within the table: at least zero, less than its cells.
    #[inline(always)]
    fn held<V: Value>(&self, place: Signal<V>, of_v: Signal<V>) -> Signal<V> {
        let format = self.formats.place;
        let last = |axis| code(((self.layout.cells(axis) as i64) << format.frac) - 1, format);
        let most = of_v.select(last(Axis::Y), last(Axis::X));
        place.fit(format, Exact, Saturate).at_most(most)
    }
}
