// SPDX-License-Identifier: MIT OR Apache-2.0
//! A hand: a spring, a damper and a mass that pull the pad after a target, tremor, and a load.
//!
//! Targets go from place to place by minimum jerk, s(τ) = 10τ³ − 15τ⁴ + 6τ⁵ (Flash and Hogan, 1985).
//! A press of P newtons into a wall of k_w aims P/k beyond the depth P/k_w at which the pad is then
//! held.

use std::f64::consts::TAU;

use fastrand::Rng;

/// What the hand is about in a part of its trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// To and fro before the wall.
    Air,
    /// Towards the wall and into it.
    Enter,
    /// Pressing against it.
    Press,
    /// Along its surface, pressing against it.
    Slide,
    /// Out of it, slowly.
    LeaveSlowly,
    /// Out of it, fast.
    LeaveFast,
    /// To and fro about its surface.
    Hover,
}

/// A part of a trial, from the end of the one before.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// What it is.
    pub phase: Phase,
    /// When it ends, s.
    pub end_s: f64,
    /// Where the hand's target then is, mm.
    pub to_mm: f64,
}

/// A hand and what it does.
#[derive(Clone, Debug)]
pub struct Hand {
    /// Stiffness of arm and finger, N/m.
    pub stiffness_n_per_m: f64,
    /// Damping, N·s/m.
    pub damping_n_s_per_m: f64,
    /// Mass that moves with the pad, kg.
    pub mass_kg: f64,
    /// Load on the pad, N.
    pub load_n: f64,
    /// Tremor: amplitude in mm, frequency in Hz, phase in turns.
    pub tremor: [f64; 3],
    /// What it does.
    pub parts: Vec<Part>,
    /// Where its target is along the surface: s, mm, straight in between; nowhere else without a point.
    pub along: Vec<[f64; 2]>,
}

/// Where every trial begins, mm.
const START_MM: f64 = 12.0;

/// How far hands slide along the surface, mm.
const SLIDE_MM: f64 = 20.0;

impl Hand {
    /// A hand drawn at random, at a wall of `wall_n_per_mm` N/mm.
    pub fn draw(seed: u64, wall_n_per_mm: f64) -> Hand {
        let mut rng = Rng::with_seed(seed);
        let mut between = |low: f64, high: f64| low + (high - low) * rng.f64();
        let stiffness_n_per_m = 100.0 * 10f64.powf(between(0.0, 1.0));
        let mass_kg = 0.02 * 10f64.powf(between(0.0, 1.0));
        let damping = 2.0 * between(0.4, 1.0) * (stiffness_n_per_m * mass_kg).sqrt();
        let tremor_mm = (1e3 * between(0.01, 0.04) / stiffness_n_per_m).min(0.1);
        let tremor = [tremor_mm, between(8.0, 12.0), between(0.0, 1.0)];
        let load_n = between(0.4, 1.2);
        let aim_mm = |press_n: f64| aim_mm(press_n, stiffness_n_per_m, wall_n_per_mm);
        let mut plan = Plan { parts: Vec::new(), at_mm: START_MM, time_s: 0.0 };
        for to_mm in [4.0, 11.0, 3.0] {
            plan.go(Phase::Air, to_mm, between(20.0, 60.0));
        }
        // Slow out, fast out, slow out again: each after a press of its own.
        for (phase, speeds) in [
            (Phase::LeaveSlowly, [5.0, 25.0]),
            (Phase::LeaveFast, [100.0, 300.0]),
            (Phase::LeaveSlowly, [5.0, 25.0]),
        ] {
            let press_n = between(0.3, 0.8);
            plan.go(Phase::Enter, aim_mm(press_n), between(15.0, 80.0));
            plan.wait(Phase::Press, between(0.2, 0.5));
            plan.go(phase, between(3.0, 8.0), between(speeds[0], speeds[1]));
            plan.wait(Phase::Air, 0.1);
            if phase == Phase::LeaveFast {
                for _ in 0..2 {
                    plan.go(Phase::Hover, aim_mm(between(0.1, 0.25)), between(10.0, 30.0));
                    plan.go(Phase::Hover, between(0.5, 2.0), between(10.0, 30.0));
                }
            }
        }
        Hand {
            stiffness_n_per_m,
            damping_n_s_per_m: damping,
            mass_kg,
            load_n,
            tremor,
            parts: plan.parts,
            along: Vec::new(),
        }
    }

    /// The hand of a seed. It goes to and fro in air, then presses slowly into the wall with
    /// `press_n` newtons and stays there.
    pub fn pressing(seed: u64, wall_n_per_mm: f64, press_n: f64) -> Hand {
        let hand = Hand::draw(seed, wall_n_per_mm);
        let mut plan = Plan { parts: Vec::new(), at_mm: START_MM, time_s: 0.0 };
        for to_mm in [4.0, 11.0, 3.0] {
            plan.go(Phase::Air, to_mm, 40.0);
        }
        plan.go(Phase::Enter, aim_mm(press_n, hand.stiffness_n_per_m, wall_n_per_mm), 20.0);
        plan.wait(Phase::Press, 0.5);
        Hand { parts: plan.parts, ..hand }
    }

