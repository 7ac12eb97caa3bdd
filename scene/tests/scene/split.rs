// SPDX-License-Identifier: MIT OR Apache-2.0
//! Split pads: how a push tilts them, what strips of a disc carry, and electrodes at a voltage of
//! their own.

use crate::common::timing;
use hapticore_scene::{Plant, Scene, Truth};

fn plant(text: &str) -> Plant {
    let scene = Scene::parse(&format!("title = \"t\"\n{text}"), "s.toml", &[]);
    Plant::new(&scene.unwrap_or_else(|error| panic!("{error}")), 0, &timing()).unwrap()
}

fn last(text: &str) -> Truth {
    let mut plant = plant(text);
    let slots = plant.slots();
    plant.truth(slots - 1)
}

/// A hand that only pushes, so that the pad sticks: 0.05 N along x.
const PUSHED: &str =
    "[hand]\nstiffness_n_per_m = 0\ndamping_n_s_per_m = 0\n[friction]\n[gap]\nrung = \"tr-bdf2\"\n";

fn pad(more: &str) -> String {
    format!(
        "duration_s = 0.3\n[[pad]]\nposition_mm = [0, 0]\nload_g = 50\nhaptic_v_rms = 200\n{more}\n"
    )
}

/// e = height·F/W: 4 mm · 0.05 N / (0.05 kg · g), from the first step of friction on.
#[test]
fn a_push_at_a_height_tilts_the_pad_as_so_much_eccentricity_does() {
    let eccentricity_mm = 4.0 * 0.05 / (0.05 * 9.80665);
    let of = |push_n: f64, height_mm: f64| {
        let pushed = pad(&format!("push_x_n = {push_n}"));
        last(&format!("{pushed}{PUSHED}[halves]\npush_height_mm = {height_mm}\n"))
    };
    let step = format!("[[0, 0], [0.0001, 0], [0.0001, {eccentricity_mm}]]");
    let set = pad(&format!("eccentricity_mm = {{ timeline = {step} }}"));
    let set = last(&format!("{set}{PUSHED}[halves]\n"));
    let tilted = of(0.05, 4.0);
    assert!(set.direction > 3e-5, "{set:?}");
    assert!((tilted.direction / set.direction - 1.0).abs() < 1e-9, "{tilted:?} {set:?}");
    assert_eq!(tilted.hand_n, [0.05, 0.0]);
    assert_eq!(of(-0.05, 4.0).direction, -tilted.direction);
    assert_eq!(of(0.05, 0.0).direction, 0.0);
    let far = of(0.05, 1e3);
    let tips = of(0.05, 7.5 / 4.0 * 4.0 * 0.4903325 / 0.05);
    assert_eq!(far.direction, tips.direction, "beyond 7.5 mm the pad tips");
}

/// A segment of a disc that begins at t radii has (acos t − t√(1−t²))/π of its area.
#[test]
fn strips_of_a_disc_share_its_capacitance_by_area() {
    let strips = |outer: f64| {
        let strips = format!("[gap]\n[halves]\nstrips = 4\nouter_share_percent = {outer}\n");
        last(&format!("[[pad]]\nposition_mm = [0, 0]\nload_g = 50\n{strips}"))
    };
    let Truth { electrodes_pf: [a, b, c, d], capacitance_pf, direction, .. } = strips(20.0);
    assert_eq!((a, b, direction), (d, c, 0.0));
    assert!((a / b - 0.25).abs() < 1e-9 && (a + b + c + d - capacitance_pf).abs() < 1e-9);
    let halves = last("[[pad]]\nposition_mm = [0, 0]\nload_g = 50\n[gap]\n[halves]\n");
    assert!((halves.capacitance_pf - capacitance_pf).abs() < 1e-9);
    assert_eq!(halves.electrodes_pf[2..], [0.0; 2]);
}

