// SPDX-License-Identifier: MIT OR Apache-2.0
//! How the haptic voltage goes on in time, of which a scene sets the RMS.
//!
//! A sine and a square have no mean, so that no charge gathers in the insulators (`effects/charge`);
//! of a square V² is constant, too. Source: docs/physics.md §7.

use crate::error::SceneError;
use crate::format::{Key, Limits, Table, keys};
use crate::stimulus::{Moment, next_multiple};

keys! { KEYS:
    /// How the haptic voltage goes on in time.
    HAPTIC_WAVE: Option<&'static str> = Key::choice("haptic_wave", || vec!["sine", "dc", "square"]).usually("sine");
    /// Time from one turn of a square's polarity to the next, from time 0 on.
    HAPTIC_TURN_S: Option<f64> = Key::number("haptic_turn_s", Limits::within(1e-6, 1e5)).usually("every slot; behind `[supply]` 20 time constants");
}

keys! { SUPPLY_KEYS:
    /// Resistor that keeps the current harmless.
    LIMITING_KOHM: f64 = Key::number("limiting_kohm", Limits::within(0.0, 1e6)).or(300.0);
    /// Capacitance of cable and pad to ground.
    PARASITIC_PF: f64 = Key::number("parasitic_pf", Limits::within(0.0, 1e6)).or(100.0);
}

/// A turn comes so many time constants of the supply after the one before, where a scene does not say when: it
/// then costs a tenth of the mean square.
pub(crate) const LEAST_TAUS: f64 = 20.0;

/// Capacitance of a pad in work for each area, F/m²: 600 pF of the paper's pad (docs/physics.md §3, 400 V).
const WORKING_F_PER_M2: f64 = 0.85e-6;

/// What lies between the source and a pad: the limiting resistor, Ω, and the capacitance to ground, F.
pub(crate) fn limiter(supply: &Table) -> Result<[f64; 2], SceneError> {
    Ok([1e3 * supply.get(&LIMITING_KOHM)?, 1e-12 * supply.get(&PARASITIC_PF)?])
}

/// The time constant with which `[supply]` recharges a pad in work, s: 210 µs of the paper's; 0 without the table.
pub(crate) fn recharge_s(root: &Table, pad_area_m2: f64) -> Result<f64, SceneError> {
    let Some(supply) = root.table("supply")? else { return Ok(0.0) };
    let [limiting_ohm, parasitic_f] = limiter(supply)?;
    Ok(limiting_ohm * (WORKING_F_PER_M2 * pad_area_m2 + parasitic_f))
}

/// How the haptic voltage goes on in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HapticWave {
    /// A sine.
    Sine,
    /// A constant voltage.
    Dc,
    /// A voltage that turns its polarity.
    Square {
        /// From one turn to the next, s; none, until a plant is built for a core, where it turns
        /// with every slot, or less often behind a supply.
        turn_s: Option<f64>,
    },
}

impl HapticWave {
    /// Reads `[carrier]`'s keys.
    pub(crate) fn read(root: &Table) -> Result<HapticWave, SceneError> {
        let Some(carrier) = root.table("carrier")? else { return Ok(HapticWave::Sine) };
        let word = carrier.get(&HAPTIC_WAVE)?;
        let turn_s = carrier.get(&HAPTIC_TURN_S)?;
        match (word, turn_s) {
            (Some("square"), turn_s) => Ok(HapticWave::Square { turn_s }),
            (_, Some(_)) => Err(carrier.error(
                "haptic_turn_s",
                "expected haptic_wave = \"square\" too, which alone turns",
            )),
            (Some("dc"), None) => Ok(HapticWave::Dc),
            _ => Ok(HapticWave::Sine),
        }
    }

    /// Peak value over rms value.
    pub(crate) fn crest(self) -> f64 {
        match self {
            HapticWave::Sine => std::f64::consts::SQRT_2,
            HapticWave::Dc | HapticWave::Square { .. } => 1.0,
        }
    }

    /// The same under a core whose slots last so long, behind a supply that recharges a pad with a time constant.
    pub(crate) fn in_slots_of(self, slot_s: f64, recharge_s: f64) -> HapticWave {
        match self {
            HapticWave::Square { turn_s } => {
                let slots = (LEAST_TAUS * recharge_s / slot_s).ceil().max(1.0);
                HapticWave::Square { turn_s: Some(turn_s.unwrap_or(slots * slot_s)) }
            }
            same => same,
        }
    }

    /// What a scene writes.
    pub fn name(self) -> &'static str {
        match self {
            HapticWave::Sine => "sine",
            HapticWave::Dc => "dc",
            HapticWave::Square { .. } => "square",
        }
    }

    /// Its polarity: 1 or −1, and 0 for a sine, which has none for long.
    pub(crate) fn polarity(self, moment: Moment) -> f64 {
        const ROUNDING: f64 = 1e-9;
        match self {
            HapticWave::Sine => 0.0,
            HapticWave::Dc => 1.0,
            HapticWave::Square { turn_s } => {
                let turns = moment.time_s / turn_s.unwrap_or(f64::INFINITY);
                let past = match moment.is_past(moment.time_s) {
                    true => turns + ROUNDING,
                    false => (turns - ROUNDING).ceil() - 1.0,
                };
                // The cast leaves no fraction, and nothing below zero.
                if past as u64 & 1 == 0 { 1.0 } else { -1.0 }
            }
        }
    }

    /// When the polarity next turns; infinite where it never does.
    pub(crate) fn next_turn_s(self, after_s: f64) -> f64 {
        match self {
            HapticWave::Square { turn_s: Some(turn_s) } => next_multiple(turn_s, after_s),
            _ => f64::INFINITY,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_turns_at_multiples_and_has_not_turned_just_before() {
        let square = HapticWave::Square { turn_s: Some(0.1) };
        for n in 1..50u32 {
            let turn_s = square.next_turn_s(0.1 * f64::from(n) - 0.03);
            assert!((turn_s - 0.1 * f64::from(n)).abs() < 1e-12);
            let polarity = if n % 2 == 0 { 1.0 } else { -1.0 };
            let around = [Moment::before(turn_s), Moment::at(turn_s), Moment::at(turn_s + 0.05)];
            assert_eq!(around.map(|at| square.polarity(at)), [-polarity, polarity, polarity]);
        }
        assert_eq!(square.polarity(Moment::at(0.0)), 1.0);
    }

    #[test]
    fn a_square_without_a_time_turns_with_every_slot() {
        let square = HapticWave::Square { turn_s: None };
        assert_eq!(square.next_turn_s(3.0), f64::INFINITY);
        assert_eq!(square.in_slots_of(0.5, 0.0).next_turn_s(3.0), 3.5);
        let own = HapticWave::Square { turn_s: Some(2.0) };
        assert_eq!(own.in_slots_of(0.5, 1.0), own);
    }

    #[test]
    fn a_square_behind_a_supply_turns_every_20_time_constants_or_less_often() {
        for (slot_s, recharge_s, slots) in
            [(1e-3, 210e-6, 5.0), (250e-6, 210e-6, 17.0), (0.5, 1e-3, 1.0)]
        {
            let HapticWave::Square { turn_s } =
                HapticWave::Square { turn_s: None }.in_slots_of(slot_s, recharge_s)
            else {
                panic!("a square stays one")
            };
            assert_eq!(turn_s, Some(slots * slot_s));
        }
    }
}
