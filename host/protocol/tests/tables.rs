// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tables of `docs/boards.md` are printed from the lists of this crate: flags, places of commands, words of a frame.
//!
//! A table stands between `<!-- table NAME -->` and `<!-- end -->`; `TABLES=write` prints all of them anew.

use hapticore_contract::control::{Control, Law};
use hapticore_contract::frame::Field;
use hapticore_contract::profile::Profile;
use hapticore_hdl::format::Format;
use hapticore_protocol::drive::{DriveWord, Kind, RIGHT, status};
use hapticore_protocol::framing::flags;
use hapticore_protocol::{Constant, Control as ControlBits, Register, Setting, WordFormats};
use std::path::Path;

const DOCUMENT: &str = "docs/boards.md";

fn bundled(name: &str) -> Profile {
    Profile::bundled(name).expect("bundled")
}

/// A board with a drive.
fn driven() -> Profile {
    let profile = bundled("standard");
    Profile { control: Some(Control::of(&profile, Law::Inverse)), ..profile }
}

fn table(head: &str, rows: impl IntoIterator<Item = String>) -> String {
    let columns = head.matches('|').count() - 1;
    let rule = "| --- ".repeat(columns) + "|";
    [head.to_owned(), rule].into_iter().chain(rows).map(|row| row + "\n").collect()
}

fn bits(all: &[(&str, u8, &str)]) -> String {
    let row = |(name, bit, about): &(&str, u8, &str)| {
        format!("| {bit} | `{}` | {} |", name.to_lowercase(), about.trim())
    };
    table("| bit | name | meaning |", all.iter().map(row))
}

/// Places of a board without a drive.
fn registers() -> String {
    let [small, standard] = ["small", "standard"].map(|name| WordFormats::new(&bundled(name)));
    let about = |register: Register| match register {
        Register::Constant(constant) => constant.about().to_owned(),
        Register::Control => {
            format!(
                "Bit {}: enable; bit {}: reset of the ADC.",
                ControlBits::ENABLE,
                ControlBits::ADC_RESET
            )
        }
        Register::Adc => "A register of the ADC: address and data, 16 bits.".to_owned(),
    };
    let row = |register: Register| {
        let [small, standard] = [&small, &standard].map(|formats| register.format(formats));
        let place = register.place();
        format!("| {place:04x} | `{register}` | {small} | {standard} | {} |", about(register))
    };
    let words = format!(
        "| 0000 + n | position table | {} | {} | Word n of the table: `hapticore codes` prints them. |",
        small.table, standard.table
    );
    assert_eq!(Register::ALL.len(), Constant::ALL.len() + 2, "a row for each");
    let head = "| place (hex) | register | `small` | `standard` | what |";
    table(head, [words].into_iter().chain(Register::ALL.map(row)))
}

/// Places of a board with a drive.
fn drive() -> String {
    let profile = driven();
    let format = |word: DriveWord| word.format(&profile).expect("a controller");
    let row = |place: String, name: &str, format: Format, about: &str| {
        format!("| {place} | {name} | {format} | {} |", about.trim())
    };
    let setting = |setting: Setting| {
        let word = DriveWord::Setting(setting);
        row(format!("{:04x}", word.place()), &format!("{setting:?}"), format(word), setting.about())
    };
    let numbered = |word: DriveWord, name: &str, about: &str| {
        row(format!("{:04x} + n", word.place()), name, format(word), about)
    };
    let right = DriveWord::Surface { pad: 0, right: true };
    assert_eq!(right.place() & 1 << RIGHT, 1 << RIGHT);
    assert_eq!(
        Kind::Surface.bits(),
        3,
        "four kinds of places, a row for each and one more for the right side"
    );
    let rows = [
        numbered(DriveWord::Curve(0), "curve", "Word n of the controller's curve, a drive word."),
        numbered(DriveWord::Target(0), "target", "Target force of pad n, N."),
        numbered(
            DriveWord::Surface { pad: 0, right: false },
            "surface",
            "Surface of pad n's wall, its inside left of it, mm.",
        ),
        numbered(right, "surface", "Surface of pad n's wall, its inside right of it, mm."),
    ];
    let head = "| place (hex) | word | `standard` | what |";
    table(head, Setting::ALL.map(setting).into_iter().chain(rows))
}

/// Words of a frame.
fn frame() -> String {
    let profiles = ["small", "standard"].map(bundled);
    let about = |field: Field| match field {
        Field::RatioX | Field::RatioY => "Ratio of the currents along an axis.",
        Field::X => "Position along the long edges, mm.",
        Field::Y => "Position along the short edges, mm.",
        Field::Sheet => "Resistance of the sheet, full scales of voltage per current.",
        Field::Capacitance => "Capacitance, pF.",
        Field::Force => "Haptic force, N.",
        Field::MeanSquare => {
            "Mean square of the haptic voltage over that of its channel's full scale, times the profile's `square_gain` (formats.md)."
        }
    };
    let row = |(number, field): (usize, Field)| {
        let [small, standard] = profiles.each_ref().map(|profile| field.format(profile));
        format!("| {number} | {field:?} | {small} | {standard} | {} |", about(field))
    };
    table(
        "| word | name | `small` | `standard` | what |",
        Field::ALL.into_iter().enumerate().map(row),
    )
}

#[test]
fn the_tables_of_the_boards_page_are_those_of_the_code() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(DOCUMENT);
    let mut text = std::fs::read_to_string(&path).expect("the page");
    let before = text.clone();
    for (name, table) in [
        ("flags", bits(flags::ALL)),
        ("registers", registers()),
        ("drive", drive()),
        ("status", bits(status::ALL)),
        ("frame", frame()),
    ] {
        let mark = format!("<!-- table {name} -->\n");
        let start =
            text.find(&mark).unwrap_or_else(|| panic!("{DOCUMENT}: no {mark}")) + mark.len();
        let length = text[start..].find("<!-- end -->").expect("the table's end");
        text.replace_range(start..start + length, &table);
    }
    if std::env::var("TABLES").as_deref() == Ok("write") {
        std::fs::write(&path, text).expect("the page");
        return;
    }
    let again = "TABLES=write cargo test -p hapticore-protocol --test tables";
    assert!(text == before, "{DOCUMENT}: a table is not that of the code: {again}");
}
