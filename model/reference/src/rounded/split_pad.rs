// SPDX-License-Identifier: MIT OR Apache-2.0
//! Parts of split pads as pads, each number rounded.
//!
//! ```text
//! C = [(C_left + C_right)/2],  F likewise;   or those of a third part
//! x_w = [±(x − surface)]
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
}

/// A pad whose parts have all been seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WholePad {
    /// The estimate of what brakes.
    pub brake: Estimate,
    /// What its wall gives.
    pub wall: WallResult,
}

/// One split pad and its wall.
#[derive(Debug, Clone)]
pub struct SplitPads {
    parts: u64,
    position: Format,
    capacitance: Format,
    force: Format,
    wall: Wall,
    /// Place of the last valid frame.
    pub place: Option<Exact>,
    /// The wall's surface, and whether the wall is right of it.
    pub surface: (Exact, bool),
    /// The pad is not driven.
    pub rests: bool,
}

impl SplitPads {
    /// A pad of a profile with walls, nothing seen.
    ///
    /// # Panics
    /// Where the profile has none.
    pub fn new(profile: &Profile) -> Self {
        let f = &profile.formats;
        SplitPads {
            parts: profile.wall.expect("a profile with walls").parts,
            position: f.position,
            capacitance: f.capacitance,
            force: f.force,
            wall: Wall::new(profile),
            place: None,
            surface: (Exact::ZERO, false),
            rests: false,
        }
    }

    /// The estimates of a pad's parts in the order of their slots; `port` has stiffness, largest
    /// force and factory offset, and whether the pad starts anew.
    pub fn estimates(&mut self, parts: &[Estimate], port: &WallFrame) -> WholePad {
        let [left, right] = [parts[0], parts[1]];
        let mean = |a: Exact, b: Exact, to| round((a + b).scaled(-1), to).value;
        let brake = match self.parts {
            2 => Estimate {
                capacitance: mean(left.capacitance, right.capacitance, self.capacitance),
                force: mean(left.force, right.force, self.force),
                invalid: left.invalid | right.invalid,
            },
            _ => parts[2],
        };
        let trusted = self.place.is_some() && !left.invalid && !right.invalid;
        let current = |part: Estimate| if trusted { part.capacitance } else { Exact::ZERO };
        let (surface, mirrored) = self.surface;
        let depth = self.place.unwrap_or(Exact::ZERO) - surface;
        let sides = [current(left), current(right)];
        let frame = WallFrame {
            restart: port.restart | self.place.is_none(),
            parts: if mirrored { [sides[1], sides[0]] } else { sides },
            x: round(if mirrored { -depth } else { depth }, self.position).value,
            at_zero: self.rests,
            factory: if mirrored { round(-port.factory, U).value } else { port.factory },
            ..*port
        };
        WholePad { brake, wall: self.wall.frame(&frame) }
    }
}

const U: Format = Format::signed(13, 13);
