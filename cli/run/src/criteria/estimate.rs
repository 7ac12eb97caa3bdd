// SPDX-License-Identifier: MIT OR Apache-2.0
//! The value of a quantity in a row: as the core, the reference and eq. 6 alone estimate it, and as
//! the plant has it.

use hapticore_scene::Quantity;

use crate::record::{GameRow, Quantities, Row, Truth};

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
    if let Some(known) = row.truth.and_then(|truth| known_to_the_plant(&truth, of)) {
        return known;
    }
    if let Some(known) = row.game.and_then(|game| of_game(&game, of)) {
        return known;
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
    if let Some(known) = row.game.and_then(|game| of_game(&game, of)) {
        return known;
    }
    match (of, row.truth) {
        (Quantity::TimeS, _) => row.time_s - start_s,
        (_, Some(truth)) => {
            known_to_the_plant(&truth, of).unwrap_or_else(|| quantity(&truth.quantities, of))
        }
        (_, None) => f64::NAN,
    }
}

/// What no frame estimates.
fn known_to_the_plant(truth: &Truth, of: Quantity) -> Option<f64> {
    match of {
        Quantity::LoadG => Some(truth.load_g),
        Quantity::FrictionN => Some(truth.friction_n),
        Quantity::HapticFrictionN => Some(truth.haptic_friction_n),
        Quantity::HandXN => Some(truth.hand_x_n),
        Quantity::EccentricityMm => Some(truth.set.eccentricity_mm),
        Quantity::Part => Some(truth.part as f64),
        _ => None,
    }
}

/// What the game of an arena knows.
fn of_game(game: &GameRow, of: Quantity) -> Option<f64> {
    match of {
        Quantity::PuckXMm => Some(game.puck_mm[0]),
        Quantity::PuckYMm => Some(game.puck_mm[1]),
        Quantity::PuckMmS => Some(game.puck_mm_s),
        Quantity::ImpactN => Some(game.impact_n),
        Quantity::ScoreLeft => Some(f64::from(game.score[0])),
        Quantity::ScoreRight => Some(f64::from(game.score[1])),
        _ => None,
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