/// Loads per area are W·(1 + e·x/ρ²). With the places of the strips, by sums over the disc in this
/// test, they balance the moment of the push. A small e moves each by the slope of C times that.
#[test]
fn strips_balance_the_moment_of_the_push() {
    let strips = |eccentricity_mm: f64, load_g: f64| {
        let pad = format!(
            "[[pad]]\nposition_mm = [0, 0]\nload_g = {load_g}\neccentricity_mm = {eccentricity_mm}\n"
        );
        last(&format!("{pad}[gap]\n[halves]\nstrips = 4\nouter_share_percent = 30\n")).electrodes_pf
    };
    // Columns of the disc from the middle outwards: area and first moment, until 35 % of it.
    let (steps, radius_mm) = (200_000, 15.0);
    let (mut sums, mut area) = ([[0.0; 2]; 2], 0.0);
    for n in 0..steps {
        let t = (f64::from(n) + 0.5) / f64::from(steps);
        let column = 2.0 / std::f64::consts::PI * (1.0 - t * t).sqrt() / f64::from(steps);
        let strip = usize::from(area >= 0.35);
        area += column;
        sums[strip][0] += column;
        sums[strip][1] += column * t * radius_mm;
    }
    let places = sums.map(|[area, moment]| moment / area);
    let square_mm2: f64 = sums.iter().zip(places).map(|([area, _], x)| 2.0 * area * x * x).sum();
    let (e, load_g) = (0.01, 50.0);
    let tilted = strips(e, load_g);
    for (n, x) in [-places[1], -places[0], places[0], places[1]].into_iter().enumerate() {
        let expected = strips(0.0, load_g * (1.0 + e * x / square_mm2))[n];
        let change = tilted[n] - strips(0.0, load_g)[n];
        let off = tilted[n] - expected;
        assert!(off.abs() < 1e-4 * change.abs(), "{n}: {off} of {change}");
    }
}

#[test]
fn sensing_strips_stay_at_their_voltage_and_the_inner_ones_brake() {
    let at = |volts: f64, more: &str| {
        let pad = format!(
            "duration_s = 0.2\n[[pad]]\nposition_mm = [0, 0]\nload_g = 50\nhaptic_v_rms = {volts}\n"
        );
        last(&format!("{pad}[friction]\n[gap]\nrung = \"tr-bdf2\"\n[halves]\nstrips = 4\n{more}"))
    };
    let [high, low, all] = [at(380.0, "sensing_v_rms = 150\n"), at(150.0, ""), at(380.0, "")];
    assert_eq!(high.electrodes_pf[0].to_bits(), low.electrodes_pf[0].to_bits());
    assert_eq!(high.electrodes_pf[1].to_bits(), all.electrodes_pf[1].to_bits());
    let part = |truth: &Truth| truth.force_n;
    // The outer strips are a fifth of the pad: its gaps are the same in each.
    let expected = 0.8 * part(&all) + 0.2 * part(&low);
    assert!((part(&high) - expected).abs() < 1e-9, "{} N, expected {expected}", part(&high));
}

/// The push is kept at times of its own, so that looks change nothing.
#[test]
fn a_tilted_pad_does_not_depend_on_who_looks() {
    let moving = "position_mm = { timeline = { x_mm = [[0, 0], [0.05, 3], [0.1, -2], [0.2, 5]] } }";
    let text = format!(
        "duration_s = 0.2\n[[pad]]\n{moving}\nload_g = 60\nhaptic_v_rms = 250\n[hand]\n[friction]\n\
         [gap]\nrung = \"tr-bdf2\"\n[halves]\npush_height_mm = 5\n"
    );
    let mut every = plant(&text);
    let slots = every.slots();
    let all: Vec<Truth> = (0..slots).map(|slot| every.truth(slot)).collect();
    let mut some = plant(&text);
    for slot in (0..slots).step_by(7) {
        assert_eq!(some.truth(slot), all[slot], "slot {slot}");
    }
    assert!(
        all.iter().any(|truth| truth.direction > 5e-5)
            && all.iter().any(|truth| truth.direction < -5e-5)
    );
}

