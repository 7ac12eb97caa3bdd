// SPDX-License-Identifier: MIT OR Apache-2.0
//! A sheet whose film is the same everywhere.

/// Resistance in series with a terminal that is not connected, Ω.
pub const OPEN: f64 = f64::INFINITY;

/// A rectangular sheet with a uniform film, in SI units, places from its bottom left corner.
///
/// ```
/// use hapticore_sheet::{Analytic, UniformSheet};
///
/// let sheet = UniformSheet {
///     size_m: [0.86, 0.5],
///     ohm_per_square: 150.0,
///     pad_radius_m: 0.015,
///     terminals_m: vec![[0.0, 0.5], [0.0, 0.0], [0.86, 0.0], [0.86, 0.5]],
///     terminal_ohm: vec![0.0; 4],
///     terminal_radius_m: 1.7e-3,
/// };
/// let exact = Analytic::new(sheet);
/// let middle = exact.source(0.0, 0.0);
/// assert!(middle.shares().iter().all(|share| (share - 0.25).abs() < 1e-12));
/// assert!((100.0..250.0).contains(&exact.between(&middle, &middle)), "the resistance R_p in the middle, Ω");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct UniformSheet {
    /// Width and height, m.
    pub size_m: [f64; 2],
    /// Sheet resistance of the film, Ω per square.
    pub ohm_per_square: f64,
    /// Of a pad, a disc of even current.
    pub pad_radius_m: f64,
    /// The places of the terminals.
    pub terminals_m: Vec<[f64; 2]>,
    /// In series with each terminal, Ω; [`OPEN`] where it carries no current.
    pub terminal_ohm: Vec<f64>,
    /// Effective radius of a terminal, m.
    pub terminal_radius_m: f64,
}

impl UniformSheet {
    /// How many terminals there are.
    pub fn terminals(&self) -> usize {
        self.terminals_m.len()
    }

    /// Millimetres from the middle to metres from the bottom left corner.
    pub fn place_m(&self, x_mm: f64, y_mm: f64) -> [f64; 2] {
        [self.size_m[0] / 2.0 + x_mm * 1e-3, self.size_m[1] / 2.0 + y_mm * 1e-3]
    }

    /// R·e^(−1/4): a disc of even current has, on average over itself, the potential of a ring of
    /// this radius.
    pub fn disc_m(&self) -> f64 {
        self.pad_radius_m * (-0.25f64).exp()
    }
}
