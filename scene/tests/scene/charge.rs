// SPDX-License-Identifier: MIT OR Apache-2.0
//! Charge in the insulators: the attraction drifts under a voltage with a mean, as closed forms and
//! an integration apart have it, and does not under one that alternates.

use crate::common::ode::{Ode, REST_UM};
use crate::common::{assert_near, scene, standard_timing, timing};
use hapticore_scene::{Plant, Truth};

fn plant(text: &str) -> Plant {
    Plant::new(&scene(text), 0, &standard_timing()).unwrap_or_else(|error| panic!("{error}"))
}

fn truths(text: &str) -> Vec<Truth> {
    let mut plant = plant(text);
    (0..plant.slots()).map(|slot| plant.truth(slot)).collect()
}

const PAD: &str = "[[pad]]\nposition_mm = [0, 0]\nload_g = 50\n";
const DC: &str = "[carrier]\nhaptic_wave = \"dc\"\n";

fn square(turn: &str) -> String {
    format!("[carrier]\nhaptic_wave = \"square\"\n{turn}\n")
}

fn charge(share: f64, time_constant_s: f64) -> String {
    format!("[charge]\nshare = {share}\ntime_constant_s = {time_constant_s}\n")
}

/// k·(C·V)² of 318 pF.
fn force_n(volt: f64) -> f64 {
    plant(PAD).device().force_k * (318e-12 * volt).powi(2)
}

#[test]
fn at_constant_voltage_the_force_decays_or_rises_with_the_charge() {
    for share in [0.4, -0.3] {
        let text = format!(
            "duration_s = 0.5\n{PAD}haptic_v_rms = {{ timeline = [[0, 300], [0.3, 300], [0.3, 0]] }}\n{DC}{}",
            charge(share, 0.08)
        );
        for friction in ["", "[friction]\nrung = \"coulomb\"\n", "[supply]\n"] {
            for truth in truths(&format!("{text}{friction}")) {
                let on_s = truth.time_s.min(0.3);
                let charged_v = 300.0 * share * (1.0 - (-on_s / 0.08f64).exp());
                let expected_n = match truth.time_s < 0.3 {
                    true => force_n(300.0 - charged_v),
                    false => force_n(charged_v * (-(truth.time_s - 0.3) / 0.08).exp()),
                };
                assert!(
                    (truth.force_n - expected_n).abs() < 1e-12,
                    "{share}, {friction}, {} s: {} N, {expected_n} N",
                    truth.time_s,
                    truth.force_n
                );
                let source_v = if truth.time_s < 0.3 { 300.0 } else { 0.0 };
                assert_eq!(truth.haptic_v_rms, source_v, "a sensor of V sees no charge");
            }
        }
    }
}

/// τ_i·ẋ_i = s_i·V − x_i once more, by the midpoint rule with steps of 2 µs.
fn charged_v(traps: &[[f64; 2]], until_s: f64, volt: impl Fn(f64) -> f64) -> f64 {
    let steps = (until_s / 2e-6).ceil();
    let step_s = until_s / steps;
    let each = traps.iter().map(|[share, time_constant_s]| {
        (0..steps as usize).fold(0.0, |held_v: f64, n| {
            let rate =
                |held_v: f64| (share * volt((n as f64 + 0.5) * step_s) - held_v) / time_constant_s;
            held_v + step_s * rate(held_v + 0.5 * step_s * rate(held_v))
        })
    });
    each.sum()
}

#[test]
fn several_time_constants_follow_a_voltage_that_ramps_swings_and_turns() {
    let ramp = "{ timeline = [[0, 0], [0.03, 350], [0.05, 350], [0.0513, 120], [0.1, 200]] }";
    let ramp_v = |time_s: f64| match time_s {
        t if t < 0.03 => 350.0 * t / 0.03,
        t if t < 0.05 => 350.0,
        t if t < 0.0513 => 350.0 - 230.0 * (t - 0.05) / 0.0013,
        t => 120.0 + 80.0 * (t - 0.0513) / 0.0487,
    };
    let sine = "{ sine = { mean = 200, amplitude = 100, frequency_hz = 7 } }";
    let sine_v = |time_s: f64| 200.0 + 100.0 * (std::f64::consts::TAU * 7.0 * time_s).sin();
    type Over = fn(f64) -> f64;
    let volts: [(&str, Over, f64); 2] = [(ramp, ramp_v, 0.02), (sine, sine_v, 0.05)];
    for (words, volt, within_v) in volts {
        for (wave, turn_s) in
            [(DC.to_string(), f64::INFINITY), (square("haptic_turn_s = 0.0043"), 0.0043)]
        {
            let text = format!(
                "duration_s = 0.1\n{PAD}haptic_v_rms = {words}\n{wave}\
                 [charge]\nshare = [0.5, -0.4]\ntime_constant_s = [0.004, 0.07]\n"
            );
            let turned = |time_s: f64| if (time_s / turn_s) as u64 % 2 == 1 { -1.0 } else { 1.0 };
            for truth in truths(&text).iter().step_by(7) {
                let signed_v = |time_s: f64| turned(time_s) * volt(time_s);
                let traps = [[0.5, 0.004], [-0.4, 0.07]];
                let left_v = signed_v(truth.time_s) - charged_v(&traps, truth.time_s, signed_v);
                let found_v = left_v.abs() * (truth.force_n / force_n(left_v)).sqrt();
                assert!(
                    (found_v - left_v.abs()).abs() < within_v,
                    "{wave}, {} s: {found_v} V, {left_v} V",
                    truth.time_s
                );
            }
        }
    }
}

