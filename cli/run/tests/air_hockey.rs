// SPDX-License-Identifier: MIT OR Apache-2.0
//! Air hockey: the stepper plays on the core's frames, and the core makes impacts and walls felt.

use std::sync::Arc;

use hapticore_host::air_hockey::Puck;
use hapticore_run::engine::Fidelity;
use hapticore_run::inputs;
use hapticore_run::record::{GameRow, Row};
use hapticore_run::stepper::{Input, Options, Stepper};

/// Parts of a pad, and the slot of its last one.
const PARTS: usize = 4;
const SLOT_S: f64 = 250e-6;

fn stepper(set: &[(&str, &str)], fidelity: Fidelity) -> Stepper {
    let set: Vec<_> = set.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    let scene = inputs::scene("air-hockey", &set).unwrap_or_else(|error| panic!("{error:#}"));
    let profile = inputs::profile(&scene.profile).unwrap();
    let options = Options { fidelity, errors: false, reference: false };
    Stepper::new(Arc::new(scene), 0, &profile, options).unwrap_or_else(|error| panic!("{error:#}"))
}

fn until(stepper: &mut Stepper, time_s: f64) -> Vec<Row> {
    let mut rows = Vec::new();
    while stepper.time_s() < time_s {
        rows.extend(stepper.step().expect("a slot"));
    }
    rows
}

fn game(row: &Row) -> GameRow {
    row.game.expect("a scene with an arena")
}

fn true_n(row: &Row) -> f64 {
    row.truth.expect("a plant").quantities.force_n
}

/// Rows of the last part of a pad.
fn of_pad(rows: &[Row], pad: usize) -> impl Iterator<Item = &Row> {
    rows.iter().filter(move |row| row.pad == PARTS * pad + PARTS - 1)
}

/// The scene until after its first strike, and the time of it.
fn struck() -> (Vec<Row>, f64) {
    let rows = until(&mut stepper(&[], Fidelity::Fixed), 0.9);
    let first = rows.iter().find(|row| game(row).puck_mm_s > 0.0).expect("a strike");
    let time_s = first.time_s;
    (rows, time_s)
}

#[test]
fn a_strike_moves_the_puck_and_the_core_brakes_the_pad() {
    let (rows, contact_s) = struck();
    // A hand at 300 mm/s and a restitution of 0.8: 540 mm/s, and an impulse of 10.8 mN·s.
    let speed = of_pad(&rows, 0).map(|row| game(row).puck_mm_s).fold(0.0, f64::max);
    assert!((speed - 540.0).abs() < 30.0, "{speed} mm/s");
    let puck = Puck { place_mm: game(rows.last().unwrap()).puck_mm, ..Puck::default() };
    assert!(puck.place_mm[0] > -30.0 && puck.place_mm[1].abs() < 5.0, "{puck:?}");
    let felt = |row: &&Row| (contact_s..contact_s + 0.02).contains(&row.time_s);
    let most_n = of_pad(&rows, 0).filter(felt).map(true_n).fold(0.0, f64::max);
    assert!(most_n > 0.3, "{most_n} N within 20 ms of the contact");
    let impulse_n_s: f64 = of_pad(&rows, 0)
        .filter(|row| row.time_s > contact_s - 0.01)
        .map(|row| true_n(row) * SLOT_S * (2 * PARTS) as f64)
        .sum();
    let expected_n_s = 1e-6 * 20.0 * speed;
    println!("{most_n} N, {} mN·s of {} mN·s", 1e3 * impulse_n_s, 1e3 * expected_n_s);
    assert!((impulse_n_s / expected_n_s - 1.0).abs() < 0.25, "{impulse_n_s} of {expected_n_s} N·s");
    // The other player has felt nothing.
    let other_n = of_pad(&rows, 1).filter(felt).map(true_n).fold(0.0, f64::max);
    assert!(other_n < 0.01, "{other_n} N");
}

#[test]
fn a_puck_between_strikes_only_slows_down() {
    let rows = until(&mut stepper(&[], Fidelity::Fixed), 1.3);
    let mut last = 0.0;
    let mut strikes = 0;
    for row in &rows {
        let speed = game(row).puck_mm_s;
        if speed > last {
            strikes += 1;
            let felt = rows.iter().filter(|of| (of.time_s - row.time_s).abs() < 5e-3);
            let most_n = felt.map(|of| game(of).impact_n).fold(0.0, f64::max);
            assert!(most_n > 0.1, "faster by {} mm/s without an impact", speed - last);
        }
        last = speed;
    }
    assert!((2..=4).contains(&strikes), "{strikes} strikes");
}

