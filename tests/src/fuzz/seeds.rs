// SPDX-License-Identifier: MIT OR Apache-2.0
//! What fuzzing begins with: small inputs of every kind that are accepted, made of what is bundled.

use std::fmt::Write;

use fastrand::Rng;
use hapticore_contract::control::{Control, Law};
use hapticore_contract::frame::{Field, Flags, Frame};
use hapticore_contract::profile::{BUNDLED, Profile, Wall};
use hapticore_host::{
    Command, DeviceCalibration, Heartbeat, Message, Packet, Raster, Status, encode,
};
use hapticore_run::tuning_file::TuningFile;
use hapticore_run::{calibrate, inputs};
use hapticore_scene::{Plant, Scene, gallery};

/// The seeds of a target.
///
/// # Panics
/// Where there is no such target.
pub fn of(target: &str) -> Vec<Vec<u8>> {
    let bytes = |texts: Vec<String>| texts.into_iter().map(String::into_bytes).collect();
    match target {
        "profile" => bytes(profiles()),
        "scene" => bytes(scenes()),
        "calibration" => bytes(calibrations()),
        "csv" => bytes(csvs()),
        "wav" => wavs(),
        "sigmf" => sigmfs(),
        "tuning" => vec![tuning().into_bytes()],
        "plan" => bytes(plans()),
        "lab" => bytes(labs()),
        "options" => bytes(OPTIONS.map(|line| line.replace(' ', "\n")).to_vec()),
        "packets" => packets(),
        "board_commands" => board_commands(),
        "core" => (0..16).map(random).collect(),
        other => panic!("no target {other}"),
    }
}

fn random(seed: u64) -> Vec<u8> {
    let mut rng = Rng::with_seed(seed);
    (0..200).map(|_| rng.u8(..)).collect()
}

fn profiles() -> Vec<String> {
    let bundled = BUNDLED.map(|(_, text)| text.to_string());
    bundled.into_iter().chain([toml::to_string(&walled()).expect("plain data")]).collect()
}

/// A profile with a force controller and walls.
pub fn walled() -> Profile {
    let mut walled = Profile::bundled("small").expect("bundled");
    (walled.pads, walled.wall) = (3, Some(Wall::A));
    walled.control = Some(Control::of(&walled, Law::Inverse));
    walled
}

fn tuning() -> String {
    let profile = walled();
    let control = profile.control.clone().expect("a controller");
    let idle = TuningFile::at_reset(&profile, &control);
    let curve = (0..=control.cells).map(|cell| cell as f64 / (2.0 * control.cells as f64));
    let file = TuningFile {
        curve: curve.collect(),
        rail: 0.5,
        slew: 0.125,
        target_n: vec![0.25, 0.0, 0.5],
        ..idle
    };
    file.text("a seed").expect("plain data")
}

/// The bundled ones, and one whose sheet is quick to make with effects that others lack.
fn scenes() -> Vec<String> {
    const QUICK: &str = "title = \"t\"\nduration_s = 0.01\n[[pad]]\nposition_mm = { timeline = { x_mm = [[0, -20], [1, 5]] } }\n\
        load_g = { sine = { mean = 50, amplitude = 20, frequency_hz = 3 } }\nhaptic_v_rms = { timeline = [[0, 0], [0.005, 300]] }\n\
        [sheet]\nrung = \"bilinear\"\ntable_columns = 8\ntable_rows = 8\n[gap]\nrung = \"tr-bdf2\"\n[charge]\n[friction]\n\
        [carrier]\nrung = \"samples\"\nhaptic_wave = \"square\"\nhaptic_turn_s = 0.002\n[sensor]\nnoise_ppm_rms = 18\n\
        [[case]]\nname = \"a\"\nset = { \"pad.0.load_g\" = 5 }\n";
    let bundled = gallery::all().iter().map(|(_, text)| text.to_string());
    let quick = |text: String| text.replace("[sheet]\n", "[sheet]\nrung = \"distance\"\n");
    let minimal = gallery::all().iter().filter(|(name, _)| name.starts_with("minimal"));
    bundled.chain(minimal.map(|(_, text)| quick(text.to_string()))).chain([QUICK.into()]).collect()
}

/// The nominal device.
fn nominal() -> Plant {
    const TEXT: &str =
        "title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n[sheet]\nrung = \"analytic\"\n";
    let scene = Scene::parse(TEXT, "t", &[]).expect("a scene");
    let profile = Profile::bundled("small").expect("bundled");
    Plant::new(&scene, 0, &inputs::timing(&profile)).expect("a plant")
}

