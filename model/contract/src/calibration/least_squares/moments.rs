// SPDX-License-Identifier: MIT OR Apache-2.0
//! Equations of three entries, added up.

use super::band::Band;

/// Equations of three entries, one value per layer, added up: what they bring to the normal equations and to
/// the right-hand sides.
#[derive(Debug, Clone, Copy)]
pub struct Moments<const LAYERS: usize> {
    pub(super) products: [[f64; 3]; 3],
    pub(super) values: [[f64; 3]; LAYERS],
}

impl<const LAYERS: usize> Moments<LAYERS> {
    /// Of no equation.
    pub const NONE: Self = Moments { products: [[0.0; 3]; 3], values: [[0.0; 3]; LAYERS] };

    /// Adds an equation.
    #[inline(always)]
    pub fn add(&mut self, weights: [f64; 3], values: [f64; LAYERS], importance: f64) {
        let important = weights.map(|weight| importance * weight);
        self.products.iter_mut().zip(important).for_each(|(sums, by)| add(sums, by, &weights));
        self.values.iter_mut().zip(values).for_each(|(sums, by)| add(sums, by, &important));
    }

    /// The entries of each layer that come nearest to the equations; none where these do not settle them.
    pub fn solve(&self) -> Option<[[f64; 3]; LAYERS]> {
        let mut normal = Band::new(3, 2);
        for row in 0..3 {
            for column in 0..=row {
                *normal.at(row, column) = self.products[row][column];
            }
        }
        let found = normal.solve(self.values.iter().map(|values| values.to_vec()).collect())?;
        Some(std::array::from_fn(|layer| std::array::from_fn(|entry| found[layer][entry])))
    }
}

/// Adds weights to coefficients, each `by` times.
#[inline(always)]
pub(super) fn add(coefficients: &mut [f64], by: f64, weights: &[f64; 3]) {
    coefficients.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += by * weight);
}

#[cfg(test)]
mod tests {
    use super::super::terms::Fit;
    use super::*;

    /// Contradicting ones of different importance, as terms one after the other, to the bit.
    #[test]
    fn entries_are_those_of_the_equations_term_by_term() {
        let (mut moments, mut terms) = (Moments::NONE, Fit::new(3, 2));
        for k in 0..20 {
            let t = f64::from(k) / 7.0;
            let (weights, values) = ([1.0, t, t * t - 2.0], [t.sin(), 3.0 - t]);
            moments.add(weights, values, 0.1 + t);
            terms.ask([0, 1, 2].map(|n| (n, weights[n])), &values, 0.1 + t);
        }
        let found = moments.solve().expect("settled").map(Vec::from);
        assert_eq!(found.to_vec(), terms.solve().expect("settled"));
    }

    #[test]
    fn entries_that_nothing_settles_are_told() {
        let mut moments = Moments::NONE;
        assert_eq!(moments.solve(), None);
        (0..3).for_each(|_| moments.add([1.0, 2.0, 3.0], [1.0], 1.0));
        assert_eq!(moments.solve(), None);
        moments.add([f64::NAN, 1.0, 0.0], [1.0], 1.0);
        assert_eq!(moments.solve(), None);
    }
}
