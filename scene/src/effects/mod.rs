// SPDX-License-Identifier: MIT OR Apache-2.0
//! Effects: what the plant does beyond the ideal, each in a module of its own and switched on by
//! its table.
//!
//! Once per slot the effects on the pad run in the order of [`EFFECTS`], each changing the [`Pad`].
//! Then the effects that see all pads together run; then the effects on the channels turn it into
//! phasors or samples. States of effects are kept at times of their own, whichever slots are asked
//! for: see `tick`. An effect whose table (or key, for the sensor chain) is absent yields no
//! [`Spec`], so the plant holds nothing of it. To add an effect: one file with a `read`, one line
//! in the list.

pub(crate) mod carrier;
pub(crate) mod charge;
pub(crate) mod coupling;
mod effect;
pub(crate) mod finger;
pub(crate) mod friction;
pub(crate) mod gap;
pub(crate) mod pad;
pub(crate) mod part;
pub(crate) mod recorded;
pub(crate) mod release;
mod running;
pub(crate) mod sensor;
pub(crate) mod sheet;
pub(crate) mod shunt;
mod spec;
pub(crate) mod split_electrode;
pub(crate) mod supply;
pub(crate) mod switching;
pub(crate) mod temperature;
mod tick;

pub(crate) use effect::{Phasors, Run};
pub use gap::Compression;
pub(crate) use pad::Pad;
pub use running::EffectCost;
pub(crate) use running::Effects;
pub(crate) use spec::{Setting, Spec};

use crate::device::Device;
use crate::error::SceneError;
use crate::format::Table;

/// Every effect, in the order in which they act.
pub(crate) const EFFECTS: &[Reader] = &[
    supply::read,
    charge::read,
    temperature::read_spring,
    gap::read,
    split_electrode::read,
    finger::read,
    release::read,
    friction::read,
    part::read,
    temperature::read,
    sheet::read,
    shunt::read,
    sensor::inductance::read,
    coupling::read,
    sensor::others::read,
    carrier::read,
    switching::read,
    sensor::leakage::read,
    shunt::panel::read,
    sensor::bandwidth::read,
    sensor::jitter::read,
    sensor::crosstalk::read,
    sensor::scale::read,
    sensor::gain::read,
    sensor::noise::read_density,
    sensor::offset::read,
    sensor::noise::read,
    sensor::noise::read_dither,
    sensor::quantisation::read,
];

/// Those that split a pad's current among the terminals.
pub(crate) const SPLITTING: [&str; 3] = ["sheet", "shunt", "coupling"];

/// Those on the film and on the currents: what comes before them moves the pads and their gaps.
pub(crate) const FILM_AND_CURRENTS: [&str; 7] = [
    "temperature",
    "sheet",
    "shunt",
    "sensor.inductance",
    "coupling",
    "sensor.others",
    carrier::CARRIER,
];

/// Those that see all pads together.
pub(crate) const JOINING: [&str; 2] = ["coupling", "sensor.others"];

/// Those that differ from one realisation to the next: an error of a level leaves them out.
pub(crate) const RANDOM: [&str; 4] =
    ["sensor.noise", "sensor.noise_density", "sensor.jitter", shunt::panel::PANEL_NOISE];

/// Reads an effect's table; `None` where the scene leaves the effect out.
pub(crate) type Reader = fn(&Table, &Device) -> Result<Option<Spec>, SceneError>;
