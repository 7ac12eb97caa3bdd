// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is set at a pad while a case runs, in place of what the scene says: its voltage, its load,
//! the push on it, and where its finger goes.
//!
//! ```text
//! lead     from where the finger is, on a line, to a place; it stays there
//! release  from where the finger is, on a line, to where the scene has it then; it follows the scene
//! voltage, load, push: each value holds until the next
//! ```

use std::collections::VecDeque;

use crate::input_limits::DriveError;
use crate::stimulus::Moment;

/// What has been set at one pad.
#[derive(Clone, Debug, Default)]
pub(crate) struct PadInputs {
    pub voltage_v_rms: Held<f64>,
    pub load_g: Held<f64>,
    pub push_n: Held<[f64; 2]>,
    pub finger: FingerPath,
}

impl PadInputs {
    /// Forgets what cannot be asked for any more once the pad has been evaluated at a time.
    pub fn forget(&mut self, before_s: f64) {
        self.voltage_v_rms.forget(before_s);
        self.load_g.forget(before_s);
        self.push_n.forget(before_s);
        self.finger.forget(before_s);
    }
}

/// Refuses a time before `earliest_s`.
fn check_time(time_s: f64, earliest_s: f64) -> Result<(), DriveError> {
    let is_left = time_s >= earliest_s && time_s.is_finite();
    if is_left { Ok(()) } else { Err(DriveError::Past { time_s, earliest_s }) }
}

/// Values that are set as time goes on, each held until the next.
#[derive(Clone, Debug)]
pub(crate) struct Held<T> {
    /// Time and value, in the order of time; what a later one has replaced is forgotten.
    updates: VecDeque<(f64, T)>,
}

impl<T> Default for Held<T> {
    fn default() -> Self {
        Held { updates: VecDeque::new() }
    }
}

impl<T: Copy + PartialEq> Held<T> {
    /// Whether a value can be set from `time_s` on; `now_s` is the time at which the plant was last
    /// evaluated.
    pub fn check(&self, time_s: f64, now_s: f64) -> Result<(), DriveError> {
        let earliest_s = self.updates.back().map_or(now_s, |(last_s, _)| last_s.max(now_s));
        check_time(time_s, earliest_s)
    }

    /// From `time_s`, which has been checked, the value is this.
    pub fn set(&mut self, time_s: f64, value: T) {
        if self.updates.back().is_some_and(|(last_s, _)| *last_s == time_s) {
            self.updates.pop_back();
        }
        // A value that is set again changes nothing, so that it is no event either.
        if self.updates.back().is_none_or(|(_, last)| *last != value) {
            self.updates.push_back((time_s, value));
        }
    }

    fn forget(&mut self, before_s: f64) {
        while self.updates.get(1).is_some_and(|(time_s, _)| *time_s <= before_s) {
            self.updates.pop_front();
        }
    }

    /// The value at a moment; none before the first is set.
    #[inline]
    pub fn at(&self, moment: Moment) -> Option<T> {
        if self.updates.is_empty() {
            return None;
        }
        let past = self.updates.partition_point(|(time_s, _)| moment.is_past(*time_s));
        Some(self.updates[past.checked_sub(1)?].1)
    }

    /// When the value next changes, where the scene's own next changes at the time that `scenes_s` finds.
    pub fn next_event_s(&self, after_s: f64, scenes_s: impl FnOnce() -> f64) -> f64 {
        if self.updates.is_empty() {
            return scenes_s();
        }
        let next = self.updates.partition_point(|(time_s, _)| *time_s <= after_s);
        let next_s = self.updates.get(next).map_or(f64::INFINITY, |(time_s, _)| *time_s);
        if next == 0 { next_s.min(scenes_s()) } else { next_s }
    }
}

/// Lines on which a finger is led.
#[derive(Clone, Debug, Default)]
pub struct FingerPath {
    /// In the order of time. Each holds until the next begins.
    lines: VecDeque<Line>,
}

/// A line from one place to another, reached at a later time.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// When it begins, s.
    pub from_s: f64,
    /// When the finger arrives, s.
    pub at_s: f64,
    /// Where it begins, mm from the sheet's centre.
    pub from_mm: [f64; 2],
    /// Where it ends, mm.
    pub to_mm: [f64; 2],
    /// At its end the finger stays; else it follows the scene.
    pub stays: bool,
    /// The finger's velocity changes where the line begins.
    is_kink: bool,
}

