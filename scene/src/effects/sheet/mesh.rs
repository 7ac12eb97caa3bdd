// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sheet as a mesh of resistors, and its terminals as nodes of it.
//!
//! A conductance of the mesh is (width of the strip that it stands for)/(its length·R_s), half as
//! wide along the rim. Currents sum to zero at every node, second order in the spacing. A terminal
//! that is a single node acts as if it had the radius r₀ = e^(−γ)/4·√(h_x² + h_y²), 0.1986h on a
//! square mesh, and so refinement would not converge: f·R_s/2π·ln(r₀/a_t) in series puts that right
//! (Peaceman, 1978), f = 4 at a corner and 2 on an edge, for only so much of a circle lies on the
//! sheet.
//!
//! That resistance is negative where the mesh is finer than the terminal, and such a matrix need
//! not be positive definite. So the matrix that is factored has a positive dummy g to ground at
//! every terminal; the difference is folded in as a current s_i into the node (Woodbury), which
//! covers open and shorted terminals too. With K_ij = (A⁻¹)_ij between terminals:
//!
//!   φ_i = φ⁰_i + Σ K_ij·s_j,   w_i = g·φ_i − s_i,   R_i·w_i = φ_i   ⇒   R_i·s_i − (g·R_i − 1)·Σ K_ij·s_j = (g·R_i − 1)·φ⁰_i

use std::f64::consts::PI;

use faer::Side;
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::Llt;
use faer::sparse::{SparseColMat, Triplet};
use faer::{Col, Mat};

use super::geometry::Sheet;
use super::linear::{Square, dot};
use super::nodes::Values;
use super::spline::Axis;

/// e^(−γ)/4, γ being Euler's constant.
const PEACEMAN: f64 = 0.140_364_870_891_724_5;

/// Whether terminals get the radius that they have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Correction {
    Peaceman,
    /// As if the mesh did not matter, to show that it does.
    #[cfg(test)]
    None,
}

/// A mesh of nodes from rim to rim.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mesh {
    /// Along x and y; twice an odd number, so that the edges' middles are nodes and the rest
    /// divides by four.
    pub cells: [usize; 2],
    pub step_m: [f64; 2],
}

impl Mesh {
    pub fn new(size_m: [f64; 2], spacing_m: f64) -> Self {
        let cells =
            size_m.map(|size| 4 * ((size / spacing_m - 2.0) / 4.0).round().max(1.0) as usize + 2);
        Mesh { cells, step_m: [0, 1].map(|axis| size_m[axis] / cells[axis] as f64) }
    }

    pub fn nodes(&self) -> usize {
        (self.cells[0] + 1) * (self.cells[1] + 1)
    }

    pub fn node(&self, column: usize, row: usize) -> usize {
        row * (self.cells[0] + 1) + column
    }

    pub fn place_m(&self, column: usize, row: usize) -> [f64; 2] {
        [column as f64 * self.step_m[0], row as f64 * self.step_m[1]]
    }

    /// Column and row of the node nearest to a place.
    pub fn nearest(&self, place_m: [f64; 2]) -> [usize; 2] {
        [0, 1].map(|axis| {
            ((place_m[axis] / self.step_m[axis]).round() as usize).min(self.cells[axis])
        })
    }

    /// The four nodes around a place in mm from the middle, and the weight of each.
    fn around(&self, place_mm: [f64; 2]) -> [(usize, f64); 4] {
        let axes = [0, 1].map(|axis| {
            Axis::symmetric(5e2 * self.step_m[axis] * self.cells[axis] as f64, self.cells[axis] + 1)
        });
        let ((column, x), (row, y)) = (axes[0].locate(place_mm[0]), axes[1].locate(place_mm[1]));
        [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(right, up)| {
            let along = |t: f64, step: usize| if step == 1 { t } else { 1.0 - t };
            (self.node(column + right, row + up), along(x, right) * along(y, up))
        })
    }

    /// How many rims a node lies on.
    fn rims(&self, [column, row]: [usize; 2]) -> i32 {
        i32::from(column == 0 || column == self.cells[0])
            + i32::from(row == 0 || row == self.cells[1])
    }

    /// Radius of a ring that has the potential of a node which feeds current into the mesh.
    pub fn node_radius_m(&self) -> f64 {
        PEACEMAN * self.step_m[0].hypot(self.step_m[1])
    }

    /// The mesh's conductances: two nodes and siemens each.
    fn conductances(&self, sheet: &Sheet) -> Vec<(usize, usize, f64)> {
        let [columns, rows] = self.cells;
        let mut list = Vec::with_capacity(2 * self.nodes());
        for (column, row) in
            (0..=rows).flat_map(|row| (0..=columns).map(move |column| (column, row)))
        {
            for (axis, [c, r]) in [[column + 1, row], [column, row + 1]].into_iter().enumerate() {
                if c > columns || r > rows {
                    continue;
                }
                let across = [row, column][axis];
                let width = if across == 0 || across == [rows, columns][axis] { 0.5 } else { 1.0 };
                let ohm = 0.5
                    * (sheet.film.at(self.place_m(column, row))
                        + sheet.film.at(self.place_m(c, r)));
                let siemens = width * self.step_m[1 - axis] / (self.step_m[axis] * ohm);
                list.push((self.node(column, row), self.node(c, r), siemens));
            }
        }
        list
    }
}

