// SPDX-License-Identifier: MIT OR Apache-2.0
//! Recordings: logs and scene files give the rows again that were shown.

use std::sync::Arc;

use hapticore_live::protocol::{Command, Opening, Recording, Setting};
use hapticore_live::setup::simulated;
use hapticore_live::simulated::Simulated;
use hapticore_live::source::Source;
use hapticore_run::case::{Case, Settings};
use hapticore_run::engine::Fidelity;
use hapticore_run::inputs;
use hapticore_run::record::Row;
use hapticore_run::stepper::{Input, Options, Stepper};
use hapticore_scene::Scene;
use serde_json::Value;

use crate::client::opening;

/// Runs slots with commands before some of them; all rows.
fn run(source: &mut Simulated, slots: usize, commands: &[(usize, Command)]) -> Vec<Row> {
    let mut rows = Vec::new();
    for slot in 0..slots {
        for (_, command) in commands.iter().filter(|(at, _)| *at == slot) {
            source.apply(command).expect("an input of the scene");
        }
        rows.extend(source.advance().expect("a slot").row.map(|(_, row)| row));
    }
    rows
}

fn lead(pad: usize, mm: [f64; 2]) -> Command {
    Command::Lead { pad, mm, within_s: None }
}

fn set(pad: usize, setting: Setting) -> Command {
    Command::Set { pad, setting }
}

/// Simulates a recorded scene; its rows without what a live run leaves out.
fn simulate(text: &str, case: Option<&str>) -> Vec<Row> {
    let scene =
        Scene::parse(text, "recorded.toml", &[]).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let index = case
        .map_or(0, |name| scene.cases.iter().position(|case| case.name == name).expect("the case"));
    let profile = inputs::windowed(inputs::profile(&scene.profile).unwrap(), &scene).unwrap();
    let case = Case::new(&Arc::new(scene), index, &profile, &[]).expect("a case");
    let settings = Settings { fidelity: Fidelity::Fixed, errors: false };
    let outcome = case.run(&settings, None, &|| ()).expect("a run");
    outcome.rows.into_iter().map(|row| Row { reference: None, ..row }).collect()
}

/// The first row that differs, with both.
fn difference<'a>(shown: &'a [Row], again: &'a [Row]) -> Option<(usize, &'a Row, &'a Row)> {
    assert_eq!(shown.len(), again.len(), "rows");
    shown.iter().zip(again).enumerate().find(|(_, (a, b))| a != b).map(|(n, (a, b))| (n, a, b))
}

fn check_scene(opening: &Opening, case: Option<&str>, slots: usize, commands: &[(usize, Command)]) {
    let mut source = simulated(opening).expect("a source");
    let shown = run(&mut source, slots, commands);
    let recorded = source.record(Recording::Scene).expect("a recording");
    assert!(recorded.exact, "{}", recorded.note);
    let again = simulate(&recorded.text, case);
    assert_eq!(difference(&shown, &again), None, "{}", recorded.text);
}

#[test]
fn a_log_replays_to_the_bit() {
    let commands = [
        (3, lead(0, [2.0, 150.0])),
        (20, lead(0, [1.0, 149.0])), // cuts the line short
        (40, set(1, Setting::LoadG(95.0))),
        (200, Command::Wall { x_mm: Some(3.0), y_mm: None, off: false }),
        (300, lead(2, [-2.0, -52.5])),
        (420, Command::Release { pad: 0 }),
        (500, set(3, Setting::PushXN(0.4))),
        (600, Command::Wall { x_mm: None, y_mm: None, off: true }),
    ];
    let mut source = simulated(&opening("peg", &[])).unwrap();
    let shown = run(&mut source, 800, &commands);
    let recorded = source.record(Recording::Log).unwrap();
    let log: Value = serde_json::from_str(&recorded.text).unwrap();
    assert_eq!((&log["scene"], &log["slots"]), (&"peg".into(), &800.into()));
    let scene = Arc::new(inputs::scene("peg", &[]).unwrap());
    let profile = inputs::profile(&scene.profile).unwrap();
    let options = Options { fidelity: Fidelity::Fixed, errors: false, reference: false };
    let mut again = Stepper::new(scene, 0, &profile, options).unwrap();
    let mut rows = Vec::new();
    for slot in 0..800 {
        for entry in log["inputs"].as_array().unwrap().iter().filter(|entry| entry["slot"] == slot)
        {
            let input: Input = serde_json::from_value(entry.clone()).unwrap();
            again.apply(&input).unwrap();
        }
        rows.extend(again.step().unwrap());
    }
    assert_eq!(difference(&shown, &rows), None);
}

#[test]
fn a_recorded_wall_simulates_to_the_bit() {
    let still = "[6, 150]";
    let commands = [
        (10, lead(0, [4.0, 150.0])),
        (80, lead(0, [-1.0, 148.0])),
        (160, lead(0, [-1.0, 148.0])), // rests
        (240, lead(0, [3.0, 151.0])),
        (241, set(0, Setting::LoadG(75.0))),
        (300, set(0, Setting::LoadG(40.0))),
        (320, Command::Wall { x_mm: Some(2.0), y_mm: None, off: false }),
        (500, Command::Wall { x_mm: None, y_mm: None, off: true }),
        (620, Command::Wall { x_mm: Some(2.5), y_mm: None, off: false }),
        (700, set(0, Setting::PushXN(-0.5))),
    ];
    check_scene(&opening("peg", &[("pad.0.position_mm", still)]), None, 900, &commands);
}

