// SPDX-License-Identifier: MIT OR Apache-2.0
//! A mallet: where it is by the frames of its pad, the force of impacts on it, its walls.
//!
//! ```text
//! m(n) = (p(n) + … + p(n−4))/5,   w = (m(n) − m(n−1))/(t(n) − t(n−1)) = (p(n) − p(n−5))/(5·T)
//! ```
//!
//! The mallet goes from mean to mean on straight lines. So its path and its velocity agree, which contacts need, and
//! noise of 0.05 mm becomes 7 mm/s at frames of 2 ms. It lags by two frames.

use hapticore_contract::control::Surface;

use super::Rules;
use super::puck::Moving;

/// Frames of a mean.
const FRAMES: usize = 5;
/// The side of a wall changes this far from the middle of its half, as a share of the way between both walls.
const HYSTERESIS: f64 = 0.05;

#[derive(Clone, Copy, Debug, Default)]
struct Sample {
    time_s: f64,
    place_mm: [f64; 2],
}

/// A force that ends.
#[derive(Clone, Copy, Debug, Default)]
struct Pulse {
    newtons: f64,
    until_s: f64,
}

#[derive(Clone, Debug)]
pub(super) struct Mallet {
    /// Where its centre may be: from and to, along x and y, mm.
    reach_mm: [[f64; 2]; 2],
    /// The last places as measured, in a ring.
    measured_mm: [[f64; 2]; FRAMES],
    next: usize,
    /// The last two means; none where the mallet is not on the table.
    line: Option<[Sample; 2]>,
    pulse: Pulse,
    /// The wall along x and along y is that of the greater coordinate.
    above: [bool; 2],
    /// It has had a place.
    is_placed: bool,
}

impl Mallet {
    pub fn new(reach_mm: [[f64; 2]; 2]) -> Mallet {
        Mallet {
            reach_mm,
            measured_mm: [[0.0; 2]; FRAMES],
            next: 0,
            line: None,
            pulse: Pulse::default(),
            above: [false; 2],
            is_placed: false,
        }
    }

    pub fn reach_mm(&self) -> [[f64; 2]; 2] {
        self.reach_mm
    }

    /// Takes a frame.
    pub fn take(&mut self, time_s: f64, place_mm: Option<[f64; 2]>) {
        let Some(place_mm) = place_mm.filter(|mm| mm.iter().all(|mm| mm.is_finite())) else {
            (self.line, self.pulse) = (None, Pulse::default());
            return;
        };
        self.choose_walls(place_mm);
        if self.line.is_none() {
            self.measured_mm = [place_mm; FRAMES];
        }
        self.measured_mm[self.next] = place_mm;
        self.next = (self.next + 1) % FRAMES;
        let mean = Sample { time_s, place_mm: self.mean_mm() };
        self.line = Some([self.line.map_or(mean, |[_, last]| last), mean]);
    }

    fn mean_mm(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.measured_mm.iter().map(|mm| mm[axis]).sum::<f64>() / FRAMES as f64)
    }

    /// The nearer wall along each axis; the side stays near the middle.
    fn choose_walls(&mut self, place_mm: [f64; 2]) {
        for (axis, [from_mm, to_mm]) in self.reach_mm.into_iter().enumerate() {
            let beyond_mm = place_mm[axis] - 0.5 * (from_mm + to_mm);
            let stays_mm = if self.is_placed { HYSTERESIS * (to_mm - from_mm) } else { 0.0 };
            if beyond_mm.abs() > stays_mm {
                self.above[axis] = beyond_mm > 0.0;
            }
        }
        self.is_placed = true;
    }

    /// Until when its place is known, s; none where it is not on the table.
    pub fn known_s(&self) -> Option<f64> {
        self.line.map(|[_, last]| last.time_s)
    }

    /// The next time at which its velocity changes, s.
    pub fn turn_s(&self, after_s: f64) -> Option<f64> {
        self.line?.map(|sample| sample.time_s).into_iter().find(|time_s| *time_s > after_s)
    }

    /// Where it is at a time, and how fast until it turns; none where it is not on the table then.
    pub fn moving(&self, at_s: f64) -> Option<Moving> {
        let [from, to] = self.line?;
        let whole_s = to.time_s - from.time_s;
        if at_s < from.time_s || whole_s <= 0.0 {
            return None;
        }
        if at_s >= to.time_s {
            return Some(Moving { place_mm: to.place_mm, velocity_mm_s: [0.0; 2] });
        }
        let velocity_mm_s = [0, 1].map(|axis| (to.place_mm[axis] - from.place_mm[axis]) / whole_s);
        let gone_s = at_s - from.time_s;
        let place_mm = [0, 1].map(|axis| from.place_mm[axis] + velocity_mm_s[axis] * gone_s);
        Some(Moving { place_mm, velocity_mm_s })
    }

    /// Takes an impulse, N·s, besides what is left of the last ones.
    pub fn feel(&mut self, hit_n_s: f64, now_s: f64, rules: &Rules) {
        if hit_n_s > 0.0 && self.line.is_some() {
            let left_n_s = self.pulse.newtons * (self.pulse.until_s - now_s).max(0.0);
            let newtons = ((left_n_s + hit_n_s) / rules.impact_s).min(rules.most_n);
            self.pulse = Pulse { newtons, until_s: now_s + rules.impact_s };
        }
    }

    pub fn target_n(&self, now_s: f64) -> f64 {
        if now_s < self.pulse.until_s { self.pulse.newtons } else { 0.0 }
    }

    pub fn surfaces(&self) -> [Surface; 2] {
        [0, 1].map(|axis| {
            let right = self.above[axis];
            Surface { mm: self.reach_mm[axis][usize::from(right)], right }
        })
    }
}
