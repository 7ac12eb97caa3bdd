// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hdl`: Verilog with a controller and the pins of its drives, and what is refused.

use std::fs;

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
        assert!(folder.path().join(dac).join("hapticore_loop.v").exists(), "{dac}: the loop");
        let top = folder.path().join(dac).join("hapticore_drive_output.v");
        let top = fs::read_to_string(top).expect("the top");
        assert!(top.contains(&format!("--dac {dac} --wave {wave}")), "{dac}: the command");
        assert!(top.contains("output wire dac_live"), "{dac}");
        for (n, pin) in pins.iter().enumerate() {
            let port = top.lines().any(|line| line.contains("output wire") && line.contains(pin));
            assert_eq!(port, n == own, "{dac}: {pin}");
        }
    }
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
