// SPDX-License-Identifier: MIT OR Apache-2.0
//! A rotating unit vector, stepped by multiplication: the sine and cosine of a run of samples
//! without a call each.

use std::f64::consts::TAU;

use num_complex::Complex64;

/// e^(jφ) with φ stepping evenly. Rounding lets it drift by about 1e-16 a step; it is set anew for
/// every run of samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rotor {
    at: Complex64,
    step: Complex64,
}

impl Rotor {
    /// Starts at phase `turns` and steps by `step_turns`.
    pub fn new(turns: f64, step_turns: f64) -> Self {
        let unit =
            |turns: f64| Complex64::new((TAU * turns.fract()).cos(), (TAU * turns.fract()).sin());
        Rotor { at: unit(turns), step: unit(step_turns) }
    }

    /// The vector now; then one step on.
    #[inline(always)]
    pub fn turn(&mut self) -> Complex64 {
        let now = self.at;
        self.at = now * self.step;
        now
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hundred_thousand_steps_stay_within_a_picounit() {
        let mut rotor = Rotor::new(0.1, 0.123_456_789);
        for n in 0..100_000 {
            let exact = Complex64::cis(TAU * (0.1 + 0.123_456_789 * f64::from(n)).fract());
            assert!((rotor.turn() - exact).norm() < 1e-10);
        }
    }
}
