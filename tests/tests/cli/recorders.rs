// SPDX-License-Identifier: MIT OR Apache-2.0
//! Captures as other recorders write them: whatever the file is like, the same signal gives the
//! same measurements, or a reason.
//!
//! The files are put together here byte by byte, after the formats' documents, without the
//! command's own writers.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Output, Stdio};

use crate::{Table, expect, finish, refuse};

/// Samples of a slot of the profile `standard`, and its channels.
const SLOT: usize = 1700;
const CHANNELS: usize = 8;

/// The signal as fractions of full scale: currents a quarter turn ahead of the voltage.
fn signal(slots: usize, haptic_hz: f64) -> Vec<[f64; CHANNELS]> {
    const CURRENTS: [f64; 6] = [0.05, 0.06, 0.08, 0.07, 0.04, 0.03];
    let sample = |n: usize| {
        let turn = std::f64::consts::TAU * (n % SLOT) as f64 / 10.0;
        let [a, b, c, d, e, f] = CURRENTS.map(|part| -part * turn.sin());
        let haptic = 0.5 * (std::f64::consts::TAU * haptic_hz * 1e-6 * n as f64).sin();
        [a, b, c, d, e, f, 0.625 * turn.cos(), haptic]
    };
    (0..slots * SLOT).map(sample).collect()
}

/// A chunk of a RIFF file; one of odd size is followed by a byte.
fn chunk(id: &[u8; 4], body: &[u8]) -> Vec<u8> {
    let size = (body.len() as u32).to_le_bytes();
    [&id[..], &size, body, &vec![0; body.len() % 2]].concat()
}

struct Wav {
    tag: u16,
    bytes: usize,
    valid: u16,
    rate: u32,
    before: Vec<u8>,
}

impl Default for Wav {
    fn default() -> Self {
        Wav { tag: 1, bytes: 3, valid: 24, rate: 1_000_000, before: Vec::new() }
    }
}

impl Wav {
    /// The file of samples that are bytes already; `channels` each instant.
    fn file(&self, channels: usize, samples: &[u8]) -> Vec<u8> {
        let block = (channels * self.bytes) as u16;
        let mut format = [0xfffe_u16, channels as u16].map(u16::to_le_bytes).concat();
        format.extend([self.rate, self.rate * u32::from(block)].map(u32::to_le_bytes).concat());
        format.extend(
            [block, 8 * self.bytes as u16, 22, self.valid, 0, 0, self.tag]
                .map(u16::to_le_bytes)
                .concat(),
        );
        format.extend([0, 0, 0, 0, 0x10, 0, 0x80, 0, 0, 0xaa, 0, 0x38, 0x9b, 0x71]);
        let body = [
            b"WAVE".to_vec(),
            self.before.clone(),
            chunk(b"fmt ", &format),
            chunk(b"data", samples),
        ]
        .concat();
        chunk(b"RIFF", &body)
    }

    /// The file of the signal, its codes at the top of their containers.
    fn integers(&self, signal: &[[f64; CHANNELS]]) -> Vec<u8> {
        let (full, shift) =
            (f64::from(1u32 << (self.valid - 1)), 8 * self.bytes - usize::from(self.valid));
        let code = |part: &f64| ((part * full).round() as i64) << shift;
        let samples: Vec<u8> = signal
            .iter()
            .flatten()
            .flat_map(|part| code(part).to_le_bytes()[..self.bytes].to_vec())
            .collect();
        self.file(CHANNELS, &samples)
    }
}

fn replay(folder: &Path, args: &[&str]) -> Table {
    expect(folder, &[&["replay", "--out", "o"], args].concat(), 0);
    Table::read(&folder.join("o/frames.csv"))
}

