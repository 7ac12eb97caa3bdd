// SPDX-License-Identifier: MIT OR Apache-2.0
//! Defaults that work: what a scene leaves out changes nothing of what it has.

use crate::common::plant;
use hapticore_scene::{Plant, Scene, Truth};

fn level(text: &str, effect: &str) -> String {
    let case = &crate::common::scene(text).cases[0];
    let found = case.effects().into_iter().find(|(name, _)| *name == effect);
    found.expect("the effect is on").1.to_string()
}

const CONTROLLED: &str =
    "duration_s = 1\n[[pad]]\nposition_mm = [0, 0]\ntarget_n = 0.3\n[control]\n[friction]\n";

#[test]
fn a_gap_moves_under_a_controller_unless_the_scene_says_otherwise() {
    assert_eq!(level(&format!("{CONTROLLED}[gap]\n"), "gap"), "tr-bdf2 100 µs");
    assert_eq!(level(&format!("{CONTROLLED}[gap]\nrung = \"static\"\n"), "gap"), "static");
    let free = "duration_s = 1\n[[pad]]\nposition_mm = [0, 0]\n[gap]\n";
    assert_eq!(level(free, "gap"), "static");
}

fn doubts(text: &str) -> Vec<String> {
    crate::common::scene(text).cases[0].doubts.clone()
}

#[test]
fn a_gap_at_rest_under_a_controller_is_a_doubt() {
    for rung in ["static", "hysteresis"] {
        let of = doubts(&format!("{CONTROLLED}[gap]\nrung = \"{rung}\"\n"));
        assert!(of.len() == 1 && of[0].starts_with("gap.rung"), "{of:?}");
    }
    assert!(doubts(&format!("{CONTROLLED}[gap]\n")).is_empty());
}

#[test]
fn gains_of_zero_and_absent_friction_are_doubts() {
    let text = "duration_s = 1\n[[pad]]\nposition_mm = [0, 0]\n[gap]\n[control]\nlaw = \"integral\"\nintegral_v = 0\n";
    let of = doubts(text);
    assert!(
        of.len() == 2 && of[0].starts_with("friction") && of[1].starts_with("control.integral_v"),
        "{of:?}"
    );
}

#[test]
fn a_supply_that_is_slow_for_its_wave_or_for_a_loop_is_a_doubt() {
    let square = "[supply]\nlimiting_kohm = 300\n[carrier]\nhaptic_wave = \"square\"\n";
    assert!(doubts(&format!("{CONTROLLED}[gap]\n{square}")).is_empty());
    let often = doubts(&format!("{CONTROLLED}[gap]\n{square}haptic_turn_s = 0.004\n"));
    assert!(often.len() == 1 && often[0].starts_with("carrier.haptic_turn_s"), "{often:?}");
    let slow = square.replace("300", "3000");
    let of_loop = doubts(&format!("{CONTROLLED}[gap]\n{slow}"));
    assert!(of_loop.len() == 1 && of_loop[0].starts_with("supply.limiting_kohm"), "{of_loop:?}");
    // Without a loop nothing waits for the pad.
    let free = "duration_s = 1\n[[pad]]\nposition_mm = [0, 0]\n[gap]\n";
    assert!(doubts(&format!("{free}{slow}")).is_empty());
}

/// Truths of a pad under 50 g at 300 V.
fn at_300_v(tables: &str) -> Truth {
    let text = format!("[[pad]]\nposition_mm = [0, 0]\nload_g = 50\nhaptic_v_rms = 300\n{tables}");
    plant(&text).truth(0)
}

#[test]
fn friction_left_out_leaves_the_haptic_force_as_it_is() {
    for gap in ["[gap]\n", "[gap]\nrung = \"tr-bdf2\"\n", "[gap]\n[halves]\n", "[gap]\n[supply]\n"]
    {
        let [with, without] = ["[friction]\n", ""].map(|more| at_300_v(&format!("{gap}{more}")));
        assert_eq!(with.force_n, without.force_n, "{gap}");
        // Eq. 8 with the even gap's k is another number: a reading, and not the truth.
        let k = crate::common::scene("[[pad]]\nposition_mm = [0, 0]\n").cases[0].device.force_k;
        let eq8_n = k * (1e-12 * without.capacitance_pf * without.haptic_v_rms).powi(2);
        assert!(without.force_n > 1.02 * eq8_n, "{gap}: {} {eq8_n}", without.force_n);
    }
}