#[test]
fn polarity_that_alternates_keeps_the_force() {
    let see = |wave: &str, charge: &str| {
        truths(&format!("duration_s = 1\n{PAD}haptic_v_rms = 300\n{wave}{charge}"))
    };
    let charge = charge(0.4, 0.1);
    let last = |wave: &str, charge: &str| see(wave, charge).last().unwrap().force_n;
    let full_n = force_n(300.0);
    assert_near("constant", last(DC, &charge), full_n * 0.36, 1e-3);
    // Turns of a sixtieth of τ, x within s·V·tanh(T/2τ) of zero.
    let most = (1.0 + 0.4 * (0.0017f64 / 0.2).tanh()).powi(2);
    for wave in [square(""), square("haptic_turn_s = 0.0017")] {
        for truth in &see(&wave, &charge)[500..] {
            let off = truth.force_n / full_n;
            assert!(off < most && off > 2.0 - most, "{wave}: {off} of the force");
        }
    }
    let bits =
        |charge: &str| see("", charge).iter().map(|t| t.force_n.to_bits()).collect::<Vec<_>>();
    assert!(bits(&charge) == bits(""), "a sine charges nothing");
}

#[test]
fn what_a_start_leaves_decays_under_a_sine() {
    let text =
        format!("duration_s = 0.3\n{PAD}haptic_v_rms = 100\n{}start_v = 200\n", charge(0.4, 0.1));
    for truth in truths(&text) {
        let left_v = 200.0 * (-truth.time_s / 0.1).exp();
        assert_near("force", truth.force_n, force_n(100.0f64.hypot(left_v)), 1e-12);
    }
}

/// The gap's own equations, solved apart under V − V_c.
#[test]
fn a_gap_moves_under_what_charge_leaves_of_the_voltage() {
    let (share, time_constant_s, off_s) = (0.35, 0.03, 0.0602);
    for (rung, within) in [("tr-bdf2", 1e-3), ("trapezoid", 3e-3)] {
        let text = format!(
            "duration_s = 0.08\n{PAD}haptic_v_rms = {{ timeline = [[0, 400], [{off_s}, 400], [{off_s}, 0]] }}\n{DC}{}\
             [gap]\nrest_um = {REST_UM:?}\nrung = \"{rung}\"\n",
            charge(share, time_constant_s)
        );
        let held_v = |time_s: f64| {
            let on_s = time_s.min(off_s);
            let at_off = 400.0 * share * (1.0 - (-on_s / time_constant_s).exp());
            at_off * (-(time_s - on_s) / time_constant_s).exp()
        };
        let left_v =
            |time_s: f64| if time_s < off_s { 400.0 - held_v(time_s) } else { held_v(time_s) };
        let mut ode = Ode::at_rest(50.0, 0.0);
        let mut most_pf = 0.0f64;
        // The midpoint of the integration's steps, as it asks with their starts.
        let drive = |time_s: f64, _: f64| left_v(time_s);
        for truth in truths(&text) {
            if truth.time_s > off_s {
                ode.advance(off_s, drive);
            }
            ode.advance(truth.time_s, drive);
            assert_near(rung, truth.capacitance_pf, ode.capacitance_pf(), within);
            most_pf = most_pf.max(truth.capacitance_pf);
        }
        let uncharged = truths(&text.replace("share = 0.35", "share = 0"));
        let most_uncharged_pf = uncharged.iter().map(|t| t.capacitance_pf).fold(0.0, f64::max);
        println!("{rung}: at most {most_pf} pF, without charge {most_uncharged_pf} pF");
        assert!(most_pf < most_uncharged_pf - 10.0);
    }
}

#[test]
fn a_calibration_is_of_insulators_without_charge() {
    let points = |charge: &str| {
        plant(&format!("{PAD}{DC}[gap]\n{charge}"))
            .friction_calibration(&[20.0, 50.0], &[100.0, 300.0])
    };
    assert_eq!(points(&format!("{}start_v = 100\n", charge(0.4, 1.0))), points(""));
}

#[test]
fn the_haptic_channel_has_the_voltage_with_its_polarity() {
    let last = |wave: &str| {
        let text = format!("duration_s = 0.01\n{PAD}haptic_v_rms = 300\n{wave}");
        let mut plant = Plant::new(&scene(&text), 0, &timing()).unwrap();
        let mut samples = Vec::new();
        (0..10).for_each(|slot| plant.samples(slot, 0..200, &mut samples));
        let channels = plant.channels();
        samples.chunks_exact(channels).map(|row| row[channels - 1] * 600.0).collect::<Vec<_>>()
    };
    assert!(last(DC).iter().all(|volt| *volt == 300.0));
    for (turn, samples) in [("", 200), ("haptic_turn_s = 0.0005", 500)] {
        for (n, volt) in last(&square(turn)).into_iter().enumerate() {
            assert_eq!(volt, if n / samples % 2 == 0 { 300.0 } else { -300.0 }, "sample {n}");
        }
    }
}