    /// The hand of a seed. It goes to and fro in air, presses into the wall, and slides along its surface by 20 mm while it
    /// presses on.
    pub fn sliding(seed: u64, wall_n_per_mm: f64, mm_per_s: f64) -> Hand {
        let hand = Hand::draw(seed, wall_n_per_mm);
        let press_n = 0.3 + 0.5 * Rng::with_seed(!seed).f64();
        let mut plan = Plan { parts: Vec::new(), at_mm: START_MM, time_s: 0.0 };
        for to_mm in [4.0, 11.0, 3.0] {
            plan.go(Phase::Air, to_mm, 40.0);
        }
        plan.go(Phase::Enter, aim_mm(press_n, hand.stiffness_n_per_m, wall_n_per_mm), 40.0);
        plan.wait(Phase::Press, 0.3);
        let begins_s = plan.time_s;
        plan.wait(Phase::Slide, SLIDE_MM / mm_per_s);
        let along = vec![[begins_s, 0.0], [plan.time_s, SLIDE_MM]];
        Hand { parts: plan.parts, along, ..hand }
    }

    /// The hand of a seed. It goes to and fro in air, crosses the surface at a mean speed, presses with 0.8 N and leaves twice
    /// as fast.
    pub fn crossing(seed: u64, wall_n_per_mm: f64, mm_per_s: f64) -> Hand {
        let hand = Hand::draw(seed, wall_n_per_mm);
        let mut plan = Plan { parts: Vec::new(), at_mm: START_MM, time_s: 0.0 };
        for to_mm in [4.0, 11.0, 6.0] {
            plan.go(Phase::Air, to_mm, 40.0);
        }
        plan.go(Phase::Enter, aim_mm(0.8, hand.stiffness_n_per_m, wall_n_per_mm), mm_per_s);
        plan.wait(Phase::Press, 0.3);
        plan.go(Phase::LeaveFast, 8.0, 2.0 * mm_per_s);
        Hand { parts: plan.parts, ..hand }
    }

    /// How the paper's authors went through a wall once: in by 10 mm, a pause, out again.
    pub fn of_the_paper() -> Hand {
        let mut plan = Plan { parts: Vec::new(), at_mm: START_MM, time_s: 0.0 };
        plan.go(Phase::Air, 4.0, 20.0);
        plan.go(Phase::Air, 8.0, 20.0);
        plan.go(Phase::Enter, -4.0, 20.0);
        plan.wait(Phase::Press, 0.5);
        plan.go(Phase::LeaveSlowly, 8.0, 20.0);
        let parts = plan.parts;
        let (stiffness_n_per_m, damping_n_s_per_m, mass_kg, load_n) = (300.0, 3.0, 0.05, 0.8);
        Hand {
            stiffness_n_per_m,
            damping_n_s_per_m,
            mass_kg,
            load_n,
            tremor: [0.0, 10.0, 0.0],
            parts,
            along: Vec::new(),
        }
    }

    /// How long the trial takes, s.
    pub fn duration_s(&self) -> f64 {
        self.parts.last().map_or(0.0, |part| part.end_s)
    }

    /// What the hand is about at a time, and which of its parts that is.
    pub fn phase(&self, time_s: f64) -> (usize, Phase) {
        let n = self.parts.partition_point(|part| part.end_s <= time_s).min(self.parts.len() - 1);
        (n, self.parts[n].phase)
    }

    /// Its target, mm.
    pub fn target_mm(&self, time_s: f64) -> f64 {
        let (n, _) = self.phase(time_s);
        let (from_s, from_mm) = n
            .checked_sub(1)
            .map_or((0.0, START_MM), |n| (self.parts[n].end_s, self.parts[n].to_mm));
        let part = self.parts[n];
        let share = ((time_s - from_s) / (part.end_s - from_s)).clamp(0.0, 1.0);
        let smooth = share.powi(3) * (10.0 + share * (6.0 * share - 15.0));
        let [amplitude_mm, hz, turns] = self.tremor;
        from_mm
            + (part.to_mm - from_mm) * smooth
            + amplitude_mm * (TAU * (hz * time_s + turns)).sin()
    }
}

/// Where a hand aims to press with `press_n` newtons.
fn aim_mm(press_n: f64, hand_n_per_m: f64, wall_n_per_mm: f64) -> f64 {
    -press_n * (1e3 / hand_n_per_m + 1.0 / wall_n_per_mm)
}

/// A trial as it is put together.
struct Plan {
    parts: Vec<Part>,
    at_mm: f64,
    time_s: f64,
}

impl Plan {
    /// To a place at a mean speed.
    fn go(&mut self, phase: Phase, to_mm: f64, mm_per_s: f64) {
        self.time_s += (to_mm - self.at_mm).abs() / mm_per_s;
        self.at_mm = to_mm;
        self.parts.push(Part { phase, end_s: self.time_s, to_mm });
    }

    fn wait(&mut self, phase: Phase, seconds: f64) {
        self.time_s += seconds;
        self.parts.push(Part { phase, end_s: self.time_s, to_mm: self.at_mm });
    }
}
