// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finite differences: a table of the split over a mesh from rim to rim, for non-uniform sheets.
//!
//! By reciprocity the share of a terminal is a field over the pad's place, solved once for all
//! places. It is level at the insulated rim, and so is its spline. R_p needs a solution for each
//! place: it comes from a mesh of 10 mm or coarser (finer on sheets that would have less than
//! fourteen cells across), at every fourth node along either axis, with the pad's radius put in
//! place of the node's as for terminals. What varies quickly, near terminals and corners, a uniform
//! sheet has too: what is solved for is the ratio to its exact R_p.

use std::f64::consts::PI;

use super::analytic::Analytic;
use super::geometry::Sheet;
use super::mesh::{Correction, Mesh, Network};
use super::nodes::Values;
use super::spline::{Axis, Spline};
use super::split::{Solver, Split};
use crate::few::Few;

/// Finest spacing that R_p is solved with, m.
const OWN_SPACING_M: f64 = 0.01;

/// Cells of R_p's mesh across the sheet, at least: a spline needs three of its places.
const OWN_CELLS: f64 = 14.0;

/// Nodes from one place of R_p to the next.
const OWN_STEP: usize = 4;

pub(super) struct Grid {
    share: Spline,
    ohm: Spline,
}

/// Columns and rows of the table of R_p.
const OWN_TABLE: [usize; 2] = [128, 75];

impl Grid {
    pub fn new(sheet: &Sheet, spacing_m: f64) -> Self {
        Grid::corrected(sheet, spacing_m, Correction::Peaceman)
    }

    pub fn corrected(sheet: &Sheet, spacing_m: f64, correction: Correction) -> Self {
        let network = Network::new(sheet, Mesh::new(sheet.size_m, spacing_m), correction);
        let mesh = network.mesh;
        let node = |column, row| network.share(mesh.node(column, row));
        let share = Spline::level(axes(&mesh, 0, 1), sheet.terminals(), node);
        let own_m = own_spacing_m(sheet, spacing_m);
        let other = (own_m != spacing_m)
            .then(|| Network::new(sheet, Mesh::new(sheet.size_m, own_m), correction));
        Grid { share, ohm: own(sheet, &other.unwrap_or(network)) }
    }
}

impl Solver for Grid {
    fn split(&self, x_mm: f64, y_mm: f64) -> Split {
        let share = Few::from_slice(&self.share.at(x_mm, y_mm));
        Split { share, ohm: self.ohm.at(x_mm, y_mm)[0] }
    }
}

/// Spacing of the mesh that R_p is solved with, beside one of the shares.
fn own_spacing_m(sheet: &Sheet, spacing_m: f64) -> f64 {
    let across = f64::min(sheet.size_m[0], sheet.size_m[1]);
    spacing_m.max(OWN_SPACING_M).min(across / OWN_CELLS)
}

/// A single value.
fn single(value: f64) -> Values {
    std::iter::once(value).collect()
}

/// R_p over the places of a pad.
fn own(sheet: &Sheet, network: &Network) -> Spline {
    let uniform = Analytic::new(sheet);
    let ratio = ratio(sheet, network, &uniform);
    let reach_mm = sheet.reach_mm();
    let axes = [0, 1].map(|axis| Axis::symmetric(reach_mm[axis], OWN_TABLE[axis]));
    Spline::of(axes, 1, |x, y| single(uniform.split(x, y).ohm * ratio.at(x, y)[0]))
}

/// R_p of the mesh by that of a uniform sheet, over the places that are not on the rim.
fn ratio(sheet: &Sheet, network: &Network, uniform: &Analytic) -> Spline {
    let mesh = network.mesh;
    let axes = axes(&mesh, 1, OWN_STEP);
    let disc = (mesh.node_radius_m() / sheet.disc_m()).ln() / (2.0 * PI);
    let ratio = |column: usize, row: usize| {
        let place = [axes[0].node_mm(column), axes[1].node_mm(row)];
        let [column, row] = [1 + OWN_STEP * column, 1 + OWN_STEP * row];
        let node = mesh.node(column, row);
        let ohm = network.potential(node)[node] + sheet.film.at(mesh.place_m(column, row)) * disc;
        single(ohm / uniform.split(place[0], place[1]).ohm)
    };
    let (columns, rows) = (axes[0].nodes, axes[1].nodes);
    let solved: Vec<_> = (0..columns * rows).map(|n| ratio(n % columns, n / columns)).collect();
    Spline::free(axes, 1, |column, row| solved[row * columns + column])
}

/// Every `step`th node, leaving out so many at the rim.
fn axes(mesh: &Mesh, rim: usize, step: usize) -> [Axis; 2] {
    [0, 1].map(|axis| {
        let cells = mesh.cells[axis] - 2 * rim;
        Axis::symmetric(5e2 * mesh.step_m[axis] * cells as f64, cells / step + 1)
    })
}