/// Against the measurements of a CSV capture of integer codes of `bits` bits, finer ones than the
/// ADC's 18 rounded to these, half to even. Floats and volts are compared at 24 bits: a code may
/// then be rounded otherwise.
fn same(folder: &Path, args: &[&str], bits: u16) {
    let power = |bits: u16| f64::from(bits).exp2();
    let (full, coarser) = (power(bits - 1), power(bits.saturating_sub(18)));
    let tolerance = if bits == 24 { 1e-4 } else { 1e-12 };
    let text: String = signal(3, 1000.0)
        .iter()
        .map(|row| {
            row.map(|part| format!("{}", ((part * full).round() / coarser).round_ties_even()))
                .join(",")
                + "\n"
        })
        .collect();
    fs::write(
        folder.join("plain.csv"),
        format!("# bits = {}\ni1,i2,i3,i4,i5,i6,v_sense,v_haptic\n{text}", bits.min(18)),
    )
    .unwrap();
    let expected = replay(folder, &["plain.csv"]);
    let got = replay(folder, args);
    assert_eq!(got.rows.len(), 3, "{args:?}");
    for name in ["r_x", "r_y", "capacitance_pf", "haptic_v_rms"] {
        for (got, expected) in got.numbers(name).iter().zip(expected.numbers(name)) {
            assert!(
                (got / expected - 1.0).abs() < tolerance,
                "{args:?}: {name}: {got}, expected {expected}"
            );
        }
    }
}

#[test]
fn wav_of_any_width_is_read_as_meant() {
    let folder = tempfile::tempdir().unwrap();
    let signal = signal(3, 1000.0);
    for (bytes, valid) in [(2, 16), (3, 24), (4, 24), (4, 32), (3, 18), (4, 20)] {
        fs::write(
            folder.path().join("c.wav"),
            Wav { bytes, valid, ..Wav::default() }.integers(&signal),
        )
        .unwrap();
        same(folder.path(), &["c.wav"], valid);
    }
}

#[test]
fn wav_of_floats_and_with_chunks_of_odd_size_is_read_as_meant() {
    let folder = tempfile::tempdir().unwrap();
    let signal = signal(3, 1000.0);
    let singles: Vec<u8> =
        signal.iter().flatten().flat_map(|part| (*part as f32).to_le_bytes()).collect();
    let doubles: Vec<u8> =
        signal.iter().flatten().flat_map(|part| (10.0 * part).to_le_bytes()).collect();
    let float = |bytes| Wav {
        tag: 3,
        bytes,
        valid: 8 * bytes as u16,
        before: chunk(b"LIST", b"odd"),
        ..Wav::default()
    };
    fs::write(folder.path().join("f.wav"), float(4).file(CHANNELS, &singles)).unwrap();
    same(folder.path(), &["f.wav"], 24);
    fs::write(folder.path().join("v.wav"), float(8).file(CHANNELS, &doubles)).unwrap();
    same(folder.path(), &["v.wav", "--full-scale-v", "10"], 24);
    let nan: Vec<u8> = [f32::NAN; CHANNELS].iter().flat_map(|part| part.to_le_bytes()).collect();
    fs::write(folder.path().join("n.wav"), float(4).file(CHANNELS, &nan)).unwrap();
    refuse(folder.path(), &["replay", "n.wav"], &["n.wav: sample 0: i1: expected a number"]);
}

#[test]
fn codes_at_the_bottom_of_their_samples_are_refused_until_they_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let codes =
        signal(3, 1000.0).into_iter().flatten().map(|part| (part * 8_388_608.0).round() as i32);
    let bytes: Vec<u8> = codes.flat_map(i32::to_le_bytes).collect();
    fs::write(
        folder.path().join("b.wav"),
        Wav { bytes: 4, valid: 24, ..Wav::default() }.file(CHANNELS, &bytes),
    )
    .unwrap();
    refuse(folder.path(), &["replay", "b.wav"], &["b.wav: sample 1: i1", "--bits 24"]);
    same(folder.path(), &["b.wav", "--bits", "24"], 24);
}

#[test]
fn rf64_is_read_and_a_length_that_riff_cannot_hold_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let mut file = Wav::default().integers(&signal(3, 1000.0));
    let samples = 3 * SLOT * CHANNELS * 3;
    let sizes = [(file.len() + 28) as u64, samples as u64, (3 * SLOT) as u64]
        .map(u64::to_le_bytes)
        .concat();
    let data = file.len() - samples - 4;
    file[data..data + 4].copy_from_slice(&[0xff; 4]);
    let head = [
        b"RF64".to_vec(),
        vec![0xff; 4],
        b"WAVE".to_vec(),
        chunk(b"ds64", &[sizes, vec![0; 4]].concat()),
    ]
    .concat();
    fs::write(folder.path().join("l.wav"), [head, file[12..].to_vec()].concat()).unwrap();
    same(folder.path(), &["l.wav"], 24);
    // A file of more than 4 GiB, all but its head a hole, whose head is of RIFF: its size has
    // wrapped.
    let path = folder.path().join("w.wav");
    fs::write(&path, Wav::default().integers(&signal(1, 1000.0))).unwrap();
    fs::File::options().write(true).open(&path).unwrap().set_len((1 << 32) + 100_000).unwrap();
    refuse(folder.path(), &["replay", "w.wav"], &["w.wav", "RF64"]);
}

