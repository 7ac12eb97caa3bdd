// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore sweep`: the same bytes by however many threads, calls and stops; the command reports
//! what is torn, missing, failed or different.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use serde_json::Value;
use tempfile::TempDir;

use crate::{Table, command, expect, refuse};

/// Both sides are varied.
const PLAN: &str = r#"scene = "mine.toml"
profile = "small"
slots = 2
seeds = [1, 2]

[axes.profile]
capacitance = [13, 15]
force = [11, 15]
carrier.window = ["hann"]

[axes.scene]
sheet.rung = ["bilinear", "bicubic"]
"#;

const SCENE: &str = "title = \"t\"\n[[pad]]\nposition_mm = [90, 40]\nhaptic_v_rms = 150\n\
                     [sheet]\n[carrier]\nrung = \"samples\"\n[sensor]\nnoise_ppm_rms = 18\n";

const FILES: [&str; 3] = ["results.csv", "results.json", "results.parquet"];

fn folder(plan: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("mine.toml"), SCENE).unwrap();
    fs::write(folder.path().join("plan.toml"), plan).unwrap();
    folder
}

/// Runs the plan into a store of this name; what is collected of it.
fn swept(folder: &Path, store: &str, more: &[&str]) -> [Vec<u8>; 3] {
    let args = ["sweep", "plan.toml", "--store", store, "--out", "results"];
    expect(folder, &[&args[..], more].concat(), 0);
    FILES.map(|name| fs::read(folder.join("results").join(name)).unwrap())
}

fn collect(folder: &Path, store: &str, code: i32) -> (String, String) {
    let args = ["sweep", "collect", "plan.toml", "--store", store, "--out", "results"];
    let output = expect(folder, &args, code);
    [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap()).into()
}

