// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[friction]`: the haptic force that the finger feels, and the pad's motion against friction.
//!
//! | level | what |
//! | --- | --- |
//! | `coulomb` | F_h = μ·ΣF_e, the attraction summed over the patches of the gap, and μN of the load; the pad's motion is prescribed |
//! | `stiction` | besides, friction μ(N + F_e) that sticks and slides |
//! | `dahl` | besides, bristles that bend before they slide |
//! | `lugre` | besides, the Stribeck fall of sliding friction and the bristles' damping |
//!
//! Each is a law of its own, none an approximation of another. For a finger that swings 30 mm twice a second, the
//! step's error in the pad's place is 1.4, 16 and 150 µm at 10 µs, 100 µs and 1 ms. The prototype has 1.8, 18 and 180
//! µm (docs/physics.md §4).
//!
//! Without the table the force is μ·ΣF_e too, of the nominal μ, and no friction acts on the pad. Without `[gap]`
//! that is eq. 8 with the true capacitance and voltage. μ is `device.mu`, 0.12 unless the scene says otherwise. The haptic force is what friction can do because of the voltage, whether the pad slides
//! or sticks; how much it does is the truth's `friction_n`, by `coulomb` as if the pad slid. With `[hand]` the pad lags behind its
//! trajectory; a step is `step_us`, 100 µs. Source: docs/physics.md §3, §4.

mod coefficient;
mod law;
mod moving;

use super::effect::{Effect, PadEffect};
use super::pad::Pad;
use super::spec::{Level, Rung, Setting, Spec};
use crate::device::Device;
use crate::error::SceneError;
use crate::format::{Key, Limits, Table, keys};
use coefficient::Coefficient;
pub(crate) use coefficient::KEYS as DRIFT_KEYS;
use law::{Law, Surface};
use moving::Moving;

/// Levels that have a law of motion, and what a slot of 1.7 ms costs at 100 µs, ns.
const LAWS: [(&str, Law, f64); 3] =
    [("stiction", Law::Stiction, 600.0), ("dahl", Law::Dahl, 4e3), ("lugre", Law::LuGre, 5e3)];

keys! { KEYS:
    /// Law of friction: `coulomb` prescribes the pad's motion; `stiction` sticks and slides, `dahl` bends bristles first,
    /// `lugre` adds the Stribeck fall and the bristles' damping.
    RUNG: Option<&'static str> =
        Rung::choice("rung", || [&["coulomb"][..], &LAWS.map(|(word, ..)| word)[..]].concat()).usually("lugre with [hand], else coulomb");
    /// Friction before the pad slides, by that of sliding.
    STICTION: f64 = Key::number("stiction", Limits::within(1.0, 10.0)).or(1.2);
    /// Stribeck velocity: at this speed the excess of `stiction` has fallen to 1/e.
    STRIBECK: f64 = Key::number("stribeck_mm_per_s", Limits::within(1e-6, 1e6)).or(10.0);
    /// Stiffness of the bristles.
    BRISTLE_N_PER_M: f64 = Key::number("bristle_n_per_m", Limits::within(1e-3, 1e12)).or(1e5);
    /// Damping of the bristles.
    BRISTLE_N_S_PER_M: f64 = Key::number("bristle_n_s_per_m", Limits::within(0.0, 1e9)).or(300.0);
    /// Time step.
    STEP_US: f64 = Key::number("step_us", Limits::within(1.0, 1000.0)).or(100.0);
}

pub(super) fn read(root: &Table, device: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("friction")? else { return Ok(None) };
    let surface = Surface {
        stiction: table.get(&STICTION)?,
        stribeck_m_s: 1e-3 * table.get(&STRIBECK)?,
        bristle_n_per_m: table.get(&BRISTLE_N_PER_M)?,
        bristle_n_s_per_m: table.get(&BRISTLE_N_S_PER_M)?,
    };
    let step_s = 1e-6 * table.get(&STEP_US)?;
    let mu = Coefficient::read(table, device)?;
    let newton_per_g = device.weight_n(1.0);
    let coulomb = {
        let mu = mu.clone();
        move |_: &Setting| Effect::Pad(Box::new(Coulomb { mu: mu.clone(), newton_per_g }))
    };
    let mut levels = vec![Level::new("coulomb", 20.0, coulomb).apart()];
    for (word, law, cost_ns) in LAWS {
        let (device, mu) = (device.clone(), mu.clone());
        let build = move |_: &Setting| {
            Effect::Pad(Box::new(Moving::new(law, surface, mu.clone(), step_s, device.clone())))
        };
        levels.push(Level::new(word, cost_ns, build).apart());
    }
    let has_hand = root.table("hand")?.is_some();
    let usual = if has_hand { "lugre" } else { "coulomb" };
    let spec = Spec::with_levels("friction", Some(table), &RUNG, levels, usual)?;
    if has_hand && spec.as_ref().is_some_and(|spec| spec.is_at("coulomb")) {
        let message = "expected \"stiction\", \"dahl\" or \"lugre\" with [hand], whose pad moves against friction, got \"coulomb\"";
        return Err(table.error("rung", message));
    }
    Ok(spec)
}

struct Coulomb {
    mu: Coefficient,
    newton_per_g: f64,
}

impl Coulomb {
    fn rub(&self, pad: &mut Pad, mu: f64) {
        let force_n = mu * pad.attraction_n;
        pad.force_n = Some(force_n);
        pad.friction_n = mu * self.newton_per_g * pad.load_g + force_n;
    }
}

impl PadEffect for Coulomb {
    fn act(&mut self, pad: &mut Pad) {
        self.rub(pad, self.mu.at(pad.time_s));
    }

    /// A calibration is of the nominal coefficient.
    fn settle(&mut self, pad: &mut Pad) {
        self.rub(pad, self.mu.nominal);
    }
}

#[cfg(test)]
mod tests;
