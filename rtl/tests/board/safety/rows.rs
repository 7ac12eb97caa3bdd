// SPDX-License-Identifier: MIT OR Apache-2.0
//! The rows of the drive safety table, one by one: each measures its largest voltage and its times, which the document has.

use super::rig::{AT_ONCE, Pad, Rig, profile, tuning};
use crate::pins::Health;
use hapticore_contract::control::{Control, Law, Tuning};
use hapticore_host::{Command, drive, encode};

const TARGET_N: f64 = 0.5;
const RAIL: f64 = 0.6;
/// So small that a word from before would be seen.
const SLEW: f64 = 0.05;
const LAWS: [Law; 3] = [Law::Open, Law::Inverse, Law::Integral];

/// The document that states what is measured here.
const DOCUMENT: &str = include_str!("../../../../docs/safety.md");

/// A row of the table: the most of all laws.
struct Row {
    name: &'static str,
    largest_v: f64,
    largest_at: u64,
    zero_after: u64,
}

impl Row {
    fn of(name: &'static str) -> Row {
        Row { name, largest_v: 0.0, largest_at: 0, zero_after: 0 }
    }

    /// Takes the largest voltage since [`Rig::mark`], and the clocks until 0 V.
    fn add(&mut self, rig: &Rig, clocks: u64) {
        if rig.watch.largest_v > self.largest_v {
            (self.largest_v, self.largest_at) = (rig.watch.largest_v, rig.watch.largest_at);
        }
        self.zero_after = self.zero_after.max(clocks);
    }

    /// The document has these figures; clocks are those of a board at 25 MHz.
    fn is_documented(&self) {
        let us = |clocks: u64| clocks as f64 / 25.0;
        let Row { name, largest_v, .. } = self;
        let (at, zero) = (us(self.largest_at), us(self.zero_after));
        let line = format!("| {name} | {largest_v:.0} V | {at:.0} µs | {zero:.1} µs |");
        println!("{line}");
        assert!(DOCUMENT.contains(&line), "docs/safety.md: expected {line}");
    }
}

/// A loop that drives all pads.
fn driving(law: Law) -> Rig {
    driven(Rig::new(law), law)
}

fn driven(mut rig: Rig, law: Law) -> Rig {
    rig.start(&tuned(&rig), TARGET_N, true);
    for _ in 0..16 {
        frames(&mut rig, 1);
        if rig.watch.now.iter().all(|now| *now > 0.1) {
            break;
        }
    }
    assert!(rig.watch.now.iter().all(|now| *now > 0.1), "{law:?}: {:?}", rig.watch.now);
    assert!(rig.is_live() && !rig.driven().faults.any(), "{law:?}: {:?}", rig.driven());
    rig
}

fn tuned(rig: &Rig) -> Tuning {
    tuning(&rig.profile, RAIL, SLEW)
}

/// Frames of a host that is alive.
fn frames(rig: &mut Rig, count: u64) {
    for _ in 0..count {
        rig.targets(TARGET_N);
        rig.frames(1);
    }
}

/// Clocks until something holds, in steps of a thousand, while the host is alive.
fn until(rig: &mut Rig, most: u64, holds: impl Fn(&Rig) -> bool) -> u64 {
    let mut clocks = 0;
    while !holds(rig) {
        assert!(clocks <= most, "{:?} after {clocks} clocks", rig.watch.now);
        rig.targets(TARGET_N);
        rig.run(1_000);
        clocks += 1_000;
    }
    clocks
}

#[test]
fn power_up_drives_nothing() {
    let mut row = Row::of("power-up");
    for law in LAWS {
        let mut rig = Rig::new(law);
        rig.frames(6);
        assert!(rig.is_zero() && !rig.is_live() && rig.dac.pins.dac_polarity == 0, "{law:?}");
        rig.send(&[Command::ENABLE]);
        rig.frames(6);
        assert!(rig.is_zero(), "{law:?}: enabled, and nothing was set");
        row.add(&rig, 0);
        assert_eq!(rig.watch.largest_v, 0.0);
    }
    row.is_documented();
}

