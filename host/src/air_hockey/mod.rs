// SPDX-License-Identifier: MIT OR Apache-2.0
//! Air hockey: a puck and mallets that are pads, played by a host on a board's frames.
//!
//! ```text
//! frames of pads ─[place of each mallet, mean of five frames]─ mallets ─┐
//!                                                        puck ─[advance]┴─ puck, score
//!                                    impulse J ─[J/T for T]─ target of the pad, N
//!                            place ─[nearer wall of its half]─ surfaces of the pad's walls
//! ```
//!
//! A pad can only brake. A player feels an impact as a force J/T against the motion of the mallet, for the time T, and
//! the arena as walls along x and y. A pad has one wall along each axis: the nearer one of its half, whose side changes
//! in the middle, with hysteresis.
//!
//! The game is a pure function of its frames: the same frames give the same puck, to the bit. It allocates nothing
//! after [`Game::new`]. The puck is as late as the frames are: some 6 ms at frames of 2 ms.
//!
//! Source: Nakamura and Yamamoto, A multi-user surface visuo-haptic display, IEEE Trans. Haptics 2016, for what the
//! game is; rigid bodies with restitution and Coulomb friction for how the puck moves (docs/physics.md §6).

mod mallet;
mod puck;

use hapticore_contract::control::Surface;

use mallet::Mallet;
use puck::Moving;
pub use puck::Puck;

/// How long puck and mallets may go without a frame, s: the puck leaves out longer gaps.
const LONGEST_GAP_S: f64 = 0.1;
/// How long its path is taken as straight and uniform, s.
const STEP_S: f64 = 2e-3;

/// The table, the puck and the impacts.
#[derive(Clone, Debug, PartialEq)]
pub struct Rules {
    /// Half of the table's length and of its height, mm; its centre is the sheet's.
    pub half_mm: [f64; 2],
    /// Half of a goal's width, mm.
    pub goal_half_mm: f64,
    /// Radius of a mallet, mm.
    pub mallet_radius_mm: f64,
    /// Radius of the puck, mm.
    pub puck_radius_mm: f64,
    /// Mass of the puck, kg.
    pub puck_kg: f64,
    /// By how much friction slows the puck, mm/s².
    pub deceleration_mm_s2: f64,
    /// Where the puck is served, mm, and how fast, mm/s.
    pub serve: Puck,
    /// Speed after by speed before an impact on a wall.
    pub restitution_wall: f64,
    /// The same on a mallet.
    pub restitution_mallet: f64,
    /// How long a mallet feels an impact, s.
    pub impact_s: f64,
    /// The most that an impact gives, N.
    pub most_n: f64,
}

impl Rules {
    /// Where the centre of a mallet of the left half, or of the right one, may be: from and to along x, then along y,
    /// mm.
    pub fn reach_mm(&self, left: bool) -> [[f64; 2]; 2] {
        let [x_mm, y_mm] = self.half_mm.map(|half| half - self.mallet_radius_mm);
        let along_x = match left {
            true => [-x_mm, -self.mallet_radius_mm],
            false => [self.mallet_radius_mm, x_mm],
        };
        [along_x, [-y_mm, y_mm]]
    }

    /// How far from the table's centre that of the puck may be, mm.
    pub fn puck_reach_mm(&self) -> [f64; 2] {
        self.half_mm.map(|half| half - self.puck_radius_mm)
    }
}

/// A game at some time.
///
/// ```
/// use hapticore_host::air_hockey::{Game, Puck, Rules};
///
/// let rules = Rules {
///     half_mm: [300.0, 180.0],
///     goal_half_mm: 60.0,
///     mallet_radius_mm: 15.0,
///     puck_radius_mm: 12.0,
///     puck_kg: 0.02,
///     deceleration_mm_s2: 0.0,
///     serve: Puck { place_mm: [0.0; 2], velocity_mm_s: [-500.0, 0.0] },
///     restitution_wall: 0.9,
///     restitution_mallet: 0.8,
///     impact_s: 0.03,
///     most_n: 1.0,
/// };
/// let mut game = Game::new(rules, &[true]); // one mallet, in the left half
/// for frame in 0..200 {
///     game.frame(0, 2e-3 * f64::from(frame), Some([-100.0, 0.0]));
/// }
/// assert_eq!(game.puck().velocity_mm_s, [400.0, 0.0]); // 0.8 of 500 mm/s, to the right
/// ```
#[derive(Clone, Debug)]
pub struct Game {
    rules: Rules,
    puck: Puck,
    mallets: Vec<Mallet>,
    /// When the puck is where it is, s; none before the first frame.
    played_s: Option<f64>,
    /// The latest frame's time, s.
    now_s: f64,
    score: [u32; 2],
    /// Of each mallet, while the puck advances: how it moves, and the impulses on it, N·s.
    moving: Vec<Option<Moving>>,
    hits: Vec<f64>,
}

