// SPDX-License-Identifier: MIT OR Apache-2.0
//! The check of the wiring against faults that are drawn by seed, singly and in pairs, on three devices.
//!
//! A finding counts where it names a fault that is there, by line or pad. As a user would, the test mends what was named
//! and checks again, until nothing is named; a finding of something that is sound counts as wrong.

use fastrand::Rng;
use hapticore_board::bench::{Bench as _, DeviceTime};
use hapticore_board::check::{Finding, Report, check};
use hapticore_board::faults::Wrong;
use hapticore_board::target::{Asked, virtual_device};
use hapticore_host::DeviceCalibration;
use hapticore_scene::gallery;

/// Six terminals and four pads; four pads in halves with a drive; ten terminals on a sheet that is not uniform.
const DEVICES: [&str; 3] = ["hockey", "peg", "non-uniform-sheet"];

struct Device {
    scene: &'static str,
    calibration: DeviceCalibration,
    pads: usize,
    terminals: usize,
}

fn device(scene: &'static str) -> Device {
    let bench = bench(scene);
    let calibration = (**bench.board.case().device).clone();
    let profile = bench.profile();
    Device { scene, calibration, pads: profile.pads as usize, terminals: profile.terminals.x.len() }
}

fn bench(scene: &str) -> DeviceTime {
    let asked = Asked { port: format!("virtual:{scene}"), ..Asked::default() };
    DeviceTime::new(virtual_device(&asked).expect("a bundled scene"))
}

/// A fault of any kind that a user may find.
fn drawn(random: &mut Rng, device: &Device) -> Wrong {
    let Device { pads, terminals, .. } = *device;
    let mut two = |below: usize| {
        let a = random.usize(..below);
        let b = (a + random.usize(1..below)) % below;
        (a.min(b), a.max(b))
    };
    let ((a, b), (p, q)) = (two(terminals), if pads > 1 { two(pads) } else { (0, 0) });
    let line = random.usize(..terminals + 2);
    loop {
        let wrong = match random.u8(..10) {
            0 => Wrong::Open(a),
            1 => Wrong::Swapped(a, b),
            2 => Wrong::Reversed(a),
            3 => Wrong::Noisy(a, 0.05 + 0.1 * random.f64()),
            4 => Wrong::Clipped(a),
            5 if pads > 1 => Wrong::PadMissing(p),
            6 if pads > 1 => Wrong::PadsSwapped(p, q),
            7 => Wrong::LineLow(line),
            8 => Wrong::LineHigh(line),
            9 => Wrong::LineShorted(line, (line + 1) % (terminals + 2)),
            _ => continue,
        };
        return wrong;
    }
}

/// Channels and pads that a fault is about.
fn channels(wrong: Wrong) -> Vec<usize> {
    match wrong {
        Wrong::Open(a) | Wrong::Reversed(a) | Wrong::Noisy(a, _) | Wrong::Clipped(a) => vec![a],
        Wrong::LineLow(a) | Wrong::LineHigh(a) => vec![a],
        Wrong::Swapped(a, b) | Wrong::LineShorted(a, b) => vec![a, b],
        Wrong::PadMissing(a) => vec![100 + a],
        Wrong::PadsSwapped(a, b) => vec![100 + a, 100 + b],
    }
}

/// Whether a finding names a fault: what it is, and the line or pad.
fn names(finding: &Finding, wrong: Wrong) -> bool {
    match (*finding, wrong) {
        (Finding::DataLine { line, .. }, Wrong::LineLow(of) | Wrong::LineHigh(of)) => line == of,
        (Finding::DataLine { line, .. }, Wrong::LineShorted(a, b)) => line == a || line == b,
        (Finding::Open { terminal }, Wrong::Open(of))
        | (Finding::Reversed { terminal }, Wrong::Reversed(of)) => terminal == of,
        (Finding::Swapped { terminals }, Wrong::Swapped(a, b)) => terminals == [a, b],
        (Finding::Noisy { channel }, Wrong::Noisy(of, _))
        | (Finding::Clipped { channel }, Wrong::Clipped(of)) => channel == of,
        (Finding::PadMissing { pad }, Wrong::PadMissing(of)) => pad == of,
        (Finding::PadsSwapped { pads }, Wrong::PadsSwapped(a, b)) => pads == [a, b],
        _ => false,
    }
}

