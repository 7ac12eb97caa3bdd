// SPDX-License-Identifier: MIT OR Apache-2.0
//! The parts of split pads as pads, and their walls, in floating point.
//!
//! ```text
//! C = (C_left + C_right)/2,  F likewise;   those of a third part, which brakes alone;   or the mean of quadrants
//! x_w = ±(x − surface);   of quadrants y_w likewise, with those at the bottom and at the top for left and right
//! ```

use super::{Direction, Frame, Rule, Sequential, Stiffness, Target};
use crate::control::Prompt;
use hapticore_contract::control::{Surface, Walled, Walls};
use hapticore_contract::profile::Wall;

/// A pad whose parts have all been seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whole {
    /// The estimate of what brakes, under the number of the pad's last part.
    pub prompt: Prompt,
    /// What the wall makes of it.
    pub walled: Walled,
}

/// The wall along one axis.
#[derive(Clone, Debug)]
struct Axis {
    wall: Sequential,
    /// What the direction of a wall on the left reads without a push.
    factory: f64,
    /// Where it begins; without it there is none.
    surface: Option<Surface>,
    /// The user leaves the wall, as of the last frame.
    is_free: bool,
    /// Place of the last valid frame across the surface and along it, mm.
    place_mm: Option<[f64; 2]>,
}

#[derive(Clone, Debug)]
struct Pad {
    /// Along x, and of quadrants along y.
    axes: Vec<Axis>,
    /// Estimates of the parts that sense, in the order of their slots.
    sensed: Vec<Option<Prompt>>,
    /// It is not driven.
    rests: bool,
}

/// Split pads, known by the numbers of their last parts.
#[derive(Clone, Debug)]
pub struct SplitPads {
    parts: usize,
    pads: Vec<Pad>,
}

impl SplitPads {
    /// `parts` parts of pads with walls of a profile.
    pub fn new(wall: &Wall, walls: &Walls, parts: usize) -> Self {
        let stiffness = Stiffness { n_per_mm: walls.stiffness_n_per_mm, most_n: walls.most_n };
        let axis = |factory: f64| Axis {
            wall: Sequential::of_profile(stiffness, wall, mirrored(factory, walls.right)),
            factory,
            surface: None,
            is_free: false,
            place_mm: None,
        };
        let axes = [walls.factory, 0.0].into_iter().take(wall.axes() as usize).map(axis).collect();
        let of_pad = wall.parts as usize;
        let sensed = vec![None; if of_pad == 3 { 2 } else { of_pad }];
        let pad = Pad { axes, sensed, rests: false };
        SplitPads { parts: of_pad, pads: vec![pad; parts / of_pad] }
    }

    fn pad(&mut self, part: usize) -> &mut Pad {
        &mut self.pads[part / self.parts]
    }

    /// Sets where the wall that is known by this number begins.
    pub fn set_surface(&mut self, pad: usize, surface: Surface) {
        let (last, part) = (self.parts - 1, pad % self.parts);
        let axis = match part {
            part if part == last => 0,
            part if part as u64 == Wall::PART_OF_Y => 1,
            _ => return,
        };
        if let Some(axis) = self.pad(pad).axes.get_mut(axis) {
            axis.surface = Some(surface);
            axis.wall.set_factory(mirrored(axis.factory, surface.right));
        }
    }

    /// The place of a valid frame, x and y.
    pub fn place(&mut self, part: usize, place_mm: [f64; 2]) {
        if part % self.parts == self.parts - 1 {
            let [x_mm, y_mm] = place_mm;
            let axes = self.pad(part).axes.iter_mut().zip([[x_mm, y_mm], [y_mm, x_mm]]);
            axes.for_each(|(axis, mm)| axis.place_mm = Some(mm));
        }
    }

    /// A pad has been given a drive.
    pub fn drive(&mut self, pad: usize, fraction: f64) {
        self.pad(pad).rests = fraction == 0.0;
    }

    /// A part's estimate: of the pad, where it is its last.
    pub fn estimate(&mut self, prompt: &Prompt) -> Option<Whole> {
        let (parts, part) = (self.parts, prompt.pad % self.parts);
        let pad = self.pad(prompt.pad);
        if let Some(sensed) = pad.sensed.get_mut(part) {
            *sensed = Some(*prompt);
        }
        if part < parts - 1 {
            return None;
        }
        let sensed = pad.sensed.iter().copied().collect::<Option<Vec<_>>>()?;
        let whole = match parts {
            3 => *prompt,
            _ => Prompt {
                capacitance_pf: mean(sensed.iter().map(|part| part.capacitance_pf)),
                force_n: mean(sensed.iter().map(|part| part.force_n)),
                invalid: sensed.iter().any(|part| part.invalid),
                lifted: sensed.iter().any(|part| part.lifted),
                ..*prompt
            },
        };
        Some(Whole { prompt: whole, walled: pad.walled(&sensed) })
    }
}

/// What a wall reads where one on the left reads `factory`.
fn mirrored(factory: f64, right: bool) -> f64 {
    if right { -factory } else { factory }
}

fn mean(of: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = of.len() as f64;
    of.sum::<f64>() / count
}

impl Pad {
    /// The larger force of the walls; whether the user leaves either.
    fn walled(&mut self, sensed: &[Prompt]) -> Walled {
        let trusted = sensed.iter().all(|part| !part.invalid && !part.lifted);
        let sides = |axis: usize| {
            let of = |parts: &[usize]| mean(parts.iter().map(|&n| sensed[n].capacitance_pf));
            match (trusted, sensed.len(), axis) {
                (false, ..) => [0.0; 2],
                (_, 4, 0) => [of(&[0, 1]), of(&[2, 3])],
                (_, 4, _) => [of(&[1, 2]), of(&[0, 3])],
                _ => [of(&[0]), of(&[1])],
            }
        };
        let rests = self.rests;
        let mut each = Vec::new();
        for n in 0..self.axes.len() {
            let other_free = self.axes.get(1 - n).is_some_and(|other| other.is_free);
            self.axes[n].wall.set_other_free(other_free);
            each.push(self.axes[n].walled(sides(n), rests));
        }
        each.into_iter()
            .reduce(|a, b| Walled { target_n: a.target_n.max(b.target_n), free: a.free | b.free })
            .expect("a pad has an axis")
    }
}

impl Axis {
    fn walled(&mut self, [a, b]: [f64; 2], at_zero: bool) -> Walled {
        let Some(([place_mm, along_mm], surface)) = self.place_mm.zip(self.surface) else {
            self.is_free = false;
            return Walled { target_n: 0.0, free: false };
        };
        let depth_mm = place_mm - surface.mm;
        let frame = match surface.right {
            true => Frame { left: b, right: a, x_mm: -depth_mm, along_mm, at_zero },
            false => Frame { left: a, right: b, x_mm: depth_mm, along_mm, at_zero },
        };
        let (target, direction) = self.wall.frame(&frame);
        self.is_free = direction == Direction::Free;
        let target_n = match target {
            Target::Force(newtons) => newtons,
            Target::Voltage(_) => 0.0,
        };
        Walled { target_n, free: self.is_free }
    }
}
