// SPDX-License-Identifier: MIT OR Apache-2.0
//! Neumann function of an insulated rectangle: the potential at one place for a unit current fed in
//! at another and taken out evenly, per ohm per square.
//!
//!   N = g₀/b − (1/4π) Σ_m Σ_X Σ_± ln(1 − 2e^(−πX/b)·cos θ± + e^(−2πX/b)),   X ∈ {|Δ|,2a−|Δ|,s,2a−s} + 2ma
//!   Δ = x−x′, s = x+x′, θ± = π(y±y′)/b, g₀ = (x²+x′²)/2a − max(x,x′) + a/3
//!
//! Each logarithm's argument is (1−e)² + 4e·sin²(θ/2), which does not cancel near the source; the
//! product of all is taken before one logarithm. What is cut off after M images is 3.8e-6, 8e-11,
//! 2e-15 for M = 1, 2, 3. Source: docs/physics.md §1.

use std::f64::consts::PI;

/// What is left of the first image that is left out; 2 images for the paper's sheet.
const CUT_OFF: f64 = 1e-9;

/// What N takes from the places' x alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct AlongX {
    /// e^(−πX/b) of the nearest images.
    decay: [f64; 4],
    /// g₀/b.
    slope: f64,
}

/// What N takes from the places' y alone: sin²(θ±/2).
#[derive(Clone, Copy, Debug, Default)]
pub struct AlongY([f64; 2]);

/// Rectangle `[0, a] × [0, b]`, metres.
#[derive(Clone, Copy, Debug)]
pub struct Neumann {
    a: f64,
    b: f64,
    images: i32,
    /// e^(−2πa/b): from one image to the next.
    next: f64,
}

impl Neumann {
    /// With as many images as matter.
    pub fn exact([a, b]: [f64; 2]) -> Self {
        let images = (CUT_OFF.ln() / (-2.0 * PI * a / b)).ceil();
        Neumann::new([a, b], images as i32)
    }

    /// With `images` images.
    pub fn new([a, b]: [f64; 2], images: i32) -> Self {
        Neumann { a, b, images, next: (-2.0 * PI * a / b).exp() }
    }

    /// N at `p` for a source at `q`. Where an image of `q` falls on `p` itself, their distance is
    /// taken as `near`: the radius of a terminal, or R·e^(−1/4) for a disc of even current averaged
    /// over itself.
    pub fn at(&self, p: [f64; 2], q: [f64; 2], near: f64) -> f64 {
        self.join(&self.along_x(p[0], q[0]), &self.along_y(p[1], q[1]), near)
    }

    /// What [`Neumann::at`] takes from the x of both places, for rasters: most of the time goes into this and
    /// [`Neumann::along_y`].
    pub fn along_x(&self, x: f64, x1: f64) -> AlongX {
        let (larger, smaller) = (x.max(x1), x.min(x1));
        let (delta, sum) = (larger - smaller, larger + smaller);
        let decay = [delta, 2.0 * self.a - delta, sum, 2.0 * self.a - sum]
            .map(|x| (-PI * x / self.b).exp());
        AlongX { decay, slope: self.slope(x, x1) / self.b }
    }

    /// What it takes from the y of both places.
    pub fn along_y(&self, y: f64, y1: f64) -> AlongY {
        let half_sine = |y: f64| (y * PI / (2.0 * self.b)).sin().powi(2);
        AlongY([half_sine(y + y1), half_sine(y - y1)])
    }

    /// [`Neumann::at`] from what it takes along either axis.
    pub fn join(&self, x: &AlongX, y: &AlongY, near: f64) -> f64 {
        x.slope - self.product(x.decay, y.0, near).ln() / (4.0 * PI)
    }

    /// g₀: the part that is linear in the slower direction.
    pub fn slope(&self, x: f64, x1: f64) -> f64 {
        (x.powi(2) + x1.powi(2)) / (2.0 * self.a) - x.max(x1) + self.a / 3.0
    }

    fn product(&self, decay: [f64; 4], angles: [f64; 2], near: f64) -> f64 {
        let coincident = (PI * near / self.b).powi(2);
        let (mut product, mut image) = (1.0, 1.0);
        for _ in 0..self.images {
            let decay = decay.map(|e| e * image);
            let (constant, by) = (decay.map(|e| (1.0 - e).powi(2)), decay.map(|e| 4.0 * e));
            // All are computed before one is tested for being tiny: two are computed side by side.
            let [of_sum, of_difference] = angles.map(|angle| {
                let factors: [f64; 4] = std::array::from_fn(|n| constant[n] + by[n] * angle);
                factors.map(|factor| if factor < 1e-24 { coincident } else { factor })
            });
            product *=
                of_sum.iter().zip(of_difference).map(|(sum, diff)| sum * diff).product::<f64>();
            image *= self.next;
        }
        product
    }
}
