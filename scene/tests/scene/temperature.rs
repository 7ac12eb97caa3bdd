// SPDX-License-Identifier: MIT OR Apache-2.0
//! A film that is warmer than at its calibration: everything that is computed from the sheet sees
//! the same changed film.

use crate::common::{plant, timing};
use hapticore_scene::{Complex, Plant, Scene, Truth};

/// Two pads, so that they can be coupled.
const PADS: &str = "dwell_slots = 4\n[[pad]]\nposition_mm = [120, -60]\nhaptic_v_rms = 150\n\
                    [[pad]]\nposition_mm = [160, 30]\ncapacitance_pf = 760\n";

/// 25 K at 4000 ppm/K: a tenth more.
const TENTH: &str = "[temperature]\ntempco_ppm_per_k = 4000\nrise_k = 25\n";

/// Truth and amplitudes of a slot.
type Slot = (Truth, Vec<Complex>);

/// Four slots.
fn see(text: &str) -> Vec<Slot> {
    let mut plant = plant(text);
    let mut one = |slot| {
        let mut phasors = vec![Complex::default(); plant.channels() - 1];
        plant.phasors(slot, &mut phasors);
        (plant.truth(slot), phasors)
    };
    (0..4).map(&mut one).collect()
}

/// The largest difference of R_p, of a ratio and of an amplitude, by the size of each.
fn difference(a: &[Slot], b: &[Slot]) -> f64 {
    let one = |((a, p), (b, q)): (&Slot, &Slot)| {
        let size = q.iter().map(|q| q.norm()).fold(0.0, f64::max);
        let amplitudes = p.iter().zip(q).map(|(p, q)| (p - q).norm() / size);
        let truths = [a.sheet_ohm / b.sheet_ohm - 1.0, a.r_x - b.r_x, a.r_y - b.r_y];
        amplitudes.chain(truths.map(f64::abs)).fold(0.0, f64::max)
    };
    a.iter().zip(b).map(one).fold(0.0, f64::max)
}

/// Shunt and coupling, alone and together, at each of their levels.
const ABOVE: [&str; 6] = [
    "",
    "[shunt]\nnanofarad_per_m2 = 22\n",
    "[shunt]\nnanofarad_per_m2 = 22\nrung = \"series\"\n",
    "[coupling]\n",
    "[coupling]\nrung = \"once\"\n",
    "[shunt]\nnanofarad_per_m2 = 22\n[coupling]\n",
];

#[test]
fn an_even_rise_is_a_film_of_more_resistance_for_sheet_shunt_and_coupling_alike() {
    for level in ["distance", "bilinear", "bicubic", "analytic", "grid-20-mm"] {
        for above in ABOVE {
            let sheet = |more: &str| {
                format!("{PADS}[sheet]\nterminal_ohm = 300\nrung = \"{level}\"\n{more}{above}")
            };
            let [cold, warm, more] =
                [sheet(""), sheet("") + TENTH, sheet("ohm_per_square = 165\n")]
                    .map(|text| see(&text));
            assert!(
                difference(&warm, &more) < 1e-12,
                "{level}, {above}: {:e}",
                difference(&warm, &more)
            );
            assert!(difference(&warm, &cold) > 1e-3, "{level}, {above}: nothing changed");
        }
    }
}

/// Each of the three follows by itself: a shunt and a coupling on the cold film would be far off
/// those on the warm one.
#[test]
fn what_shunt_and_coupling_change_is_not_that_of_the_cold_film() {
    for above in &ABOVE[1..] {
        let sheet = |film: &str, above: &str| {
            see(&format!("{PADS}[sheet]\nterminal_ohm = 300\nrung = \"analytic\"\n{film}{above}"))
        };
        let change = |film: &str| {
            let (with, without) = (sheet(film, above), sheet(film, ""));
            with.iter()
                .zip(&without)
                .map(|((_, p), (_, q))| (p[0] / q[0] - 1.0).norm())
                .fold(0.0, f64::max)
        };
        let (cold, warm) = (change(""), change("ohm_per_square = 165\n"));
        assert!((warm / cold - 1.0).abs() > 0.02, "{above}: {cold} and {warm}");
    }
}

