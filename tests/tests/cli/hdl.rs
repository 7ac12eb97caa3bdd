// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hdl`: Verilog with a controller and the pins of its drives, and what is refused.

use std::fs;

use hapticore_contract::profile::Profile;
use hapticore_host::Wave;
use hapticore_run::inputs;
use hapticore_scene::{HapticWave, Plant, Scene, Timing};

use crate::{expect, refuse};

const LOOP: [&str; 5] = ["hdl", "--profile", "fast", "--control", "inverse"];

#[test]
fn each_converter_has_its_pins_and_no_others() {
    let folder = tempfile::tempdir().unwrap();
    let pins = ["dac_pulses", "dac_sync_n", "dac_write_n"];
    for (dac, wave, own) in [
        ("pulses", "square:10", 0),
        ("ad5664", "dc", 1),
        ("ad5664r", "square", 1),
        ("ad5668", "square", 1),
        ("parallel", "sine:125000", 2),
    ] {
        let args = [&LOOP[..], &["--dac", dac, "--wave", wave, "--out", dac]].concat();
        expect(folder.path(), &args, 0);
        assert!(folder.path().join(dac).join("hapticore_fast_loop.v").exists(), "{dac}: the loop");
        let top = folder.path().join(dac).join("hapticore_fast_drive_output.v");
        let top = fs::read_to_string(top).expect("the top");
        assert!(top.contains(&format!("--dac {dac} --wave {wave}")), "{dac}: the command");
        assert!(top.contains("output wire dac_live"), "{dac}");
        for (n, pin) in pins.iter().enumerate() {
            let port = top.lines().any(|line| line.contains("output wire") && line.contains(pin));
            assert_eq!(port, n == own, "{dac}: {pin}");
        }
    }
}

/// As often as a scene's wave turns behind the paper's resistor, in frames of 1 ms and of 6.8 ms.
#[test]
fn a_square_turns_every_20_time_constants_of_a_pad_by_default() {
    let folder = tempfile::tempdir().unwrap();
    for (profile, slots) in [("fast", 5), ("standard", 1)] {
        let args = [
            "hdl",
            "--profile",
            profile,
            "--control",
            "inverse",
            "--dac",
            "ad5664",
            "--out",
            profile,
        ];
        let output = expect(folder.path(), &args, 0);
        let printed = String::from_utf8_lossy(&output.stdout);
        assert!(printed.contains(&format!("square:{slots}")), "{printed}");
    }
    let behind = "title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n[supply]\n[carrier]\nhaptic_wave = \"square\"\n";
    let scene = Scene::parse(behind, "t.toml", &[]).expect("a scene");
    let timing =
        Timing { pads: 4, slot_samples: 250, ..inputs::timing(&Profile::bundled("fast").unwrap()) };
    let plant = Plant::new(&scene, 0, &timing).expect("a plant");
    let least_s = 1e-6 * Wave::LEAST_TURN_US as f64;
    let HapticWave::Square { turn_s: Some(turn_s) } = plant.device().haptic_wave else {
        panic!("a square")
    };
    assert!((turn_s - least_s) / 250e-6 < 1.0 && turn_s >= least_s, "{turn_s}");
}

#[test]
fn drives_that_cannot_be_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (args, words) in [
        (
            &["--control", "inverse", "--dac", "ad5761"][..],
            "expected pulses, ad5664, ad5664r, ad5668 or parallel",
        ),
        (
            &["--control", "inverse", "--dac", "pulses", "--wave", "sine:10"],
            "sine:N with N from 512",
        ),
        (&["--control", "inverse", "--wave", "dc"], "--dac"),
        (&["--dac", "pulses"], "expected a force controller too: --control LAW"),
        (
            &["--board", "ulx3s", "--control", "inverse", "--dac", "pulses"],
            "ulx3s has no pins for such a drive: expected ulx3s, with ad5664, ad5664r or ad5668",
        ),
        (
            &["--board", "icebreaker", "--control", "open", "--dac", "ad5664"],
            "icebreaker has no pins for such a drive: expected ulx3s",
        ),
        (
            &["--board", "ulx3s", "--control", "open"],
            "expected a converter for the controller's drives too: --dac ad5664r",
        ),
    ] {
        if args.contains(&"--dac") || args.contains(&"--board") {
            refuse(folder.path(), &[&["hdl"], args].concat(), &[words]);
        } else {
            let out = [&["hdl"], args, &["--out", "results"]].concat();
            let log = String::from_utf8(expect(folder.path(), &out, 2).stderr).expect("text");
            assert!(log.contains(words), "{log}");
        }
    }
    let many = folder.path().join("many.toml");
    let text = include_str!("../../../model/contract/src/profile/standard.toml");
    fs::write(&many, text.replace("\npads = 4", "\npads = 5")).unwrap();
    let args = ["hdl", "--profile", "many.toml", "--control", "inverse", "--dac", "ad5664"];
    refuse(folder.path(), &args, &["pads", "at most 4"]);
}

