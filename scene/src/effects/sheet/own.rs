// SPDX-License-Identifier: MIT OR Apache-2.0
//! R_p over the places of a pad, from a mesh.
//!
//! R_p is the mean over the pad's disc of the potential of an even current into it: an energy of the
//! mesh for each place. It is corrected as the terminals are, by the film's mean under the disc
//! times the error of a uniform film's mesh for the disc. What varies quickly, near terminals and
//! corners, a uniform sheet has too, and a slope of the film is a factor. So the look-up is the
//! exact R_p of a uniform sheet times that factor, times a ratio. The ratio was solved for on lines
//! 40 mm from one another, nearer where the film's patches end.

use super::analytic::Analytic;
use super::disc::Disc;
use super::geometry::Sheet;
use super::lattice::Lattice;
use super::lines::Lines;
use super::network::Network;
use super::neumann::Neumann;
use super::nodes::Values;
use super::spline::{AS_IT_IS, Axis, Spline};
use super::split::Solver;

/// From one node of the table of R_p to the next, by the mesh's spacing, and from where to where,
/// mm.
const TABLE: f64 = 0.75;
const TABLE_MM: [f64; 2] = [2.5, 6.5];

/// From one line to the next near ends of patches: the mesh's spacing from where to where, mm.
const NEAR_MM: [f64; 2] = [3.5, 8.0];

/// R_p over the places of a pad.
pub(super) fn own(sheet: &Sheet, network: &Network) -> Spline {
    let uniform = Analytic::new(sheet);
    let even = |x_mm, y_mm| {
        let sloping = sheet.film.slope(sheet.place_m(x_mm, y_mm));
        uniform.split(x_mm, y_mm).ohm * sloping
    };
    let step_mm = 1e3 * f64::min(network.mesh.step_m[0], network.mesh.step_m[1]);
    let reach_mm = sheet.reach_mm();
    let near_mm = step_mm.clamp(NEAR_MM[0], NEAR_MM[1]);
    let lines = [0, 1].map(|axis| {
        Lines::new(reach_mm[axis], &sheet.breaks_mm(axis), 1e3 * sheet.pad_radius_m, near_mm)
    });
    let mut solved = Solved::new(sheet, network);
    let mut ratios = Vec::with_capacity(lines[0].at_mm.len() * lines[1].at_mm.len());
    for y_mm in &lines[1].at_mm {
        let row = lines[0].at_mm.iter();
        ratios.extend(row.map(|x_mm| solved.ohm(sheet.place_m(*x_mm, *y_mm)) / even(*x_mm, *y_mm)));
    }
    let ratio = |x_mm, y_mm| {
        let [(column, across), (row, up)] = [lines[0].weights(x_mm), lines[1].weights(y_mm)];
        let along = |row: usize| {
            let first = row * lines[0].at_mm.len() + column;
            ratios[first..].iter().zip(across).map(|(ratio, weight)| ratio * weight).sum::<f64>()
        };
        (0..4).map(|n| up[n] * along(row + n)).sum::<f64>()
    };
    let table_mm = (TABLE * step_mm).clamp(TABLE_MM[0], TABLE_MM[1]);
    let axes = reach_mm.map(|mm| Axis::symmetric(mm, ((2.0 * mm / table_mm) as usize + 2).max(5)));
    Spline::of(axes, 1, AS_IT_IS, |&x, &y| {
        std::iter::once(even(x, y) * ratio(x, y)).collect::<Values>()
    })
}

/// The pad's disc on a mesh.
pub(super) struct Solved<'a> {
    sheet: &'a Sheet,
    network: &'a Network,
    exact: Neumann,
    lattice: Lattice,
    disc: Disc,
    work: Vec<f64>,
}

impl<'a> Solved<'a> {
    pub fn new(sheet: &'a Sheet, network: &'a Network) -> Self {
        let mesh = network.mesh;
        let step_m = f64::min(mesh.step_m[0], mesh.step_m[1]);
        let rings = (sheet.pad_radius_m / step_m).ceil() as usize + 2;
        Solved {
            sheet,
            network,
            exact: Neumann::exact(sheet.size_m),
            lattice: Lattice::new(&mesh),
            disc: Disc::new(sheet.pad_radius_m, rings),
            work: vec![0.0; mesh.nodes()],
        }
    }

    /// R_p of a pad at a place from the bottom left corner.
    pub fn ohm(&mut self, place_m: [f64; 2]) -> f64 {
        let sheet = self.sheet;
        let nodes = self.network.mesh.gather(self.disc.at(place_m));
        // N is not harmonic: what is taken out evenly lifts its mean over a disc, twice.
        let taken_out = sheet.pad_radius_m.powi(2) / (4.0 * sheet.size_m[0] * sheet.size_m[1]);
        let exact = self.exact.at(place_m, place_m, sheet.disc_m()) + taken_out;
        let wrong = sheet.film.mean(place_m, &self.disc) * (exact - self.lattice.energy(&nodes));
        self.network.resistance(&nodes, &mut self.work) + wrong
    }
}
