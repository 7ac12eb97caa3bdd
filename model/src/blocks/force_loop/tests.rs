// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clocks from the last strobe to the drive word; what a target that is written late does.

use super::{ForceLoop, Inputs};
use crate::support::Bench;
use crate::support::device::short_profiles;
use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::{Force, ForceLaw, Profile, Wall};
use hapticore_hdl::probe::variables;
use std::collections::HashSet;
use std::f64::consts::TAU;

/// The short profiles, with a controller of this law.
fn controlled(law: Law) -> impl Iterator<Item = Profile> {
    short_profiles().into_iter().map(move |mut profile| {
        profile.control = Some(Control::of(&profile, law));
        // The frame waits for two estimates.
        profile.slot.settle += 400;
        profile
    })
}

/// Those, with the force by eq. 8 and by the table.
fn with_both_forces(law: Law) -> impl Iterator<Item = Profile> {
    controlled(law).flat_map(|profile| {
        [ForceLaw::Eq8, ForceLaw::Table].map(|law| {
            let force = Force { law, ..profile.force };
            Profile { force, ..profile.clone() }
        })
    })
}

/// Clocks a slot of codes, and then until the drive word: the clocks after the last strobe, and the
/// word.
fn slot(
    bench: &mut Bench<ForceLoop>,
    profile: &Profile,
    quiet: Inputs<i64>,
    late: impl Fn(u64) -> Inputs<i64>,
) -> (u64, i64) {
    let clocks = profile.clocks_per_sample;
    // Currents that are small beside the sensing voltage, so that there is a capacitance.
    let (sense, mut channel) = (profile.terminals.x.len() as i64, 0);
    for clock in 0..=(profile.slot.samples() - 1) * clocks {
        let mut inputs = quiet;
        inputs.core.strobe = i64::from(clock % clocks == 0);
        let turns = (clock / clocks) as f64 * profile.turns_per_sample();
        let amplitude = if channel == sense { 10_000.0 } else { 100.0 };
        inputs.core.code = (amplitude * (TAU * turns).cos()).round() as i64;
        channel = bench.clock(inputs).core.channel;
    }
    for clock in 1..20_000 {
        let drive = bench.clock(late(clock)).drive;
        if drive.drive_valid == 1 {
            return (clock, drive.drive);
        }
    }
    panic!("{}: no drive word", profile.name);
}

/// Inputs of a core that is calibrated, so that its pads touch, while nothing happens.
fn touching(block: &ForceLoop) -> Inputs<i64> {
    let mut inputs = Inputs::of(0);
    let gain = block.inputs().core.calibration.capacitance_gain;
    inputs.core.calibration.capacitance_gain = gain.max_code() as i64;
    inputs
}

/// A split pad has its drive word after the slot of its last part, later by what its wall takes.
#[test]
fn latency_is_the_clocks_measured_with_walls() {
    for wall in [Wall::A, Wall::B, Wall::QUADRANTS] {
        for profile in controlled(Law::Inverse) {
            let (wall, pads) = (Some(wall), wall.parts);
            let profile = Profile { wall, pads, ..profile };
            let mut bench = Bench::new(ForceLoop::try_new(&profile).unwrap());
            let quiet = Inputs::of(0);
            let clocks = profile.slot_clocks() * (pads - 1);
            for clock in 0..clocks {
                let mut inputs = quiet;
                inputs.core.strobe = i64::from(clock % profile.clocks_per_sample == 0);
                assert_eq!(bench.clock(inputs).drive.drive_valid, 0, "clock {clock}");
            }
            let (measured, _) = slot(&mut bench, &profile, quiet, |_| quiet);
            let (name, latency) = (&profile.name, bench.block.latency());
            assert_eq!(measured, latency, "{name} {pads} parts");
            // 30 µs at 1 MS/s; `small` and `fine` multiply longer words bit by bit.
            println!("{name}, {pads} parts: {latency} clocks");
            if ["standard", "fast"].contains(&name.as_str()) {
                assert!(
                    latency <= 30 * profile.clocks_per_sample,
                    "{name}, {pads} parts: {latency}"
                );
            }
        }
    }
}

/// A waveform tells variables apart by instance and name.
#[test]
fn variables_have_names_of_their_own() {
    for law in Law::ALL {
        for profile in with_both_forces(law) {
            for wall in [None, Some(Wall::A), Some(Wall::B), Some(Wall::QUADRANTS)] {
                let pads = wall.map_or(profile.pads, |wall| wall.parts);
                let profile = Profile { wall, pads, ..profile.clone() };
                let block = ForceLoop::try_new(&profile).expect("time for a wall");
                let variables = variables(&block, "loop");
                let names: HashSet<_> = variables.iter().map(|of| (&of.scope, &of.name)).collect();
                assert_eq!(names.len(), variables.len(), "{} {wall:?}", profile.name);
            }
        }
    }
}

