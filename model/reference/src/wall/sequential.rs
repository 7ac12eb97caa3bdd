// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rules A and B: a sequential test (CUSUM) on the direction, play of the position, an offset learnt
//! in free air.
//!
//! ```text
//! x̄ += (x − x̄)/4,   v += (Δx/T − v)/8
//! free air (x̄ > 0.2 mm, 0 V for 10 ms):  v < −10 mm/s: u_in += (u − u_in)/64,  v > 10: u_out likewise    (/4 the first 16 times)
//! off = (u_in + u_out)/2,  b = max((u_out − u_in)/2, 0.0015);  one side alone: u_in + 0.006, u_out − 0.006;  none: factory offset
//! y = clamp((u − off)/σ, ±4),   σ = 2^-8, or 2^-7 where 0.886·mean|Δu| > 0.0055
//! x ≥ 0   PUSH, S = E = 0, gain = 1
//! PUSH    S = max(0, S + y + bf·b/σ − ½);  v < −20 mm/s: S = min(S, h1);  S > h1 or x̄ − min x̄ > 0.2 mm → FREE
//! FREE    E = max(0, E − y − ½ − kb·b/σ);  E > h2 and v ≤ 20 mm/s, or max x̄ − x̄ > 0.2 mm → PUSH, gain = 0
//! F = min(k_w·|x|, F_max)·gain,   gain += 1/40 per ms, up to 1; 0 where the pad slides along the surface: see `motion.rs`
//! ```
//!
//! Rule B, whose halves brake too, lets the force of a push that may have ended fall: see `pressed.rs`.
//!
//! A state is left when its dwell is over. u's mean |Δu| is taken in free air. Without current, or
//! with a part open, there is no evidence, y = 0, and nothing is learnt; a pad without any current is
//! let go. Source: docs/physics.md §6.

use super::motion::Motion;
use super::pressed::{Fade, Pressed};
use super::{Direction, Frame, Rule, Stiffness, Target};
use hapticore_contract::profile::{Release, Wall};

/// Asymmetry of a push that only overcomes friction, until it is learnt.
const FRICTION_AT_FIRST: f64 = 0.006;
/// The least that is taken for it.
const LEAST_FRICTION: f64 = 0.0015;
/// Frames of one side that are learnt fast, before it counts.
const FAST: u32 = 16;
/// Play of the position, mm.
const PLAY_MM: f64 = 0.2;

/// What tells rule A from rule B.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Test {
    /// What lets go.
    pub h1: f64,
    /// What engages again.
    pub h2: f64,
    /// By how much of b engaging is delayed.
    pub kb: f64,
    /// By how much of b letting go is advanced.
    pub bf: f64,
    /// How long a state lasts at least, ms.
    pub dwell_ms: f64,
    /// When the force of a stationary push falls, if it may.
    pub fade: Option<Fade>,
}

impl Test {
    /// Rule A, for a pad whose sensing strips stay at a low voltage.
    pub const A: Test = Test { h1: 3.0, h2: 8.0, kb: 1.0, bf: 0.3, dwell_ms: 20.0, fade: None };
    /// Rule B, for halves that sense and brake.
    pub const B: Test = Test {
        h1: 4.0,
        h2: 12.0,
        kb: 1.5,
        bf: 0.0,
        dwell_ms: 64.0,
        fade: Some(Fade { quiet_ms: 100.0, slip_mm: 0.025, latch_n: 0.75 }),
    };
}

/// The direction as it reads in free air, moving one way.
#[derive(Clone, Copy, Debug)]
struct Side {
    u: f64,
    frames: u32,
}

impl Side {
    fn learn(&mut self, u: f64) {
        self.u += (u - self.u) / if self.frames < FAST { 4.0 } else { 64.0 };
        self.frames = (self.frames + 1).min(FAST);
    }

    fn is_known(&self) -> bool {
        self.frames == FAST
    }
}

/// What a wall's rule goes by besides its test.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Numbers {
    rule: Release,
    /// Distance from the wall at which air is free, mm.
    clear_mm: f64,
    /// Time without voltage after which the direction is learnt, ms.
    zero_ms: f64,
    /// Speeds from which it is learnt, and beyond which only play releases, mm/s.
    learn_mm_s: f64,
    fast_mm_s: f64,
    play_mm: f64,
    /// Time in which the force comes back, ms.
    ramp_ms: f64,
}

impl Numbers {
    const USUAL: Numbers = Numbers {
        rule: Release::Sequential,
        clear_mm: 0.2,
        zero_ms: 10.0,
        learn_mm_s: 10.0,
        fast_mm_s: 20.0,
        play_mm: PLAY_MM,
        ramp_ms: 40.0,
    };

    /// Of a profile, a frame being a millisecond, so that 1 µm per frame is 1 mm/s.
    fn of(wall: &Wall) -> Numbers {
        Numbers {
            rule: wall.rule,
            clear_mm: 1e-3 * wall.clear_um as f64,
            zero_ms: wall.zero_frames as f64,
            learn_mm_s: wall.learn_um as f64,
            fast_mm_s: wall.fast_um as f64,
            play_mm: 1e-3 * wall.play_um as f64,
            ramp_ms: wall.ramp_frames as f64,
        }
    }
}

