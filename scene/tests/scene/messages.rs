// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every mistake in a scene is one line that names the file, the line, the key, what was expected
//! and what was found.

use hapticore_scene::{Plant, Scene, Timing};

const SCENE: &str = "title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n";

fn message(text: &str, overrides: &[(&str, &str)]) -> String {
    let overrides: Vec<_> =
        overrides.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    let error =
        Scene::parse(text, "s.toml", &overrides).expect_err("the scene was accepted").to_string();
    assert!(!error.contains('\n') && error.len() < 600, "not one line: {error}");
    error
}

fn check(table: &str, expected: &str) {
    let message = message(&format!("{SCENE}{table}"), &[]);
    assert!(message.starts_with(expected), "got      {message}\nexpected {expected}");
}

#[test]
fn a_calibration_that_cannot_be_of_the_device_names_its_key() {
    for (set, words) in [
        (
            "\"sheet.terminals\" = 4",
            "calibration.set: expected the 6 terminals that the device has, got 4",
        ),
        ("\"sheet.foo\" = 4", "sheet.foo: unknown key"),
        ("seed = 4", "seed belongs to the whole scene"),
        (
            "\"pad.9.load_g\" = 4",
            "pad.9.load_g: expected an entry's number, 0 to 0, or its name, got 9",
        ),
    ] {
        let text = format!(
            "title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n[sheet]\n[calibration]\nset = {{ {set} }}\n"
        );
        let message = Scene::parse(&text, "s.toml", &[]).unwrap_err().to_string();
        assert!(message.starts_with("s.toml:") && message.contains(words), "{message}");
    }
}

/// Its film is implicit, its spring is not.
#[test]
fn semi_implicit_refuses_rubber_that_it_would_make_swing() {
    let with = |rung: &str, key: &str| {
        let text = format!(
            "title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n[gap]\nrung = \"{rung}\"\n{key}\n"
        );
        Scene::parse(&text, "s.toml", &[])
    };
    for key in ["spring_pa_per_m = 1e15", "creep_share = 1000"] {
        let message = with("semi-implicit", key).unwrap_err().to_string();
        assert!(
            message.contains("s.toml:5: gap.rung: expected rubber of at most 1.8e9 Pa/m"),
            "{message}"
        );
        assert!(with("tr-bdf2", key).is_ok() && with("moving", key).is_ok(), "{key}");
    }
    assert!(with("semi-implicit", "spring_pa_per_m = 1e9").is_ok());
}

#[test]
fn unknown_level() {
    check(
        "[sheet]\nrung = \"cubic\"",
        "s.toml:5: sheet.rung: expected one of \"distance\", \"bilinear\", \"bicubic\", \"bicubic-fine\", \"analytic\", \"grid-20-mm\"",
    );
}

#[test]
fn unknown_effect() {
    let magnet = format!("{SCENE}[magnet]\nrung = \"a\"");
    assert!(message(&magnet, &[]).starts_with("s.toml:4: magnet: unknown key, expected one of "));
    assert!(
        message(&magnet, &[])
            .contains("\"charge\", \"temperature\", \"gap\", \"halves\", \"hand\", \"release\"")
    );
}

#[test]
fn unknown_key() {
    check(
        "[gap]\n\ncoil = 3",
        "s.toml:6: gap.coil: unknown key, expected one of \"rung\", \"insulator_um\", ",
    );
}

#[test]
fn negative_thickness() {
    check(
        "[gap]\ninsulator_um = -8",
        "s.toml:5: gap.insulator_um: expected a number from 0.01 to 10000, got -8",
    );
}