#[test]
fn a_gradient_is_a_film_with_a_slope_and_patches_take_part() {
    const MESH: &str = "rung = \"grid-20-mm\"\nterminal_ohm = 300\n";
    let patch = |ohm: f64| {
        format!(
            "[[sheet.patch]]\ncentre_mm = [200, 50]\nsize_mm = [120, 80]\nohm_per_square = {ohm}\n"
        )
    };
    for above in ["", "[coupling]\n"] {
        let sheet =
            |film: &str, rest: &str| see(&format!("{PADS}[sheet]\n{MESH}{film}{rest}{above}"));
        let cold = sheet("", "");
        let gradient = "[temperature]\ntempco_ppm_per_k = 4000\ngradient_k = [25, -10]\n";
        let (warm, sloped) = (sheet("", gradient), sheet("slope_percent = [10, -4]\n", ""));
        assert!(difference(&warm, &sloped) < 1e-12 && difference(&warm, &cold) > 1e-3);
        // 10 % more in the middle: the same slope is a smaller share of that.
        let (warm, sloped) = (
            sheet("", &format!("{gradient}rise_k = 25\n")),
            sheet(
                &format!(
                    "ohm_per_square = 165\nslope_percent = [{}, {}]\n",
                    10.0 / 1.1,
                    -4.0 / 1.1
                ),
                "",
            ),
        );
        assert!(difference(&warm, &sloped) < 1e-12);
        let (warm, patched) = (
            sheet("", &format!("{}{TENTH}", patch(300.0))),
            sheet("ohm_per_square = 165\n", &patch(330.0)),
        );
        assert!(difference(&warm, &patched) < 1e-12);
    }
}

#[test]
fn a_film_warms_up_over_time_in_steps() {
    let warming = "[temperature]\ntempco_ppm_per_k = 1000\nrise_k = { timeline = [[0, 0], [0.4, 20]] }\nstep_k = 0.5\n";
    let pad = "duration_s = 0.4\n[[pad]]\nposition_mm = [120, -60]\n";
    for (ohm, limit) in [(0, 1e-12), (500, f64::INFINITY)] {
        let scene = |rest: &str| plant(&format!("{pad}[sheet]\nterminal_ohm = {ohm}\n{rest}"));
        let (mut warm, mut cold) = (scene(warming), scene(""));
        let still = cold.truth(0);
        let mut moved = 0.0f64;
        for slot in (0..warm.slots()).step_by(50) {
            let truth = warm.truth(slot);
            let rise_k = (50.0 * truth.time_s / 0.5).round() * 0.5;
            let expected = 1.0 + 1e-3 * rise_k;
            if ohm == 0 {
                assert!(
                    (truth.sheet_ohm / still.sheet_ohm / expected - 1.0).abs() < 1e-12,
                    "{}",
                    truth.time_s
                );
            }
            moved = moved.max((truth.r_x - still.r_x).abs());
        }
        assert!(moved < limit && (ohm == 0 || moved > 1e-4), "{ohm} Ω in series: r_x by {moved}");
    }
}

#[test]
fn a_calibration_is_of_the_film_before_it_warmed_up() {
    let scene = |rest: &str| plant(&format!("{PADS}[sheet]\nterminal_ohm = 300\n{rest}"));
    let (warm, cold) = (scene(TENTH), scene(""));
    assert_eq!(warm.calibration_map(9, 5, 15.0), cold.calibration_map(9, 5, 15.0));
    assert_eq!(warm.measurements(&[[10.0, 20.0]]), cold.measurements(&[[10.0, 20.0]]));
}

#[test]
fn a_rise_of_nothing_changes_no_bit() {
    let scene = |rest: &str| see(&format!("{PADS}[sheet]\n[coupling]\n{rest}"));
    assert_eq!(scene("[temperature]\ntempco_ppm_per_k = 400\n"), scene(""));
}

#[test]
fn what_cannot_be_is_refused_with_its_key() {
    let refused = |text: &str, expected: &str| {
        let text = format!("title = \"t\"\n{PADS}{text}");
        let built =
            Scene::parse(&text, "s.toml", &[]).and_then(|scene| Plant::new(&scene, 0, &timing()));
        let error = built.map(|_| ()).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    };
    refused("[temperature]\ntempco_ppm_per_k = 400\n", "temperature: expected a [sheet] too");
    refused(
        "[sheet]\n[temperature]\nrise_k = 5\n",
        "temperature.tempco_ppm_per_k: expected a number from -100000 to 100000",
    );
    let gradient = "[temperature]\ntempco_ppm_per_k = 400\ngradient_k = [5, 0]\n";
    refused(
        &format!("[sheet]\n{gradient}"),
        "temperature.gradient_k: expected a mesh as sheet.rung",
    );
    refused(
        &format!("[sheet]\nrung = \"grid-20-mm\"\n[shunt]\nnanofarad_per_m2 = 9\n{gradient}"),
        "temperature.gradient_k: expected a mesh as sheet.rung",
    );
    refused(
        "[sheet]\n[temperature]\ntempco_ppm_per_k = 400\nrise_k = { sweep = [1, 2] }\n",
        "rise_k: expected a temperature over time",
    );
    refused(
        "[sheet]\n[temperature]\ntempco_ppm_per_k = -50000\nrise_k = 40\n",
        "expected a film that changes by at most 0.9 of itself, got",
    );
}

