// SPDX-License-Identifier: MIT OR Apache-2.0
//! The worst slot of two runs.
//!
//! All slots are evaluated where that is cheap compared with what a core does in them. Where it is
//! not (a series at every place, the samples of a window), some are. These are the slots in which a
//! pad is nearest to a terminal or to an edge, or has the most or the least of a quantity. Others
//! are spread over the case without a period that a sweep or the pads' turns could share. Around
//! the worst of them neighbours are searched, by steps that halve.

use std::collections::HashMap;

use super::norm::Quantities;

/// What looking at a slot may cost on average, and at all, ns.
const SLOT_NS: f64 = 10e3;
const ALL_NS: f64 = 20e6;

/// The fewest slots that are evaluated.
const FEWEST: usize = 64;

/// How many of the worst slots are searched around.
const AROUND: usize = 4;

/// How many slots may be evaluated where each costs `look_ns`.
pub(super) fn affordable(slots: usize, look_ns: f64) -> usize {
    let total_ns = (slots as f64 * SLOT_NS).max(ALL_NS);
    slots.min((total_ns / look_ns) as usize).max(FEWEST)
}

/// Slots in which something is at its extreme: quantities, and the distance to each terminal.
pub(super) fn extremes(slots: &[Quantities], terminals_mm: &[[f64; 2]]) -> Vec<usize> {
    let least = |of: &dyn Fn(&Quantities) -> f64| {
        let costs = slots.iter().map(of).enumerate().filter(|(_, cost)| !cost.is_nan());
        costs.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(slot, _)| slot)
    };
    let quantities =
        (0..6).flat_map(|n| [least(&move |slot| slot[n]), least(&move |slot| -slot[n])]);
    let terminals = terminals_mm
        .iter()
        .map(|[x, y]| least(&move |slot: &Quantities| (slot[0] - x).hypot(slot[1] - y)));
    quantities.chain(terminals).flatten().collect()
}

/// A search over slots, of which it evaluates at most `looks` before it is refined.
pub(super) struct Search<'a> {
    pub slots: usize,
    pub looks: usize,
    /// Slots to look at first.
    pub first: &'a [usize],
    /// Pads, which slots serve in turn.
    pub pads: usize,
    /// The search ends where a slot is worse than this.
    pub enough: f64,
}

impl Search<'_> {
    /// The worst slot's value.
    pub fn worst<E>(&self, mut of: impl FnMut(usize) -> Result<f64, E>) -> Result<f64, E> {
        let mut known = HashMap::new();
        for slot in self.spread() {
            let value = of(slot)?;
            known.insert(slot, value);
            if value > self.enough {
                return Ok(value);
            }
        }
        if self.looks < self.slots {
            self.refine(&mut known, &mut of)?;
        }
        Ok(known.into_values().fold(0.0, f64::max))
    }

    /// All slots, or those to look at first and others by the golden section.
    fn spread(&self) -> Vec<usize> {
        if self.looks >= self.slots {
            return (0..self.slots).collect();
        }
        let golden =
            |n: usize| ((n as f64 * 0.618_033_988_749_895).fract() * self.slots as f64) as usize;
        let others = (0..self.looks).map(golden);
        let mut slots: Vec<_> = self.first.iter().copied().chain(others).collect();
        slots.sort_unstable();
        slots.dedup();
        slots
    }

    /// Climbs from the worst slots to worse ones of the same pad.
    fn refine<E>(
        &self,
        known: &mut HashMap<usize, f64>,
        of: &mut impl FnMut(usize) -> Result<f64, E>,
    ) -> Result<(), E> {
        let mut worst: Vec<_> = known.iter().map(|(slot, value)| (*slot, *value)).collect();
        worst.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        for (mut at, mut value) in worst.into_iter().take(AROUND) {
            let mut step =
                (self.slots / self.looks).div_ceil(self.pads).next_power_of_two() * self.pads;
            while step >= self.pads {
                for next in [at.checked_sub(step), Some(at + step)].into_iter().flatten() {
                    if next >= self.slots {
                        continue;
                    }
                    let found = match known.get(&next) {
                        Some(found) => *found,
                        None => of(next)?,
                    };
                    known.insert(next, found);
                    if found > value {
                        (at, value) = (next, found);
                    }
                }
                step /= 2;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;

    fn worst(looks: usize, enough: f64, of: impl Fn(usize) -> f64) -> (f64, usize) {
        let mut asked = 0;
        let search = Search { slots: 10_000, looks, first: &[], pads: 2, enough };
        let count = |slot| {
            asked += 1;
            Ok::<_, Infallible>(of(slot))
        };
        let Ok(found) = search.worst(count);
        (found, asked)
    }

    /// A narrow peak in the slots of one pad.
    fn peak(slot: usize) -> f64 {
        let off = slot as f64 - 7_531.0;
        f64::from(u8::from(slot % 2 == 1)) / (1.0 + (off / 60.0).powi(2))
    }

    #[test]
    fn neighbours_of_the_worst_slots_are_searched() {
        let (found, asked) = worst(256, f64::INFINITY, peak);
        assert_eq!(found, 1.0);
        assert!(asked < 400, "{asked}");
        assert_eq!(worst(10_000, f64::INFINITY, peak), (1.0, 10_000));
    }

    #[test]
    fn a_slot_that_is_bad_enough_ends_the_search() {
        assert!(worst(10_000, 0.5, peak).1 < 7_532);
    }

    #[test]
    fn what_is_dear_is_looked_at_less_often() {
        assert_eq!([1e2, 1e5, 1e9].map(|ns| affordable(4_000, ns)), [4_000, 400, 64]);
    }
}
