// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finite differences: tables of the shares and of R_p over a mesh, for non-uniform sheets.
//!
//! By reciprocity the share of a terminal is a field over the pad's place, solved once for all
//! places. It is level at the insulated rim, and so is its spline.

use super::geometry::Sheet;
use super::mesh::Mesh;
use super::network::{Correction, Network};
use super::own::own;
use super::spline::{Axis, Spline};
use super::split::{Solver, Split};
use crate::few::Few;

/// Cells of R_p's mesh across the sheet, at least.
const OWN_CELLS: f64 = 14.0;

pub(super) struct Grid {
    share: Spline,
    ohm: Spline,
}

impl Grid {
    pub fn new(sheet: &Sheet, spacing_m: f64) -> Self {
        Grid::corrected(sheet, spacing_m, Correction::Peaceman)
    }

    pub fn corrected(sheet: &Sheet, spacing_m: f64, correction: Correction) -> Self {
        let network =
            |spacing_m| Network::new(sheet, Mesh::new(sheet.size_m, spacing_m), correction);
        let solved = network(spacing_m);
        let mesh = solved.mesh;
        let node = |column, row| solved.share(mesh.node(column, row));
        let share = Spline::level(axes(&mesh), sheet.terminals(), node);
        let own_m = spacing_m.min(f64::min(sheet.size_m[0], sheet.size_m[1]) / OWN_CELLS);
        let solved = if own_m == spacing_m { solved } else { network(own_m) };
        Grid { share, ohm: own(sheet, &solved) }
    }
}

impl Solver for Grid {
    fn split(&self, x_mm: f64, y_mm: f64) -> Split {
        let share = Few::from_slice(&self.share.at(x_mm, y_mm));
        Split { share, ohm: self.ohm.at(x_mm, y_mm)[0] }
    }
}

/// The mesh's nodes along each axis.
fn axes(mesh: &Mesh) -> [Axis; 2] {
    [0, 1].map(|axis| {
        let half_mm = 5e2 * mesh.step_m[axis] * mesh.cells[axis] as f64;
        Axis::symmetric(half_mm, mesh.cells[axis] + 1)
    })
}
