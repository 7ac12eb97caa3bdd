// SPDX-License-Identifier: MIT OR Apache-2.0
//! Mutations of values: each kind comes, the same for a seed, and within the size that is allowed.

use hapticore_tests::fuzz::{cross, mutate};
use toml::{Table, Value};

const SEEDS: u32 = 40_000;

const DOCUMENT: &str = "pads = 4\ngain = 0.5\nwindow = \"hann\"\nwide = \"u28.17\"\nfast = true\n\
    [map]\ncolumns = 77\nplaces = [[1, 2], [3, 4], [5, 6]]\n[force]\nk = 1e6\n";

/// A fuzzer that has seen a comparison with 4242, and otherwise puts an exclamation mark in front.
fn bytes(data: &mut [u8], size: usize, most: usize) -> usize {
    match data.len() {
        8 => data.copy_from_slice(&4242_i64.to_le_bytes()),
        _ if most > 0 => data[0] = b'!',
        _ => {}
    }
    size.min(most)
}

/// What becomes of a text with a seed, in at most `most` bytes.
fn mutated(target: &str, text: &str, seed: u32, most: usize) -> String {
    let mut data = text.as_bytes().to_vec();
    data.resize(most.max(text.len()), 0);
    let size = mutate(target, &mut data, text.len(), most, seed, bytes);
    assert!(size <= most, "{size} bytes, {most} are allowed");
    String::from_utf8(data[..size].to_vec()).expect("text")
}

fn all(target: &str, text: &str) -> Vec<String> {
    (0..SEEDS).map(|seed| mutated(target, text, seed, 4096)).collect()
}

