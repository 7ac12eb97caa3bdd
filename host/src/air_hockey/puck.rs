// SPDX-License-Identifier: MIT OR Apache-2.0
//! The puck: free flight with friction, impacts on walls and mallets.
//!
//! ```text
//! free      |v|' = −μg,   s(t) = |v|·t − μg·t²/2
//! wall      v_n → −e_w·v_n
//! mallet    v_n → v_n − (1 + e)·(v − w)·n,   J = m·(1 + e)·|(v − w)·n|       (a mallet of infinite mass, velocity w)
//! ```
//!
//! Contacts are solved for in time: where a path meets a line or a circle that moves. So nothing is passed through,
//! however fast. Between two steps of at most 2 ms the path is taken as uniform, with its mean velocity: for μ = 0.02 that
//! is off by less than 0.1 µm.

use super::Rules;

/// The largest speed, mm/s.
const FASTEST_MM_S: f64 = 1e4;
/// Contacts of one step: a puck that is pinned between a mallet and a wall has no end of them.
const MOST_CONTACTS: usize = 32;

/// Place and velocity of the puck.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Puck {
    /// Its centre, mm from the sheet's.
    pub place_mm: [f64; 2],
    /// Its velocity, mm/s.
    pub velocity_mm_s: [f64; 2],
}

/// A mallet that moves uniformly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Moving {
    pub place_mm: [f64; 2],
    pub velocity_mm_s: [f64; 2],
}

impl Moving {
    fn at(&self, time_s: f64) -> [f64; 2] {
        [0, 1].map(|axis| self.place_mm[axis] + self.velocity_mm_s[axis] * time_s)
    }
}

/// What the puck meets.
#[derive(Clone, Copy)]
enum Contact {
    /// A wall across x (0) or y (1).
    Wall(usize),
    /// A mallet, by its number.
    Mallet(usize),
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

impl Puck {
    /// Its speed, mm/s.
    pub fn speed_mm_s(&self) -> f64 {
        self.velocity_mm_s[0].hypot(self.velocity_mm_s[1])
    }

    /// Goes on for a time, s, in which mallets move uniformly; adds the impulses on them, N·s. A goal ends it: 0 where the
    /// left player has scored, 1 where the right one has.
    pub(super) fn advance(
        &mut self,
        rules: &Rules,
        whole_s: f64,
        mallets: &[Option<Moving>],
        hits: &mut [f64],
    ) -> Option<usize> {
        let mut gone_s = 0.0;
        for _ in 0..MOST_CONTACTS {
            let mean = self.mean_mm_s(rules, whole_s - gone_s);
            let Some((in_s, contact)) =
                self.next_contact(rules, mean, (gone_s, whole_s - gone_s), mallets)
            else {
                self.go(rules, mean, whole_s - gone_s);
                break;
            };
            self.go(rules, mean, in_s);
            gone_s += in_s;
            match contact {
                Contact::Wall(0)
                    if self.place_mm[1].abs() <= rules.goal_half_mm - rules.puck_radius_mm =>
                {
                    return Some(usize::from(self.place_mm[0] < 0.0));
                }
                Contact::Wall(axis) => self.velocity_mm_s[axis] *= -rules.restitution_wall,
                Contact::Mallet(n) => {
                    hits[n] += mallets[n].map_or(0.0, |mallet| self.meet(rules, &mallet, gone_s));
                }
            }
        }
        self.keep_apart(rules, whole_s, mallets);
        None
    }

    /// Its mean velocity over a time.
    fn mean_mm_s(&self, rules: &Rules, time_s: f64) -> [f64; 2] {
        let (speed, slower) = (self.speed_mm_s(), rules.deceleration_mm_s2 * time_s);
        let share = match slower < speed {
            true => 1.0 - 0.5 * slower / speed,
            false if slower > 0.0 => 0.5 * speed / slower,
            false => 0.0,
        };
        self.velocity_mm_s.map(|velocity| share * velocity)
    }

    fn go(&mut self, rules: &Rules, mean: [f64; 2], time_s: f64) {
        let speed = self.speed_mm_s();
        if speed == 0.0 {
            return;
        }
        let share = (1.0 - rules.deceleration_mm_s2 * time_s / speed).max(0.0);
        for (place, mean) in self.place_mm.iter_mut().zip(mean) {
            *place += mean * time_s;
        }
        self.velocity_mm_s = self.velocity_mm_s.map(|velocity| velocity * share);
    }

