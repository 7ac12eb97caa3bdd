// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a shunt capacitance changes of a uniform sheet, exactly.
//!
//! −∇·(∇φ/R_s) + jωc·φ = I·δ has the Neumann function of the sheet alone plus
//!
//!   D = Σ_n (ε_n/b)·cos(nπy/b)·cos(nπy′/b)·[f(√(κ_n² + jωcR_s)) − f(κ_n)],   κ_n = nπ/b,   ε_0 = 1, else 2
//!   f(k) = cosh(k·x_<)·cosh(k·(a − x_>))/(k·sinh ka),   for n = 0 without shunt g₀ = (x²+x′²)/2a − max(x,x′) + a/3
//!
//! The singularity is all in the sheet's own function, so that the terms fall as 1/n³. Terminals
//! tie it together as they do without shunt, but no border is needed: what the terminals do not
//! get, the panel does.

use std::f64::consts::PI;

use crate::few::Few;
use num_complex::Complex64;

use crate::effects::sheet::Sheet;
use crate::effects::sheet::linear::Square;
use crate::effects::sheet::neumann::Neumann;
use crate::terminals::{MOST_TERMINALS, PerTerminal};

/// Modes along y; those left out are below 3e-7 of the sum at 22 nF/m².
const MODES: usize = 100;

/// Modes that have decayed by so much along x, to 1e-11, are left out.
const NEPERS: f64 = 25.0;

/// A uniform sheet with a shunt.
pub(in super::super) struct Screened {
    sheet: Sheet,
    neumann: Neumann,
    /// k_n with shunt.
    modes: Vec<Complex64>,
    inverse: Square<Complex64>,
}

/// D between a place and each terminal, then the place itself.
pub(in super::super) type Screens = Few<Complex64, { MOST_TERMINALS + 1 }>;

/// A place on it: the split there, and what its potential is made of.
pub(in super::super) struct Source {
    at: [f64; 2],
    known: PerTerminal<Complex64>,
    pub share: PerTerminal<Complex64>,
}

impl Screened {
    /// With `siemens_per_m2` = ωc.
    pub fn new(sheet: &Sheet, siemens_per_m2: f64) -> Self {
        let neumann = Neumann::exact(sheet.size_m);
        let screening = Complex64::new(0.0, siemens_per_m2 * sheet.film.ohm_per_square);
        let mode = |n: usize| ((n as f64 * PI / sheet.size_m[1]).powi(2) + screening).sqrt();
        let modes = (0..MODES).map(mode).collect();
        let inverse = Square::of(0, |_, _| Complex64::ZERO);
        let mut screened = Screened { sheet: sheet.clone(), neumann, modes, inverse };
        screened.inverse = screened.tied().invert();
        screened
    }

    /// R_s·N between terminals, and what is in series with each.
    fn tied(&self) -> Square<Complex64> {
        let Sheet { terminals_m, terminal_ohm, terminal_radius_m, .. } = &self.sheet;
        Square::of(terminals_m.len(), |i, j| match terminal_ohm[i].is_finite() {
            true => {
                let own = if i == j { terminal_ohm[i] } else { 0.0 };
                self.ohm(terminals_m[i], terminals_m[j], *terminal_radius_m) + own
            }
            false => Complex64::from(f64::from(u8::from(i == j))),
        })
    }

    /// Current into each terminal per volt of the panel, S: the same as if the terminals alone had a
    /// volt less, since a sheet that nothing else holds follows the panel.
    pub fn driven_by_panel(&self) -> PerTerminal<Complex64> {
        let ohm = &self.sheet.terminal_ohm;
        let closed = |n: usize| ohm[n].is_finite();
        let into = |(n, row): (usize, &[Complex64])| match closed(n) {
            true => row.iter().enumerate().filter(|(n, _)| closed(*n)).map(|(_, g)| g).sum(),
            false => Complex64::ZERO,
        };
        self.inverse.rows().enumerate().map(into).collect()
    }