/// Modules of an earlier print would be compiled with `*.v`; files of the user stay.
#[test]
fn a_print_takes_the_place_of_an_earlier_one() {
    let folder = tempfile::tempdir().unwrap();
    let names = || {
        let entries = fs::read_dir(folder.path().join("out")).unwrap().flatten();
        let mut names: Vec<_> =
            entries.map(|entry| entry.file_name().into_string().unwrap()).collect();
        names.sort();
        names
    };
    expect(folder.path(), &["hdl", "--profile", "small", "--out", "out"], 0);
    let small = names();
    fs::write(folder.path().join("out/mine.v"), "module mine; endmodule\n").unwrap();
    expect(folder.path(), &[&LOOP[..], &["--dac", "pulses", "--out", "out"]].concat(), 0);
    assert!(names().iter().all(|name| !name.contains("small")), "{:?}", names());
    expect(folder.path(), &["hdl", "--board", "ulx3s", "--out", "out"], 0);
    assert_eq!(names(), ["build.sh", "mine.v", "top.v", "ulx3s.lpf"]);
    expect(folder.path(), &["hdl", "--profile", "small", "--out", "out"], 0);
    let mut expected = small;
    expected.push("mine.v".into());
    expected.sort();
    assert_eq!(names(), expected);
}

/// A board has the device's terminals and pads, or says why it cannot have them.
#[test]
fn a_board_is_made_for_the_terminals_and_pads_of_the_profile() {
    let folder = tempfile::tempdir().unwrap();
    let text = include_str!("../../../model/contract/src/profile/standard.toml");
    let profile = |pads: u64, terminals: usize| {
        let signs = |signs: [i64; 8]| format!("{:?}", &signs[..terminals]);
        let lines = text.lines().map(|line| match line.split_once(" = [") {
            Some(("x", _)) => format!("x = {}", signs([-1, -1, 1, 1, 0, 0, 1, -1])),
            Some(("y", _)) => format!("y = {}", signs([1, -1, -1, 1, -1, 1, 0, 0])),
            _ if line.starts_with("pads = ") => format!("pads = {pads}"),
            _ if line.starts_with("clocks_per_sample = ") => "clocks_per_sample = 30".into(),
            _ => line.to_owned(),
        });
        let text: Vec<_> = lines.collect();
        fs::write(folder.path().join("mine.toml"), text.join("\n")).unwrap();
    };
    for (pads, terminals) in [(1, 4), (3, 5), (4, 6)] {
        profile(pads, terminals);
        let args = ["hdl", "--board", "ulx3s", "--profile", "mine.toml", "--out", "out"];
        expect(folder.path(), &args, 0);
        let constraints = fs::read_to_string(folder.path().join("out/ulx3s.lpf")).unwrap();
        let ports = |name: &str| {
            let own = |line: &&str| line.starts_with(&format!("LOCATE COMP \"{name}"));
            constraints.lines().filter(own).count() as u64
        };
        assert_eq!(
            (ports("pads"), ports("dout")),
            (pads, terminals as u64 + 2),
            "{pads}, {terminals}"
        );
        let verilog = fs::read_to_string(folder.path().join("out/top.v")).unwrap();
        let head: Vec<_> = verilog.lines().take(5).collect();
        for words in ["SPDX-License-Identifier", "digest", "25000000 Hz", "1000000 baud"] {
            assert!(head.iter().any(|line| line.contains(words)), "{words}: {head:?}");
        }
    }
    for (pads, terminals, words) in [
        (5, 6, "pads: expected 1 to 4, for ulx3s has no more pins for them; got 5"),
        (4, 8, "ADC channels: expected 2 to 8, got 10"),
    ] {
        profile(pads, terminals);
        refuse(folder.path(), &["hdl", "--board", "ulx3s", "--profile", "mine.toml"], &[words]);
    }
}

#[test]
fn a_folder_whose_name_is_no_text_is_named_in_json_too() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    let out = std::ffi::OsStr::from_bytes(b"caf\xe9");
    let mut hdl = crate::command(folder.path(), &["hdl", "--profile", "small", "--json", "--out"]);
    let output = hdl.arg(out).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let told: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(told["files"][0].as_str().is_some_and(|name| name.starts_with("caf")), "{told}");
}