/// A mesh whose matrix is factored, with its terminals.
pub(crate) struct Network {
    pub mesh: Mesh,
    terminals: Vec<usize>,
    factor: Llt<usize, f64>,
    /// A⁻¹ from each terminal to each node.
    fields: Mat<f64>,
    /// Extra currents s by the potentials φ⁰ that the dummies alone leave at the terminals.
    extra: Square<f64>,
    /// Shares w by the same.
    share: Square<f64>,
}

impl Network {
    pub fn new(sheet: &Sheet, mesh: Mesh, correction: Correction) -> Self {
        let places: Vec<_> = sheet.terminals_m.iter().map(|place| mesh.nearest(*place)).collect();
        let terminals: Vec<_> =
            places.iter().map(|[column, row]| mesh.node(*column, *row)).collect();
        let dummy = 1.0 / sheet.film.ohm_per_square;
        let factor = factor(&mesh, &mesh.conductances(sheet), &terminals, dummy);
        let mut fields = Mat::zeros(mesh.nodes(), terminals.len());
        terminals.iter().enumerate().for_each(|(terminal, node)| fields[(*node, terminal)] = 1.0);
        factor.solve_in_place(&mut fields);
        let series = places.iter().zip(&sheet.terminal_ohm).map(|(place, ohm)| {
            let local = sheet.film.at(mesh.place_m(place[0], place[1]));
            let peaceman = f64::from(1 << mesh.rims(*place)) * local / (2.0 * PI)
                * (mesh.node_radius_m() / sheet.terminal_radius_m).ln();
            ohm + if correction == Correction::Peaceman { peaceman } else { 0.0 }
        });
        let series: Vec<f64> = series.collect();
        let between = Square::of(terminals.len(), |i, j| fields[(terminals[i], j)]);
        let (extra, share) = fold(&between, &series, dummy);
        Network { mesh, terminals, factor, fields, extra, share }
    }

    /// The share of each terminal in a current that is fed in at a node.
    pub fn share(&self, node: usize) -> Values {
        let alone = self.alone(node);
        self.share.rows().map(|row| dot(row, &alone)).collect()
    }

    /// Potential of every node for a unit current into one.
    pub fn potential(&self, node: usize) -> Col<f64> {
        self.potential_of(&[(node, 1.0)])
    }

    /// Potential of every node for a unit current into a place in mm from the middle, shared by the
    /// nodes around it.
    pub fn potential_around(&self, place_mm: [f64; 2]) -> Col<f64> {
        self.potential_of(&self.mesh.around(place_mm))
    }

    /// A potential at a place in mm from the middle.
    pub fn read(&self, potential: &Col<f64>, place_mm: [f64; 2]) -> f64 {
        self.mesh.around(place_mm).into_iter().map(|(node, weight)| weight * potential[node]).sum()
    }

    fn potential_of(&self, currents: &[(usize, f64)]) -> Col<f64> {
        let mut potential = Col::zeros(self.mesh.nodes());
        currents.iter().for_each(|(node, current)| potential[*node] = *current);
        self.factor.solve_in_place(potential.as_mut().as_mat_mut());
        let alone: Values = self.terminals.iter().map(|node| potential[*node]).collect();
        let extra: Values = self.extra.rows().map(|row| dot(row, &alone)).collect();
        let extra = Col::from_fn(extra.len(), |n| extra[n]);
        potential + &self.fields * extra
    }

    /// φ⁰ at the terminals for a unit current into a node; the matrix is symmetric.
    fn alone(&self, node: usize) -> Values {
        (0..self.terminals.len()).map(|terminal| self.fields[(node, terminal)]).collect()
    }
}

fn factor(
    mesh: &Mesh,
    conductances: &[(usize, usize, f64)],
    terminals: &[usize],
    dummy: f64,
) -> Llt<usize, f64> {
    let mut entries = Vec::with_capacity(3 * conductances.len() + terminals.len());
    for &(a, b, siemens) in conductances {
        entries.extend([Triplet::new(a, a, siemens), Triplet::new(b, b, siemens)]);
        entries.push(Triplet::new(a.max(b), a.min(b), -siemens));
    }
    entries.extend(terminals.iter().map(|node| Triplet::new(*node, *node, dummy)));
    let matrix =
        SparseColMat::<usize, f64>::try_new_from_triplets(mesh.nodes(), mesh.nodes(), &entries);
    let matrix = matrix.expect("every entry lies within the matrix");
    matrix
        .sp_cholesky(Side::Lower)
        .expect("conductances and dummies are positive, and the mesh is connected")
}

/// s and w by φ⁰, as the module says.
fn fold(between: &Square<f64>, series: &[f64], dummy: f64) -> (Square<f64>, Square<f64>) {
    let count = series.len();
    // Both factors of a terminal's row, R and g·R − 1, or what is left of them where R is infinite.
    let weight = |ohm: &f64| if ohm.is_finite() { [*ohm, dummy * ohm - 1.0] } else { [1.0, dummy] };
    let weights: Vec<_> = series.iter().map(weight).collect();
    let delta = |i: usize, j: usize| f64::from(i == j);
    let inverse =
        Square::of(count, |i, j| weights[i][0] * delta(i, j) - weights[i][1] * between.at(i, j))
            .invert();
    let extra = Square::of(count, |i, j| inverse.at(i, j) * weights[j][1]);
    let lifted = |i: usize, j: usize| {
        delta(i, j) + (0..count).map(|k| between.at(i, k) * extra.at(k, j)).sum::<f64>()
    };
    let share = Square::of(count, |i, j| dummy * lifted(i, j) - extra.at(i, j));
    (extra, share)
}