#[test]
fn sigmf_is_read_as_meant_or_refused_with_the_reason() {
    let folder = tempfile::tempdir().unwrap();
    let signal = signal(3, 1000.0);
    let meta = |datatype: &str, more: &str| {
        let global = format!(
            "\"core:datatype\": \"{datatype}\", \"core:sample_rate\": 1e6, \"core:num_channels\": 8, \"core:version\": \"1.2.0\"{more}"
        );
        fs::write(
            folder.path().join("c.sigmf-meta"),
            format!("{{\"global\": {{{global}}}, \"captures\": [{{\"core:sample_start\": 0}}]}}"),
        )
        .unwrap();
    };
    let data = |bytes: Vec<u8>| fs::write(folder.path().join("c.sigmf-data"), bytes).unwrap();
    meta("ri16_le", "");
    data(
        signal
            .iter()
            .flatten()
            .flat_map(|part| ((part * 32_768.0).round() as i16).to_le_bytes())
            .collect(),
    );
    same(folder.path(), &["c.sigmf-meta"], 16);
    meta("rf32_be", "");
    data(signal.iter().flatten().flat_map(|part| (*part as f32).to_be_bytes()).collect());
    same(folder.path(), &["c.sigmf-data"], 24);
    meta("cf32_le", "");
    refuse(folder.path(), &["replay", "c.sigmf-meta"], &["c.sigmf-meta: core:datatype", "complex"]);
    meta("rf32_le", ", \"core:dataset\": \"x.bin\"");
    refuse(folder.path(), &["replay", "c.sigmf-meta"], &["c.sigmf-meta", "core:dataset"]);
    refuse(folder.path(), &["replay", "c.sigmf"], &["c.sigmf", "archive"]);
}

/// The signal as volts at an ADC of ±10 V, a time before them and no header.
fn volts() -> String {
    let row = |(n, row): (usize, &[f64; CHANNELS])| {
        format!("{},{}\n", n as f64 * 1e-6, row.map(|part| format!("{:.7}", 10.0 * part)).join(","))
    };
    signal(3, 1000.0).iter().enumerate().map(row).collect()
}

const MAP: &str = "_,i1,i2,i3,i4,i5,i6,v_sense,v_haptic";

#[test]
fn csv_in_volts_with_a_map_of_its_columns_is_read_as_meant() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scope.csv"), volts()).unwrap();
    same(folder.path(), &["scope.csv", "--channels", MAP, "--full-scale-v", "10"], 24);
    fs::write(
        folder.path().join("named.csv"),
        format!("# full_scale_v = 10\nTime,CH1,CH2,CH3,CH4,CH5,CH6,CH7,CH8\n{}", volts()),
    )
    .unwrap();
    same(folder.path(), &["named.csv", "--channels", MAP], 24);
    let refuse =
        |args: &[&str], words: &[&str]| refuse(folder.path(), &[&["replay"], args].concat(), words);
    refuse(
        &["scope.csv", "--channels", MAP],
        &["scope.csv:1: i1", "integer code", "--full-scale-v"],
    );
    refuse(&["scope.csv", "--channels", "i1,i2"], &["scope.csv:1", "--channels", "got 9"]);
    refuse(
        &["scope.csv", "--channels", &MAP.replace("i2", "i1")],
        &["--channels", "i1 comes twice"],
    );
    refuse(&["scope.csv", "--channels", &MAP.replace("i2", "_")], &["--channels", "i2 is missing"]);
}

/// The signal as volts, each row of it written so.
fn written(
    time: impl Fn(usize) -> String,
    separator: &str,
    end: &str,
    number: impl Fn(f64) -> String,
) -> String {
    let row = |(n, row): (usize, &[f64; CHANNELS])| {
        let cells: Vec<String> =
            std::iter::once(time(n)).chain(row.iter().map(|part| number(10.0 * part))).collect();
        cells.join(separator) + end
    };
    signal(3, 1000.0).iter().enumerate().map(row).collect()
}