/// Relaxed rubber under 50 g at 300 V.
const GAP: &str = "[[pad]]\nposition_mm = [0, 0]\nload_g = 50\nhaptic_v_rms = 300\n[friction]\nrung = \"coulomb\"\n[gap]\n";

/// docs/physics.md §3: κ − 5 % is + 1.4 mN and + 2.5 pF at 50 g and 300 V, between two pull-ins.
#[test]
fn softer_rubber_closes_the_gap() {
    let see = |spring: &str| plant(&format!("{GAP}{spring}")).truth(0);
    let nominal = see("");
    let soft = see("[temperature]\nspring_percent_per_k = -0.5\nrise_k = 10\n");
    let (more_n, more_pf) =
        (soft.force_n - nominal.force_n, soft.capacitance_pf - nominal.capacitance_pf);
    println!("+{more_n:.4} N, +{more_pf:.1} pF");
    assert!((more_n - 0.00136).abs() < 2e-5 && (more_pf - 2.494).abs() < 0.02);
}

#[test]
fn warm_rubber_is_rubber_of_another_spring_at_every_level() {
    for rung in
        ["static", "hysteresis", "quasi-static", "semi-implicit", "implicit-euler", "tr-bdf2"]
    {
        let see = |keys: &str| {
            let mut plant = plant(&format!("duration_s = 0.05\n{GAP}rung = \"{rung}\"\n{keys}"));
            (0..plant.slots()).map(|slot| plant.truth(slot)).collect::<Vec<_>>()
        };
        let [cold, warm, stiff] = [
            "",
            "[temperature]\nspring_percent_per_k = 0.5\nrise_k = 20\n",
            "spring_pa_per_m = 4.95e7\n",
        ]
        .map(see);
        let off = |a: &[Truth], b: &[Truth]| {
            let off = |(a, b): (&Truth, &Truth)| (a.capacitance_pf / b.capacitance_pf - 1.0).abs();
            a.iter().zip(b).map(off).fold(0.0, f64::max)
        };
        assert!(off(&warm, &stiff) < 1e-9, "{rung}: {:e}", off(&warm, &stiff));
        assert!(off(&warm, &cold) > 1e-3, "{rung}: {:e}", off(&warm, &cold));
    }
}

#[test]
fn rubber_that_warms_up_is_where_rubber_of_that_warmth_is() {
    let warming =
        "[temperature]\nspring_percent_per_k = 0.5\nrise_k = { timeline = [[0, 0], [0.2, 20]] }\n";
    let mut moving = plant(&format!("duration_s = 0.2\n{GAP}{warming}"));
    for slot in (0..moving.slots()).step_by(40) {
        let truth = moving.truth(slot);
        let spring = 4.5e7 * (1.0 + 0.005 * 100.0 * truth.time_s);
        let still = plant(&format!("{GAP}spring_pa_per_m = {spring}\n")).truth(0);
        assert!((truth.capacitance_pf / still.capacitance_pf - 1.0).abs() < 1e-9);
    }
    let dynamic = |us: u32| {
        let text = format!("duration_s = 0.2\n{GAP}rung = \"tr-bdf2\"\nstep_us = {us}\n{warming}");
        let mut plant = plant(&text);
        plant.truth(plant.slots() - 1).capacitance_pf
    };
    assert!((dynamic(100) / dynamic(10) - 1.0).abs() < 1e-4);
}

#[test]
fn a_calibration_is_of_rubber_before_it_warmed_up() {
    let points = |keys: &str| {
        plant(&format!("{GAP}{keys}")).friction_calibration(&[20.0, 100.0], &[0.0, 300.0])
    };
    let warm = "[temperature]\nspring_percent_per_k = 0.5\nrise_k = 20\n";
    assert_eq!(points(warm), points(""));
}