#[test]
fn a_recorded_game_simulates_to_the_bit() {
    let strike = Command::Lead { pad: 0, mm: [-60.0, 1.0], within_s: Some(0.2) };
    let commands = [
        (0, lead(0, [-149.0, 0.0])),
        (100, strike),
        (1000, Command::Serve),
        (1100, lead(0, [-90.0, 0.0])),
        (1300, Command::Serve),
    ];
    let set = [("pad.0.position_mm", "[-150, 0]"), ("arena.serve_s", "[0.3]")];
    let mut source = simulated(&opening("air-hockey", &set)).unwrap();
    let shown = run(&mut source, 1100, &commands);
    let fastest =
        shown.iter().filter_map(|row| row.game).map(|game| game.puck_mm_s).fold(0.0, f64::max);
    assert!(fastest > 300.0, "a strike: {fastest} mm/s");
    check_scene(&opening("air-hockey", &set), None, 1400, &commands);
}

#[test]
fn a_recorded_corner_simulates_to_the_bit() {
    let commands = [
        (0, lead(0, [9.0, 9.0])),
        (100, lead(0, [-2.0, 9.0])),
        (300, Command::Wall { x_mm: None, y_mm: Some(4.0), off: false }),
        (400, lead(0, [5.0, 2.0])),
    ];
    check_scene(&opening("wall-2d", &[("pad.0.position_mm", "[10, 10]")]), None, 600, &commands);
}

#[test]
fn a_recorded_force_loop_simulates_to_the_bit() {
    let opening = Opening { case: Some("1".into()), ..opening("fig9", &[]) };
    let commands = [
        (20, Command::Target { pad: 0, n: 0.25 }),
        (60, set(0, Setting::LoadG(80.0))),
        (90, Command::Target { pad: 0, n: 0.0 }),
        (100, lead(0, [60.0, -30.0])),
    ];
    check_scene(&opening, Some("live"), 150, &commands);
}

#[test]
fn recorded_voltages_of_a_later_case_simulate_to_the_bit() {
    let opening = Opening {
        case: Some("cancelled".into()),
        ..opening("four-pads", &[("pad.0.position_mm", "[-405, 0]")])
    };
    let commands = [
        (5, set(1, Setting::HapticVRms(250.0))),
        (9, lead(0, [-390.0, 20.0])),
        (40, lead(0, [-400.0, 30.0])),
        (44, set(1, Setting::HapticVRms(0.0))),
    ];
    check_scene(&opening, Some("live"), 80, &commands);
}

#[test]
fn what_is_not_exact_says_so_and_is_near() {
    let commands = [
        (40, lead(2, [100.0, 50.0])),       // on its way by itself, along a line
        (60, set(0, Setting::LoadG(35.0))), // a sine until then
        (100, lead(2, [110.0, 60.0])),
        (103, lead(2, [90.0, 60.0])), // cuts the line short
        (140, Command::Release { pad: 2 }),
    ];
    let mut source = simulated(&opening("hockey", &[])).unwrap();
    let shown = run(&mut source, 240, &commands);
    let recorded = source.record(Recording::Scene).unwrap();
    assert!(
        !recorded.exact && recorded.note.contains("sampled") && recorded.text.contains("sampled")
    );
    let again = simulate(&recorded.text, None);
    assert_eq!(shown.len(), again.len());
    for (a, b) in shown.iter().zip(&again) {
        let (one, other) = (a.truth.unwrap().quantities, b.truth.unwrap().quantities);
        assert!(
            (one.x_mm - other.x_mm).abs() < 0.01 && (one.y_mm - other.y_mm).abs() < 0.01,
            "{a:?}\n{b:?}"
        );
        assert!((one.force_n - other.force_n).abs() < 1e-4, "{a:?}\n{b:?}");
    }
}

#[test]
fn a_line_that_is_cut_short_is_near_to_rounding() {
    let commands =
        [(10, lead(0, [4.0, 150.0])), (37, lead(0, [-1.0, 148.0])), (90, lead(0, [1.0, 149.0]))];
    let mut source = simulated(&opening("peg", &[("pad.0.position_mm", "[6, 150]")])).unwrap();
    let shown = run(&mut source, 300, &commands);
    let recorded = source.record(Recording::Scene).unwrap();
    assert!(!recorded.exact && recorded.note.contains("1e-12 mm"), "{}", recorded.note);
    let again = simulate(&recorded.text, None);
    for (a, b) in shown.iter().zip(&again) {
        let off_mm = a.truth.unwrap().quantities.x_mm - b.truth.unwrap().quantities.x_mm;
        assert!(off_mm.abs() < 1e-6, "{off_mm} mm at {} s", a.time_s);
    }
}

#[test]
fn a_sweep_is_recorded_as_a_log_alone() {
    let mut source = simulated(&opening("minimal-coupling", &[])).unwrap();
    run(&mut source, 4, &[(1, set(0, Setting::LoadG(33.0)))]);
    let message = source.record(Recording::Scene).unwrap_err();
    assert!(message.contains("duration_s") && message.contains("log"), "{message}");
    assert!(source.record(Recording::Log).unwrap().text.contains("\"press\""));
}