/// Files as oscilloscopes and numpy write them, with eight channels: heads after the manufacturers' manuals
/// and files that users have published.
#[test]
fn files_of_oscilloscopes_are_read_as_meant() {
    let folder = tempfile::tempdir().unwrap();
    let channels = |name: &dyn Fn(usize) -> String| (1..=8).map(name).collect::<Vec<_>>().join(",");
    let plain = |volt: f64| format!("{volt:.7}");
    let seconds = |n: usize| format!("{:.7e}", n as f64 * 1e-6 - 2e-3);
    let ch = channels(&|k| format!("CH{k}"));
    let eight = |word: &str| [word; 8].join(",");
    let tektronix = format!(
        "Model,MSO58\nFirmware Version,1.20.3\n\nWaveform Type,ANALOG{0}\nPoint Format,Y{0}\nHorizontal Units,s{0}\n\
         Horizontal Scale,0.0004{0}\nHorizontal Delay,0{0}\nSample Interval,1e-06{0}\nRecord Length,5100{0}\n\
         Gating,0.0% to 100.0%{0}\nProbe Attenuation,{1}\nVertical Units,{2}\nVertical Offset,{3}\n,{0}\n,{0}\nTIME,{ch}\n",
        ",".repeat(7),
        eight("1"),
        eight("V"),
        eight("0")
    ) + &written(seconds, ",", "\n", plain);
    let pico =
        channels(&|k| format!("Channel {}", ['A', 'B', 'C', 'D', 'E', 'F', 'G', 'H'][k - 1]));
    let picoscope = format!("Time,{pico}\n(us),{}\n\n", eight("(mV)"))
        + &written(
            |n| format!("{:.3}", n as f64 - 500.0),
            ",",
            "\r\n",
            |volt| format!("{:.5}", 1e3 * volt),
        );
    let rigol =
        format!("X,{ch},Start,Increment,\nSequence,{},-2.000000e-03,1.000000e-06\n", eight("Volt"))
            + &written(|n| n.to_string(), ",", ",\n", |volt| format!("{volt:.6e}"));
    let ampl = channels(&|k| format!("Ampl{k}"));
    let lecroy = format!(
        "LECROYHDO8108,12345,Waveform\nSegments,1,SegmentSize,5100\nSegment,TrigTime,TimeSinceSegment1\n#1,24-Feb-2016 16:34:36,0\nTime,{ampl}\n"
    ) + &written(seconds, ",", "\n", plain);
    let numpy = String::from("# time i1 i2 i3 i4 i5 i6 v_sense v_haptic\n")
        + &written(
            |n| format!("{:.18e}", n as f64 * 1e-6),
            " ",
            "\n",
            |volt| format!("{volt:.18e}"),
        );
    let comma = |volt: f64| format!("{volt:.7}").replace('.', ",");
    let german = format!("Zeit;{}\n", ch.replace(',', ";"))
        + &written(|n| format!("{:.6}", n as f64 * 1e-6).replace('.', ","), ";", ";\n", comma);
    let tabs = format!("Time (ms)\t{}\n", ch.replace(',', "\t"))
        + &written(|n| format!("{:.3}", n as f64 * 1e-3), "\t", "\n", plain);
    let quoted = format!("\"Time\",\"{}\"\n", ch.replace(',', "\",\""))
        + &written(
            |n| format!("\"{:.6}\"", n as f64 * 1e-6),
            ",",
            "\n",
            |volt| format!("\"{}\"", comma(volt)),
        );
    let args = ["c.csv", "--full-scale-v", "10", "--channels", MAP];
    for text in [&tektronix, &picoscope, &rigol, &lecroy, &german, &tabs, &quoted] {
        fs::write(folder.path().join("c.csv"), text).unwrap();
        same(folder.path(), &args, 24);
        let words = ["c.csv:", "expected columns i1", "--channels _,i1,i2"];
        refuse(folder.path(), &["replay", "c.csv", "--full-scale-v", "10"], &words);
    }
    fs::write(folder.path().join("c.csv"), &numpy).unwrap();
    same(folder.path(), &args[..3], 24);
    for is_big in [false, true] {
        let word = |word: u16| if is_big { word.to_be_bytes() } else { word.to_le_bytes() };
        let marked = std::iter::once(0xfeff).chain(picoscope.encode_utf16());
        fs::write(folder.path().join("c.csv"), marked.flat_map(word).collect::<Vec<_>>()).unwrap();
        same(folder.path(), &args, 24);
    }
    fs::write(folder.path().join("c.csv"), &picoscope).unwrap();
    refuse(
        folder.path(),
        &["replay", "c.csv", "--channels", MAP],
        &["c.csv:", "i1: its unit is volts", "--full-scale-v"],
    );
    fs::write(folder.path().join("c.csv"), picoscope.replace("(mV)", "(mA)")).unwrap();
    refuse(
        folder.path(),
        &["replay", "c.csv", "--channels", MAP],
        &["c.csv:", "expected volts", "mA"],
    );
    let slow = tektronix.replace("Sample Interval,1e-06", "Sample Interval,2e-06");
    fs::write(folder.path().join("c.csv"), slow).unwrap();
    refuse(
        folder.path(),
        &[&["replay"], &args[..]].concat(),
        &["sample_rate_hz", "500000", "resample"],
    );
    let one = "LECROYHDO8108,12345,Waveform\nSegments,1,SegmentSize,2\nSegment,TrigTime,TimeSinceSegment1\n#1,now,0\nTime,Ampl\n0,1.5\n1e-6,1.6\n";
    fs::write(folder.path().join("c.csv"), one).unwrap();
    refuse(folder.path(), &["replay", "c.csv"], &["c.csv:5: ", "a LeCroy file", "side by side"]);
    fs::write(folder.path().join("c.csv"), lecroy.replace("Segments,1", "Segments,4")).unwrap();
    refuse(folder.path(), &[&["replay"], &args[..]].concat(), &["c.csv:", "one segment, got 4"]);
}

