// SPDX-License-Identifier: MIT OR Apache-2.0
//! Captures: bytes in, codes of an ADC out.
//!
//! The first byte selects what the options say of the file ([`Described`]).

use std::io::Cursor;

use hapticore_contract::format::Format;
use hapticore_run::capture::{self, Adc, Content, Described, Input, Source};

use super::{Planted, all_hold, planted, refused};

const ADC: Adc = Adc { terminals: 3, format: Format { signed: true, width: 18, frac: 17 } };

/// The most rows that are read: what follows is of the same kind.
const MOST_ROWS: usize = 4096;

pub(super) fn csv(data: &[u8]) -> bool {
    let Some((options, data)) = data.split_first() else { return false };
    let content = Content::Csv(input(data, "fuzz.csv"));
    let Some(rows) = rows(content, &described(*options), "fuzz.csv") else { return false };
    assert_eq!(again(&rows, "again.csv"), rows);
    true
}

pub(super) fn wav(data: &[u8]) -> bool {
    let Some((options, data)) = data.split_first() else { return false };
    let content = Content::Wav(input(data, "fuzz.wav"));
    let Some(mut rows) = rows(content, &described(*options), "fuzz.wav") else { return false };
    // A WAV file that is written has no channel for the pad.
    rows.iter_mut().for_each(|(pad, _)| *pad = None);
    assert_eq!(again(&rows, "again.wav"), rows);
    true
}

pub(super) fn sigmf(data: &[u8]) -> bool {
    let Some((options, data)) = data.split_first() else { return false };
    let end = data.iter().position(|byte| *byte == 0).unwrap_or(data.len());
    let Ok(meta) = str::from_utf8(&data[..end]) else { return false };
    let samples = data.get(end + 1..).unwrap_or_default();
    let content = Content::Sigmf {
        file: "fuzz.sigmf-meta".into(),
        meta: meta.into(),
        data: input(samples, "fuzz.sigmf-data"),
    };
    rows(content, &described(*options), "fuzz.sigmf-").is_some()
}

/// What a byte says beside the file: seeds have the character of none.
fn described(options: u8) -> Described {
    let options = options ^ b'0';
    let names = |names: &[&str]| Some(names.iter().map(ToString::to_string).collect());
    Described {
        channels: match options & 3 {
            1 => names(&["i1", "i2", "i3", "v_sense", "v_haptic", "pad"]),
            2 => names(&["_", "v_haptic", "i3", "i2", "v_sense", "i1"]),
            _ => None,
        },
        bits: [None, Some(2), Some(16), Some(32)][usize::from(options >> 2 & 3)],
        full_scale_v: [None, Some(10.0), Some(1e-300), Some(1e300)][usize::from(options >> 4 & 3)],
        sample_rate_hz: (options & 64 != 0).then_some(1e6),
        truncated: options & 128 != 0,
    }
}

fn input(data: &[u8], name: &str) -> Input {
    Input::new(Box::new(Cursor::new(data.to_vec())), name.into(), Some(data.len() as u64))
}

/// A pad and the codes of a row.
type Row = (Option<usize>, Vec<i32>);

/// The rows of a capture; none where it is refused.
fn rows(content: Content, described: &Described, file: &str) -> Option<Vec<Row>> {
    let refused = |error| {
        refused(error, file);
    };
    let mut source = capture::read(content, ADC, described).map_err(refused).ok()?;
    let rows = take(source.as_mut()).map_err(refused).ok()?;
    source.notes().iter().for_each(|note| assert!(note.starts_with(file), "{note}"));
    assert!(source.sample_rate_hz().is_none_or(|rate| rate >= 0.0));
    let codes = ADC.format.min_code() as i32..=ADC.format.max_code() as i32;
    for (pad, row) in &rows {
        assert!(pad.is_none_or(|pad| pad < 256));
        assert_eq!(row.len(), ADC.channels().len());
        assert!(row.iter().all(|code| codes.contains(code)), "{row:?}");
    }
    Some(rows)
}

fn take(source: &mut dyn Source) -> anyhow::Result<Vec<Row>> {
    let mut rows = Vec::new();
    while rows.len() < MOST_ROWS {
        let mut codes = Vec::new();
        let Some(sampled) = source.row(&mut codes)? else { break };
        assert!(!source.place().is_empty());
        rows.push((sampled.pad, codes));
    }
    Ok(rows)
}

/// The rows, written and read again.
fn again(rows: &[Row], name: &str) -> Vec<Row> {
    let folder = tempfile::tempdir().expect("a folder of temporary files");
    let path = folder.path().join(name);
    let mut recorder = capture::create(&path, ADC, 1e6).expect("a folder that takes files");
    for (pad, codes) in rows {
        let mut codes = codes.clone();
        let is_odd = [
            pad.is_some_and(|pad| pad > 0),
            codes[3] == ADC.format.max_code() as i32,
            codes[2] == ADC.format.min_code() as i32,
        ];
        if planted(Planted::Csv) && all_hold(&is_odd) {
            codes[2] = ADC.format.max_code() as i32;
        }
        recorder.slot(pad.unwrap_or(0), &codes).expect("a file that takes rows");
    }
    recorder.keep().expect("a file that is kept");
    let mut source = capture::open(&path, ADC, &Described::default()).expect("a capture");
    let mut again = take(source.as_mut()).expect("rows");
    // A row without a pad is written as one of the first.
    again
        .iter_mut()
        .zip(rows)
        .filter(|(_, (pad, _))| pad.is_none())
        .for_each(|(row, _)| row.0 = None);
    again
}