impl Line {
    /// The place at a time from its beginning on; none where the scene has the finger.
    fn at(&self, time_s: f64) -> Option<[f64; 2]> {
        if time_s >= self.at_s {
            return self.stays.then_some(self.to_mm);
        }
        // As the timelines of a scene have it.
        let (now_s, whole_s) = (time_s - self.from_s, self.at_s - self.from_s);
        Some([0, 1].map(|axis| {
            self.from_mm[axis] + (self.to_mm[axis] - self.from_mm[axis]) * now_s / whole_s
        }))
    }

    /// The velocity on it, mm/s.
    fn slope(&self) -> [f64; 2] {
        [0, 1].map(|axis| (self.to_mm[axis] - self.from_mm[axis]) / (self.at_s - self.from_s))
    }

    /// The velocity just before a time, mm/s; none where the scene has the finger.
    fn slope_before(&self, time_s: f64) -> Option<[f64; 2]> {
        if time_s <= self.at_s { Some(self.slope()) } else { self.stays.then_some([0.0; 2]) }
    }

    /// Whether the finger has arrived before a time, and stays.
    fn rests_at(&self, time_s: f64) -> bool {
        self.stays && self.at_s <= time_s
    }

    /// When its end is an event, if it is.
    fn end_event_s(&self) -> Option<f64> {
        (!self.stays || self.from_mm != self.to_mm).then_some(self.at_s)
    }
}

impl FingerPath {
    /// Whether a line can begin at `from_s` and end at `at_s`.
    pub(crate) fn check(&self, from_s: f64, at_s: f64, now_s: f64) -> Result<(), DriveError> {
        let earliest_s = self.lines.back().map_or(now_s, |line| line.from_s.max(now_s));
        check_time(from_s, earliest_s)?;
        let is_later = at_s > from_s && at_s.is_finite();
        if is_later { Ok(()) } else { Err(DriveError::Arrival { from_s, at_s }) }
    }

    /// From `from_s`, when the finger is at `from_mm`, it goes to `to_mm`, where it is at `at_s`; then it
    /// stays there or follows the scene. `from_s` is not before the last line's, and `at_s` is later.
    pub fn go(
        &mut self,
        [from_s, at_s]: [f64; 2],
        from_mm: [f64; 2],
        to_mm: [f64; 2],
        stays: bool,
    ) {
        // A finger that stays where it is: a pointer that rests adds nothing.
        if stays && from_mm == to_mm && self.lines.back().is_some_and(|line| line.rests_at(from_s))
        {
            return;
        }
        if self.lines.back().is_some_and(|line| line.from_s == from_s) {
            self.lines.pop_back();
        }
        let mut line = Line { from_s, at_s, from_mm, to_mm, stays, is_kink: true };
        let before = self.lines.back().and_then(|before| before.slope_before(from_s));
        line.is_kink = before != Some(line.slope());
        self.lines.push_back(line);
    }

    /// Effects have kept their state at the last kink, and ask for no time before.
    fn forget(&mut self, before_s: f64) {
        let is_past_kink = |line: &Line| line.is_kink && line.from_s <= before_s;
        let kept = self.lines.iter().rposition(is_past_kink).unwrap_or(0);
        self.lines.drain(..kept);
    }

    /// Where the finger is at a time; none where the scene has it.
    #[inline]
    pub fn at(&self, time_s: f64) -> Option<[f64; 2]> {
        if self.lines.is_empty() {
            return None;
        }
        let begun = self.lines.partition_point(|line| line.from_s <= time_s);
        self.lines[begun.checked_sub(1)?].at(time_s)
    }

    /// The lines, in the order of time.
    pub fn lines(&self) -> impl ExactSizeIterator<Item = &Line> {
        self.lines.iter()
    }

    /// When the finger next turns, where the scene's own next turns at the time that `scenes_s` finds.
    pub(crate) fn next_event_s(&self, after_s: f64, scenes_s: impl FnOnce() -> f64) -> f64 {
        if self.lines.is_empty() {
            return scenes_s();
        }
        let next_from_s =
            |n: usize| self.lines.get(n + 1).map_or(f64::INFINITY, |next| next.from_s);
        let events = self.lines.iter().enumerate().flat_map(|(n, line)| {
            let end_s = line.end_event_s().filter(|at_s| *at_s < next_from_s(n));
            [line.is_kink.then_some(line.from_s), end_s]
        });
        let next_s = events.flatten().find(|event_s| *event_s > after_s).unwrap_or(f64::INFINITY);
        // Where the finger follows the scene later, that begins with an event of its own.
        if self.at(after_s).is_none() { next_s.min(scenes_s()) } else { next_s }
    }
}