#[test]
fn a_size_that_a_pipe_cannot_know_is_taken_for_none() {
    let folder = tempfile::tempdir().unwrap();
    let mut wav = Wav::default().integers(&signal(3, 1000.0));
    fs::write(folder.path().join("c.wav"), &wav).unwrap();
    let expected = replay(folder.path(), &["c.wav"]).rows;
    let data = wav.len() - 3 * SLOT * CHANNELS * 3 - 4;
    // What sox writes into the head of a file of 24 bits that goes into a pipe.
    wav[data..data + 4].copy_from_slice(&0x7fff_eff0u32.to_le_bytes());
    let output = piped(folder.path(), &[], &wav);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("it ends after 5100 samples"),
        "{output:?}"
    );
    assert!(Table::read(&folder.path().join("o/frames.csv")).rows == expected);
    fs::write(folder.path().join("c.wav"), &wav).unwrap();
    refuse(folder.path(), &["replay", "c.wav"], &["c.wav", "cut short", "--truncated"]);
    assert!(replay(folder.path(), &["c.wav", "--truncated"]).rows == expected);
    wav.truncate(wav.len() - 1700 * CHANNELS * 3 - 5);
    fs::write(folder.path().join("c.wav"), &wav).unwrap();
    assert!(replay(folder.path(), &["c.wav", "--truncated"]).rows == expected[..1]);
}

fn piped(folder: &Path, args: &[&str], bytes: &[u8]) -> Output {
    let mut run = crate::command(folder, &[&["replay", "-", "--out", "o"], args].concat());
    let mut run =
        run.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    run.stdin.take().unwrap().write_all(bytes).unwrap();
    run.wait_with_output().unwrap()
}

#[test]
fn standard_input_is_read_to_the_same_frames() {
    let folder = tempfile::tempdir().unwrap();
    let mut wav = Wav::default().integers(&signal(3, 1000.0));
    fs::write(folder.path().join("c.wav"), &wav).unwrap();
    let expected = replay(folder.path(), &["c.wav"]).rows;
    // A recorder that writes into a pipe does not know how long its file will be.
    let data = wav.len() - 3 * SLOT * CHANNELS * 3 - 4;
    wav[data..data + 4].copy_from_slice(&[0xff; 4]);
    let output = piped(folder.path(), &[], &wav);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(Table::read(&folder.path().join("o/frames.csv")).rows == expected);
    let output =
        piped(folder.path(), &["--channels", MAP, "--full-scale-v", "10"], volts().as_bytes());
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert_eq!(Table::read(&folder.path().join("o/frames.csv")).rows.len(), 3);
    let output = piped(folder.path(), &[], b"");
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("standard input:1: expected a header"),
        "{output:?}"
    );
}

