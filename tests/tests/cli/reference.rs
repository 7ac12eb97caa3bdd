// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore reference`, its pages and its schema; `hapticore new`; and what is said of words that are near.

use std::fs;
use std::path::Path;

use hapticore::args::NewKind;
use hapticore::new;
use hapticore::reference::{PAGES, markdown};
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_run::lab::setup::{Setup, parsed};
use hapticore_scene::gallery;
use serde_json::Value;

use crate::{expect, refuse};

fn json(args: &[&str]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    serde_json::from_slice(&expect(folder.path(), args, 0).stdout).unwrap()
}

#[test]
fn reference_pages_are_fresh() {
    let pages = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/guide/reference");
    for (name, ..) in PAGES {
        let page = fs::read_to_string(pages.join(format!("{name}.md"))).unwrap_or_default();
        let fresh = page == markdown(name).unwrap();
        assert!(
            fresh,
            "docs/guide/reference/{name}.md: hapticore reference {name} --markdown prints it anew"
        );
    }
}

#[test]
fn reference_of_a_key_says_meaning_unit_default_and_range() {
    let of_wall = json(&["reference", "wall.stiffness_n_per_mm", "--json"]);
    let row = &of_wall[0]["rows"][0];
    assert_eq!(of_wall[0]["heading"], "[wall]");
    assert_eq!([&row["unit"], &row["default"], &row["values"]], ["N/mm", "0.5", "0 to 15"]);
    assert_eq!(row["meaning"], "Force of the wall for each millimetre of depth.");
    let named = json(&["reference", "force_n", "--json"]);
    let tables: Vec<_> = named.as_array().unwrap().iter().map(|part| &part["heading"]).collect();
    assert_eq!(tables, ["[wall]", "[arena]"]);
    assert_eq!(json(&["reference", "pad.mallet.load_g", "--json"])[0]["heading"], "[[pad]]");
    let folder = tempfile::tempdir().unwrap();
    let text = expect(folder.path(), &["reference", "gap"], 0).stdout;
    assert!(String::from_utf8(text).unwrap().contains("contact_hardness_pa"));
}

/// The properties that a value of TOML has and its schema has not.
fn unknown(value: &toml::Value, schema: &Value, root: &Value, path: &str) -> Vec<String> {
    let forms = schema["anyOf"].as_array();
    let schemas: Vec<&Value> = forms.map_or(vec![schema], |forms| forms.iter().collect());
    let schemas = schemas.into_iter().map(|form| match form["$ref"].as_str() {
        Some(path) => &root["$defs"][path.rsplit('/').next().unwrap()],
        None => form,
    });
    let is = |form: &&Value, kind: &str| {
        form["type"] == kind
            || form["type"].as_array().is_some_and(|types| types.contains(&kind.into()))
    };
    let of = |kind: &str| schemas.clone().find(|form| is(form, kind)).cloned();
    match value {
        toml::Value::Table(table) => {
            let Some(form) = of("object") else { return vec![path.to_string()] };
            let inside = |(key, value): (&String, &toml::Value)| {
                let path = format!("{path}.{key}");
                match form["properties"].get(key) {
                    Some(property) => unknown(value, property, root, &path),
                    None if form["properties"].is_null() => Vec::new(),
                    None => vec![path],
                }
            };
            table.iter().flat_map(inside).collect()
        }
        toml::Value::Array(list) => match of("array") {
            Some(form) => {
                list.iter().flat_map(|item| unknown(item, &form["items"], root, path)).collect()
            }
            None => vec![path.to_string()],
        },
        _ => Vec::new(),
    }
}

#[test]
fn the_schema_knows_every_key_of_the_bundled_scenes_and_no_other() {
    let schema = json(&["reference", "--schema"]);
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    let templates = [NewKind::Scene, NewKind::Wall, NewKind::Loop].map(new::text);
    let bundled = gallery::all().iter().map(|(_, text)| text.to_string());
    for text in bundled.chain(templates) {
        let scene: toml::Table = toml::from_str(&text).unwrap();
        let unknown = unknown(&scene.into(), &schema, &schema, "");
        assert!(unknown.is_empty(), "{unknown:?}");
    }
    let typo: toml::Table =
        toml::from_str("[wall]\nforce = 1\n[[pad]]\nload_g = { line = 1 }\n").unwrap();
    assert_eq!(unknown(&typo.into(), &schema, &schema, ""), [".pad.load_g.line", ".wall.force"]);
    assert_eq!(schema["properties"]["wall"]["properties"]["force_n"]["maximum"], 100.0);
    assert_eq!(schema["properties"]["pad"]["items"]["required"][0], "position_mm");
}