/// Where an effect is left out, the quantities of another effect stay: of each pair that acts on the pad.
#[test]
fn an_even_gap_has_one_force_with_friction_and_without() {
    for tables in
        ["", "[supply]\n", "[charge]\nshare = 0.3\ntime_constant_s = 0.05\nstart_v = 40\n"]
    {
        let [with, without] = ["[friction]\n", ""].map(|more| at_300_v(&format!("{tables}{more}")));
        assert!((with.force_n / without.force_n - 1.0).abs() < 1e-12, "{tables}");
    }
}

#[test]
fn a_hand_needs_a_law_of_motion() {
    let text =
        "title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n[hand]\n[friction]\nrung = \"coulomb\"\n";
    let message =
        Scene::parse(text, "s.toml", &[]).expect_err("the hand would be ignored").to_string();
    assert!(message.starts_with("s.toml:6: friction.rung: expected \"stiction\""), "{message}");
}

const PUSHED: &str = "title = \"t\"\nduration_s = 1\n[[pad]]\nposition_mm = [0, 0]\nload_g = 80\n[gap]\n\
    [halves]\nsenses = \"each\"\n[hand]\n[friction]\n";

#[test]
fn the_direction_of_a_hand_can_be_read_unless_the_scene_says_otherwise() {
    let case = |tables: &str, set: &[(&str, &str)]| {
        let set: Vec<_> =
            set.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
        Scene::parse(&format!("{PUSHED}{tables}"), "s.toml", &set).expect("a scene")
    };
    let doubts = |set: &[(&str, &str)]| case("[control]\n[wall]\n", set).cases[0].doubts.clone();
    let pushed = |set: &[(&str, &str)]| {
        let scene = case("", &[&[("pad.0.push_x_n", "0.3")], set].concat());
        let timing = hapticore_scene::Timing { pads: 16, ..crate::common::timing() };
        let mut plant = Plant::new(&scene, 0, &timing).expect("a plant");
        plant.truth(200).direction
    };
    assert!(doubts(&[]).is_empty());
    assert!(pushed(&[]).abs() > 1e-5, "{}", pushed(&[]));
    let at_sheet = [("halves.push_height_mm", "0")];
    assert!(pushed(&at_sheet).abs() < 1e-12);
    let of = doubts(&at_sheet);
    assert!(of.len() == 1 && of[0].starts_with("halves.push_height_mm"), "{of:?}");
}

/// The number is that of docs/physics.md §3, integrated apart.
#[test]
fn a_moving_gap_without_friction_has_the_force_of_its_patches() {
    let text = "duration_s = 0.3\n[[pad]]\nposition_mm = [0, 0]\nload_g = 50\nhaptic_v_rms = 300\n\
                [gap]\nrung = \"tr-bdf2\"\n";
    let mut plant = plant(text);
    let slots = plant.slots();
    let mut truths = (0..slots).map(|slot| plant.truth(slot));
    let truth = truths.find(|truth| truth.time_s >= 0.24).expect("a slot");
    assert!((truth.force_n - 0.2011).abs() < 0.0005, "{}", truth.force_n);
}

#[test]
fn a_rail_that_nobody_names_is_one_that_the_haptic_channel_reads() {
    let of = |set: &str| {
        let case = &crate::common::scene(&format!("{CONTROLLED}[gap]\n{set}")).cases[0];
        (case.control.clone().unwrap().rail_v, case.doubts.clone())
    };
    let square = "[carrier]\nhaptic_wave = \"square\"\n";
    for (set, expected) in [
        ("", 0.95 * 600.0 / 2f64.sqrt()),
        (square, 500.0),
        ("[sensor]\nhaptic_full_scale_v = 300\n", 0.95 * 300.0 / 2f64.sqrt()),
        ("[sensor]\nhaptic_full_scale_v = 3000\n", 500.0),
    ] {
        let (rail_v, doubts) = of(set);
        assert!(
            (rail_v - expected).abs() < 1e-9 && doubts.is_empty(),
            "{set}: {rail_v} {doubts:?}"
        );
    }
    let text = format!("{CONTROLLED}[gap]\n").replacen("[control]", "[control]\nrail_v = 425", 1);
    let doubts = doubts(&text);
    assert!(doubts.len() == 1 && doubts[0].starts_with("control.rail_v = 425"), "{doubts:?}");
}
