// SPDX-License-Identifier: MIT OR Apache-2.0
//! The value of a quantity in a row: as the core, the reference and eq. 6 alone estimate it, and as
//! the plant has it.

use hapticore_scene::Quantity;

use crate::record::{Quantities, Row};

/// The source of an estimate.
#[derive(Clone, Copy)]
pub enum Estimate {
    /// The fixed-point core.
    Core,
    /// The floating-point reference on the same samples.
    Reference,
    /// Eq. 6 alone, without the sheet's resistance.
    Eq6,
}

/// The estimate of a quantity; not a number where there is none. What the plant alone knows is not
/// estimated: it is the truth.
pub fn estimated(row: &Row, of: Quantity, estimate: Estimate) -> f64 {
    if let (Quantity::LoadG | Quantity::FrictionN, Some(truth)) = (of, row.truth) {
        return if of == Quantity::LoadG { truth.load_g } else { truth.friction_n };
    }
    match (estimate, row.reference) {
        (Estimate::Core, _) => quantity(&row.measured, of),
        (Estimate::Reference, Some(reference)) => quantity(&reference.quantities, of),
        (Estimate::Eq6, Some(reference)) if of == Quantity::ForceN => reference.force_eq6_n,
        (Estimate::Eq6, Some(reference)) if of == Quantity::CapacitancePf => {
            reference.capacitance_eq6_pf
        }
        _ => f64::NAN,
    }
}

/// What the plant knows of a quantity; times since `start_s`.
pub fn truth(row: &Row, of: Quantity, start_s: f64) -> f64 {
    match (of, row.truth) {
        (Quantity::TimeS, _) => row.time_s - start_s,
        (Quantity::LoadG, Some(truth)) => truth.load_g,
        (Quantity::FrictionN, Some(truth)) => truth.friction_n,
        (_, Some(truth)) => quantity(&truth.quantities, of),
        (_, None) => f64::NAN,
    }
}

fn quantity(quantities: &Quantities, of: Quantity) -> f64 {
    hapticore_host::quantity(of.name()).map_or(f64::NAN, |quantity| quantity.value_in(quantities))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A scene knows the truth of what a host measures: either has a list of its own, for neither
    /// may know the other.
    #[test]
    fn what_a_frame_measures_is_what_a_scene_knows() {
        let known: Vec<_> = Quantity::measured().map(Quantity::name).collect();
        assert_eq!(known, hapticore_host::QUANTITIES.map(|quantity| quantity.name));
    }
}
