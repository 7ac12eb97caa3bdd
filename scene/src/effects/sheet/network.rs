// SPDX-License-Identifier: MIT OR Apache-2.0
//! A mesh with the sheet's terminals on it, factored.
//!
//! A terminal b_i is the nodes around its place, by their weights. On a mesh it acts as if it had
//! another radius than its own: r₀ = 0.1986h where it is a node of a square mesh (Peaceman, 1978),
//! up to 0.44h between two, and so refinement would not converge. What puts that right, and what
//! the mesh makes wrong of its images in near edges and corners, is a resistance in series: R_s
//! there times the difference of the Neumann functions of the sheet and of the mesh,
//!
//!   R_i = R_in,i + R_s·[N(t_i, t_i) − b_iᵀ·N_mesh·b_i].
//!
//! It is negative where the mesh is finer than the terminal, and such a matrix need not be positive
//! definite. So the matrix that is factored has a positive dummy g to ground at every terminal; the
//! difference is folded in as a current s_i into it (Woodbury), which covers open and shorted
//! terminals too. With K_ij = b_iᵀ·A⁻¹·b_j and φ_i = b_iᵀ·φ:
//!
//!   φ_i = φ⁰_i + Σ K_ij·s_j,   w_i = g·φ_i − s_i,   R_i·w_i = φ_i   ⇒   R_i·s_i − (g·R_i − 1)·Σ K_ij·s_j = (g·R_i − 1)·φ⁰_i

use super::factor::{Factor, Half};
use super::geometry::Sheet;
use super::lattice::Lattice;
use super::linear::{Square, dot};
use super::mesh::{Mesh, Spread};
use super::neumann::Neumann;
use super::nodes::Values;

/// Whether terminals get the radius that they have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Correction {
    Peaceman,
    /// As if the mesh did not matter, to show that it does.
    #[cfg(test)]
    None,
}

/// A mesh whose matrix is factored, with its terminals.
pub(crate) struct Network {
    pub mesh: Mesh,
    factor: Factor,
    /// A⁻¹ from each terminal to each node.
    fields: Vec<Vec<f64>>,
    /// Extra currents s by the potentials φ⁰ that the dummies alone leave at the terminals.
    extra: Square<f64>,
    /// Shares w by the same.
    share: Square<f64>,
}

/// A current into a mesh.
pub(crate) struct Source {
    half: Half,
    /// φ⁰ at the terminals, and the extra currents by them.
    alone: Values,
    extra: Values,
}

impl Network {
    pub fn new(sheet: &Sheet, mesh: Mesh, correction: Correction) -> Self {
        let terminals: Vec<Spread> =
            sheet.terminals_m.iter().map(|place| mesh.spread(*place)).collect();
        let dummy = 1.0 / sheet.film.ohm_per_square;
        let factor = factor(&mesh, &mesh.conductances(&sheet.film), &terminals, dummy);
        let fields: Vec<Vec<f64>> =
            terminals.iter().map(|nodes| field(&factor, &mesh, nodes)).collect();
        let wrong = match correction {
            Correction::Peaceman => wrong(sheet, &mesh, &terminals),
            #[cfg(test)]
            Correction::None => Square::of(terminals.len(), |_, _| 0.0),
        };
        let at =
            |nodes: &Spread, j: usize| numbered(&mesh, nodes).map(|(n, w)| w * fields[j][n]).sum();
        let between = Square::of(terminals.len(), |i, j| at(&terminals[i], j));
        let (extra, share) = fold(&between, &wrong, &sheet.terminal_ohm, dummy);
        Network { mesh, factor, fields, extra, share }
    }

    /// The share of each terminal in a current that is fed in at a node.
    pub fn share(&self, node: usize) -> Values {
        let alone: Values = self.fields.iter().map(|field| field[node]).collect();
        self.share.rows().map(|row| dot(row, &alone)).collect()
    }

    /// A unit current into some nodes by their weights; `work` is as [`Factor::energy`] wants it.
    pub fn source(&self, nodes: &Spread, work: &mut [f64]) -> Source {
        let half = self.factor.half(numbered(&self.mesh, nodes), work);
        let alone = self.alone(nodes);
        Source { half, extra: self.extra(&alone), alone }
    }

