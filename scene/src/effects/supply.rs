// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[supply]`: what lies between the haptic voltage's source and the pad, so that the pad's voltage
//! falls as its capacitance grows.
//!
//!   V_h = V_source / |1 + jω_h(R_lim + jω_hL)(C + C_par)|
//!
//! | level | what | error |
//! | --- | --- | --- |
//! | `steady` | amplitudes | none once R_lim·(C + C_par), a quarter of a millisecond, has passed |
//!
//! `limiting_kohm` is the resistor that keeps the current harmless, `transformer_h` the inductance
//! of the winding that adds the sensing voltage, `parasitic_pf` the capacitance of cable and pad to
//! ground. Source: docs/physics.md §3; the inductance is no one's measurement, hence 0.

use std::f64::consts::TAU;

use super::effect::{Effect, PadEffect};
use super::pad::{Pad, Supply};
use super::spec::{Level, Spec};
use crate::device::{Device, EPSILON_0};
use crate::error::SceneError;
use crate::format::{Limits, Table};

pub(super) fn read(root: &Table, device: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("supply")? else { return Ok(None) };
    let supply = Supply {
        limiting_ohm: 1e3 * table.number_or("limiting_kohm", Limits::NOT_NEGATIVE, 300.0)?,
        transformer_h: table.number_or("transformer_h", Limits::NOT_NEGATIVE, 0.0)?,
        parasitic_f: 1e-12 * table.number_or("parasitic_pf", Limits::NOT_NEGATIVE, 100.0)?,
        rad_s: TAU * device.haptic_hz,
    };
    let pad_m2 = device.pad_area_m2;
    let steady =
        Level::new("steady", 20.0, move |_| Effect::Pad(Box::new(Supplied { supply, pad_m2 })));
    Spec::with_levels("supply", Some(table), vec![steady], "steady")
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
        };
        let without = Supply { transformer_h: 0.0, ..supply };
        assert!(supply.share(400e-12) > without.share(400e-12));
        assert_eq!(without.share(0.0), 1.0);
    }
}
