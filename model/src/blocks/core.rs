// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core: ADC codes in, frames out.
//!
//! ```text
//! strobe ─ multiplexer ─ oscillator ─ demodulator ─ estimator ─ frames
//!            └ pad, closed      code ──┘      calibration ──┘
//! ```
//!
//! The answer to `channel` is expected as `code` one clock later. Pads are selected by `pad` and
//! `closed`, break before make. The estimate of a slot may run on while the next window is taken; it
//! is over before that window's sums come.

mod front;
mod observer;
mod samples;

pub use self::observer::Observer;
use super::demodulator::{self, Demodulator};
use super::estimator::{self, Calibration, Estimator, FramePort, PromptPort};
use super::multiplexer::{self, Multiplexer};
use super::oscillator::{self, Oscillator};
use super::pace::{self, Pace};
use super::position::TablePort;
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::BIT;
use hapticore_hdl::signal::Clocked;
use hapticore_hdl::{block, call};

block! {
    /// The core: from ADC codes to frames, and the pad to be driven.
    pub struct Core("hapticore") {}
    submodules {
        multiplexer: Multiplexer,
        pace: Pace,
        oscillator: Oscillator,
        demodulator: Demodulator,
        estimator: Estimator,
    }
    inputs(core) {
        /// A set of ADC codes is valid.
        strobe: BIT,
        /// Abandons the current slot; the next strobe starts the first pad's slot.
        clear: BIT,
        /// The code of the channel that `channel` asked for one cycle earlier.
        code: core.demodulator.inputs().code,
        calibration as Calibration: core.estimator.inputs().calibration,
    }
    outputs(core) {
        /// The channel whose code is needed in the next cycle.
        channel: core.demodulator.outputs().channel,
        /// The selected pad.
        serve: core.multiplexer.outputs().pad,
        /// Its switch is closed.
        closed: BIT,
        carrier: core.oscillator.outputs().cosine,
        frames as FramePort: core.estimator.outputs().frames,
        /// Strobes have come closer than the profile's clocks per sample since reset or `clear`: frames are wrong.
        overrun: BIT,
        prompt as PromptPort: core.estimator.outputs().prompt,
    }
    registers(core) {}
}

impl<T: Copy> Inputs<T> {
    /// These inputs, with others at the port of the position table.
    pub fn with_table(mut self, table: TablePort<T>) -> Self {
        self.calibration.table = table;
        self
    }
}

impl Core {
    /// The core of a profile whose values are in their ranges.
    ///
    /// # Panics
    /// Where one of its blocks cannot be.
    pub fn new(profile: &Profile) -> Self {
        Self::of_blocks(profile).unwrap_or_else(|error| panic!("{error}"))
    }

    /// The core of a profile that need not have been checked.
    ///
    /// # Errors
    /// The first value that does not allow it: field, range and value.
    pub fn try_new(profile: &Profile) -> Result<Self, ProfileError> {
        profile.check_values()?;
        let core = Self::of_blocks(profile)?;
        core.check_clocks(profile)?;
        Ok(core)
    }

    fn of_blocks(profile: &Profile) -> Result<Self, ProfileError> {
        Ok(Core {
            multiplexer: Multiplexer::new(profile),
            pace: Pace::new(profile),
            oscillator: Oscillator::new(profile),
            demodulator: Demodulator::try_new(profile)?,
            estimator: Estimator::try_new(profile)?,
        })
    }

    /// Sums have been read out when the next window begins, and a frame is made when the next sums
    /// come: an estimate may run on while the next window is taken.
    fn check_clocks(&self, profile: &Profile) -> Result<(), ProfileError> {
        let read_out = self.demodulator.latency();
        let blanking = profile.slot.blanking() * profile.clocks_per_sample;
        if blanking <= read_out {
            let expected = format_args!("more than {read_out} clocks of blanking").to_string();
            return Err(ProfileError::value("slot.settle", expected, blanking));
        }
        // From a window's last sample to its frame, less those from the next's to its first sum.
        let frame = read_out + self.estimator.latency() - self.demodulator.first_sum();
        if profile.slot_clocks() <= frame {
            let expected = format_args!("slots of more than {frame} clocks").to_string();
            return Err(ProfileError::value("slot.settle", expected, profile.slot_clocks()));
        }
        Ok(())
    }

