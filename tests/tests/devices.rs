// SPDX-License-Identifier: MIT OR Apache-2.0
//! Positions on anyone's device: random sheets with random terminals, each calibrated as a user
//! would, read by the integers of the core (`fixed`).
//!
//! `DEVICES=300` takes 300 devices, at all places, instead of a few at some. `PROFILE=small` takes
//! another profile, whose figures are printed and not judged: `DEVICES=300 cargo test --release -p
//! hapticore-tests --test devices -- --nocapture random`.

use std::env;
use std::sync::Arc;

use hapticore_contract::profile::Profile;
use hapticore_run::case::Case;
use hapticore_run::inputs;
use hapticore_run::record::Row;
use hapticore_scene::{Scene, Timing, gallery};
use hapticore_tests::devices::{Device, Found, Raster, error_mm, find, rms, rows};
use rayon::prelude::*;

/// Devices where none are asked for.
const DEVICES: usize = 24;
/// Places on a device.
const PLACES: Raster = Raster { columns: 61, rows: 35, every: 1 };
/// Places on the display.
const DISPLAY_PLACES: Raster = Raster { columns: 97, rows: 57, every: 5 };
/// Of nine devices in ten, mm rms.
const LIMIT_MM: f64 = 0.05;
/// The paper's display.
const DISPLAY: &str = "title = \"display\"\n[sheet]\nrung = \"analytic\"\n";

/// Beyond this a place counts as wrong: 1 mm, or 0.2 % of the sheet's length.
fn wrong_mm(device: &Device) -> f64 {
    f64::max(1.0, 0.002 * device.size_mm[0])
}

/// Whether a place is wrong without *invalid*, and the calibration's report does not name one as
/// wrong.
fn is_silently_wrong(found: &Found) -> bool {
    let limit = wrong_mm(&found.device);
    found.worst_mm() > limit && found.residual.worst_mm <= limit
}

fn line(found: &Found) -> String {
    format!(
        "{}: {:.4} mm rms, {:.3} at most, {} invalid; in floating point {:.4}; its own places: {}",
        found.device.label(),
        found.rms_mm(),
        found.worst_mm(),
        found.invalid,
        rms(&found.reference_mm),
        found.residual.errors()
    )
}

fn profile(name: &str) -> Profile {
    Profile::bundled(name).expect("bundled")
}

#[test]
fn positions_are_right_on_random_devices() {
    let asked = env::var("DEVICES").ok().map(|text| text.parse().expect("a number"));
    let (count, places) =
        (asked.unwrap_or(DEVICES), Raster { every: if asked.is_some() { 1 } else { 7 }, ..PLACES });
    let name = env::var("PROFILE").unwrap_or("standard".into());
    let profile = profile(&name);
    let found =
        (0..count).into_par_iter().map(|number| find(&profile, Device::draw(number), &places));
    let mut found: Vec<_> = found.collect();
    found.sort_by(|a, b| a.rms_mm().total_cmp(&b.rms_mm()));
    found.iter().rev().for_each(|found| println!("{}", line(found)));
    let at = |share: f64| found[((found.len() - 1) as f64 * share).round() as usize].rms_mm();
    println!(
        "{name}, {count} devices: median {:.4} mm rms, 90 % {:.4}, most {:.4}",
        at(0.5),
        at(0.9),
        at(1.0)
    );
    let wrong: Vec<_> = found.iter().filter(|found| is_silently_wrong(found)).map(line).collect();
    println!("wrong without a word: {}\n{}", wrong.len(), wrong.join("\n"));
    if name == "standard" {
        assert!(at(0.9) <= LIMIT_MM && wrong.is_empty());
    }
}

/// The same with every number of terminals that a sheet may have: the corners, as many as there
/// are, and others anywhere.
#[test]
fn positions_are_right_with_three_to_sixteen_terminals() {
    let profile = profile("standard");
    let found = (3..=16).into_par_iter().map(|terminals| {
        let mut device = Device::draw(2 * terminals); // a uniform film
        let [width, height] = device.size_mm;
        let mut extra = (0..).map(|n| {
            let along = 0.9 * ((0.618 * f64::from(n)).fract() - 0.5);
            [
                [along * width, 0.5 * height],
                [0.5 * width, along * height],
                [along * width, -0.5 * height],
                [-0.5 * width, along * height],
            ][n as usize % 4]
        });
        device.terminals_mm.truncate(4.min(terminals));
        device.terminals_mm.extend(extra.by_ref().take(terminals.saturating_sub(4)));
        device.terminal_ohm = vec![device.terminal_ohm[0]; terminals];
        let places = Raster { every: 7, ..PLACES };
        (terminals, find(&profile, device, &places))
    });
    for (terminals, found) in found.collect::<Vec<_>>() {
        println!("{}", line(&found));
        assert!(rms(&found.reference_mm) < 0.1, "{}", line(&found));
        // Three corners tell so little about a pad near the fourth that the words of `standard` do
        // not hold it.
        assert!(terminals == 3 || !is_silently_wrong(&found), "{}", line(&found));
    }
}