type Kind<T> = (&'static str, fn(&T) -> bool);

/// Holds that each kind is among them.
fn hold_each<T>(made: &[T], kinds: &[Kind<T>]) {
    for (kind, is) in kinds {
        assert!(made.iter().any(is), "{kind}: none of {}", made.len());
    }
}

fn places(table: &Table) -> Option<&Vec<Value>> {
    table.get("map")?.get("places")?.as_array()
}

fn pads(table: &Table) -> Option<i64> {
    table.get("pads")?.as_integer()
}

fn gain(table: &Table) -> Option<f64> {
    table.get("gain")?.as_float()
}

#[test]
fn a_document_has_every_kind_of_change() {
    let texts = all("profile", DOCUMENT);
    let tables: Vec<Table> = texts.iter().filter_map(|text| text.parse().ok()).collect();
    hold_each(
        &tables,
        &[
            ("a step", |t| pads(t) == Some(5)),
            ("a multiple", |t| pads(t) == Some(8)),
            ("a small number", |t| pads(t) == Some(11)),
            ("beside a power of two", |t| pads(t) == Some(-33)),
            ("a limit", |t| pads(t) == Some(i64::MAX)),
            ("another number of the document", |t| pads(t) == Some(77)),
            ("a number that was compared with", |t| pads(t) == Some(4242)),
            ("a neighbour", |t| gain(t) == Some(0.5_f64.next_up())),
            ("no number", |t| gain(t).is_some_and(f64::is_nan)),
            ("infinite", |t| gain(t) == Some(f64::NEG_INFINITY)),
            ("another number with a point", |t| gain(t) == Some(1e6)),
            ("without a point", |t| t.get("gain").is_some_and(Value::is_integer)),
            ("a boolean", |t| t.get("fast") == Some(&Value::Boolean(false))),
            ("a word", |t| t.get("window").and_then(Value::as_str) == Some("rectangular")),
            ("another string", |t| t.get("window").and_then(Value::as_str) == Some("u28.17")),
            ("a number in a string", |t| t.get("wide").and_then(Value::as_str) == Some("u28.18")),
            ("removed", |t| pads(t).is_none() && t.len() == 6),
            ("renamed", |t| pads(t).is_none() && t.get("k") == Some(&Value::Integer(4))),
            ("copied", |t| t.get("force").is_some_and(|force| force.get("places").is_some())),
            ("restored", |t| t.get("haptic").is_some_and(Value::is_table)),
            ("longer", |t| places(t).is_some_and(|places| places.len() == 4)),
            ("shorter", |t| places(t).is_some_and(|places| places.len() == 2)),
            ("columns for rows", |t| {
                let columns = [[1, 3, 5], [2, 4, 6]].map(|column| Value::from(column.to_vec()));
                places(t).is_some_and(|places| *places == columns)
            }),
        ],
    );
    hold_each(
        &texts,
        &[
            ("a key twice", |text| text.matches("pads = 4\n").count() == 2),
            ("the fuzzer's own", |text| text.starts_with('!')),
        ],
    );
}

#[test]
fn a_table_has_every_kind_of_change() {
    let made = all("csv", "0a,b,c\n1,-2,0.5\n7,8,9\n");
    hold_each(
        &made,
        &[
            ("a number", |text| text.contains("\n1,-2,1.5\n")),
            ("the most negative code", |text| text.contains("-131072")),
            ("another cell", |text| text.contains("\n1,9,0.5\n")),
            ("a row twice", |text| text.matches("7,8,9").count() == 2),
            ("a row less", |text| text == "0a,b,c\n7,8,9\n"),
            ("rows exchanged", |text| text == "0a,b,c\n7,8,9\n1,-2,0.5\n"),
            ("columns exchanged", |text| text == "0c,b,a\n0.5,-2,1\n9,8,7\n"),
            ("a column less", |text| text == "0a,c\n1,0.5\n7,9\n"),
            ("a word", |text| text.contains("polyphase")),
        ],
    );
}

#[test]
fn each_file_of_a_lab_is_changed() {
    let made = all("lab", "pads = 1\n\0x,y\n1,2\n\0load\n3\n");
    hold_each(
        &made,
        &[
            ("the setup", |text| text == "pads = 2\n\0x,y\n1,2\n\0load\n3\n"),
            ("the places", |text| text == "pads = 1\n\0x,y\n1,3\n\0load\n3\n"),
            ("the loads", |text| text == "pads = 1\n\0x,y\n1,2\n\0load\n4\n"),
        ],
    );
}

#[test]
fn a_seed_gives_the_same_within_the_size() {
    for seed in 0..2000 {
        let most = DOCUMENT.len() - 40 + seed as usize % 80;
        let [first, second] = [0; 2].map(|_| mutated("profile", DOCUMENT, seed, most));
        assert_eq!(first, second);
    }
    assert_eq!(mutated("profile", "no document = ", 3, 20), "!o document = ");
    assert_eq!(mutated("csv", "", 3, 20), "");
}

#[test]
fn two_inputs_give_one_of_values_of_both() {
    let crossed = |target, first: &str, second: &str, most, seed| {
        let mut out = vec![0; most];
        let size = cross(target, first.as_bytes(), second.as_bytes(), &mut out, seed);
        String::from_utf8(out[..size].to_vec()).expect("text")
    };
    let every = |target, first, second, expected: &[&str]| {
        let made: Vec<_> = (0..2000).map(|seed| crossed(target, first, second, 40, seed)).collect();
        for text in expected {
            assert!(made.iter().any(|made| made == text), "{target}: {text:?} is none of them");
        }
    };
    let (first, second) = ("a = 1\n\n[b]\nc = 2\n", "a = 3\nd = 4\n\n[b]\nc = 5\n");
    let both = ["a = 3\n\n[b]\nc = 2\n", "a = 1\n\n[b]\nc = 5\n", "a = 1\nd = 4\n\n[b]\nc = 2\n"];
    every("scene", first, second, &both);
    every("scene", "a = [{b = 1}]", "a = [{b = 2}]", &["[[a]]\nb = 2\n"]);
    every("csv", "0a\n1\n2\n", "0b\n3\n", &["0a\n3\n2\n", "0b\n1\n2\n"]);
    every("lab", "a = 1\n\0x\n1\n", "a = 2\n\0x\n3\n", &["a = 2\n\0x\n1\n", "a = 1\n\0x\n3\n"]);
    every("plan", "no = ", "text", &["no = text", "no t"]);
    assert_eq!(crossed("plan", "no = ", "text", 3, 1).len(), 3);
}
