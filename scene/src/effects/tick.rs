// SPDX-License-Identifier: MIT OR Apache-2.0
//! The times at which an effect keeps its state: multiples of its step since the start of the case,
//! and the events of what drives it. They do not depend on the times at which the pad is evaluated:
//! a state in between is reached by a step of its own, which is not kept.

/// The share of a step below which two times are one.
const SLACK: f64 = 1e-6;

/// A time at which a state is kept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Tick {
    pub time_s: f64,
    /// Multiples of the step up to it.
    steps: u64,
}

/// How far apart two times are at most that are one.
pub(super) fn slack_s(step_s: f64) -> f64 {
    SLACK * step_s
}

impl Tick {
    /// The next tick, where it is not past `until_s`; `next_event_s` finds the first event after a
    /// time.
    pub fn next(
        self,
        step_s: f64,
        until_s: f64,
        next_event_s: impl FnOnce(f64) -> f64,
    ) -> Option<Tick> {
        let slack_s = slack_s(step_s);
        let multiple_s = (self.steps + 1) as f64 * step_s;
        let event_s = next_event_s(self.time_s + slack_s);
        let next = if event_s > multiple_s + slack_s {
            Tick { time_s: multiple_s, steps: self.steps + 1 }
        } else {
            let is_multiple = event_s >= multiple_s - slack_s;
            Tick { time_s: event_s, steps: self.steps + u64::from(is_multiple) }
        };
        (next.time_s <= until_s + slack_s).then_some(next)
    }

    /// How much later a time is; nothing where it is this one.
    pub fn ahead_s(self, step_s: f64, time_s: f64) -> Option<f64> {
        let ahead_s = time_s - self.time_s;
        (ahead_s > slack_s(step_s)).then_some(ahead_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every tick up to a time, seen at each of these times.
    fn ticks(step_s: f64, events_s: &[f64], looks_s: &[f64]) -> Vec<f64> {
        let next_event_s = |after_s: f64| {
            events_s.iter().copied().find(|event_s| *event_s > after_s).unwrap_or(f64::INFINITY)
        };
        let (mut at, mut ticks) = (Tick::default(), Vec::new());
        for until_s in looks_s {
            while let Some(next) = at.next(step_s, *until_s, next_event_s) {
                ticks.push(next.time_s);
                at = next;
            }
        }
        ticks
    }

    #[test]
    fn ticks_are_multiples_of_the_step_and_events_whoever_looks() {
        let events_s = [0.25, 1.0 - 1e-9, 1.0 + 1e-9, 2.5];
        let all = [0.25, 1.0 - 1e-9, 2.0, 2.5, 3.0];
        assert_eq!(ticks(1.0, &events_s, &[3.4]), all);
        let looks_s: Vec<f64> = (0..340).map(|n| 0.01 * f64::from(n)).collect();
        assert_eq!(ticks(1.0, &events_s, &looks_s), all);
    }

    #[test]
    fn a_time_within_rounding_of_a_tick_is_the_tick() {
        let tick = Tick { time_s: 0.3, steps: 3 };
        assert_eq!(tick.ahead_s(0.1, 0.1 + 0.2), None);
        assert_eq!(tick.ahead_s(0.1, 0.35).map(|ahead_s| ahead_s > 0.04), Some(true));
        assert_eq!(tick.next(0.1, 0.3999999999, |_| f64::INFINITY).map(|tick| tick.steps), Some(4));
    }
}