#[test]
fn missing_unit() {
    let bare = message("title = \"t\"\n[[pad]]\nposition = [0, 0]", &[]);
    assert_eq!(bare, "s.toml:3: pad.0.position: expected position_mm, since a key names its unit");
    check("load = 20", "s.toml:4: pad.0.load: expected load_g, since a key names its unit");
    check(
        "[sheet]\n[shunt]\nnanofarad = 9",
        "s.toml:6: shunt.nanofarad: expected nanofarad_per_m2, since a key",
    );
    check(
        "[sensor]\njitter_ns = 1",
        "s.toml:5: sensor.jitter_ns: expected jitter_ns_rms, since a key names its unit",
    );
}

#[test]
fn effects_that_need_a_sheet() {
    let sheet = "expected a [sheet] too, since";
    check("[shunt]\nnanofarad_per_m2 = 9", &format!("s.toml:4: shunt: {sheet}"));
    check("[coupling]", &format!("s.toml:4: coupling: {sheet}"));
    check("[switching]", &format!("s.toml:4: switching: {sheet}"));
    let uneven = "[sheet]\nslope_percent = [5, 0]\n[shunt]\nnanofarad_per_m2 = 9";
    check(
        uneven,
        "s.toml:6: shunt: expected a uniform film, without sheet.slope_percent and sheet.patch",
    );
    let wish = message(&format!("uncouple = true\n{SCENE}"), &[]);
    assert_eq!(wish, "s.toml:1: uncouple: expected a [coupling] that could be taken out again");
}

#[test]
fn sheets_that_cannot_be() {
    check(
        "[sheet]\nterminals = 5",
        "s.toml:5: sheet.terminals: expected 4 or 6, got 5; terminals_mm takes the places of any other number",
    );
    check(
        "[sheet]\nterminals = 4\nopen = [6]",
        "s.toml:6: sheet.open: expected a list, each a number from 1 to 4, got 6",
    );
    check(
        "[sheet]\nopen = [1.5]",
        "s.toml:5: sheet.open: expected numbers of terminals, 1 to 6, got 1.5",
    );
    check(
        "[sheet]\nopen = [1, 2, 3, 4, 5, 6]",
        "s.toml:5: sheet.open: expected a terminal that is not open, since the current has to leave",
    );
    check(
        "[sheet]\nslope_percent = [95, 0]",
        "s.toml:5: sheet.slope_percent: expected a list, each a number from -90",
    );
    check(
        "[sheet]\nslope_percent = [5, 0]\nrung = \"bicubic\"",
        "s.toml:6: sheet.rung: expected one of \"grid-20-mm\"",
    );
    check(
        "[[sheet.patch]]\ncentre_mm = [0, 0]\nsize_mm = [1, 0]",
        "s.toml:6: sheet.patch.0.size_mm: expected a list, each a number from 0.001 to 100000, got 0",
    );
    check(
        "[shunt]\nnanofarad_per_m2 = -9",
        "s.toml:5: shunt.nanofarad_per_m2: expected a number from 0 to 10000, got -9",
    );
    check(
        "[sensor]\ndither_lsb_rms = 1",
        "s.toml:5: sensor.dither_lsb_rms: expected quantisation_bits too",
    );
}

#[test]
fn timelines_that_go_back_or_nowhere() {
    check(
        "load_g = { timeline = [] }",
        "s.toml:4: pad.0.load_g.timeline: expected a list of pairs of numbers, got a list of 0",
    );
    check(
        "load_g = { timeline = [[0, 1], [1, 2], [0, 1]] }",
        "s.toml:4: pad.0.load_g.timeline: expected times that do not fall",
    );
}

#[test]
fn steps_too_long_for_the_gap() {
    check(
        "[gap]\nrung = \"tr-bdf2\"\nstep_us = 1500",
        "s.toml:6: gap.step_us: expected at most 1000, since near the fold a longer step pulls in seconds too early or too late, got 1500",
    );
    check(
        "[gap]\nrung = \"semi-implicit\"\nstep_us = 500",
        "s.toml:6: gap.step_us: expected at most 200, since a longer step bounces off the contact, got 500",
    );
}

