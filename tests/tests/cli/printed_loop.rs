// SPDX-License-Identifier: MIT OR Apache-2.0
//! A printed force loop, fed as rtl/verilog/README.md says, gives the drive words that `simulate` gave: `simulate`, `hdl`, `codes` and
//! an Icarus bench, with files in between and nothing else.

use std::fs;
use std::path::Path;
use std::process::Command;

use hapticore_contract::profile::Profile;
use hapticore_tests::tools;
use serde_json::Value;
use wellen::simple::Waveform;

use crate::{Table, expect, finish, refuse};

const CASE: &str = "sine 0.3 N, closed loop";

/// The drive's full scale, V: the scene's default (docs/formats.md).
const FULL_SCALE_V: f64 = 500.0;

/// Runs a case of fig9 for so long, with its samples as CSV.
fn simulate(folder: &Path, seconds: &str) {
    let set = format!("duration_s={seconds}");
    let args = ["simulate", "fig9", "--case", CASE, "--set", &set, "--capture", "samples.csv"];
    finish(folder, &[&args[..], &["--waves", "vcd", "--out", "run"]].concat());
}

/// Prints the loop and what feeds it; the top module.
fn print(folder: &Path) -> String {
    let args = ["hdl", "--profile", "run/profile.toml", "--out", "verilog", "--json"];
    let told: Value = serde_json::from_slice(&expect(folder, &args, 0).stdout).expect("JSON");
    let args = ["codes", "--profile", "run/profile.toml", "--tuning", "run/tuning.toml"];
    let calibration = ["--calibration", "samples.csv.calibration.toml", "--out", "codes.csv"];
    expect(folder, &[&args[..], &calibration].concat(), 0);
    told["top"].as_str().expect("a module").to_owned()
}

/// Of each slot a tick, since slots are a millisecond long, and the target, written before its window as `simulate` does.
fn write_events(folder: &Path, profile: &Profile, frames: &Table) {
    let word = profile.control.as_ref().expect("a controller").target;
    let mut events = String::from("sample,name,address,code\n0,enable,,1\n");
    let [samples, blanking] =
        [profile.slot.samples(), profile.slot.blanking()].map(|count| count as usize);
    let rows = frames.numbers("pad").into_iter().zip(frames.numbers("target_n"));
    for (slot, (pad, target_n)) in rows.enumerate() {
        let code = word.code(target_n).unwrap_or(word.code_saturating(target_n));
        let sample = slot * samples + blanking;
        events += &format!("{sample},tick,,1\n{sample},target_word,{pad},{code}\n");
    }
    fs::write(folder.join("events.csv"), events).expect("written");
}

/// Zeros in the samples of each slot's blanking, which the waves of a run have there: no result depends on them.
fn silence_blanking(folder: &Path, profile: &Profile) {
    let path = folder.join("samples.csv");
    let text = fs::read_to_string(&path).expect("samples");
    let is_code = |line: &str| line.starts_with(|c: char| c == '-' || c.is_ascii_digit());
    let head = text.lines().take_while(|line| !is_code(line)).map(str::to_owned);
    let silence = vec!["0"; profile.channels()].join(",");
    let rows = text.lines().filter(|line| is_code(line)).enumerate().map(|(row, line)| {
        let blanked = row as u64 % profile.slot.samples() < profile.slot.blanking();
        if blanked { silence.clone() } else { line.to_owned() }
    });
    fs::write(path, head.chain(rows).collect::<Vec<_>>().join("\n") + "\n").expect("written");
}

/// Runs the bench of `rtl/verilog` in the folder; the drive words that it got.
fn run_bench(folder: &Path, top: &str) -> Table {
    let bench = Path::new(env!("CARGO_MANIFEST_DIR")).join("../rtl/verilog/cocotb/loop_bench.v");
    let printed = fs::read_dir(folder.join("verilog")).expect("printed").flatten();
    let modules = printed.map(|file| file.path());
    let modules = modules.filter(|path| path.extension().is_some_and(|of| of == "v"));
    let mut compile = Command::new("iverilog");
    compile.args(["-g2005", "-I", "verilog", "-s", "bench", "-o", "bench"]);
    compile.arg(format!("-DLOOP={top}")).args(modules).arg(bench);
    tools::run(&mut compile, folder);
    let log = tools::run(Command::new("vvp").args(["-n", "bench", "+waves"]), folder);
    assert!(log.contains("PASSED"), "{log}");
    Table::read(&folder.join("got.csv"))
}

#[test]
#[cfg_attr(
    not(all(tool = "iverilog", tool = "vvp")),
    ignore = "needs iverilog, vvp: ./test fetches what is missing"
)]
fn the_printed_loop_gives_the_drive_words_of_fig9() {
    let folder = tempfile::tempdir().expect("a folder");
    // A slot is a millisecond; the whole case takes Icarus minutes.
    simulate(folder.path(), if std::env::var("FIG9").is_ok() { "0.5" } else { "0.01" });
    let top = print(folder.path());
    let text = fs::read_to_string(folder.path().join("run/profile.toml")).expect("a profile");
    let profile = Profile::parse(&text).expect("a profile");
    let frames = Table::read(&folder.path().join("run/frames.csv"));
    write_events(folder.path(), &profile, &frames);
    silence_blanking(folder.path(), &profile);
    let got = run_bench(folder.path(), &top);
    let format = profile.control.as_ref().expect("a controller").drive;
    let word = |volts: &f64| format.code(volts / FULL_SCALE_V).expect("a drive word") as f64;
    let expected: Vec<f64> = frames.numbers("drive_v_rms").iter().map(word).collect();
    assert_eq!(got.numbers("drive"), expected);
    assert!(expected.iter().filter(|&&word| word > 0.0).count() > expected.len() / 2, "it drives");
    let either = |a: &str, b: &str| -> Vec<bool> {
        let both = got.numbers(a).into_iter().zip(got.numbers(b));
        both.map(|(a, b)| a + b > 0.0).collect()
    };
    let limited: Vec<bool> = frames.numbers("drive_limited").iter().map(|&bit| bit > 0.0).collect();
    assert_eq!(either("low", "high"), limited);
    the_dump_has_the_signals_of_the_waves(folder.path());
}

