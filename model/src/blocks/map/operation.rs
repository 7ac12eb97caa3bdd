// SPDX-License-Identifier: MIT OR Apache-2.0
//! The operations of the map, in their order; after the last of those named come those of the three layers.

use super::layout::{Curve, Layout};
use crate::signal::{Signal, Value, int};

pub const BOX_X: u64 = 0;
pub const BOX_Y: u64 = 1;
pub const MIDDLE_Y: u64 = 2;
pub const STRETCH_Y: u64 = 3;
pub const STRAIGHTEN_Y: u64 = 4;
pub const SPACING_Y: u64 = 5;
pub const MIDDLE_X: u64 = 6;
pub const STRETCH_X: u64 = 7;
pub const STRAIGHTEN_X: u64 = 8;
pub const SPACING_X: u64 = 9;
/// Of each of three layers: along the row above, along the row below, between the two.
pub const LAYERS: u64 = 10;
pub const ALL: u64 = LAYERS + 9;

/// Which kinds of operation one is.
pub struct Kind<V> {
    /// Brings a ratio into the box.
    pub boxed: Signal<V>,
    /// Straightens an edge.
    pub straightened: Signal<V>,
    /// Evens out the spacing.
    pub spaced: Signal<V>,
    /// Looks up a table.
    pub tables: Signal<V>,
    /// In the row below the pad.
    pub below: Signal<V>,
    /// Between the two rows.
    pub between: Signal<V>,
}

impl<V: Value> Kind<V> {
    /// What the operation is.
    #[inline(always)]
    pub fn of(operation: Signal<V>) -> Self {
        let at = |which: u64| operation.is(which);
        let in_layers = |which: u64| at(LAYERS + which) | at(LAYERS + 3 + which) | at(LAYERS + 6 + which);
        Kind {
            boxed: (at(BOX_X) | at(BOX_Y)).named("boxed"),
            straightened: (at(STRAIGHTEN_Y) | at(STRAIGHTEN_X)).named("straightened"),
            spaced: (at(SPACING_Y) | at(SPACING_X)).named("spaced"),
            tables: (!operation.less_than(int(LAYERS))).named("tables"),
            below: in_layers(1).named("below"),
            between: in_layers(2).named("between"),
        }
    }
}

/// Where the curve or table of an operation begins in the memory.
#[inline(always)]
pub fn offset<V: Value>(layout: &Layout, operation: Signal<V>) -> Signal<V> {
    let at = |which: u64| operation.is(which);
    let curve = |curve: Curve| int(layout.curve(curve) as u64);
    let table = |layer: usize| int(layout.table(layer) as u64);
    let layer = |k: u64| !operation.less_than(int(LAYERS + 3 * k));
    let curves = [
        (MIDDLE_Y, Curve::MiddleY),
        (STRETCH_Y, Curve::StretchY),
        (MIDDLE_X, Curve::MiddleX),
        (STRETCH_X, Curve::StretchX),
        (SPACING_Y, Curve::SpacingY),
    ];
    let of_curve = curves.iter().fold(curve(Curve::SpacingX), |rest, &(which, of)| at(which).select(curve(of), rest));
    let of_table = layer(2).select(table(2), layer(1).select(table(1), table(0)));
    layer(0).select(of_table, of_curve)
}
