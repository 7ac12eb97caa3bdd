// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pad's rubber: its patches, what they make of gaps, and their equilibrium.

use super::dynamic::Method;
use super::equilibrium::equilibrium;
use super::law::{Drive, Law, State};
use crate::device::EPSILON_0;
use crate::effects::pad::Supply;

/// The pad's rubber: patches of equal area that differ in their gap without pressure.
#[derive(Clone, Debug)]
pub(super) struct Rubber {
    pub law: Law,
    pub patch_m2: f64,
    /// W/S of a gram.
    pub pa_per_g: f64,
    /// g₀ of each patch.
    pub rest_m: Vec<f64>,
    /// κ and k₁ of the law where it was fitted.
    fitted_pa_per_m: [f64; 2],
}

impl Rubber {
    pub fn new(law: Law, patch_m2: f64, pa_per_g: f64, rest_m: Vec<f64>) -> Self {
        let fitted_pa_per_m = [law.spring_pa_per_m, law.creep_spring_pa_per_m];
        Rubber { law, patch_m2, pa_per_g, rest_m, fitted_pa_per_m }
    }

    /// The same rubber with springs so much as stiff as they were fitted.
    pub fn stiffen(&mut self, stiffness: f64) {
        [self.law.spring_pa_per_m, self.law.creep_spring_pa_per_m] =
            self.fitted_pa_per_m.map(|pa_per_m| stiffness * pa_per_m);
    }

    /// The stiffest spring that steps of a method are stable with: at the unloaded gap of the
    /// highest patch the film damps least.
    pub fn stiffest_pa_per_m(&self, method: Method, step_s: f64) -> f64 {
        let highest_m = self.rest_m.iter().copied().fold(0.0, f64::max);
        method.stiffest_pa_per_m(&self.law, highest_m, step_s)
    }

    pub fn capacitance_f(&self, gaps_m: impl Iterator<Item = f64>) -> f64 {
        gaps_m.map(|gap| EPSILON_0 * self.patch_m2 / (gap + self.law.insulator_m)).sum()
    }

    pub fn attraction_n(&self, gaps_m: impl Iterator<Item = f64>, pull_n: f64) -> f64 {
        gaps_m.map(|gap| pull_n * self.patch_m2 / (gap + self.law.insulator_m).powi(2)).sum()
    }

    /// The relaxed gaps under a drive.
    pub fn equilibrium_m(&self, drive: Drive) -> impl Iterator<Item = f64> {
        self.rest_m.iter().map(move |rest| equilibrium(&self.law, *rest, drive))
    }
}

/// A patch that is still, and has crept as far as it will.
pub(super) fn at_rest(rest_m: f64, gap_m: f64) -> State {
    State { gap_m, speed_m_s: 0.0, creep_m: rest_m - gap_m }
}

/// The voltage at a pad whose capacitance rises with it: behind a supply the voltage falls as the
/// capacitance rises, so that there is one that agrees, found by halving.
pub(super) fn agreed_v(
    source_v: f64,
    supply: Option<Supply>,
    capacitance_f: impl Fn(f64) -> f64,
) -> f64 {
    let Some(supply) = supply else { return source_v };
    let (mut low, mut high) = (0.0, source_v);
    while high - low > 1e-12 * source_v {
        let middle = 0.5 * (low + high);
        let agreed = source_v * supply.share(capacitance_f(middle));
        *(if agreed > middle { &mut low } else { &mut high }) = middle;
    }
    high
}
