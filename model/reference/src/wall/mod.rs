// SPDX-License-Identifier: MIT OR Apache-2.0
//! Direction of push and walls in floating point, frame by frame: eqs. 10 to 12 of the paper and
//! the rules of this project.
//!
//! ```text
//! Δx = Σa_i·x_i/Σa_i − Σx_i/n                                   (eq. 10; a_i a part's current, x_i its place)
//! u  = (C_R − C_L)/(C_R + C_L)                                  (eq. 10 of two parts at ∓x_c, over x_c)
//! V  = K_w·|x| where x < 0                                      (eq. 11)
//! V  = K_w·|x| where x < 0 and the push does not lead out       (eq. 12)
//! F  = min(k_w·|x|, F_max)                                      (linear in the depth, into a force controller)
//! ```
//!
//! | rule | output | releases where |
//! | --- | --- | --- |
//! | [`Eq11`] | voltage | never |
//! | [`Eq12`] | voltage | the push leads out, as read in the frame |
//! | [`Linear`] | force | never, or by eq. 12 on a calibrated direction |
//! | [`Fused`] | force | a filtered, calibrated direction passes a threshold; motion inwards engages |
//! | [`Sequential`] | force | a sequential test on the direction, or play of the position, says so: rules A and B; no force where the pad slides along the surface |
//!
//! The wall's surface is at x = 0 and its inside at x < 0; a push into it reads u < 0. Lengths in
//! mm, forces in N, voltages in V rms, capacitances in any unit. Source: docs/physics.md §6.

mod fused;
mod motion;
mod paper;
mod pressed;
mod sequential;
mod split;

pub use fused::{Fused, Linear};
pub use paper::{Eq11, Eq12};
pub use pressed::Fade;
pub use sequential::{Sequential, Test};
pub use split::{SplitPads, Whole};

/// What a rule sees of one pad in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Capacitance of the left part that senses.
    pub left: f64,
    /// Capacitance of the right part that senses, in the same unit.
    pub right: f64,
    /// Place of the pad right of the wall's surface, mm.
    pub x_mm: f64,
    /// Its place along the surface, mm.
    pub along_mm: f64,
    /// The haptic voltage of the frame was zero.
    pub at_zero: bool,
}

impl Frame {
    /// u of eq. 10; nothing where no part is there, or one is open: its capacitance is less than a
    /// third of the other's.
    pub fn direction(&self) -> Option<f64> {
        let sum = self.left + self.right;
        let u = (self.right - self.left) / sum;
        (sum > 0.0 && u.abs() < 0.5).then_some(u)
    }
}

/// Eq. 10 of n parts: their currents' centre less the parts'; nothing without current.
///
/// ```
/// use hapticore_reference::wall::eccentricity;
///
/// // Two parts 15 mm apart, the right one with 1 % more: 7.5 mm · 0.01/2.01.
/// let of_two = eccentricity(&[(-7.5, 1.0), (7.5, 1.01)]).unwrap();
/// assert!((of_two - 7.5 * 0.01 / 2.01).abs() < 1e-15);
/// // A pad elsewhere reads the same.
/// let moved = eccentricity(&[(92.5, 1.0), (107.5, 1.01)]).unwrap();
/// assert!((moved - of_two).abs() < 1e-12);
/// assert_eq!(eccentricity(&[(0.0, 0.0), (1.0, 0.0)]), None);
/// ```
pub fn eccentricity(parts: &[(f64, f64)]) -> Option<f64> {
    let (sum, moment) =
        parts.iter().fold((0.0, 0.0), |(sum, moment), (x, a)| (sum + a, moment + a * x));
    let middle = parts.iter().map(|(x, _)| x).sum::<f64>() / parts.len() as f64;
    (sum > 0.0).then(|| moment / sum - middle)
}

/// Whether a wall acts on the pad.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// The user pushes into the wall, or is outside it.
    Push,
    /// The user leaves: the wall lets go.
    Free,
}

/// What a rule asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// A force, N.
    Force(f64),
    /// A voltage, V rms.
    Voltage(f64),
}

/// A wall's rule for one pad.
pub trait Rule {
    /// What it asks for after a frame, and whether the wall acts.
    fn frame(&mut self, frame: &Frame) -> (Target, Direction);
}

/// The wall's force at a place: linear in the depth, up to a largest one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// k_w, N/mm.
    pub n_per_mm: f64,
    /// F_max, N.
    pub most_n: f64,
}

impl Stiffness {
    fn at(&self, x_mm: f64) -> f64 {
        (self.n_per_mm * (-x_mm).max(0.0)).min(self.most_n)
    }
}
