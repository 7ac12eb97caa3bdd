// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is committed about the Verilog is about the Verilog as it is. Needs no tools.

use hapticore_contract::profile::Profile;
use hapticore_synth::loops::{Loop, LoopsReport};
use hapticore_synth::report::{BoardReport, CoresReport, limits, median};
use hapticore_synth::sources;
use hapticore_synth::target::{BOARDS, Family, TOP};
use hapticore_synth::tools::root;
use hapticore_synth::vectors;
use std::collections::BTreeSet;
use std::fs;

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

#[test]
fn the_table_of_cores_is_of_the_cores_that_are_printed() {
    let report: CoresReport =
        serde_json::from_str(&read("synth/reports/cores.json")).expect("a report");
    assert_eq!(read("synth/reports/cores.md"), report.markdown(), "synth/run cores");
    let mut rows = report.rows.iter();
    for profile in Profile::all() {
        let hash = sources::hash_of(&sources::files(&hapticore_rtl::header::design(&profile)));
        for family in Family::ALL {
            let row = rows.next().expect("a row for each profile and family");
            let (found, expected) =
                ((&row.profile, row.part.as_str()), (&profile.name, family.part()));
            assert_eq!(found, expected);
            assert_eq!(
                row.sources, hash,
                "{}: the Verilog has changed: run synth/run cores",
                profile.name
            );
        }
    }
    assert!(rows.next().is_none());
}

#[test]
fn the_table_of_loops_is_of_the_loops_that_are_printed() {
    let report: LoopsReport =
        serde_json::from_str(&read("synth/reports/loops.json")).expect("a report");
    assert_eq!(read("synth/reports/loops.md"), report.markdown(), "synth/run loops");
    let loops = Loop::all();
    assert_eq!(report.rows.len(), loops.len());
    for (row, of) in report.rows.iter().zip(&loops) {
        let name = of.name();
        assert!(of.is_of(row), "{name}: a row for each loop");
        let hash = sources::hash_of(&of.files());
        assert_eq!(row.sources, hash, "{name}: the Verilog has changed: run synth/run loops");
    }
}

#[test]
fn the_vectors_are_those_of_the_model() {
    for file in vectors::files() {
        let path = format!("rtl/verilog/vectors/{}", file.name);
        assert!(read(&path) == file.text, "{path}: the model has changed: run synth/run vectors");
    }
}

#[test]
fn the_fusesoc_core_names_every_file_of_its_profiles() {
    let core = read("rtl/verilog/hapticore.core");
    for profile in ["small", "standard"] {
        let folder = root().join("rtl/verilog").join(profile);
        let there: BTreeSet<_> = fs::read_dir(folder)
            .expect("a folder")
            .map(|entry| {
                format!("{profile}/{}", entry.expect("a file").file_name().to_string_lossy())
            })
            .collect();
        let named =
            core.lines().filter_map(|line| line.trim().strip_prefix("- ")?.split(" : ").next());
        let named: BTreeSet<_> = named
            .filter(|name| name.starts_with(&format!("{profile}/")))
            .map(String::from)
            .collect();
        assert_eq!(named, there, "rtl/verilog/hapticore.core");
    }
}

/// A board's script, for users, and the flow of its report are one.
#[test]
fn the_scripts_do_what_the_reports_say() {
    for board in BOARDS {
        let name = board.target.name();
        let script = read(&format!("synth/scripts/{}.sh", name)).replace("\\\n", "");
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        let script = words(&script);
        assert!(script.contains(&words(&board.family.synthesis(TOP))), "{}: synthesis", name);
        let (place, options) = board.family.place();
        assert!(script.contains(place) && script.contains(&options.join(" ")), "{}: {place}", name);
        let (pack, options, _) = board.family.pack();
        assert!(
            script.contains(&words(&format!("{pack} {}", options.join(" ")))),
            "{}: {pack}",
            name
        );
    }
}

#[test]
fn reports_of_boards_say_what_they_measured() {
    for board in BOARDS {
        let name = board.target.name();
        let path = format!("synth/reports/{}.json", name);
        let report: BoardReport = serde_json::from_str(&read(&path)).expect("a report");
        assert_eq!(read(&path.replace(".json", ".md")), report.markdown(), "synth/run {}", name);
        let hash = sources::hash_of(&sources::board(board.target));
        assert_eq!(
            report.sources, hash,
            "{name}: the Verilog or the pins have changed: run synth/run {name}"
        );
        assert_eq!(report.timings.len(), 5, "five seeds");
        assert_eq!(report.median_mhz, median(&report.timings));
        assert_eq!(report.limits, limits(&board, &report.used, report.median_mhz));
        assert!(report.limits.iter().all(|limit| limit.holds), "{}: {:?}", name, report.limits);
    }
}
