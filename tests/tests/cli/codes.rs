// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore codes`: whichever way they are printed, codes make the sensor of a core that `replay`
//! has.

use std::fs;
use std::path::Path;
use std::process::Command;

use hapticore_contract::frame::Field;
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::Block;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::signal::Signal;
use hapticore_model::blocks::core::{Core, Inputs, Outputs};
use hapticore_model::blocks::position::TablePort;
use hapticore_tests::tools::run;

use crate::{Table, expect, finish, refuse};

/// A device with four terminals and one pad, and samples of it.
const DEVICE: [&str; 8] = [
    "simulate",
    "minimal-sheet",
    "--set",
    "sheet.terminals=4",
    "--profile",
    "small",
    "--waves",
    "none",
];
const SLOTS: usize = 3;

fn text(folder: &Path, format: &str) -> String {
    let args = [
        "codes",
        "--profile",
        "small",
        "--calibration",
        "c.csv.calibration.toml",
        "--format",
        format,
    ];
    String::from_utf8(expect(folder, &args, 0).stdout).unwrap()
}

/// The constants by name, and the table by address.
#[derive(Debug, PartialEq)]
struct Codes {
    constants: Vec<(String, i64)>,
    table: Vec<i64>,
}

fn from_csv(text: &str) -> Codes {
    let mut codes = Codes { constants: Vec::new(), table: Vec::new() };
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    for row in rows.map(|line| line.split(',').collect::<Vec<_>>()) {
        let [name, address, code, value, format] = row[..] else { panic!("{row:?}") };
        let (code, format): (i64, hapticore_hdl::format::Format) =
            (code.parse().unwrap(), format.parse().unwrap());
        assert_eq!(value.parse::<f64>().unwrap(), format.real(code), "{row:?}");
        match address {
            "" => codes.constants.push((name.into(), code)),
            address => {
                assert_eq!((name, address.parse()), ("position_table", Ok(codes.table.len())));
                codes.table.push(code);
            }
        }
    }
    codes
}

fn from_header(text: &str) -> Codes {
    let number = |text: &str| text.parse::<i64>().ok();
    let words = |line: &str| line.split_whitespace().map(String::from).collect::<Vec<_>>();
    let mut constants = Vec::new();
    for line in
        text.lines().map(words).filter(|line| line.first().is_some_and(|word| word == "#define"))
    {
        let name = line[1].trim_start_matches("HAPTICORE_").to_lowercase();
        constants.extend(line.get(2).and_then(|code| number(code)).map(|code| (name, code)));
    }
    let (name, count) = constants.pop().unwrap();
    let (_, array) = text.split_once("= {").unwrap();
    let table: Vec<_> = array.split([',', ' ', '\n']).filter_map(number).collect();
    assert_eq!((name.as_str(), count as usize), ("position_table_words", table.len()));
    Codes { constants, table }
}

/// A core that is written to through its ports, as a host does, and then given samples: the words
/// of its frames.
fn frames(profile: &Profile, codes: &Codes, samples: &[Vec<i64>]) -> Vec<[i64; 8]> {
    let core = Core::new(profile);
    let formats = core.inputs();
    let mut fields = Inputs::FIELDS.iter();
    let constants = Inputs::map(formats, |_| {
        let name = fields.next().unwrap().name;
        codes.constants.iter().find(|(known, _)| known == name).map_or(0, |(_, code)| *code)
    });
    let (mut state, mut asked, mut frames) = (core.reset(), 0, Vec::new());
    let mut clock = |inputs: Inputs<i64>, asked: &mut i64| {
        let signals =
            Inputs::map(Inputs::zip(inputs, formats), |(value, format)| Signal { value, format });
        let outputs = Outputs::map(core.step(&mut state, signals), |signal| signal.value);
        *asked = outputs.channel;
        let port = outputs.frames;
        if port.valid == 1 {
            if port.index == 0 {
                frames.push([0; 8]);
            }
            frames.last_mut().unwrap()[port.index as usize] = port.frame;
        }
    };
    for (address, &word) in codes.table.iter().enumerate() {
        clock(
            constants.with_table(TablePort { write: 1, address: address as i64, word }),
            &mut asked,
        );
    }
    for row in samples {
        for step in 0..profile.clocks_per_sample {
            let inputs =
                Inputs { strobe: i64::from(step == 0), code: row[asked as usize], ..constants };
            clock(inputs, &mut asked);
        }
    }
    (0..core.latency()).for_each(|_| clock(constants, &mut asked));
    frames
}

#[test]
fn a_core_given_the_printed_codes_measures_what_replay_does() {
    let folder = tempfile::tempdir().unwrap();
    finish(folder.path(), &[&DEVICE[..], &["--capture", "c.csv"]].concat());
    let capture = fs::read_to_string(folder.path().join("c.csv")).unwrap();
    let rows = capture.lines().filter(|line| !line.starts_with('#')).skip(1);
    let mut profile = Profile::bundled("small").unwrap();
    let rows = rows.take(SLOTS * profile.slot.samples() as usize);
    let samples: Vec<Vec<i64>> =
        rows.map(|line| line.split(',').map(|code| code.parse().unwrap()).collect()).collect();
    expect(folder.path(), &["replay", "c.csv", "--profile", "small", "--out", "r"], 0);
    let replayed = Table::read(&folder.path().join("r/frames.csv"));

    let codes = from_csv(&text(folder.path(), "csv"));
    assert_eq!(codes.constants.len(), 3, "{:?}", codes.constants);
    assert_eq!(from_header(&text(folder.path(), "c")), codes);
    (profile.terminals.x, profile.terminals.y, profile.pads) =
        (vec![-1, -1, 1, 1], vec![1, -1, -1, 1], 1);
    let frames = frames(&profile, &codes, &samples);
    assert_eq!(frames.len(), SLOTS);
    for (name, field) in [
        ("r_x", Field::RatioX),
        ("y_mm", Field::Y),
        ("capacitance_pf", Field::Capacitance),
        ("force_n", Field::Force),
    ] {
        let lsb = field.format(&profile).lsb();
        let got: Vec<f64> = frames.iter().map(|frame| frame[field as usize] as f64 * lsb).collect();
        assert_eq!(got[..], replayed.numbers(name)[..SLOTS], "{name}");
    }
}

