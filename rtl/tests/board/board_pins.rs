// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pins of the boards against what is known of these boards: a line to the outside is on a connector and nowhere else, a
//! lamp is a lamp. Source of the tables: the boards' schematics, and `amaranth-boards` (files `ulx3s.py`, `icebreaker.py`).

use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::Profile;
use hapticore_rtl::board::Target;
use hapticore_rtl::board::drive_output::serial::Frame;
use hapticore_rtl::board::drive_output::{Converter, Wave};
use std::collections::BTreeMap;

/// Both rows of the ULX3S's header, number by number: gp and gn.
const ULX3S_HEADER: [&str; 2] = [
    "B11 A10 A9 B9 A7 C8 C6 A6 A4 A2 C4 F4 G3 H4 U18 N17 N16 L16 H18 F17 D18 C18 B15 B17 C16 D14 B13 D13",
    "C11 A11 B10 C10 A8 B8 C7 B6 A5 B1 B4 E3 F3 G5 U17 P16 M17 L17 H17 G18 E17 D17 C15 C17 D16 E14 C13 E13",
];
/// Pins that the ESP32 shares, or the ADC on the board.
const ULX3S_SHARED: &str = "F4 E3 G3 F3 H4 G5 U18 U17 N17 P16 N16 M17 L16 L17";

/// The iCEBreaker's connectors 1A, 1B and 2, pins 1 to 4 and 7 to 10.
const ICEBREAKER_HEADER: [&str; 3] =
    ["4 2 47 45 3 48 46 44", "43 38 34 31 42 36 32 28", "27 25 21 19 26 23 20 18"];
/// Buttons of the break-off board, active high, at PMOD 2: pins 9, 4 and 10.
const ICEBREAKER_BUTTONS: &str = "20 19 18";

/// What else is on the board: port, site.
const ULX3S_OWN: [(&str, &str); 6] = [
    ("clock", "G2"),
    ("button", "R1"),
    ("tx", "L4"),
    ("rx", "M1"),
    ("enabled", "B2"),
    ("late", "C2"),
];
const ICEBREAKER_OWN: [(&str, &str); 6] = [
    ("clock", "35"),
    ("button", "10"),
    ("tx", "9"),
    ("rx", "6"),
    ("enabled", "37"),
    ("late", "11"),
];

/// Port and site of each pin of the constraints.
fn sites(text: &str) -> BTreeMap<String, String> {
    let words = |line: &str| -> Option<(String, String)> {
        let words: Vec<&str> =
            line.split([' ', '"', ';']).filter(|word| !word.is_empty()).collect();
        match words[..] {
            ["LOCATE", "COMP", port, "SITE", site] => Some((port.into(), site.into())),
            ["set_io", .., port, site] => Some((port.into(), site.into())),
            _ => None,
        }
    };
    text.lines().filter_map(words).collect()
}

fn is_among(sites: &str, site: &str) -> bool {
    sites.split(' ').any(|other| other == site)
}

fn check(
    text: &str,
    own: &[(&str, &str)],
    header: &[&str],
    forbidden: impl Fn(&str, &str) -> bool,
) {
    let sites = sites(text);
    assert!(sites.len() > 20, "{text}");
    for (port, site) in &sites {
        let expected = own.iter().find(|(name, _)| name == port);
        if let Some((_, expected)) = expected {
            assert_eq!(site, expected, "{port}");
            continue;
        }
        let connector = header.iter().find(|connector| is_among(connector, site));
        assert!(connector.is_some(), "{port}: {site} is on no connector");
        assert!(!forbidden(port, site), "{port}: {site} is not free");
    }
}

#[test]
fn every_line_to_the_outside_of_a_ulx3s_is_a_pin_of_its_header_that_nothing_else_drives() {
    let target = Target::Ulx3s;
    let profile = target.profile();
    let control = Some(Control::of(&profile, Law::Inverse));
    let drive = (Wave::Dc, Converter::Serial(Frame::AD5664R)).into();
    let driven = target.printed(&Profile { control, ..profile }, Some(drive)).expect("a drive");
    // Documented as shared: gp 11.
    let shared = |port: &str, site: &str| port != "dac_sdi" && is_among(ULX3S_SHARED, site);
    for text in [target.bundled().constraints.1, driven.constraints.1] {
        check(&text, &ULX3S_OWN, &ULX3S_HEADER, shared);
    }
}

#[test]
fn no_select_line_of_an_icebreaker_is_at_a_button_of_its_break_off_board() {
    let text = Target::Icebreaker.bundled().constraints.1;
    check(&text, &ICEBREAKER_OWN, &ICEBREAKER_HEADER, |_, site| is_among(ICEBREAKER_BUTTONS, site));
    assert!(text.starts_with("# SNAP THE BREAK-OFF BOARD OFF"), "{text}");
}
