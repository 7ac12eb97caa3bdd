// SPDX-License-Identifier: MIT OR Apache-2.0
//! The kinds of faults that are planted, and what must be said of each.

use fastrand::Rng;

use super::device::Device;
use super::lab::Lab;
use super::recording::{Recording, SLOT};

/// A file of a case: its name and what is in it.
pub type File = (&'static str, Vec<u8>);

/// A run with a fault.
pub struct Planted {
    pub files: Vec<File>,
    /// The command's arguments; `--out` follows.
    pub args: Vec<String>,
    /// What comes through standard input.
    pub piped: Option<Vec<u8>>,
    /// It is refused, in one line.
    pub refused: bool,
    /// Words of one line of the console, the summary and the report.
    pub words: Vec<String>,
    /// A flag that frames carry.
    pub flag: Option<String>,
}

/// A kind of fault.
pub struct Kind {
    pub name: &'static str,
    pub plant: fn(&Device, &mut Rng) -> Planted,
}

/// All kinds of recordings and calibrations.
pub static KINDS: [Kind; 24] = [
    Kind { name: "integer codes without their bits", plant: no_bits },
    Kind { name: "volts without their full scale", plant: no_full_scale },
    Kind { name: "a column of times of another rate", plant: another_rate },
    Kind { name: "a column of times that jumps", plant: jump },
    Kind { name: "a head of another sample rate", plant: wav_rate },
    Kind { name: "a recording that begins within a slot", plant: begins_within },
    Kind { name: "lost samples", plant: lost },
    Kind { name: "repeated samples", plant: repeated },
    Kind { name: "a pipe's size in a file", plant: size_in_file },
    Kind { name: "a pipe that ends before its size", plant: size_in_pipe },
    Kind { name: "a text that is cut short", plant: cut_short },
    Kind { name: "decimal commas between commas", plant: decimal_commas },
    Kind { name: "UTF-16 without a mark", plant: unmarked },
    Kind { name: "two channels swapped", plant: swapped },
    Kind { name: "a channel reversed", plant: reversed },
    Kind { name: "the sensing voltage reversed", plant: sense_reversed },
    Kind { name: "a channel that reads 30 % more or less", plant: gain },
    Kind { name: "a slow haptic voltage of one pad", plant: slow },
    Kind {
        name: "places in centimetres",
        plant: |device, rng| places(device, rng, "cm", |at, _| at / 10.0),
    },
    Kind {
        name: "places from a corner",
        plant: |device, rng| places(device, rng, "corner", |at, size| at + size / 2.0),
    },
    Kind { name: "loads in kilograms", plant: kilograms },
    Kind { name: "a current that reads 30 % more or less", plant: lab_gain },
    Kind { name: "currents swapped", plant: lab_swapped },
    Kind { name: "a current reversed", plant: lab_reversed },
];

/// Slots of a recording: a few rotations.
fn slots(device: &Device) -> usize {
    8 * device.pads.len().max(2)
}

fn record(device: &Device, rng: &mut Rng) -> Recording {
    Recording::of(device, slots(device), rng)
}

fn short(device: &Device, rng: &mut Rng) -> Recording {
    Recording::of(device, 2 * device.pads.len(), rng)
}

/// A replay of a file, which is refused with these words, or said to be so.
fn replay(file: File, more: &[&str], refused: bool, words: &[&str]) -> Planted {
    let args = [&["replay", file.0, "--calibration", "mine.toml"], more].concat();
    Planted {
        args: args.iter().map(ToString::to_string).collect(),
        files: vec![file],
        piped: None,
        refused,
        words: words.iter().map(ToString::to_string).collect(),
        flag: None,
    }
}

fn wav(recording: &Recording, words: &[&str], flag: Option<String>) -> Planted {
    let planted = replay(("c.wav", recording.wav(1_000_000, None)), &[], false, words);
    Planted { flag, ..planted }
}

fn no_bits(device: &Device, rng: &mut Rng) -> Planted {
    let text = short(device, rng).csv(*rng.choice([12, 14, 16, 18].iter()).expect("some"), false);
    replay(("c.csv", text.into_bytes()), &[], true, &["c.csv:2: ", "--bits"])
}

fn no_full_scale(device: &Device, rng: &mut Rng) -> Planted {
    let text = short(device, rng).volts(|n| n as f64 * 1e-6);
    replay(("c.csv", text.into_bytes()), &[], true, &["c.csv:2: ", "--full-scale-v"])
}

fn another_rate(device: &Device, rng: &mut Rng) -> Planted {
    let step = *rng.choice([2e-6, 0.5e-6, 1.25e-6, 4e-6].iter()).expect("some");
    let text = short(device, rng).volts(|n| n as f64 * step);
    replay(
        ("c.csv", text.into_bytes()),
        &["--full-scale-v", "10"],
        true,
        &["c.csv:", "time: ", "sample rate"],
    )
}

/// A sample of the recording that is in a slot's middle, and its slot's pad and number.
fn middle(device: &Device, recording: &Recording, rng: &mut Rng) -> (usize, usize, usize) {
    let pads = device.pads.len();
    let slot = rng.usize(pads..recording.samples.len() / SLOT - 4);
    (slot * SLOT + rng.usize(200..1500), slot % pads, slot)
}

fn jump(device: &Device, rng: &mut Rng) -> Planted {
    let mut recording = record(device, rng);
    let (at, pad, slot) = middle(device, &recording, rng);
    let count = rng.usize(20..4000);
    recording.samples.drain(at..at + count);
    let text = recording.volts(|n| (n + if n < at { 0 } else { count }) as f64 * 1e-6);
    let words = format!("the first at sample {}, pad {pad}", slot * SLOT);
    let planted = replay(
        ("c.csv", text.into_bytes()),
        &["--full-scale-v", "10"],
        false,
        &["SAMPLES ARE LOST", &words],
    );
    Planted { flag: Some("broken".into()), ..planted }
}

fn wav_rate(device: &Device, rng: &mut Rng) -> Planted {
    let rate = *rng.choice([500_000, 2_000_000, 1_250_000].iter()).expect("some");
    replay(
        ("c.wav", short(device, rng).wav(rate, None)),
        &[],
        true,
        &["c.wav", "sample_rate_hz", &rate.to_string()],
    )
}

fn begins_within(device: &Device, rng: &mut Rng) -> Planted {
    let mut recording = record(device, rng);
    let first = rng.usize(12..SLOT - 3);
    recording.samples.drain(..first);
    let words = format!("{} samples before the first border", SLOT - first);
    wav(&recording, &["BEGINS WITHIN A SLOT", &words], None)
}

fn lost(device: &Device, rng: &mut Rng) -> Planted {
    let mut recording = record(device, rng);
    let (at, pad, slot) = middle(device, &recording, rng);
    recording.samples.drain(at..at + rng.usize(1..1500));
    let words = format!("the first at sample {}, pad {pad}", slot * SLOT);
    wav(&recording, &["SAMPLES ARE LOST", &words], Some("broken".into()))
}

fn repeated(device: &Device, rng: &mut Rng) -> Planted {
    let mut recording = record(device, rng);
    let (at, pad, slot) = middle(device, &recording, rng);
    let again = recording.samples[at - rng.usize(1..180)..at].to_vec();
    recording.samples.splice(at..at, again);
    let words = format!("the first at sample {}, pad {pad}", slot * SLOT);
    wav(&recording, &["LOST OR REPEATED", &words], Some("broken".into()))
}

fn size_in_file(device: &Device, rng: &mut Rng) -> Planted {
    let file = short(device, rng).wav(1_000_000, Some(0x7fff_eff0));
    replay(("c.wav", file), &[], true, &["c.wav", "cut short", "--truncated"])
}

fn size_in_pipe(device: &Device, rng: &mut Rng) -> Planted {
    let recording = short(device, rng);
    let words = format!("ends after {} samples", recording.samples.len());
    let planted = replay(("-", Vec::new()), &[], false, &[&words]);
    Planted {
        files: Vec::new(),
        piped: Some(recording.wav(1_000_000, Some(0x7fff_eff0))),
        ..planted
    }
}

fn cut_short(device: &Device, rng: &mut Rng) -> Planted {
    let mut text = short(device, rng).csv(18, true);
    text.truncate(text.len() - rng.usize(1..8));
    replay(("c.csv", text.into_bytes()), &[], true, &["c.csv:", "cut short"])
}

fn decimal_commas(device: &Device, rng: &mut Rng) -> Planted {
    let text = short(device, rng).volts(|n| n as f64 * 1e-6).replace(',', ", ").replace('.', ",");
    replay(
        ("c.csv", text.into_bytes()),
        &["--full-scale-v", "10"],
        true,
        &["c.csv:2: ", "decimal commas"],
    )
}

fn unmarked(device: &Device, rng: &mut Rng) -> Planted {
    let text = short(device, rng).csv(18, true);
    let bytes = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    replay(("c.csv", bytes), &[], true, &["c.csv:1: ", "UTF-16"])
}

/// Two terminals.
fn two(device: &Device, rng: &mut Rng) -> (usize, usize) {
    let count = device.terminals_mm.len();
    let a = rng.usize(0..count);
    let b = (a + rng.usize(1..count)) % count;
    (a.min(b), a.max(b))
}

fn swapped(device: &Device, rng: &mut Rng) -> Planted {
    let (a, b) = two(device, rng);
    let mut recording = record(device, rng);
    recording.samples.iter_mut().for_each(|sample| sample.swap(a, b));
    let words = format!("i{} AND i{}", a + 1, b + 1);
    wav(&recording, &[&words, "ARE SWAPPED"], Some("swapped".into()))
}

fn scaled(device: &Device, rng: &mut Rng, k: usize, by: f64) -> Recording {
    let mut recording = record(device, rng);
    recording.samples.iter_mut().for_each(|sample| sample[k] *= by);
    recording
}

fn reversed(device: &Device, rng: &mut Rng) -> Planted {
    let k = rng.usize(0..device.terminals_mm.len());
    let words = format!("i{} IS REVERSED", k + 1);
    wav(&scaled(device, rng, k, -1.0), &[&words], Some(format!("i{}_reversed", k + 1)))
}

fn sense_reversed(device: &Device, rng: &mut Rng) -> Planted {
    let recording = scaled(device, rng, device.terminals_mm.len(), -1.0);
    wav(&recording, &["v_sense IS REVERSED"], Some("v_sense_reversed".into()))
}

/// 30 % more, or so much less.
fn by(rng: &mut Rng) -> f64 {
    if rng.bool() { 1.3 } else { 0.7 }
}

fn gain(device: &Device, rng: &mut Rng) -> Planted {
    let k = rng.usize(0..device.terminals_mm.len());
    let by = by(rng);
    let words = format!("i{} READS {}", k + 1, if by > 1.0 { "1." } else { "0." });
    wav(&scaled(device, rng, k, by), &[&words], Some("misread".into()))
}

fn slow(device: &Device, rng: &mut Rng) -> Planted {
    let pad = rng.usize(0..device.pads.len());
    let mut slow = device.clone();
    slow.pads[pad].haptic_hz = 60.0 + 300.0 * rng.f64();
    let recording = Recording::of(&slow, 40 * slow.pads.len(), rng);
    wav(&recording, &[&format!("pad {pad}: haptic_v_rms")], None)
}

/// A calibration from a lab's data, which is refused with these words, or warns of them.
fn calibrate(lab: &Lab, refused: bool, words: &[&str]) -> Planted {
    Planted {
        files: vec![
            ("p.csv", lab.places_csv().into_bytes()),
            ("l.csv", lab.loads_csv().into_bytes()),
            ("s.toml", lab.setup.clone().into_bytes()),
        ],
        args: ["calibrate", "p.csv", "l.csv", "s.toml"].map(String::from).to_vec(),
        piped: None,
        refused,
        words: words.iter().map(ToString::to_string).collect(),
        flag: None,
    }
}

fn places(device: &Device, rng: &mut Rng, word: &str, place: impl Fn(f64, f64) -> f64) -> Planted {
    let mut lab = Lab::of(device, rng);
    for (at, _) in &mut lab.places {
        *at = [0, 1].map(|axis| place(at[axis], device.size_mm[axis]));
    }
    calibrate(&lab, true, &["p.csv: x_mm", word])
}

fn kilograms(device: &Device, rng: &mut Rng) -> Planted {
    let mut lab = Lab::of(device, rng);
    lab.loads.iter_mut().for_each(|load| load[0] /= 1000.0);
    calibrate(&lab, true, &["l.csv: load_g", "kilograms"])
}

fn lab_gain(device: &Device, rng: &mut Rng) -> Planted {
    let mut lab = Lab::of(device, rng);
    let k = rng.usize(0..device.terminals_mm.len());
    let by = by(rng);
    lab.places.iter_mut().for_each(|(_, currents)| currents[k] = currents[k].map(|part| part * by));
    calibrate(&lab, false, &[&format!("p.csv: i{} READS {by:.1}", k + 1)])
}

fn lab_swapped(device: &Device, rng: &mut Rng) -> Planted {
    let mut lab = Lab::of(device, rng);
    let (a, b) = two(device, rng);
    lab.places.iter_mut().for_each(|(_, currents)| currents.swap(a, b));
    calibrate(&lab, true, &[&format!("p.csv: i{} and i{} are swapped", a + 1, b + 1)])
}

fn lab_reversed(device: &Device, rng: &mut Rng) -> Planted {
    let mut lab = Lab::of(device, rng);
    let k = rng.usize(0..device.terminals_mm.len());
    lab.places.iter_mut().for_each(|(_, currents)| currents[k] = currents[k].map(|part| -part));
    calibrate(&lab, true, &[&format!("p.csv: i{} is reversed", k + 1)])
}