#[test]
fn latency_is_the_clocks_measured() {
    for law in Law::ALL {
        for profile in with_both_forces(law) {
            let mut bench = Bench::new(ForceLoop::try_new(&profile).unwrap());
            let quiet = Inputs::of(0);
            let (measured, _) = slot(&mut bench, &profile, quiet, |_| quiet);
            let (name, latency) = (&profile.name, bench.block.latency());
            assert_eq!(measured, latency, "{name} {law:?}: from the last strobe to the drive word");
        }
    }
}

/// A window's samples begin with a strobe, and the drive word is there before the next window's first.
#[test]
fn a_drive_word_within_the_next_window_is_refused() {
    // Of drive words that come between samples, and with one.
    let mut met = [0; 2];
    for law in Law::ALL {
        for profile in with_both_forces(law) {
            // A window in which the estimate of the one before is finished; then more clocks for a sample.
            let mut profile = profile.with_window(4000);
            for more in 0..4 {
                profile.clocks_per_sample += u64::from(more > 0);
                let (latency, clocks) =
                    (ForceLoop::try_new(&profile).unwrap().latency(), profile.clocks_per_sample);
                let least = latency / clocks;
                let built = |blanking: u64| {
                    let mut profile = profile.clone();
                    profile.slot.settle = blanking - profile.slot.open;
                    ForceLoop::try_new(&profile).map_err(|error| error.to_string())
                };
                let refused = |blanking: u64| {
                    built(blanking)
                        .is_err_and(|error| error.starts_with("slot.settle: expected more than"))
                };
                let name = &profile.name;
                assert!(!refused(least) && built(least - 1).is_err(), "{name}: {least} samples");
                if refused(least - 1) {
                    met[usize::from(latency.is_multiple_of(clocks))] += 1;
                }
            }
        }
    }
    assert!(met.iter().all(|&count| count > 0), "{met:?}");
}

/// The drive word after a target of this code that is written `written` clocks after the last strobe.
fn after(profile: &Profile, target: i64, written: u64) -> i64 {
    let mut bench = Bench::new(ForceLoop::try_new(profile).unwrap());
    let mut quiet = touching(&bench.block);
    let formats = bench.block.inputs().tuning;
    (quiet.tuning.enable, quiet.tuning.rail) = (1, formats.rail.max_code() as i64);
    (quiet.tuning.slew, quiet.tuning.force_cap) =
        (formats.slew.max_code() as i64, formats.force_cap.max_code() as i64);
    for address in 0..bench.block.drives.words_of_curve() as i64 {
        let mut write = quiet;
        (write.tuning.curve_write, write.tuning.curve_address) = (1, address);
        write.tuning.curve_word = 100 * address;
        bench.clock(write);
    }
    bench.clock(Inputs { tick: 1, ..quiet });
    // A target while nothing happens, then the late one.
    let write = |word: i64| {
        let mut inputs = quiet;
        (inputs.target.target_write, inputs.target.target_word) = (1, word);
        inputs
    };
    bench.clock(write(1 << 8));
    slot(&mut bench, profile, quiet, |clock| if clock == written { write(target) } else { quiet }).1
}

/// The drive word of a frame whose rail becomes `rail`, `written` clocks after the last strobe.
fn after_rail(profile: &Profile, rail: i64, written: u64) -> i64 {
    let mut bench = Bench::new(ForceLoop::try_new(profile).unwrap());
    let mut quiet = touching(&bench.block);
    let formats = bench.block.inputs().tuning;
    (quiet.tuning.enable, quiet.tuning.rail) = (1, 1 << 10);
    (quiet.tuning.slew, quiet.tuning.force_cap) =
        (formats.slew.max_code() as i64, formats.force_cap.max_code() as i64);
    for address in 0..bench.block.drives.words_of_curve() as i64 {
        let mut write = quiet;
        (write.tuning.curve_write, write.tuning.curve_address) = (1, address);
        write.tuning.curve_word = 1 << 13;
        bench.clock(write);
    }
    let late = |clock: u64| {
        let mut inputs = quiet;
        if clock >= written {
            inputs.tuning.rail = rail;
        }
        inputs
    };
    bench.clock(Inputs { tick: 1, ..quiet });
    let mut target = quiet;
    (target.target.target_write, target.target.target_word) = (1, 1 << 10);
    bench.clock(target);
    slot(&mut bench, profile, quiet, late).1
}

