// SPDX-License-Identifier: MIT OR Apache-2.0
//! Coupled pads: the currents of all pads where one has the sensing voltage and the others are
//! capacitors to ground.
//!
//!   I_k/(jωC_k) + Σ_l G_kl·I_l = V_k,   V = (V_s, 0, 0, …),   terminal i gets Σ_k w_i(x_k)·I_k
//!
//! G_kl is the sheet's potential at pad k for a unit current into pad l; G_kk is R_p.

use crate::linear::solve;
use num_complex::Complex64;

/// Places of all pads, the first one's first: on the sheet, as far out as `reach_mm`, and none
/// nearer to the first than a pad's diameter; whether one was.
pub fn apart(
    first: [f64; 2],
    others: impl Iterator<Item = [f64; 2]>,
    reach_mm: [f64; 2],
    diameter_mm: f64,
) -> (Vec<[f64; 2]>, bool) {
    let on_sheet =
        |[x, y]: [f64; 2]| [x.clamp(-reach_mm[0], reach_mm[0]), y.clamp(-reach_mm[1], reach_mm[1])];
    let mut places = vec![on_sheet(first)];
    let mut touching = false;
    for place in others.map(on_sheet) {
        let [x, y] = [0, 1].map(|axis| place[axis] - places[0][axis]);
        let distance = x.hypot(y);
        touching |= distance < diameter_mm;
        places.push(match distance {
            0.0 => [places[0][0] - diameter_mm.copysign(places[0][0]), places[0][1]],
            near if near < diameter_mm => {
                let away = diameter_mm / near;
                [places[0][0] + x * away, places[0][1] + y * away]
            }
            _ => place,
        });
    }
    (places, touching)
}

/// Currents of all pads where the first one has 1 V: the first column of the inverse.
pub fn answered(ohm: Vec<Vec<Complex64>>) -> Vec<Complex64> {
    let driven =
        (0..ohm.len()).map(|k| vec![Complex64::from(f64::from(u8::from(k == 0)))]).collect();
    solve(ohm, driven).into_iter().flatten().collect()
}

/// A symmetric matrix from what is above its diagonal, which is zero.
pub fn symmetric(count: usize, above: impl Fn(usize, usize) -> Complex64) -> Vec<Vec<Complex64>> {
    let mut matrix = vec![vec![Complex64::ZERO; count]; count];
    for (k, l) in (0..count).flat_map(|k| (k + 1..count).map(move |l| (k, l))) {
        matrix[k][l] = above(k, l);
        matrix[l][k] = matrix[k][l];
    }
    matrix
}

/// jωC/(1 + jωC·R_p): a pad's capacitance in series with the sheet, S.
pub fn admittance(rad_s: f64, capacitance_f: f64, sheet_ohm: Complex64) -> Complex64 {
    let capacitive = Complex64::new(0.0, rad_s * capacitance_f);
    capacitive / (capacitive * sheet_ohm + 1.0)
}
