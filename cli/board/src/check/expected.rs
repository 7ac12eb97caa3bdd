// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a sound device reads: shares of the terminals' currents at the places of the check.

use std::f64::consts::TAU;

use anyhow::{Context, Result, ensure};
use hapticore_contract::profile::Profile;
use hapticore_host::DeviceCalibration;
use hapticore_run::lab::shares;

/// Places, and what is expected there.
pub(crate) struct Expected {
    /// Where pads are put, mm: the place of each terminal's largest share.
    pub places: Vec<[f64; 2]>,
    /// Signs of the terminals in both ratios.
    pub signs: Vec<[f64; 2]>,
    /// Shares of the terminals by place and part of a pad.
    shares: Vec<Vec<Vec<f64>>>,
    /// ωR by place, 1/pF.
    omega_r: Vec<f64>,
    /// Pads, split ones counted once.
    pads: usize,
}

impl Expected {
    /// Of a device with a board of the profile.
    ///
    /// # Errors
    /// A calibration without shares.
    pub fn new(
        profile: &Profile,
        device: &DeviceCalibration,
        parts_mm: &[[f64; 2]],
    ) -> Result<Self> {
        let known = device.shares.as_ref().context(
            "--calibration: expected a calibration with [shares], as hapticore calibrate writes it from currents of all \
             terminals",
        )?;
        let terminals = profile.terminals.x.len();
        let place_of = |terminal: usize| {
            let best =
                known.places.iter().max_by(|a, b| a[2 + terminal].total_cmp(&b[2 + terminal]));
            best.map(|row| [row[0], row[1]])
        };
        let places: Vec<_> = (0..terminals).filter_map(place_of).collect();
        let pads = profile.pads as usize / parts_mm.len();
        ensure!(
            pads <= places.len(),
            "expected at most {} pads, a place for each, got {pads}",
            places.len()
        );
        let at = |place: &[f64; 2]| {
            let of_part = |part: &[f64; 2]| {
                let at = [place[0] + part[0], place[1] + part[1]];
                // Near a terminal shares change faster than an interpolation follows.
                let own =
                    known.places.iter().find(|row| row[..2] == at).map(|row| row[2..].to_vec());
                own.or_else(|| shares::predicted(known, at, None))
                    .context("--calibration: shares on a line")
            };
            parts_mm.iter().map(of_part).collect::<Result<Vec<_>>>()
        };
        let omega = TAU * device.device.carrier_hz * 1e-12;
        let ohm = |place: &[f64; 2]| {
            let square = |of: &[f64; 5]| (of[0] - place[0]).powi(2) + (of[1] - place[1]).powi(2);
            let nearest = device.map.places.iter().min_by(|a, b| square(a).total_cmp(&square(b)));
            nearest.map_or(0.0, |of| omega * of[4])
        };
        let signs = profile.terminals.x.iter().zip(&profile.terminals.y);
        Ok(Expected {
            shares: places.iter().map(at).collect::<Result<_>>()?,
            omega_r: places.iter().map(ohm).collect(),
            signs: signs.map(|(x, y)| [f64::from(*x), f64::from(*y)]).collect(),
            places,
            pads,
        })
    }

    /// How many parts a pad has.
    pub fn parts(&self) -> usize {
        self.shares.first().map_or(1, Vec::len)
    }

    /// How many pads as the board numbers them, each part of a split one with a select line of its own.
    pub fn selects(&self) -> usize {
        self.pads * self.parts()
    }

    /// How many terminals.
    pub fn terminals(&self) -> usize {
        self.signs.len()
    }

    /// The place of each pad in a round: over all rounds each pad is at each place.
    pub fn round(&self, round: usize) -> Vec<usize> {
        (0..self.pads).map(|pad| (round + pad) % self.places.len()).collect()
    }

    /// Shares of the terminals where a part of a pad is.
    pub fn shares(&self, place: usize, part: usize) -> &[f64] {
        &self.shares[place][part]
    }

    /// By what the sum of currents is less than that of the capacitance alone, of a capacitance, pF.
    pub fn through_sheet(&self, place: usize, capacitance_pf: f64) -> f64 {
        1.0 / (self.omega_r[place] * capacitance_pf).hypot(1.0)
    }

    /// Ratios and sum of signed amplitudes: what a board reads of them.
    pub fn reading(&self, amplitudes: &[f64]) -> [f64; 3] {
        let sum: f64 = amplitudes.iter().map(|of| of.abs()).sum();
        let ratio = |axis: usize| {
            let signed = amplitudes.iter().zip(&self.signs).map(|(of, sign)| of.abs() * sign[axis]);
            signed.sum::<f64>() / sum.max(f64::MIN_POSITIVE)
        };
        [ratio(0), ratio(1), amplitudes.iter().sum::<f64>().abs()]
    }
}
