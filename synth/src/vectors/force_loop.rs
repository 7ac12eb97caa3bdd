// SPDX-License-Identifier: MIT OR Apache-2.0
//! Vectors of the printed force loop, for `rtl/verilog/cocotb/loop_bench.v` and `test_loop.py`.
//!
//! Split pads on a sheet, each with a carrier of 21 periods per window. The drives rise to a target within the slew,
//! and a slot is abandoned with `clear` a clock after its strobe. The drives begin anew, are cleared, reach their
//! target in one step, and are switched off. Then `clear` comes a clock after a strobe, beside one, and beside the
//! place of a frame, before a pad whose only force is its wall's.
//!
//! | file | holds |
//! | --- | --- |
//! | loop_codes.csv | words that are written before the first sample, as `hapticore codes` prints them |
//! | loop_events.csv | words that are written before a row of samples |
//! | loop_samples.csv | a row a strobe |
//! | loop_drives.csv | a row a drive word, its limits and faults behind it |
//! | loop_frames.csv | a row a word of a frame, flags behind it |
//! | loop_pins.csv | which pad is closed, the carrier, and whether strobes came too early, a row for each clock after reset at which one is new |

use std::f64::consts::TAU;
use std::fmt::Write as _;

use hapticore_contract::calibration::{Calibration, ForceTable};
use hapticore_contract::control::Tuning;
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Block, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::Signal;
use hapticore_model::blocks::force_loop::{ForceLoop, Inputs, Outputs};
use hapticore_rtl::codes::{CalibrationWords, DriveWord, Setting};

use super::calibrations::{Set, sheet};
use super::line;
use crate::sources::File;

/// The profile of `rtl/verilog/loop`.
const PROFILE: &str = include_str!("../../../rtl/verilog/loop.toml");

/// Amplitudes of terminals and sensing voltage, full scale.
const PAD: [f64; 7] = [0.11, 0.09, 0.12, 0.1, 0.08, 0.13, 0.5];

/// The haptic voltage, full scale: the force is below the targets.
const HAPTIC: f64 = 0.08;

/// The word of a frame that is the pad's place along x.
const PLACE_INDEX: i64 = 2;

/// A surface that the pad is within, mm.
const INSIDE_MM: f64 = 200.0;

/// Forces depend on the voltage that a pad has had.
const FORCE: ForceTable = ForceTable {
    rows: [[1.0, 2.0, 1.0]; ForceTable::ROWS],
    recent: 0.25,
    mean: 0.02,
    release: 0.001,
};

/// Largest error of an amplitude in the pads' parts, full scale: their places differ.
const SPREAD: f64 = 0.02;

/// A loop at work, its inputs, and the text of its outputs.
struct Bench {
    block: ForceLoop,
    state: State<ForceLoop, i64>,
    constants: Inputs<i64>,
    asked: usize,
    row: u64,
    written: [String; 2],
    samples: String,
    drives: String,
    frames: String,
    clocks: i64,
    pins: [i64; 4],
    changes: String,
}

/// The outputs of these names.
fn outputs_of<const N: usize>(outputs: Outputs<i64>, names: [&str; N]) -> [i64; N] {
    let mut found = [0; N];
    Outputs::each(outputs, |field, code| {
        if let Some(at) = names.iter().position(|name| *name == field.name) {
            found[at] = code;
        }
    });
    found
}

fn step(block: &ForceLoop, state: &mut State<ForceLoop, i64>, inputs: Inputs<i64>) -> Outputs<i64> {
    let signals = Inputs::map(Inputs::zip(inputs, block.inputs()), |(value, format)| Signal {
        value,
        format,
    });
    Outputs::map(block.step(state, signals), |signal| signal.value)
}

impl Bench {
    fn new(block: ForceLoop) -> Self {
        let text = String::from;
        let flags = "clipped,saturated,invalid,lost,lifted";
        Bench {
            state: block.reset(),
            constants: Inputs::map(block.inputs(), |_| 0),
            block,
            asked: 0,
            row: 0,
            written: [text("name,address,code\n"), text("sample,name,address,code\n")],
            samples: text("i1,i2,i3,i4,i5,i6,v_sense,v_haptic\n"),
            drives: text("pad,drive,low,high,silence,sensor,force\n"),
            frames: format!("pad,index,word,{flags}\n"),
            clocks: 0,
            pins: [-1; 4],
            changes: text("clock,serve,closed,carrier,overrun\n"),
        }
    }

    /// Clocks from a strobe to the one whose outputs are as asked, without running any.
    fn clocks_until(&self, found: impl Fn(Outputs<i64>) -> bool) -> u64 {
        let mut state = self.state.clone();
        let strobe = |clock: u64| self.with(&[("strobe", i64::from(clock == 0))]);
        let mut clocks = 0..self.block.core.latency();
        clocks
            .find(|&clock| found(step(&self.block, &mut state, strobe(clock))))
            .expect("such outputs")
    }

