// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Verilog of whole boards: a top with an ADC at its pins, which counts what its data sheet
//! forbids, and a host at its serial line, which hears the frames that the clocked model gives.

#[path = "../../model/tests/equality/device.rs"]
#[allow(dead_code)]
mod device;
#[path = "../../model/tests/equality/random.rs"]
#[allow(dead_code)]
mod random;
#[path = "board/recording.rs"]
mod recording;

use std::sync::Arc;

use device::{Sight, calibration, codes};
use hapticore_contract::calibration::Calibration;
use hapticore_contract::control::{Control, Law, Tuning};
use hapticore_contract::frame::Frame;
use hapticore_contract::profile::Profile;
use hapticore_host::startup::{AdcSetup, check, prepare};
use hapticore_host::{Command as BoardCommand, Decoder, Message, Packet, drive, encode};
use hapticore_host::{Constant, WordFormats};
use hapticore_model::blocks::core::Core;
use hapticore_model::fidelity::clock::ClockSimulation;
use hapticore_model::fidelity::force_loop::FixedLoop;
use hapticore_rtl::board::drive_output::serial::Frame as SerialFrame;
use hapticore_rtl::board::drive_output::{Converter, Wave};
use hapticore_rtl::board::framing::Register;
use hapticore_rtl::board::parameters::Drive;
use hapticore_rtl::board::{Parameters, Target};
use hapticore_run::case::Case;
use hapticore_run::engine::Fidelity;
use hapticore_run::engine::{Slot, engine};
use hapticore_run::inputs;
use hapticore_run::maker::Maker;
use hapticore_synth::certificates::Subject;
use hapticore_tests::tools;
use random::Random;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const SEED: u64 = 23;
const SLOTS: usize = 5;
/// Commands while frames come.
const STORM: usize = 16;

/// The board's profile with slots just longer than a packet and small tables, so that Icarus comes
/// to an end.
fn shortened(target: Target) -> Profile {
    let mut profile = target.profile();
    profile.slot.open = 2;
    // With `open` whole periods of five samples, as polyphase sums ask.
    profile.slot.settle = 423;
    let samples = 4 * profile.samples_per_period().round() as u64;
    profile = profile.with_window(samples);
    (profile.position.columns, profile.position.rows) = (17, 11);
    hapticore_model::check(&profile).expect("a profile");
    profile
}

fn samples(profile: &Profile) -> Vec<i32> {
    let sights = [Sight::Tones, Sight::Tones, Sight::Noise, Sight::Broken, Sight::FullScale];
    samples_of(profile, sights)
}

fn samples_of(profile: &Profile, sights: [Sight; SLOTS]) -> Vec<i32> {
    let mut random = Random::new(SEED);
    sights.iter().flat_map(|&sight| codes(profile, sight, &mut random)).collect()
}

fn simulated(profile: &Profile, calibration: &Calibration, samples: &[i32]) -> Vec<Frame> {
    let mut simulation = ClockSimulation::new(profile, calibration);
    let mut frames = Vec::new();
    for sample in samples.chunks(profile.channels()) {
        simulation.samples(sample);
        frames.extend(simulation.take_frame());
    }
    frames.extend(simulation.finish_slot());
    frames
}

/// A line of hexadecimal digits for each word.
fn hex(words: impl IntoIterator<Item = u32>) -> String {
    words.into_iter().map(|word| format!("{word:x}\n")).collect()
}

fn bench_files() -> [PathBuf; 3] {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../rtl/verilog/sim");
    ["board_bench.v", "adc_model.v", "lattice_cells.v"].map(|file| folder.join(file))
}

/// What runs a bench.
#[derive(Debug, Clone, Copy)]
enum Simulator {
    /// Some fifty thousand clocks per second.
    Icarus,
    /// Thirty times as many, once compiled.
    Verilator,
}

