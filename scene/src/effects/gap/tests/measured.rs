// SPDX-License-Identifier: MIT OR Apache-2.0
//! The electroadhesive clutch that Rauf and Follmer measured (EML 79:102382, 2025; docs/physics.md §3): brass pins on a
//! polymer of high permittivity, whose contact spots attract and whose mean gap decides the capacitance.

use super::*;
use crate::device::EPSILON_0;

/// Insulators of 0.622 µm of air at the carrier's frequency.
const INSULATOR: &str = "insulator_um = 0.622\ninsulator_permittivity = 1\n";

/// A patch of an area with nothing but these keys; loads are in N.
fn clutch(area_mm2: f64, keys: &str) -> Rubber {
    let Rubber { law, patches, .. } = pad(&format!("{INSULATOR}{keys}"));
    Rubber::new(law, patches, vec![1e-6 * area_mm2], 1.0 / (1e-6 * area_mm2))
}

/// With a contact share, of a pin of 2 mm: insulators of 0.472 µm at the haptic frequency.
fn touching() -> Rubber {
    let permittivity = 0.622 / 0.472;
    clutch(
        21.0,
        &format!(
            "rest_um = [256.622]\nspring_pa_per_m = 4.88e9\ncontact_pa = 50.4e6\ncontact_decay_um = 68\n\
             contact_hardness_pa = 3.64e6\nhaptic_permittivity = {permittivity}"
        ),
    )
}

fn gaps_m(pad: &Rubber, volt: f64, load_n: f64) -> Vec<f64> {
    pad.equilibrium_m(Drive::new(volt, pad.pa_per_g * load_n)).collect()
}

fn capacitance_pf(pad: &Rubber, load_n: f64) -> f64 {
    1e12 * pad.capacitance_f(gaps_m(pad, 0.0, load_n).into_iter())
}

/// Without a hardness: C over load at 0 V, within 3 % RMS, by which measurements of one width differ.
#[test]
fn capacitance_over_load_is_that_of_two_pins() {
    for (area_mm2, keys, measured_pf) in [
        (
            21.0,
            "rest_um = [7.949]\nspring_pa_per_m = 2.156e10\ncontact_pa = 1.243e9\ncontact_decay_um = 0.4814\n\
             contact_hardness_pa = 1e15",
            [26.5, 30.0, 33.3, 36.9, 40.7],
        ),
        (
            66.7,
            "rest_um = [21.591]\nspring_pa_per_m = 1.721e9\ncontact_pa = 1.2013e6\ncontact_decay_um = 1.7650\n\
             contact_hardness_pa = 1e15",
            [34.8, 44.0, 63.9, 85.3, 114.1],
        ),
    ] {
        let pin = clutch(area_mm2, keys);
        let off = [0.5, 1.0, 2.0, 4.0, 8.0].into_iter().zip(measured_pf);
        let off: Vec<f64> =
            off.map(|(load_n, pf)| capacitance_pf(&pin, load_n) / pf - 1.0).collect();
        let rms = (off.iter().map(|off| off * off).sum::<f64>() / 5.0).sqrt();
        assert!(rms < 0.03, "{area_mm2} mm²: {off:?}");
    }
}

/// Measured at 100, 125 … 300 V; the load is not stated, and 0.1 N is taken.
#[test]
fn friction_of_contact_spots_is_that_of_a_clutch() {
    const MU: f64 = 0.188;
    let measured_n = [0.100, 0.141, 0.166, 0.269, 0.316, 0.481, 0.504, 0.730, 0.838];
    let force_n = |pad: &Rubber, volt: f64| {
        let gaps_m = gaps_m(pad, volt, 0.1);
        MU * pad.attraction_n(gaps_m.into_iter(), Drive::new(volt, 0.0).pull_n)
    };
    let pad = touching();
    for (step, measured_n) in measured_n.into_iter().enumerate() {
        let part = force_n(&pad, 100.0 + 25.0 * step as f64) / measured_n;
        assert!((0.75..1.1).contains(&part), "{step}: {part}");
    }
    // Without contact spots attraction is that of the mean gap, which gives a thirtieth.
    let mut free = touching();
    free.law.contact_hardness_pa = 1e15;
    assert!(force_n(&free, 200.0) < 0.04, "{}", force_n(&free, 200.0));
}