fn calibrations() -> Vec<String> {
    let profile = Profile::bundled("small").expect("bundled");
    let plant = nominal();
    let map = plant.calibration_map(5, 4, 15.0);
    let places =
        map.iter().map(|point| [point.x_mm, point.y_mm, point.r_x, point.r_y, point.sheet_ohm]);
    let coarse = |place: [f64; 5]| place.map(|number| (number * 1e3).round() / 1e3);
    let device = DeviceCalibration {
        map: Raster { columns: 5, places: places.map(coarse).collect(), open_share: 0.01 },
        ..calibrate::of_plant(&plant, &profile)
    };
    let with_force = DeviceCalibration {
        force: Some(hapticore_host::device::Force::default()),
        pads: 4,
        parts: 2,
        ..device.clone()
    };
    vec![device.text(), with_force.text()]
}

const CSV: &str = "# sample_rate_hz = 1000000\n# bits = 18\ni1,i2,i3,v_sense,v_haptic,pad\n\
    1,-2,3,4,-131072,0\n131071,12344,5,-6,7,0\n0,0,0,0,0,2\n";

fn csvs() -> Vec<String> {
    let volts = "0# full_scale_v = 10\nv_haptic,i2,_,i1,i3,v_sense\n1.5,-0.25,x,1e-3,9.999,-10\n";
    vec![format!("0{CSV}"), volts.into(), "91,2,3,4,5,0\n6,7,8,9,10,1\n".into()]
}

/// The chunks of a WAV file of five channels.
fn wav(riff: &[u8], tag: u16, bits: u16, samples: &[u8]) -> Vec<u8> {
    let block = 5 * bits / 8;
    let mut format = Vec::new();
    [tag, 5].iter().for_each(|word| format.extend(word.to_le_bytes()));
    [1_000_000, 1_000_000 * u32::from(block)]
        .iter()
        .for_each(|word: &u32| format.extend(word.to_le_bytes()));
    [block, bits].iter().for_each(|word| format.extend(word.to_le_bytes()));
    let mut file = vec![b'0'];
    file.extend(riff);
    let mut chunk = |name: &[u8], size: u32, body: &[u8]| {
        file.extend(name);
        file.extend(size.to_le_bytes());
        file.extend(body);
    };
    let large = riff == b"RF64";
    let size = samples.len() as u32;
    chunk(b"", if large { u32::MAX } else { size + 36 }, b"WAVE");
    if large {
        let sizes = [u64::from(size) + 72, size.into(), 2].map(u64::to_le_bytes).concat();
        chunk(b"ds64", 28, &[&sizes[..], &[0; 4]].concat());
    }
    chunk(b"LIST", 3, b"abc\0");
    chunk(b"fmt ", format.len() as u32, &format);
    chunk(b"data", if large { u32::MAX } else { size }, samples);
    file
}

fn wavs() -> Vec<Vec<u8>> {
    let floats: Vec<u8> = (0..10).flat_map(|n| (n as f32 / 10.0).to_le_bytes()).collect();
    vec![
        wav(b"RIFF", 1, 16, &random(1)[..20]),
        wav(b"RIFF", 1, 24, &random(2)[..30]),
        wav(b"RF64", 1, 32, &random(3)[..40]),
        wav(b"RIFF", 3, 32, &floats),
    ]
}

fn sigmfs() -> Vec<Vec<u8>> {
    let file = |datatype: &str, bytes: usize| {
        let meta = format!(
            "0{{\"global\": {{\"core:datatype\": \"{datatype}\", \"core:num_channels\": 5, \"core:sample_rate\": 1e6, \
             \"core:version\": \"1.2.0\"}}, \"captures\": [{{\"core:sample_start\": 0}}], \"annotations\": []}}\0"
        );
        [meta.as_bytes(), &vec![0x3f; 10 * bytes][..]].concat()
    };
    vec![file("ri16_le", 2), file("ri32_be", 4), file("rf32_le", 4), file("rf64_be", 8)]
}

fn plans() -> Vec<String> {
    const GRID: &str = "scene = \"minimal-sheet\"\nprofile = \"small\"\nslots = 2\nseeds = [1, 2]\n[axes.profile]\n\
        capacitance = [13, 15]\nslot.integrate = { from = 500, to = 1000, step = 250 }\n[axes.scene]\n\
        sheet.rung = [\"bilinear\", \"bicubic\"]\n";
    const RANDOM: &str = "scene = \"minimal-sheet\"\nfidelity = \"float\"\npredicted = 1\n[random]\ncount = 10\nseed = 7\n\
        [random.profile]\niq = { from = 18, to = 26 }\ncarrier.window = [\"hann\"]\n[random.scene]\n\
        \"pad.0.load_g\" = { from = 1.5, to = 20 }\n";
    vec![GRID.into(), RANDOM.into()]
}