impl Game {
    /// A game before its first frame, the puck served. `left` says of each mallet that it plays the left half.
    pub fn new(rules: Rules, left: &[bool]) -> Game {
        let mallets: Vec<Mallet> =
            left.iter().map(|left| Mallet::new(rules.reach_mm(*left))).collect();
        Game {
            puck: rules.serve,
            moving: vec![None; mallets.len()],
            hits: vec![0.0; mallets.len()],
            rules,
            mallets,
            played_s: None,
            now_s: 0.0,
            score: [0; 2],
        }
    }

    /// The rules.
    pub fn rules(&self) -> &Rules {
        &self.rules
    }

    /// The puck, as of the latest frames.
    pub fn puck(&self) -> Puck {
        self.puck
    }

    /// Goals of the left player and of the right one.
    pub fn score(&self) -> [u32; 2] {
        self.score
    }

    /// Where the centre of each mallet may be: from and to along x, then along y, mm.
    pub fn reaches_mm(&self) -> impl Iterator<Item = [[f64; 2]; 2]> {
        self.mallets.iter().map(Mallet::reach_mm)
    }

    /// Serves a new puck. The score stays.
    pub fn serve(&mut self) {
        self.puck = self.rules.serve;
    }

    /// Takes a frame: where a mallet was measured at a time, s, which does not fall from frame to frame; none where it is
    /// lifted or not measured. Such a mallet meets no puck and feels nothing.
    ///
    /// # Panics
    /// Where there is no such mallet.
    pub fn frame(&mut self, mallet: usize, time_s: f64, place_mm: Option<[f64; 2]>) {
        self.now_s = self.now_s.max(time_s);
        self.mallets[mallet].take(self.now_s, place_mm);
        self.play();
    }

    /// The force of impacts on a mallet now, N.
    ///
    /// # Panics
    /// Where there is no such mallet.
    pub fn target_n(&self, mallet: usize) -> f64 {
        self.mallets[mallet].target_n(self.now_s)
    }

    /// The walls along x and y of a mallet.
    ///
    /// # Panics
    /// Where there is no such mallet.
    pub fn surfaces(&self, mallet: usize) -> [Surface; 2] {
        self.mallets[mallet].surfaces()
    }

    /// Advances the puck as far as the places of all mallets are known.
    fn play(&mut self) {
        // A mallet without frames stays where it was.
        let is_recent = |known_s: &f64| self.now_s - known_s < LONGEST_GAP_S;
        let known = self.mallets.iter().filter_map(Mallet::known_s).filter(is_recent);
        let until_s = known.fold(self.now_s, f64::min);
        let mut at_s = self.played_s.unwrap_or(until_s).min(self.now_s);
        if until_s - at_s > LONGEST_GAP_S {
            at_s = until_s;
        }
        while at_s < until_s {
            let ends = self.mallets.iter().filter_map(|mallet| mallet.turn_s(at_s));
            let to_s = ends.fold(until_s.min(at_s + STEP_S), f64::min);
            self.advance(at_s, to_s);
            at_s = to_s;
        }
        self.played_s = Some(at_s);
    }

    /// Advances the puck while no mallet changes its velocity.
    fn advance(&mut self, from_s: f64, to_s: f64) {
        for (moving, mallet) in self.moving.iter_mut().zip(&self.mallets) {
            *moving = mallet.moving(from_s);
        }
        self.hits.fill(0.0);
        let goal = self.puck.advance(&self.rules, to_s - from_s, &self.moving, &mut self.hits);
        for (mallet, hit_n_s) in self.mallets.iter_mut().zip(&self.hits) {
            mallet.feel(*hit_n_s, self.now_s, &self.rules);
        }
        if let Some(scorer) = goal {
            self.score[scorer] = self.score[scorer].saturating_add(1);
            self.puck = Puck::default();
        }
    }
}

#[cfg(test)]
mod tests;