#[test]
fn tables_and_keys_that_mean_nothing_alone() {
    check("[hand]", "s.toml:4: hand: expected [friction] too");
    check("[halves]", "s.toml:4: halves: expected [gap] too");
    check("push_x_n = 1", "s.toml:4: pad.0.push_x_n: without effect in this scene");
    check("eccentricity_mm = 1", "s.toml:4: pad.0.eccentricity_mm: without effect in this scene");
    check(
        "push_x_n = { sweep = [1, 2] }\n[hand]\n[friction]",
        "s.toml:4: pad.0.push_x_n: expected a push over time, got a sweep of 2 points",
    );
    check(
        "eccentricity_mm = 8\n[halves]\n[gap]",
        "s.toml:4: pad.0.eccentricity_mm: expected a number from -7.5 to 7.5, got 8",
    );
    check(
        "[gap]\n[halves]\npush_height_mm = 5",
        "s.toml:6: halves.push_height_mm: expected [hand] too, which pushes at that height",
    );
    check("[gap]\n[halves]\nstrips = 3", "s.toml:6: halves.strips: expected 2 or 4, got 3");
    check(
        "[gap]\n[halves]\nsensing_v_rms = 9",
        "s.toml:6: halves.sensing_v_rms: without effect in this scene",
    );
}

#[test]
fn wrong_types() {
    check(
        "[sheet]\nohm_per_square = \"150\"",
        "s.toml:5: sheet.ohm_per_square: expected a number from 0.001 to 10000000, got \"150\"",
    );
    check(
        "[sensor]\nquantisation_bits = 16.5",
        "s.toml:5: sensor.quantisation_bits: expected an integer from 2 to 32, got 16.5",
    );
    check(
        "[sensor]\nhaptic_leakage = 1",
        "s.toml:5: sensor.haptic_leakage: expected true or false, got 1",
    );
    check("[[sheet]]", "s.toml:4: sheet: expected a table, got a list of 1");
    check(
        "[carrier]\nfrequency_hz = nan",
        "s.toml:5: carrier.frequency_hz: expected a number from 1 to 1000000000, got NaN",
    );
    check(
        "[carrier]\nfrequency_hz = 99999999999999999999",
        "s.toml:5: carrier.frequency_hz: expected an integer of at most 64 bits",
    );
}

#[test]
fn pad_outside_the_sheet() {
    let scene = |position| format!("title = \"t\"\n[[pad]]\nposition_mm = {position}\n");
    let expected = "s.toml:3: pad.0.position_mm: expected the pad's centre within ±415 × ±235 mm";
    for position in [
        "[500, 0]",
        "[0, -235.1]",
        "{ sweep = [[0, 0], [416, 0]] }",
        "{ raster = { nx = 3, ny = 3, margin_mm = 10 } }",
        "{ line = { from_mm = [0, 0], to_mm = [0, 300], period_s = 1 } }",
        "{ circle = { centre_mm = [400, 0], radius_mm = 20, period_s = 1 } }",
        "{ lissajous = { amplitude_mm = [100, 240], frequency_hz = [1, 1] } }",
        "{ timeline = { x_mm = [[0, 0], [1, 430], [2, 0]] } }",
    ] {
        let message = message(&scene(position), &[]);
        assert!(message.starts_with(expected), "{position}: {message}");
    }
}

#[test]
fn terminals_inside_the_sheet() {
    check(
        "[sheet]\nterminal_5_mm = [0, 0]",
        "s.toml:5: sheet.terminal_5_mm: expected a place on the sheet's edge",
    );
    check(
        "[sheet]\nterminal_6_mm = [0, -250]",
        "s.toml:5: sheet.terminal_6_mm: expected a place other than terminal 5's",
    );
    check(
        "[sheet]\nterminal_radius_mm = 12",
        "s.toml:5: sheet.terminal_radius_mm: expected a number from 0.001 to 10",
    );
}