/// Lines whose options have readers of their own.
const OPTIONS: [&str; 8] = [
    "simulate minimal-sheet --set pad.0.load_g=50 --set sheet.terminal_ohm=1e3 --waves-window 0..0.5 --bode 0.3",
    "simulate fig9 --set gap.rung=\"static\" --set control.law=\"open\" --case a --capture c.wav",
    "simulate minimal-gap --set pad.0.haptic_v_rms={timeline=[[0,0],[1,350]]} --set friction.rung=\"dahl\"",
    "replay c.csv --channels i1,i2,i3,v_sense,v_haptic,pad --bits 12 --pads 2",
    "replay c.csv --channels _,v_haptic,i3,i2,v_sense,i1 --full-scale-v 10",
    "hdl --board ulx3s --control inverse --dac ad5664 --wave sine:250 --out o",
    "tradeoff --target force=1mN,position=0.1mm,capacitance=0.1% --slots 2 --family ice40",
    "sweep run --store s {\"count\":1,\"first\":0,\"plan\":\"0\"}",
];

const SETUP: &str = "pads = 1\nsample_rate_hz = 1e6\ncarrier_hz = 101e3\ncurrent_full_scale_a = 0.004\n\
    sense_full_scale_v = 8.0\nhaptic_full_scale_v = 600.0\n";
const LOADS: &str = "load_g,haptic_v_rms,capacitance_pf,force_n\n20,0,330,0\n20,100,340,0.0109\n20,200,350,0.0472\n\
    20,300,360,0.1122\n100,0,370,0\n100,100,380,0.0138\n100,200,390,0.0581\n100,300,400,0.1388\n";

fn labs() -> Vec<String> {
    let plant = nominal();
    let at: Vec<[f64; 2]> = (0..30)
        .map(|k| [f64::from(k % 6) * 160.0 - 400.0, f64::from(k / 6) * 110.0 - 220.0])
        .collect();
    let places = |phases: bool| {
        let mut text = String::from("x_mm,y_mm,v_sense");
        (1..=6).for_each(|n| match phases {
            true => write!(text, ",i{n},i{n}_deg").expect("text"),
            false => write!(text, ",i{n}").expect("text"),
        });
        for (read, [x, y]) in plant.measurements(&at).into_iter().zip(&at) {
            write!(text, "\n{x},{y},8").expect("text");
            for siemens in read.siemens {
                write!(text, ",{:.5e}", 8.0 * siemens.norm()).expect("text");
                if phases {
                    write!(text, ",{:.3}", siemens.arg().to_degrees()).expect("text");
                }
            }
        }
        text + "\n"
    };
    vec![
        format!("{SETUP}\0{}\0{LOADS}", places(true)),
        format!("{SETUP}force_k = 9.6e12\n\0{}", places(false)),
    ]
}

/// For each profile commands of each kind, one after the other; then payloads, which are packed where they are read.
fn board_commands() -> Vec<Vec<u8>> {
    let of = |(choice, profile): (u8, &Profile)| {
        let commands =
            [Command::RESET_ADC, Command::Table { address: 3, code: -2 }, Command::ENABLE];
        std::iter::once(choice).chain(encode(&commands, profile)).collect()
    };
    let profiles = Profile::all();
    let payloads = (0x80..0x80 + 2 * profiles.len() as u8).map(|choice| {
        let places = [0x80, 0x40, 0x50, 0x60, 0x70, 0x78, 0x00];
        let payload = |place: u8| [place, 3, 0, 1, 2].into_iter();
        std::iter::once(choice).chain(places.into_iter().flat_map(payload)).collect()
    });
    (0..).zip(&profiles).map(of).chain(payloads).collect()
}

/// Of each profile a heartbeat and frames, one after the other.
fn packets() -> Vec<Vec<u8>> {
    let of = |(choice, profile): (u8, &Profile)| {
        let status = Status { sequence: 7, late: choice == 1, commands: 3, ..Status::default() };
        let flags = Flags { clipped: true, ..Flags::default() };
        let codes = [0; Field::ALL.len()].map(|_| -1 - i64::from(choice));
        let frame = Frame { pad: 0, codes, flags };
        let messages = [
            Message::Heartbeat(Heartbeat::new(status, profile, None)),
            Message::Frame(Packet { status, frame }),
        ];
        let bytes = messages.iter().flat_map(|message| message.encode(profile));
        std::iter::once(choice).chain(bytes).collect()
    };
    let profiles = Profile::all();
    // Payloads of two packets or more, which are packed where they are read.
    let payloads = (0x80..0x80 + profiles.len() as u8)
        .map(|choice| std::iter::once(choice).chain(1..=2 * 40).collect::<Vec<u8>>());
    (0..).zip(&profiles).map(of).chain(payloads).collect()
}
