// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every number of a scene, however large or small: refused, or a plant whose truth and signals are numbers.

use crate::common::timing;
use hapticore_scene::{Complex, Plant, Scene, Timing};

/// A scene in which every table has its keys.
const SCENE: &str = "title = \"t\"\nduration_s = 0.004\n\
    [[pad]]\nposition_mm = [0, 0]\nload_g = 50\n[[pad]]\nposition_mm = [60, 40]\n\
    [device]\n[sheet]\n[gap]\n[friction]\n[carrier]\n[sensor]\n";

/// Numbers that a key is set to: the smallest there is, what no device has, and the largest.
const EXTREMES: [&str; 14] = [
    "5e-324", "1e-300", "1e-20", "1e-9", "1e-6", "1e-3", "0", "1", "1e3", "1e6", "1e9", "1e20",
    "1e300", "1.7e308",
];

/// Keys, and what else each needs: overrides of the scene.
const KEYS: &[(&str, &[(&str, &str)])] = &[
    ("pad.0.load_g", &[]),
    ("pad.0.haptic_v_rms", &[]),
    (
        "pad.0.haptic_v_rms.sine.frequency_hz",
        &[("pad.0.haptic_v_rms", "{ sine = { mean = 100, amplitude = 50, frequency_hz = 2 } }")],
    ),
    (
        "pad.0.haptic_v_rms.sine.phase_turns",
        &[("pad.0.haptic_v_rms", "{ sine = { mean = 100, amplitude = 50, frequency_hz = 2 } }")],
    ),
    ("pad.0.capacitance_pf", &[("gap", "false")]),
    (
        "pad.0.position_mm.circle.period_s",
        &[("pad.0.position_mm", "{ circle = { radius_mm = 50, period_s = 2 } }")],
    ),
    (
        "pad.0.position_mm.circle.radius_mm",
        &[("pad.0.position_mm", "{ circle = { radius_mm = 50, period_s = 2 } }")],
    ),
    (
        "pad.0.position_mm.circle.phase_turns",
        &[("pad.0.position_mm", "{ circle = { radius_mm = 50, period_s = 2 } }")],
    ),
    (
        "pad.0.position_mm.line.period_s",
        &[("pad.0.position_mm", "{ line = { from_mm = [0, 0], to_mm = [50, 0], period_s = 2 } }")],
    ),
    ("pad.0.push_x_n", &[("hand", "{}")]),
    ("device.width_mm", &[]),
    ("device.height_mm", &[]),
    ("device.pad_diameter_mm", &[]),
    ("device.mu", &[]),
    ("device.gravity_m_s2", &[]),
    ("sheet.ohm_per_square", &[]),
    ("sheet.terminal_ohm", &[]),
    ("sheet.terminal_radius_mm", &[]),
    ("supply.limiting_kohm", &[("supply", "{}")]),
    ("supply.transformer_h", &[("supply", "{}")]),
    ("supply.parasitic_pf", &[("supply", "{}")]),
    ("charge.time_constant_s", &[("charge", "{ share = 0.3, time_constant_s = 0.05 }")]),
    ("gap.insulator_um", &[("gap.rung", "\"tr-bdf2\""), ("gap.contact_decay_um", "0.1")]),
    (
        "gap.insulator_permittivity",
        &[("gap.rung", "\"tr-bdf2\""), ("gap.contact_decay_um", "0.005")],
    ),
    ("gap.contact_hardness_pa", &[]),
    ("gap.contact_hardness_pa", &[("gap.rung", "\"tr-bdf2\"")]),
    ("gap.haptic_permittivity", &[("gap.contact_decay_um", "0.005")]),
    ("gap.spring_pa_per_m", &[("gap.rung", "\"tr-bdf2\"")]),
    ("gap.creep_share", &[("gap.rung", "\"tr-bdf2\"")]),
    ("gap.creep_s", &[("gap.rung", "\"tr-bdf2\"")]),
    ("gap.contact_pa", &[("gap.rung", "\"tr-bdf2\"")]),
    ("gap.contact_decay_um", &[("gap.rung", "\"tr-bdf2\"")]),
    ("gap.film_pa_s", &[("gap.rung", "\"tr-bdf2\"")]),
    ("gap.film_area_share", &[("gap.rung", "\"tr-bdf2\"")]),
    ("gap.film_rest_um", &[("gap.rung", "\"tr-bdf2\"")]),
    ("gap.inertia_kg_m2", &[("gap.rung", "\"tr-bdf2\"")]),
    ("gap.contact_pa", &[]),
    ("gap.contact_decay_um", &[]),
    ("gap.spring_pa_per_m", &[]),
    ("gap.step_us", &[("gap.rung", "\"tr-bdf2\"")]),
    ("halves.mismatch_percent", &[("halves", "{}")]),
    ("halves.height_mismatch_percent", &[("halves", "{}")]),
    ("halves.source_mismatch_percent", &[("halves", "{}")]),
    ("halves.push_height_mm", &[("halves", "{}"), ("hand", "{}")]),
    ("halves.sensing_v_rms", &[("halves", "{ strips = 4 }")]),
    ("hand.stiffness_n_per_m", &[("hand", "{}")]),
    ("hand.damping_n_s_per_m", &[("hand", "{}")]),
    ("hand.mass_kg", &[("hand", "{}")]),
    ("release.time_constant_ms", &[("release", "{}")]),
    ("friction.stiction", &[("friction.rung", "\"lugre\"")]),
    ("friction.stribeck_mm_per_s", &[("friction.rung", "\"lugre\""), ("hand", "{}")]),
    ("friction.bristle_n_per_m", &[("friction.rung", "\"lugre\""), ("hand", "{}")]),
    ("friction.bristle_n_s_per_m", &[("friction.rung", "\"lugre\""), ("hand", "{}")]),
    ("friction.step_us", &[("friction.rung", "\"lugre\"")]),
    ("friction.drift", &[]),
    ("temperature.rise_k", &[("temperature", "{ tempco_ppm_per_k = 400 }")]),
    ("temperature.tempco_ppm_per_k", &[("temperature", "{ rise_k = 15 }")]),
    ("shunt.nanofarad_per_m2", &[("shunt", "{}")]),
    ("carrier.frequency_hz", &[]),
    ("carrier.amplitude_v", &[]),
    ("carrier.haptic_hz", &[]),
    ("carrier.haptic_turn_s", &[("carrier.haptic_wave", "\"square\"")]),
    ("sensor.current_full_scale_ma", &[]),
    ("sensor.sense_full_scale_v", &[]),
    ("sensor.haptic_full_scale_v", &[]),
    ("sensor.bandwidth_khz", &[]),
    ("sensor.series_inductance_mh", &[]),
    ("sensor.noise_ppm_rms", &[]),
    ("sensor.jitter_ns_rms", &[]),
    ("sensor.crosstalk_percent", &[]),
    ("sensor.gain_error_percent", &[]),
    ("sensor.gain_mismatch_percent", &[]),
    ("sensor.offset_percent", &[]),
    ("sensor.dither_lsb_rms", &[("sensor.quantisation_bits", "16")]),
];