fn parts(store: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(store.join("parts")).unwrap();
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

#[test]
fn threads_lines_and_stops_leave_the_same_bytes() {
    let folder = folder(PLAN);
    let folder = folder.path();
    let first = swept(folder, "one", &["--threads", "1"]);
    assert!(first == swept(folder, "two", &["--threads", "2"]), "by two threads");
    let table = Table::read(&folder.join("results/results.csv"));
    assert_eq!(table.rows.len(), 16);
    assert!(table.column("error").iter().all(|error| error.is_empty()));
    let keys = table.column("key");
    assert!(keys.is_sorted() && keys.iter().all(|key| key.len() == 64));
    // By single lines, each from another program, some twice.
    let args = ["sweep", "plan.toml", "--store", "lines", "--list"];
    let listed = String::from_utf8(expect(folder, &args, 0).stdout).unwrap();
    let chunk: Value = serde_json::from_str(listed.lines().next().unwrap()).unwrap();
    for n in [3, 0, 3, 1, 2] {
        let mut chunk = chunk.clone();
        (chunk["first"], chunk["count"]) = ((4 * n).into(), 4.into());
        expect(folder, &["sweep", "run", "--store", "lines", &chunk.to_string()], 0);
    }
    collect(folder, "lines", 0);
    for (name, first) in FILES.iter().zip(&first) {
        assert!(fs::read(folder.join("results").join(name)).unwrap() == *first, "{name} by lines");
    }
    // What is there is not run again.
    let before = parts(&folder.join("lines"));
    assert!(first == swept(folder, "lines", &[]));
    assert_eq!(parts(&folder.join("lines")), before);
}

/// What is a number in one is the same double in the other, which a reader of its own finds there.
#[test]
fn the_parquet_file_has_the_rows_of_the_table() {
    let folder = folder(PLAN);
    swept(folder.path(), "store", &[]);
    let table = Table::read(&folder.path().join("results/results.csv"));
    let file = fs::File::open(folder.path().join("results/results.parquet")).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let rows: Vec<_> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
    assert_eq!(rows.len(), table.rows.len());
    let text = |cell: &Field| match cell {
        Field::Null => String::new(),
        Field::Str(text) => text.clone(),
        other => panic!("expected a text, got {other:?}"),
    };
    for (name, cells) in rows[0].get_column_iter().map(|(name, _)| (name, table.column(name))) {
        let of = rows.iter().map(|row| row.get_column_iter().find(|of| of.0 == name).unwrap().1);
        for (cell, read) in cells.iter().zip(of) {
            match read {
                Field::Double(number) => assert_eq!(cell.parse(), Ok(*number), "{name}"),
                Field::Long(number) => assert_eq!(*cell, number.to_string(), "{name}"),
                other => assert_eq!(*cell, text(other), "{name}"),
            }
        }
    }
    let numbers = rows[0].get_column_iter().filter(|of| matches!(of.1, Field::Double(_))).count();
    assert!(numbers > 20, "{numbers} columns of numbers");
}

#[test]
fn both_sides_show_in_errors_and_costs() {
    let folder = folder(PLAN);
    swept(folder.path(), "store", &[]);
    let table = Table::read(&folder.path().join("results/results.csv"));
    let mean = |column: &str, key: &str, value: &str| {
        let (of, numbers) = (table.column(key), table.numbers(column));
        let own: Vec<_> = (0..of.len()).filter(|n| of[*n] == value).map(|n| numbers[n]).collect();
        own.iter().sum::<f64>() / own.len() as f64
    };
    let force = |column: &str| ["11", "15"].map(|bits| mean(column, "profile.force", bits));
    let [short, long] = force("measured_force_rms");
    assert!(short > 4.0 * long, "four bits: {short} mN, {long} mN");
    let [short, long] = force("flip_flops");
    assert!(short < long, "{short} {long}");
    let level = |level: &str| mean("plant_percent", "scene.sheet.rung", level);
    assert!(level("bilinear") > 10.0 * level("bicubic"));
    let truth = table.numbers("truth_position_rms");
    assert!(truth.iter().all(|um| *um < 500.0), "{truth:?}");
    assert!(!table.column("front").iter().all(|front| front.is_empty()));
    let times = Table::read(&folder.path().join("results/times.csv"));
    assert!(times.numbers("core_s_per_s").iter().all(|seconds| *seconds > 0.0));
    let page = fs::read_to_string(folder.path().join("results/report.html")).unwrap();
    for title in ["Error of the force over area", "Levels of the simulated device", "Pareto front"]
    {
        assert!(page.contains(title), "{title}");
    }
}

/// A plan whose points take long enough that some chunks are done when the program is killed.
#[test]
#[cfg(unix)]
fn a_killed_sweep_goes_on_where_it_was() {
    let plan = PLAN.replace("[13, 15]", "{ from = 10, to = 16, step = 1 }");
    let folder = folder(&plan.replace("slots = 2", "slots = 200"));
    let scene = SCENE.replace("title", "dwell_slots = 200\ntitle");
    fs::write(folder.path().join("mine.toml"), scene).unwrap();
    let args = ["sweep", "plan.toml", "--store", "killed", "--threads", "2"];
    let mut run = command(folder.path(), &args).stdout(Stdio::null()).spawn().unwrap();
    let (start, store) = (Instant::now(), folder.path().join("killed"));
    while parts_or_none(&store) < 2 && start.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(5));
    }
    run.kill().unwrap();
    run.wait().unwrap();
    let kept = parts(&store);
    let (text, _) = collect(folder.path(), "killed", 1);
    assert!(text.contains(" missing:"), "{text}");
    let resumed = swept(folder.path(), "killed", &[]);
    assert!(kept.iter().all(|part| part.exists()), "what was run is kept");
    assert!(resumed == swept(folder.path(), "whole", &[]));
}

