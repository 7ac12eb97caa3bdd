// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore reference`, its pages and its schema; `hapticore new`; and what is said of words that are near.

use std::fs;
use std::path::Path;

use hapticore::args::NewKind;
use hapticore::new;
use hapticore::reference::{PAGES, markdown};
use hapticore_contract::profile::Profile;
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
        Some(_) => &root["$defs"]["stimulus"],
        None => form,
    });
    let of = |kind: &str| schemas.clone().find(|form| form["type"] == kind).cloned();
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
fn a_new_file_runs_as_it_is_and_takes_no_place() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for kind in ["scene", "loop", "wall"] {
        let file = format!("{kind}.toml");
        expect(at, &["new", kind, &file], 0);
        expect(at, &["simulate", &file, "--out", kind], 0);
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
