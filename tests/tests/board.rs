// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Verilog of whole boards: a top with an ADC at its pins, which counts what its data sheet forbids, and a host at its
//! serial line, which hears the frames that the clocked model gives.

#[path = "../../model/tests/equality/device.rs"]
#[allow(dead_code)]
mod device;
#[path = "../../model/tests/equality/random.rs"]
#[allow(dead_code)]
mod random;

use device::{Sight, calibration, codes};
use hapticore_model::calibration::Calibration;
use hapticore_model::fidelity::clock::ClockSimulation;
use hapticore_model::frame::Frame;
use hapticore_model::profile::Profile;
use hapticore_rtl::board::packet::{Decoder, encode, start};
use hapticore_rtl::board::{Parameters, Target};
use hapticore_rtl::component;
use hapticore_tests::tools;
use random::Random;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const SEED: u64 = 23;
const SLOTS: usize = 5;

/// The board's profile with slots just longer than a packet and small tables, so that Icarus comes to an end.
fn shortened(target: Target) -> Profile {
    let mut profile = target.profile();
    profile.slot.open = 2;
    profile.slot.settle = 420;
    profile.slot.integrate = 4 * profile.carrier.samples_per_period;
    (profile.map.edge_address, profile.map.spacing_address, profile.map.table_address) = (4, 4, 2);
    profile.check().expect("a profile");
    profile
}

fn samples(profile: &Profile) -> Vec<i32> {
    let mut random = Random::new(SEED);
    let sights = [Sight::Tones, Sight::Tones, Sight::Noise, Sight::Broken, Sight::Rails];
    sights.iter().cycle().take(SLOTS).flat_map(|&sight| codes(profile, sight, &mut random)).collect()
}

fn simulated(profile: &Profile, calibration: &Calibration, samples: &[i32]) -> Vec<Frame> {
    let mut simulation = ClockSimulation::new(profile, calibration);
    let mut frames = Vec::new();
    for sample in samples.chunks(profile.channels()) {
        simulation.sample(sample);
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

/// Runs the bench in Icarus: what it said, and the bytes that the host heard.
fn bench(target: Target, profile: &Profile, commands: &[u8], samples: &[i32], folder: &Path) -> (String, Vec<u8>) {
    let Parameters { clock_hz, .. } = target.parameters();
    let width = profile.formats.adc.width;
    let mask = (1u32 << width) - 1;
    let top = target.top_of(profile).expect("the board serves the profile");
    fs::write(folder.join("top.v"), component::verilog(&top)).expect("a file");
    fs::write(folder.join("bytes.hex"), hex(commands.iter().map(|&byte| byte.into()))).expect("a file");
    fs::write(folder.join("codes.hex"), hex(samples.iter().map(|&code| code as u32 & mask))).expect("a file");
    let mut icarus = Command::new("iverilog");
    icarus.args(["-g2005", "-s", "board_bench", "-o", "bench"]);
    for (name, value) in [
        ("BITS", width.to_string()),
        ("SAMPLES", (samples.len() / profile.channels()).to_string()),
        ("BYTES", commands.len().to_string()),
        ("PACKETS", SLOTS.to_string()),
        ("PERIOD", format!("{:.3}", 1e9 / clock_hz as f64)),
        ("ACTIVE_LOW", u8::from(target == Target::Icebreaker).to_string()),
    ] {
        icarus.arg(format!("-Pboard_bench.{name}={value}"));
    }
    tools::run(icarus.arg("top.v").args(bench_files()), folder);
    let said = tools::run(&mut Command::new("./bench"), folder);
    let heard = fs::read_to_string(folder.join("heard.hex")).expect("the bench wrote what it heard");
    (said, heard.lines().map(|line| u8::from_str_radix(line, 16).expect("a known byte")).collect())
}

#[test]
fn boards_tell_over_their_line_what_the_model_computes_from_what_their_adc_saw() {
    if !tools::have(&["iverilog", "vvp"]) {
        return;
    }
    for target in Target::ALL {
        let profile = shortened(target);
        let (calibration, samples) = (calibration(&profile), samples(&profile));
        let commands = encode(&start(&profile, &calibration), &profile);
        let folder = tempfile::tempdir().expect("a folder");
        let (said, heard) = bench(target, &profile, &commands, &samples, folder.path());
        assert_eq!(
            said.lines().filter(|line| !line.contains("$finish")).collect::<Vec<_>>(),
            ["faults 0"],
            "{target:?}"
        );
        let packets: Result<Vec<_>, _> = Decoder::new(&profile).take_all(heard).collect();
        let packets = packets.expect("every packet is whole");
        assert_eq!(packets.len(), SLOTS, "{target:?}");
        for (packet, expected) in packets.iter().zip(simulated(&profile, &calibration, &samples)) {
            assert_eq!(packet.frame, expected, "{target:?}, frame {}", packet.sequence);
            assert!(!(packet.late || packet.refused || packet.overrun), "{target:?}: {packet:?}");
        }
    }
}

#[test]
fn every_port_of_a_top_has_one_pin_of_its_own() {
    for target in Target::ALL {
        let (name, text) = target.constraints();
        assert!(name.starts_with(target.name()), "{name}");
        let locations = text.lines().filter(|line| line.contains("set_io") || line.contains("LOCATE"));
        let mut pins: Vec<&str> =
            locations.map(|line| line.trim_end_matches(';').rsplit(' ').next().unwrap()).collect();
        assert_eq!(pins.len(), 25, "{name}: thirteen ports of a bit, eight data lines and four pads");
        pins.sort_unstable();
        pins.dedup();
        assert_eq!(pins.len(), 25, "{name}: a pin twice");
        assert_eq!(target.name().parse::<Target>().unwrap(), target);
    }
    let error = "arty".parse::<Target>().unwrap_err().to_string();
    assert_eq!(error, "expected a board among ulx3s, icebreaker, got \"arty\"");
}