/// Reads words as a bench does, prints them with their sign.
const BENCH: &str = "module bench;
    reg signed [WIDTH-1:0] codes [0:1048575];
    integer k;
    initial begin
        $readmemh(\"codes.hex\", codes);
        for (k = 0; codes[k] !== {WIDTH{1'bx}}; k = k + 1) $display(\"%0d\", codes[k]);
        $finish;
    end
endmodule
";

#[test]
#[cfg_attr(
    not(all(tool = "iverilog", tool = "vvp")),
    ignore = "needs iverilog, vvp: ./test fetches what is missing"
)]
fn verilog_reads_the_same_codes() {
    let folder = tempfile::tempdir().unwrap();
    finish(folder.path(), &[&DEVICE[..], &["--capture", "c.csv"]].concat());
    let codes = from_csv(&text(folder.path(), "csv"));
    let hex = text(folder.path(), "readmemh");
    let width = hex.split_once(" words of ").unwrap().1.split(' ').next().unwrap();
    fs::write(folder.path().join("bench.v"), BENCH.replace("WIDTH", width)).unwrap();
    fs::write(folder.path().join("codes.hex"), &hex).unwrap();
    run(Command::new("iverilog").args(["-g2005", "-o", "bench", "bench.v"]), folder.path());
    let log = run(Command::new("vvp").args(["-n", "bench"]), folder.path());
    let read: Vec<i64> = log.lines().filter_map(|line| line.parse().ok()).collect();
    assert_eq!(read.len(), codes.table.len() + codes.constants.len(), "{log}");
    assert_eq!(read[..codes.table.len()], codes.table);
    // A constant without sign fills the word: it is the same bits.
    let modulus = 1i64 << width.parse::<u8>().unwrap();
    let constants: Vec<_> =
        read[codes.table.len()..].iter().map(|code| code.rem_euclid(modulus)).collect();
    assert_eq!(constants, codes.constants.iter().map(|(_, code)| *code).collect::<Vec<_>>());
}

/// A host's program: every number of the header, as the header says them.
const HOST: &str = "#include <stdio.h>
#include \"codes.h\"
int main(void) {
    printf(\"%d\\n%d\\n%d\\n\", HAPTICORE_CAPACITANCE_GAIN, HAPTICORE_FORCE_GAIN, HAPTICORE_CONTACT_CAPACITANCE);
    for (int k = 0; k < HAPTICORE_POSITION_TABLE_WORDS; k++) printf(\"%d\\n\", hapticore_position_table[k]);
    return 0;
}
";

#[test]
#[cfg_attr(not(tool = "gcc"), ignore = "needs gcc: ./test fetches what is missing")]
fn a_host_in_c_has_the_same_codes() {
    let folder = tempfile::tempdir().unwrap();
    finish(folder.path(), &[&DEVICE[..], &["--capture", "c.csv"]].concat());
    fs::write(folder.path().join("codes.h"), text(folder.path(), "c")).unwrap();
    fs::write(folder.path().join("host.c"), HOST).unwrap();
    run(
        Command::new("gcc")
            .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-o", "host", "host.c"]),
        folder.path(),
    );
    let log = run(&mut Command::new(folder.path().join("host")), folder.path());
    let numbers: Vec<i64> = log.lines().map(|line| line.parse().unwrap()).collect();
    let codes = from_csv(&text(folder.path(), "csv"));
    let constant = |name: &str| codes.constants.iter().find(|(known, _)| known == name).unwrap().1;
    let names = ["capacitance_gain", "force_gain", "contact_capacitance"];
    assert_eq!(numbers[..3], names.map(constant));
    assert_eq!(numbers[3..], codes.table);
}

#[test]
fn codes_say_what_they_are_of_and_are_refused_where_they_cannot_be() {
    let folder = tempfile::tempdir().unwrap();
    finish(folder.path(), &[&DEVICE[..], &["--capture", "c.csv"]].concat());
    for format in ["csv", "readmemh", "c"] {
        let text = text(folder.path(), format);
        for word in [
            "hapticore 0.",
            "Profile small (digest ",
            "4 terminals and 1 pads",
            "c.csv.calibration.toml",
        ] {
            assert!(text.contains(word), "{format}: {word}");
        }
    }
    let out = folder.path().join("results");
    expect(folder.path(), &["codes", "--format", "c", "--out", "results"], 0);
    assert!(fs::read_to_string(&out).unwrap().contains("Calibration: the paper's display."));
    fs::remove_file(out).unwrap();
    refuse(folder.path(), &["codes", "--calibration", "none.toml"], &["none.toml"]);
    refuse(folder.path(), &["codes", "--profile", "none"], &["none"]);
}