/// Attraction is the rise of the energy ½CV² as the gap closes, and its slope that of the attraction.
#[test]
fn attraction_is_the_slope_of_the_energy() {
    let law = Law { haptic_insulator_m: 0.622e-6, ..touching().law };
    // Where the share that touches does not change, it is that of two capacitors side by side.
    let law = Law { contact_decay_m: 1.0, ..law };
    let drive = Drive::new(200.0, 0.0);
    let per_area = |gap_m: f64| {
        let share = law.contact_share(gap_m).value;
        EPSILON_0 * (share / law.insulator_m + (1.0 - share) / (gap_m + law.insulator_m))
    };
    let (gap_m, step_m) = (5e-6, 1e-9);
    let patch = Patch { rest_m: gap_m, load_share: 1.0 };
    let pressure =
        |gap_m: f64| law.rubber(gap_m, patch.rest_m).value - law.relaxed(gap_m, patch, drive).value;
    let energy = 0.5 * 200.0 * 200.0 * (per_area(gap_m - step_m) - per_area(gap_m + step_m));
    let share = law.contact_share(gap_m).value;
    let touching = share * drive.pull_n / law.insulator_m.powi(2);
    let found = pressure(gap_m) - touching;
    assert!((energy / (2.0 * step_m) / found - 1.0).abs() < 1e-3, "{energy} {found}");
}

/// The slope that Newton's steps take is that of the pressure.
#[test]
fn slopes_are_those_of_the_pressure() {
    let Rubber { law, patches, .. } = touching();
    let drive = Drive::new(300.0, 1e4);
    for gap_m in [1e-6, 20e-6, 100e-6, 250e-6] {
        let at = |gap_m: f64| law.relaxed(gap_m, patches[0], drive);
        let step_m = 1e-4 * gap_m;
        let rise = (at(gap_m + step_m).value - at(gap_m - step_m).value) / (2.0 * step_m);
        assert!((rise / at(gap_m).slope - 1.0).abs() < 1e-6, "{gap_m} m: {rise}");
    }
}

/// Followed in steps or found in closed form, the gap is the same where nothing touches.
#[test]
fn gaps_that_are_followed_are_those_of_the_closed_form() {
    let closed = pad("");
    let followed = pad("contact_hardness_pa = 1e15");
    for load_g in [20.0, 100.0] {
        for volt in (0..=50).map(|step| 10.0 * f64::from(step)) {
            let drive = Drive::new(volt, closed.pa_per_g * load_g);
            let pairs = closed.equilibrium_m(drive).zip(followed.equilibrium_m(drive));
            for (closed_m, followed_m) in pairs {
                let off_m = closed_m - followed_m;
                assert!(off_m.abs() < 1e-11, "{load_g} g, {volt} V: {closed_m} {followed_m}");
            }
        }
    }
}

/// A patch that moves comes to rest in its equilibrium.
#[test]
fn a_patch_with_contact_spots_comes_to_rest() {
    let Rubber { law, patches, .. } = touching();
    let drive = Drive::new(250.0, 5e3);
    let rest_m = equilibrium(&law, patches[0], drive);
    for method in [Method::ImplicitEuler, Method::TrBdf2] {
        let mut at = at_rest(&law, patches[0], equilibrium(&law, patches[0], Drive::new(0.0, 5e3)));
        for _ in 0..20_000 {
            at = step_alone(method, &law, patches[0], at, 1e-3, &method.stages(|_| drive));
        }
        assert!((at.gap_m / rest_m - 1.0).abs() < 1e-4, "{method:?}: {} {rest_m}", at.gap_m);
    }
}