    fn clock(&mut self, inputs: Inputs<i64>) {
        let outputs = step(&self.block, &mut self.state, inputs);
        let [asked, valid, driven] = outputs_of(outputs, ["channel", "valid", "drive_valid"]);
        self.asked = asked as usize;
        let pins = outputs_of(outputs, ["serve", "closed", "carrier", "overrun"]);
        if pins != self.pins {
            self.pins = pins;
            line(&mut self.changes, &[&[self.clocks], &pins[..]].concat());
        }
        self.clocks += 1;
        if valid == 1 {
            let flags = ["clipped", "saturated", "invalid", "lost", "lifted"];
            let word = outputs_of(outputs, ["pad", "index", "frame"]);
            line(&mut self.frames, &[&word[..], &outputs_of(outputs, flags)].concat());
        }
        if driven == 1 {
            let faults = ["silence_fault", "sensor_fault", "force_fault"];
            let word = outputs_of(outputs, ["drive_pad", "drive", "drive_low", "drive_high"]);
            line(&mut self.drives, &[&word[..], &outputs_of(outputs, faults)].concat());
        }
    }

    /// The inputs, with some of other codes.
    fn with(&self, changes: &[(&str, i64)]) -> Inputs<i64> {
        let mut fields = Inputs::FIELDS.iter();
        Inputs::map(self.constants, |old| {
            let name = fields.next().expect("a field of each input").name;
            changes.iter().find(|(of, _)| *of == name).map_or(old, |&(_, code)| code)
        })
    }

    /// Writes a word, before the first sample or before the next.
    fn write(&mut self, name: &str, address: Option<i64>, code: i64) {
        let place = address.map_or(String::new(), |address| address.to_string());
        let text = format!("{name},{place},{code}\n");
        match self.row {
            0 => self.written[0] += &text,
            row => write!(self.written[1], "{row},{text}").expect("a string grows"),
        }
        let at = address.unwrap_or_default();
        match name {
            "clocks" => (),
            "clear" | "tick" | "drives_clear" => self.clock(self.with(&[(name, 1)])),
            "clear_and_strobe" => self.clock(self.with(&[("clear", 1), ("strobe", 1)])),
            "position_table" => {
                self.clock(self.with(&[("write", 1), ("address", at), ("word", code)]));
            }
            "curve_word" => {
                let words = [("curve_write", 1), ("curve_address", at), ("curve_word", code)];
                self.clock(self.with(&words));
            }
            "target_word" => {
                let words = [("target_write", 1), ("target_pad", at), ("target_word", code)];
                self.clock(self.with(&words));
            }
            "wall_surface" => {
                let words = [("wall_write", 1), ("wall_pad", at), ("wall_surface", code)];
                self.clock(self.with(&words));
            }
            _ => self.constants = self.with(&[(name, code)]),
        }
    }

    /// A strobe, and clocks until the next.
    fn sample(&mut self, codes: &[i64], clocks: u64) {
        line(&mut self.samples, codes);
        self.row += 1;
        for step in 0..clocks {
            let code = codes[self.asked];
            self.clock(self.with(&[("strobe", i64::from(step == 0)), ("code", code)]));
        }
    }
}

/// The code of a controller's word.
fn code(profile: &Profile, word: DriveWord, value: f64) -> i64 {
    word.format(profile).expect("a loop").code_saturating(value)
}

/// What is written before the first sample: calibration, tuning, walls.
fn prepare(bench: &mut Bench, profile: &Profile) {
    let calibration = Calibration { force_table: FORCE, ..sheet(profile, Set::Sheet) };
    let words = CalibrationWords::new(profile, &calibration);
    for word in words.constants {
        bench.write(word.constant.name(), None, word.code);
    }
    (0..)
        .zip(&words.table)
        .for_each(|(address, &code)| bench.write("position_table", Some(address), code));
    let control = profile.control.as_ref().expect("a loop");
    let set = |setting: Setting, value: f64| code(profile, DriveWord::Setting(setting), value);
    let cells = control.cells as f64;
    let tuning = Tuning::idle(control);
    for (address, _) in (0..).zip(&tuning.curve) {
        let word = code(profile, DriveWord::Curve(0), 0.7 * address as f64 / cells);
        bench.write("curve_word", Some(address), word);
    }
    for (name, setting, value) in [
        ("full_drive", Setting::FullDrive, 2.0),
        ("proportional", Setting::Proportional, 0.3),
        ("correction", Setting::Correction, 0.2),
        ("rail", Setting::Rail, 0.5),
        ("slew", Setting::Slew, 0.2),
        ("force_cap", Setting::ForceCap, 3.0),
        ("wall_stiffness", Setting::Stiffness, 0.05),
        ("wall_most", Setting::Most, 0.5),
        ("wall_factory", Setting::Factory, 0.01),
    ] {
        bench.write(name, None, set(setting, value));
    }
    for pad in 0..profile.pads as i64 {
        let word = DriveWord::Surface { pad: pad as u8, right: false };
        let surface = code(profile, word, 5.0 * pad as f64);
        bench.write("wall_surface", Some(pad), surface);
    }
    bench.write("enable", None, 1);
    bench.write("tick", None, 1);
}

