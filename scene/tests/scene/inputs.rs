// SPDX-License-Identifier: MIT OR Apache-2.0
//! Inputs of a plant while it runs: a finger that is led, loads and pushes, in place of the scene's.

use crate::time::{Draw, STATES, bits, plant, truths};
use hapticore_scene::{DriveError, Plant, Truth};

/// A pad of effects with a load, a voltage and whatever moves it.
fn pad(effects: &str, position: &str, load_g: &str) -> String {
    let carrier = if effects.contains("[carrier]") { "" } else { "[carrier]\nhaptic_hz = 200\n" };
    format!(
        "duration_s = 0.15\n[[pad]]\nposition_mm = {position}\nload_g = {load_g}\nhaptic_v_rms = 210\n\
         {carrier}{effects}"
    )
}

/// Lines on which a finger is led: when it leaves and arrives, and where it goes. Every other one begins
/// when the one before ends.
fn lines(draw: &mut Draw, until_s: f64) -> Vec<([f64; 2], [f64; 2])> {
    let mut lines: Vec<([f64; 2], [f64; 2])> = Vec::new();
    let mut from_s = 0.004;
    while from_s < until_s {
        let at_s = from_s + draw.within(1e-3, 15e-3);
        lines.push(([from_s, at_s], [draw.within(-60.0, 60.0), draw.within(-40.0, 40.0)]));
        let waits_s = if lines.len().is_multiple_of(2) { draw.within(1e-3, 8e-3) } else { 0.0 };
        from_s = at_s + waits_s;
    }
    lines
}

/// The same as a scene has it.
fn timeline(lines: &[([f64; 2], [f64; 2])], start_mm: [f64; 2]) -> String {
    let axis = |axis: usize| {
        let mut points = vec![[0.0, start_mm[axis]]];
        for ([from_s, at_s], to_mm) in lines {
            points.push([*from_s, points[points.len() - 1][1]]);
            points.push([*at_s, to_mm[axis]]);
        }
        format!("{points:?}")
    };
    format!("{{ timeline = {{ x_mm = {}, y_mm = {} }} }}", axis(0), axis(1))
}

/// Set just before the slot that sees it, or all ahead.
#[test]
fn a_finger_that_is_led_has_the_bits_of_the_scenes_timeline() {
    let mut draw = Draw(11);
    for (n, effects) in STATES.into_iter().enumerate() {
        let lines = lines(&mut draw, 0.13);
        let scenes = truths(&pad(effects, &timeline(&lines, [5.0, -8.0]), "40"));
        let mut plant = plant(&pad(effects, "[5, -8]", "40"));
        let ahead_s = if n % 2 == 0 { 1.7e-3 } else { 1.0 };
        let mut left = lines.iter().peekable();
        for (slot, scenes) in scenes.iter().enumerate() {
            while let Some(([from_s, at_s], to_mm)) =
                left.next_if(|([from_s, _], _)| *from_s <= scenes.time_s + ahead_s)
            {
                plant.lead(0, *to_mm, *from_s, *at_s).unwrap();
            }
            let led = plant.truth(slot);
            assert_eq!(bits(&led), bits(scenes), "{effects}, slot {slot}");
            assert_eq!((led.set, led.hand_n), (scenes.set, scenes.hand_n), "{effects}");
        }
        assert!(left.next().is_none());
    }
}

#[test]
fn a_load_that_is_set_has_the_bits_of_the_same_steps_in_the_scene() {
    let mut draw = Draw(12);
    for effects in STATES {
        let mut steps = vec![[0.0, 40.0]];
        while steps[steps.len() - 1][0] < 0.14 {
            let from_s = steps[steps.len() - 1][0] + draw.within(1e-3, 9e-3);
            steps.push([from_s, draw.within(0.0, 200.0)]);
        }
        let held = |n: usize| [steps[n][0], steps[n.saturating_sub(1)][1]];
        let points: Vec<_> = (0..steps.len()).flat_map(|n| [held(n), steps[n]]).collect();
        let scenes = truths(&pad(effects, "[5, -8]", &format!("{{ timeline = {points:?} }}")));
        let mut plant = plant(&pad(effects, "[5, -8]", "40"));
        for [from_s, load_g] in &steps[1..] {
            plant.press(0, *load_g, *from_s).unwrap();
        }
        for (slot, scenes) in scenes.iter().enumerate() {
            assert_eq!(bits(&plant.truth(slot)), bits(scenes), "{effects}, slot {slot}");
        }
    }
}