/// A wall by rule A or B.
#[derive(Clone, Debug)]
pub struct Sequential {
    stiffness: Stiffness,
    test: Test,
    numbers: Numbers,
    factory: f64,
    frame_ms: f64,
    /// Last x, filtered x and speed; nothing before the first frame.
    motion: Option<[f64; 3]>,
    u: f64,
    /// Mean |Δu| in free air.
    change: f64,
    zero_ms: f64,
    inwards: Side,
    outwards: Side,
    direction: Direction,
    /// S or E.
    evidence: f64,
    /// The filtered place farthest in or farthest out of the state.
    extreme_mm: f64,
    since_ms: f64,
    gain: f64,
    /// Filtered u.
    slow_u: f64,
    pressed: Pressed,
    lead: Motion,
    other_free: bool,
    /// The force that was asked for last, N.
    last_n: f64,
}

impl Sequential {
    /// A wall of a pad whose direction reads `factory` without a push when it leaves the factory.
    pub fn new(stiffness: Stiffness, test: Test, factory: f64, frame_ms: f64) -> Self {
        let side = Side { u: factory, frames: 0 };
        Sequential {
            stiffness,
            test,
            numbers: Numbers::USUAL,
            factory,
            frame_ms,
            motion: None,
            u: factory,
            change: 0.0,
            zero_ms: 0.0,
            inwards: side,
            outwards: side,
            direction: Direction::Push,
            evidence: 0.0,
            extreme_mm: 0.0,
            since_ms: f64::INFINITY,
            gain: 0.0,
            slow_u: factory,
            pressed: Pressed::at(factory, 0.0),
            lead: Motion::default(),
            other_free: false,
            last_n: 0.0,
        }
    }

    /// The same with the numbers of a profile, whose unit of time is a frame.
    pub fn of_profile(stiffness: Stiffness, wall: &Wall, factory: f64) -> Self {
        let test = Test {
            h1: wall.release as f64,
            h2: wall.engage as f64,
            kb: wall.delay_16 as f64 / 16.0,
            bf: wall.advance_16 as f64 / 16.0,
            dwell_ms: wall.dwell_frames as f64,
            fade: (wall.quiet_frames > 0).then_some(Fade {
                quiet_ms: wall.quiet_frames as f64,
                slip_mm: 1e-3 * wall.slip_um as f64,
                latch_n: 1e-3 * wall.latch_mn as f64,
            }),
        };
        Sequential { numbers: Numbers::of(wall), ..Sequential::new(stiffness, test, factory, 1.0) }
    }

    /// Sets what the direction reads without a push when it leaves the factory: the wall is now on the other side of the
    /// pad. What it has learnt in free air stays.
    pub fn set_factory(&mut self, factory: f64) {
        self.factory = factory;
        if self.motion.is_none() {
            (self.u, self.slow_u) = (factory, factory);
            (self.inwards.u, self.outwards.u) = (factory, factory);
            self.pressed = Pressed::at(factory, 0.0);
        }
    }

    /// Sets whether the user leaves the pad's other wall: then this one brakes only a pad that goes into it.
    pub fn set_other_free(&mut self, free: bool) {
        self.other_free = free;
    }

    /// Filtered place and speed, mm and mm/s.
    fn follow(&mut self, x_mm: f64) -> (f64, f64) {
        let [last, filtered, speed] = self.motion.unwrap_or([x_mm, x_mm, 0.0]);
        let filtered = filtered + (x_mm - filtered) / 4.0;
        let speed = speed + (1e3 * (x_mm - last) / self.frame_ms - speed) / 8.0;
        self.motion = Some([x_mm, filtered, speed]);
        (filtered, speed)
    }

    fn learn(&mut self, change: f64, filtered_mm: f64, speed_mm_s: f64) {
        let Numbers { clear_mm, zero_ms, learn_mm_s, .. } = self.numbers;
        if filtered_mm <= clear_mm || self.zero_ms < zero_ms {
            return;
        }
        self.change += (change.abs() - self.change) / 64.0;
        if speed_mm_s < -learn_mm_s {
            self.inwards.learn(self.u);
        } else if speed_mm_s > learn_mm_s {
            self.outwards.learn(self.u);
        }
    }

    /// Offset, and what a push that only overcomes friction reads.
    fn calibration(&self) -> (f64, f64) {
        let (into, out) = (self.inwards, self.outwards);
        match (into.is_known(), out.is_known()) {
            (true, true) => ((into.u + out.u) / 2.0, ((out.u - into.u) / 2.0).max(LEAST_FRICTION)),
            (true, false) => (into.u + FRICTION_AT_FIRST, FRICTION_AT_FIRST),
            (false, true) => (out.u - FRICTION_AT_FIRST, FRICTION_AT_FIRST),
            (false, false) => (self.factory, FRICTION_AT_FIRST),
        }
    }

