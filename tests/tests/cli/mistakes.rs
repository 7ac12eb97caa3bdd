// SPDX-License-Identifier: MIT OR Apache-2.0
//! Mistakes that people make: each message names what is wrong, where, and what would be right.

use std::fs;
use std::path::Path;

use hapticore_contract::profile::BUNDLED;

use crate::{finish, hapticore};

/// A command line, and what its message says.
type Mistake = (&'static str, &'static [&'static str]);

/// Words of a command line that are none.
const COMMANDS: &[Mistake] = &[
    ("simulat fig6", &["unrecognized subcommand", "'simulate'"]),
    ("simulate", &["<SCENE>"]),
    ("simulate fig-6", &["a file or a scene among", "did you mean \"fig6\"?"]),
    ("simulate Fig6", &["did you mean \"fig6\"?"]),
    ("simulate fig6 --profil small", &["--profil", "--profile"]),
    ("simulate fig6 --core fixd", &["--core", "fixd", "'fixed'"]),
    ("simulate fig6 --profile fats", &["did you mean \"fast\"?"]),
    ("simulate fig3 --case rests", &["--case", "did you mean \"rest\"?"]),
    (
        "simulate hockey.wav",
        &["hockey.wav: expected a scene, got a capture: hapticore replay hockey.wav"],
    ),
    ("simulate none.toml", &["none.toml: No such file"]),
    ("simulate fig6 --set sheet", &["--set", "KEY=VALUE"]),
    ("simulate fig6 --waves vdc", &["--waves", "vdc", "vcd"]),
    ("simulate fig6 --capture c.mp3", &["c.mp3", ".csv or .wav"]),
    ("simulate fig3 --capture c.csv", &["--capture", "one case", "--case"]),
    ("replay fig6", &["a capture whose name ends in", "for a scene: hapticore simulate fig6"]),
    ("replay scene.toml", &["for a scene: hapticore simulate scene.toml"]),
    ("replay none.csv", &["none.csv: No such file"]),
    ("replay hockey.wav --pads 0", &["--pads", "0"]),
    ("replay hockey.wav --calibration hockey.wav", &["hockey.wav: expected text"]),
    ("replay hockey.wav --profile tiny", &["a profile among small, standard", "\"tiny\""]),
    ("scenes --show fig66", &["--show: expected a bundled scene", "\"fig66\""]),
    ("reference wal", &["did you mean \"wall\"?"]),
    ("reference columns --schema", &["scene, profile, calibration or messages with --schema"]),
    ("new board b.toml", &["'board'", "scene, profile, wall, loop, calibration"]),
    ("new scene scene.toml", &["scene.toml: expected a name that is not taken"]),
    ("tradeoff --target force=1", &["--target: force: expected a unit among mN"]),
    ("tradeoff --target speed=1mm", &["--target: expected force=1mN", "\"speed=1mm\""]),
    ("tradeoff --scene nope", &["a file or a scene among", "\"nope\""]),
    ("hdl --board de10 --out v", &["--board: expected a board among ulx3s, icebreaker"]),
    ("hdl --dac ad5664 --out v", &["--dac: expected a force controller too: --control LAW"]),
    (
        "hdl --board ulx3s --control inverse --out v",
        &["a converter for the controller's drives too: --dac"],
    ),
    ("codes --calibration hockey.wav", &["hockey.wav: expected text"]),
    ("codes --calibration scene.toml", &["scene.toml:2: duration_s: unknown field"]),
    ("sweep fig6", &["fig6: No such file"]),
    ("sweep scene.toml", &["scene.toml:2: unknown field `duration_s`"]),
    ("calibrate scene.toml --out m.toml", &["scene.toml"]),
    ("live hocky", &["did you mean \"hockey\"?"]),
    ("host /dev/none", &["--calibration: expected the device's calibration"]),
    ("host virtual:nope", &["a file or a scene among", "\"nope\""]),
    (
        "simulate peg --set wall.force_n=5",
        &["wall.force_n: expected at most 2.000 N, what the controller's word holds, got 5"],
    ),
    (
        "simulate fig9 --set pad.0.target_n=5",
        &["pad.0.target_n: expected at most 2.000 N, what the controller's word holds, got 5"],
    ),
];

/// Values of `--set` on `fig6`.
const SETTINGS: &[Mistake] = &[
    ("load_g=20", &["--set load_g: expected elsewhere, a key of [[pad]]: pad.0.load_g"]),
    (
        "pad.load_g=20",
        &["--set pad.load_g: expected an entry's number, 0 to 0, or its name, got load_g"],
    ),
    ("pad.9.load_g=20", &["expected an entry's number, 0 to 0", "got 9"]),
    ("pad.0.load_kg=1", &["did you mean \"load_g\"?"]),
    ("pad.0.load=20", &["expected load_g, since a key names its unit"]),
    ("pads=2", &["did you mean \"pad\"?"]),
    ("terminal_ohm=500", &["a key of [sheet]: sheet.terminal_ohm"]),
    ("sheet.terminal_ohms=500", &["did you mean \"terminal_ohm\"?"]),
    ("sheet.terminal_ohm=-5", &["a number from 0 to 1000000000, got -5"]),
    ("sheet.terminal_ohm=abc", &["a number from 0", "got \"abc\""]),
    ("sheet.width_mm=100", &["a key of [device]: device.width_mm"]),
    ("sheet.=1", &["a key such as sheet.terminal_ohm"]),
    ("sheet.rung=fine", &["expected one of \"distance\"", "got \"fine\""]),
    ("sensor.noise_ppm=40", &["expected noise_ppm_rms, since a key names its unit"]),
    ("sensor.quantisation_bits=40", &["an integer from 2 to 32, got 40"]),
    ("sensor.quantization_bits=12", &["did you mean \"quantisation_bits\"?"]),
    ("wall.force_n=1", &["without effect in this scene", "`[control]` and `[halves]`"]),
    ("pad.0.target_n=0.3", &["without effect in this scene", "with `[control]`"]),
    ("pad.0.eccentricity_mm=2", &["without effect in this scene", "with `[halves]`"]),
    ("pad.0.push_x_n=1", &["without effect in this scene", "with `[hand]`"]),
    ("pad.0.position_mm=10", &["pad.0.position_mm", "got 10"]),
    ("pad.0.position_mm=[10]", &["expected two numbers, got 1"]),
    ("pad.0.position_mm=[900,0]", &["so that the pad lies wholly on the sheet, got [900, 0]"]),
    ("pad.0.haptic_v_rms=1e9", &["a number from 0 to 100000"]),
    ("pad.0.haptic_v_rms=150 V", &["a number from 0 to 100000", "\"150 V\""]),
    ("duration_s=0", &["a number above 0"]),
    ("seed=1.5", &["an integer from 0", "got 1.5"]),
    ("title=5", &["expected text, got 5"]),
    ("criterion.0.quantity=force", &["criterion.0.quantity: unknown key", "\"of\""]),
    ("criterion.0.limit=abc", &["a finite number, got \"abc\""]),
    ("criterion.0.measure=rms", &["\"rms_error\"", "got \"rms\""]),
];

/// What is added to a scene of one pad, as its fifth line and further.
const SCENES: &[Mistake] = &[
    (
        "duration_s = 3",
        &[":5: pad.0.duration_s: expected elsewhere, a key of the scene, above its first table"],
    ),
    ("load_g = [1, 2, 3]", &[":5: pad.0.load_g: ", "got a list of 3"]),
    ("load_g = \"20 g\"", &[":5: pad.0.load_g: expected a number", "\"20 g\""]),
    ("load_g: 20", &[":5: ", "expected `=`"]),
    (
        "load_g = { sine = { mean = 3 } }",
        &[":5: pad.0.load_g.sine.amplitude: expected a number, but it is missing"],
    ),
    ("load_g = { sinus = { mean = 3 } }", &["exactly one of \"sweep\", \"timeline\", \"sine\""]),
    ("[pad]", &[":5: "]),
    ("[[pad]]", &[":5: pad.1.position_mm: expected [x, y], but it is missing"]),
    (
        "[wall]\nsurface_mm = 0",
        &[":5: wall: without effect in this scene", "`[control]` and `[halves]`"],
    ),
    (
        "[gap]\n[control]\n[halves]\n[wall]",
        &[":8: wall: expected [halves] with senses = \"each\" too"],
    ),
    ("[hand]", &[":5: hand: expected [friction] too"]),
    ("[arena]", &[":5: arena: expected [wall] too"]),
    ("[temperature]\nfilm_k = 3", &[":5: temperature: expected a [sheet] too"]),
    (
        "haptic_v_rms = 300\n[control]\n[gap]",
        &[":5: pad.0.haptic_v_rms", "[control] decides it", "target_n"],
    ),
    ("[calibration]\nfoo = 1", &[":6: calibration.foo: unknown key, expected one of \"set\""]),
    (
        "[[case]]\nname = \"a\"\n[[case]]\nname = \"a\"",
        &[":8: case.1.name: expected a name of its own"],
    ),
    (
        "[[criterion]]\nname=\"c\"\nmeasure=\"max_off\"\nlimit=1",
        &[":5: criterion.0.of: expected a quantity, but it is missing"],
    ),
    ("[magnet]", &[":5: magnet: unknown key"]),
];

/// Replacements in the profile `standard`.
const PROFILES: &[(&str, &str, &[&str])] = &[
    ("pads = 4", "pads = 0", &["pads: expected 1 to 256, got 0"]),
    ("pads = 4", "pads = \"four\"", &["pads", "four"]),
    ("pads = 4\n", "", &["missing field `pads`"]),
    ("multiplier", "multiplyer", &["`multiplyer`", "`multiplier`"]),
    ("[slot]", "[slots]", &["`slots`", "`slot`"]),
    (
        "clocks_per_sample = 25",
        "clocks_per_sample = 5",
        &["clocks_per_sample: expected 24 to 65536, got 5"],
    ),
    ("adc = \"s18.17\"", "adc = \"18\"", &["adc", "a format such as \"s18.17\""]),
    (
        "adc = \"s18.17\"",
        "adc = \"u18.18\"",
        &["formats.adc: expected a signed format, got u18.18"],
    ),
];

const PAD: &str = "title = \"t\"\nduration_s = 0.1\n[[pad]]\nposition_mm = [0, 0]\n";

/// Runs a command line, which is refused; what is wrong with that.
fn missing(folder: &Path, args: &[&str], words: &[&str]) -> Vec<String> {
    let output = hapticore(folder, args);
    let message = String::from_utf8(output.stderr).unwrap();
    let line = args.join(" ");
    if output.status.code() != Some(2) {
        return vec![format!("{line}: expected a refusal, got {:?}: {message}", output.status)];
    }
    let lacks = words.iter().filter(|word| !message.contains(**word));
    lacks.map(|word| format!("{line}: expected \"{word}\" in {message}")).collect()
}

#[test]
fn mistakes_are_met_with_cause_and_cure() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    finish(at, &["simulate", "hockey", "--capture", "hockey.wav", "--out", "h"]);
    fs::write(at.join("scene.toml"), PAD).unwrap();
    let mut wrong = Vec::new();
    for (line, words) in COMMANDS {
        let args: Vec<&str> = line.split(' ').collect();
        wrong.extend(missing(at, &args, words));
    }
    for (set, words) in SETTINGS {
        wrong.extend(missing(at, &["simulate", "fig6", "--set", set], words));
    }
    for (added, words) in SCENES {
        fs::write(at.join("mine.toml"), format!("{PAD}{added}\n")).unwrap();
        wrong.extend(missing(at, &["simulate", "mine.toml"], words));
    }
    let (_, standard) = BUNDLED.iter().find(|(name, _)| *name == "standard").unwrap();
    for (from, to, words) in PROFILES {
        assert!(standard.contains(from), "{from}");
        fs::write(at.join("words.toml"), standard.replacen(from, to, 1)).unwrap();
        wrong.extend(missing(at, &["simulate", "fig6", "--profile", "words.toml"], words));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let mistakes = COMMANDS.len() + SETTINGS.len() + SCENES.len() + PROFILES.len();
    assert!(mistakes >= 90, "{mistakes}");
}
