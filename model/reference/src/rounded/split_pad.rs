// SPDX-License-Identifier: MIT OR Apache-2.0
//! Parts of split pads as pads, each number rounded.
//!
//! ```text
//! C = [(C_left + C_right)/2],  F likewise;   those of a third part;   or [Σ C/4] of quadrants
//! C_left = [(C_tl + C_bl)/2], …;   x_w = [±(x − surface)],  y_w likewise
//! ```

use super::{Exact, Wall, WallFrame, WallResult, round};
use hapticore_contract::format::Format;
use hapticore_contract::profile::Profile;

/// The estimate of a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Capacitance.
    pub capacitance: Exact,
    /// Haptic force.
    pub force: Exact,
    /// It is invalid.
    pub invalid: bool,
    /// It does not touch; of several, one of them does not.
    pub lifted: bool,
}

/// A pad whose parts have all been seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WholePad {
    /// The estimate of what brakes.
    pub brake: Estimate,
    /// What its wall gives.
    pub wall: WallResult,
}

/// The wall of a pad along one axis.
#[derive(Debug, Clone)]
pub struct WallAlong {
    wall: Wall,
    /// The wall's surface, and whether the wall is right of it, or above it; without one there is no wall.
    pub surface: Option<(Exact, bool)>,
}

/// One split pad and its walls.
#[derive(Debug, Clone)]
pub struct SplitPads {
    parts: u64,
    position: Format,
    capacitance: Format,
    force: Format,
    /// Along x, and of quadrants along y.
    pub axes: Vec<WallAlong>,
    /// Place of the last valid frame, x and y.
    pub place: [Option<Exact>; 2],
    /// The pad is not driven.
    pub rests: bool,
    /// The user leaves each axis's wall, as of its last frame.
    pub free: [bool; 2],
}

impl SplitPads {
    /// A pad of a profile with walls, nothing seen.
    ///
    /// # Panics
    /// Where the profile has none.
    pub fn new(profile: &Profile) -> Self {
        let f = &profile.formats;
        let rule = profile.wall.expect("a profile with walls");
        let along = |_| WallAlong { wall: Wall::new(profile), surface: None };
        SplitPads {
            parts: rule.parts,
            position: f.position,
            capacitance: f.capacitance,
            force: f.force,
            axes: (0..rule.axes()).map(along).collect(),
            place: [None; 2],
            rests: false,
            free: [false; 2],
        }
    }

    fn mean(&self, parts: &[Estimate]) -> Estimate {
        let shift = -(parts.len().ilog2() as i8);
        let mean = |of: fn(&Estimate) -> Exact, to| {
            let sum = parts.iter().map(of).fold(Exact::ZERO, |a, b| a + b);
            round(sum.scaled(shift), to).value
        };
        Estimate {
            capacitance: mean(|part| part.capacitance, self.capacitance),
            force: mean(|part| part.force, self.force),
            invalid: parts.iter().any(|part| part.invalid),
            lifted: parts.iter().any(|part| part.lifted),
        }
    }

    /// The estimates of a pad's parts in the order of their slots; `port` has stiffness, largest
    /// force and factory offset, and whether the pad starts anew.
    pub fn estimates(&mut self, parts: &[Estimate], port: &WallFrame) -> WholePad {
        let (brake, sensing) = match self.parts {
            3 => (parts[2], &parts[..2]),
            _ => (self.mean(parts), parts),
        };
        let of = |these: &[usize]| {
            let these: Vec<_> = these.iter().map(|&n| parts[n]).collect();
            self.mean(&these).capacitance
        };
        let sides = match self.parts {
            4 => vec![[of(&[0, 1]), of(&[2, 3])], [of(&[1, 2]), of(&[0, 3])]],
            _ => vec![[of(&[0]), of(&[1])]],
        };
        let trusted = sensing.iter().all(|part| !part.invalid && !part.lifted);
        let (position, rests, [x, y]) = (self.position, self.rests, self.place);
        let place = x.zip(y);
        let free = &mut self.free;
        let walls = self.axes.iter_mut().zip(sides).enumerate().map(|(axis, (along, sides))| {
            let factory = if axis == 0 { port.factory } else { Exact::ZERO };
            let port = WallFrame { at_zero: rests, factory, other_free: free[1 - axis], ..*port };
            let sides = if trusted { sides } else { [Exact::ZERO; 2] };
            let place = place.map(|(x, y)| if axis == 0 { [x, y] } else { [y, x] });
            let result = along.frame(sides, place, position, port);
            free[axis] = result.free;
            result
        });
        let larger = |a: Exact, b: Exact| if a < b { b } else { a };
        let both = |a: WallResult, b: WallResult| WallResult {
            target: larger(a.target, b.target),
            free: a.free | b.free,
            valid: b.valid,
        };
        WholePad { brake, wall: walls.reduce(both).expect("a pad has an axis") }
    }
}

impl WallAlong {
    /// With the place across the wall's surface and along it.
    fn frame(
        &mut self,
        sides: [Exact; 2],
        place: Option<[Exact; 2]>,
        position: Format,
        port: WallFrame,
    ) -> WallResult {
        let (surface, mirrored) = self.surface.unwrap_or((Exact::ZERO, false));
        let met = place.is_some() && self.surface.is_some();
        let [across, along] = place.unwrap_or([Exact::ZERO; 2]);
        let depth = across - surface;
        let [left, right] = if met { sides } else { [Exact::ZERO; 2] };
        let frame = WallFrame {
            restart: port.restart | !met,
            parts: if mirrored { [right, left] } else { [left, right] },
            x: round(if mirrored { -depth } else { depth }, position).value,
            along,
            factory: if mirrored { round(-port.factory, U).value } else { port.factory },
            ..port
        };
        self.wall.frame(&frame)
    }
}

const U: Format = Format::signed(13, 13);
