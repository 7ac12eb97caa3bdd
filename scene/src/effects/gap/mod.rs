// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[gap]`: the air gap under the pad, its capacitance and its attraction, patch by patch.
//!
//!   C = Σ ε₀S_i/(g_i+d),   F_e = Σ ½ε₀S_iV²/(g_i+d)²;   how g moves: see `law`
//!
//! | level | what | largest error of C, 0 → 400 → 0 V |
//! | --- | --- | --- |
//! | `static` | the relaxed equilibrium, on the branch that starts open | – |
//! | `hysteresis` | the relaxed equilibrium on the branch that the pad comes from: closed patches stay closed on the way down; 1 ms | – |
//! | `quasi-static` | film and creep without inertia, linearly implicit, 1 ms | 8e-2 |
//! | `semi-implicit` | inertia too; film and creep implicit, contact explicit, 100 µs | 3.1e-2 |
//! | `implicit-euler` | all implicit, 100 µs | 3.3e-2 |
//! | `trapezoid` | second order, 100 µs | 1.1e-3 |
//! | `tr-bdf2` | second order and damping, 100 µs: the reference | 3.0e-4 |
//!
//! `static` and `hysteresis` are questions of their own; all other levels approximate the same motion. An
//! error budget keeps the static gap where nothing is named, and chooses among these others where `rung =
//! "moving"`; without a budget that is `tr-bdf2`. With `[control]` the gap moves where no level is named.
//! `step_us` sets another step for the level that is named, up to 1 ms. A pad starts relaxed under its load,
//! its voltage switched on at time 0; from then on load and voltage act at all times, and where they step a
//! step ends. `drive = "sine"` pulls with the haptic voltage's own sine instead of its mean square; the force
//! that is reported is then still of the mean square, at the gap of the moment. Behind `[supply]` the pad's
//! voltage falls as its capacitance grows. Source: docs/physics.md §3.

mod compression;
mod dynamic;
mod equilibrium;
mod lanes;
mod law;
mod pad;
mod quasi_static;
mod read;
mod read_rubber;
mod rubber;

pub use compression::Compression;
pub(crate) use read::KEYS;
pub(super) use read::{read, read_raised};
pub(crate) use read_rubber::RUBBER_KEYS;

#[cfg(test)]
mod tests;
