// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fidelity `clock`: every clock of the core, as the board runs it. Whole samples take a fast path that skips the
//! intermediate clocks (`blocks/core/samples.rs`).

use super::{Gathered, signals};
use crate::blocks::core::{Core, Inputs, Observer, Outputs};
use crate::blocks::position::TablePort;
use hapticore_contract::calibration::Calibration;
use hapticore_contract::frame::Frame;
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{self, Block};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::probe::{Probe, Variable, sample, sample_ports, variables};
use hapticore_hdl::signal::{Signal, bit};

/// A core at work, clock by clock. Its memory does not grow with time.
pub struct ClockSimulation {
    core: Core,
    inputs: Inputs<Signal<i64>>,
    clocks_per_sample: u64,
    channels: usize,
    state: State,
}

/// What changes from clock to clock: apart from what does not, so that the compiler need not look
/// at formats again after every word that is written.
struct State {
    core: block::State<Core, i64>,
    /// The channel that was asked for last.
    channel: usize,
    /// The codes at the core's ports in the last clock that was done by itself.
    ports: (Inputs<i64>, Outputs<i64>),
    results: Results,
}

/// What a core has given.
#[derive(Default)]
struct Results {
    gathered: Gathered,
    frame: Option<Frame>,
    clocks: u64,
}

impl ClockSimulation {
    /// A core of a profile, calibrated, just before its first sample.
    pub fn new(profile: &Profile, calibration: &Calibration) -> Self {
        let core = Core::new(profile);
        let formats = core.inputs();
        let state = calibrated(&core, profile, calibration);
        ClockSimulation {
            inputs: signals::<Inputs, i64>(core.idle_inputs(calibration), formats),
            core,
            clocks_per_sample: profile.clocks_per_sample,
            channels: profile.channels(),
            state: State {
                core: state,
                channel: 0,
                ports: (Inputs::of(0), Outputs::of(0)),
                results: Results::default(),
            },
        }
    }

    /// The clocks of samples that follow one another: of each the codes of every channel, in the
    /// order terminals, sensing voltage, haptic voltage. Of the frames that are finished meanwhile,
    /// the last is kept.
    ///
    /// # Panics
    /// Where `codes` has not one code per channel per sample.
    pub fn samples(&mut self, codes: &[i32]) {
        self.state.samples(&self.core, &self.inputs, codes);
    }

    /// As [`ClockSimulation::samples`] for one of them, with a look at the simulation after each
    /// clock.
    ///
    /// # Panics
    /// Where `codes` has not one code a channel.
    pub fn sample_with(&mut self, codes: &[i32], mut look: impl FnMut(&Self)) {
        assert_eq!(codes.len(), self.channels, "one code per channel");
        for count in 0..self.clocks_per_sample {
            self.state.clock(&self.core, &self.inputs, count == 0, codes);
            look(self);
        }
    }

    /// Whether a frame has been finished since the last call of [`ClockSimulation::take_frame`].
    pub fn has_frame(&self) -> bool {
        self.state.results.frame.is_some()
    }

    /// The frame that has been finished since the last call.
    pub fn take_frame(&mut self) -> Option<Frame> {
        self.state.results.frame.take()
    }

    /// Runs on without samples until the frame of the slot that has just ended is there.
    pub fn finish_slot(&mut self) -> Option<Frame> {
        let codes = vec![0; self.channels];
        let mut left = self.core.latency();
        while self.state.results.frame.is_none() && left > 0 {
            self.state.clock(&self.core, &self.inputs, false, &codes);
            left -= 1;
        }
        self.take_frame()
    }

    /// Clocks since the first sample.
    pub fn clocks(&self) -> u64 {
        self.state.results.clocks
    }
}

/// The state of a core with the calibration's tables written into it, through its port.
fn calibrated(
    core: &Core,
    profile: &Profile,
    calibration: &Calibration,
) -> block::State<Core, i64> {
    let (mut state, formats) = (core.reset(), core.inputs());
    let (constants, word) = (core.idle_inputs(calibration), core.estimator().table().format);
    for (address, real) in (0..).zip(calibration.words(profile)) {
        let codes = TablePort { write: 1, address, word: word.code_saturating(real) };
        core.step(&mut state, signals::<Inputs, i64>(constants.with_table(codes), formats));
    }
    state
}

impl State {
    /// Not inlined: what it borrows is then known to be apart.
    #[inline(never)]
    fn samples(&mut self, core: &Core, inputs: &Inputs<Signal<i64>>, codes: &[i32]) {
        let State { core: state, channel, results, .. } = self;
        core.samples(state, inputs, codes, channel, results);
    }

    fn clock(&mut self, core: &Core, inputs: &Inputs<Signal<i64>>, strobe: bool, codes: &[i32]) {
        let inputs = self.inputs_for_cycle(inputs, strobe, codes);
        let outputs = core.step(&mut self.core, inputs);
        self.channel = outputs.channel.value as usize;
        self.ports =
            (Inputs::map(inputs, |port| port.value), Outputs::map(outputs, |port| port.value));
        self.results.outputs(outputs);
    }

    /// The inputs of a clock: the code is that of the channel that was asked for.
    #[inline(always)]
    fn inputs_for_cycle(
        &self,
        inputs: &Inputs<Signal<i64>>,
        strobe: bool,
        codes: &[i32],
    ) -> Inputs<Signal<i64>> {
        let code = Signal { value: i64::from(codes[self.channel]), format: inputs.code.format };
        Inputs { strobe: bit(strobe), code, ..*inputs }
    }
}

impl Observer for Results {
    #[inline(always)]
    fn outputs(&mut self, outputs: Outputs<Signal<i64>>) {
        self.clocks += 1;
        let frame = outputs.frames;
        self.gathered.accept_word(frame.valid.value, frame.index.value, frame.frame.value);
        if frame.done.value != 0 {
            self.frame = Some(self.gathered.frame(frame));
        }
    }

    #[inline(always)]
    fn without_results(&mut self, _outputs: Outputs<Signal<i64>>) {
        self.clocks += 1;
    }
}

impl Probe for ClockSimulation {
    fn variables(&self) -> Vec<Variable> {
        variables(&self.core, "core")
    }

    fn sample(&self, codes: &mut Vec<i64>) {
        sample(&self.core, &self.state.core, codes);
    }

    fn sample_ports(&self, codes: &mut Vec<i64>) {
        sample_ports(&self.core, &self.state.ports, codes);
    }
}