/// Two programs on one store: each point is run by one of them, whichever comes first.
#[test]
fn two_runners_share_the_work_of_a_store() {
    let plan = PLAN.replace("[13, 15]", "{ from = 10, to = 16, step = 1 }");
    let folder = folder(&plan.replace("slots = 2", "slots = 50"));
    let scene = SCENE.replace("title", "dwell_slots = 50\ntitle");
    fs::write(folder.path().join("mine.toml"), scene).unwrap();
    let start = |out: &str| {
        let args = ["sweep", "plan.toml", "--store", "store", "--threads", "2", "--out", out];
        command(folder.path(), &args).stdout(Stdio::null()).spawn().unwrap()
    };
    for mut runner in ["one", "two"].map(start) {
        assert!(runner.wait().unwrap().success());
    }
    let lines = |part: PathBuf| fs::read_to_string(part).unwrap().lines().count();
    let parts = parts(&folder.path().join("store"));
    assert_eq!(parts.into_iter().map(lines).sum::<usize>(), 56, "each point once");
    let claims = fs::read_dir(folder.path().join("store/claims")).unwrap();
    assert_eq!(claims.count(), 0, "nothing is claimed any more");
    let of = |out: &str| FILES.map(|name| fs::read(folder.path().join(out).join(name)).unwrap());
    assert!(of("one") == of("two"));
}

/// A plan finds its scene and profile beside it, from whatever folder it is run.
#[test]
fn paths_of_a_plan_are_relative_to_its_folder() {
    let folder = folder(PLAN);
    let whole = swept(folder.path(), "store", &[]);
    let elsewhere = folder.path().join("elsewhere");
    fs::create_dir(&elsewhere).unwrap();
    let args = ["sweep", "../plan.toml", "--store", "../store", "--out", "results"];
    expect(&elsewhere, &args, 0);
    let found = FILES.map(|name| fs::read(elsewhere.join("results").join(name)).unwrap());
    assert!(found == whole, "the same plan");
}

fn parts_or_none(store: &Path) -> usize {
    let entries = fs::read_dir(store.join("parts")).into_iter().flatten().flatten();
    entries.filter(|entry| entry.path().extension().is_some_and(|of| of == "jsonl")).count()
}

/// Lines of a part, each with the check sum of what stands in it.
fn summed(text: &str) -> String {
    let line = |line: &str| {
        let (_, rest) = line.split_once("\",").expect("a check sum");
        let object = format!("{{{rest}");
        let check = &blake3::hash(object.as_bytes()).to_hex()[..16];
        format!("{{\"check\":\"{check}\",{rest}\n")
    };
    text.lines().map(line).collect()
}

#[test]
fn torn_doubled_and_strange_lines_are_told_and_mended() {
    let folder = folder(PLAN);
    let store = folder.path().join("store");
    let whole = swept(folder.path(), "store", &["--threads", "1"]);
    let first: Vec<_> =
        parts(&store).into_iter().map(|part| (fs::read_to_string(&part).unwrap(), part)).collect();
    let (text, part) = first[0].clone();
    let line = text.lines().next().unwrap();
    // The same line twice, also in another part, is one point.
    fs::write(&part, format!("{line}\n{text}")).unwrap();
    fs::write(store.join("parts/copy.jsonl"), &text).unwrap();
    assert_eq!(collect(folder.path(), "store", 0).1, "");
    fs::remove_file(store.join("parts/copy.jsonl")).unwrap();
    for (broken, words) in [
        (text[..text.len() / 2].to_string(), "the line has no end"),
        (text.trim_end().to_string(), ": the line has no end"),
        (summed(&text.replacen("\"seed\"", "\"colour\":1,\"seed\"", 1)), "unknown field `colour`"),
        (
            summed(&text.replacen("\"results\"", "\"error\":\"x\",\"results\"", 1)),
            "either results or error",
        ),
        (text.replacen("\"slots\":", "\"slots\":1", 1), "the line is damaged"),
        (text.replacen("\"check\":\"", "\"check\":\"0", 1), "begins with its check sum"),
        ("\u{0}\u{0}\n".to_string(), ":1: "),
    ] {
        fs::write(&part, &broken).unwrap();
        let (_, log) = collect(folder.path(), "store", 1);
        assert!(log.contains("parts/") && log.contains(words), "{words}: {log}");
        assert!(whole == swept(folder.path(), "store", &[]), "{words}");
        assert!(part.with_extension("jsonl.torn").exists());
        assert_eq!(collect(folder.path(), "store", 0).1, "", "{words}: mended");
        parts(&store).iter().for_each(|part| fs::remove_file(part).unwrap());
        first.iter().for_each(|(text, part)| fs::write(part, text).unwrap());
    }
    // Another result of the same point is a host that is wrong.
    let other = summed(&text.replacen("\"slots\":", "\"slots\":1", 1));
    fs::write(store.join("parts/other.jsonl"), other).unwrap();
    let args = ["sweep", "collect", "plan.toml", "--store", "store"];
    let log = String::from_utf8(expect(folder.path(), &args, 2).stderr).unwrap();
    assert!(log.contains("other.jsonl") && log.contains("expected equal results"), "{log}");
}

