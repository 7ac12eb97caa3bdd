// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[friction]`: the haptic force that the finger feels.
//!
//! | rung | force | source |
//! | --- | --- | --- |
//! | `coulomb` | F_h = μ·ΣF_e, the attraction summed over the patches of the gap | PHYSICS §3, §4 |
//!
//! Without the table the force is eq. 8 with the true capacitance and voltage, which for an even gap is the same. μ is
//! `device.mu`: 0.12, or 0.065 where the loop has to agree with the paper's K = 600.

use super::{Effect, Pad, PadEffect, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::Table;

pub(super) fn read(root: &Table, device: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("friction")? else { return Ok(None) };
    let rung = table.choice("rung", &["coulomb"])?.unwrap_or("coulomb");
    let mu = device.mu;
    Ok(Spec::new("friction", rung, move |_| Effect::Pad(Box::new(Coulomb { mu }))))
}

struct Coulomb {
    mu: f64,
}

impl PadEffect for Coulomb {
    fn act(&mut self, pad: &mut Pad) {
        pad.force_n = Some(self.mu * pad.attraction_n);
    }
}
