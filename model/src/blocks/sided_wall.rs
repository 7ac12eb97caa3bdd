// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sided wall: a wall that is on either side of a pad. One on the right is a mirrored one on the left.
//!
//! ```text
//! x = ±(place − surface),   C_L, C_R and the sign of u change places with the sides
//! ```
//!
//! ```text
//! place − surface ─(±)─[saturate]─ x ─────────────┐
//! parts ─[changed, none where not trusted]────────┴─ wall ─ target
//! ```
//!
//! | signal | format | unit | overflow |
//! | x      | that of positions | mm | saturates, meant: far from the wall |
//! | factory | that of u        | –  | saturates at the one code without an opposite |
//!
//! Latency: the wall's.

use super::rests::Rests;
use super::wall::{self, Wall};
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::{HalfEven, Saturate, zero};
use hapticore_hdl::{block, call};

block! {
    /// A wall on either side.
    pub struct SidedWall("sided_wall") {}
    submodules {
        /// The wall, on the left.
        wall: Wall,
    }
    inputs(block) {
        /// Begins a pad's frame; all others are valid and stable until `done`.
        start: BIT,
        /// Pad of the frame.
        pad: block.wall.inputs().pad,
        /// The pad starts anew.
        restart: BIT,
        /// Capacitance of the left part that senses, pF.
        left: block.wall.inputs().c_left,
        /// Capacitance of the right part that senses, pF.
        right: block.wall.inputs().c_right,
        /// Its parts are to be trusted.
        trusted: BIT,
        /// Place less the wall's surface, mm.
        depth: depth(block.wall.inputs().x),
        /// Place along the wall's surface, mm.
        along: block.wall.inputs().along,
        /// The user leaves the pad's other wall.
        other_free: block.wall.inputs().other_free,
        /// The wall is right of its surface.
        mirrored: BIT,
        /// The haptic voltage was zero in the frame.
        at_zero: BIT,
        /// Stiffness of the wall, N/mm.
        stiffness: block.wall.inputs().stiffness,
        /// Largest force of the wall, N.
        most: block.wall.inputs().most,
        /// What u reads without a push as the device left the factory.
        factory: block.wall.inputs().factory,
    }
    outputs(block) {
        /// Asserted for one cycle when the results are valid.
        done: BIT,
        /// Force target of the pad, N.
        target: block.wall.outputs().target,
        /// The user leaves the wall; else pushes into it or is outside.
        free: BIT,
        /// The direction was read from current.
        valid: BIT,
    }
    registers(block) {}
}

/// The format of a difference of places.
const fn depth(position: Format) -> Format {
    Format { width: position.width + 1, ..position }
}

impl SidedWall {
    /// The walls of a profile.
    ///
    /// # Errors
    /// Words that the model cannot hold.
    pub fn try_new(profile: &Profile) -> Result<Self, ProfileError> {
        Ok(SidedWall { wall: Wall::try_new(profile)? })
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        self.wall.latency()
    }

    /// As [`Wall::is_busy`].
    pub(super) fn is_busy<V: Interpretation>(&self, state: &State<Self, V>) -> bool {
        self.wall.is_busy(&state.submodules.wall)
    }

    /// The wall's inputs: without current where no part can be trusted, so that it releases.
    #[inline(always)]
    fn of_wall<V: Interpretation>(&self, i: In<V>) -> wall::In<V> {
        let f = self.wall.inputs();
        let current = |part| i.trusted.select(part, zero(f.c_left));
        let (x, _) = i.mirrored.select(-i.depth, i.depth).saturate(f.x, HalfEven);
        wall::Inputs {
            start: i.start,
            pad: i.pad,
            restart: i.restart,
            c_left: current(i.mirrored.select(i.right, i.left)),
            c_right: current(i.mirrored.select(i.left, i.right)),
            x,
            along: i.along,
            other_free: i.other_free,
            at_zero: i.at_zero,
            stiffness: i.stiffness,
            most: i.most,
            factory: i.mirrored.select(-i.factory, i.factory).resize(f.factory, Saturate),
        }
    }
}

impl Block for SidedWall {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let wall = call!(self.wall, state, self.of_wall(i));
        Outputs { done: wall.done, target: wall.target, free: wall.free, valid: wall.valid }
    }
}