/// The left mallet is led into a wall, rests and is drawn out again: mean true force at rest by the depth, and the
/// largest force once it is out.
fn meet(stepper: &mut Stepper, inside_mm: [f64; 2], outside_mm: [f64; 2]) -> (f64, f64, f64) {
    let mut lead = |to_mm, within_s| {
        stepper.apply(&Input::Lead { pad: 0, to_mm, within_s }).unwrap();
        let end_s = stepper.time_s() + within_s;
        until(stepper, end_s)
    };
    // To and fro before the wall, as a hand that plays.
    for _ in 0..2 {
        lead(outside_mm, 0.25);
        lead([0, 1].map(|axis| 0.8 * outside_mm[axis] + 0.2 * inside_mm[axis]), 0.1);
    }
    lead([0, 1].map(|axis| 0.1 * outside_mm[axis] + 0.9 * inside_mm[axis]), 0.3);
    lead(inside_mm, 0.3);
    let rest = lead(inside_mm, 0.15);
    lead(outside_mm, 0.4);
    let out = lead(outside_mm, 0.1);
    let axis = usize::from(inside_mm[1] != outside_mm[1]);
    let place_mm = |row: &Row| {
        let of = row.truth.expect("a plant").quantities;
        [of.x_mm, of.y_mm][axis]
    };
    let rests: Vec<&Row> = rest.iter().filter(|row| row.pad < PARTS).skip(200).collect();
    let mean = |of: &dyn Fn(&Row) -> f64| {
        rests.iter().map(|row| of(row)).sum::<f64>() / rests.len() as f64
    };
    let most_n = of_pad(&out, 0).map(true_n).fold(0.0, f64::max);
    (mean(&true_n), mean(&place_mm), most_n)
}

#[test]
fn walls_hold_on_either_side_and_release() {
    let mut stepper = stepper(&[("arena.puck_mm", "[200, 150]")], Fidelity::Fixed);
    until(&mut stepper, 0.45);
    let walls = [
        ("outer", [-288.0, 60.0], [-200.0, 60.0], -285.0, -1.0),
        ("centre", [-12.0, 60.0], [-100.0, 60.0], -15.0, 1.0),
        ("upper", [-100.0, 168.0], [-100.0, 100.0], 165.0, 1.0),
        ("lower", [-100.0, -168.0], [-100.0, -100.0], -165.0, -1.0),
        ("outer again", [-288.0, -60.0], [-200.0, -60.0], -285.0, -1.0),
    ];
    for (name, inside_mm, outside_mm, surface_mm, side) in walls {
        let (rest_n, place_mm, out_n) = meet(&mut stepper, inside_mm, outside_mm);
        let depth_mm = side * (place_mm - surface_mm);
        println!("{name}: {rest_n:.3} N at a depth of {depth_mm:.3} mm, {out_n:.3} N outside");
        assert!(rest_n > 0.3, "{name}: {rest_n} N at a depth of {depth_mm} mm");
        assert!(
            (rest_n / (0.5 * depth_mm) - 1.0).abs() < 0.1,
            "{name}: {rest_n} N at {depth_mm} mm"
        );
        assert!(out_n < 0.01, "{name}: {out_n} N outside");
    }
}

#[test]
fn every_fidelity_plays_the_same_game() {
    // A puck that meets the left mallet after 4 ms.
    let served = [("arena.puck_mm", "[-119, 0]"), ("arena.puck_mm_s", "[-1000, 0]")];
    let rows = |fidelity| {
        let mut stepper = stepper(&served, fidelity);
        let mut rows: Vec<Row> = (0..160).filter_map(|_| stepper.step().expect("a slot")).collect();
        rows.extend(stepper.finish().unwrap());
        rows
    };
    let [fixed, clock] = [Fidelity::Fixed, Fidelity::Clock].map(rows);
    let text = |rows: &[Row]| rows.iter().map(|row| format!("{row:?}")).collect::<Vec<_>>();
    assert!(text(&fixed) == text(&clock), "fixed and clock");
    assert!(fixed.iter().any(|row| game(row).impact_n > 0.2), "no impact");
    let last = game(fixed.last().unwrap());
    assert!(last.puck_mm_s > 500.0 && last.puck_mm[0] > -119.0, "{last:?}");
}

#[test]
fn a_scripted_serve_is_a_serve_by_hand() {
    let mut by_hand = stepper(&[], Fidelity::Fixed);
    let mut rows = until(&mut by_hand, 0.8);
    let slot = by_hand.slot();
    by_hand.apply(&Input::Serve).unwrap();
    rows.extend(until(&mut by_hand, 0.85));
    let serve_s = format!("[{}]", (slot as f64 + 0.25) * SLOT_S);
    let scripted = until(&mut stepper(&[("arena.serve_s", &serve_s)], Fidelity::Fixed), 0.85);
    assert!(rows == scripted, "the same rows");
    assert_eq!(game(&rows[slot]).puck_mm, [-60.0, 0.0]);
    assert_ne!(game(&rows[slot - 1]).puck_mm, [-60.0, 0.0]);
}

#[test]
fn inputs_that_the_game_decides_are_refused() {
    let mut stepper = stepper(&[], Fidelity::Fixed);
    let refused = |of: &mut Stepper, input: Input| of.apply(&input).unwrap_err().to_string();
    let wall = Input::Wall { x_mm: Some(0.0), y_mm: None, off: false };
    let message = "expected a case without [arena], whose game sets targets and walls";
    assert_eq!(refused(&mut stepper, wall), format!("wall: {message}"));
    let target = Input::Target { pad: 0, newtons: 0.1 };
    assert_eq!(refused(&mut stepper, target), format!("target: {message}"));
    let scene = inputs::scene("peg", &[]).unwrap();
    let options = Options { fidelity: Fidelity::Fixed, errors: false, reference: false };
    let profile = inputs::profile("fast").unwrap();
    let mut peg = Stepper::new(scene.into(), 0, &profile, options).unwrap();
    assert_eq!(refused(&mut peg, Input::Serve), "serve: expected a case with [arena]");
}
