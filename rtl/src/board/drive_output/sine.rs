// SPDX-License-Identifier: MIT OR Apache-2.0
//! The points of a sine, one after the other, from a quarter of it.
//!
//! ```text
//! count ─ point ─ quadrant ──────────────┐
//!               └ rest ─(N/4 −)?─[quarter]─(±)─ sin 2π·point/N
//! ```
//!
//! | signal | format         | unit     | overflow            |
//! | count  | counter        | clock    | reloaded, by compare |
//! | point  | N a power of 2 | 1/N turn | wraps, meant        |
//! | sine   | s18.16         | –        | one is a code       |
//!
//! Latency: the sine is that of the point two clocks before; `turned` is asserted with a new point.

use super::super::bits::{next, previous};
use hapticore_hdl::block;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::Memory;
use hapticore_hdl::signal::{Proved, Wrap, int};
use std::f64::consts::TAU;

/// The format of a sine: one is a code of it.
pub const SINE: Format = Format::signed(18, 16);
/// The format of its magnitude.
pub const MAGNITUDE: Format = Format::unsigned(17, 16);

block! {
    /// A sine of slow points.
    pub struct Sine("sine") {
        points: u64,
        point_clocks: u64,
    }
    submodules {
        quarter: Memory,
    }
    inputs(block) {}
    outputs(block) {
        /// The sine has just taken its next point.
        turned: BIT,
        /// Sine of the point.
        sine: SINE,
    }
    registers(block) {
        count: Format::counter(block.point_clocks - 1),
        point: Format::counter(block.points - 1),
        turning: BIT,
        turned: BIT,
        negative: BIT,
    }
}

impl Sine {
    /// A sine of `points` points, each for `point_clocks` clocks.
    ///
    /// # Panics
    /// Where the points are no power of two from 8, or a point is shorter than 8 clocks.
    pub fn new(points: u64, point_clocks: u64) -> Self {
        assert!(
            points.is_power_of_two() && points >= 8,
            "points: expected a power of two from 8, got {points}"
        );
        assert!(point_clocks >= 8, "point_clocks: expected 8 at least, got {point_clocks}");
        let sine = |n: u64| (TAU * n as f64 / points as f64).sin();
        let quarter = (0..=points / 4).map(sine).collect();
        Sine { points, point_clocks, quarter: Memory::table("quarter", SINE, quarter) }
    }
}

impl Block for Sine {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, _: In<V>) -> Out<V> {
        let r = state.load(self);
        let quarter = self.quarter.data(&mut state.submodules.quarter);
        let width = r.point.format.width;
        let rest = r.point.bits(0, width - 2);
        let falls = r.point.bits(width - 2, 1);
        let address = falls.select(int(self.points / 4) - rest, rest);
        let address = address.resize(self.quarter.address(), Proved);
        self.quarter.read(&mut state.submodules.quarter, address);
        let turning = r.count.is(0);
        let registers = Registers {
            count: turning
                .select(int(self.point_clocks - 1), previous(r.count))
                .resize(r.count.format, Wrap),
            point: turning.select(next(r.point), r.point),
            turning,
            turned: r.turning,
            negative: r.point.msb(),
        };
        state.store(self, registers);
        let sine = r.negative.select(-quarter, quarter).resize(SINE, Proved);
        Outputs { turned: r.turned, sine }
    }
}