impl Simulator {
    /// Compiles and runs the bench with these parameters; its output.
    fn run(self, drives: bool, parameters: &[(&str, String)], folder: &Path) -> String {
        let mut compiler = match self {
            Simulator::Icarus => Command::new("iverilog"),
            Simulator::Verilator => Command::new("verilator"),
        };
        let prefix = match self {
            Simulator::Icarus => {
                compiler.args(["-g2005", "-s", "board_bench", "-o", "bench"]);
                "-Pboard_bench."
            }
            Simulator::Verilator => {
                // The bench and rust-hdl's wrappers are not the printed core: their style is no
                // matter here.
                compiler.args([
                    "--binary",
                    "--timing",
                    "-O3",
                    "-CFLAGS",
                    "-O2",
                    "-Wno-lint",
                    "-Wno-fatal",
                    "-j",
                    "2",
                ]);
                compiler.args(["--top-module", "board_bench", "--Mdir", ".", "-o", "bench"]);
                "-G"
            }
        };
        compiler.args(drives.then_some("-DDRIVE"));
        for (name, value) in parameters {
            compiler.arg(format!("{prefix}{name}={value}"));
        }
        tools::run(compiler.arg("top.v").args(bench_files()), folder);
        tools::run(&mut Command::new("./bench"), folder)
    }
}

/// Runs the bench: its output, and the bytes that the host received.
fn bench(
    simulator: Simulator,
    (target, profile): (Target, &Profile),
    commands: &[u8],
    samples: &[i32],
    folder: &Path,
) -> (String, Vec<u8>) {
    let Parameters { clock_hz, .. } = target.parameters();
    let width = profile.formats.adc.width;
    let mask = (1u32 << width) - 1;
    let drive = profile.control.as_ref().map(|_| DRIVE.into());
    let printed = target.printed(profile, drive).expect("the board serves the profile");
    let files = [
        ("top.v", printed.verilog),
        ("bytes.hex", hex(commands.iter().map(|&byte| byte.into()))),
        ("codes.hex", hex(samples.iter().map(|&code| code as u32 & mask))),
    ];
    for (name, text) in &files {
        fs::write(folder.join(name), text).expect("a file");
    }
    let parameters = [
        ("BITS", width.to_string()),
        ("SAMPLES", (samples.len() / profile.channels()).to_string()),
        ("BYTES", commands.len().to_string()),
        ("PACKETS", SLOTS.to_string()),
        ("PERIOD", format!("{:.3}", 1e9 / clock_hz as f64)),
        ("ACTIVE_LOW", u8::from(target == Target::Icebreaker).to_string()),
    ];
    let bench = ["rtl/verilog/sim", "tests/tests/board.rs"];
    let how = format!("{simulator:?} {parameters:?} {}", drive.is_some());
    let subject =
        files.iter().fold(Subject::new().and(how), |subject, (_, text)| subject.and(text));
    let verdict = subject.and_files(&bench).verdict(&format!("board: {target:?}"), || {
        // A verdict names no folder of this machine.
        let log = simulator.run(drive.is_some(), &parameters, folder);
        let log = log.replace(concat!(env!("CARGO_MANIFEST_DIR"), "/../"), "");
        let outputs = OUTPUTS.map(|name| fs::read_to_string(folder.join(name)).unwrap_or_default());
        let [heard, converter] = outputs;
        [log, heard, converter].map(|text| text.replace('\n', " ; ")).join(" | ")
    });
    let [log, outputs @ ..] = lines(&verdict);
    for (name, text) in OUTPUTS.iter().zip(&outputs) {
        fs::write(folder.join(name), text).expect("a file");
    }
    let heard = outputs[0].lines();
    (log, heard.map(|line| u8::from_str_radix(line, 16).expect("a known byte")).collect())
}

/// What the bench writes: the bytes that the host heard, and the words that the converter did.
const OUTPUTS: [&str; 2] = ["heard.hex", "dac.hex"];

/// The texts of a verdict, its output and [`OUTPUTS`], in lines again.
fn lines(verdict: &str) -> [String; 3] {
    let texts: Vec<_> = verdict.split(" | ").map(|text| text.replace(" ; ", "\n")).collect();
    texts.try_into().expect("three texts")
}