#[test]
fn a_reset_in_every_phase_clears_the_drive_and_enable_alone_drives_nothing() {
    let mut row = Row::of("reset");
    for (number, law) in (0..).zip(LAWS) {
        let running = driving(law);
        // Of each law other phases.
        let (phases, mut longest) = (12, 0);
        for phase in (number..phases).step_by(LAWS.len()) {
            let mut rig = running.clone();
            rig.run(phase * (rig.frame_clocks() / phases + 7));
            rig.reset(260);
            longest = longest.max(rig.until_zero(AT_ONCE));
            rig.mark();
            rig.send(&[Command::ENABLE]);
            rig.frames(2);
            assert_eq!(rig.watch.largest_v, 0.0, "{law:?}, phase {phase}: enabled alone");
            rig.send(&[Command::DISABLE]);
            rig.prepare(false);
            rig.send(&[Command::ENABLE]);
            rig.frames(3);
            assert_eq!(rig.watch.largest_v, 0.0, "{law:?}, phase {phase}: settings never sent");
            // From zero within slew, as the rig sees to; and it does drive.
            rig.send(&[Command::DISABLE]);
            rig.targets(TARGET_N);
            rig.tune(&tuned(&rig));
            rig.send(&[Command::ENABLE]);
            frames(&mut rig, 4);
            assert!(rig.watch.largest_v > 0.0, "{law:?}, phase {phase}: it drives again");
            if phase + LAWS.len() as u64 >= phases {
                row.add(&rig, longest);
            }
        }
    }
    row.is_documented();
}

#[test]
fn disable_clears_the_drive_and_enable_begins_from_zero() {
    let mut row = Row::of("disable, enable");
    for law in LAWS {
        let mut rig = driving(law);
        rig.send(&[Command::DISABLE]);
        assert!(!rig.is_live(), "{law:?}");
        let clocks = rig.until_zero(AT_ONCE);
        rig.frames(1);
        rig.mark();
        rig.send(&[Command::ENABLE]);
        frames(&mut rig, 2);
        // Two frames: twice the slew at most.
        assert!(rig.watch.largest_v <= 500.0 * 3.0 * SLEW, "{law:?}: {}", rig.watch.largest_v);
        frames(&mut rig, 16);
        assert!(rig.watch.now.iter().all(|now| *now > 0.1), "{law:?}: {:?}", rig.watch.now);
        row.add(&rig, clocks);
    }
    row.is_documented();
}

#[test]
fn settings_that_were_never_sent_drive_nothing() {
    let mut row = Row::of("settings never sent");
    for law in LAWS {
        let mut rig = Rig::new(law);
        rig.prepare(true);
        rig.targets(TARGET_N);
        rig.send(&[Command::ENABLE]);
        frames(&mut rig, 12);
        row.add(&rig, 0);
        assert_eq!(rig.watch.largest_v, 0.0, "{law:?}");
    }
    row.is_documented();
}

#[test]
fn settings_that_are_garbled_are_refused() {
    let mut row = Row::of("settings garbled");
    for law in LAWS {
        let mut rig = Rig::new(law);
        rig.prepare(true);
        let commands = drive::tune(&rig.profile, &tuned(&rig)).expect("a controller");
        for (number, command) in commands.iter().enumerate() {
            let mut bytes = encode(&[*command], &rig.profile);
            let at = 2 + number % (bytes.len() - 3);
            // No zero byte, which would end the command early: that is a damaged command as well.
            bytes[at] ^= if bytes[at] == 0x40 { 0x80 } else { 0x40 };
            rig.send_bytes(bytes);
        }
        rig.targets(TARGET_N);
        rig.send(&[Command::ENABLE]);
        frames(&mut rig, 12);
        row.add(&rig, 0);
        assert_eq!(rig.watch.largest_v, 0.0, "{law:?}");
    }
    row.is_documented();
}

#[test]
fn a_host_that_falls_silent_leaves_no_voltage() {
    let mut row = Row::of("host dead");
    // The default of all bundled profiles, then less.
    for (law, silent_ms) in LAWS.into_iter().zip([Control::SILENT_MS, 20, 5]) {
        let mut profile = profile(law);
        profile.control.as_mut().expect("a controller").silent_ms = silent_ms;
        let mut rig = driven(Rig::of(profile), law);
        rig.mark();
        let most = 25_000 * silent_ms + rig.frame_clocks() + AT_ONCE;
        let clocks = rig.until_zero(most);
        assert!(!rig.is_live(), "{law:?}");
        rig.frames(2);
        assert!(rig.driven().faults.silence, "{law:?}: and it is said");
        row.add(&rig, clocks);
    }
    row.is_documented();
}

#[test]
fn a_drive_that_shall_rest_is_at_zero_within_a_frame() {
    let mut row = Row::of("`drive::rest`");
    for law in LAWS {
        let mut rig = driving(law);
        rig.mark();
        rig.send(&[drive::rest()]);
        let clocks = rig.until_zero(rig.frame_clocks() + AT_ONCE);
        frames(&mut rig, 2);
        assert!(rig.is_zero() && !rig.driven().faults.any(), "{law:?}: it is no fault");
        row.add(&rig, clocks);
    }
    row.is_documented();
}

