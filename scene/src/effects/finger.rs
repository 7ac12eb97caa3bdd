// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[hand]`: the pad hangs on the finger by a spring and a damper, and the finger is what follows
//! the pad's trajectory.
//!
//!   m·v̇ = k(x_h − x) + c(v_h − v) + push − friction
//!
//! Without the table the pad itself follows its trajectory. A pad's `push_x_n` and `push_y_n` push
//! it besides; with a `stiffness_n_per_m` and a `damping_n_s_per_m` of 0 they alone move it. The
//! friction that the finger works against is `[friction]`'s, which also takes the steps. Source:
//! docs/physics.md §4, 300 N/m, 3 N·s/m, 0.05 kg.

use super::effect::{Effect, PadEffect};
use super::pad::{Finger, Pad};
use super::spec::{Level, Rung, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::{Key, Limits, Table, keys};

keys! { KEYS:
    /// Level of the finger.
    RUNG: Option<&'static str> = Rung::choice("rung", || vec!["spring"]).usually("spring");
    /// Stiffness of the spring between finger and pad.
    STIFFNESS_N_PER_M: f64 = Key::number("stiffness_n_per_m", Limits::within(0.0, 1e7)).or(300.0);
    /// Damping between finger and pad.
    DAMPING_N_S_PER_M: f64 = Key::number("damping_n_s_per_m", Limits::within(0.0, 1e5)).or(3.0);
    /// Mass of the pad.
    MASS_KG: f64 = Key::number("mass_kg", Limits::within(1e-6, 1e4)).or(0.05);
}

pub(super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("hand")? else { return Ok(None) };
    if root.table("friction")?.is_none() {
        return Err(table.error("", "expected [friction] too, which the finger works against"));
    }
    let finger = Finger {
        stiffness_n_per_m: table.get(&STIFFNESS_N_PER_M)?,
        damping_n_s_per_m: table.get(&DAMPING_N_S_PER_M)?,
        mass_kg: table.get(&MASS_KG)?,
    };
    let spring = Level::new("spring", 5.0, move |_| Effect::Pad(Box::new(OnFinger { finger })));
    Spec::with_levels("hand", Some(table), &RUNG, vec![spring], "spring")
}

struct OnFinger {
    finger: Finger,
}

impl PadEffect for OnFinger {
    fn act(&mut self, pad: &mut Pad) {
        pad.finger = Some(self.finger);
    }
}
