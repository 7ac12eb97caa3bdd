// SPDX-License-Identifier: MIT OR Apache-2.0
//! A board that drives its pads: tuned over its line, its converter has the drive words of the force loop, and its packets
//! say what they were.

use crate::device::{Sight, calibration, short_profiles};
use crate::session::{Session, parameters, samples_of};
use hapticore_contract::control::{Control, Drive, Law, Surface, Tuning, Walls};
use hapticore_contract::frame::Frame as Measured;
use hapticore_contract::profile::{ForceLaw, Profile, Wall};
use hapticore_host::startup::{AdcSetup, prepare};
use hapticore_host::{Command, Driven, Packet, drive};
use hapticore_model::fidelity::force_loop::FixedLoop;
use hapticore_rtl::board::drive_output::serial::Frame;
use hapticore_rtl::board::drive_output::{Converter, Wave};
use hapticore_rtl::board::{Board, Parameters};

const SLOTS: usize = 12;
const TARGETS_N: [f64; 4] = [0.3, 0.8, 0.05, 0.0];
/// A converter's code of 0 V.
const ZERO: i64 = 0;

/// A short profile with a controller of this law, and walls where there are some; slots so long that a drive word is there
/// before the next window.
fn controlled(which: usize, law: Law, wall: Option<Wall>) -> Profile {
    let mut profile = short_profiles().swap_remove(which);
    profile.control = Some(Control::of(&profile, law));
    profile.slot.settle += 400;
    // As few words to be sent as a map may have.
    (profile.position.columns, profile.position.rows) = (17, 11);
    Profile { wall, ..profile }
}

fn tuning(profile: &Profile) -> Tuning {
    let control = profile.control.as_ref().expect("a controller");
    let cells = control.cells as f64;
    Tuning {
        curve: (0..=control.cells).map(|cell| 0.9 * cell as f64 / cells).collect(),
        full_drive: 2.0,
        proportional: 0.2,
        correction: 0.1,
        rail: 0.7,
        slew: 0.2,
        force_cap: f64::INFINITY,
        walls: profile.wall.map(|_| Walls {
            stiffness_n_per_mm: 1.0,
            most_n: 0.9,
            factory: 0.01,
            right: false,
        }),
    }
}

fn drives(profile: &Profile) -> Parameters {
    let drive = Some((Wave::Dc, Converter::Serial(Frame::AD5664R)).into());
    Parameters { drive, ..parameters(profile, 4, 0) }
}

/// The numbers of the pads that have targets: of split ones the last parts.
fn pads(profile: &Profile) -> Vec<u8> {
    let parts = profile.wall.map_or(1, |wall| wall.parts);
    (1..=profile.pads / parts).map(|pad| (pad * parts - 1) as u8).collect()
}

/// All commands but the last, which enables.
fn commands(profile: &Profile, tuning: &Tuning) -> Vec<Command> {
    let mut all = prepare(profile, &calibration(profile), &AdcSetup::default());
    all.extend(drive::tune(profile, tuning).expect("a controller"));
    for (pad, newtons) in pads(profile).into_iter().zip(TARGETS_N) {
        all.push(drive::target(profile, pad, newtons).expect("a controller"));
        if profile.wall.is_some() {
            all.push(drive::surface(profile, pad, SURFACE_MM, false).expect("a controller"));
        }
    }
    all
}

/// So far right that every valid place is within the wall.
const SURFACE_MM: f64 = 390.0;

/// What the model gives of the same.
fn modelled(
    profile: &Profile,
    tuning: &Tuning,
    samples: &[Vec<i32>],
) -> Vec<(Measured, Option<Drive>)> {
    let mut of = FixedLoop::new(profile, &calibration(profile), tuning).expect("a force loop");
    for (pad, newtons) in pads(profile).into_iter().zip(TARGETS_N) {
        of.set_target(pad.into(), newtons);
        if profile.wall.is_some() {
            of.set_surface(pad.into(), Surface { mm: SURFACE_MM, right: false });
        }
    }
    let slots = samples.chunks_exact(profile.slot.samples() as usize).enumerate();
    let blanking = profile.slot.blanking() as usize;
    slots
        .map(|(slot, samples)| {
            let codes: Vec<i32> = samples[blanking..].concat();
            of.slot(|core| core.slot(slot % profile.pads as usize, &codes))
        })
        .collect()
}

