// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where the map's curves and tables lie in its memory, one after the other.

use crate::profile::Profile;

/// Where the curves and tables lie in the memory.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layout {
    /// Address bits of the curves that straighten the edges.
    pub edge: u8,
    /// Address bits of the curves that even out the spacing.
    pub spacing: u8,
    /// Address bits of a side of the tables.
    pub table: u8,
}

/// The curves, in their order in the memory; the three tables follow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Curve {
    /// The middle of the long edges' curves.
    MiddleY,
    /// One over half their distance.
    StretchY,
    /// The middle of the short edges' curves.
    MiddleX,
    /// One over half their distance.
    StretchX,
    /// Even spacing between the long edges.
    SpacingY,
    /// Even spacing between the short edges.
    SpacingX,
}

impl Layout {
    /// The layout of a profile.
    pub fn new(profile: &Profile) -> Self {
        let map = &profile.map;
        Layout { edge: map.edge_address, spacing: map.spacing_address, table: map.table_address }
    }

    /// Entries of a curve.
    pub fn entries(&self, curve: Curve) -> usize {
        let bits = if matches!(curve, Curve::SpacingY | Curve::SpacingX) { self.spacing } else { self.edge };
        (1 << bits) + 1
    }

    /// Where a curve begins.
    pub fn curve(&self, curve: Curve) -> usize {
        let edge = self.entries(Curve::MiddleY);
        match curve {
            Curve::SpacingX => 4 * edge + self.entries(Curve::SpacingY),
            _ => curve as usize * edge,
        }
    }

    /// Nodes of a side of the tables.
    pub fn side(&self) -> usize {
        (1 << self.table) + 1
    }

    /// Where a table begins: 0 of x, 1 of y, 2 of the sheet's resistance.
    pub fn table(&self, layer: usize) -> usize {
        self.curve(Curve::SpacingX) + self.entries(Curve::SpacingX) + layer * self.side() * self.side()
    }

    /// Words in all.
    pub fn words(&self) -> usize {
        self.table(3)
    }
}