#[test]
fn schemas_of_profiles_and_calibrations_know_every_key_of_written_files() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let simulate = ["simulate", "hockey", "--capture", "run.wav", "--out", "run"];
    expect(at, &simulate, 0);
    let text = |file: &str| fs::read_to_string(at.join(file)).unwrap();
    let calibrations = json(&["reference", "calibration", "--schema"]);
    let controlled = include_str!("../../../rtl/verilog/loop.toml").to_string();
    let setup = new::text(NewKind::Calibration);
    for (text, schema) in [
        (text("run/profile.toml"), json(&["reference", "profile", "--schema"])),
        (controlled, json(&["reference", "profile", "--schema"])),
        (text("run.wav.calibration.toml"), calibrations["calibration of a device"].clone()),
        (setup, calibrations["set-up for hapticore calibrate"].clone()),
    ] {
        let file: toml::Table = toml::from_str(&text).unwrap();
        assert_eq!(unknown(&file.into(), &schema, &schema, ""), Vec::<String>::new());
    }
}

/// The keys of a profile whose ranges are declared: dotted path, least, most.
fn declared_ranges(schema: &Value, root: &Value, path: &str) -> Vec<(String, f64, f64)> {
    let properties = schema["properties"].as_object().into_iter().flatten();
    let ranges = properties.flat_map(|(name, property)| {
        let path = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
        let nullable = property["anyOf"][0].is_object().then(|| &property["anyOf"][0]);
        let form = nullable.unwrap_or(property);
        match (form["$ref"].as_str(), &form["minimum"], &form["maximum"]) {
            (Some(name), ..) => {
                let name = name.rsplit('/').next().unwrap();
                declared_ranges(&root["$defs"][name], root, &path)
            }
            (None, Value::Number(least), Value::Number(most)) => {
                vec![(path, least.as_f64().unwrap(), most.as_f64().unwrap())]
            }
            _ => Vec::new(),
        }
    });
    ranges.collect()
}

/// Sets a dotted key of a profile.
fn with(profile: &toml::Table, path: &str, value: f64) -> Result<Profile, ProfileError> {
    let mut changed = profile.clone();
    let mut table = &mut changed;
    let (tables, key) = path.rsplit_once('.').unwrap_or(("", path));
    for name in tables.split('.').filter(|name| !name.is_empty()) {
        table = table.entry(name).or_insert(toml::Table::new().into()).as_table_mut().unwrap();
    }
    table.insert(key.into(), (value as i64).into());
    Profile::parse(&toml::to_string(&changed).unwrap())
}

/// Whether a value is refused for being out of its key's range, whatever else the profile then lacks.
fn is_out_of_range(profile: &toml::Table, path: &str, value: f64) -> bool {
    let error = with(profile, path, value).err().map(|error| error.to_string());
    let expected = format!("{path}: expected ");
    error.is_some_and(|error| {
        error.starts_with(&expected) && error.ends_with(&format!("got {value}"))
    })
}

/// The schema's ranges and those that a profile is checked against are written in two places.
#[test]
fn ranges_of_the_profile_reference_are_those_that_are_checked() {
    let root = json(&["reference", "profile", "--schema"]);
    let loops = include_str!("../../../rtl/verilog/loop.toml");
    let profile: toml::Table = toml::from_str(loops).unwrap();
    let ranges = declared_ranges(&root, &root, "");
    assert!(ranges.len() > 25, "{ranges:?}");
    for (path, least, most) in ranges.iter().filter(|(path, ..)| !path.starts_with("formats.")) {
        assert!(is_out_of_range(&profile, path, most + 1.0), "{path}: {} is accepted", most + 1.0);
        assert!(
            *least == 0.0 || is_out_of_range(&profile, path, least - 1.0),
            "{path}: {}",
            least - 1.0
        );
        for end in [*least, *most] {
            let error = with(&profile, path, end).err().map(|error| error.to_string());
            let refused = format!("{path}: expected {least} to {most}");
            assert!(
                error.is_none_or(|error| !error.starts_with(&refused)),
                "{path}: {end} is refused"
            );
        }
    }
}