/// A pad at many places of the paper's display, from its exact currents. A 16-bit ADC without noise
/// of its own, which would be its dither, adds to that: with `carrier.rung = "samples"` `small` is
/// at 0.2 mm rms, integers or not.
#[test]
fn positions_are_right_on_the_papers_display() {
    let places = DISPLAY_PLACES.position([860.0, 500.0]);
    let scene =
        format!("{DISPLAY}[[pad]]\n{places}haptic_v_rms = 150\n[carrier]\nrung = \"phasor\"\n");
    for (name, rms_mm, most_mm) in [("standard", 0.03, 0.4), ("small", 0.08, 0.6)] {
        let (rows, _) = rows(&profile(name), &scene);
        let errors: Vec<_> = rows.iter().map(error_mm).collect();
        let most = errors.iter().copied().fold(0.0, f64::max);
        println!(
            "{name}: {:.4} mm rms, {most:.3} mm at most over {} places",
            rms(&errors),
            errors.len()
        );
        assert!(rms(&errors) <= rms_mm && most <= most_mm, "{name}");
        // The outermost places are at the pad's reach, which is where it may begin to lie over the
        // edge.
        let at_reach = |row: &Row| {
            let at = row.truth.expect("the plant knows").quantities;
            at.x_mm.abs() > 413.0 || at.y_mm.abs() > 233.0
        };
        let unflagged =
            |row: &&Row| row.flags.is_empty() || row.flags == "at_edge" && at_reach(row);
        assert_eq!(rows.iter().filter(unflagged).count(), rows.len(), "{name}");
    }
}

/// Standard deviation of positions about their mean at each place, over all places, mm.
fn noise_mm(profile: &Profile) -> f64 {
    const SLOTS: usize = 24;
    let scene = format!(
        "{DISPLAY}[[pad]]\nposition_mm = {{ raster = {{ nx = 15, ny = 9, margin_mm = 15 }} }}\n\
         [carrier]\nrung = \"phasor\"\n[sensor]\nnoise_ppm_rms = 18\n"
    );
    let (rows, _) = rows(profile, &format!("dwell_slots = {SLOTS}\n{scene}"));
    let spread = |of: fn(&Row) -> f64| {
        let places = rows.chunks(SLOTS).flat_map(move |place| {
            let mean = place.iter().map(of).sum::<f64>() / SLOTS as f64;
            place.iter().map(move |row| of(row) - mean)
        });
        rms(&places.collect::<Vec<_>>())
    };
    spread(|row| row.measured.x_mm).hypot(spread(|row| row.measured.y_mm))
}

/// Signs for all six terminals: the same noise of the currents is less noise of the position than
/// with eqs. 2 and 3.
#[test]
fn positions_have_less_noise_than_with_the_papers_ratios() {
    let ours = profile("standard");
    let mut paper = ours.clone();
    (paper.terminals.x, paper.terminals.y) = (vec![-1, -1, 1, 1, 0, 0], vec![1, -1, -1, 1, 0, 0]);
    let [ours, paper] = [noise_mm(&ours), noise_mm(&paper)];
    println!("{ours:.4} mm; with eqs. 2 and 3 {paper:.4} mm; ratio {:.3}", ours / paper);
    assert!(ours <= 0.4 * paper);
}

/// What a scene's cases share is what each would have alone, whatever the scene's cases change.
#[test]
fn a_case_after_others_has_the_calibration_that_it_has_alone() {
    const PAD: &str =
        "title = \"changed\"\n[[pad]]\nposition_mm = [0, 0]\n[sheet]\n[gap]\n[friction]\n";
    let changed = PAD.to_string()
        + &[
            ("as it is", ""),
            ("heavier", "\"pad.0.load_g\" = 80"),
            ("other terminals", "\"sheet.terminal_ohm\" = 100"),
            ("another pad", "\"device.pad_diameter_mm\" = 40"),
            ("another film", "\"sheet.slope_percent\" = [5, 0]"),
            ("another friction", "\"device.mu\" = 0.2"),
            ("another rubber", "\"gap.spring_pa_per_m\" = 3.6e7"),
            ("worn", "\"calibration.set\" = { \"device.mu\" = 0.3 }"),
        ]
        .map(|(name, set)| format!("[[case]]\nname = \"{name}\"\nset = {{ {set} }}\n"))
        .concat();
    let bundled = gallery::all().iter().map(|(_, text)| *text);
    for text in bundled.chain([changed.as_str()]) {
        let (scene, profile) = chosen(text);
        let mut others: Vec<Case> = Vec::new();
        for index in 0..scene.cases.len() {
            let after = Case::new(&scene, index, &profile, &others).expect("a case");
            // A scene of its own, for cases of one scene share effects, too.
            let (own, profile) = chosen(&scene.cases[index].document);
            let alone = Case::new(&own, 0, &profile, &[]).expect("a case");
            assert!(**after.device == **alone.device, "{}, case {}", scene.title, after.name());
            others.push(after);
        }
    }
}

/// A scene with its levels chosen, and its profile.
fn chosen(text: &str) -> (Arc<Scene>, Profile) {
    let scene = Scene::parse(text, "scene.toml", &[]).expect("a scene");
    let profile = inputs::windowed(profile(&scene.profile), &scene).expect("a profile");
    let timing = Timing { signs: None, ..inputs::timing(&profile) };
    (Arc::new(scene.within_budget(&timing).expect("levels within the budget")), profile)
}
