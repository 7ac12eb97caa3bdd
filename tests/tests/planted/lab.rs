// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a lab measures of a device: places, loads, setup.

use std::fmt::Write;

use fastrand::Rng;

use super::device::{CARRIER_HZ, CURRENT_A, Device, HAPTIC_V, RATE_HZ, SENSE_V};

/// k of eq. 8, N/(F·V)², and the coefficient of friction.
const FORCE_K: f64 = 9.6e12;
const MU: f64 = 0.12;

/// A measured place: where, and each current in phase with the sensing voltage and a quarter turn ahead.
pub type Place = ([f64; 2], Vec<[f64; 2]>);

/// The files of a lab, as they will be written.
#[derive(Clone)]
pub struct Lab {
    pub places: Vec<Place>,
    pub sense_v: f64,
    /// Grams, volts, friction in N, pF.
    pub loads: Vec<[f64; 4]>,
    pub setup: String,
}

impl Lab {
    /// What is measured of a device, with a thousandth of noise.
    pub fn of(device: &Device, rng: &mut Rng) -> Lab {
        let mut noisy = |value: f64| value * (1.0 + 1e-3 * (2.0 * rng.f64() - 1.0));
        let [width, height] = device.size_mm;
        let mut places = Vec::new();
        for row in 0..15 {
            for column in 0..23 {
                let at = [
                    (column as f64 / 22.0 - 0.5) * 0.92 * width,
                    (row as f64 / 14.0 - 0.5) * 0.92 * height,
                ];
                let currents = device.currents(318e-12, at).into_iter().map(|current| {
                    let by = noisy(1.0);
                    current.map(|part| part * by)
                });
                places.push((at, currents.collect()));
            }
        }
        let mut loads = Vec::new();
        for (load_g, pf) in [(20.0, 350.0), (60.0, 390.0), (100.0, 420.0)] {
            for volts in [0.0, 80.0, 160.0, 240.0, 320.0] {
                let force = FORCE_K * f64::powi(1e-12 * pf * volts, 2);
                loads.push([load_g, volts, noisy(force + MU * load_g * 9.80665e-3), pf]);
            }
        }
        let setup = format!(
            "pads = {}\nsample_rate_hz = {RATE_HZ:?}\ncarrier_hz = {CARRIER_HZ:?}\ncurrent_full_scale_a = {CURRENT_A}\n\
             sense_full_scale_v = {SENSE_V:?}\nhaptic_full_scale_v = {HAPTIC_V:?}\n[terminals]\nplaces_mm = {:?}\n[sheet]\n\
             width_mm = {width:?}\nheight_mm = {height:?}\n",
            device.pads.len(),
            device.terminals_mm
        );
        Lab { places, sense_v: device.sensing_v(), loads, setup }
    }

    /// The text of the places' file.
    pub fn places_csv(&self) -> String {
        let terminals = self.places[0].1.len();
        let names: Vec<String> = (1..=terminals).map(|k| format!("i{k}_re,i{k}_im")).collect();
        let mut text = format!("x_mm,y_mm,{},v_sense\n", names.join(","));
        for ([x, y], currents) in &self.places {
            write!(text, "{x},{y}").expect("a string takes all");
            currents
                .iter()
                .for_each(|[re, im]| write!(text, ",{re:e},{im:e}").expect("a string takes all"));
            writeln!(text, ",{}", self.sense_v).expect("a string takes all");
        }
        text
    }

    /// The text of the loads' file.
    pub fn loads_csv(&self) -> String {
        let row =
            |[load, volts, newtons, pf]: &[f64; 4]| format!("{load},{volts},{newtons},{pf}\n");
        let rows: String = self.loads.iter().map(row).collect();
        format!("load_g,haptic_v_rms,friction_n,capacitance_pf\n{rows}")
    }
}