#[test]
fn a_push_that_is_set_has_the_bits_of_the_same_step_in_the_scene() {
    let text = |push: &str| {
        format!(
            "duration_s = 0.1\n[[pad]]\nposition_mm = [0, 0]\n{push}[hand]\nstiffness_n_per_m = 0\n\
             damping_n_s_per_m = 0\n[friction]\nrung = \"stiction\"\n"
        )
    };
    let step = |n: f64| format!("{{ timeline = [[0.0303, 0], [0.0303, {n}]] }}");
    let scenes = truths(&text(&format!("push_x_n = {}\npush_y_n = {}\n", step(0.4), step(-0.3))));
    let mut plant = plant(&text(""));
    plant.push(0, [0.4, -0.3], 0.0303).unwrap();
    let pushed: Vec<_> = (0..scenes.len()).map(|slot| plant.truth(slot)).collect();
    assert!(pushed.iter().map(bits).eq(scenes.iter().map(bits)));
    let last = pushed.last().unwrap();
    assert!(last.x_mm > 1.0 && last.y_mm < -1.0, "it moves: {last:?}");
}

/// The truth of each slot with lines set just before, or at random ahead; the last one gives the finger
/// back to the scene. Only some slots are asked for.
fn led(text: &str, ahead_s: f64, is_asked: impl Fn(usize) -> bool) -> Vec<(usize, Truth)> {
    let mut plant = plant(text);
    let mut draw = Draw(13);
    let leave = |n: usize| 0.005 * (n + 1) as f64;
    let mut slots = Vec::new();
    let mut next = 0;
    for slot in (0..plant.slots()).filter(|slot| is_asked(*slot)) {
        while next < 16 && leave(next) <= 1.7e-3 * (slot + 1) as f64 + ahead_s {
            set(&mut plant, &mut draw, leave(next), next == 15);
            next += 1;
        }
        slots.push((slot, plant.truth(slot)));
    }
    slots
}

/// A line that is cut by the next one, for most of them.
fn set(plant: &mut Plant, draw: &mut Draw, from_s: f64, is_last: bool) {
    let at_s = from_s + draw.within(1e-3, 12e-3);
    let to_mm = [draw.within(-60.0, 60.0), draw.within(-40.0, 40.0)];
    plant.press(0, draw.within(0.0, 100.0), from_s).unwrap();
    match is_last {
        true => plant.release(0, from_s, at_s).unwrap(),
        false => plant.lead(0, to_mm, from_s, at_s).unwrap(),
    }
}

#[test]
fn a_led_pad_does_not_depend_on_the_slots_that_are_asked_for() {
    let circle = "{ circle = { radius_mm = 30, period_s = 0.11 } }";
    for effects in STATES {
        let text = pad(effects, circle, "40");
        let all = led(&text, 0.0, |_| true);
        for (ahead_s, every) in [(0.0, 1), (1.0, 1), (0.0, 7), (1.0, 5)] {
            for (slot, truth) in led(&text, ahead_s, |slot| slot % every == every - 1) {
                assert_eq!(bits(&truth), bits(&all[slot].1), "{effects}, {ahead_s} s, {every}");
            }
        }
    }
}

#[test]
fn a_released_finger_goes_to_the_scenes_place_without_a_jump_and_follows_it() {
    let text = pad("", "{ circle = { radius_mm = 30, period_s = 0.5 } }", "40");
    let scenes = truths(&text);
    let mut plant = plant(&text);
    plant.lead(0, [100.0, 50.0], 0.01, 0.03).unwrap();
    plant.release(0, 0.06, 0.08).unwrap();
    let led: Vec<_> = (0..scenes.len()).map(|slot| plant.truth(slot)).collect();
    let mut fastest_mm = 0.0f64;
    for (before, after) in led.iter().zip(&led[1..]) {
        fastest_mm = fastest_mm.max((after.x_mm - before.x_mm).hypot(after.y_mm - before.y_mm));
    }
    // 124 mm in 20 ms are 10.5 mm in a slot.
    assert!((5.0..11.0).contains(&fastest_mm), "{fastest_mm}");
    for (led, scenes) in led.iter().zip(&scenes) {
        match led.time_s {
            0.03..0.06 => assert_eq!([led.x_mm, led.y_mm], [100.0, 50.0]),
            0.01..0.08 => assert_ne!(bits(led), bits(scenes)),
            _ => assert_eq!(bits(led), bits(scenes), "the scene's"),
        }
    }
}