#[test]
fn places_of_terminals_that_cannot_be() {
    let places = |list: &str, expected: &str| {
        check(&format!("[sheet]\nterminals_mm = {list}"), &format!("s.toml:5: sheet.{expected}"))
    };
    let [a, b, c] = ["[-430, 250]", "[-430, -250]", "[430, 0]"];
    places(
        &format!("[{a}, {b}, [420, 0]]"),
        "terminals_mm: expected places on the sheet's edge, x = ±430 or y = ±250, got [420.0, 0.0] as terminal 3",
    );
    places(&format!("[{a}, {b}, [430, 251]]"), "terminals_mm: expected places on the sheet's edge");
    places(
        &format!("[{a}, {b}, {c}, {b}]"),
        "terminals_mm: expected different places, got [-430.0, -250.0] as terminals 2 and 4",
    );
    places(&format!("[{a}, {b}]"), "terminals_mm: expected 3 to 16 places, got 2");
    let many: Vec<_> = (0..17).map(|n| format!("[{}, 250]", n * 20 - 200)).collect();
    places(&format!("[{}]", many.join(", ")), "terminals_mm: expected 3 to 16 places, got 17");
    places("[1, 2, 3]", "terminals_mm: expected a list of pairs of numbers");
    for (key, value) in [
        ("terminals", "4"),
        ("middles", "\"short\""),
        ("terminal_5_mm", "[0, 250]"),
        ("terminal_6_mm", "[0, 250]"),
    ] {
        check(
            &format!("[sheet]\nterminals_mm = [{a}, {b}, {c}]\n{key} = {value}"),
            &format!(
                "s.toml:6: sheet.{key}: expected none, since terminals_mm says where all terminals are"
            ),
        );
    }
    check(
        &format!("[sheet]\nterminals_mm = [{a}, {b}, {c}]\nopen = [4]"),
        "s.toml:6: sheet.open: expected a list, each a number from 1 to 3, got 4",
    );
    check(
        "[sheet]\nterminals = 17",
        "s.toml:5: sheet.terminals: expected an integer from 3 to 16, got 17",
    );
}

#[test]
fn a_resistance_for_each_terminal() {
    check(
        "[sheet]\nterminals = 4\nterminal_ohm = [1, 2, 3]",
        "s.toml:6: sheet.terminal_ohm: expected a number, or one for each of 4 terminals, got a list of 3",
    );
    check(
        "[sheet]\nterminals = 4\nterminal_ohm = [1, 2, 3, -4]",
        "s.toml:6: sheet.terminal_ohm: expected a list, each a number from 0 to 1000000000, got -4",
    );
}

#[test]
fn signs_for_other_terminals() {
    let scene = Scene::parse(&format!("{SCENE}[sheet]\nterminals = 4"), "s.toml", &[]).unwrap();
    let signs = Some([vec![-1, -1, 1, 1, 0, 0], vec![1, -1, -1, 1, 0, 0]]);
    let timing = Timing {
        pads: 1,
        slot_samples: 9,
        window_start: 0,
        window_samples: 9,
        samples_per_period: 9.0,
        signs,
    };
    let error = Plant::new(&scene, 0, &timing).map(|_| ()).unwrap_err().to_string();
    assert_eq!(error, "s.toml: profile: expected 4 signs, as the device has terminals, got 6");
}

#[test]
fn sweeps_and_time_do_not_mix() {
    let swept = format!("duration_s = 1\n{SCENE}load_g = {{ sweep = [1, 2] }}");
    assert!(
        message(&swept, &[])
            .starts_with("s.toml:1: duration_s: expected none, since the sweep decides")
    );
    check(
        "load_g = { sine = { amplitude = 1, frequency_hz = 1 } }",
        "s.toml:4: pad.0.load_g.sine: expected a number from 0",
    );
    let endless = "load_g = { timeline = [[0, 1], [1, 2]] }";
    check(
        endless,
        "s.toml: duration_s: expected a number above 0, since a pad changes over time, but it is missing",
    );
    check(
        "load_g = { sweep = [] }",
        "s.toml:4: pad.0.load_g.sweep: expected a list, each a number from 0 to 100000, got a list of 0",
    );
    check(
        "load_g = { timeline = [[1, 1], [0, 2]] }",
        "s.toml:4: pad.0.load_g.timeline: expected times that do not fall",
    );
    let moved =
        "title = \"t\"\n[[pad]]\nposition_mm = { timeline = { x_mm = [[1, 1], [0, 1]] } }\n";
    assert_eq!(
        message(moved, &[]),
        "s.toml:3: pad.0.position_mm.timeline.x_mm: expected times that do not fall"
    );
}