/// The codes of a sample of the window, in a slot of this number.
fn codes(profile: &Profile, number: u64, sample: u64) -> Vec<i64> {
    let format: Format = profile.formats.adc;
    let turns = |cycles: u64| {
        (cycles * sample % profile.slot.integrate) as f64 / profile.slot.integrate as f64
    };
    let carrier = (TAU * (turns(profile.carrier.periods) + 0.07)).sin();
    let part = |channel: usize| SPREAD * ((number as usize * 7 + channel * 5) % 11) as f64 / 10.0;
    let amplitudes = (0..PAD.len()).map(|channel| (PAD[channel] + part(channel)) * carrier);
    amplitudes.chain([HAPTIC]).map(|value| format.code_saturating(value)).collect()
}

/// A slot, or the first samples of one, whose last strobe is too early and a clock before `clear`.
fn slot(bench: &mut Bench, profile: &Profile, number: u64, cut: Option<u64>) {
    let blanking = profile.slot.blanking();
    for sample in 0..cut.unwrap_or(profile.slot.samples()) {
        let codes = match sample.checked_sub(blanking) {
            Some(sample) => codes(profile, number, sample),
            None => vec![0; profile.channels()],
        };
        let is_early = cut.is_some_and(|cut| sample + 2 >= cut);
        if cut == Some(sample + 2) {
            bench.write("clocks", None, 1);
        }
        bench.sample(&codes, if is_early { 1 } else { profile.clocks_per_sample });
    }
    if cut.is_some() {
        // Until the next strobe is due.
        (0..profile.clocks_per_sample).for_each(|_| bench.write("clear", None, 1));
        bench.write("clocks", None, profile.clocks_per_sample as i64);
    }
}

/// Clears a clock after a strobe, beside a strobe, and beside the last part's place; then the pad's wall, and a turn.
fn clear_beside(bench: &mut Bench, profile: &Profile) {
    let (parts, last) = (profile.pads, profile.pads as i64 - 1);
    let open = vec![0; profile.channels()];
    let until_next = profile.clocks_per_sample as i64;
    bench.write("enable", None, 1);
    bench.write("clocks", None, 1);
    bench.sample(&open, 1);
    bench.write("clear", None, 1);
    bench.write("clocks", None, until_next);
    bench.sample(&open, profile.clocks_per_sample);
    bench.write("clear_and_strobe", None, 1);
    let of_place = [1, PLACE_INDEX, last];
    let clocks =
        bench.clocks_until(|outputs| outputs_of(outputs, ["valid", "index", "pad"]) == of_place);
    bench.write("clocks", None, clocks as i64);
    bench.sample(&open, clocks);
    bench.write("clear", None, 1);
    bench.write("clocks", None, until_next);
    let surface = code(profile, DriveWord::Surface { pad: last as u8, right: false }, INSIDE_MM);
    bench.write("wall_surface", Some(last), surface);
    (0..parts).for_each(|part| slot(bench, profile, part, None));
    slot(bench, profile, 0, None);
}

/// All files of the force loop's vectors.
pub fn files() -> Vec<File> {
    let profile = Profile::parse(PROFILE).expect("the profile of the committed loop");
    let mut bench = Bench::new(ForceLoop::try_new(&profile).expect("the committed loop"));
    prepare(&mut bench, &profile);
    let (parts, last) = (profile.pads, profile.pads as i64 - 1);
    let target = |newtons: f64| code(&profile, DriveWord::Target(0), newtons);
    let turn = |bench: &mut Bench| (0..parts).for_each(|part| slot(bench, &profile, part, None));
    bench.write("target_word", Some(last), target(0.3));
    turn(&mut bench);
    bench.write("target_word", Some(last), target(0.5));
    slot(&mut bench, &profile, parts, None);
    // Within the window of the second part: what `clear` leaves shows in the frame after it.
    slot(&mut bench, &profile, parts + 1, Some(profile.slot.blanking() + 1));
    bench.write("target_word", Some(last), target(0.5));
    turn(&mut bench);
    // The drive word of a turn is made in the first slot of the next.
    slot(&mut bench, &profile, 0, None);
    bench.write("drives_clear", None, 1);
    bench.write("slew", None, code(&profile, DriveWord::Setting(Setting::Slew), 0.9));
    (1..parts).for_each(|part| slot(&mut bench, &profile, part, None));
    slot(&mut bench, &profile, 0, None);
    bench.write("enable", None, 0);
    (1..parts).for_each(|part| slot(&mut bench, &profile, part, None));
    clear_beside(&mut bench, &profile);
    (0..bench.block.core.latency() + 100).for_each(|_| bench.clock(bench.constants));
    let [codes, events] = bench.written;
    let file = |name: &str, text: String| File { name: format!("loop_{name}.csv"), text };
    vec![
        file("codes", codes),
        file("events", events),
        file("samples", bench.samples),
        file("drives", bench.drives),
        file("frames", bench.frames),
        file("pins", bench.changes),
    ]
}
