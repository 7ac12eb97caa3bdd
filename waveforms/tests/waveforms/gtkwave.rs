// SPDX-License-Identifier: MIT OR Apache-2.0
//! GTKWave itself opens what is written: every trace of a save file, with the numbers that were
//! traced.
//!
//! Needs `gtkwave` and `xvfb-run`; ignored where they are not to be had.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::{Fake, VARIABLES, folder, settings, trace, true_x};
use hapticore_waveforms::gtkwave::save;
use hapticore_waveforms::kind::Kind;
use hapticore_waveforms::view::View;

const CLOCK: u64 = 101;

/// Prints each line shown, with its value at a time; headings have none.
const SCRIPT: &str = "
gtkwave::setMarker TIME
for {set i 0} {$i < [gtkwave::getTotalNumTraces]} {incr i} {
    puts \"SHOWN [gtkwave::getTraceNameFromIndex $i]=[gtkwave::getTraceValueAtMarkerFromIndex $i]\"
}
exit
";

/// What GTKWave shows of `dump` under `save` at the tick: names and values, from top to bottom.
fn shown(dump: &Path, save: &Path, tick: u64) -> Vec<(String, String)> {
    let script = save.with_extension("tcl");
    fs::write(&script, SCRIPT.replace("TIME", &tick.to_string())).unwrap();
    let mut command = Command::new("xvfb-run");
    // From another folder than that of the files, which may not matter.
    command.arg("-a").arg("gtkwave").arg("-S").args([&script, dump, save]).current_dir("/");
    let text = String::from_utf8(command.output().unwrap().stdout).unwrap();
    let lines = text.lines().filter_map(|line| line.strip_prefix("SHOWN ")?.split_once('='));
    lines.filter(|line| !line.1.is_empty()).map(|(a, b)| (a.to_string(), b.to_string())).collect()
}

/// What GTKWave should show, name and value, for a variable of the made-up core.
fn of_variable(index: usize, code: i64) -> (String, String) {
    let (path, format, states) = VARIABLES[index];
    let name = path.replace('.', "/");
    match path.rsplit('.').next().unwrap() {
        "state" => (name, states[code as usize].into()),
        "gain" => (name + " (2^-38)", code.to_string()),
        "coarse" => (name + " (2^3)", code.to_string()),
        _ => (name, format.real(code).to_string()),
    }
}

fn expected() -> Vec<(String, String)> {
    let codes = Fake { clock: CLOCK }.codes().into_iter().enumerate();
    let truth = [
        ("truth/x (mm)".into(), true_x(CLOCK).to_string()),
        ("truth/error".into(), "-1.5e-12".into()),
    ];
    codes.map(|(index, code)| of_variable(index, code)).chain(truth).collect()
}

fn same(a: &str, b: &str) -> bool {
    match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= 1e-14 * a.abs().max(1.0),
        _ => a == b,
    }
}

fn check(kind: Kind) {
    let folder = folder();
    let (dump, trace) = trace(folder.path(), kind, &settings(), 300);
    // Saved for the VCD: the FST opens under it all the same.
    let path = folder.path().join("waves.gtkw");
    save(&View::everything(), &trace, "waves.vcd", &trace.ticks, &path).unwrap();
    let (shown, expected) = (shown(&dump, &path, CLOCK * 40), expected());
    assert_eq!(shown.len(), expected.len(), "{kind:?}: {shown:?}");
    for (shown, expected) in shown.iter().zip(&expected) {
        assert!(
            shown.0 == expected.0 && same(&shown.1, &expected.1),
            "{kind:?}: {shown:?}, expected {expected:?}"
        );
    }
}

#[test]
#[cfg_attr(
    not(all(tool = "gtkwave", tool = "xvfb-run")),
    ignore = "needs gtkwave, xvfb-run: ./test fetches what is missing"
)]
fn gtkwave_shows_every_signal_of_both_formats_as_numbers() {
    check(Kind::Vcd);
    check(Kind::Fst);
}
