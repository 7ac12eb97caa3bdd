// SPDX-License-Identifier: MIT OR Apache-2.0
//! Device time against wall time.
//!
//! ```text
//! due = Σ wall·speed − skipped        a slot is due once its end is
//! ```
//!
//! A loop that is more than 50 ms behind leaves out the rest, and says so: it never catches up, and never drops slots.
//! Pure: the caller passes the wall time.

/// How far behind the loop may be, s of wall time.
pub const MOST_BEHIND_S: f64 = 0.05;

/// Which slots are due.
#[derive(Debug, Clone)]
pub struct Pace {
    speed: f64,
    /// A client steps: time stands.
    stepped: bool,
    due_s: f64,
    seen_s: f64,
    skipped_s: f64,
}

impl Pace {
    /// Device time 0 at this wall time, s.
    pub fn new(wall_s: f64, speed: f64) -> Pace {
        Pace { speed, stepped: false, due_s: 0.0, seen_s: wall_s, skipped_s: 0.0 }
    }

    /// Device time by wall time that is asked for.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Sets it; 0 pauses. Ends stepping.
    pub fn set_speed(&mut self, speed: f64) {
        (self.speed, self.stepped) = (speed, false);
    }

    /// A client steps, or no longer does.
    pub fn set_stepped(&mut self, stepped: bool) {
        self.stepped = stepped;
    }

    /// Whether a client steps.
    pub fn is_stepped(&self) -> bool {
        self.stepped
    }

    /// Whether device time stands.
    pub fn stands(&self) -> bool {
        self.stepped || self.speed == 0.0
    }

    /// Wall time that was left out, s.
    pub fn skipped_s(&self) -> f64 {
        self.skipped_s
    }

    /// Lets wall time pass without device time.
    pub fn stand(&mut self, wall_s: f64) {
        self.seen_s = wall_s;
    }

    /// Continues from this device time: after slots that were not due, such as those of a step.
    pub fn restart_at(&mut self, device_s: f64) {
        self.due_s = device_s;
    }

    /// The device time up to which slots are due at a wall time. `next_end_s` is the end of the next slot: whatever is
    /// due beyond it for more than [`MOST_BEHIND_S`] is skipped.
    ///
    /// ```
    /// use hapticore_live::pace::Pace;
    ///
    /// let mut pace = Pace::new(0.0, 0.5);
    /// assert_eq!(pace.due_s(0.02, 0.001), 0.01); // half as fast
    /// assert_eq!(pace.due_s(9.0, 0.001), 0.001); // far behind: only the next slot is due
    /// assert!((pace.skipped_s() - 8.998).abs() < 1e-9);
    /// ```
    pub fn due_s(&mut self, wall_s: f64, next_end_s: f64) -> f64 {
        let passed_s = (wall_s - self.seen_s).max(0.0);
        self.seen_s = wall_s;
        if self.stands() {
            return self.due_s.min(next_end_s.next_down());
        }
        self.due_s += self.speed * passed_s;
        let behind_s = (self.due_s - next_end_s) / self.speed;
        if behind_s > MOST_BEHIND_S {
            self.skipped_s += behind_s;
            self.due_s = next_end_s;
        }
        self.due_s
    }

    /// Wall time until the next slot is due, s; infinite where time stands.
    pub fn wait_s(&self, next_end_s: f64) -> f64 {
        match self.stands() {
            true => f64::INFINITY,
            false => ((next_end_s - self.due_s) / self.speed).max(0.0),
        }
    }
}

/// Times in classes that are a quarter wider from one to the next, from 10 µs on.
#[derive(Debug, Clone)]
pub struct Histogram {
    counts: [u32; Histogram::CLASSES],
    largest_s: f64,
}

impl Default for Histogram {
    fn default() -> Self {
        Histogram { counts: [0; Histogram::CLASSES], largest_s: 0.0 }
    }
}

impl Histogram {
    const CLASSES: usize = 64;
    const FIRST_S: f64 = 1e-5;
    const WIDER: f64 = 1.25;

    /// Adds a time, s.
    pub fn add(&mut self, time_s: f64) {
        let class =
            (time_s.max(Histogram::FIRST_S) / Histogram::FIRST_S).ln() / Histogram::WIDER.ln();
        self.counts[(class as usize).min(Histogram::CLASSES - 1)] += 1;
        self.largest_s = self.largest_s.max(time_s);
    }

    /// The time that this share of all does not exceed, s, up to a quarter of it; 0 without any.
    ///
    /// ```
    /// use hapticore_live::pace::Histogram;
    ///
    /// let mut late = Histogram::default();
    /// (1..=100).for_each(|n| late.add(1e-3 * n as f64));
    /// assert!((0.05..0.0625).contains(&late.quantile_s(0.5)) && late.quantile_s(1.0) == 0.1);
    /// ```
    pub fn quantile_s(&self, share: f64) -> f64 {
        let all: u32 = self.counts.iter().sum();
        let wanted = (share * f64::from(all)).ceil().max(1.0) as u32;
        let mut sum = 0;
        let class = self.counts.iter().position(|count| {
            sum += count;
            sum >= wanted
        });
        let upper_s = |class: usize| Histogram::FIRST_S * Histogram::WIDER.powi(class as i32 + 1);
        class.map_or(0.0, |class| upper_s(class).min(self.largest_s))
    }
}