#[test]
fn a_host_that_differs_is_named() {
    let folder = folder(PLAN);
    let args = ["sweep", "plan.toml", "--store", "store"];
    expect(folder.path(), &args, 0);
    let hosts = fs::read_dir(folder.path().join("store/hosts")).unwrap().next().unwrap();
    let reference = hosts.unwrap().path().join("reference.json");
    let other = fs::read_to_string(&reference).unwrap();
    let host = serde_json::from_str::<Value>(&other).unwrap()["host"].as_str().unwrap().to_string();
    let other = other.replacen(&format!("\"host\":\"{host}\""), "\"host\":\"abacus\"", 1);
    fs::write(&reference, other.replacen("flagged\\\":0", "flagged\\\":1", 1)).unwrap();
    let (_, log) = collect(folder.path(), "store", 0);
    assert!(log.contains("abacus") && log.contains(&host) && log.contains("differs"), "{log}");
    for part in parts(&folder.path().join("store")) {
        fs::remove_file(part).unwrap();
    }
    let log = String::from_utf8(expect(folder.path(), &args, 2).stderr).unwrap();
    assert!(log.contains("abacus") && log.contains("\"flagged"), "{log}");
    assert_eq!(parts(&folder.path().join("store")).len(), 0, "nothing was run");
}

/// A limit on the size of files stands for a full disk: the write of a part fails half-way.
#[test]
#[cfg(unix)]
fn a_write_that_fails_is_told_and_leaves_nothing_half_written() {
    let folder = folder(PLAN);
    let args = ["sweep", "plan.toml", "--store", "store", "--list"];
    let listed = String::from_utf8(expect(folder.path(), &args, 0).stdout).unwrap();
    let store = folder.path().join("store");
    parts(&store).iter().for_each(|part| fs::remove_file(part).unwrap());
    let mut chunk: Value = serde_json::from_str(listed.lines().next().unwrap()).unwrap();
    (chunk["first"], chunk["count"]) = (0.into(), 16.into());
    let program = env!("CARGO_BIN_EXE_hapticore-command");
    let script =
        format!("trap '' XFSZ; ulimit -f 8; exec '{program}' sweep run --store store '{chunk}'");
    let output = Command::new("bash").args(["-c", &script]).current_dir(folder.path()).output();
    let output = output.expect("bash runs");
    let log = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{log}");
    assert!(log.contains("store/parts/") && log.contains("too large"), "{log}");
    assert_eq!(log.lines().count(), 1, "{log}");
    assert!(parts(&store).is_empty(), "nothing half-written: {:?}", parts(&store));
    let mended = swept(folder.path(), "store", &[]);
    assert!(mended == swept(folder.path(), "other", &[]));
}

