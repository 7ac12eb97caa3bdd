// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[gap]`: the air gap under the pad, its capacitance and its attraction, patch by patch.
//!
//! A patch rests at g₀ and is pulled by V and pressed by the load W against a spring and, last, against the contact:
//!
//!   F(g) = κ(g₀ − g) + p₀·e^(−g/λ) − ½ε₀V²/(g+d)² − W/S = 0,   C = Σ ε₀S_i/(g_i+d),   F_e = Σ ½ε₀S_iV²/(g_i+d)²
//!
//! | rung | what |
//! | --- | --- |
//! | `static` | the equilibrium on the branch that starts open: the largest root of F, for the slow (relaxed) spring κ |
//!
//! Without contact F is a cubic in h = g + d, so its largest root, and the fold where it vanishes, have a closed form:
//! V_PI = √(8κh₀³/27ε₀). The contact only adds pressure, so the root with it lies above the cubic's, where F falls
//! steadily: bisection cannot miss it. Past the fold the contact alone holds the patch. Source: PHYSICS §3.

use super::{Effect, Pad, PadEffect, Spec};
use crate::device::{Device, EPSILON_0};
use crate::error::SceneError;
use crate::format::{Limits, Table};

/// Heights g₀ + d of eight patches of equal area, µm: fitted to the paper's Fig. 7 (PHYSICS §3).
const REST_UM: [f64; 8] = [13.0, 14.5, 16.0, 17.5, 19.106, 19.585, 26.0, 34.0];

/// Newtons per gram.
const NEWTON_PER_G: f64 = 9.806_65e-3;

pub(super) fn read(root: &Table, device: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("gap")? else { return Ok(None) };
    let rung = table.choice("rung", &["static"])?.unwrap_or("static");
    let thickness_um = table.number_or("insulator_um", Limits::POSITIVE, 16.0)?;
    let permittivity = table.number_or("insulator_permittivity", Limits::within(1.0, 1e5), 3.2)?;
    let insulator_um = thickness_um / permittivity;
    let rest_um = table.numbers("rest_um", Limits::above(insulator_um, 1e4))?.unwrap_or(REST_UM.to_vec());
    let gap = Gap {
        spring_pa_per_m: table.number_or("spring_pa_per_m", Limits::POSITIVE, 5e8)?,
        contact_pa: table.number_or("contact_pa", Limits::NOT_NEGATIVE, 2e5)?,
        contact_decay_m: 1e-6 * table.number_or("contact_decay_um", Limits::POSITIVE, 0.5)?,
        insulator_m: 1e-6 * insulator_um,
        patch_m2: device.pad_area_m2 / rest_um.len() as f64,
        pad_m2: device.pad_area_m2,
        rest_m: rest_um.iter().map(|um| um * 1e-6).collect(),
        last: None,
    };
    Ok(Spec::new("gap", rung, move |_| Effect::Pad(Box::new(gap.clone()))))
}

#[derive(Clone, Debug)]
struct Gap {
    spring_pa_per_m: f64,
    contact_pa: f64,
    contact_decay_m: f64,
    /// d: thickness of the insulator as so much air.
    insulator_m: f64,
    patch_m2: f64,
    pad_m2: f64,
    /// h₀ = g₀ + d of each patch.
    rest_m: Vec<f64>,
    /// The last answer: over a raster the load and the voltage stay the same.
    last: Option<(Drive, Answer)>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Drive {
    volt: f64,
    load_g: f64,
}

#[derive(Clone, Copy, Debug)]
struct Answer {
    capacitance_f: f64,
    attraction_n: f64,
}

impl PadEffect for Gap {
    fn act(&mut self, pad: &mut Pad) {
        let drive = Drive { volt: pad.haptic_v_rms, load_g: pad.load_g };
        let answer = match self.last {
            Some((same, answer)) if same == drive => answer,
            _ => self.solve(drive),
        };
        self.last = Some((drive, answer));
        pad.capacitance_f = answer.capacitance_f;
        pad.attraction_n = answer.attraction_n;
    }
}

impl Gap {
    fn solve(&self, drive: Drive) -> Answer {
        let pull = 0.5 * EPSILON_0 * drive.volt.powi(2);
        let pressure_pa = drive.load_g * NEWTON_PER_G / self.pad_m2;
        let heights = self.rest_m.iter().map(|rest| self.height(*rest, pull, pressure_pa));
        heights.fold(Answer { capacitance_f: 0.0, attraction_n: 0.0 }, |sum, height| Answer {
            capacitance_f: sum.capacitance_f + EPSILON_0 * self.patch_m2 / height,
            attraction_n: sum.attraction_n + pull * self.patch_m2 / height.powi(2),
        })
    }

    /// h = g + d in equilibrium on the open branch; the insulators themselves do not yield, so g is never negative.
    fn height(&self, rest_m: f64, pull: f64, pressure_pa: f64) -> f64 {
        let balance = |height: f64| self.balance(height, rest_m, pull, pressure_pa);
        let unpulled = rest_m - pressure_pa / self.spring_pa_per_m;
        let top = rest_m + self.contact_pa / self.spring_pa_per_m;
        let fold = (unpulled * 2.0 / 3.0).max(self.insulator_m);
        match open_height(unpulled, pull / self.spring_pa_per_m) {
            Some(open) => root(open.max(self.insulator_m), top, balance),
            None if balance(fold).0 >= 0.0 => root(fold, top, balance),
            None => root(self.insulator_m, fold, balance),
        }
    }

