// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[supply]`: what lies between the haptic voltage's source and the pad, so that the pad's voltage
//! falls as its capacitance grows.
//!
//!   V_h = V_source / |1 + jω_h(R_lim + jω_hL)(C + C_par)|                                   of a sine
//!   V_h = V_source·√(1 − (2τ/T)·tanh(T/2τ)),   τ = R_lim(C + C_par)      of a square that turns every T
//!
//! A constant voltage loses nothing. What a square loses is in the first τ after each turn, when the
//! pad is recharged from −V to V: v = V(1 − 2e^(−t/τ)/(1 + e^(−T/τ))); the voltage is its RMS.
//!
//! | level | what | error |
//! | --- | --- | --- |
//! | `steady` | amplitudes | none once R_lim·(C + C_par), a quarter of a millisecond, has passed |
//!
//! Source: docs/physics.md §3; the inductance is no one's measurement, hence 0.

use std::f64::consts::TAU;

use super::effect::{Effect, PadEffect};
use super::pad::{Pad, Supply};
use super::spec::{Level, Rung, Spec};
use crate::device::{Device, EPSILON_0};
use crate::error::SceneError;
use crate::format::{Key, Limits, Table, keys};
use crate::wave::{HapticWave, limiter};

keys! { KEYS:
    /// Level of the supply.
    RUNG: Option<&'static str> = Rung::choice("rung", || vec!["steady"]).usually("steady");
    /// Inductance of the winding that adds the sensing voltage; 0 with a square.
    TRANSFORMER_H: f64 = Key::number("transformer_h", Limits::within(0.0, 1e3)).or(0.0);
}

pub(super) fn read(root: &Table, device: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("supply")? else { return Ok(None) };
    let transformer_h = table.get(&TRANSFORMER_H)?;
    if matches!(device.haptic_wave, HapticWave::Square { .. }) && transformer_h > 0.0 {
        let message = "expected 0 with carrier.haptic_wave = \"square\", whose turns would ring";
        return Err(table.error("transformer_h", message));
    }
    let [limiting_ohm, parasitic_f] = limiter(table)?;
    let supply = Supply {
        limiting_ohm,
        transformer_h,
        parasitic_f,
        rad_s: TAU * device.haptic_hz,
        wave: device.haptic_wave,
    };
    let pad_m2 = device.pad_area_m2;
    let steady = Level::new("steady", 20.0, move |setting| {
        let supply = Supply { wave: setting.device.haptic_wave, ..supply };
        Effect::Pad(Box::new(Supplied { supply, pad_m2 }))
    });
    Spec::with_levels("supply", Some(table), &RUNG, vec![steady], "steady")
}

struct Supplied {
    supply: Supply,
    pad_m2: f64,
}

impl PadEffect for Supplied {
    /// For a pad of given capacitance; a gap that moves asks again as it does.
    fn act(&mut self, pad: &mut Pad) {
        pad.supply = Some(self.supply);
        pad.haptic_v_rms = pad.haptic_v_at(pad.capacitance_f);
        pad.attraction_n =
            (pad.capacitance_f * pad.haptic_v_rms).powi(2) / (2.0 * EPSILON_0 * self.pad_m2);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// docs/physics.md §3, Fig. 7: 343 V where the pad has some 440 pF, 333 V where it has 760 pF.
    #[test]
    fn three_hundred_kilohms_drop_350_v_to_343_v_and_333_v() {
        let supply = Supply {
            limiting_ohm: 300e3,
            transformer_h: 0.0,
            parasitic_f: 100e-12,
            rad_s: TAU * 200.0,
            wave: HapticWave::Sine,
        };
        let at = |capacitance_f: f64| 350.0 * supply.share(capacitance_f);
        assert!(
            (at(440e-12) - 343.0).abs() < 0.1 && (at(760e-12) - 333.0).abs() < 0.1,
            "{} {}",
            at(440e-12),
            at(760e-12)
        );
    }

    #[test]
    fn a_transformer_raises_the_voltage_towards_its_resonance() {
        let supply = Supply {
            limiting_ohm: 300e3,
            transformer_h: 100.0,
            parasitic_f: 0.0,
            rad_s: TAU * 200.0,
            wave: HapticWave::Sine,
        };
        let without = Supply { transformer_h: 0.0, ..supply };
        assert!(supply.share(400e-12) > without.share(400e-12));
        assert_eq!(without.share(0.0), 1.0);
    }
    /// The mean square over a period of the recharging voltage, summed.
    #[test]
    fn a_square_loses_what_its_turns_take_to_recharge() {
        for turn_s in [1e-4, 1e-3, 1.7e-3] {
            let wave = HapticWave::Square { turn_s: Some(turn_s) };
            let supply = Supply {
                limiting_ohm: 300e3,
                transformer_h: 0.0,
                parasitic_f: 100e-12,
                rad_s: TAU * 200.0,
                wave,
            };
            let (steps, step_s) = (200_000, turn_s / 200_000.0);
            let tau_s = 300e3 * 540e-12;
            let half = |start: f64, square: &mut f64| {
                (0..steps).fold(start, |volt, _| {
                    let next =
                        volt + (1.0 - volt) * (step_s / tau_s) / (1.0 + 0.5 * step_s / tau_s);
                    *square += 0.25 * (volt + next).powi(2) / f64::from(steps);
                    next
                })
            };
            // Each half from where the one before has left it.
            let end = (0..40).fold(0.0, |end: f64, _| half(-end, &mut 0.0));
            let mut square = 0.0;
            half(-end, &mut square);
            let share = supply.share(440e-12);
            assert!((share / square.sqrt() - 1.0).abs() < 1e-6, "{share} {}", square.sqrt());
            assert_eq!(Supply { wave: HapticWave::Dc, ..supply }.share(440e-12), 1.0);
            assert_eq!(Supply { limiting_ohm: 0.0, ..supply }.share(440e-12), 1.0);
        }
    }
}