#[test]
fn a_gap_and_a_capacitance_of_its_own() {
    check(
        "capacitance_pf = 300\n[gap]",
        "s.toml:4: pad.0.capacitance_pf: expected no capacitance of its own, since [gap]",
    );
}

#[test]
fn criteria() {
    let head = "[[criterion]]\nname = \"c\"\nlimit = 1\n";
    check(
        &format!("{head}of = \"force_n\"\nmeasure = \"best\""),
        "s.toml:8: criterion.0.measure: expected one of \"max_abs_error\"",
    );
    check(
        &format!("{head}of = \"force\"\nmeasure = \"rms_error\""),
        "s.toml:7: criterion.0.of: expected one of \"time_s\"",
    );
    check(
        &format!("{head}of = \"force_n\"\nmeasure = \"increases_with\""),
        "s.toml:4: criterion.0.with: expected with",
    );
    let case = "of = \"force_n\"\nmeasure = \"rms_error\"\ncase = \"wet\"";
    check(
        &format!("{head}{case}"),
        "s.toml:9: criterion.0.case: expected the name of a case, one of [\"main\"], got \"wet\"",
    );
}

#[test]
fn cases() {
    check(
        "[[case]]\nname = \"a\"\nset = { \"sheet.wet\" = 1 }",
        "s.toml:6: sheet.wet: unknown key",
    );
    check(
        "[[case]]\nname = \"a\"\nset = { seed = 1 }",
        "s.toml:6: case.0.set: seed belongs to the whole scene",
    );
    check(
        "[[case]]\nname = \"a\"\n[[case]]\nname = \"a\"",
        "s.toml:7: case.1.name: expected a name of its own, got \"a\" again",
    );
    check("[[case]]\nset = {}", "s.toml:4: case.0.name: expected text, but it is missing");
}

#[test]
fn overrides() {
    let expect = |key, value, expected: &str| {
        let message = message(SCENE, &[(key, value)]);
        assert!(message.starts_with(expected), "got      {message}\nexpected {expected}");
    };
    expect("sheet.rung", "cubic", "s.toml: --set sheet.rung: expected one of \"distance\"");
    expect(
        "sheet.wet",
        "1",
        "s.toml: --set sheet.wet: unknown key, expected one of \"terminals\", \"middles\"",
    );
    expect("magnet.rung", "1", "s.toml: --set magnet: unknown key");
    expect(
        "pad.3.load_g",
        "1",
        "s.toml: --set pad.3.load_g: expected an entry's number, 0 to 0, or its name, got 3",
    );
    expect("title.x", "1", "s.toml: --set title.x: expected a table at title, got");
    expect(
        "sheet..rung",
        "1",
        "s.toml: --set sheet..rung: expected a key such as sheet.terminal_ohm",
    );
}

#[test]
fn no_scene_at_all() {
    assert_eq!(message("", &[]), "s.toml: title: expected text, but it is missing");
    assert_eq!(
        message("title = \"t\"", &[]),
        "s.toml: pad: expected 1 to 16 tables headed [[pad]], got 0"
    );
    assert!(message("title = \"t\"\n\ntitle = \"u\"", &[]).starts_with("s.toml:3: duplicate key"));
    for nonsense in ["%&@\u{0}\u{1b}[2J ", "[[[[", "a = [", "{", "\"\"\"", "a.", "= ", "\n", "é"] {
        assert!(message(&nonsense.repeat((1 << 20) / nonsense.len()), &[]).starts_with("s.toml"));
    }
}