    fn enter(&mut self, direction: Direction, filtered_mm: f64) {
        self.direction = direction;
        self.evidence = 0.0;
        self.extreme_mm = filtered_mm;
        self.pressed = Pressed::at(self.slow_u, filtered_mm);
    }

    /// Whether the state is to be left.
    fn test(&mut self, y: f64, bias: f64, filtered_mm: f64, speed_mm_s: f64) -> bool {
        let Test { h1, h2, kb, bf, dwell_ms, fade } = self.test;
        let Numbers { fast_mm_s, play_mm, .. } = self.numbers;
        let is_over = match self.direction {
            Direction::Push => {
                self.extreme_mm = self.extreme_mm.min(filtered_mm);
                let y = if fade.is_some_and(|fade| self.last_n > fade.latch_n) {
                    y.min(0.0)
                } else {
                    y
                };
                self.evidence = (self.evidence + y + bf * bias - 0.5).max(0.0);
                if speed_mm_s < -fast_mm_s {
                    self.evidence = self.evidence.min(h1);
                }
                self.evidence > h1 || filtered_mm - self.extreme_mm > play_mm
            }
            Direction::Free => {
                self.extreme_mm = self.extreme_mm.max(filtered_mm);
                self.evidence = (self.evidence - y - 0.5 - kb * bias).max(0.0);
                (self.evidence > h2 && speed_mm_s <= fast_mm_s)
                    || self.extreme_mm - filtered_mm > play_mm
            }
        };
        is_over && self.since_ms >= dwell_ms
    }

    /// What a frame adds to the gain.
    fn gain_step(&mut self, sigma: f64, filtered_mm: f64) -> f64 {
        let steps = match self.test.fade.filter(|_| self.direction == Direction::Push) {
            Some(fade) => {
                self.pressed.steps(&fade, (self.slow_u, sigma), filtered_mm, self.frame_ms)
            }
            None => 1.0,
        };
        steps * self.frame_ms / self.numbers.ramp_ms
    }
}

impl Rule for Sequential {
    fn frame(&mut self, frame: &Frame) -> (Target, Direction) {
        let (filtered_mm, speed_mm_s) = self.follow(frame.x_mm);
        let read = frame.direction();
        let u = read.unwrap_or(self.u);
        let change = u - std::mem::replace(&mut self.u, u);
        self.zero_ms = if frame.at_zero { self.zero_ms + self.frame_ms } else { 0.0 };
        if read.is_some() {
            self.learn(change, filtered_mm, speed_mm_s);
        }
        let (offset, friction) = self.calibration();
        let sigma = if 0.886 * self.change > 0.0055 { 2f64.powi(-7) } else { 2f64.powi(-8) };
        let y = read.map_or(0.0, |u| ((u - offset) / sigma).clamp(-4.0, 4.0));
        self.since_ms += self.frame_ms;
        self.slow_u += (u - self.slow_u) / 8.0;
        let slides =
            self.lead.slides([filtered_mm, frame.along_mm], self.other_free, self.numbers.play_mm);
        if self.numbers.rule != Release::Sequential {
            let leads_out = self.numbers.rule == Release::Direct && frame.x_mm < 0.0 && y > 0.0;
            self.direction = if leads_out { Direction::Free } else { Direction::Push };
            self.gain = 1.0;
        } else if frame.x_mm >= 0.0 {
            self.enter(Direction::Push, filtered_mm);
            if self.test.fade.is_none() {
                self.since_ms = f64::INFINITY;
            }
            self.gain = 1.0;
        } else if self.test(y, friction / sigma, filtered_mm, speed_mm_s) {
            self.since_ms = 0.0;
            self.gain = 0.0;
            match self.direction {
                Direction::Push => self.enter(Direction::Free, filtered_mm),
                Direction::Free => self.enter(Direction::Push, filtered_mm),
            }
        } else {
            self.gain = (self.gain + self.gain_step(sigma, filtered_mm)).clamp(0.0, 1.0);
        }
        if self.numbers.rule == Release::Sequential && slides {
            self.gain = 0.0;
        }
        let force_n = match self.direction {
            _ if frame.left + frame.right <= 0.0 => 0.0,
            Direction::Push => self.stiffness.at(frame.x_mm) * self.gain,
            Direction::Free => 0.0,
        };
        self.last_n = force_n;
        (Target::Force(force_n), self.direction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number that is turned in one place alone is noticed.
    #[test]
    fn numbers_of_profiles_are_those_of_the_rules_at_frames_of_a_millisecond() {
        let stiffness = Stiffness { n_per_mm: 0.5, most_n: 1.0 };
        for (wall, test) in [(Wall::A, Test::A), (Wall::B, Test::B), (Wall::QUADRANTS, Test::B)] {
            let of = Sequential::of_profile(stiffness, &wall, 0.0);
            let sixteenths = |of: f64| (16.0 * of).round() / 16.0;
            assert_eq!(of.test, Test { bf: sixteenths(test.bf), kb: sixteenths(test.kb), ..test });
            assert_eq!(of.numbers, Numbers::USUAL);
        }
    }
}