#[test]
fn a_force_beyond_the_cap_takes_the_drive_away_within_a_frame() {
    let mut row = Row::of("force cap");
    for law in LAWS {
        let mut rig = driving(law);
        rig.mark();
        let cap = Tuning { force_cap: 0.001, ..tuned(&rig) };
        rig.tune(&cap);
        let clocks = rig.until_zero(2 * rig.frame_clocks() + AT_ONCE);
        frames(&mut rig, 4);
        assert!(rig.is_zero() && !rig.is_live() && rig.driven().faults.force, "{law:?}: it stays");
        row.add(&rig, clocks);
        rig.tune(&tuned(&rig));
        frames(&mut rig, 16);
        assert!(rig.is_live() && !rig.is_zero(), "{law:?}: until it is cleared");
    }
    row.is_documented();
}

#[test]
fn a_broken_line_of_the_adc_takes_the_drive_away() {
    let mut row = Row::of("ADC line broken");
    for law in LAWS {
        let running = driving(law);
        let invalid = running.profile.control.as_ref().expect("a controller").invalid_frames;
        let mut longest = 0;
        // Terminals and the sensing voltage; the haptic voltage is in no estimate of a law but integral.
        for line in 0..running.profile.channels() - 1 {
            let mut rig = running.clone();
            rig.adc.broken = Some((line, line as i64 % 2));
            rig.mark();
            let most = (invalid + 2) * rig.frame_clocks() + AT_ONCE;
            longest = longest.max(until(&mut rig, most, Rig::is_zero));
            frames(&mut rig, 2);
            let said = rig.packets.last().is_some_and(|packet| packet.frame.flags.lost);
            let fault = rig.driven().faults.sensor;
            assert!(said || fault, "{law:?}, line {line}: and it is said");
            assert!(!rig.is_live(), "{law:?}, line {line}");
            row.add(&rig, longest);
        }
    }
    row.is_documented();
}

#[test]
fn an_adc_that_loses_its_supply_takes_the_drive_away() {
    let mut row = Row::of("ADC absent");
    for law in LAWS {
        let mut rig = driving(law);
        rig.adc.health = Health::Absent;
        rig.mark();
        let most = 2 * rig.frame_clocks() + AT_ONCE;
        let clocks = until(&mut rig, most, Rig::is_zero);
        frames(&mut rig, 4);
        assert!(rig.is_zero() && !rig.is_live(), "{law:?}: it stays");
        let said = rig.packets.last().is_some_and(|packet| packet.status.late);
        assert!(said, "{law:?}: and it is said");
        row.add(&rig, clocks);
        rig.adc.health = Health::Well;
        frames(&mut rig, 20);
        assert!(rig.is_live() && !rig.is_zero(), "{law:?}: until it is back");
    }
    row.is_documented();
}

#[test]
fn a_broken_line_of_the_haptic_voltage_drives_no_more_than_the_rail() {
    let mut row = Row::of("haptic line broken");
    for law in LAWS {
        let mut rig = driving(law);
        rig.adc.broken = Some((rig.profile.channels() - 1, 0));
        rig.mark();
        frames(&mut rig, 16);
        row.add(&rig, 0);
        assert!(rig.watch.largest_v <= 500.0 * RAIL + 0.1, "{law:?}: {}", rig.watch.largest_v);
    }
    row.is_documented();
}

#[test]
fn a_pad_that_is_lifted_is_not_driven_and_begins_from_zero_when_it_is_put_back() {
    let mut row = Row::of("pad lifted, put back");
    for law in LAWS {
        let mut rig = driving(law);
        rig.pads[1] = Pad { share: 0.004 };
        rig.mark();
        let most = 3 * rig.frame_clocks();
        let clocks = until(&mut rig, most, |rig| rig.watch.now[1] == 0.0);
        frames(&mut rig, 6);
        assert_eq!(rig.watch.now[1], 0.0, "{law:?}: a free pad");
        assert!(rig.watch.now[0] > 0.1 && rig.watch.now[2] > 0.1, "{law:?}: the others go on");
        assert!(!rig.driven().faults.any(), "{law:?}: it is no fault");
        // Put back: a 64th of full scale per frame.
        rig.pads[1] = Pad { share: 1.4 };
        frames(&mut rig, 4);
        assert!(rig.watch.now[1] <= 5.0 / 64.0 + 0.001, "{law:?}: {:?}", rig.watch.now);
        frames(&mut rig, 24);
        assert!(rig.watch.now[1] > 0.05, "{law:?}: {:?}", rig.watch.now);
        row.add(&rig, clocks);
    }
    row.is_documented();
}
