// SPDX-License-Identifier: MIT OR Apache-2.0
//! Vectors for users of the Verilog who have no Rust: calibrations, slots of samples, and the
//! frames and pins that follow.
//!
//! `rtl/verilog/vectors/` holds them for the small profile; `synth/run vectors` makes them, a test
//! holds them fresh. The first slots are pads somewhere on a sheet, a carrier of five samples per
//! period with some noise; the others are what breaks a careless core. No plant is behind them.
//! `tests/tests/vectors.rs` holds that they notice faults.
//!
//! | file | holds |
//! | --- | --- |
//! | calibration.csv | what is written before which row of samples: a constant by its port, a word of the table by its address, `clocks` from one strobe to the next, or `clear` for a clock |
//! | samples.csv | a row a strobe |
//! | frames.csv | a row a word of a frame, flags behind it |
//! | loop_*.csv | the same for the printed force loop, see `force_loop` |
//! | pins.csv | the other outputs, a row for each clock after reset at which one of them is new |

mod calibrations;
mod force_loop;
mod slots;

use crate::sources::File;
use calibrations::Set;
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Block, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::Signal;
use hapticore_model::blocks::core::{Core, Inputs, Outputs};
use hapticore_model::blocks::position::TablePort;
use slots::{CHANNELS, Slot};
use std::fmt::Write as _;

/// The profile that they are for.
pub const PROFILE: &str = "small";

/// Clocks after the last sample: longer than a frame takes.
const REST: u64 = 10_000;

/// Slots, what is written for their frames, and what their numbers begin with. Those with numbers
/// above 12 were found among thousands drawn so, as the ones that notice faults that others do not:
/// a sum whose bits end just so, say.
const SLOTS: [(Slot, Option<Set>, u32); 37] = [
    (Slot::Any, Some(Set::Sheet), 1000),
    (Slot::Pad, None, 1),
    (Slot::Pad, None, 2),
    (Slot::Pad, None, 3),
    (Slot::Faint, Some(Set::Constants), 1015),
    (Slot::Loud, Some(Set::Constants), 1142),
    (Slot::OpenTerminal, None, 4),
    (Slot::NoVoltage, None, 5),
    (Slot::OneSide(true), Some(Set::Constants), 1001),
    (Slot::OneSide(false), Some(Set::Constants), 1002),
    (Slot::Any, Some(Set::Behind), 1160),
    (Slot::Offset, Some(Set::Constants), 1173),
    (Slot::Noise, None, 6),
    (Slot::Silence, None, 7),
    (Slot::Any, Some(Set::Powers), 1220),
    (Slot::Any, Some(Set::Constants), 1236),
    (Slot::Abandoned, None, 8),
    (Slot::FullScale, None, 9),
    (Slot::Loud, Some(Set::Corners), 1290),
    (Slot::Faint, Some(Set::Constants), 1291),
    (Slot::Late, Some(Set::Constants), 10),
    (Slot::Alike(1), Some(Set::Constants), 11),
    (Slot::Pad, Some(Set::Sheet), 12),
    (Slot::Any, None, 7),
    (Slot::Whisper, None, 9),
    (Slot::Halfway, None, 9),
    (Slot::PowerSum, None, 5),
    (Slot::Any, Some(Set::Constants), 95),
    (Slot::Cancelling, Some(Set::Constants), 152),
    (Slot::Pad, Some(Set::Constants), 3668),
    (Slot::Pad, Some(Set::Constants), 1507),
    (Slot::Pad, Some(Set::Flat(31_691)), 11),
    // Of the last pad: whatever `clear` leaves of pad, count or window shows in the slot after it.
    (Slot::Cut(351), None, 12),
    (Slot::Pad, None, 13),
    (Slot::Cut(1), None, 14),
    (Slot::Cut(850), None, 15),
    (Slot::Pad, None, 16),
];

/// Numbers without a pattern, the same everywhere.
struct Noise(u32);

impl Noise {
    fn below(&mut self, most: u32) -> i64 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        i64::from((self.0 >> 16) % most)
    }

    /// Any code of a format of sixteen bits at most.
    fn any(&mut self, format: Format) -> i64 {
        format.min_code() as i64 + self.below(1 << format.width)
    }
}

/// A core at work, its inputs, and the text of its outputs.
struct Bench {
    core: Core,
    state: State<Core, i64>,
    constants: Inputs<i64>,
    asked: i64,
    clock: u64,
    pins: [i64; 5],
    row: u64,
    written: String,
    samples: String,
    frames: String,
    changes: String,
}

/// A line of a file that holds these.
fn line(text: &mut String, codes: &[i64]) {
    let codes: Vec<_> = codes.iter().map(i64::to_string).collect();
    *text += &(codes.join(",") + "\n");
}