    /// The potential at one source's nodes for a unit current into another's.
    pub fn between(&self, a: &Source, b: &Source) -> f64 {
        a.half.dot(&b.half) + dot(&a.alone, &b.extra)
    }

    /// The same of a source itself; `work` is as [`Factor::energy`] wants it.
    pub fn resistance(&self, source: &Spread, work: &mut [f64]) -> f64 {
        let alone = self.alone(source);
        let dummies = self.factor.energy(numbered(&self.mesh, source), work);
        dummies + dot(&alone, &self.extra(&alone))
    }

    /// φ⁰ at the terminals for a unit current into some nodes; the matrix is symmetric.
    fn alone(&self, source: &Spread) -> Values {
        let at = |field: &Vec<f64>| {
            numbered(&self.mesh, source).map(|(node, weight)| weight * field[node]).sum()
        };
        self.fields.iter().map(at).collect()
    }

    fn extra(&self, alone: &[f64]) -> Values {
        self.extra.rows().map(|row| dot(row, alone)).collect()
    }
}

fn numbered(mesh: &Mesh, nodes: &Spread) -> impl Iterator<Item = (usize, f64)> {
    nodes.iter().map(|([column, row], weight)| (mesh.node(*column, *row), *weight))
}

/// What the mesh makes wrong between terminals, Ω.
fn wrong(sheet: &Sheet, mesh: &Mesh, terminals: &[Spread]) -> Square<f64> {
    let (exact, lattice) = (Neumann::exact(sheet.size_m), Lattice::new(mesh));
    let film: Vec<f64> = sheet.terminals_m.iter().map(|place| sheet.film.at(*place)).collect();
    Square::of(terminals.len(), |i, j| {
        let [a, b] = [i, j].map(|n| sheet.terminals_m[n]);
        let potential = lattice.between(&terminals[i], &terminals[j]);
        0.5 * (film[i] + film[j]) * (exact.at(a, b, sheet.terminal_radius_m) - potential)
    })
}

fn factor(
    mesh: &Mesh,
    conductances: &[(usize, usize, f64)],
    terminals: &[Spread],
    dummy: f64,
) -> Factor {
    let mut entries = Vec::with_capacity(4 * conductances.len() + terminals.len());
    for &(a, b, siemens) in conductances {
        entries.extend([(a, a, siemens), (b, b, siemens), (a, b, -siemens), (b, a, -siemens)]);
    }
    for nodes in terminals {
        let pairs = numbered(mesh, nodes).flat_map(|a| numbered(mesh, nodes).map(move |b| (a, b)));
        entries.extend(pairs.map(|((a, f), (b, g))| (a, b, dummy * f * g)));
    }
    Factor::new(&entries, &mesh.dissected())
        .expect("conductances and dummies are positive, and the mesh is connected")
}

/// A⁻¹ from a terminal to each node.
fn field(factor: &Factor, mesh: &Mesh, terminal: &Spread) -> Vec<f64> {
    let mut current = vec![0.0; mesh.nodes()];
    numbered(mesh, terminal).for_each(|(node, weight)| current[node] = weight);
    factor.solve(&current)
}

/// s and w by φ⁰, as the module says.
fn fold(
    between: &Square<f64>,
    wrong: &Square<f64>,
    series: &[f64],
    dummy: f64,
) -> (Square<f64>, Square<f64>) {
    let count = series.len();
    let delta = |i: usize, j: usize| f64::from(u8::from(i == j));
    let product = |a: &Square<f64>, b: &Square<f64>| {
        Square::of(count, |i, j| (0..count).map(|k| a.at(i, k) * b.at(k, j)).sum())
    };
    // R and g·R − 1, or what is left of their rows where R is infinite.
    let ohm = |i: usize, j: usize| match series[i].is_finite() {
        true => wrong.at(i, j) + if i == j { series[i] } else { 0.0 },
        false => delta(i, j),
    };
    let lifting = Square::of(count, |i, j| {
        dummy * ohm(i, j) - if series[i].is_finite() { delta(i, j) } else { 0.0 }
    });
    let lifted = product(&lifting, between);
    let extra = product(&Square::of(count, |i, j| ohm(i, j) - lifted.at(i, j)).invert(), &lifting);
    let back = product(between, &extra);
    let share = Square::of(count, |i, j| dummy * (delta(i, j) + back.at(i, j)) - extra.at(i, j));
    (extra, share)
}