#[test]
#[cfg_attr(
    not(all(tool = "iverilog", tool = "vvp")),
    ignore = "needs iverilog, vvp: ./test fetches what is missing"
)]
fn boards_tell_over_their_line_what_the_model_computes_from_what_their_adc_saw() {
    for target in Target::ALL {
        let profile = shortened(target);
        let (calibration, samples) = (calibration(&profile), samples(&profile));
        let folder = tempfile::tempdir().expect("a folder");
        let given = (&calibration, &[][..]);
        let (packets, _) =
            heard(Simulator::Icarus, (target, &profile), given, &samples, folder.path());
        let heard: Vec<_> = packets.iter().map(|packet| packet.frame).collect();
        assert_eq!(heard, simulated(&profile, &calibration, &samples), "{target:?}");
    }
}

/// A board as it is, with the codes of `hockey`, returns what `simulate` makes of them.
fn returns_what_simulate_gives(target: Target, simulator: Simulator) {
    let profile = target.profile();
    let scene = Arc::new(inputs::scene("hockey", &[]).expect("bundled"));
    let case = Case::new(&scene, 0, &profile, &[]).expect("a case");
    assert_eq!(*case.profile, profile, "the scene has as many pads as the board");
    let calibration = case.device.for_profile(&profile).expect("a calibration");
    let mut maker = Maker::new(case.plant().expect("a plant"), &profile, true, true);
    let mut engine = engine(Fidelity::Clock, &case.profile, &calibration);
    let (mut samples, mut expected) = (Vec::new(), Vec::new());
    for number in 0..SLOTS {
        let slot = Slot { pad: number % profile.pads as usize, signals: maker.sample(number).0 };
        samples.extend_from_slice(slot.whole());
        expected.extend(engine.slot(&slot));
    }
    expected.extend(engine.finish());
    let folder = tempfile::tempdir().expect("a folder");
    let given = (&calibration, &[][..]);
    let (packets, bytes) = heard(simulator, (target, &profile), given, &samples, folder.path());
    let measurements: Vec<_> =
        packets.iter().map(|packet| packet.frame.measurement(&profile)).collect();
    assert_eq!(measurements, expected);
    if target == Target::Icebreaker {
        recording::check(&bytes[bytes.len() - recording::BYTES..], &profile, &case.device);
    }
}

#[test]
#[cfg_attr(
    not(all(tool = "iverilog", tool = "vvp", tool = "verilator", tool = "g++")),
    ignore = "needs iverilog, vvp, verilator, g++: ./test fetches what is missing"
)]
fn icebreaker_returns_over_its_line_the_frames_that_simulate_gives() {
    returns_what_simulate_gives(Target::Icebreaker, Simulator::Verilator);
}

#[test]
#[cfg_attr(
    not(all(tool = "iverilog", tool = "vvp", tool = "verilator", tool = "g++")),
    ignore = "needs iverilog, vvp, verilator, g++: ./test fetches what is missing"
)]
fn ulx3s_returns_over_its_line_the_frames_that_simulate_gives() {
    // The calibration alone takes ten million clocks.
    returns_what_simulate_gives(Target::Ulx3s, Simulator::Verilator);
}

/// A converter whose words are the drive words, as they are.
const DRIVE: (Wave, Converter) = (Wave::Dc, Converter::Serial(SerialFrame::AD5664));

/// A controller whose drive is most of its target's root.
fn tuning(control: &Control) -> Tuning {
    let cells = control.cells as f64;
    let curve = (0..=control.cells).map(|cell| 0.9 * cell as f64 / cells).collect();
    Tuning { curve, full_drive: 2.0, slew: 0.2, ..Tuning::idle(control) }
}

