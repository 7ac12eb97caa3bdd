// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core at its three fidelities behind one trait: slots in, measurements out.

use std::sync::Arc;

use hapticore_contract::calibration::Calibration;
use hapticore_contract::control::{Drive, Surface};
use hapticore_contract::frame::{Frame, Measurement};
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::Interpretation;
use hapticore_model::fidelity::clock::ClockSimulation;
use hapticore_model::fidelity::fixed::FixedSimulation;
use hapticore_reference::Reference;

/// How exactly the core is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fidelity {
    /// The equations in floating point.
    Float,
    /// The core's results to the bit, slot by slot.
    Fixed,
    /// Every clock of the core.
    Clock,
}

impl Fidelity {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Fidelity::Float => "float",
            Fidelity::Fixed => "fixed",
            Fidelity::Clock => "clock",
        }
    }
}

/// What the core receives of a slot.
#[derive(Debug, Clone)]
pub struct Slot {
    /// Pad number, from 0.
    pub pad: usize,
    /// Samples or amplitudes of the slot.
    pub signals: Signals,
}

/// The signals of a slot.
#[derive(Debug, Clone)]
pub enum Signals {
    /// ADC codes, a sample after the other, each of all channels.
    Samples {
        /// The codes: of the window, or of the blanking before it, too.
        codes: Vec<i32>,
        /// How many codes come before the window's.
        blanking: usize,
    },
    /// What an ideal demodulator finds, in fractions of full scale.
    Phasors {
        /// In-phase and quadrature of the terminals and the sensing voltage.
        amplitudes: Vec<(f64, f64)>,
        /// Of the haptic voltage.
        mean_square: f64,
    },
}

impl Slot {
    /// The codes of the window.
    ///
    /// # Panics
    /// Where the slot has phasors.
    pub fn window(&self) -> &[i32] {
        match &self.signals {
            Signals::Samples { codes, blanking } => &codes[*blanking..],
            Signals::Phasors { .. } => {
                unreachable!("phasors are refused where a core needs samples")
            }
        }
    }

    /// The codes of the whole slot.
    pub fn whole(&self) -> &[i32] {
        match &self.signals {
            Signals::Samples { codes, .. } => codes,
            Signals::Phasors { .. } => {
                unreachable!("phasors are refused where a core needs samples")
            }
        }
    }

    /// The frame of the slot, without its clocks.
    pub fn frame<V: Interpretation>(&self, core: &mut FixedSimulation<V>) -> Frame {
        match &self.signals {
            Signals::Samples { .. } => core.slot(self.pad, self.window()),
            Signals::Phasors { amplitudes, mean_square } => {
                core.phasors(self.pad, amplitudes, *mean_square)
            }
        }
    }

    /// The reference's measurement of the slot.
    pub fn refer(&self, reference: &mut Reference) -> Measurement {
        match &self.signals {
            Signals::Samples { .. } => reference.slot(self.pad, self.window()),
            Signals::Phasors { amplitudes, mean_square } => {
                reference.phasors(self.pad, amplitudes, *mean_square)
            }
        }
    }
}

/// A core at work. Measurements come in the order of their slots, perhaps some slots later.
pub trait Engine: Send {
    /// Takes a slot; the measurement that is finished, if one is.
    fn slot(&mut self, slot: &Slot) -> Option<Measurement>;

    /// The measurement of the last slot, where it is still to come.
    fn finish(&mut self) -> Option<Measurement> {
        None
    }

    /// Sets a pad's target force, N, where there is a controller.
    fn set_target(&mut self, _pad: usize, _newtons: f64) {}

    /// Sets where the wall that is known by this number begins, where there are walls.
    fn set_surface(&mut self, _pad: usize, _surface: Surface) {}

    /// The drive that the last slot led to, where there is a controller: after each slot, or after
    /// the last of a split pad.
    fn take_drive(&mut self) -> Option<Drive> {
        None
    }
}

/// A core of the profile at a fidelity.
pub fn engine(
    fidelity: Fidelity,
    profile: &Arc<Profile>,
    calibration: &Calibration,
) -> Box<dyn Engine> {
    match fidelity {
        Fidelity::Float => Box::new(Float(Reference::new(profile, calibration))),
        Fidelity::Fixed => {
            Box::new(Fixed(FixedSimulation::new(profile, calibration), profile.clone()))
        }
        Fidelity::Clock => {
            Box::new(Clock(ClockSimulation::new(profile, calibration), profile.clone()))
        }
    }
}

struct Float(Reference);

impl Engine for Float {
    fn slot(&mut self, slot: &Slot) -> Option<Measurement> {
        Some(slot.refer(&mut self.0))
    }
}

struct Fixed(FixedSimulation<i64>, Arc<Profile>);

impl Engine for Fixed {
    fn slot(&mut self, slot: &Slot) -> Option<Measurement> {
        Some(slot.frame(&mut self.0).measurement(&self.1))
    }
}

/// The frame of a slot comes while the next one is blanked.
struct Clock(ClockSimulation, Arc<Profile>);

impl Engine for Clock {
    fn slot(&mut self, slot: &Slot) -> Option<Measurement> {
        self.0.samples(slot.whole());
        self.0.take_frame().map(|frame| frame.measurement(&self.1))
    }

    fn finish(&mut self) -> Option<Measurement> {
        self.0.finish_slot().map(|frame| frame.measurement(&self.1))
    }
}