#[test]
fn two_collectors_at_once_write_the_same() {
    let folder = folder(PLAN);
    let whole = swept(folder.path(), "store", &[]);
    let args = ["sweep", "collect", "plan.toml", "--store", "store", "--out", "results"];
    let start = || command(folder.path(), &args).stdout(Stdio::null()).spawn().unwrap();
    let both = [start(), start()];
    for mut collector in both {
        assert!(collector.wait().unwrap().success());
    }
    for (name, whole) in FILES.iter().zip(&whole) {
        assert!(fs::read(folder.path().join("results").join(name)).unwrap() == *whole, "{name}");
    }
}

#[test]
fn random_points_are_drawn_by_point_and_key_alone() {
    let plan = "scene = \"mine.toml\"\nprofile = \"small\"\nslots = 1\n[random]\ncount = 6\nseed = 5\n\
                [random.profile]\nforce = { from = 10, to = 15 }\nratio = { from = 12, to = 18 }\n\
                [random.scene]\nsheet.ohm_per_square = { from = 100.0, to = 200.0 }\n";
    let folder = folder(plan);
    swept(folder.path(), "store", &[]);
    let few = Table::read(&folder.path().join("results/results.csv"));
    let drawn = few.numbers("scene.sheet.ohm_per_square");
    assert!(drawn.iter().all(|ohm| (100.0..200.0).contains(ohm)) && drawn[0] != drawn[1]);
    fs::write(folder.path().join("plan.toml"), plan.replace("count = 6", "count = 8")).unwrap();
    swept(folder.path(), "store", &[]);
    let more = Table::read(&folder.path().join("results/results.csv"));
    let keys = more.column("key");
    assert!(few.column("key").iter().all(|key| keys.contains(key)), "the first six are there");
    assert_eq!(keys.len(), 8);
}

/// A word that no core can have does not stop the others.
#[test]
fn points_that_cannot_be_run_are_listed() {
    let folder = folder(&PLAN.replace("capacitance = [13, 15]", "adc = [12, 16]"));
    swept(folder.path(), "store", &[]);
    let (text, _) = collect(folder.path(), "store", 0);
    assert!(text.contains("8 cannot be run:") && text.contains("adc=12"), "{text}");
    let table = Table::read(&folder.path().join("results/results.csv"));
    let told = table.column("error").iter().filter(|error| !error.is_empty()).count();
    assert_eq!(told, 8);
}

#[test]
fn plans_that_are_none_are_one_line_with_file_line_and_what_was_expected() {
    let folder = folder(PLAN);
    for (from, to, words) in [
        ("slots = 2", "slot = 2", "plan.toml:3: unknown field `slot`"),
        ("slots = 2", "slots = 0", "plan.toml:3: slots: expected 1 to 1000000, got 0"),
        ("small", "huge", "plan.toml:2: profile: expected a file or a profile among"),
        (
            "seeds = [1, 2]",
            "seeds = [1, 1]",
            "plan.toml:4: seeds: expected whole numbers, each once",
        ),
        (
            "capacitance =",
            "capacities =",
            "plan.toml:7: profile.capacities: expected a knob among adc,",
        ),
        (
            "[13, 15]",
            "16",
            "plan.toml:7: profile.capacitance: expected a list or { from, to, step }",
        ),
        (
            "[13, 15]",
            "{ from = 1, to = 2 }",
            "plan.toml:7: profile.capacitance: expected a list or",
        ),
        ("\"hann\"", "\"hahn\"", "plan.toml:9: profile.carrier.window: unknown variant `hahn`"),
        (
            "\"bicubic\"",
            "\"cubic\"",
            "plan.toml:12: scene.sheet.rung: expected one of \"distance\"",
        ),
        ("sheet.rung", "sheets.rung", "plan.toml:12: scene.sheets.rung: "),
        (
            "sheet.rung = [\"bilinear\", \"bicubic\"]",
            "seed = [1]",
            "plan.toml:12: scene.seed: expected seeds",
        ),
        (
            "[axes.scene]",
            "[random]\ncount = 1\n[axes.scene]",
            "plan.toml:11: random: expected either",
        ),
        ("mine.toml", "none.toml", "plan.toml:1: scene: none.toml"),
    ] {
        fs::write(folder.path().join("plan.toml"), PLAN.replacen(from, to, 1)).unwrap();
        refuse(folder.path(), &["sweep", "plan.toml", "--store", "store"], &[words]);
    }
    let run = |line: &str| expect(folder.path(), &["sweep", "run", "--store", "s", line], 2).stderr;
    let log = String::from_utf8(run("{\"first\":0}")).unwrap();
    assert!(log.contains("expected a line of `sweep --list`"), "{log}");
    let log = String::from_utf8(run("{\"plan\":\"00\",\"first\":0,\"count\":1}")).unwrap();
    assert!(log.contains("s/plans/00.json"), "{log}");
}