/// Gains and limits count from the frame on in which they are there when the estimate comes: changed in any clock after
/// it, they leave its drive word as it was.
#[test]
fn settings_that_change_in_mid_frame_are_taken_with_the_next() {
    let profile = controlled(Law::Open).next().expect("a profile");
    let block = ForceLoop::try_new(&profile).unwrap();
    let given = block.core.prompt_latency();
    assert_eq!(after_rail(&profile, 1 << 12, 1), 1 << 12, "in time");
    for written in given + 1..=block.latency() {
        assert_eq!(after_rail(&profile, 1 << 12, written), 1 << 10, "changed at {written}");
    }
}

/// Of what every frame gives, the least and the most until they are read.
#[test]
fn extremes_are_those_since_they_were_read() {
    let profile = controlled(Law::Open).next().expect("a profile");
    let mut bench = Bench::new(ForceLoop::try_new(&profile).unwrap());
    let mut quiet = touching(&bench.block);
    let formats = bench.block.inputs().tuning;
    (quiet.tuning.enable, quiet.tuning.rail) = (1, formats.rail.max_code() as i64);
    (quiet.tuning.slew, quiet.tuning.force_cap) =
        (formats.slew.max_code() as i64, formats.force_cap.max_code() as i64);
    for address in 0..bench.block.drives.words_of_curve() as i64 {
        let mut write = quiet;
        (write.tuning.curve_write, write.tuning.curve_address) = (1, address);
        write.tuning.curve_word = 100 * address;
        bench.clock(write);
    }
    bench.clock(Inputs { tick: 1, ..quiet });
    assert_eq!(bench.clock(quiet).extremes.extremes_valid, 0, "nothing yet");
    let mut given = Vec::new();
    for (n, target) in [1 << 10, 1 << 12, 1 << 8].into_iter().enumerate() {
        let mut write = quiet;
        (write.target.target_write, write.target.target_word) = (1, target);
        for pad in 0..profile.pads as i64 {
            write.target.target_pad = pad;
            bench.clock(write);
        }
        given.push(slot(&mut bench, &profile, quiet, |_| quiet).1);
        assert!(given[n] > 0, "frame {n}");
        let extremes = bench.clock(quiet).extremes;
        let (least, most) = (given.iter().min().unwrap(), given.iter().max().unwrap());
        assert_eq!((extremes.least_drive, extremes.most_drive), (*least, *most), "frame {n}");
    }
    bench.clock(Inputs { extremes_read: 1, ..quiet });
    assert_eq!(bench.clock(quiet).extremes.extremes_valid, 0, "read");
}

/// A target counts from the frame on in which it is there when the estimate comes: written in any
/// clock, it gives the old drive word or the new one, and never a mixture.
#[test]
fn a_target_that_is_written_in_mid_frame_is_taken_whole_or_not_at_all() {
    let profile = controlled(Law::Open).next().expect("a profile");
    let block = ForceLoop::try_new(&profile).unwrap();
    let given = block.latency() - block.drives.controller.latency();
    let (old, new) = (after(&profile, 1 << 8, 1), after(&profile, 1 << 12, 1));
    assert!(old > 0 && new > old, "{old}, {new}");
    for written in given - 8..=block.latency() {
        let drive = after(&profile, 1 << 12, written);
        assert!(drive == old || drive == new, "written at {written}: {drive}");
    }
    assert_eq!(after(&profile, 1 << 12, given + 2), old, "too late for this frame");
}

/// A board that has not been calibrated knows of no pad that it touches.
#[test]
fn a_core_without_a_calibration_drives_no_pad() {
    for law in Law::ALL {
        for profile in with_both_forces(law) {
            let mut bench = Bench::new(ForceLoop::try_new(&profile).unwrap());
            let mut quiet = Inputs::of(0);
            let tuning = bench.block.inputs().tuning;
            (quiet.tuning.enable, quiet.tuning.rail) = (1, tuning.rail.max_code() as i64);
            quiet.tuning.slew = tuning.slew.max_code() as i64;
            quiet.tuning.force_cap = tuning.force_cap.max_code() as i64;
            for address in 0..bench.block.drives.words_of_curve() as i64 {
                let mut write = quiet;
                (write.tuning.curve_write, write.tuning.curve_address) = (1, address);
                write.tuning.curve_word = 1 << 13;
                bench.clock(write);
            }
            assert_eq!(slot(&mut bench, &profile, quiet, |_| quiet).1, 0, "{law:?}");
        }
    }
}