#[test]
fn too_many_pads_for_the_profile() {
    let scene =
        Scene::parse(&format!("{SCENE}[[pad]]\nposition_mm = [9, 9]"), "s.toml", &[]).unwrap();
    let timing = Timing {
        pads: 1,
        slot_samples: 9,
        window_start: 0,
        window_samples: 9,
        samples_per_period: 9.0,
        signs: None,
    };
    let error = Plant::new(&scene, 0, &timing).map(|_| ()).unwrap_err().to_string();
    assert_eq!(error, "s.toml: pad: expected at most 1 pads, as profile standard serves, got 2");
}

#[test]
fn charge_and_waves_that_cannot_be() {
    check(
        "[charge]\ntime_constant_s = 3",
        "s.toml:4: charge.share: expected a number from -10 to 0.99, but it is missing",
    );
    check(
        "[charge]\nshare = 0.3",
        "s.toml:4: charge.time_constant_s: expected a number from 0.000000001 to 1000000, but it is missing",
    );
    check(
        "[charge]\nshare = 1.5\ntime_constant_s = 3",
        "s.toml:5: charge.share: expected a number from -10 to 0.99, got 1.5",
    );
    check(
        "[charge]\nshare = [0.5, 0.6]\ntime_constant_s = [3, 4]",
        "s.toml:5: charge.share: expected at most 4 shares that add up to 0.99 at most, got [0.5, 0.6]",
    );
    check(
        "[charge]\nshare = [0.1, 0.2]\ntime_constant_s = 3",
        "s.toml:6: charge.time_constant_s: expected 2, one for each share, got 1",
    );
    check(
        "[carrier]\nhaptic_wave = \"saw\"",
        "s.toml:5: carrier.haptic_wave: expected one of \"sine\", \"dc\", \"square\", got \"saw\"",
    );
    check(
        "[carrier]\nhaptic_turn_s = 0.1",
        "s.toml:5: carrier.haptic_turn_s: expected haptic_wave = \"square\" too",
    );
    let square = "[carrier]\nhaptic_wave = \"square\"\n";
    check(
        &format!("{square}[sensor]\nhaptic_leakage = true"),
        "s.toml:7: sensor.haptic_leakage: expected carrier.haptic_wave = \"sine\" with it, whose current alone is known here, got \"square\"",
    );
    check(
        &format!("{square}[gap]\ndrive = \"sine\""),
        "s.toml:7: gap.drive: expected \"rms\" where carrier.haptic_wave is no sine, got \"square\"",
    );
    check(
        &format!("{square}[supply]\ntransformer_h = 1"),
        "s.toml:7: supply.transformer_h: expected 0 with carrier.haptic_wave = \"square\"",
    );
}

