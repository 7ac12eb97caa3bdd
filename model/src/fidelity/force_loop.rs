// SPDX-License-Identifier: MIT OR Apache-2.0
//! A core with its force controller, slot by slot: `fixed` and, of every clock, `clock`.
//!
//! Either takes the codes of a slot's window and gives its drive word, and the frame that is finished. That frame is
//! the slot's or, with `clock`, where slots are short, the one of the slot before. What the ADC sees while a slot is
//! blanked touches neither, so that `clock` receives zeros there. A plant can then wait for the drive word before it
//! makes the window that depends on it.

use super::fixed::FixedSimulation;
use super::{Gathered, assert_pad, signals};
use crate::blocks::controller::{self, Faults as FaultPort};
use crate::blocks::core;
use crate::blocks::drives::{self, DrivePort, Drives, TargetPort};
use crate::blocks::force_loop::{ForceLoop, Inputs, Outputs};
use crate::blocks::position::TablePort;
use crate::blocks::split_pad::WallPort;
use hapticore_contract::calibration::Calibration;
use hapticore_contract::control::{Drive, Faults, Surface, Tuning, Walled, Walls};
use hapticore_contract::frame::{Field, Flags, Frame};
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::{Block, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::probe::{Probe, Variable, sample, sample_ports, variables};
use hapticore_hdl::signal::{Signal, bit};

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

/// The inputs of drives while nothing happens: tuned, walls as told.
fn idle(drives: &Drives, tuning: &Tuning) -> drives::Inputs<i64> {
    let formats = drives.inputs();
    let mut idle =
        drives::Inputs { tuning: tuning_codes(&formats.tuning, tuning), ..drives::Inputs::of(0) };
    if let Some(walls) = &tuning.walls {
        idle.wall = wall_codes(&formats.wall, walls);
    }
    idle
}

/// The words of walls as codes, nothing written.
pub fn wall_codes(formats: &WallPort<Format>, walls: &Walls) -> WallPort<i64> {
    WallPort {
        wall_right: walls.right.into(),
        wall_stiffness: formats.wall_stiffness.code_saturating(walls.stiffness_n_per_mm),
        wall_most: formats.wall_most.code_saturating(walls.most_n),
        wall_factory: formats.wall_factory.code_saturating(walls.factory),
        ..WallPort::of(0)
    }
}

/// A pad's target as its port takes it.
fn target_write(formats: &TargetPort<Format>, pad: usize, newtons: f64) -> TargetPort<i64> {
    TargetPort {
        target_write: 1,
        target_pad: pad as i64,
        target_word: formats.target_word.code_saturating(newtons),
        ..TargetPort::of(0)
    }
}

/// The surface of a pad's wall as its port takes it.
fn surface_write(
    formats: &WallPort<Format>,
    idle: WallPort<i64>,
    pad: usize,
    surface: Surface,
) -> WallPort<i64> {
    WallPort {
        wall_write: 1,
        wall_pad: pad as i64,
        wall_surface: formats.wall_surface.code_saturating(surface.mm),
        wall_right: surface.right.into(),
        ..idle
    }
}

/// Fidelity `fixed`: the clocks of drives follow those of the estimator, both without those of the
/// samples.
pub struct FixedLoop {
    core: FixedSimulation<i64>,
    drives: Drives,
    state: State<Drives, i64>,
    idle: drives::Inputs<i64>,
}

impl FixedLoop {
    /// A core and its drives of a profile, calibrated and tuned, all targets zero.
    ///
    /// # Errors
    /// A profile without a controller, or one that cannot be.
    pub fn new(
        profile: &Profile,
        calibration: &Calibration,
        tuning: &Tuning,
    ) -> Result<Self, ProfileError> {
        let mut drives = ForceLoop::try_new(profile)?.drives;
        drives.hurry();
        let (state, idle) = (drives.reset(), idle(&drives, tuning));
        let core = FixedSimulation::new(profile, calibration);
        let mut of = FixedLoop { core, drives, state, idle };
        of.tick();
        for write in curve_writes(of.drives.inputs().tuning, tuning) {
            of.clock(drives::Inputs { tuning: write, ..of.idle });
        }
        Ok(of)
    }

    /// A millisecond has passed, by which a silent host is missed; the first is over when a loop begins.
    pub fn tick(&mut self) {
        self.clock(drives::Inputs { tick: 1, ..self.idle });
    }

    /// Sets a pad's target force, N.
    ///
    /// # Panics
    /// Where there is no such pad; the loop stays as it was.
    pub fn set_target(&mut self, pad: usize, newtons: f64) {
        assert_pad(pad, self.core.pads());
        let target = target_write(&self.drives.inputs().target, pad, newtons);
        self.clock(drives::Inputs { target, ..self.idle });
    }

    /// Sets where the wall that is known by this number begins.
    ///
    /// # Panics
    /// As [`FixedLoop::set_target`].
    pub fn set_surface(&mut self, pad: usize, surface: Surface) {
        assert_pad(pad, self.core.pads());
        let wall = surface_write(&self.drives.inputs().wall, self.idle.wall, pad, surface);
        self.clock(drives::Inputs { wall, ..self.idle });
    }

    /// The frame of a slot, of what `frame` lets the core find, and its drive word; none where the
    /// slot is not the last of a split pad.
    pub fn slot(
        &mut self,
        frame: impl FnOnce(&mut FixedSimulation<i64>) -> Frame,
    ) -> (Frame, Option<Drive>) {
        let frame = frame(&mut self.core);
        let drive = self.drive();
        self.place(&frame);
        (frame, drive)
    }

    /// The drive word of the last estimate. Not inlined, so that it is compiled here and not in each
    /// crate that calls [`FixedLoop::slot`].
    #[inline(never)]
    fn drive(&mut self) -> Option<Drive> {
        let prompt = self.core.prompt().expect("a core with a controller gives an estimate");
        let mut inputs = signals::<drives::Inputs, i64>(self.idle, self.drives.inputs());
        inputs.estimate = prompt;
        let mut drive = None;
        for _ in 0..=self.drives.latency() {
            let outputs = self.drives.clock_apart(&mut self.state, &inputs);
            inputs.estimate.prompt = bit(false);
            if outputs.drive.drive_valid.value != 0 {
                drive = Some(given(outputs.drive, outputs.faults));
            } else if drive.is_some() {
                break; // Whether the drive is zero has been written, too.
            }
        }
        drive
    }

    /// The place of a valid frame.
    fn place(&mut self, frame: &Frame) {
        let Flags { invalid, lifted, .. } = frame.flags;
        let is_last = self.drives.split_pad.is_some() && self.drives.is_last(frame.pad);
        if invalid || lifted || !is_last {
            return;
        }
        let of = |field: Field| frame.codes[field as usize];
        let number = frame.pad as i64;
        for (placed_pad, place) in [(number, of(Field::X)), (number - 1, of(Field::Y))] {
            self.clock(drives::Inputs { placed: 1, placed_pad, place, ..self.idle });
        }
    }

    fn clock(&mut self, inputs: drives::Inputs<i64>) {
        let inputs = signals::<drives::Inputs, i64>(inputs, self.drives.inputs());
        self.drives.clock_apart(&mut self.state, &inputs);
    }
}

/// The drive word on a port.
fn given(port: DrivePort<Signal<i64>>, faults_port: FaultPort<Signal<i64>>) -> Drive {
    let DrivePort { drive_pad, drive, drive_low, drive_high, drive_target, drive_free, .. } = port;
    let walled = Walled {
        target_n: drive_target.format.real(drive_target.value),
        free: drive_free.value != 0,
    };
    Drive {
        pad: drive_pad.value as usize,
        fraction: drive.format.real(drive.value),
        low: drive_low.value != 0,
        high: drive_high.value != 0,
        faults: faults(faults_port),
        walled: (!drive_target.format.is_none()).then_some(walled),
    }
}

/// Fidelity `clock`: every clock, as the board runs it.
pub struct ClockLoop {
    block: ForceLoop,
    inputs: Inputs<Signal<i64>>,
    clocks_per_sample: u64,
    /// What the ADC sees of a slot's blanking.
    silence: Vec<i32>,
    channels: usize,
    pads: usize,
    /// The walls, nothing written.
    wall: WallPort<i64>,
    state: ClockState,
}

/// What changes from clock to clock: apart from what does not, so that the compiler need not look
/// at formats again after every word that is written.
struct ClockState {
    block: State<ForceLoop, i64>,
    /// The channel that was asked for last.
    channel: usize,
    /// The codes at the loop's ports in the last clock that was done by itself.
    ports: (Inputs<i64>, Outputs<i64>),
    results: Results,
}

/// What a loop has given.
#[derive(Default)]
struct Results {
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
        let drives = idle(&block.drives, tuning);
        let codes = Inputs {
            core: block.core.idle_inputs(calibration),
            tuning: drives.tuning,
            wall: drives.wall,
            ..Inputs::of(0)
        };
        let channels = profile.channels();
        let mut of = ClockLoop {
            state: ClockState {
                block: block.reset(),
                channel: 0,
                ports: (Inputs::of(0), Outputs::of(0)),
                results: Results::default(),
            },
            inputs: signals::<Inputs, i64>(codes, formats),
            clocks_per_sample: profile.clocks_per_sample,
            silence: vec![0; profile.slot.blanking() as usize * channels],
            channels,
            pads: profile.pads as usize,
            wall: drives.wall,
            block,
        };
        of.calibrate(profile, calibration, tuning);
        of.tick();
        of.blank();
        Ok(of)
    }

    fn calibrate(&mut self, profile: &Profile, calibration: &Calibration, tuning: &Tuning) {
        let formats = self.block.inputs();
        let word = self.block.core.estimator().table().format;
        for (address, real) in (0..).zip(calibration.words(profile)) {
            let codes = TablePort { write: 1, address, word: word.code_saturating(real) };
            let table = formats.core.calibration.table;
            let mut inputs = self.inputs;
            inputs.core.calibration.table = signals::<TablePort, i64>(codes, table);
            self.block.step(&mut self.state.block, inputs);
        }
        for write in curve_writes(formats.tuning, tuning) {
            let tuning = signals::<controller::Tuning, i64>(write, formats.tuning);
            self.block.step(&mut self.state.block, Inputs { tuning, ..self.inputs });
        }
    }

    /// As [`FixedLoop::tick`].
    pub fn tick(&mut self) {
        self.step(Inputs { tick: bit(true), ..self.inputs });
    }

    /// Sets a pad's target force, N.
    ///
    /// # Panics
    /// As [`FixedLoop::set_target`].
    pub fn set_target(&mut self, pad: usize, newtons: f64) {
        assert_pad(pad, self.pads);
        let formats = self.block.inputs().target;
        let target = signals::<TargetPort, i64>(target_write(&formats, pad, newtons), formats);
        self.step(Inputs { target, ..self.inputs });
    }

    /// Sets where the wall that is known by this number begins.
    ///
    /// # Panics
    /// As [`FixedLoop::set_target`].
    pub fn set_surface(&mut self, pad: usize, surface: Surface) {
        assert_pad(pad, self.pads);
        let formats = self.block.inputs().wall;
        let wall = surface_write(&formats, self.wall, pad, surface);
        let wall = signals::<WallPort, i64>(wall, formats);
        self.step(Inputs { wall, ..self.inputs });
    }

    fn step(&mut self, inputs: Inputs<Signal<i64>>) {
        let outputs = self.block.step(&mut self.state.block, inputs);
        let codes = |port: Signal<i64>| port.value;
        self.state.ports = (Inputs::map(inputs, codes), Outputs::map(outputs, codes));
        let Outputs { core, drive, extremes, faults } = outputs;
        self.state.channel = core.channel.value as usize;
        self.state.results.collect(Some(&core), Some(drives::Outputs { drive, extremes, faults }));
    }

    /// The drive word of a slot, as in [`FixedLoop::slot`], and the frame that is finished before
    /// the next window begins, if one is: `codes` are those of its window.
    pub fn slot(&mut self, codes: &[i32]) -> (Option<Frame>, Option<Drive>) {
        self.samples(codes);
        self.blank();
        self.results()
    }

    /// As [`ClockLoop::slot`], with a look at the simulation after each clock.
    pub fn slot_with(
        &mut self,
        codes: &[i32],
        mut look: impl FnMut(&Self),
    ) -> (Option<Frame>, Option<Drive>) {
        let silence = self.silence.clone();
        for codes in codes.chunks_exact(self.channels).chain(silence.chunks_exact(self.channels)) {
            for count in 0..self.clocks_per_sample {
                self.clock(count == 0, codes);
                look(self);
            }
        }
        self.results()
    }

    /// Whether the slot that is under way has given its drive word.
    pub fn has_drive(&self) -> bool {
        self.state.results.drive.is_some()
    }

    /// Whether a frame has been finished in the slot that is under way.
    pub fn has_frame(&self) -> bool {
        self.state.results.frame.is_some()
    }

    /// Runs on without samples until the last slot's frame is there, where it is still to come.
    pub fn finish(&mut self) -> Option<Frame> {
        let codes = vec![0; self.channels];
        let mut left = self.block.core.latency();
        while self.state.results.frame.is_none() && left > 0 {
            self.clock(false, &codes);
            left -= 1;
        }
        self.state.results.frame.take()
    }

    fn clock(&mut self, strobe: bool, codes: &[i32]) {
        self.step(self.state.inputs(&self.inputs, strobe, codes));
    }

    fn results(&mut self) -> (Option<Frame>, Option<Drive>) {
        (self.state.results.frame.take(), self.state.results.drive.take())
    }

    /// Clocks since the first sample.
    pub fn clocks(&self) -> u64 {
        self.state.results.clocks
    }

    fn blank(&mut self) {
        let silence = std::mem::take(&mut self.silence);
        self.samples(&silence);
        self.silence = silence;
    }

    fn samples(&mut self, codes: &[i32]) {
        self.state.samples(&self.block, &self.inputs, codes);
    }
}