    /// The inputs of a core with a calibration, as codes, while nothing happens.
    pub fn idle_inputs(
        &self,
        calibration: &hapticore_contract::calibration::Calibration,
    ) -> Inputs<i64> {
        let formats = self.inputs();
        let mut inputs = Inputs::map(formats, |_| 0);
        let (gains, formats) = (&mut inputs.calibration, formats.calibration);
        gains.capacitance_gain =
            formats.capacitance_gain.code_saturating(calibration.capacitance_gain);
        gains.force_gain = formats.force_gain.code_saturating(calibration.force_gain);
        gains.contact_capacitance =
            formats.contact_capacitance.code_saturating(calibration.contact_capacitance);
        inputs
    }

    /// The pad multiplexer's configuration.
    pub fn multiplexer(&self) -> &Multiplexer {
        &self.multiplexer
    }

    /// The oscillator's configuration.
    pub fn oscillator(&self) -> &Oscillator {
        &self.oscillator
    }

    /// The demodulator's configuration.
    pub fn demodulator(&self) -> &Demodulator {
        &self.demodulator
    }

    /// The estimator's configuration.
    pub fn estimator(&self) -> &Estimator {
        &self.estimator
    }

    /// From now on interpretations of codes compute positions in one step, without their clocks,
    /// from a position table of these codes.
    pub(crate) fn place_at_once(&mut self, table: Vec<i64>) {
        self.estimator.place_at_once(table);
    }

    /// From now on interpretations that decide by codes compute positions without their clocks, with all that they have
    /// beside codes.
    pub(crate) fn place_by_statements(&mut self) {
        self.estimator.place_by_statements();
    }

    /// Clocks from the strobe of a window's last sample to its prompt estimate.
    pub fn prompt_latency(&self) -> u64 {
        1 + self.oscillator.latency() + self.demodulator.latency() + self.estimator.prompt_latency()
    }

    /// Clocks from the strobe of a window's last sample to the last word of its frame.
    pub fn latency(&self) -> u64 {
        1 + self.oscillator.latency() + self.demodulator.latency() + self.estimator.latency()
    }
}

impl Block for Core {
    #[inline(never)]
    fn step(&self, state: &mut State<Self, Clocked>, i: In<Clocked>) -> Out<Clocked> {
        self.clock(state, i)
    }

    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let inputs = multiplexer::Inputs { strobe: i.strobe, clear: i.clear };
        let slot = call!(self.multiplexer, state, inputs);
        let inputs = pace::Inputs { strobe: i.strobe, clear: i.clear };
        let pace = call!(self.pace, state, inputs);
        let inputs =
            oscillator::Inputs { sample: slot.sample, restart: slot.restart, first: slot.first };
        let oscillator = call!(self.oscillator, state, inputs);
        let inputs = demodulator::Inputs {
            start: oscillator.ready & slot.integrate,
            first: slot.first,
            last: slot.last,
            pad: slot.pad,
            code: i.code,
            cosine: oscillator.cosine,
            sine: oscillator.sine,
            window: oscillator.window,
            phase: oscillator.phase,
        };
        let demodulator = call!(self.demodulator, state, inputs);
        let inputs = estimator::Inputs {
            clear: i.clear,
            valid: demodulator.valid,
            index: demodulator.index,
            sum: demodulator.sum,
            pad: demodulator.pad,
            clipped: demodulator.clipped,
            calibration: i.calibration,
        };
        let estimator::Outputs { frames, prompt } = call!(self.estimator, state, inputs);
        Outputs {
            channel: demodulator.channel,
            serve: slot.pad,
            closed: slot.closed,
            carrier: oscillator.cosine,
            frames,
            overrun: pace.overrun,
            prompt,
        }
    }
}

#[cfg(test)]
mod tests;
