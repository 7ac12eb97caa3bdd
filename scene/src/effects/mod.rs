// SPDX-License-Identifier: MIT OR Apache-2.0
//! Effects: what the plant does beyond the ideal, each in a module of its own and switched on by its table.
//!
//! Once per slot the effects on the pad run in the order of [`EFFECTS`], each changing the [`Pad`]; then the effects on the
//! channels turn it into phasors or samples. An effect whose table (or key, for the sensor chain) is absent yields no
//! [`Spec`], so the plant holds nothing of it. To add an effect: one file with a `read`, one line in the list.

pub(crate) mod carrier;
mod friction;
mod gap;
mod running;
mod sensor;
pub(crate) mod sheet;

pub use running::EffectCost;
pub(crate) use running::Effects;

use std::ops::Range;
use std::sync::Arc;

use num_complex::Complex64;

use crate::device::{CHANNELS, Device, TERMINALS};
use crate::error::SceneError;
use crate::format::Table;
use crate::timing::Timing;

/// Every effect, in the order in which they act.
pub(crate) const EFFECTS: &[Reader] = &[
    sheet::read,
    gap::read,
    friction::read,
    carrier::read,
    sensor::leakage::read,
    sensor::gain::read,
    sensor::offset::read,
    sensor::noise::read,
    sensor::quantisation::read,
];

/// Reads an effect's table; `None` where the scene leaves the effect out.
pub(crate) type Reader = fn(&Table, &Device) -> Result<Option<Spec>, SceneError>;

/// An effect as the scene asks for it.
#[derive(Clone)]
pub(crate) struct Spec {
    pub name: &'static str,
    pub rung: String,
    pub build: Builder,
}

type Builder = Arc<dyn Fn(&Setting) -> Effect + Send + Sync>;

impl Spec {
    pub fn new(
        name: &'static str,
        rung: impl Into<String>,
        build: impl Fn(&Setting) -> Effect + Send + Sync + 'static,
    ) -> Option<Spec> {
        Some(Spec { name, rung: rung.into(), build: Arc::new(build) })
    }
}

/// What an effect may know of the run it is built for.
pub(crate) struct Setting<'a> {
    pub device: &'a Device,
    pub timing: &'a Timing,
    pub seed: u64,
    /// Which case of the scene: its noise differs from the other cases', its hardware does not.
    pub case: usize,
}

/// An effect at work.
pub(crate) enum Effect {
    Pad(Box<dyn PadEffect>),
    Channels(Box<dyn ChannelEffect>),
}

/// Acts on the pad, once per slot.
pub(crate) trait PadEffect: Send {
    fn act(&mut self, pad: &mut Pad);
}

/// Acts on what the ADC sees of a pad.
pub(crate) trait ChannelEffect: Send {
    /// On the amplitudes that a demodulator over the slot's window would find.
    fn phasors(&mut self, pad: &Pad, phasors: &mut Phasors);
    /// On the samples of a run, one row of channels per sample instant.
    fn samples(&mut self, pad: &Pad, run: &Run, rows: &mut [[f64; CHANNELS]]);
}

/// A pad in one slot, as far as the effects have got.
#[derive(Clone, Debug)]
pub(crate) struct Pad {
    /// Which pad it is: effects with a state keep one for each.
    pub index: usize,
    /// Middle of the slot's window, since the start of the case.
    pub time_s: f64,
    pub x_mm: f64,
    pub y_mm: f64,
    pub load_g: f64,
    pub haptic_v_rms: f64,
    pub capacitance_f: f64,
    /// Electrostatic attraction summed over the pad, N; where no effect says otherwise that of an even gap, eq. 7.
    pub attraction_n: f64,
    /// Haptic force, N; where no effect says otherwise eq. 8 with the true capacitance and voltage.
    /// Haptic force, N, where an effect says it.
    pub force_n: Option<f64>,
    /// Share of the current through each terminal.
    pub split: [f64; TERMINALS],
    /// Combined resistance R_p of the sheet at the pad, Ω.
    pub sheet_ohm: f64,
}

impl Pad {
    /// The haptic force as an effect says, or else by eq. 8.
    pub fn haptic_force_n(&self, device: &Device) -> f64 {
        self.force_n.unwrap_or(device.force_k * (self.capacitance_f * self.haptic_v_rms).powi(2))
    }
}

/// Complex amplitudes as fractions of full scale, real part in phase with the carrier.
#[derive(Clone, Debug, Default)]
pub(crate) struct Phasors {
    pub slot: u64,
    pub carrier: [Complex64; CHANNELS - 1],
    /// Mean square of the haptic channel, as a fraction of full scale squared.
    pub haptic_mean_square: f64,
}

/// A run of samples within a slot.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    pub slot: usize,
    /// Sample indices within the slot.
    pub range: Range<usize>,
    /// Index of the slot's first sample since the start of the case.
    pub slot_start: u64,
}