#[test]
fn a_new_file_runs_as_it_is_and_takes_no_place() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for kind in ["scene", "loop", "wall"] {
        let file = format!("{kind}.toml");
        expect(at, &["new", kind, &file], 0);
        let log = expect(at, &["simulate", &file, "--out", kind], 0).stderr;
        let log = String::from_utf8_lossy(&log);
        assert!(!log.contains("warning"), "{file}: {log}");
        assert!(at.join(kind).join("frames.csv").is_file());
    }
    expect(at, &["new", "profile", "words.toml"], 0);
    Profile::parse(&fs::read_to_string(at.join("words.toml")).unwrap()).unwrap();
    expect(at, &["simulate", "minimal-gap", "--profile", "words.toml", "--out", "words"], 0);
    expect(at, &["new", "calibration", "device.toml"], 0);
    parsed::<Setup>(&fs::read_to_string(at.join("device.toml")).unwrap(), "device.toml").unwrap();
    let output = expect(at, &["new", "scene", "words.toml"], 2);
    assert!(String::from_utf8_lossy(&output.stderr).contains("the file exists"));
    assert!(fs::read_to_string(at.join("words.toml")).unwrap().contains("name = \"mine\""));
}

#[test]
fn words_that_are_near_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for (args, near) in [
        (&["simulate", "hocky"][..], "hockey"),
        (&["simulate", "fig6", "--profile", "standart"], "standard"),
        (&["simulate", "fig3", "--case", "rest "], "rest"),
        (&["simulate", "fig6", "--set", "sensor.quantization_bits=12"], "quantisation_bits"),
        (&["simulate", "fig6", "--set", "gap.rung=statik"], "static"),
        (&["simulate", "fig6", "--set", "sheets.rung=bicubic"], "sheet"),
        (&["simulate", "fig6", "--set", "criterion.0.measure=max_of"], "max_off"),
    ] {
        refuse(at, args, &[&format!("; did you mean \"{near}\"?")]);
    }
    let output = expect(at, &["reference", "wall.stifness_n_per_mm"], 2);
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("did you mean \"stiffness_n_per_mm\"?")
    );
}

/// Candidates for the last word of a command line.
fn completed(words: &[&str]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let last = (words.len()).to_string();
    let output = crate::command(folder.path(), &[&["--", "hapticore"], words].concat())
        .envs([("COMPLETE", "bash"), ("_CLAP_IFS", "\n"), ("_CLAP_COMPLETE_INDEX", &last)])
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(String::from).collect()
}

#[test]
fn a_shell_completes_scenes_profiles_keys_and_their_words() {
    assert_eq!(completed(&["simulate", "minimal-sh"]), ["minimal-sheet", "minimal-shunt"]);
    assert_eq!(completed(&["live", "hoc"]), ["hockey"]);
    assert_eq!(completed(&["hdl", "--profile", "f"]), ["fine", "fast"]);
    assert_eq!(
        completed(&["simulate", "fig6", "--set", "sheet.terminal_o"]),
        ["sheet.terminal_ohm="]
    );
    let rules = completed(&["simulate", "fig15", "--set", "wall.rule=s"]);
    assert_eq!(rules, ["wall.rule=sequential"]);
    assert_eq!(completed(&["simulate", "fig6", "--set", "pad.0.load"]), ["pad.0.load_g="]);
    assert_eq!(completed(&["reference", "calib"]), ["calibration"]);
    let folder = tempfile::tempdir().unwrap();
    let script = crate::command(folder.path(), &[]).env("COMPLETE", "zsh").output().unwrap();
    assert!(String::from_utf8(script.stdout).unwrap().contains("compdef"));
}

#[test]
fn each_subcommand_has_a_manual_page() {
    let folder = tempfile::tempdir().unwrap();
    expect(folder.path(), &["reference", "--man", "man/man1"], 0);
    let page = |name: &str| {
        let path = folder.path().join("man/man1").join(format!("{name}.1"));
        fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    };
    let of_all = page("hapticore");
    for command in ["simulate", "replay", "hdl", "host", "reference", "new"] {
        assert!(of_all.contains(&format!("hapticore\\-{command}(1)")), "{command}");
        let text = page(&format!("hapticore-{command}"));
        assert!(text.contains(".TH") && text.contains("Exit status"), "{command}");
    }
    assert!(page("hapticore-simulate").contains("\\-\\-waves"));
    assert!(page("hapticore-sweep-run").contains("hapticore\\-sweep\\-run"));
    let no_folder = expect(folder.path(), &["reference", "--man", "man/man1/hapticore.1"], 2);
    assert!(String::from_utf8_lossy(&no_folder.stderr).contains("hapticore.1"));
}