#[test]
fn a_timeline_leads_from_point_to_point() {
    let text = "duration_s = 2\n[[pad]]\nposition_mm = { timeline = { x_mm = [[0.5, -20], [1.5, 10]], y_mm = [[0, 7]] } }\n";
    let mut plant = plant(text);
    for slot in 0..plant.slots() {
        let Truth { time_s, x_mm, y_mm, .. } = plant.truth(slot);
        let expected = (-20.0 + 30.0 * (time_s - 0.5)).clamp(-20.0, 10.0);
        assert!((x_mm - expected).abs() < 1e-9 && y_mm == 7.0, "{time_s}: {x_mm}");
    }
}

/// What halves that differ read without a push, mm, at 100 g.
fn offset_mm(halves: &str, volts: f64) -> f64 {
    let pad = format!("[[pad]]\nposition_mm = [0, 0]\nload_g = 100\nhaptic_v_rms = {volts}\n");
    430.0 * last(&format!("{pad}[gap]\n[halves]\n{halves}\n")).direction
}

/// docs/physics.md §4: the paper's offset that depends on the voltage.
#[test]
fn halves_of_unequal_height_read_an_offset_that_depends_on_the_voltage() {
    for (percent, volts, expected_mm) in [
        (2.0, 0.0, 0.0237),
        (2.0, 200.0, 0.0859),
        (2.0, 300.0, 0.0164),
        (5.0, 0.0, 0.0578),
        (5.0, 200.0, 0.1319),
        (5.0, 300.0, 0.3354),
    ] {
        let found_mm = offset_mm(&format!("height_mismatch_percent = {percent}"), volts);
        assert!((found_mm - expected_mm).abs() < 1e-4, "{percent} %, {volts} V: {found_mm} mm");
        let lower_mm = offset_mm(&format!("height_mismatch_percent = {}", -percent), volts);
        assert!(lower_mm < 0.0, "{percent} %, {volts} V: {lower_mm} mm");
    }
}

#[test]
fn a_stronger_source_on_the_left_reads_as_a_push_to_the_left_under_voltage_only() {
    let offset = |volts: f64| offset_mm("source_mismatch_percent = 2", volts);
    assert_eq!(offset(0.0), 0.0);
    let [low, high] = [offset(100.0), offset(250.0)];
    assert!(low < 0.0 && high < 2.0 * low, "{low} {high} mm");
    // Its left half is the one of a pad at 2 % more.
    let pad = |volts: f64, halves: &str| {
        let pad = format!("[[pad]]\nposition_mm = [0, 0]\nload_g = 100\nhaptic_v_rms = {volts}\n");
        last(&format!("{pad}[gap]\n[halves]\n{halves}\n")).electrodes_pf
    };
    let [left, right, ..] = pad(250.0, "source_mismatch_percent = 2");
    assert_eq!([left, right], [pad(255.0, "")[0], pad(250.0, "")[1]]);
}

/// A part of its own slot is at its own voltage.
#[test]
fn a_half_at_a_stronger_source_is_measured_at_its_voltage() {
    let text = "[[pad]]\nposition_mm = [0, 0]\nload_g = 100\nhaptic_v_rms = 250\n[gap]\n[halves]\n\
                senses = \"each\"\nsource_mismatch_percent = 2\n";
    let mut plant = plant(text);
    let volts = [0, 1].map(|slot| plant.truth(slot).haptic_v_rms);
    assert!((volts[0] - 255.0).abs() < 1e-9 && volts[1] == 250.0, "{volts:?}");
}

#[test]
fn heights_that_differ_need_patches_without_load() {
    let text = "title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n[gap]\nrest_um = [19]\n[halves]\n\
                height_mismatch_percent = 2\n";
    let message = Scene::parse(text, "s.toml", &[]).unwrap_err().to_string();
    assert!(message.contains("gap.load_shares: expected a patch that bears no load"), "{message}");
}