/// The code of a converter of 16 bits for a drive word.
fn converted(profile: &Profile, fraction: f64) -> i64 {
    let format = profile.control.as_ref().expect("a controller").drive;
    let scaled = (format.code_saturating(fraction) as f64) * 2f64.powi(16 - i32::from(format.frac));
    ZERO + scaled.round_ties_even() as i64
}

/// What a packet says of a drive.
fn told(profile: &Profile, drive: &Drive) -> Driven {
    let format = profile.control.as_ref().expect("a controller").drive;
    Driven {
        word: format.code_saturating(drive.fraction),
        pad: drive.pad as u8,
        low: drive.low,
        high: drive.high,
        free: drive.walled.is_some_and(|walled| walled.free),
        live: true,
        faults: drive.faults,
    }
}

fn follow(profile: &Profile, sights: &[Sight]) {
    let (tuning, samples) = (tuning(profile), samples_of(profile, sights, SLOTS + 1));
    let mut session = Session::new(profile, drives(profile), &samples);
    session.send(&commands(profile, &tuning));
    session.send(&[Command::ENABLE]);
    let packets = session.packets(SLOTS);
    let expected = modelled(profile, &tuning, &samples);
    let name = format!("{} {:?}", profile.name, profile.control.as_ref().map(|of| of.law));
    for (number, (packet, (frame, _))) in packets.iter().zip(&expected).enumerate() {
        assert_eq!(packet.frame, *frame, "{name}: frame {number}");
    }
    // A converter has zero on every channel after the reset. The first drive word sets it up: that channel, and zero on the
    // others. Then it has the drive words in their order.
    let parts = profile.wall.map_or(1, |wall| wall.parts) as usize;
    let given: Vec<&Drive> = expected.iter().filter_map(|(_, drive)| drive.as_ref()).collect();
    let words = given.iter().map(|drive| (drive.pad / parts, converted(profile, drive.fraction)));
    let words: Vec<_> = words.collect();
    let zeros = |from: usize| (from..pads(profile).len()).map(|channel| (channel, ZERO));
    let begins = zeros(0).chain([words[0]]).chain(zeros(1));
    let all: Vec<_> = begins.chain(words[1..].iter().copied()).collect();
    let updates = &session.dac.updates;
    assert!(
        updates.len() + 1 >= 2 * pads(profile).len() + SLOTS / parts - 1,
        "{name}: {updates:?}"
    );
    assert_eq!(*updates, all[..updates.len()], "{name}: channels and codes");
    assert!(words.iter().any(|&(_, code)| code > ZERO), "{name}: something is driven");
    // What packets say is the last drive word before each: of their slot, or of one before.
    let all: Vec<Driven> = given.iter().map(|drive| told(profile, drive)).collect();
    let of = |packet: &Packet| packet.status.driven.expect("a board with a drive");
    let mut at = 0;
    for packet in packets.iter().skip(parts) {
        let found = all[at..].iter().position(|driven| *driven == of(packet));
        at += found.unwrap_or_else(|| panic!("{name}: {:?} is none of {all:?}", of(packet)));
    }
    assert!(at + 2 >= SLOTS / parts, "{name}: the last one said is {at}");
}

#[test]
fn tuned_over_the_line_a_converter_has_the_drive_words_of_the_force_loop() {
    // An open terminal switches the board's drive off, which the model of the loop does not know of.
    follow(&controlled(0, Law::Inverse, None), &[Sight::Tones]);
    follow(&controlled(1, Law::Integral, None), &[Sight::Tones]);
    let mut with_table = controlled(1, Law::Inverse, None);
    with_table.force.law = ForceLaw::Table;
    with_table.slot.settle += 400;
    follow(&with_table, &[Sight::Tones]);
}

#[test]
fn walls_are_set_over_the_line() {
    follow(&controlled(1, Law::Inverse, Some(Wall { parts: 2, ..Wall::B })), &[Sight::Tones]);
}

/// Pads on the sheet, for as long as the tests take.
fn tones(profile: &Profile) -> Vec<Vec<i32>> {
    samples_of(profile, &[Sight::Tones], 80)
}

/// Runs until `packets` more packets are there, and gives what the last reports of the drive.
fn later(session: &mut Session, packets: usize) -> Driven {
    let count = session.packets.len() + packets;
    session.packets(count)[count - 1].status.driven.expect("a board with a drive")
}