#[test]
#[cfg_attr(
    not(all(tool = "verilator", tool = "g++")),
    ignore = "needs verilator, g++: ./test fetches what is missing"
)]
fn ulx3s_gives_its_converter_the_drive_words_of_the_force_loop() {
    let (target, targets_n) = (Target::Ulx3s, [0.3, 0.8, 0.05, 0.5]);
    let plain = shortened(target);
    let control = Control::of(&plain, Law::Inverse);
    let tuning = tuning(&control);
    let mut profile = Profile { control: Some(control), ..plain };
    profile.slot.settle += 400;
    // No broken line, and no noise, in which terminals are open: either takes the drive away.
    let mut sights = [Sight::Tones; SLOTS];
    sights[SLOTS - 1] = Sight::FullScale;
    let (calibration, samples) = (calibration(&profile), samples_of(&profile, sights));
    let mut commands = drive::tune(&profile, &tuning).expect("a controller");
    let mut of = FixedLoop::new(&profile, &calibration, &tuning).expect("a force loop");
    for (pad, newtons) in (0..).zip(targets_n) {
        commands.push(drive::target(&profile, pad, newtons).expect("a controller"));
        of.set_target(pad.into(), newtons);
    }
    let folder = tempfile::tempdir().expect("a folder");
    let given = (&calibration, &commands[..]);
    let (packets, _) =
        heard(Simulator::Verilator, (target, &profile), given, &samples, folder.path());
    let slots = samples.chunks(profile.channels() * profile.slot.samples() as usize);
    let blanking = profile.channels() * profile.slot.blanking() as usize;
    let expected: Vec<_> = (0..)
        .zip(slots)
        .map(|(slot, codes)| of.slot(|core| core.slot(slot % 4, &codes[blanking..])))
        .collect();
    for (number, (packet, (frame, _))) in packets.iter().zip(&expected).enumerate() {
        assert_eq!(packet.frame, *frame, "frame {number}");
        let driven = packet.status.driven.expect("a board with a drive");
        assert!(driven.live && !driven.faults.any(), "frame {number}: {frame:?}, {driven:?}");
    }
    let told = fs::read_to_string(folder.path().join("dac.hex")).expect("what the converter heard");
    let told = told.lines().map(|line| u32::from_str_radix(line, 16).expect("a known frame"));
    let told: Vec<(u32, u32)> = told.map(|frame| (frame >> 16, frame & 0xffff)).collect();
    // Write and update channel n: 18 + n (hex). Channels are set to 0 V after the reset; the first drive word sets the
    // converter up, the other channels with 0 V.
    let zeros = |from: u32| (from..4).map(|pad| (0x18 + pad, 0));
    let words = expected.iter().filter_map(|(_, drive)| drive.as_ref()).map(|drive| {
        (0x18 + drive.pad as u32, (drive.fraction * 65536.0).round_ties_even() as u32)
    });
    let words: Vec<_> = words.collect();
    let begin = zeros(0).chain([words[0]]).chain(zeros(1));
    let words: Vec<_> = begin.chain(words[1..].iter().copied()).collect();
    assert!(told.len() >= 8 + SLOTS - 2, "{told:x?}");
    assert_eq!(told, words[..told.len()]);
    assert!(told[8..].iter().any(|&(_, code)| code > 0), "something is driven");
}

/// Commands that change nothing, to be taken while frames come: a register's own code, with any
/// bits in the bytes that the register has not, and words beyond the map.
fn storm(profile: &Profile, calibration: &Calibration) -> Vec<BoardCommand> {
    let (mut random, gain) = (
        Random::new(SEED),
        Register::Constant(Constant::ForceGain).format(&WordFormats::new(profile)),
    );
    let own = Core::new(profile).idle_inputs(calibration).calibration.force_gain;
    let any = |random: &mut Random| random.bits() as i64;
    let of_gain = |random: &mut Random| own | any(random) & 0xffff << gain.width;
    let adc = |random: &mut Random| BoardCommand::Register(Register::Adc, any(random) & 0xffff);
    let one = |k| {
        if k % 2 == 0 {
            adc(&mut random)
        } else {
            BoardCommand::Register(Register::Constant(Constant::ForceGain), of_gain(&mut random))
        }
    };
    (0..STORM).map(one).collect()
}