    /// F at a height, and its slope.
    fn balance(&self, height: f64, rest_m: f64, pull: f64, pressure_pa: f64) -> (f64, f64) {
        let contact = self.contact_pa * (-(height - self.insulator_m) / self.contact_decay_m).exp();
        let attraction = pull / height.powi(2);
        let force = self.spring_pa_per_m * (rest_m - height) + contact - attraction - pressure_pa;
        (force, -self.spring_pa_per_m - contact / self.contact_decay_m + 2.0 * attraction / height)
    }
}

/// Largest root of h²(H − h) = a, by the trigonometric form; none past the fold a = 4H³/27.
fn open_height(unpulled: f64, a: f64) -> Option<f64> {
    let cosine = 1.0 - 13.5 * a / unpulled.powi(3);
    let open = unpulled > 0.0 && cosine >= -1.0;
    open.then(|| unpulled / 3.0 * (1.0 + 2.0 * (cosine.acos() / 3.0).cos()))
}

/// Root between `low` and `high`, where `f` is not positive, to the last bits; `low` where there is none. Newton's steps from
/// `low`, halving the bracket wherever one would leave it.
fn root(mut low: f64, mut high: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut at = low;
    for _ in 0..100 {
        let (value, slope) = f(at);
        *(if value >= 0.0 { &mut low } else { &mut high }) = at;
        let newton = at - value / slope;
        let next = if slope < 0.0 && newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
        if (next - at).abs() <= 1e-15 * at {
            return next;
        }
        at = next;
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAD_M2: f64 = std::f64::consts::PI / 4.0 * 0.03 * 0.03;

    fn gap(rest_um: &[f64], contact_pa: f64) -> Gap {
        Gap {
            spring_pa_per_m: 5e8,
            contact_pa,
            contact_decay_m: 0.5e-6,
            insulator_m: 5e-6,
            patch_m2: PAD_M2 / rest_um.len() as f64,
            pad_m2: PAD_M2,
            rest_m: rest_um.iter().map(|um| um * 1e-6).collect(),
            last: None,
        }
    }

    fn capacitance_pf(gap: &Gap, volt: f64, load_g: f64) -> f64 {
        gap.solve(Drive { volt, load_g }).capacitance_f * 1e12
    }

    #[test]
    fn one_patch_pulls_in_where_the_closed_form_says() {
        let gap = gap(&[19.66], 0.0);
        let pull_in_v = (8.0 * 5e8 * (19.66e-6f64).powi(3) / (27.0 * EPSILON_0)).sqrt();
        assert!((pull_in_v - 356.577).abs() < 5e-3, "{pull_in_v}"); // PHYSICS §3 rounds ε₀ to 8.854e-12
        let height = |volt: f64| gap.height(19.66e-6, 0.5 * EPSILON_0 * volt * volt, 0.0);
        assert!((height(pull_in_v * (1.0 - 1e-9)) / (19.66e-6 * 2.0 / 3.0) - 1.0).abs() < 1e-4);
        assert!((height(pull_in_v * (1.0 + 1e-9)) - 5e-6).abs() < 1e-18);
    }

    #[test]
    fn capacitance_at_rest_is_353_to_373_pf_from_20_to_50_g() {
        let gap = gap(&REST_UM, 2e5);
        let at = |load_g| capacitance_pf(&gap, 0.0, load_g);
        assert!((at(20.0) - 353.0).abs() < 1.0 && (at(50.0) - 373.0).abs() < 1.0, "{} {}", at(20.0), at(50.0));
    }

    #[test]
    fn every_patch_is_in_balance_wherever_it_floats() {
        let gap = gap(&REST_UM, 2e5);
        for (rest, volt) in
            REST_UM.into_iter().flat_map(|um| (0..60).map(move |step| (um * 1e-6, 10.0 * f64::from(step))))
        {
            let pull = 0.5 * EPSILON_0 * volt * volt;
            let height = gap.height(rest, pull, 300.0);
            let (force, slope) = gap.balance(height, rest, pull, 300.0);
            assert!(force.abs() < 1e-6 && slope < 0.0, "{rest} m, {volt} V: {force} Pa at {height} m, slope {slope}");
        }
    }

    #[test]
    fn the_branch_is_the_open_one_up_to_the_fold() {
        let gap = gap(&REST_UM, 2e5);
        for rest in REST_UM.map(|um| um * 1e-6) {
            let fold_v = (8.0 * 5e8 * rest.powi(3) / (27.0 * EPSILON_0)).sqrt();
            let height = |volt: f64| gap.height(rest, 0.5 * EPSILON_0 * volt * volt, 0.0);
            assert!(height(0.999 * fold_v) > rest * 2.0 / 3.0, "{rest}");
            assert!(height(1.15 * fold_v) < rest * 0.6, "{rest}: {}", height(1.15 * fold_v));
        }
    }

    #[test]
    fn capacitance_rises_with_load_and_voltage() {
        let gap = gap(&REST_UM, 2e5);
        for load_g in [0.0, 20.0, 50.0, 100.0] {
            let rising: Vec<f64> = (0..80).map(|step| capacitance_pf(&gap, 10.0 * f64::from(step), load_g)).collect();
            assert!(rising.windows(2).all(|pair| pair[0] <= pair[1]), "{load_g} g: {rising:?}");
            assert!(capacitance_pf(&gap, 300.0, load_g) < capacitance_pf(&gap, 300.0, load_g + 10.0));
        }
    }
}