/// Every signal of the run's waves is in the dump of the printed loop under its path and takes the same values one after the
/// other.
fn the_dump_has_the_signals_of_the_waves(folder: &Path) {
    let [mut run, mut dump] = ["run/waves.vcd", "waves.vcd"]
        .map(|name| wellen::simple::read(folder.join(name)).expect("waves that others read"));
    let hierarchy = run.hierarchy();
    let paths: Vec<String> =
        hierarchy.all_vars().map(|var| hierarchy[var].full_name(hierarchy)).collect();
    let (mut moving, mut others) = (0, Vec::new());
    for path in paths.iter().filter(|path| !path.starts_with("truth.")) {
        let [of_run, of_dump] = [&mut run, &mut dump].map(|waves| values(waves, path));
        moving += usize::from(of_run.len() > 1);
        // What a register holds before its first operand is the simulator's: some are not reset.
        let of_run = &of_run[usize::from(of_run.len() > 1)..];
        let follows = of_dump.windows(of_run.len()).any(|values| values == of_run);
        if !follows {
            others.push(path);
        }
    }
    assert_eq!(others, [""; 0], "other values");
    assert!(paths.len() > 200 && moving > 100, "{}, {moving}", paths.len());
}

/// The values of a signal one after the other.
fn values(waves: &mut Waveform, path: &str) -> Vec<String> {
    let names: Vec<_> = path.split('.').collect();
    let (name, scopes) = names.split_last().expect("a path");
    let hierarchy = waves.hierarchy();
    let var = hierarchy.lookup_var(scopes, name).unwrap_or_else(|| panic!("no signal {path}"));
    let signal = hierarchy[var].signal_ref();
    waves.load_signals(&[signal]);
    let signal = waves.get_signal(signal).expect("loaded");
    signal.iter_changes().map(|(_, value)| value.to_bit_string().expect("bits")).collect()
}

#[test]
fn codes_of_a_loop_have_every_word_of_its_controller() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../rtl/verilog/loop.toml");
    let profile = path.to_str().expect("a path");
    let output = expect(folder.path(), &["codes", "--profile", profile, "--out", "codes.csv"], 0);
    let log = String::from_utf8_lossy(&output.stderr);
    assert!(log.contains("--tuning") && log.contains("drive nothing"), "{log}");
    let text = fs::read_to_string(folder.path().join("codes.csv")).expect("codes");
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    let of = |name: &str| rows.iter().filter(|row| row[0] == name).count();
    for name in ["full_drive", "proportional", "correction", "rail", "slew", "force_cap"] {
        assert_eq!(of(name), 1, "{name}");
    }
    for name in ["wall_stiffness", "wall_most", "wall_factory", "wall_right"] {
        assert_eq!(of(name), 1, "{name}");
    }
    assert_eq!(["curve_word", "target_word", "wall_surface"].map(of), [65, 4, 4]);
    let rail = rows.iter().find(|row| row[0] == "rail").expect("the rail");
    assert_eq!(rail[2], "0", "as after a reset");
    for (format, words) in
        [("c", "#define HAPTICORE_FULL_DRIVE "), ("readmemh", ": curve_word 64,")]
    {
        let args = ["codes", "--profile", profile, "--format", format];
        let text = String::from_utf8(expect(folder.path(), &args, 0).stdout).expect("text");
        assert!(text.contains(words), "{format}");
    }
}

#[test]
fn a_tuning_that_is_none_of_the_profile_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    simulate(folder.path(), "0.003");
    let tuning = fs::read_to_string(folder.path().join("run/tuning.toml")).expect("a tuning");
    let args = ["codes", "--profile", "run/profile.toml", "--tuning", "tuning.toml"];
    let rail = tuning.lines().find(|line| line.starts_with("rail = ")).expect("a rail");
    for (text, words) in [
        (tuning.replace(rail, "rail = 1.5"), "rail: expected 0 to"),
        (tuning.replace(rail, "rial = 1"), "rial"),
        (tuning.replace("curve = [", "curve = [0.0, "), "curve: expected 65 numbers"),
    ] {
        fs::write(folder.path().join("tuning.toml"), text).expect("written");
        let log = expect(folder.path(), &args, 2).stderr;
        let log = String::from_utf8_lossy(&log).into_owned();
        assert!(log.contains("tuning.toml") && log.contains(words), "{log}");
    }
    fs::write(folder.path().join("tuning.toml"), &tuning).expect("written");
    let args = ["codes", "--profile", "fast", "--tuning", "tuning.toml"];
    let log = expect(folder.path(), &args, 2).stderr;
    assert!(String::from_utf8_lossy(&log).contains("expected a profile with [control]"));
    // Files of a run go with the next.
    let at = |name: &str| folder.path().join("run").join(name);
    fs::copy(at("profile.toml"), at("profile.other.toml")).expect("copied");
    fs::write(at("profile.mine.toml"), "pads = 4\n").expect("written");
    simulate(folder.path(), "0.002");
    assert!(!at("profile.other.toml").exists(), "of no run that is kept");
    assert!(at("profile.mine.toml").exists(), "the user's");
    refuse(folder.path(), &["hdl", "--profile", "run/none.toml"], &["run/none.toml"]);
}