impl ClockState {
    /// Not inlined: what it borrows is then known to be apart.
    #[inline(never)]
    fn samples(&mut self, block: &ForceLoop, inputs: &Inputs<Signal<i64>>, codes: &[i32]) {
        let ClockState { block: state, channel, results, .. } = self;
        block.samples(state, inputs, codes, channel, &mut |core, drives| {
            results.collect(core, drives)
        });
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
}

impl Results {
    #[inline(always)]
    fn collect(&mut self, core: Option<&core::Out<i64>>, drives: Option<drives::Out<i64>>) {
        self.clocks += 1;
        if let Some(frame) = core.map(|core| core.frames) {
            self.gathered.accept_word(frame.valid.value, frame.index.value, frame.frame.value);
            if frame.done.value != 0 {
                self.frame = Some(self.gathered.frame(frame));
            }
        }
        if let Some(drives) = drives.filter(|drives| drives.drive.drive_valid.value != 0) {
            self.drive = Some(given(drives.drive, drives.faults));
        }
    }
}

impl Probe for ClockLoop {
    fn variables(&self) -> Vec<Variable> {
        variables(&self.block, "force_loop")
    }

    fn sample(&self, codes: &mut Vec<i64>) {
        sample(&self.block, &self.state.block, codes);
    }

    fn sample_ports(&self, codes: &mut Vec<i64>) {
        sample_ports(&self.block, &self.state.ports, codes);
    }
}
