// SPDX-License-Identifier: MIT OR Apache-2.0
//! What counts of a slot, and what a percent of it is: the table of docs/physics.md §8.
//!
//! The true values are a frame's columns `true_…`; the others are what an ideal core reads of the
//! slot's currents (`core`). The difference of two slots is the largest over all of these. A value
//! that cannot be read in the finer slot does not count; one that cannot be read in the coarser slot
//! alone is infinitely far off.

use crate::device::Device;
use crate::truth::Truth;

/// Number of quantities.
const COUNT: usize = 7;

/// x and y in mm, capacitance in pF, R_p in Ω, haptic voltage in V, haptic force and friction in N.
pub(super) type Quantities = [f64; COUNT];

/// The quantities of the truth.
pub(super) fn of_truth(truth: &Truth) -> Quantities {
    [
        truth.x_mm,
        truth.y_mm,
        truth.capacitance_pf,
        truth.sheet_ohm,
        truth.haptic_v_rms,
        truth.force_n,
        truth.friction_n,
    ]
}

/// What a slot is, and what an ideal core reads of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub truth: Quantities,
    pub read: Quantities,
}

/// What differences are divided by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Norm {
    size_mm: [f64; 2],
    /// The largest haptic voltage, haptic force and friction of the case.
    largest: [f64; 3],
}

impl Norm {
    /// For a case with these slots.
    pub fn new(device: &Device, slots: &[Quantities]) -> Norm {
        let largest = |n: usize| slots.iter().map(|slot| slot[n].abs()).fold(0.0, f64::max);
        Norm {
            size_mm: [device.width_mm, device.height_mm],
            largest: [largest(4), largest(5), largest(6)],
        }
    }

    /// The difference of a slot from the same one at a finer level, percent.
    pub fn percent(&self, coarse: &Seen, fine: &Seen) -> f64 {
        self.of(&coarse.truth, &fine.truth).max(self.of(&coarse.read, &fine.read))
    }

    /// The same of one set of quantities.
    pub fn of(&self, coarse: &Quantities, fine: &Quantities) -> f64 {
        let [width, height] = self.size_mm;
        let [volt, force, friction] = self.largest;
        let scales = [width, height, fine[2].abs(), fine[3].abs(), volt, force, friction];
        let off = |((coarse, fine), scale): ((&f64, &f64), f64)| match (coarse - fine).abs() {
            _ if fine.is_nan() || coarse == fine => 0.0,
            off if off.is_nan() || scale == 0.0 => f64::INFINITY,
            off => 100.0 * off / scale,
        };
        coarse.iter().zip(fine).zip(scales).map(off).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NORM: Norm = Norm { size_mm: [800.0, 500.0], largest: [300.0, 0.5, 0.0] };
    const SLOT: Quantities = [10.0, 0.0, 400.0, 120.0, 100.0, 0.1, 0.0];

    fn off(n: usize, by: f64) -> f64 {
        let mut coarse = SLOT;
        coarse[n] += by;
        NORM.of(&coarse, &SLOT)
    }

    #[test]
    fn a_percent_is_of_the_sheet_the_value_or_the_largest_of_the_case() {
        let ones = [(0, 8.0), (1, 5.0), (2, 4.0), (3, 1.2), (4, 3.0), (5, 0.005)];
        for (n, by) in ones {
            assert!((off(n, by) - 1.0).abs() < 1e-9 && (off(n, -by) - 1.0).abs() < 1e-9, "{n}");
        }
    }

    #[test]
    fn what_should_not_be_there_or_is_no_number_is_infinitely_far_off() {
        assert_eq!(
            [off(6, 1e-9), off(6, 0.0), off(2, f64::NAN)],
            [f64::INFINITY, 0.0, f64::INFINITY]
        );
        let unread = SLOT.map(|_| f64::NAN);
        assert_eq!(NORM.of(&SLOT, &unread), 0.0);
    }
}
