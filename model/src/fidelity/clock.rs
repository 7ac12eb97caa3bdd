// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fidelity `clock`: every clock of the core, as the board runs it.

use super::{Gathered, calibrated, signals};
use crate::block::{Block, Cell, sample, variables};
use crate::blocks::core::{Core, Inputs};
use crate::calibration::Calibration;
use crate::format::BIT;
use crate::frame::Frame;
use crate::probe::{Probe, Variable};
use crate::profile::Profile;
use crate::signal::Signal;

/// A core at work, clock by clock. Its memory does not grow with time.
pub struct ClockSimulation {
    core: Core,
    cell: Cell<Core, i64>,
    inputs: Inputs<Signal<i64>>,
    clocks_per_sample: u64,
    channels: usize,
    channel: usize,
    gathered: Gathered,
    frame: Option<Frame>,
    clocks: u64,
}

impl ClockSimulation {
    /// A core of a profile, calibrated, just before its first sample.
    pub fn new(profile: &Profile, calibration: &Calibration) -> Self {
        let core = Core::new(profile);
        let formats = core.inputs();
        ClockSimulation {
            cell: calibrated(&core, calibration),
            inputs: signals::<Inputs, i64>(calibration.inputs(formats), formats),
            core,
            clocks_per_sample: profile.clocks_per_sample,
            channels: profile.channels(),
            channel: 0,
            gathered: Gathered::default(),
            frame: None,
            clocks: 0,
        }
    }

    /// The clocks of one sample: codes of every channel, in the order terminals, sensing voltage, haptic voltage.
    ///
    /// # Panics
    /// Where `codes` has not one code a channel.
    pub fn sample(&mut self, codes: &[i32]) {
        self.sample_with(codes, |_| ());
    }

    /// As [`ClockSimulation::sample`], with a look at the simulation after each clock.
    pub fn sample_with(&mut self, codes: &[i32], mut look: impl FnMut(&Self)) {
        assert_eq!(codes.len(), self.channels, "one code a channel");
        for clock in 0..self.clocks_per_sample {
            self.clock(i64::from(clock == 0), codes);
            look(self);
        }
    }

    #[inline(always)]
    fn clock(&mut self, strobe: i64, codes: &[i32]) {
        let code = Signal { value: i64::from(codes[self.channel]), format: self.inputs.code.format };
        let strobe = Signal { value: strobe, format: BIT };
        let outputs = self.core.clock(&mut self.cell, Inputs { strobe, code, ..self.inputs });
        self.clocks += 1;
        self.channel = outputs.channel.value as usize;
        self.gathered.take(outputs.valid.value, outputs.index.value, outputs.frame.value);
        if outputs.done.value != 0 {
            let flags = [outputs.clipped, outputs.saturated, outputs.invalid, outputs.lost].map(|flag| flag.value);
            self.frame = Some(self.gathered.frame(outputs.pad.value, flags[0], flags[1], flags[2], flags[3]));
        }
    }

    /// The frame that has been finished since the last call.
    pub fn take_frame(&mut self) -> Option<Frame> {
        self.frame.take()
    }

    /// Runs on without samples until the frame of the slot that has just ended is there.
    pub fn finish_slot(&mut self) -> Option<Frame> {
        let codes = vec![0; self.channels];
        let mut left = self.core.latency();
        while self.frame.is_none() && left > 0 {
            self.clock(0, &codes);
            left -= 1;
        }
        self.take_frame()
    }

    /// Clocks since the first sample.
    pub fn clocks(&self) -> u64 {
        self.clocks
    }
}

impl Probe for ClockSimulation {
    fn variables(&self) -> Vec<Variable> {
        variables(&self.core, "core")
    }

    fn sample(&self, codes: &mut Vec<i64>) {
        sample(&self.core, &self.cell, codes);
    }
}