    /// What it meets first within a time, and when.
    fn next_contact(
        &self,
        rules: &Rules,
        mean: [f64; 2],
        (gone_s, left_s): (f64, f64),
        mallets: &[Option<Moving>],
    ) -> Option<(f64, Contact)> {
        let reach_mm = rules.puck_reach_mm();
        let walls = (0..2).filter_map(|axis| {
            let away_mm = reach_mm[axis] - self.place_mm[axis] * mean[axis].signum();
            let speed = mean[axis].abs();
            (speed > 0.0).then(|| ((away_mm / speed).max(0.0), Contact::Wall(axis)))
        });
        let radius_mm = rules.puck_radius_mm + rules.mallet_radius_mm;
        let mallets = mallets.iter().enumerate().filter_map(|(n, mallet)| {
            let mallet = mallet.as_ref()?;
            let away = minus(self.place_mm, mallet.at(gone_s));
            let towards = minus(mean, mallet.velocity_mm_s);
            Some((meets_s(away, towards, radius_mm)?, Contact::Mallet(n)))
        });
        walls
            .chain(mallets)
            .filter(|(in_s, _)| *in_s < left_s)
            .min_by(|(a, _), (b, _)| a.total_cmp(b))
    }

    /// Bounces off a mallet; the impulse, N·s.
    fn meet(&mut self, rules: &Rules, mallet: &Moving, gone_s: f64) -> f64 {
        let Some(normal) = normal(minus(self.place_mm, mallet.at(gone_s))) else { return 0.0 };
        let closing = -dot(minus(self.velocity_mm_s, mallet.velocity_mm_s), normal);
        if closing <= 0.0 {
            // Friction has stopped it meanwhile.
            return 0.0;
        }
        let change = (1.0 + rules.restitution_mallet) * closing;
        for (velocity, normal) in self.velocity_mm_s.iter_mut().zip(normal) {
            *velocity += change * normal;
        }
        let speed = self.speed_mm_s();
        if speed > FASTEST_MM_S {
            self.velocity_mm_s = self.velocity_mm_s.map(|velocity| velocity * FASTEST_MM_S / speed);
        }
        1e-3 * rules.puck_kg * change
    }

    /// Moves it out of a mallet that was put on it or pins it, and back on the table. Its velocity stays.
    fn keep_apart(&mut self, rules: &Rules, gone_s: f64, mallets: &[Option<Moving>]) {
        let radius_mm = rules.puck_radius_mm + rules.mallet_radius_mm;
        let reach_mm = rules.puck_reach_mm();
        for mallet in mallets.iter().flatten() {
            let centre = mallet.at(gone_s);
            let away = minus(self.place_mm, centre);
            if dot(away, away) < radius_mm * radius_mm {
                self.place_mm = self.nearest_beside(centre, radius_mm, reach_mm);
            }
        }
        for (place, reach) in self.place_mm.iter_mut().zip(reach_mm) {
            *place = place.clamp(-reach, reach);
        }
    }

    /// The nearest place on the table at a distance from a mallet's centre: straight away from it, or where a wall is in the
    /// way, along that.
    fn nearest_beside(&self, centre: [f64; 2], radius_mm: f64, reach_mm: [f64; 2]) -> [f64; 2] {
        let normal = normal(minus(self.place_mm, centre)).unwrap_or([1.0, 0.0]);
        let straight = [0, 1].map(|axis| centre[axis] + radius_mm * normal[axis]);
        let is_on_table =
            |place: &[f64; 2]| place.iter().zip(reach_mm).all(|(mm, reach)| mm.abs() <= reach);
        if is_on_table(&straight) {
            return straight;
        }
        let on_wall = |axis: usize, wall_mm: f64, side: f64| {
            let across_mm = wall_mm - centre[axis];
            let along_mm = (radius_mm * radius_mm - across_mm * across_mm).max(0.0).sqrt();
            let mut place = [wall_mm; 2];
            place[1 - axis] = centre[1 - axis] + side * along_mm;
            (across_mm.abs() <= radius_mm).then_some(place)
        };
        let signs = [-1.0, 1.0];
        let walls =
            [0, 1].into_iter().flat_map(|axis| signs.map(|sign| (axis, sign * reach_mm[axis])));
        let places =
            walls.flat_map(|(axis, wall_mm)| signs.map(|side| on_wall(axis, wall_mm, side)));
        let off_mm = |place: &[f64; 2]| {
            let off = minus(*place, self.place_mm);
            dot(off, off)
        };
        let nearest =
            places.flatten().filter(is_on_table).min_by(|a, b| off_mm(a).total_cmp(&off_mm(b)));
        nearest.unwrap_or(straight)
    }
}

fn normal(away: [f64; 2]) -> Option<[f64; 2]> {
    let size = away[0].hypot(away[1]);
    (size > 0.0).then(|| away.map(|of| of / size))
}

/// When a point that is `away` of a circle's centre and moves by `towards` enters it; at once where it is inside and
/// goes further in.
fn meets_s(away: [f64; 2], towards: [f64; 2], radius: f64) -> Option<f64> {
    let (a, b) = (dot(towards, towards), dot(away, towards));
    if b >= 0.0 {
        return None;
    }
    let c = dot(away, away) - radius * radius;
    if c <= 0.0 {
        return Some(0.0);
    }
    let root = b * b - a * c;
    // −b − √ in the form that does not cancel.
    (root >= 0.0).then(|| c / (-b + root.sqrt()))
}
