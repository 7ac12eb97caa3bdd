// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a drive is after a reset, `clear`, a fault, and where it is off: zero, and then it begins anew.

use super::rig::Rig;
use super::{Inputs, Outputs};
use hapticore_contract::control::Law;

/// Frames in which a drive shows what is left of what was before.
const FRAMES: usize = 40;

/// A settled rig with a drive, and a slew limit from now on.
fn driven(law: Law, slew: i64) -> Rig {
    let mut rig = Rig::new(law, |_| ());
    assert!(rig.settled() > 0, "{law:?}");
    rig.inputs.tuning.slew = slew;
    rig
}

/// A slew limit of a hundredth of full scale.
fn slow(rig: &Rig) -> i64 {
    rig.control.drive.code_saturating(0.01)
}

/// Every law with what stops its drives: a name, and what is done.
type Stop = (&'static str, fn(&mut Rig));

/// A frame in which drives stop, and what it gives.
type Stopping<'a> = &'a dyn Fn(&mut Rig) -> Outputs<i64>;

const STOPS: [Stop; 3] = [
    ("reset", |rig| {
        rig.bench.press_reset();
        rig.begin();
    }),
    ("clear", |rig| _ = rig.bench.clock(Inputs { clear: 1, ..rig.inputs })),
    ("disable", |rig| {
        let mut off = rig.inputs;
        off.tuning.enable = 0;
        rig.bench.clock(off);
    }),
];

#[test]
fn reset_clears_the_drive() {
    for law in Law::ALL {
        for (name, stop) in STOPS {
            let mut rig = driven(law, 0);
            stop(&mut rig);
            assert_eq!(rig.drives(0.1, FRAMES), [0; FRAMES], "{law:?}, {name}: a slew of 0");
        }
    }
}

#[test]
fn enable_after_reset_drives_from_zero_within_slew() {
    for law in Law::ALL {
        for (name, stop) in STOPS {
            let mut rig = driven(law, 0);
            stop(&mut rig);
            rig.inputs.tuning.slew = slow(&rig);
            let (mut last, slew) = (0, slow(&rig));
            for drive in rig.drives(0.1, FRAMES) {
                assert!((drive - last).abs() <= slew, "{law:?}, {name}: {last}, {drive}");
                last = drive;
            }
            assert!(last > 0, "{law:?}, {name}: it is driven again");
        }
    }
}

/// Neither the integral nor a filter's state outlives what stops a drive: all goes on as from a fresh controller.
#[test]
fn the_integral_restarts() {
    for law in Law::ALL {
        for (name, stop) in STOPS {
            let mut rig = driven(law, 0);
            stop(&mut rig);
            let mut fresh = Rig::new(law, |_| ());
            (rig.inputs, rig.drive) = (fresh.inputs, 0.0);
            fresh.capacitance_pf = rig.capacitance_pf;
            assert_eq!(rig.drives(0.1, FRAMES), fresh.drives(0.1, FRAMES), "{law:?}, {name}");
        }
    }
}

/// A frame after an event that must take the drive to zero immediately, with a slew of 0.
fn stopped(law: Law, how: impl FnOnce(&mut Rig) -> Outputs<i64>) -> (Rig, i64) {
    let mut rig = driven(law, 0);
    let drive = how(&mut rig).drive;
    (rig, drive)
}

#[test]
fn slew_holds_no_shutdown_back() {
    for law in Law::ALL {
        let off = |rig: &mut Rig| {
            rig.inputs.tuning.enable = 0;
            rig.frame(0.1, 0.1)
        };
        let fault = |rig: &mut Rig| {
            rig.inputs.tuning.force_cap = 0;
            rig.frame(0.1, 0.1)
        };
        let silent = |rig: &mut Rig| {
            let ticks = rig.control.silent_ms;
            for _ in 0..ticks {
                rig.bench.clock(Inputs { tick: 1, ..rig.inputs });
            }
            rig.frame(0.1, 0.1)
        };
        let lifted = |rig: &mut Rig| {
            let request = Inputs { lifted: 1, ..rig.request(0.1, 0.1) };
            rig.bench.operate(request).0
        };
        let invalid = |rig: &mut Rig| {
            let frames = rig.control.invalid_frames;
            (0..frames).map(|_| rig.any_frame(0.1, 0.1, 1)).last().expect("frames")
        };
        let stops: [(&str, Stopping); 5] = [
            ("off", &off),
            ("force fault", &fault),
            ("silence", &silent),
            ("lifted", &lifted),
            ("sensor fault", &invalid),
        ];
        for (name, stop) in stops {
            let (mut rig, drive) = stopped(law, stop);
            assert_eq!(drive, 0, "{law:?}, {name}: in that very frame");
            rig.inputs.tuning = Rig::new(law, |_| ()).inputs.tuning;
            rig.inputs.tuning.slew = slow(&rig);
            rig.clear();
            let first = rig.frame(0.1, 0.0).drive;
            assert!(first <= slow(&rig), "{law:?}, {name}: {first}, from zero within slew");
        }
    }
}

#[test]
fn a_lower_rail_holds_at_once_whatever_slew_says() {
    for law in Law::ALL {
        for invalid in [0, 1] {
            let mut rig = driven(law, 0);
            let rail = rig.settled() / 3;
            rig.inputs.tuning.rail = rail;
            let drive = rig.any_frame(0.1, 0.05, invalid).drive;
            assert!(drive <= rail && rail > 0, "{law:?}, invalid {invalid}: {drive} of {rail}");
        }
    }
}

/// With a slew of zero a drive neither rises nor falls by itself.
#[test]
fn with_a_slew_of_zero_a_drive_stays() {
    for law in Law::ALL {
        let mut rig = driven(law, 0);
        let before = rig.frame(0.1, 0.1).drive;
        assert!(before > 0, "{law:?}");
        assert_eq!([0.0, 1.5, 0.0].map(|target_n| rig.frame(target_n, 0.1).drive), [before; 3]);
    }
}

/// A fault between two drive words of a pad, cleared before the second, has stopped it all the same.
#[test]
fn a_fault_that_is_cleared_before_the_next_drive_word_has_stopped_the_pad() {
    for law in Law::ALL {
        let mut rig = driven(law, 0);
        for _ in 0..rig.control.silent_ms {
            rig.bench.clock(Inputs { tick: 1, ..rig.inputs });
        }
        rig.clear();
        assert_eq!(rig.frame(0.1, 0.1).drive, 0, "{law:?}");
    }
}

/// `clear`, a pulse in any clock of a drive word: that word is zero, and so is the pad's state.
#[test]
fn clear_in_every_phase_of_a_drive_word_leaves_nothing_of_it() {
    for law in Law::ALL {
        let mut rig = Rig::new(law, |_| ());
        let (latency, slew) = (rig.bench.block.latency(), rig.inputs.tuning.slew);
        for phase in 0..=latency {
            rig.inputs.tuning.slew = slew;
            assert!(rig.drives(0.1, 3)[2] > 0, "{law:?}: nothing to clear");
            rig.inputs.tuning.slew = 0;
            let request = rig.request(0.1, 0.05);
            for clock in 0..=latency {
                let inputs = Inputs {
                    start: (clock == 0).into(),
                    clear: (clock == phase).into(),
                    ..request
                };
                let out = rig.bench.clock(inputs);
                assert!(clock < phase || out.drive == 0, "{law:?}, clock {clock} of {phase}");
            }
            assert_eq!(rig.drives(0.1, 3), [0; 3], "{law:?}: cleared in clock {phase}");
        }
    }
}

#[test]
fn nothing_is_driven_without_ticks_or_a_whole_curve() {
    for law in Law::ALL {
        let mut rig = Rig::new(law, |_| ());
        rig.bench.press_reset();
        rig.bench.clock(Inputs { tick: 1, ..rig.inputs });
        assert_eq!(rig.drives(0.1, 3), [0; 3], "{law:?}: no curve, the old one is in its memory");
        let words = rig.bench.block.words_of_curve() as i64;
        for address in (0..words).rev() {
            let mut write = rig.inputs;
            (write.tuning.curve_write, write.tuning.curve_address) = (1, address);
            write.tuning.curve_word = rig.inputs.tuning.rail;
            rig.bench.clock(write);
        }
        assert_eq!(rig.drives(0.1, 3), [0; 3], "{law:?}: not in order from the first word on");
        rig.bench.press_reset();
        rig.write_curve();
        assert_eq!(rig.drives(0.1, 3), [0; 3], "{law:?}: no ticks");
        rig.bench.clock(Inputs { tick: 1, ..rig.inputs });
        assert!(rig.drives(0.1, FRAMES)[FRAMES - 1] > 0, "{law:?}: all of it");
    }
}