/// The frames that a board's host hears, and the bytes that they came in, after it has sent the
/// calibration: heartbeats that say so before them, nothing else, and no fault of the ADC's pins,
/// whatever else the host then sends.
fn heard(
    simulator: Simulator,
    (target, profile): (Target, &Profile),
    (calibration, tuned): (&Calibration, &[BoardCommand]),
    samples: &[i32],
    folder: &Path,
) -> (Vec<Packet>, Vec<u8>) {
    let setup = AdcSetup::default();
    let prepared = [&prepare(profile, calibration, &setup), tuned].concat();
    let mut commands = prepared.clone();
    // The time of a heartbeat and more.
    commands.extend([BoardCommand::DISABLE; 64]);
    let taken = commands.len() + 1;
    commands.push(BoardCommand::ENABLE);
    let storm = storm(profile, calibration);
    let commands = encode(&[commands.as_slice(), &storm].concat(), profile);
    let (log, heard) = bench(simulator, (target, profile), &commands, samples, folder);
    let log: Vec<_> =
        log.lines().filter(|line| !line.contains("$finish") && !line.starts_with("- ")).collect();
    assert_eq!(log, [format!("faults 0, commands {}", setup.words().len())], "{target:?}");
    let told: Result<Vec<_>, _> = Decoder::new(profile).decode(heard.iter().copied()).collect();
    let told = told.expect("every packet is whole");
    let mut heartbeats = told.iter().filter_map(|told| {
        if let Message::Heartbeat(heartbeat) = told { Some(heartbeat) } else { None }
    });
    let last = heartbeats.next_back().expect("the board told that it was there");
    let output = profile.control.as_ref().map(|_| Drive::from(DRIVE).output(target.clock_hz()));
    let before = (16 + last.status.commands - (prepared.len() % 16) as u8) % 16;
    assert_eq!(
        check(last, profile, output.as_ref(), calibration, (before, prepared.len())),
        Ok(()),
        "{target:?}"
    );
    let packets: Vec<_> = told.iter().filter_map(|told| told.frame()).collect();
    assert_eq!(packets.len(), SLOTS, "{target:?}");
    assert!(
        packets.iter().any(|packet| packet.status.refused),
        "{target:?}: the ADC is not spoken to while enabled"
    );
    assert_eq!(
        packets[SLOTS - 1].status.commands,
        ((taken + STORM / 2) % 16) as u8,
        "{target:?}: all but those were taken"
    );
    for packet in &packets {
        assert!(!(packet.status.late || packet.status.overrun), "{target:?}: {packet:?}");
    }
    (packets, heard)
}

/// Holds that so many bits of a top's ports have a pin each.
fn has_pins((name, text): (String, String), count: usize) {
    let locations = text.lines().filter(|line| line.contains("set_io") || line.contains("LOCATE"));
    let mut pins: Vec<&str> =
        locations.map(|line| line.trim_end_matches(';').rsplit(' ').next().unwrap()).collect();
    assert_eq!(pins.len(), count, "{name}: ports of a bit, eight data lines and four pads");
    pins.sort_unstable();
    pins.dedup();
    assert_eq!(pins.len(), count, "{name}: a pin twice");
}

#[test]
fn every_port_of_a_top_has_one_pin_of_its_own() {
    for target in Target::ALL {
        let constraints = target.bundled().constraints;
        assert!(constraints.0.starts_with(target.name()), "{}", constraints.0);
        has_pins(constraints, 13 + 8 + 4);
        assert_eq!(target.name().parse::<Target>().unwrap(), target);
    }
    let profile = Target::Ulx3s.profile();
    let control = Some(Control::of(&profile, Law::Inverse));
    let driven = Target::Ulx3s.printed(&Profile { control, ..profile }, Some(DRIVE.into()));
    has_pins(driven.expect("a board with a drive").constraints, 17 + 8 + 4 + 4);
    let error = "arty".parse::<Target>().unwrap_err().to_string();
    assert_eq!(error, "expected a board among ulx3s, icebreaker, got \"arty\"");
}
