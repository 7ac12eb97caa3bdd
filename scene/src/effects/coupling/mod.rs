// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[coupling]`: what the other pads do to the pad that a slot selects.
//!
//! Only the selected pad has the sensing voltage, but every pad lies on the sheet, and for the
//! carrier the others are capacitors to ground. Where the selected pad's current lifts the sheet,
//! they draw some of it away:
//!
//!   I_k/(jωC_k) + Σ_l G_kl·I_l = V_k,   V = (V_s, 0, 0, …),   terminal i gets Σ_k w_i(x_k)·I_k
//!
//! G_kl is the sheet's potential at pad k for a unit current into pad l; G_kk is R_p. Four pads
//! shift a position by some tenths of a millimetre at 318 pF and by millimetres at 760 pF
//! (docs/physics.md §1), since amplitudes are of second order in ωCG.
//!
//! | level | what | error | four pads |
//! | --- | --- | --- | --- |
//! | `once` | the other pads answer the selected one, not each other | second order in ωCG | 3.6 µs |
//! | `full` | all currents together | – | 4.6 µs |
//!
//! With a shunt either takes 0.35 ms, on a mesh 27 µs.
//!
//! Pads that are nearer to each other than they are wide are taken as touching, and flagged.

#[cfg(test)]
pub(crate) mod tests;

use hapticore_sheet::coupling::{answered, apart, symmetric};
use num_complex::Complex64;

use super::effect::{Effect, PadsEffect};
use super::pad::Pad;
use super::sheet::analytic::{self, Analytic};
use super::sheet::mesh::Mesh;
use super::sheet::network::{self, Correction, Network};
use super::sheet::{Following, OfSheet, Sheet};
use super::shunt::{self, Screened};
use super::spec::{Level, Rung, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::{Table, keys};
use crate::terminals::PerTerminal;

/// Spacing of the mesh that a non-uniform film's G comes from, m.
const SPACING_M: f64 = 0.01;

keys! { KEYS:
    /// Whether the other pads answer the selected one alone, or each other, too.
    RUNG: Option<&'static str> = Rung::choice("rung", || vec!["once", "full"]).usually("full");
}

pub(super) fn read(root: &Table, device: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("coupling")? else { return Ok(None) };
    let Some(sheet) = root.table("sheet")? else {
        return Err(table
            .error("", "expected a [sheet] too, since pads are coupled through its resistance"));
    };
    let sheet = Sheet::read(sheet, device)?;
    let siemens_per_m2 = shunt::screened(root, device)?.map(|(_, siemens_per_m2)| siemens_per_m2);
    let level = |word, cost_ns, once| {
        let field = OfSheet::new(sheet.clone(), move |sheet| field(sheet, siemens_per_m2));
        Level::new(word, cost_ns, move |setting| {
            Effect::Pads(Box::new(Coupling {
                field: Following::new(&field),
                once,
                device: setting.device.clone(),
            }))
        })
    };
    // With a shunt or a mesh nearly all of it is the field: to neglect an answer saves nothing.
    let [once_ns, full_ns] = match (sheet.film.is_uniform(), siemens_per_m2) {
        (true, None) => [3.6e3, 4.6e3],
        (true, Some(_)) => [3.5e5, 3.5e5],
        (false, _) => [2.7e4, 2.7e4],
    };
    let levels = vec![level("once", once_ns, true), level("full", full_ns, false)];
    Spec::with_levels("coupling", Some(table), &RUNG, levels, "full")
}

/// The field of a sheet, with a shunt of ωc or none.
fn field(sheet: &Sheet, siemens_per_m2: Option<f64>) -> Box<dyn Field> {
    match siemens_per_m2 {
        Some(siemens_per_m2) => Box::new(Screened::new(sheet, siemens_per_m2)),
        None if sheet.film.is_uniform() => Box::new(Analytic::new(sheet)),
        None => {
            Box::new(Network::new(sheet, Mesh::new(sheet.size_m, SPACING_M), Correction::Peaceman))
        }
    }
}

/// The sheet's potential at one place for a unit current into another, Ω.
trait Field: Send + Sync {
    /// For each pair of different places; symmetric.
    fn ohm(&self, places_mm: &[[f64; 2]]) -> Vec<Vec<Complex64>>;
}

struct Coupling {
    field: Following<Box<dyn Field>>,
    once: bool,
    device: Device,
}

impl PadsEffect for Coupling {
    fn act(&mut self, pad: &mut Pad, others: &[Pad]) {
        let place = |pad: &Pad| [pad.x_mm, pad.y_mm];
        let (reach_mm, diameter_mm) = (self.device.reach_mm(), self.device.pad_diameter_mm);
        let (places, touching) = apart(place(pad), others.iter().map(place), reach_mm, diameter_mm);
        pad.touching = touching;
        let pads: Vec<&Pad> = std::iter::once(&*pad).chain(others).collect();
        let mut ohm = self.field.at(pad.film).ohm(&places);
        for (k, one) in pads.iter().enumerate() {
            ohm[k][k] = one.admittance(self.device.carrier_rad_s).inv();
        }
        let currents = if self.once { answered_once(&ohm) } else { answered(ohm) };
        let into = |terminal: usize| {
            pads.iter().zip(&currents).map(|(pad, current)| pad.split[terminal] * current).sum()
        };
        let transfer: PerTerminal<Complex64> = (0..pad.split.len()).map(into).collect();
        pad.transfer = Some(transfer);
    }
}

/// The same where each other pad answers the first one's current alone, and the first one takes no
/// notice.
fn answered_once(ohm: &[Vec<Complex64>]) -> Vec<Complex64> {
    let first = ohm[0][0].inv();
    (0..ohm.len()).map(|k| if k == 0 { first } else { -ohm[k][0] / ohm[k][k] * first }).collect()
}

impl Field for Analytic {
    fn ohm(&self, places_mm: &[[f64; 2]]) -> Vec<Vec<Complex64>> {
        let sources: Vec<analytic::Source> =
            places_mm.iter().map(|[x, y]| self.source(*x, *y)).collect();
        symmetric(sources.len(), |k, l| self.between(&sources[k], &sources[l]).into())
    }
}

impl Field for Screened {
    fn ohm(&self, places_mm: &[[f64; 2]]) -> Vec<Vec<Complex64>> {
        let sources: Vec<shunt::Source> =
            places_mm.iter().map(|[x, y]| self.source(*x, *y)).collect();
        symmetric(sources.len(), |k, l| self.between(&sources[k], &sources[l]))
    }
}

impl Field for Network {
    fn ohm(&self, places_mm: &[[f64; 2]]) -> Vec<Vec<Complex64>> {
        let half_m = self.mesh.place_m(self.mesh.cells[0], self.mesh.cells[1]).map(|m| m / 2.0);
        let place_m = |place: &[f64; 2]| [0, 1].map(|axis| half_m[axis] + 1e-3 * place[axis]);
        let mut work = vec![0.0; self.mesh.nodes()];
        let source = |place| self.source(&self.mesh.spread(place_m(place)), &mut work);
        let sources: Vec<network::Source> = places_mm.iter().map(source).collect();
        symmetric(sources.len(), |k, l| self.between(&sources[k], &sources[l]).into())
    }
}