/// Whether a scene was refused; what it says otherwise are numbers.
fn is_refused(overrides: &[(String, String)]) -> bool {
    let Ok(scene) = Scene::parse(SCENE, "s.toml", overrides) else { return true };
    let timing = Timing { pads: 16, ..timing() };
    let Ok(mut plant) = Plant::new(&scene, 0, &timing) else { return true };
    for slot in [0, 1, 2, plant.slots().saturating_sub(1).min(20)] {
        let truth = plant.truth(slot);
        let numbers = [
            truth.r_x,
            truth.r_y,
            truth.x_mm,
            truth.y_mm,
            truth.capacitance_pf,
            truth.sheet_ohm,
            truth.haptic_v_rms,
            truth.force_n,
            truth.friction_n,
            truth.haptic_friction_n,
            truth.hand_n[0],
            truth.hand_n[1],
            truth.direction,
        ];
        assert!(numbers.iter().all(|number| number.is_finite()), "{overrides:?}: {truth:?}");
        let mut phasors = vec![Complex::default(); plant.channels() - 1];
        let mean_square = plant.phasors(slot, &mut phasors);
        let of_phasors = phasors.iter().flat_map(|phasor| [phasor.re, phasor.im]);
        let mut samples = Vec::new();
        plant.samples(slot, 0..20, &mut samples);
        let mut signals = of_phasors.chain([mean_square]).chain(samples);
        assert!(signals.all(f64::is_finite), "{overrides:?}: signals");
    }
    false
}

#[test]
fn extreme_numbers_are_refused_or_lead_to_numbers() {
    let owned = |(key, value): (&str, &str)| (key.to_string(), value.to_string());
    let (mut refused, mut ran) = (0, 0);
    for (key, needs) in KEYS {
        let before = ran;
        for value in EXTREMES {
            let overrides: Vec<_> =
                needs.iter().copied().chain([(*key, value)]).map(owned).collect();
            if is_refused(&overrides) {
                refused += 1;
            } else {
                ran += 1;
            }
        }
        assert!(ran > before, "{key}: no value was taken, so that nothing was tried");
    }
    assert!(refused > 200 && ran > 300, "{refused} refused, {ran} ran");
}

#[test]
fn a_film_that_no_mesh_can_hold_is_refused() {
    let text = "title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n[sheet]\nrung = \"grid-20-mm\"\n\
                [[sheet.patch]]\ncentre_mm = [100, 0]\nsize_mm = [200, 100]\nohm_per_square = 300\n";
    let with = |value: &str| {
        let set = [("sheet.patch.0.ohm_per_square".to_string(), value.to_string())];
        Scene::parse(text, "s.toml", &set)
    };
    let message = with("1e-20").expect_err("no such film").to_string();
    assert!(message.contains("ohm_per_square: expected a number from 0.001 to"), "{message}");
    for value in ["1e-3", "1e7"] {
        let mut plant = Plant::new(&with(value).expect("a film"), 0, &timing()).expect("a plant");
        let truth = plant.truth(0);
        assert!(truth.sheet_ohm.is_finite() && truth.r_x.is_finite(), "{value}: {truth:?}");
    }
}

#[test]
fn insulators_thicker_than_the_pad_is_high_name_their_key() {
    let text = "title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n[gap]\ninsulator_um = 100\n";
    let message = Scene::parse(text, "s.toml", &[]).expect_err("no gap is left").to_string();
    assert!(message.contains("s.toml:5: gap.insulator_um: expected"), "{message}");
}
