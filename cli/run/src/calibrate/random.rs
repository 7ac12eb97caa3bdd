// SPDX-License-Identifier: MIT OR Apache-2.0
//! Random devices: what a pad may be that is built like the paper's.
//!
//! | parameter of the scene | spread (standard deviation) |
//! | --- | --- |
//! | heights of all patches together; of each | 0.5 µm; 0.3 µm |
//! | spring; creep share; creep time | 7; 15; 20 % |
//! | contact pressure; its decay length; rest of the film | 20; 10; 15 % |
//! | thickness of the insulator | 4 % |
//! | coefficient of friction | 15 % |
//!
//! Normal deviates, cut at three deviations. Nominal values are those of docs/physics.md §3, the
//! spreads are assumptions: production tolerances of foam rubber and film, which the paper does not
//! give.

use std::f64::consts::TAU;

/// Nominal heights of the patches, µm.
const REST_UM: [f64; 8] = [13.0, 14.5, 16.0, 17.5, 19.0664, 19.5503, 26.0, 34.0];

/// Key, nominal value and relative deviation.
const PARAMETERS: [(&str, f64, f64); 7] = [
    ("spring_pa_per_m", 5e8, 0.07),
    ("creep_share", 0.35, 0.15),
    ("creep_s", 1.5, 0.2),
    ("contact_pa", 2e5, 0.2),
    ("contact_decay_um", 0.5, 0.1),
    ("insulator_um", 16.0, 0.04),
    ("film_rest_um", 0.7, 0.15),
];

/// Normal deviates from a seed.
#[derive(Debug, Clone)]
pub struct Normal(u64);

impl Normal {
    /// Those of a seed.
    pub fn new(seed: u64) -> Self {
        Normal(seed)
    }

    /// SplitMix64 (Steele, Lea, Flood 2014), as a share of one.
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ mixed >> 31) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// The next (Box and Muller 1958).
    pub fn deviate(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.share()).ln()).sqrt();
        (radius * (TAU * self.share()).cos()).clamp(-3.0, 3.0)
    }
}

/// The scene of a device, as TOML: the nominal one, or one at random.
pub fn scene(mut normal: Option<&mut Normal>) -> String {
    let mut next = || normal.as_mut().map_or(0.0, |normal| normal.deviate());
    let common_um = 0.5 * next();
    let heights: Vec<f64> = REST_UM.iter().map(|um| um + common_um + 0.3 * next()).collect();
    let gap: String = PARAMETERS
        .iter()
        .map(|(key, nominal, spread)| format!("{key} = {:?}\n", nominal * (1.0 + spread * next())))
        .collect();
    let mu = 0.12 * (1.0 + 0.15 * next());
    format!(
        "[device]\nmu = {mu:?}\n[supply]\nlimiting_kohm = 300\nparasitic_pf = 100\n\
         [carrier]\nhaptic_hz = 200\n[friction]\n[gap]\nrung = \"tr-bdf2\"\nrest_um = {heights:?}\n{gap}"
    )
}
