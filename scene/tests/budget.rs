// SPDX-License-Identifier: MIT OR Apache-2.0
//! Levels: how far each is from the next finer one, and which of them an error budget takes.

use hapticore_scene::{LevelDeviation, Plant, Scene, Timing};

const HEAD: &str = "title = \"t\"\n";
const REST: &str =
    "[[pad]]\nposition_mm = { raster = { nx = 7, ny = 5, margin_mm = 20 } }\n[sheet]\n";

fn timing() -> Timing {
    Timing {
        pads: 4,
        slot_samples: 500,
        window_start: 100,
        window_samples: 400,
        samples_per_period: 10.0,
        signs: None,
    }
}

fn scene(head: &str, rest: &str) -> Scene {
    Scene::parse(&format!("{HEAD}{head}{REST}{rest}"), "s.toml", &[])
        .unwrap_or_else(|error| panic!("{error}"))
}

fn within(percent: f64) -> Scene {
    scene(&format!("error_budget_percent = {percent}\n"), "").within_budget(&timing()).unwrap()
}

fn sheet_error(level: &str) -> LevelDeviation {
    scene("", &format!("rung = {level:?}")).level_deviations(0, &timing()).unwrap().remove(0)
}

#[test]
fn each_level_is_closer_to_the_next_and_the_finest_has_none() {
    let percent = |level| sheet_error(level).finer.map(|(_, percent)| percent);
    let [distance, bilinear, bicubic] =
        ["distance", "bilinear", "bicubic"].map(|level| percent(level).unwrap());
    assert!(
        distance > 5.0 && bilinear < 0.5 && bicubic < 0.02 && bicubic > 1e-6,
        "{distance} {bilinear} {bicubic}"
    );
    assert_eq!(percent("analytic"), None);
}

#[test]
fn a_budget_takes_the_cheapest_level_whose_measured_error_fits() {
    let chosen = |percent| {
        let scene = within(percent);
        let sheet = scene.cases[0].effects()[0].1.to_string();
        sheet.split(' ').next().unwrap().to_string()
    };
    assert_eq!([40.0, 0.05, 1e-9].map(chosen), ["bilinear", "bicubic", "analytic"]);
}

#[test]
fn a_level_that_the_scene_names_is_left_alone() {
    let scene = scene("error_budget_percent = 1e-9\n", "rung = \"distance\"")
        .within_budget(&timing())
        .unwrap();
    assert_eq!(scene.cases[0].effects()[0], ("sheet", "distance"));
}

#[test]
fn a_budget_without_chosen_levels_cannot_be_run() {
    let scene = scene("error_budget_percent = 1\n", "");
    let error = Plant::new(&scene, 0, &timing()).map(|_| ()).unwrap_err().to_string();
    assert!(
        error.starts_with("s: error_budget_percent: expected levels that have been chosen"),
        "{error}"
    );
}
