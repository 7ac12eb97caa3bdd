// SPDX-License-Identifier: MIT OR Apache-2.0
//! A core with its force controller, slot by slot: `fixed` and, of every clock, `clock`.
//!
//! Either takes the codes of a slot's window and gives its drive word, and the frame that is
//! finished: that of the slot, or with `clock`, where slots are short, that of the slot before. What
//! the ADC sees while a slot is blanked touches neither, so that `clock` is given zeros there: a
//! plant can then wait for the drive word before it makes the window that depends on it.

use super::fixed::FixedSimulation;
use super::{Gathered, signals};
use crate::blocks::controller::{self, Controller, Faults as FaultPort};
use crate::blocks::core;
use crate::blocks::force_loop::{DrivePort, ForceLoop, Inputs, Outputs};
use crate::blocks::position::TablePort;
use hapticore_contract::calibration::Calibration;
use hapticore_contract::control::{Drive, Faults, Tuning};
use hapticore_contract::frame::Frame;
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::{Block, Inputs as BlockInputs, Outputs as BlockOutputs, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::probe::{Probe, Variable, sample, variables};
use hapticore_hdl::signal::{Signal, bit, code};
use std::slice::ChunksExact;

/// The tuning's words as codes, all drives on, nothing written.
pub fn tuning_codes(
    formats: &controller::Tuning<Format>,
    tuning: &Tuning,
) -> controller::Tuning<i64> {
    controller::Tuning {
        enable: 1,
        full_drive: formats.full_drive.code_saturating(tuning.full_drive),
        proportional: formats.proportional.code_saturating(tuning.proportional),
        correction: formats.correction.code_saturating(tuning.correction),
        rail: formats.rail.code_saturating(tuning.rail),
        slew: formats.slew.code_saturating(tuning.slew),
        force_cap: formats.force_cap.code_saturating(tuning.force_cap),
        curve_write: 0,
        curve_address: 0,
        curve_word: 0,
    }
}

/// The writes of the curve, one a clock.
pub fn curve_writes(
    formats: controller::Tuning<Format>,
    tuning: &Tuning,
) -> Vec<controller::Tuning<i64>> {
    let mut write = tuning_codes(&formats, tuning);
    write.curve_write = 1;
    let mut writes = Vec::new();
    for (address, word) in (0..).zip(&tuning.curve) {
        write.curve_address = address;
        write.curve_word = formats.curve_word.code_saturating(*word);
        writes.push(write);
    }
    writes
}

fn faults(port: FaultPort<Signal<i64>>) -> Faults {
    let FaultPort { silence_fault, sensor_fault, force_fault } =
        FaultPort::map(port, |fault| fault.value != 0);
    Faults { silence: silence_fault, sensor: sensor_fault, force: force_fault }
}

/// Fidelity `fixed`: the controller's clocks follow those of the estimator, both without those of
/// the samples.
pub struct FixedLoop {
    core: FixedSimulation<i64>,
    controller: Controller,
    state: State<Controller, i64>,
    tuning: controller::Tuning<Signal<i64>>,
    targets: Vec<i64>,
    alive: bool,
}

impl FixedLoop {
    /// A core and a controller of a profile, calibrated and tuned, all targets zero.
    ///
    /// # Errors
    /// A profile without a controller, or one that cannot be.
    pub fn new(
        profile: &Profile,
        calibration: &Calibration,
        tuning: &Tuning,
    ) -> Result<Self, ProfileError> {
        let controller = Controller::try_new(profile)?;
        let formats = controller.inputs().tuning;
        let mut state = controller.reset();
        for write in curve_writes(formats, tuning) {
            let idle = controller::Inputs { tuning: write, ..controller::Inputs::of(0) };
            let inputs = signals::<controller::Inputs, i64>(idle, controller.inputs());
            clock(&controller, &mut state, inputs);
        }
        Ok(FixedLoop {
            core: FixedSimulation::new(profile, calibration),
            tuning: signals::<controller::Tuning, i64>(tuning_codes(&formats, tuning), formats),
            state,
            controller,
            targets: vec![0; profile.pads as usize],
            alive: false,
        })
    }

    /// Sets a pad's target force, N.
    pub fn set_target(&mut self, pad: usize, newtons: f64) {
        self.targets[pad] = self.controller.inputs().target.code_saturating(newtons);
        self.alive = true;
    }

    /// The frame and the drive word of a slot, of what `frame` lets the core find.
    pub fn slot(
        &mut self,
        frame: impl FnOnce(&mut FixedSimulation<i64>) -> Frame,
    ) -> (Frame, Drive) {
        let frame = frame(&mut self.core);
        let prompt = self.core.prompt().expect("a core with a controller gives an estimate");
        let formats = self.controller.inputs();
        let inputs = controller::Inputs {
            start: bit(false),
            pad: prompt.prompt_pad,
            target: code(self.targets[frame.pad], formats.target),
            capacitance: prompt.prompt_capacitance,
            measured: prompt.prompt_force,
            force_gain: prompt.prompt_gain,
            invalid: prompt.prompt_invalid,
            alive: bit(std::mem::take(&mut self.alive)),
            clear_faults: bit(false),
            tuning: self.tuning,
        };
        (frame, run(&self.controller, &mut self.state, inputs, frame.pad))
    }
}

/// A clock, out of line: once is enough of what is large.
#[inline(never)]
fn clock<B: Block>(
    block: &B,
    state: &mut State<B, i64>,
    inputs: BlockInputs<B, Signal<i64>>,
) -> BlockOutputs<B, Signal<i64>> {
    block.clock(state, inputs)
}

/// Runs a controller until its drive word is there.
///
/// # Panics
/// Where it does not finish within its latency.
#[inline(never)]
fn run(
    controller: &Controller,
    state: &mut State<Controller, i64>,
    inputs: controller::In<i64>,
    pad: usize,
) -> Drive {
    clock(controller, state, inputs);
    let quiet = controller::Inputs { alive: bit(false), ..inputs };
    clock(controller, state, controller::Inputs { start: bit(true), ..quiet });
    for _ in 0..controller.latency() {
        let out = clock(controller, state, quiet);
        if out.done.value != 0 {
            return Drive {
                pad,
                fraction: out.drive.format.real(out.drive.value),
                low: out.low.value != 0,
                high: out.high.value != 0,
                faults: faults(out.faults),
            };
        }
    }
    unreachable!("the controller finishes within its latency")
}

/// Fidelity `clock`: every clock, as the board runs it.
pub struct ClockLoop {
    block: ForceLoop,
    inputs: Inputs<Signal<i64>>,
    clocks_per_sample: u64,
    /// What the ADC sees of a slot's blanking.
    silence: Vec<i32>,
    channels: usize,
    state: ClockState,
}

/// What changes from clock to clock: apart from what does not, so that the compiler need not look
/// at formats again after every word that is written.
struct ClockState {
    block: State<ForceLoop, i64>,
    channel: usize,
    gathered: Gathered,
    frame: Option<Frame>,
    drive: Option<Drive>,
    clocks: u64,
}

impl ClockLoop {
    /// A core and a controller of a profile, calibrated and tuned, the first slot's blanking behind
    /// them.
    ///
    /// # Errors
    /// A profile without a controller, or one that cannot be.
    pub fn new(
        profile: &Profile,
        calibration: &Calibration,
        tuning: &Tuning,
    ) -> Result<Self, ProfileError> {
        let block = ForceLoop::try_new(profile)?;
        let formats = block.inputs();
        let codes = Inputs {
            core: block.core.idle_inputs(calibration),
            tuning: tuning_codes(&formats.tuning, tuning),
            ..Inputs::of(0)
        };
        let channels = profile.channels();
        let mut of = ClockLoop {
            state: ClockState {
                block: block.reset(),
                channel: 0,
                gathered: Gathered::default(),
                frame: None,
                drive: None,
                clocks: 0,
            },
            inputs: signals::<Inputs, i64>(codes, formats),
            clocks_per_sample: profile.clocks_per_sample,
            silence: vec![0; profile.slot.blanking() as usize * channels],
            channels,
            block,
        };
        of.calibrate(profile, calibration, tuning);
        of.blank();
        Ok(of)
    }

    fn calibrate(&mut self, profile: &Profile, calibration: &Calibration, tuning: &Tuning) {
        let formats = self.block.inputs();
        let word = formats.core.calibration.table.word;
        for (address, real) in (0..).zip(calibration.words(profile)) {
            let codes = TablePort { write: 1, address, word: word.code_saturating(real) };
            let table = formats.core.calibration.table;
            let mut inputs = self.inputs;
            inputs.core.calibration.table = signals::<TablePort, i64>(codes, table);
            clock(&self.block, &mut self.state.block, inputs);
        }
        for write in curve_writes(formats.tuning, tuning) {
            let tuning = signals::<controller::Tuning, i64>(write, formats.tuning);
            clock(&self.block, &mut self.state.block, Inputs { tuning, ..self.inputs });
        }
    }

    /// Sets a pad's target force, N.
    pub fn set_target(&mut self, pad: usize, newtons: f64) {
        let formats = self.block.inputs().target;
        let mut inputs = self.inputs;
        inputs.target.target_write = bit(true);
        inputs.target.target_pad = code(pad as i64, formats.target_pad);
        inputs.target.target_word =
            code(formats.target_word.code_saturating(newtons), formats.target_word);
        let outputs = clock(&self.block, &mut self.state.block, inputs);
        self.state.collect(outputs);
    }

    /// The drive word of a slot, and the frame that is finished before the next window begins, if
    /// one is: `codes` are those of its window.
    pub fn slot(&mut self, codes: &[i32]) -> (Option<Frame>, Drive) {
        self.samples(codes);
        self.blank();
        self.results()
    }

    /// As [`ClockLoop::slot`], with a look at the simulation after each clock.
    pub fn slot_with(
        &mut self,
        codes: &[i32],
        mut look: impl FnMut(&Self),
    ) -> (Option<Frame>, Drive) {
        let silence = self.silence.clone();
        for codes in codes.chunks_exact(self.channels).chain(silence.chunks_exact(self.channels)) {
            for count in 0..self.clocks_per_sample {
                self.clock(count == 0, codes);
                look(self);
            }
        }
        self.results()
    }

    /// Runs on without samples until the last slot's frame is there, where it is still to come.
    pub fn finish(&mut self) -> Option<Frame> {
        let codes = vec![0; self.channels];
        let mut left = self.block.core.latency();
        while self.state.frame.is_none() && left > 0 {
            self.clock(false, &codes);
            left -= 1;
        }
        self.state.frame.take()
    }

    fn clock(&mut self, strobe: bool, codes: &[i32]) {
        let inputs = self.state.inputs(&self.inputs, strobe, codes);
        let outputs = clock(&self.block, &mut self.state.block, inputs);
        self.state.collect(outputs);
    }

    fn results(&mut self) -> (Option<Frame>, Drive) {
        let drive = self.state.drive.take().expect("the blanking is longer than it takes");
        (self.state.frame.take(), drive)
    }

    /// Clocks since the first sample.
    pub fn clocks(&self) -> u64 {
        self.state.clocks
    }

    fn blank(&mut self) {
        let silence = std::mem::take(&mut self.silence);
        self.samples(&silence);
        self.silence = silence;
    }

    fn samples(&mut self, codes: &[i32]) {
        let samples = codes.chunks_exact(self.channels);
        self.state.samples(&self.block, &self.inputs, self.clocks_per_sample, samples);
    }
}

impl ClockState {
    /// Not inlined: what it borrows is then known to be apart.
    #[inline(never)]
    fn samples(
        &mut self,
        block: &ForceLoop,
        inputs: &Inputs<Signal<i64>>,
        clocks: u64,
        samples: ChunksExact<'_, i32>,
    ) {
        for codes in samples {
            for count in 0..clocks {
                let inputs = self.inputs(inputs, count == 0, codes);
                let outputs = block.clock(&mut self.block, inputs);
                self.collect(outputs);
            }
        }
    }

    /// The inputs of a clock: the code is that of the channel that was asked for.
    #[inline(always)]
    fn inputs(
        &self,
        inputs: &Inputs<Signal<i64>>,
        strobe: bool,
        codes: &[i32],
    ) -> Inputs<Signal<i64>> {
        let format = inputs.core.code.format;
        let code = Signal { value: i64::from(codes[self.channel]), format };
        Inputs { core: core::Inputs { strobe: bit(strobe), code, ..inputs.core }, ..*inputs }
    }

    #[inline(always)]
    fn collect(&mut self, outputs: Outputs<Signal<i64>>) {
        self.clocks += 1;
        self.channel = outputs.core.channel.value as usize;
        let frame = outputs.core.frames;
        self.gathered.accept_word(frame.valid.value, frame.index.value, frame.frame.value);
        if frame.done.value != 0 {
            self.frame = Some(self.gathered.frame(frame));
        }
        if outputs.drive.drive_valid.value != 0 {
            self.drive = Some(given(outputs));
        }
    }
}

/// The drive word that is given.
fn given(outputs: Outputs<Signal<i64>>) -> Drive {
    let DrivePort { drive_pad, drive, drive_low, drive_high, .. } = outputs.drive;
    Drive {
        pad: drive_pad.value as usize,
        fraction: drive.format.real(drive.value),
        low: drive_low.value != 0,
        high: drive_high.value != 0,
        faults: faults(outputs.faults),
    }
}

impl Probe for ClockLoop {
    fn variables(&self) -> Vec<Variable> {
        variables(&self.block, "force_loop")
    }

    fn sample(&self, codes: &mut Vec<i64>) {
        sample(&self.block, &self.state.block, codes);
    }
}
