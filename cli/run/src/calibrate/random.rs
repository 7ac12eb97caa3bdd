// SPDX-License-Identifier: MIT OR Apache-2.0
//! Random devices: what a pad may be that is built like the paper's.
//!
//! | parameter of the scene | spread (standard deviation) |
//! | --- | --- |
//! | each height; each share of the area | 5; 15 % |
//! | spring; creep share; creep time | 10; 15; 20 % |
//! | contact pressure; its decay length; rest of the film | 20; 10; 15 % |
//! | thickness of the insulator | 5 % |
//! | coefficient of friction | 15 % |
//!
//! Normal deviates, cut at three deviations. Crests bear all of the load. Nominal values are those of
//! docs/physics.md §3, the spreads are assumptions: production tolerances of rough rubber and film, which
//! the paper does not give.

use std::f64::consts::TAU;

/// Nominal heights of the patches, µm, and their spread.
const REST_UM: [f64; 8] = [12.0, 26.4, 27.7, 29.3, 33.6, 38.191, 39.847, 55.0];
const REST_SPREAD: f64 = 0.05;

/// Nominal shares of the pad's area, and their spread; the first patch bears the load.
const AREA_SHARES: [f64; 8] = [0.365, 0.11, 0.065, 0.04, 0.025, 0.1, 0.1, 0.195];
const AREA_SPREAD: f64 = 0.15;

/// Key, nominal value and relative deviation.
const PARAMETERS: [(&str, f64, f64); 7] = [
    ("spring_pa_per_m", 4.5e7, 0.1),
    ("creep_share", 0.6, 0.15),
    ("creep_s", 1.5, 0.2),
    ("contact_pa", 2e5, 0.2),
    ("contact_decay_um", 1.25, 0.1),
    ("insulator_um", 16.0, 0.05),
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

/// The scene of a device, as TOML: the nominal one, or one at random. Steps of 250 µs leave 1e-4 of the capacitance, and
/// the prior needs half a million of them for each device.
pub fn scene(mut normal: Option<&mut Normal>) -> String {
    let mut next = || normal.as_mut().map_or(0.0, |normal| normal.deviate());
    let mut about = |nominal: f64, spread: f64| nominal * (1.0 + spread * next());
    let heights = REST_UM.map(|um| about(um, REST_SPREAD));
    let areas = AREA_SHARES.map(|share| about(share, AREA_SPREAD));
    let area: f64 = areas.iter().sum();
    let areas = areas.map(|share| share / area);
    let mut loads = [0.0; 8];
    loads[0] = 1.0 / areas[0];
    let gap: String = PARAMETERS
        .iter()
        .map(|(key, nominal, spread)| format!("{key} = {:?}\n", about(*nominal, *spread)))
        .collect();
    let mu = about(0.12, 0.15);
    format!(
        "[device]\nmu = {mu:?}\n[supply]\nlimiting_kohm = 300\nparasitic_pf = 100\n\
         [carrier]\nhaptic_hz = 200\n[friction]\n[gap]\nrung = \"tr-bdf2\"\nstep_us = 250\nrest_um = {heights:?}\n\
         area_shares = {areas:?}\nload_shares = {loads:?}\n{gap}"
    )
}
