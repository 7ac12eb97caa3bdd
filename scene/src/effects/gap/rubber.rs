// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pad's rubber: its patches, what they make of gaps, and their equilibrium.

use super::dynamic::Method;
use super::equilibrium::equilibrium;
use super::law::{Drive, Law, Patch, State};
use crate::device::EPSILON_0;
use crate::effects::pad::Supply;

/// The pad's rubber: patches that differ in area, in their gap without pressure, and in the load that they bear.
#[derive(Clone, Debug)]
pub(super) struct Rubber {
    pub law: Law,
    pub patches: Vec<Patch>,
    /// Area of each patch, m².
    pub areas_m2: Vec<f64>,
    /// W/S of a gram.
    pub pa_per_g: f64,
    /// κ of the law where it was fitted.
    fitted_pa_per_m: f64,
}

impl Rubber {
    pub fn new(law: Law, patches: Vec<Patch>, areas_m2: Vec<f64>, pa_per_g: f64) -> Self {
        let fitted_pa_per_m = law.spring_pa_per_m;
        Rubber { law, patches, areas_m2, pa_per_g, fitted_pa_per_m }
    }

    /// The same rubber with patches that bear no load higher by a share of their heights; none reaches the film.
    pub fn raised(mut self, share: f64) -> Self {
        for patch in self.patches.iter_mut().filter(|patch| patch.load_share == 0.0) {
            let raised_m = patch.rest_m + share * (patch.rest_m + self.law.insulator_m);
            patch.rest_m = raised_m.max(0.0);
        }
        self
    }

    /// The same rubber with springs so much as stiff as they were fitted.
    pub fn stiffen(&mut self, stiffness: f64) {
        self.law.spring_pa_per_m = stiffness * self.fitted_pa_per_m;
    }

    /// The stiffest spring that steps of a method are stable with: at the unloaded gap of the
    /// highest patch the film damps least.
    pub fn stiffest_pa_per_m(&self, method: Method, step_s: f64) -> f64 {
        let highest_m = self.patches.iter().map(|patch| patch.rest_m).fold(0.0, f64::max);
        method.stiffest_pa_per_m(&self.law, highest_m, step_s)
    }

    pub fn capacitance_f(&self, gaps_m: impl Iterator<Item = f64>) -> f64 {
        let of = |area: f64, height_m: f64| EPSILON_0 * area / height_m;
        self.sum(gaps_m, self.law.insulator_m, of)
    }

    pub fn attraction_n(&self, gaps_m: impl Iterator<Item = f64>, pull_n: f64) -> f64 {
        let of = |area: f64, height_m: f64| pull_n * area / (height_m * height_m);
        self.sum(gaps_m, self.law.haptic_insulator_m, of)
    }

    /// The sum over patches, each from its area, m², and height g + d, m; of the share that touches the height is d.
    fn sum(
        &self,
        gaps_m: impl Iterator<Item = f64>,
        insulator_m: f64,
        of: impl Fn(f64, f64) -> f64,
    ) -> f64 {
        let touches = self.law.touches();
        let patch = |(gap_m, &area): (f64, &f64)| {
            let free = of(area, gap_m + insulator_m);
            if !touches {
                return free;
            }
            free + self.law.contact_share(gap_m).value * (of(area, insulator_m) - free)
        };
        gaps_m.zip(&self.areas_m2).map(patch).sum()
    }

    /// The relaxed gaps under a drive.
    pub fn equilibrium_m(&self, drive: Drive) -> impl Iterator<Item = f64> {
        self.patches.iter().map(move |patch| equilibrium(&self.law, *patch, drive))
    }
}

/// A patch that is still, and has crept as far as it will.
pub(super) fn at_rest(law: &Law, patch: Patch, gap_m: f64) -> State {
    State { gap_m, speed_m_s: 0.0, crept_pa: law.rubber(gap_m, patch.rest_m).value }
}

/// The voltage at a pad whose capacitance rises with it. Behind a supply the voltage falls as the
/// capacitance rises, so that what the source leaves beyond a voltage falls by at least 1 V per volt: one
/// voltage agrees, or the pad pulls in there. Secants within a bracket, which is halved where a secant
/// shortens it by less.
pub(super) fn agreed_v(
    source_v: f64,
    supply: Option<Supply>,
    capacitance_f: impl Fn(f64) -> f64,
) -> f64 {
    let Some(supply) = supply else { return source_v };
    let beyond = |volt: f64| source_v * supply.share(capacitance_f(volt)) - volt;
    let tolerance_v = 1e-12 * source_v;
    let [mut low, mut high] = [0.0, source_v].map(|volt| (volt, beyond(volt)));
    let mut halves = false;
    while high.0 - low.0 > tolerance_v {
        let share = if halves { 0.5 } else { low.1 / (low.1 - high.1) };
        let volt = low.0 + share * (high.0 - low.0);
        let at = (volt, beyond(volt));
        if at.1.abs() <= tolerance_v {
            return volt;
        }
        let before_v = high.0 - low.0;
        *(if at.1 > 0.0 { &mut low } else { &mut high }) = at;
        halves = high.0 - low.0 > 0.5 * before_v;
    }
    high.0
}
