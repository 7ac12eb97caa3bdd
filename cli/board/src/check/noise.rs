// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which channel is noisy: noise of one terminal moves both ratios and the capacitance along one direction.
//!
//! ```text
//!   dr_x = (±_x − r_x)·da/Σa,   dr_y = (±_y − r_y)·da/Σa,   dC/C = da/Σa       of a terminal's amplitude a
//!   noise of the sensing voltage moves C alone
//! ```
//!
//! At each place the terminal's variances are those of its direction times one factor, which is the least squares' one.

use super::Datum;
use super::expected::Expected;
use super::report::Finding;

/// Scatter of a ratio that a sound board does not show.
const RATIO: f64 = 1.0e-3;
/// Relative scatter of a capacitance that a sound board does not show, where its ratios are quiet.
const CAPACITANCE: f64 = 4.0e-3;

/// Noise of one terminal departs less from its direction: at most 0.20 on three devices, that of two 0.10 to 0.48.
const SEVERAL: f64 = 0.22;

/// The noisy channel, where there is one.
pub(super) fn findings(expected: &Expected, data: &[Datum]) -> Option<Finding> {
    let data: Vec<&Datum> = data.iter().filter(|datum| datum.is_valid()).collect();
    let of_ratios = |datum: &&Datum| (datum.scatter[0] + datum.scatter[1]).sqrt();
    let of_capacitance = |datum: &&Datum| datum.scatter[3].sqrt();
    if median(data.iter().map(of_ratios)) > RATIO {
        let terminals = 0..expected.terminals();
        let misfit = |terminal: &usize| misfit(expected.signs[*terminal], &data);
        let best = terminals.min_by(|a, b| misfit(a).total_cmp(&misfit(b)))?;
        return Some(match misfit(&best) < SEVERAL {
            true => Finding::Noisy { channel: best },
            false => Finding::AllNoisy,
        });
    }
    let is_noisy = median(data.iter().map(of_capacitance)) > CAPACITANCE;
    is_noisy.then_some(Finding::Noisy { channel: expected.terminals() })
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// How badly one factor on a terminal's directions explains all variances: one minus the squared cosine between them.
fn misfit(sign: [f64; 2], data: &[&Datum]) -> f64 {
    let (mut product, mut own, mut others) = (0.0, 0.0, 0.0);
    for datum in data {
        // The sum of currents is as the capacitance.
        let scale = datum.mean[2].max(1e-3).powi(-2);
        let [x, y] = [0, 1].map(|axis| sign[axis] - datum.mean[axis]);
        let model = [x * x, y * y, x * y].map(|of| of * scale);
        for (of_model, measured) in model.iter().zip(datum.scatter) {
            product += of_model * measured;
            own += of_model * of_model;
            others += measured * measured;
        }
    }
    1.0 - product.max(0.0).powi(2) / (own * others).max(f64::MIN_POSITIVE)
}
