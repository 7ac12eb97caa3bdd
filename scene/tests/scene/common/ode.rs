// SPDX-License-Identifier: MIT OR Apache-2.0
//! The equations of docs/physics.md §3 once more, by an explicit method with a short step. It
//! shares no code with the plant.

/// Heights g₀ + d of the patches, µm.
pub const REST_UM: [f64; 8] = [12.0, 26.4, 27.7, 29.3, 33.6, 38.191, 39.847, 55.0];

/// Shares of the pad's area; the first patch bears all of the load.
const AREA_SHARES: [f64; 8] = [0.365, 0.11, 0.065, 0.04, 0.025, 0.1, 0.1, 0.195];

const EPSILON_0: f64 = 8.8541878128e-12;
const KAPPA: f64 = 4.5e7;
const CREEP_SHARE: f64 = 0.6;
const TAU_S: f64 = 1.5;
const P_0: f64 = 2e5;
const LAMBDA_M: f64 = 1.25e-6;
const D_M: f64 = 5e-6;
const FILM_REST_M: f64 = 0.7e-6;
const FILM_AREA_SHARE: f64 = 0.4;
const VISCOSITY_PA_S: f64 = 1.8e-5;
const INERTIA: f64 = 7.0;
const GRAVITY: f64 = 9.80665;
const AREA_M2: f64 = std::f64::consts::PI * 0.015 * 0.015;

/// Longest step, s: RK4 diverges from 0.5 µs on.
const STEP_S: f64 = 1e-7;

/// A patch: gap, its speed, crept pressure.
type Patch = [f64; 3];

/// A pad of eight patches.
pub struct Ode {
    time_s: f64,
    pressure_pa: f64,
    patches: [Patch; 8],
}

impl Ode {
    /// Relaxed under its load, without voltage.
    pub fn at_rest(load_g: f64, time_s: f64) -> Ode {
        let pressure_pa = 1e-3 * load_g * GRAVITY / AREA_M2;
        let patch = |n: usize| {
            let rest_m = 1e-6 * REST_UM[n] - D_M;
            let load_pa = load_pa(n, pressure_pa);
            let (mut low, mut high) = (0.0, 2.0 * rest_m);
            for _ in 0..200 {
                let middle = 0.5 * (low + high);
                let opens = rubber_pa(middle, n) > load_pa;
                *(if opens { &mut low } else { &mut high }) = middle;
            }
            [low, 0.0, rubber_pa(low, n)]
        };
        Ode { time_s, pressure_pa, patches: std::array::from_fn(patch) }
    }

    /// Onwards, the pad's voltage given over time and capacitance in pF; it must not step between.
    pub fn advance(&mut self, until_s: f64, volt: impl Fn(f64, f64) -> f64) {
        let span_s = until_s - self.time_s;
        let steps = (span_s / STEP_S).ceil() as usize;
        let step_s = span_s / steps as f64;
        for step in 0..steps {
            // Inside the step, so that a voltage that steps at its ends is on the right side.
            let volt = volt(self.time_s + (step as f64 + 0.5) * step_s, self.capacitance_pf());
            for (n, patch) in self.patches.iter_mut().enumerate() {
                *patch = rk4(*patch, step_s, |at| rates(at, n, volt, self.pressure_pa));
            }
        }
        self.time_s = self.time_s.max(until_s);
    }

    pub fn capacitance_pf(&self) -> f64 {
        let each = self.patches.iter().zip(AREA_SHARES);
        1e12 * each.map(|([gap, ..], share)| EPSILON_0 * AREA_M2 * share / (gap + D_M)).sum::<f64>()
    }
}

/// What presses a patch.
fn load_pa(n: usize, pressure_pa: f64) -> f64 {
    if n == 0 { pressure_pa / AREA_SHARES[0] } else { 0.0 }
}

/// Spring and contact.
fn rubber_pa(gap: f64, n: usize) -> f64 {
    KAPPA * (1e-6 * REST_UM[n] - D_M - gap) + P_0 * (-gap / LAMBDA_M).exp()
}

fn rates([gap, speed, crept]: Patch, n: usize, volt: f64, pressure_pa: f64) -> Patch {
    let film = 1.5 * VISCOSITY_PA_S * FILM_AREA_SHARE * AREA_M2
        / std::f64::consts::PI
        / (gap + FILM_REST_M).powi(3);
    let rubber = rubber_pa(gap, n);
    let pressure = rubber + CREEP_SHARE * (rubber - crept)
        - EPSILON_0 * volt * volt / (2.0 * (gap + D_M).powi(2))
        - load_pa(n, pressure_pa);
    [speed, (pressure - film * speed) / INERTIA, (rubber - crept) / TAU_S]
}

fn rk4(from: Patch, step_s: f64, rates: impl Fn(Patch) -> Patch) -> Patch {
    let ahead = |rates: Patch, step_s: f64| std::array::from_fn(|n| from[n] + step_s * rates[n]);
    let a = rates(from);
    let b = rates(ahead(a, 0.5 * step_s));
    let c = rates(ahead(b, 0.5 * step_s));
    let d = rates(ahead(c, step_s));
    ahead(std::array::from_fn(|n| (a[n] + 2.0 * b[n] + 2.0 * c[n] + d[n]) / 6.0), step_s)
}
