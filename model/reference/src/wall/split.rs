// SPDX-License-Identifier: MIT OR Apache-2.0
//! The parts of split pads as pads, and their walls, in floating point.
//!
//! ```text
//! C = (C_left + C_right)/2,  F likewise;   or those of a third part, which brakes alone
//! x_w = ±(x − surface)
//! ```

use super::{Direction, Frame, Rule, Sequential, Stiffness, Target};
use crate::control::Prompt;
use hapticore_contract::control::{Walled, Walls};
use hapticore_contract::profile::Wall;

/// A pad whose parts have all been seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whole {
    /// The estimate of what brakes, under the number of the pad's last part.
    pub prompt: Prompt,
    /// What the wall makes of it.
    pub walled: Walled,
}

#[derive(Clone, Debug)]
struct Pad {
    wall: Sequential,
    surface_mm: f64,
    /// Place of the last valid frame.
    x_mm: Option<f64>,
    /// Left and right estimate.
    sensed: [Option<Prompt>; 2],
    /// It is not driven.
    rests: bool,
}

/// Split pads, known by the numbers of their last parts.
#[derive(Clone, Debug)]
pub struct SplitPads {
    parts: usize,
    right: bool,
    pads: Vec<Pad>,
}

impl SplitPads {
    /// So many parts of pads with walls of a profile.
    pub fn new(wall: &Wall, walls: &Walls, parts: usize) -> Self {
        let stiffness = Stiffness { n_per_mm: walls.stiffness_n_per_mm, most_n: walls.most_n };
        let factory = if walls.right { -walls.factory } else { walls.factory };
        let wall_of_pad = Sequential::of_profile(stiffness, wall, factory);
        let pad =
            Pad { wall: wall_of_pad, surface_mm: 0.0, x_mm: None, sensed: [None; 2], rests: false };
        let of_pad = wall.parts as usize;
        SplitPads { parts: of_pad, right: walls.right, pads: vec![pad; parts / of_pad] }
    }

    fn pad(&mut self, part: usize) -> &mut Pad {
        &mut self.pads[part / self.parts]
    }

    /// Sets where the wall of a pad begins, mm.
    pub fn set_surface(&mut self, pad: usize, surface_mm: f64) {
        self.pad(pad).surface_mm = surface_mm;
    }

    /// The place of a valid frame.
    pub fn place(&mut self, part: usize, x_mm: f64) {
        if part % self.parts == self.parts - 1 {
            self.pad(part).x_mm = Some(x_mm);
        }
    }

    /// A pad has been given a drive.
    pub fn drive(&mut self, pad: usize, fraction: f64) {
        self.pad(pad).rests = fraction == 0.0;
    }

    /// A part's estimate: of the pad, where it is its last.
    pub fn estimate(&mut self, prompt: &Prompt) -> Option<Whole> {
        let (parts, right, part) = (self.parts, self.right, prompt.pad % self.parts);
        let pad = self.pad(prompt.pad);
        if part < 2 {
            pad.sensed[part] = Some(*prompt);
        }
        if part < parts - 1 {
            return None;
        }
        let [left, last] = [pad.sensed[0]?, pad.sensed[1]?];
        let whole = match parts {
            2 => Prompt {
                capacitance_pf: 0.5 * (left.capacitance_pf + last.capacitance_pf),
                force_n: 0.5 * (left.force_n + last.force_n),
                invalid: left.invalid | last.invalid,
                ..*prompt
            },
            _ => *prompt,
        };
        Some(Whole { prompt: whole, walled: pad.walled([left, last], right) })
    }
}

impl Pad {
    fn walled(&mut self, sensed: [Prompt; 2], right: bool) -> Walled {
        let Some(x_mm) = self.x_mm else { return Walled { target_n: 0.0, free: false } };
        let trusted = sensed.iter().all(|part| !part.invalid);
        let [a, b] = sensed.map(|part| if trusted { part.capacitance_pf } else { 0.0 });
        let depth_mm = x_mm - self.surface_mm;
        let frame = match right {
            true => Frame { left: b, right: a, x_mm: -depth_mm, at_zero: self.rests },
            false => Frame { left: a, right: b, x_mm: depth_mm, at_zero: self.rests },
        };
        let (target, direction) = self.wall.frame(&frame);
        let target_n = match target {
            Target::Force(newtons) => newtons,
            Target::Voltage(_) => 0.0,
        };
        Walled { target_n, free: direction == Direction::Free }
    }
}
