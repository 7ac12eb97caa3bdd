// SPDX-License-Identifier: MIT OR Apache-2.0
//! The first guess: of some cells, the one whose middle coefficients are nearest to the ratios, by absolute differences.
//!
//! | clock | address | word | deviation | partial | distance |
//! | --- | --- | --- | --- | --- | --- |
//! | 0 | of x | | | | |
//! | 1 | of y | | | | |
//! | 2 | | x | | | |
//! | 3 | | y | of x | | |
//! | 4 | | | of y | of x | |
//! | 5 | | | | | of both, compared with the least |

use super::layout::{Axis, Surface};
use super::{Inputs, Position, Registers, task};
use crate::format::Format;
use crate::signal::{Exact, Never, Signal, Value, Wrap, bit, code, int};
use crate::{choose, when};

/// Clocks of a guess.
pub const CLOCKS: u64 = 6;

impl Position {
    /// The first clock of all: the first guess, and no distance yet.
    #[inline(always)]
    pub(super) fn begin<V: Value>(&self, r: Registers<Signal<V>>) -> Registers<Signal<V>> {
        let [u, v] = self.guesses().map(|guesses| guesses.first);
        let first = Registers {
            pass: int(0),
            surface: int(Surface::RatioX as u64),
            address: int(self.middle_coefficient(u, v) as u64),
            guess_u: int(u as u64),
            guess_v: int(v as u64),
            least: code(self.registers.least.max_code() as i64, r.least.format),
            saturated: bit(false),
            ..r
        };
        self.enter(first, task::SEARCH)
    }

    /// Where the coefficient of r_x in the middle of a cell lies.
    fn middle_coefficient(&self, u: usize, v: usize) -> usize {
        let columns = self.layout.coefficients(Surface::RatioX, Axis::X);
        self.layout.surface(Surface::RatioX) + (v + 1) * columns + u + 1
    }

    /// A clock of a guess.
    #[inline(always)]
    pub(super) fn search<V: Value>(
        &self,
        next: Registers<Signal<V>>,
        i: &Inputs<Signal<V>>,
        now: &Registers<Signal<V>>,
    ) -> Registers<Signal<V>> {
        let at = |clock: u64| now.clock.is(clock);
        let magnitude = now.deviation.abs();
        let compared = Registers {
            address: at(0).select(self.moved(now.address, self.plane() as i64), now.address),
            deviation: {
                let measured = at(2).select(i.r_x, i.r_y);
                (measured - now.word.as_code(self.formats.word)).fit(now.deviation.format, Exact, Never)
            },
            partial: at(3).select(magnitude, now.partial),
            distance: at(4).select((now.partial + magnitude).fit(now.distance.format, Exact, Never), now.distance),
            ..next
        };
        when!(V, Registers, at(CLOCKS - 1), self.compare(next, now), compared)
    }

    /// The last clock of a guess: the nearest so far, and where to look next.
    #[inline(always)]
    fn compare<V: Value>(&self, next: Registers<Signal<V>>, now: &Registers<Signal<V>>) -> Registers<Signal<V>> {
        let nearer = now.distance.less_than(now.least).named("nearer");
        let [u, v] = self.guesses();
        let [last_u, last_v] = [u, v].map(|axis| axis.first + (axis.count - 1) * axis.stride);
        let row_ends = now.guess_u.is(last_u as u64).named("row_ends");
        let ends = (row_ends & now.guess_v.is(last_v as u64)).named("search_ends");
        let columns = self.layout.coefficients(Surface::RatioX, Axis::X);
        let along = u.stride as i64 - self.plane() as i64;
        let to_next_row = (v.stride * columns) as i64 - (last_u - u.first) as i64 - self.plane() as i64;
        let following = |guess: Signal<V>, stride: usize| (guess + int(stride as u64)).fit(guess.format, Exact, Wrap);
        let guessed = Registers {
            least: nearer.select(now.distance, now.least),
            place_u: choose!(V, nearer, self.middle(now.guess_u), now.place_u),
            place_v: choose!(V, nearer, self.middle(now.guess_v), now.place_v),
            guess_u: row_ends.select(int(u.first as u64), following(now.guess_u, u.stride)),
            guess_v: row_ends.select(following(now.guess_v, v.stride), now.guess_v),
            address: row_ends.select(self.moved(now.address, to_next_row), self.moved(now.address, along)),
            ..next
        };
        let again = Registers { clock: int(0), ..guessed };
        let ended = Registers { address: now.address, ..guessed };
        when!(V, Registers, ends, self.enter(ended, task::ADDRESS), again)
    }

    /// Words from a coefficient of r_x to that of r_y.
    fn plane(&self) -> usize {
        self.layout.surface(Surface::RatioY) - self.layout.surface(Surface::RatioX)
    }

    /// An address some words on, or back.
    #[inline(always)]
    fn moved<V: Value>(&self, address: Signal<V>, by: i64) -> Signal<V> {
        let by = by.rem_euclid(1 << address.format.width) as u64;
        (address + int(by)).fit(address.format, Exact, Wrap)
    }

    /// The middle of a cell.
    #[inline(always)]
    fn middle<V: Value>(&self, cell: Signal<V>) -> Signal<V> {
        let frac = self.formats.place.frac;
        let half = code(1 << (frac - 1), Format::unsigned(frac as u8, 0));
        cell.concat(half).scaled(-frac).fit(self.formats.place, Exact, Never)
    }
}