#[test]
fn release_drift_springs_and_panel_noise_that_cannot_be() {
    check("[release]", "s.toml:4: release: expected [friction] too");
    check(
        "[friction]\n[release]\ntime_constant_ms = 0",
        "s.toml:6: release.time_constant_ms: expected a number from 0.000001 to 1000000, got 0",
    );
    check(
        "[friction]\ndrift = { sweep = [1, 2] }",
        "s.toml:5: friction.drift: expected a factor over time, not a sweep",
    );
    check(
        "[friction]\ndrift = { timeline = [[0, 1], [1, -1]] }",
        "s.toml:5: friction.drift.timeline: expected a number from 0 to 100, got -1",
    );
    check(
        "[temperature]\nspring_percent_per_k = 1",
        "s.toml:5: temperature.spring_percent_per_k: expected a [gap] too",
    );
    check(
        "[gap]\n[temperature]\nspring_percent_per_k = -5\nrise_k = 40",
        "s.toml:6: temperature.spring_percent_per_k: expected springs that lose at most 0.9 of themselves, got 2",
    );
    check(
        "[gap]\n[temperature]\nspring_percent_per_k = 1\ngradient_k = [1, 0]",
        "s.toml:7: temperature.gradient_k: without effect in this scene",
    );
    check(
        "[gap]\nspring_pa_per_m = 5e8\nrung = \"semi-implicit\"\n[temperature]\nspring_percent_per_k = 10\nrise_k = 40",
        "s.toml:6: gap.rung: expected rubber of at most 1.8e9 Pa/m",
    );
    let shunt = "[sheet]\n[shunt]\nnanofarad_per_m2 = 9\n";
    check(
        &format!("{shunt}panel_noise_mv = -1"),
        "s.toml:7: shunt.panel_noise_mv: expected a number from 0 to 100000, got -1",
    );
    check(
        &format!("{shunt}panel_noise_khz = 1"),
        "s.toml:7: shunt.panel_noise_khz: expected panel_noise_mv too",
    );
    check(
        &format!("{shunt}panel_noise_mv = 1\npanel_noise_khz = 20"),
        "s.toml:8: shunt.panel_noise_khz: expected at most 10, a tenth of the carrier's frequency, got 20",
    );
}

/// Shares that are not of the pad, with the cure.
#[test]
fn shares_of_the_pad_that_cannot_be_name_their_key() {
    let gap = |keys: &str, expected: &str| check(&format!("[gap]\n{keys}"), expected);
    gap(
        "rest_um = [12, 30]",
        "s.toml:4: gap.area_shares: expected 2 numbers, one for each height of gap.rest_um, got none, and the \
         default shares are for the default heights only; set gap.area_shares",
    );
    gap(
        "rest_um = [12, 30]\narea_shares = [0.4, 0.6]",
        "s.toml:4: gap.load_shares: expected 2 numbers, one for each height of gap.rest_um, got none, and the \
         default shares are for the default heights only; set gap.load_shares",
    );
    gap(
        "rest_um = [13, 14.5, 16, 17.5, 19.0664, 19.5503, 26, 34]",
        "s.toml:4: gap.area_shares: expected 8 numbers, one for each height of gap.rest_um, got none, and the default \
         shares are for the default heights only; set gap.area_shares",
    );
    gap(
        "area_shares = [0.4, 0.6]",
        "s.toml:5: gap.area_shares: expected 8 numbers, one for each height of gap.rest_um, got 2",
    );
    let two = "rest_um = [12, 30]\n";
    gap(
        &format!("{two}area_shares = [0.4, 0.7]\nload_shares = [2.5, 0]"),
        "s.toml:6: gap.area_shares: expected shares of the pad's area whose sum is 1, got 1.1",
    );
    gap(
        &format!("{two}area_shares = [1.4, -0.4]\nload_shares = [2.5, 0]"),
        "s.toml:6: gap.area_shares",
    );
    gap(
        &format!("{two}area_shares = [0.4, 0.6]\nload_shares = [1, 0]"),
        "s.toml:7: gap.load_shares: expected loads per area whose sum, each times its share of the area, is 1, got 0.4",
    );
    gap(
        &format!("{two}area_shares = [0.4, 0.6]\nload_shares = [4, -1]"),
        "s.toml:7: gap.load_shares",
    );
    gap(
        "contact_decay_um = 3",
        "s.toml:5: gap.contact_decay_um: expected at most half of the insulators' 5 µm of air",
    );
    let of_two = format!("{SCENE}[gap]\n{two}area_shares = [0.4, 0.6]\nload_shares = [2.5, 0]\n");
    assert!(Scene::parse(&of_two, "s.toml", &[]).is_ok());
    assert!(Scene::parse(&format!("{SCENE}[gap]\nrest_um = [20]\n"), "s.toml", &[]).is_ok());
}