/// Slots of a force loop depend on the core: each point closes it.
#[test]
fn a_force_loop_is_swept() {
    const LOOP: &str = "scene = \"mine.toml\"\nprofile = \"standard\"\nslots = 2\nseeds = [1, 2]\n\
                        [axes.profile]\ndrive = [11, 17]\n\
                        [axes.scene]\ncontrol.law = [\"inverse\", \"integral\"]\n";
    let folder = folder(LOOP);
    let scene = format!("{SCENE}haptic_full_scale_v = 550\n[gap]\n[control]\n[friction]\n");
    let scene = scene
        .replace("title = \"t\"", "title = \"t\"\nduration_s = 0.1")
        .replace("haptic_v_rms = 150", "target_n = 0.2");
    fs::write(folder.path().join("mine.toml"), scene).unwrap();
    let first = swept(folder.path(), "one", &["--threads", "1"]);
    assert!(first == swept(folder.path(), "two", &["--threads", "2"]), "by two threads");
    let table = Table::read(&folder.path().join("results/results.csv"));
    assert!(
        table.column("error").iter().all(|cell| cell.is_empty()),
        "{:?}",
        table.column("error")
    );
    assert_eq!(table.numbers("slots"), [40.0; 8]);
    let drive = table.numbers("measured_drive_rms");
    let bits = table.numbers("profile.drive");
    let of = |bits_of: f64| {
        drive.iter().zip(&bits).filter(move |(_, bits)| **bits == bits_of).map(|(rms, _)| *rms)
    };
    let (short, long) = (of(11.0).fold(f64::MAX, f64::min), of(17.0).fold(0.0, f64::max));
    assert!(short > 2.0 * long && long > 0.0, "{short} V, {long} V");
    assert!(table.numbers("truth_loop_force_rms").iter().all(|rms| *rms > 0.0));
    assert!(
        table.column("measured_direction_rms").iter().all(|cell| cell.is_empty()),
        "whole pads"
    );
}

#[test]
#[cfg_attr(not(tool = "parallel"), ignore = "needs parallel: ./test fetches what is missing")]
fn engines_are_given_commands_that_run() {
    let folder = folder(PLAN);
    let whole = swept(folder.path(), "whole", &[]);
    let submit = |engine: &str, more: &[&str]| {
        let args = ["sweep", "submit", "plan.toml", "--store", "store", "--engine", engine];
        let args = [&args[..], more].concat();
        String::from_utf8(expect(folder.path(), &args, 0).stdout).unwrap()
    };
    for (engine, word) in
        [("hq", "HQ_ENTRY"), ("slurm", "SLURM_ARRAY_TASK_ID"), ("snakemake", "rule chunk")]
    {
        let text = submit(engine, &["--dry-run"]);
        assert!(text.contains(word), "{engine}: {text}");
    }
    assert!(!folder.path().join("store").exists(), "--dry-run writes nothing");
    submit("parallel", &[]);
    for (name, whole) in FILES.iter().zip(&whole) {
        assert!(fs::read(folder.path().join("results").join(name)).unwrap() == *whole, "{name}");
    }
}
