// SPDX-License-Identifier: MIT OR Apache-2.0
//! Lines across an axis, dense where something varies quickly, and interpolation between them.

/// From one line to the next far from all breaks, mm: where there are none, and where there are.
const APART_MM: [f64; 2] = [40.0, 25.0];

/// Steps that the reach is looked through in.
const STEPS: usize = 1000;

/// How much farther apart they are for each millimetre that they are off.
const GROWTH: f64 = 0.25;

/// Places along an axis in order, four at least.
pub(super) struct Lines {
    pub at_mm: Vec<f64>,
}

impl Lines {
    /// From −reach to reach; `near_mm` from one another within a radius around the breaks.
    pub fn new(reach_mm: f64, breaks_mm: &[f64], radius_mm: f64, near_mm: f64) -> Self {
        let far_mm = APART_MM[usize::from(!breaks_mm.is_empty())].min(reach_mm / 2.0);
        let apart = |at: f64| {
            let off =
                breaks_mm.iter().map(|to| (at - to).abs() - radius_mm).fold(f64::MAX, f64::min);
            (near_mm + GROWTH * off.max(0.0)).min(far_mm)
        };
        // The number of lines up to each place: they are where that is a whole number.
        let step_mm = 2.0 * reach_mm / STEPS as f64;
        let place = |step: f64| step * step_mm - reach_mm;
        let mut passed = vec![0.0];
        for step in 0..STEPS {
            passed.push(passed[step] + step_mm / apart(place(step as f64 + 0.5)));
        }
        let count = passed[STEPS].ceil();
        let line = |n: usize| {
            let due = n as f64 / count * passed[STEPS];
            let after = passed.partition_point(|passed| *passed < due).clamp(1, STEPS);
            let short = (passed[after] - due) / (passed[after] - passed[after - 1]);
            place(after as f64 - short)
        };
        Lines { at_mm: (0..=count as usize).map(line).collect() }
    }

    /// The first of four lines around a place, and the weight of each: a cubic through them.
    pub fn weights(&self, mm: f64) -> (usize, [f64; 4]) {
        let after = self.at_mm.partition_point(|at| *at <= mm);
        let first = after.saturating_sub(2).min(self.at_mm.len() - 4);
        let four = &self.at_mm[first..first + 4];
        let weight = |n: usize| {
            let others = (0..4).filter(|other| *other != n);
            others.map(|other| (mm - four[other]) / (four[n] - four[other])).product()
        };
        (first, [0, 1, 2, 3].map(weight))
    }
}
