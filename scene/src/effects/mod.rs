// SPDX-License-Identifier: MIT OR Apache-2.0
//! Effects: what the plant does beyond the ideal, each in a module of its own and switched on by its table.
//!
//! Once per slot the effects on the pad run in the order of [`EFFECTS`], each changing the [`Pad`]; then those that see all
//! pads at once; then the effects on the channels turn it into phasors or samples. An effect whose table (or key, for the
//! sensor chain) is absent yields no [`Spec`], so the plant holds nothing of it. To add an effect: one file with a `read`, one
//! line in the list.

pub(crate) mod carrier;
pub(crate) mod coupling;
mod friction;
mod gap;
mod halves;
mod hand;
mod running;
mod sensor;
pub(crate) mod sheet;
mod shunt;
mod spec;
mod supply;
mod switching;

pub use running::EffectCost;
pub(crate) use running::Effects;
pub(crate) use sensor::noise::{NOISE, Origin};
pub(crate) use spec::{Rung, Setting, Spec};

use std::ops::Range;

use crate::few::Few;
use hapticore_sheet::coupling::admittance;
use num_complex::Complex64;

use crate::device::{Device, MOST_CHANNELS, PerTerminal, VOLTAGES};
use crate::error::SceneError;
use crate::format::Table;

/// Every effect, in the order in which they act.
pub(crate) const EFFECTS: &[Reader] = &[
    supply::read,
    gap::read,
    halves::read,
    hand::read,
    friction::read,
    sheet::read,
    shunt::read,
    coupling::read,
    carrier::read,
    switching::read,
    sensor::leakage::read,
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

/// Reads an effect's table; `None` where the scene leaves the effect out.
pub(crate) type Reader = fn(&Table, &Device) -> Result<Option<Spec>, SceneError>;

/// An effect at work.
pub(crate) enum Effect {
    Pad(Box<dyn PadEffect>),
    Pads(Box<dyn PadsEffect>),
    Channels(Box<dyn ChannelEffect>),
}

/// Acts on the pad, once per slot.
pub(crate) trait PadEffect: Send {
    fn act(&mut self, pad: &mut Pad);
    /// Why the rung cannot be used on a pad that it has acted on, as for [`ChannelEffect::refuses`].
    fn refuses(&self, _: &Pad) -> Option<String> {
        None
    }
    /// As if the pad had been there for ever: what a calibration waits for.
    fn settle(&mut self, pad: &mut Pad) {
        self.act(pad);
    }
}

/// Acts on the pad that a slot serves, once per slot, in sight of all others.
pub(crate) trait PadsEffect: Send {
    fn act(&mut self, pad: &mut Pad, others: &[Pad]);
}

/// Acts on what the ADC sees of a pad.
pub(crate) trait ChannelEffect: Send {
    /// On the amplitudes that a demodulator over the slot's window would find.
    fn phasors(&mut self, pad: &Pad, phasors: &mut Phasors);
    /// On the samples of a run, one [row](Run::rows) of channels per sample instant.
    fn samples(&mut self, pad: &Pad, run: &Run, samples: &mut [f64]);
    /// Why the rung cannot be used on a pad: asked before a run where the rung says that it has [limits](Rung::limited).
    fn refuses(&self, _: &Pad) -> Option<String> {
        None
    }
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
    /// Haptic voltage at the source.
    pub source_v_rms: f64,
    /// What lies between source and pad, where an effect says it.
    pub supply: Option<supply::Supply>,
    /// Haptic voltage at the pad.
    pub haptic_v_rms: f64,
    pub capacitance_f: f64,
    /// Electrostatic attraction summed over the pad, N; where no effect says otherwise that of an even gap, eq. 7.
    pub attraction_n: f64,
    /// Haptic force, N, where an effect says it; else eq. 8 with the true capacitance and voltage.
    pub force_n: Option<f64>,
    /// How far along x the push is off the pad's centre.
    pub eccentricity_mm: f64,
    /// Eq. 10, where an effect says it.
    pub direction: f64,
    /// What pushes the pad besides its hand, N.
    pub push_n: [f64; 2],
    /// What the pad hangs on, where an effect says it; else it goes where its path says.
    pub hand: Option<hand::Hand>,
    /// Friction that acts on the pad, N, where an effect says it.
    pub friction_n: f64,
    /// Share of the current through each terminal; real where the sheet is all there is.
    pub split: PerTerminal<Complex64>,
    /// What the pad sees of the sheet, Ω: the combined resistance R_p, or an impedance where an effect makes it one.
    pub sheet_ohm: Complex64,
    /// Current into each terminal per volt of sensing, S, where an effect says it; else each one's share of jωC/(1 + jωC·R_p).
    pub transfer: Option<PerTerminal<Complex64>>,
    /// The pad reaches over the sheet's edge: it is taken as lying at the edge.
    pub over_edge: bool,
    /// The pad lies on another one: both are taken as touching.
    pub touching: bool,
}

impl Pad {
    /// The haptic voltage at the pad, were its capacitance this.
    pub fn haptic_v_at(&self, capacitance_f: f64) -> f64 {
        self.supply.map_or(self.source_v_rms, |supply| self.source_v_rms * supply.share(capacitance_f))
    }

    /// The haptic force as an effect says, or else by eq. 8.
    pub fn haptic_force_n(&self, device: &Device) -> f64 {
        self.force_n.unwrap_or(device.force_k * (self.capacitance_f * self.haptic_v_rms).powi(2))
    }

    /// jωC/(1 + jωC·R_p): the pad's capacitance in series with the sheet, S.
    pub fn admittance(&self, rad_s: f64) -> Complex64 {
        admittance(rad_s, self.capacitance_f, self.sheet_ohm)
    }

    /// Amplitudes of the terminals' currents, up to a common factor.
    pub fn amplitudes(&self) -> PerTerminal<f64> {
        self.transfer.unwrap_or(self.split).map(Complex64::norm)
    }

    /// Current into each terminal per volt of sensing, S: eqs. 1 and 4, or as an effect says.
    pub fn transfer(&self, device: &Device) -> PerTerminal<Complex64> {
        self.transfer.unwrap_or_else(|| {
            let total = self.admittance(device.carrier_rad_s);
            self.split.map(|share| total * share)
        })
    }

    /// Amplitudes of the terminals' channels, as fractions of full scale.
    pub fn terminal_amplitudes(&self, device: &Device) -> PerTerminal<Complex64> {
        let scale = device.carrier_v / device.current_full_scale_a;
        match &self.transfer {
            Some(transfer) => transfer.map(|siemens| siemens * scale),
            None => {
                let total = self.admittance(device.carrier_rad_s);
                self.split.map(|share| total * share * scale)
            }
        }
    }
}

/// Complex amplitudes as fractions of full scale, real part in phase with the carrier.
#[derive(Clone, Debug, Default)]
pub(crate) struct Phasors {
    pub slot: u64,
    /// The terminals', then the sensing voltage's.
    pub carrier: Few<Complex64, { MOST_CHANNELS - 1 }>,
    /// Mean square of the haptic channel, as a fraction of full scale squared.
    pub haptic_mean_square: f64,
}

impl Phasors {
    /// The terminals' amplitudes.
    pub fn terminals(&mut self) -> &mut [Complex64] {
        let terminals = self.carrier.len().saturating_sub(1);
        &mut self.carrier[..terminals]
    }
}

/// A run of samples within a slot.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    pub slot: usize,
    /// Sample indices within the slot.
    pub range: Range<usize>,
    /// Index of the slot's first sample since the start of the case.
    pub slot_start: u64,
    /// Samples per instant.
    pub channels: usize,
}

impl Run {
    /// Lets `act` see each row of channels. A device's number of channels is known at run time only; for the usual ones the
    /// compiler gets it as a constant, so that what `act` does to a row unrolls.
    #[inline]
    pub fn rows(&self, samples: &mut [f64], mut act: impl FnMut(&mut [f64])) {
        match self.channels {
            6 => samples.as_chunks_mut::<6>().0.iter_mut().for_each(|row| act(row)),
            8 => samples.as_chunks_mut::<8>().0.iter_mut().for_each(|row| act(row)),
            10 => samples.as_chunks_mut::<10>().0.iter_mut().for_each(|row| act(row)),
            channels => samples.chunks_exact_mut(channels).for_each(act),
        }
    }

    /// The terminals' part of a row.
    pub fn terminals(row: &mut [f64]) -> &mut [f64] {
        let terminals = row.len() - VOLTAGES;
        &mut row[..terminals]
    }
}