/// The last code of each channel.
fn codes(session: &Session, channels: usize) -> Vec<i64> {
    let last = |channel: usize| {
        session.dac.updates.iter().rev().find(|update| update.0 == channel).map(|update| update.1)
    };
    (0..channels).map(|channel| last(channel).expect("a channel that was set")).collect()
}

#[test]
fn nothing_is_driven_before_it_is_tuned_nor_after_it_is_disabled() {
    let profile = controlled(0, Law::Inverse, None);
    let mut session = Session::new(&profile, drives(&profile), &tones(&profile));
    session.send(&prepare(&profile, &calibration(&profile), &AdcSetup::default()));
    session.send(&[drive::target(&profile, 1, 0.8).expect("a controller"), Command::ENABLE]);
    let driven = later(&mut session, 6);
    // The force cap is zero until it is set.
    assert!(!driven.live && driven.faults.force, "untuned: {driven:?}");
    assert_eq!((driven.word, codes(&session, 4)), (0, vec![ZERO; 4]), "untuned");
    session.send(&drive::tune(&profile, &tuning(&profile)).expect("a controller"));
    let driven = later(&mut session, 8);
    assert!(codes(&session, 4)[1] > ZERO && driven.live, "tuned: {driven:?}");
    session.send(&[drive::rest()]);
    later(&mut session, 16);
    assert_eq!(codes(&session, 4), [ZERO; 4], "at rest");
    let on = Command::Drive(hapticore_host::DriveWord::Setting(hapticore_host::Setting::Enable), 1);
    session.send(&[on]);
    later(&mut session, 6);
    assert!(codes(&session, 4)[1] > ZERO, "and on");
    session.send(&[Command::DISABLE]);
    session.run(1_000);
    assert_eq!(codes(&session, 4), [ZERO; 4], "disabled: at once");
}

#[test]
fn a_fault_takes_drives_to_zero_is_told_and_stays_until_it_is_cleared() {
    let profile = controlled(0, Law::Open, None);
    let capped = Tuning { force_cap: 0.0, ..tuning(&profile) };
    let mut session = Session::new(&profile, drives(&profile), &tones(&profile));
    session.send(&commands(&profile, &capped));
    session.send(&[Command::ENABLE]);
    assert!(later(&mut session, 12).faults.force, "a force beyond its cap");
    assert_eq!(codes(&session, 4), [ZERO; 4]);
    session.send(&drive::tune(&profile, &tuning(&profile)).expect("a controller"));
    let driven = later(&mut session, 8);
    assert!(
        !driven.faults.any() && codes(&session, 4)[1] > ZERO,
        "cleared, with a larger cap: {driven:?}"
    );
}

#[test]
fn a_host_that_falls_silent_takes_drives_to_zero() {
    let mut profile = controlled(0, Law::Open, None);
    // Sixteen slots.
    let clocks_per_ms = drives(&profile).clock_hz / 1000;
    let silent_ms = (16 * profile.slot_clocks()).div_ceil(clocks_per_ms);
    profile.control.as_mut().expect("a controller").silent_ms = silent_ms;
    let mut session = Session::new(&profile, drives(&profile), &tones(&profile));
    session.send(&commands(&profile, &tuning(&profile)));
    session.send(&[Command::ENABLE]);
    let driven = later(&mut session, 12);
    assert!(!driven.faults.silence && codes(&session, 4)[1] > ZERO, "within its time: {driven:?}");
    assert!(later(&mut session, 8).faults.silence, "then it is a fault");
    assert_eq!(codes(&session, 4), [ZERO; 4]);
    session.send(&[drive::clear_faults()]);
    assert!(!later(&mut session, 6).faults.any());
}

#[test]
fn a_controller_without_a_converter_is_refused_and_the_other_way_round() {
    let profile = controlled(0, Law::Open, None);
    let error = |profile: &Profile, parameters: Parameters| {
        let Err(error) = Board::new(profile, &parameters) else { panic!("refused") };
        error.to_string()
    };
    let plain = Profile { control: None, ..profile.clone() };
    assert_eq!(error(&profile, parameters(&profile, 4, 0)), "drives: expected 1 to 1, got 0");
    assert_eq!(error(&plain, drives(&plain)), "drives: expected 0 to 0, got 1");
    let many = Profile { pads: 5, ..profile };
    let expected = "pads: expected at most 4, a channel of the converter each, got 5";
    assert_eq!(error(&many, drives(&many)), expected);
}
