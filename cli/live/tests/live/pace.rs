// SPDX-License-Identifier: MIT OR Apache-2.0
//! Device time against a clock that the test moves.

use hapticore_live::pace::{MOST_BEHIND_S, Pace};

/// A loop whose slots take time of the fake clock.
struct Loop {
    pace: Pace,
    wall_s: f64,
    slot_s: f64,
    slots: usize,
}

impl Loop {
    fn new(speed: f64, slot_s: f64) -> Loop {
        Loop { pace: Pace::new(0.0, speed), wall_s: 0.0, slot_s, slots: 0 }
    }

    fn next_end_s(&self) -> f64 {
        (self.slots + 1) as f64 * self.slot_s
    }

    /// Runs until a wall time; each slot costs `cost_s`, each wait is `nap_s` too long.
    fn run(&mut self, until_s: f64, cost_s: f64, nap_s: f64) {
        while self.wall_s < until_s {
            let due_s = self.pace.due_s(self.wall_s, self.next_end_s());
            let mut ran = false;
            while self.next_end_s() <= due_s {
                (self.slots, ran) = (self.slots + 1, true);
                self.wall_s += cost_s;
            }
            if !ran || cost_s == 0.0 {
                self.wall_s += self.pace.wait_s(self.next_end_s()).clamp(0.004, 0.1) + nap_s;
            }
        }
    }

    fn device_s(&self) -> f64 {
        self.slots as f64 * self.slot_s
    }
}

#[test]
fn device_time_is_wall_time_times_speed() {
    for speed in [0.01, 0.1, 1.0, 4.0] {
        let mut one = Loop::new(speed, 250e-6);
        one.run(10.0, 0.0, 0.0);
        assert!(
            (one.device_s() - 10.0 * speed).abs() < 0.005 * speed.max(1.0),
            "{speed}: {}",
            one.device_s()
        );
        assert_eq!(one.pace.skipped_s(), 0.0);
    }
}

#[test]
fn a_slot_that_lasts_longer_than_the_bound_is_not_skipped() {
    // At a hundredth of the speed a slot of 1.7 ms lasts 170 ms.
    let mut slow = Loop::new(0.01, 1.7e-3);
    slow.run(10.0, 0.0, 0.0);
    assert_eq!((slow.pace.skipped_s(), slow.slots), (0.0, 58));
}

#[test]
fn a_loop_that_is_too_slow_skips_time_and_no_slot() {
    // A slot takes twice the time that it may.
    let mut slow = Loop::new(1.0, 1e-3);
    slow.run(10.0, 2e-3, 0.0);
    let (device_s, skipped_s) = (slow.device_s(), slow.pace.skipped_s());
    assert!((device_s - 5.0).abs() < 0.1, "half of real time, got {device_s}");
    assert!(
        (device_s + skipped_s - 10.0).abs() < 2.0 * MOST_BEHIND_S,
        "all time is told: {skipped_s}"
    );
}

#[test]
fn a_pause_of_the_machine_is_not_caught_up() {
    let mut one = Loop::new(1.0, 1e-3);
    one.run(1.0, 0.0, 0.0);
    let before = one.slots;
    one.wall_s += 13.0;
    one.run(14.2, 0.0, 0.0);
    assert!((one.slots - before) as f64 * 1e-3 < 0.3, "{} slots", one.slots - before);
    assert!((one.pace.skipped_s() - 13.0).abs() < 0.1);
}

#[test]
fn late_wake_ups_within_the_bound_lose_nothing() {
    let mut late = Loop::new(1.0, 1e-3);
    late.run(10.0, 0.0, 0.03);
    assert_eq!(late.pace.skipped_s(), 0.0);
    assert!((late.device_s() - 10.0).abs() < 0.04);
}

#[test]
fn time_stands_while_it_is_paused_or_stepped() {
    let mut one = Loop::new(0.0, 1e-3);
    one.run(5.0, 0.0, 0.0);
    assert_eq!(one.slots, 0);
    one.pace.stand(one.wall_s);
    one.pace.set_speed(1.0);
    one.run(6.0, 0.0, 0.0);
    assert!((890..=1000).contains(&one.slots), "{}", one.slots);
    one.pace.set_stepped(true);
    let before = one.slots;
    one.run(8.0, 0.0, 0.0);
    assert_eq!(one.slots, before);
    // A step of 500 slots, then the clock again.
    one.slots += 500;
    one.pace.stand(one.wall_s);
    one.pace.restart_at(one.device_s());
    one.pace.set_stepped(false);
    one.run(9.0, 0.0, 0.0);
    assert!((1400..=1501).contains(&(one.slots - before)), "{}", one.slots - before);
    assert_eq!(one.pace.skipped_s(), 0.0);
}