    /// D between a place and each terminal, and the place itself.
    pub fn screens(&self, x_mm: f64, y_mm: f64) -> Screens {
        let at = self.sheet.place_m(x_mm, y_mm);
        self.sheet.terminals_m.iter().chain([&at]).map(|there| self.screen(at, *there)).collect()
    }

    pub fn source(&self, x_mm: f64, y_mm: f64) -> Source {
        self.source_of(x_mm, y_mm, &self.screens(x_mm, y_mm))
    }

    /// The same where D is known.
    pub fn source_of(&self, x_mm: f64, y_mm: f64, screens: &Screens) -> Source {
        let at = self.sheet.place_m(x_mm, y_mm);
        let known =
            (0..self.sheet.terminals()).map(|n| match self.sheet.terminal_ohm[n].is_finite() {
                true => self.scaled(
                    self.sheet.terminals_m[n],
                    at,
                    self.sheet.terminal_radius_m,
                    screens[n],
                ),
                false => Complex64::ZERO,
            });
        let known: PerTerminal<Complex64> = known.collect();
        let share = self.inverse.rows().map(|row| product(row, &known)).collect();
        Source { at, known, share }
    }

    /// Potential at one place for a unit current into another.
    pub fn between(&self, a: &Source, b: &Source) -> Complex64 {
        self.ohm(a.at, b.at, self.sheet.disc_m()) - product(&a.known, &b.share)
    }

    /// The pad's own disc's, where D is known.
    pub fn own(&self, source: &Source, screens: &Screens) -> Complex64 {
        let free =
            self.scaled(source.at, source.at, self.sheet.disc_m(), screens[self.sheet.terminals()]);
        free - product(&source.known, &source.share)
    }

    fn ohm(&self, p: [f64; 2], q: [f64; 2], near_m: f64) -> Complex64 {
        self.scaled(p, q, near_m, self.screen(p, q))
    }

    /// R_s·(N + D)
    fn scaled(&self, p: [f64; 2], q: [f64; 2], near_m: f64, screen: Complex64) -> Complex64 {
        (screen + self.neumann.at(p, q, near_m)) * self.sheet.film.ohm_per_square
    }

    /// The change D of the Neumann function by the shunt.
    fn screen(&self, p: [f64; 2], q: [f64; 2]) -> Complex64 {
        let [a, b] = self.sheet.size_m;
        let angle = |y: f64| y * PI / b;
        let first = mode(self.modes[0], a, p[0], q[0]) - self.neumann.slope(p[0], q[0]);
        let term = |(n, screened): (usize, &Complex64)| {
            let n = n as f64;
            let plain = mode(Complex64::from(n * PI / b), a, p[0], q[0]);
            let along = (n * angle(p[1])).cos() * (n * angle(q[1])).cos();
            (mode(*screened, a, p[0], q[0]) - plain) * (2.0 * along)
        };
        let apart = angle((p[0] - q[0]).abs());
        let reaches = |(n, _): &(usize, &Complex64)| *n as f64 * apart < NEPERS;
        (first
            + self
                .modes
                .iter()
                .enumerate()
                .skip(1)
                .take_while(reaches)
                .map(term)
                .sum::<Complex64>())
            / b
    }
}

/// cosh(k·x_<)·cosh(k·(a − x_>))/(k·sinh ka) without large numbers.
fn mode(k: Complex64, a: f64, x: f64, x1: f64) -> Complex64 {
    let (delta, sum) = ((x - x1).abs(), x + x1);
    let waves = [delta, 2.0 * a - delta, sum, 2.0 * a - sum].map(|length| (-k * length).exp());
    waves.into_iter().sum::<Complex64>() / (k * 2.0 * (Complex64::ONE - (-k * (2.0 * a)).exp()))
}

/// Σ a·b, without conjugation.
fn product(a: &[Complex64], b: &[Complex64]) -> Complex64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