fn checked(device: &Device, wrong: &[Wrong]) -> Report {
    let mut bench = bench(device.scene);
    bench.board.faults.wrong = wrong.to_vec();
    check(&mut bench, &device.calibration).expect("it starts up")
}

/// Mends what is named until nothing is; whether all was named, and nothing else.
fn found(device: &Device, wrong: &[Wrong]) -> Result<(), String> {
    let mut left = wrong.to_vec();
    while !left.is_empty() {
        let report = checked(device, &left);
        let named = |wrong: &Wrong| report.findings.iter().any(|finding| names(finding, *wrong));
        let is_true = |finding: &&Finding| left.iter().any(|wrong| names(finding, *wrong));
        let before = left.len();
        if !report.findings.iter().all(|finding| is_true(&finding)) {
            return Err(format!("{left:?}: {:?}", report.findings));
        }
        let still: Vec<Wrong> = left.iter().copied().filter(|wrong| !named(wrong)).collect();
        left = still;
        if left.len() == before {
            return Err(format!("{left:?}: nothing named"));
        }
    }
    Ok(())
}

/// Draws faults, checks, and holds the share that is found.
fn hold(faults: usize, boards: usize) {
    let mut random = Rng::with_seed(faults as u64);
    let (mut wrong, mut tried) = (Vec::new(), 0);
    for scene in DEVICES {
        let device = device(scene);
        for _ in 0..boards {
            let mut drawn_faults: Vec<Wrong> = Vec::new();
            while drawn_faults.len() < faults {
                let next = drawn(&mut random, &device);
                let taken = |of: &Wrong| channels(*of).iter().any(|of| channels(next).contains(of));
                if !drawn_faults.iter().any(taken) {
                    drawn_faults.push(next);
                }
            }
            tried += 1;
            wrong.extend(found(&device, &drawn_faults).err().map(|why| format!("{scene}: {why}")));
        }
    }
    let share = 1.0 - wrong.len() as f64 / tried as f64;
    eprintln!("{faults} faults: {:.1} % of {tried} boards right", 100.0 * share);
    assert!(share >= 0.95, "{share}: {wrong:#?}");
}

/// Boards of each device; `BOARDS=200` tries more.
fn boards(default: usize) -> usize {
    std::env::var("BOARDS").ok().and_then(|boards| boards.parse().ok()).unwrap_or(default)
}

#[test]
fn single_faults_are_named_by_line_or_pad() {
    hold(1, boards(12));
}

#[test]
fn pairs_of_faults_are_named_one_step_at_a_time() {
    hold(2, boards(8));
}

#[test]
fn nothing_is_named_in_sound_boards() {
    let others = gallery::all().iter().map(|(name, _)| *name);
    let others = others.filter(|name| !DEVICES.contains(name));
    for (scene, seeds) in
        DEVICES.map(|scene| (scene, 5)).into_iter().chain(others.map(|name| (name, 1)))
    {
        let device = device(scene);
        for seed in 0..seeds {
            let asked = Asked {
                port: format!("virtual:{scene}"),
                set: vec![("seed".into(), seed.to_string())],
                ..Asked::default()
            };
            let mut bench = DeviceTime::new(virtual_device(&asked).expect("a bundled scene"));
            let report = check(&mut bench, &device.calibration).expect("it starts up");
            assert_eq!(report.findings, [], "{scene}, seed {seed}: {:#?}", report.compared);
            assert!(!report.compared.is_empty());
        }
    }
}