#[test]
fn inputs_that_cannot_be_are_refused_and_change_nothing() {
    let text = pad("[gap]\n[friction]\n", "[5, -8]", "40");
    let expected = truths(&text);
    let mut plant = plant(&text);
    let bits_of = |plant: &mut Plant, slots: std::ops::Range<usize>| {
        slots.map(|slot| bits(&plant.truth(slot))).collect::<Vec<_>>()
    };
    let first = bits_of(&mut plant, 0..10);
    let refused = |result: Result<(), DriveError>| result.unwrap_err().to_string();
    assert_eq!(refused(plant.lead(1, [0.0; 2], 0.1, 0.2)), "expected a pad below 1, got 1");
    assert_eq!(refused(plant.press(99, 10.0, 0.1)), "expected a pad below 1, got 99");
    assert_eq!(
        refused(plant.release(usize::MAX, 0.1, 0.2)),
        format!("expected a pad below 1, got {}", usize::MAX)
    );
    assert_eq!(
        refused(plant.lead(0, [416.0, 0.0], 0.1, 0.2)),
        "expected a place within ±415 × ±235 mm, got [416, 0]"
    );
    for to_mm in [[f64::NAN, 0.0], [0.0, f64::INFINITY], [0.0, -236.0]] {
        assert!(matches!(plant.lead(0, to_mm, 0.1, 0.2), Err(DriveError::Place { .. })));
    }
    assert_eq!(
        refused(plant.lead(0, [0.0; 2], 0.1, 0.1)),
        "expected to arrive after 0.1 s, got 0.1 s"
    );
    assert!(matches!(plant.release(0, 0.1, f64::NAN), Err(DriveError::Arrival { .. })));
    for from_s in [0.001, f64::NAN, f64::INFINITY] {
        assert!(matches!(plant.lead(0, [0.0; 2], from_s, 0.2), Err(DriveError::Past { .. })));
        assert!(matches!(plant.press(0, 10.0, from_s), Err(DriveError::Past { .. })));
    }
    assert_eq!(refused(plant.press(0, -1.0, 0.1)), "expected a load of 0 to 100000 g, got -1");
    assert!(matches!(plant.press(0, f64::NAN, 0.1), Err(DriveError::Load(_))));
    assert_eq!(plant.push(0, [1.0, 0.0], 0.1), Err(DriveError::NoHand));
    let rest = bits_of(&mut plant, 10..expected.len());
    assert!(first.into_iter().chain(rest).eq(expected.iter().map(bits)));
}

/// Only the pad that is led moves, and its finger pulls it.
#[test]
fn a_finger_that_is_led_pulls_its_own_pad() {
    let pads = "[[pad]]\nposition_mm = [0, 0]\n[[pad]]\nposition_mm = [100, 0]\n";
    let text = format!("duration_s = 0.6\n{pads}[hand]\n[friction]\n[coupling]\n[sheet]\n");
    let mut plant = plant(&text);
    plant.lead(1, [130.0, 20.0], 0.05, 0.45).unwrap();
    let mut pulls_n = Vec::new();
    for slot in 0..plant.slots() {
        let truth = plant.truth(slot);
        match (truth.pad, truth.time_s) {
            (0, _) | (_, 0.0..0.05) => assert!(truth.hand_n[0].abs() < 1e-12, "{truth:?}"),
            (1, 0.2..0.45) => pulls_n.push(truth.hand_n[0]),
            _ => {}
        }
    }
    // The pad has swung in: on the mean it is pulled against its friction of 24 mN.
    let mean_n = pulls_n.iter().sum::<f64>() / pulls_n.len() as f64;
    assert!((0.01..0.03).contains(&mean_n), "{mean_n}");
    let last = plant.truth(plant.slots() - 1);
    assert!((last.x_mm - 130.0).abs() < 3.0 && last.set.finger_mm() == [130.0, 20.0], "{last:?}");
}