impl Bench {
    fn new(core: Core) -> Self {
        let text = String::from;
        Bench {
            state: core.reset(),
            constants: Inputs::map(core.inputs(), |_| 0),
            core,
            asked: 0,
            clock: 0,
            pins: [-1; 5],
            row: 0,
            written: text("sample,what,code\n"),
            samples: text("i1,i2,i3,i4,i5,i6,v_sense,v_haptic\n"),
            frames: text("pad,index,word,clipped,saturated,invalid,lost,lifted\n"),
            changes: text("clock,serve,closed,carrier,done,overrun\n"),
        }
    }

    fn clock(&mut self, inputs: Inputs<i64>) {
        let formats = self.core.inputs();
        let signals =
            Inputs::map(Inputs::zip(inputs, formats), |(value, format)| Signal { value, format });
        let o = Outputs::map(self.core.step(&mut self.state, signals), |signal| signal.value);
        self.asked = o.channel;
        let f = o.frames;
        if f.valid == 1 {
            line(
                &mut self.frames,
                &[f.pad, f.index, f.frame, f.clipped, f.saturated, f.invalid, f.lost, f.lifted],
            );
        }
        let pins = [o.serve, o.closed, o.carrier, f.done, o.overrun];
        if pins != self.pins {
            self.pins = pins;
            line(&mut self.changes, &[&[self.clock as i64], &pins[..]].concat());
        }
        self.clock += 1;
    }

    /// What stands in a row of the calibration.
    fn write(&mut self, what: &str, code: i64) {
        writeln!(self.written, "{},{what},{code}", self.row).expect("a string grows");
        if let Ok(address) = what.parse() {
            self.clock(self.constants.with_table(TablePort { write: 1, address, word: code }));
        } else if what == "clear" {
            self.clock(Inputs { clear: 1, ..self.constants });
        } else {
            let mut fields = Inputs::FIELDS.iter();
            let mut is_meant = || fields.next().is_some_and(|field| field.name == what);
            self.constants = Inputs::map(self.constants, |old| if is_meant() { code } else { old });
        }
    }

    /// A strobe, and clocks until the next.
    fn sample(&mut self, codes: &[i64; CHANNELS], clocks: u64) {
        line(&mut self.samples, codes);
        self.row += 1;
        for step in 0..clocks {
            let code = codes[self.asked as usize];
            self.clock(Inputs { strobe: i64::from(step == 0), code, ..self.constants });
        }
    }
}

/// A slot. What is written for its frame comes when the frame before is out, but long before its
/// own is computed.
fn slot(bench: &mut Bench, profile: &Profile, slot: Slot, set: Option<Set>, noise: &mut Noise) {
    let usual = profile.clocks_per_sample;
    let (tones, blanking, samples) =
        (slot.tones(noise), profile.slot.blanking(), profile.slot.samples());
    let (mut clocks, writing) = (usual, if bench.row == 0 { 0 } else { samples - 20 });
    for sample in 0..slot.samples(samples) {
        if sample == writing {
            let written = set.map(|set| set.written(profile, noise)).unwrap_or_default();
            written.iter().for_each(|(what, code)| bench.write(what, *code));
        }
        // Whatever comes while the pad settles is ignored.
        let window = sample.checked_sub(blanking);
        let codes = window.map_or([0; CHANNELS], |sample| slot.codes(&tones, sample, noise));
        let next = window.map_or(usual, |sample| slot.clocks(sample, usual));
        let next = if slot == Slot::Cut(sample + 1) { 1 } else { next };
        if next != clocks {
            clocks = next;
            bench.write("clocks", clocks as i64);
        }
        bench.sample(&codes, clocks);
    }
    if slot.is_abandoned() {
        bench.write("clear", 1);
    }
    if clocks != usual {
        // Until the next strobe is due.
        (1..usual).for_each(|_| bench.write("clear", 1));
        bench.write("clocks", usual as i64);
    }
}

/// All files of the vectors.
pub fn files() -> Vec<File> {
    let profile = Profile::bundled(PROFILE).expect("a bundled profile");
    let mut bench = Bench::new(Core::new(&profile));
    assert!(bench.core.latency() < REST, "the last frame comes");
    for (kind, set, seed) in SLOTS {
        slot(&mut bench, &profile, kind, set, &mut Noise(seed));
    }
    (0..REST).for_each(|_| bench.clock(bench.constants));
    let file = |name: &str, text: String| File { name: name.into(), text };
    let mut files = vec![
        file("calibration.csv", bench.written),
        file("samples.csv", bench.samples),
        file("frames.csv", bench.frames),
        file("pins.csv", bench.changes),
    ];
    files.extend(force_loop::files());
    files
}
