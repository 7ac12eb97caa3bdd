// SPDX-License-Identifier: MIT OR Apache-2.0
//! Recordings are read back here by the formats' specifications.

use std::sync::{Arc, Mutex};

use hapticore_run::record::Driven;
use serde_json::Value as Json;

use super::*;

/// A file that stays when its writer is dropped.
#[derive(Clone, Default)]
struct Memory(Arc<Mutex<Vec<u8>>>);

impl Write for Memory {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn row(pad: usize, time_s: f64) -> Row {
    let driven = Driven { target_n: 0.3, drive_v_rms: 120.0, ..Driven::default() };
    Row {
        case: 0,
        time_s,
        pad,
        measured: hapticore_host::Quantities { x_mm: 1.5, ..Default::default() },
        flags: "lifted".into(),
        laws: None,
        truth: None,
        driven: Some(driven),
        game: None,
        reference: None,
    }
}

/// Opcode and content of each record.
fn records(mut file: &[u8]) -> Vec<(u8, &[u8])> {
    let mut records = Vec::new();
    while file.len() > 9 {
        let (head, rest) = file.split_at(9);
        let length = u64::from_le_bytes(head[1..].try_into().unwrap()) as usize;
        records.push((head[0], &rest[..length]));
        file = &rest[length..];
    }
    records
}

#[test]
fn an_mcap_recording_has_rows_by_pad_and_notes_at_their_times() {
    let memory = Memory::default();
    let mut mcap = Mcap::new(Columns::of_board(true, false), 2, memory.clone()).unwrap();
    mcap.row(&row(1, 0.25)).unwrap();
    mcap.note(0.25, "armed").unwrap();
    mcap.row(&row(1, 0.5)).unwrap();
    drop(mcap);
    let file = memory.0.lock().unwrap().clone();
    let magic = b"\x89MCAP0\r\n";
    let inner = file.strip_prefix(magic).and_then(|rest| rest.strip_suffix(magic)).unwrap();
    let records = records(inner);
    let opcodes: Vec<u8> = records.iter().map(|(opcode, _)| *opcode).collect();
    assert_eq!(opcodes, [1, 3, 3, 4, 4, 4, 5, 5, 5, 15, 2]);
    let message = |number: usize| {
        let content = records[6 + number].1;
        let time_ns = u64::from_le_bytes(content[6..14].try_into().unwrap());
        let json: Json = serde_json::from_slice(&content[22..]).unwrap();
        (content[0], content[2], time_ns, json)
    };
    let (channel, sequence, time_ns, json) = message(0);
    assert_eq!((channel, sequence, time_ns), (2, 0, 250_000_000));
    assert_eq!((&json["pad"], &json["x_mm"]), (&Json::from(1), &Json::from(1.5)));
    assert_eq!((&json["flags"], &json["target_n"]), (&Json::from("lifted"), &Json::from(0.3)));
    let (channel, sequence, _, json) = message(1);
    assert_eq!((channel, sequence, &json["text"]), (0, 0, &Json::from("armed")));
    let (channel, sequence, time_ns, _) = message(2);
    assert_eq!((channel, sequence, time_ns), (2, 1, 500_000_000));
}

#[test]
fn a_csv_recording_has_a_column_for_each_value() {
    let memory = Memory::default();
    let mut csv = Csv::new(Columns::of_board(true, true), memory.clone()).unwrap();
    csv.row(&row(0, 0.25)).unwrap();
    let text = String::from_utf8(memory.0.lock().unwrap().clone()).unwrap();
    let lines: Vec<_> = text.lines().collect();
    let [head, row] = lines[..] else { panic!("{text}") };
    assert!(head.ends_with("flags,target_n,drive_v_rms,drive_limited,drive_fault,released"));
    assert!(row.starts_with("0.25,0,0,0,1.5,") && row.ends_with("lifted,0.3,120,0,0,0"), "{row}");
}
