// SPDX-License-Identifier: MIT OR Apache-2.0
//! What an effect can act on: a pad, all pads together, or what the ADC sees.

use std::ops::Range;

use num_complex::Complex64;

use super::pad::Pad;
use super::tick::Tick;
use crate::drive::PadDrive;
use crate::few::Few;
use crate::terminals::{MOST_CHANNELS, VOLTAGES};

/// An effect at work.
pub(crate) enum Effect {
    Pad(Box<dyn PadEffect>),
    Pads(Box<dyn PadsEffect>),
    Channels(Box<dyn ChannelEffect>),
}

/// Acts on the pad, once per slot.
pub(crate) trait PadEffect: Send + Sync {
    /// On a pad that has been so for ever, where the effect has a state.
    fn act(&mut self, pad: &mut Pad);
    /// On the pad at its time, to which its drive has brought the effect's state. The state that is
    /// kept must not depend on the times that are asked for: see [`Tick`].
    fn follow(&mut self, pad: &mut Pad, _: &PadDrive) {
        self.act(pad);
    }
    /// The next time up to the pad's own at which the effect keeps its state, where that depends on
    /// what the effects before it make of the pad.
    fn due(&self, _: &Pad, _: &PadDrive) -> Option<Tick> {
        None
    }
    /// Keeps the state at a time that was due; the pad is as it is just before.
    fn keep(&mut self, _: &Pad, _: Tick, _: &PadDrive) {}
    /// Force of the hand on a pad at the last time at which the effect kept its state, N, where it
    /// moves the pad. Effects before it see that force until the next.
    fn hand_n(&self, _pad: usize) -> Option<[f64; 2]> {
        None
    }
    /// Why the level cannot be used on a pad that it has acted on, as for
    /// [`ChannelEffect::refuses`].
    fn refuses(&self, _: &Pad) -> Option<String> {
        None
    }
    /// On a pad for a calibration: it has been there for ever.
    fn settle(&mut self, pad: &mut Pad) {
        self.act(pad);
    }
}

/// Acts on the pad that a slot serves, once per slot, in sight of all others.
pub(crate) trait PadsEffect: Send + Sync {
    fn act(&mut self, pad: &mut Pad, others: &[Pad]);
}

/// Acts on what the ADC sees of a pad.
pub(crate) trait ChannelEffect: Send + Sync {
    /// On the amplitudes that a demodulator over the slot's window would find.
    fn phasors(&mut self, pad: &Pad, phasors: &mut Phasors);
    /// On the samples of a run, one [row](Run::rows) of channels per sample instant. The carrier, the first
    /// effect of all, writes them; the others change what is there.
    fn samples(&mut self, pad: &Pad, run: &Run, samples: &mut [f64]);
    /// Whether it leaves no sample beyond full scale.
    fn clips(&self) -> bool {
        false
    }
    /// Why the level cannot be used on a pad: asked before a run where the level says that it has
    /// [limits](Rung::limited).
    fn refuses(&self, _: &Pad) -> Option<String> {
        None
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
    /// Lets `act` see each row of channels. A device's number of channels is known at run time
    /// only; for the usual ones the compiler gets it as a constant, so that what `act` does to a
    /// row unrolls.
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
    #[inline(always)]
    pub fn terminals(row: &mut [f64]) -> &mut [f64] {
        let terminals = row.len() - VOLTAGES;
        &mut row[..terminals]
    }
}
