// SPDX-License-Identifier: MIT OR Apache-2.0
//! What no flag tells: disturbances of a single window, and how far they put its frame off. `docs/limits.md` states it.
//!
//! `LIMITS=write cargo test -p hapticore-tests --test limits` makes the document anew.

use std::env;
use std::fmt::Write;
use std::fs;

use hapticore_model::profile::Profile;
use hapticore_run::engine::Signals;
use hapticore_run::record::Row;
use hapticore_tests::devices::{disturbed_rows, error_mm};

const DOCUMENT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/limits.md");

const HEAD: &str = "# What no flag tells

Made by `LIMITS=write cargo test -p hapticore-tests --test limits`; the test holds it fresh.

A disturbance within a single window that stays within the ADC's range looks to the lock-in like current. Its frame carries no
flag, unless its ratios are those of no place (*invalid*). The table has the worst frame without a flag, of six places on the
paper's display with a pad of 318 pF at 150 V, each terminal and ten phases of the carrier in turn. A host that must not act on
one such frame takes the median of three; neighbouring frames are not touched.

| in the middle of a window | profile | position off by, mm | capacitance, % | force, % | frames with a flag |
| --- | --- | --- | --- | --- | --- |
";

/// A disturbance of the codes of a window: its name, and what it does to a slot of channels with so many bits.
struct Disturbance {
    name: &'static str,
    disturb: fn(slot: usize, codes: &mut [i32], channels: usize, full_scale: i32),
}

const DISTURBANCES: [Disturbance; 3] = [
    Disturbance {
        name: "one sample of a terminal's current off by half of full scale",
        disturb: |slot, codes, channels, full_scale| {
            disturb(codes, channels, slot % (channels - 2), slot, full_scale / 2)
        },
    },
    Disturbance {
        name: "one sample of the sensing voltage off by half of full scale",
        disturb: |slot, codes, channels, full_scale| disturb(codes, channels, channels - 2, slot, full_scale / 2),
    },
    Disturbance {
        name: "the carrier's phase jumps by half a turn",
        disturb: |_, codes, channels, full_scale| {
            let half = codes.len() / channels / 2 * channels;
            let carried = |(index, _): &(usize, &mut i32)| index % channels != channels - 1;
            codes[half..]
                .iter_mut()
                .enumerate()
                .filter(carried)
                .for_each(|(_, code)| *code = -(*code).max(-full_scale + 1));
        },
    },
];

/// Moves a sample near the middle of the window through zero; with the slot's number its phase of the carrier changes.
fn disturb(codes: &mut [i32], channels: usize, channel: usize, slot: usize, by: i32) {
    let middle = codes.len() / channels / 2 + slot / (channels - 2) % 10;
    let code = &mut codes[middle * channels + channel];
    *code += if *code < 0 { by } else { -by };
}

/// The paper's display; at each place as many slots as there are terminals and phases.
fn scene() -> String {
    let place = |k: usize| [400.0 * (k % 3) as f64 - 400.0, 200.0 * (k / 3) as f64 - 200.0];
    let places: Vec<_> = (0..6).flat_map(|k| [place(k); 60]).collect();
    format!(
        "title = \"limits\"\n[[pad]]\nposition_mm = {{ sweep = {places:?} }}\nhaptic_v_rms = 150\n\
         [sheet]\nrung = \"analytic\"\n[carrier]\nrung = \"samples\"\n"
    )
}

/// How far rows without a flag are off at most: mm, percent of the capacitance, percent of the force.
fn worst(rows: &[Row]) -> [f64; 3] {
    let percent = |measured: f64, truth: f64| 100.0 * (measured / truth - 1.0).abs();
    let of = |row: &Row| {
        let (is, truth) = (row.measured, row.truth.expect("a plant").quantities);
        [error_mm(row), percent(is.capacitance_pf, truth.capacitance_pf), percent(is.force_n, truth.force_n)]
    };
    rows.iter()
        .filter(|row| row.flags.is_empty())
        .map(of)
        .fold([0.0; 3], |most, of| [0, 1, 2].map(|k| f64::max(most[k], of[k])))
}

fn line(disturbance: &Disturbance, profile: &Profile, rows: &[Row]) -> String {
    let [position, capacitance, force] = worst(rows);
    let told = rows.iter().filter(|row| !row.flags.is_empty()).count();
    let Disturbance { name, .. } = disturbance;
    let share = 100.0 * told as f64 / rows.len() as f64;
    format!("| {name} | `{}` | {position:.0} | {capacitance:.1} | {force:.1} | {share:.0} % |\n", profile.name)
}

#[test]
fn the_document_states_what_a_disturbed_window_does() {
    let mut text = String::from(HEAD);
    for profile in ["standard", "small"].map(|name| Profile::bundled(name).expect("bundled")) {
        let (channels, full_scale) = (profile.channels(), 1 << (profile.formats.adc.width - 1));
        let (quiet, _) = disturbed_rows(&profile, &scene(), |_, _| ());
        let [position, capacitance, force] = worst(&quiet);
        assert!(position < 1.0 && capacitance < 0.1 && force < 0.5, "undisturbed: {position} {capacitance} {force}");
        assert!(quiet.iter().all(|row| row.flags.is_empty()), "undisturbed frames have no flags");
        for disturbance in &DISTURBANCES {
            let (rows, _) = disturbed_rows(&profile, &scene(), |slot, signals| {
                let Signals::Samples { codes, blanking } = signals else { panic!("samples") };
                (disturbance.disturb)(slot, &mut codes[*blanking..], channels, full_scale);
            });
            write!(text, "{}", line(disturbance, &profile, &rows)).expect("a string takes all");
        }
    }
    if env::var("LIMITS").is_ok_and(|what| what == "write") {
        fs::write(DOCUMENT, &text).expect("docs/limits.md");
    }
    assert_eq!(fs::read_to_string(DOCUMENT).expect("docs/limits.md"), text, "docs/limits.md is not fresh");
}