#[test]
fn what_a_capture_cannot_mean_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let header = "i1,i2,i3,i4,i5,i6,v_sense,v_haptic,pad\n";
    let csv = |text: String, words: &[&str]| {
        fs::write(folder.path().join("c.csv"), text).unwrap();
        refuse(folder.path(), &["replay", "c.csv", "--bits", "18"], words);
    };
    let row = "1,2,3,4,5,6,7,8,0\n";
    csv(
        format!("{header}{row}# sample_rate_hz = 500000\n{row}"),
        &["c.csv:3: sample_rate_hz", "before the header"],
    );
    csv(format!("{header}{}", row.replace(",0\n", ",-1\n")), &["c.csv:2: pad", "\"-1\""]);
    csv(
        format!("{header}{}", row.repeat(SLOT - 1)),
        &["c.csv", "one slot at least, 1700, got 1699"],
    );
    let mut bytes = vec![0u8; 9 * 3 * SLOT];
    bytes[24..27].copy_from_slice(&[0xff; 3]);
    let wav = |file: &Wav, bytes: &[u8], words: &[&str]| {
        fs::write(folder.path().join("c.wav"), file.file(9, bytes)).unwrap();
        refuse(folder.path(), &["replay", "c.wav"], words);
    };
    wav(&Wav::default(), &bytes, &["c.wav: sample 0: pad", "got -1"]);
    wav(
        &Wav { rate: 500_000, ..Wav::default() },
        &bytes,
        &["c.wav", "sample_rate_hz", "1000000", "500000", "resample"],
    );
    wav(&Wav { bytes: 1, valid: 8, ..Wav::default() }, &bytes, &["c.wav", "16, 24 or 32 bits"]);
    wav(&Wav { tag: 6, bytes: 3, ..Wav::default() }, &bytes, &["c.wav", "format 6"]);
}

#[test]
fn a_capture_without_calibration_says_so() {
    let folder = tempfile::tempdir().unwrap();
    finish(
        folder.path(),
        &[
            "simulate",
            "hockey",
            "--set",
            "duration_s=0.02",
            "--waves",
            "none",
            "--capture",
            "h.wav",
        ],
    );
    let output = expect(folder.path(), &["replay", "h.wav", "--out", "o"], 0);
    assert!(output.stderr.is_empty(), "{output:?}");
    fs::rename(folder.path().join("h.wav.calibration.toml"), folder.path().join("c.toml")).unwrap();
    let output = expect(folder.path(), &["replay", "h.wav", "--out", "o", "--json"], 0);
    let log = String::from_utf8(output.stderr).unwrap();
    assert!(
        log.contains("warning: h.wav: NO CALIBRATION") && log.contains("--calibration"),
        "{log}"
    );
    let summary = String::from_utf8(output.stdout).unwrap();
    assert!(
        summary.contains("NO CALIBRATION") && summary.contains("\"calibration\": null"),
        "{summary}"
    );
    assert!(
        fs::read_to_string(folder.path().join("o/report.html")).unwrap().contains("NO CALIBRATION")
    );
    // A calibration whose numbers the profile does not hold is named, with its field.
    let text = fs::read_to_string(folder.path().join("c.toml")).unwrap();
    let force = text.lines().find(|line| line.starts_with("force_k")).unwrap();
    fs::write(folder.path().join("c.toml"), text.replace(force, "force_k = 9.6e30")).unwrap();
    refuse(
        folder.path(),
        &["replay", "h.wav", "--calibration", "c.toml"],
        &["c.toml", "force gain"],
    );
}

#[test]
fn a_slow_haptic_voltage_in_a_capture_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let log = |hz: f64| {
        fs::write(folder.path().join("c.wav"), Wav::default().integers(&signal(40, hz))).unwrap();
        String::from_utf8(
            expect(folder.path(), &["replay", "c.wav", "--out", "o", "--pads", "1"], 0).stderr,
        )
        .unwrap()
    };
    assert!(!log(1000.0).contains("haptic_v_rms"));
    let slow = log(150.0);
    assert!(
        slow.contains("haptic_v_rms") && slow.contains("150") && slow.contains("6668 samples"),
        "{slow}"
    );
}
