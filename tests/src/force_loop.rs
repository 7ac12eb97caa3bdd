// SPDX-License-Identifier: MIT OR Apache-2.0
//! The inputs of a force loop, clock by clock, from a plant that its own drive words move. In a
//! trace of it, Verilog that outputs the model's drive words has moved the plant as the model did.

use std::collections::VecDeque;
use std::sync::Arc;

use hapticore_contract::profile::Profile;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::verilog::Design;
use hapticore_model::blocks::force_loop::{ForceLoop, Inputs, Outputs};
use hapticore_model::blocks::position::TablePort;
use hapticore_model::blocks::split_pad::WallPort;
use hapticore_model::fidelity::force_loop::{curve_writes, tuning_codes, wall_codes};
use hapticore_rtl::netlist;
use hapticore_run::case::Case;
use hapticore_run::control::plant::surface_of;
use hapticore_run::engine::Signals;
use hapticore_run::inputs;
use hapticore_run::maker::Maker;

use crate::lockstep::Trace;

/// The plant of a scene's case around a force loop.
pub struct Closed {
    block: ForceLoop,
    maker: Maker,
    profile: Profile,
    constants: Inputs<i64>,
    writes: VecDeque<Inputs<i64>>,
    codes: Vec<i32>,
    slots: usize,
    /// Slots, samples and clocks since the first strobe.
    slot: usize,
    sample: u64,
    count: u64,
    full_scale_v: f64,
    sample_rate_hz: f64,
}

impl Closed {
    /// `slots` slots of a bundled scene's case by a profile, with keys and values as in `--set`.
    ///
    /// # Panics
    /// Where there is no such scene or case, or it has no controller.
    pub fn new(
        profile: &Profile,
        (scene, case): (&str, usize),
        set: &[(String, String)],
        slots: usize,
    ) -> Self {
        let scene = Arc::new(inputs::scene(scene, set).expect("bundled"));
        let profile = inputs::windowed(profile.clone(), &scene).expect("a profile");
        let case = Case::new(&scene, case, &profile, &[]).expect("a case");
        let calibration = case.calibration().expect("a calibration").clone();
        let plant = case.plant().expect("a plant");
        let tuning = case.tuning(&plant).expect("gains that fit").expect("a controller");
        let block = ForceLoop::try_new(&case.profile).expect("a force loop");
        let formats = block.inputs();
        let constants = Inputs {
            core: block.core.idle_inputs(&calibration),
            tuning: tuning_codes(&formats.tuning, &tuning),
            wall: tuning
                .walls
                .as_ref()
                .map_or(WallPort::of(0), |walls| wall_codes(&formats.wall, walls)),
            ..Inputs::of(0)
        };
        let mut writes = VecDeque::new();
        let word = formats.core.calibration.table.word;
        for (address, real) in (0..).zip(calibration.words(&case.profile)) {
            let table = TablePort { write: 1, address, word: word.code_saturating(real) };
            let core = constants.core.with_table(table);
            writes.push_back(Inputs { core, ..constants });
        }
        for tuning in curve_writes(formats.tuning, &tuning) {
            writes.push_back(Inputs { tuning, ..constants });
        }
        writes.extend(surfaces(&case, constants, formats.wall.wall_surface));
        Closed {
            maker: Maker::new(plant, &case.profile, true, false),
            codes: vec![0; case.profile.channels()],
            profile: (*case.profile).clone(),
            constants,
            writes,
            slots,
            slot: 0,
            sample: 0,
            count: 0,
            full_scale_v: scene.cases[case.index]
                .control
                .as_ref()
                .expect("a controller")
                .full_scale_v,
            sample_rate_hz: case.device.device.sample_rate_hz,
            block,
        }
    }

    /// A pad that is pushed into a wall and drawn out of it again, within so few slots that a trace
    /// of them can be kept.
    ///
    /// # Panics
    /// As [`Closed::new`].
    pub fn at_a_wall(profile: &Profile) -> Self {
        Closed::drawn(
            profile,
            "fig15",
            "x_mm = [[0, 0.3], [0.006, -0.8], [0.012, -0.8], [0.02, 0.5]]",
        )
    }

    /// The same of a pad split in four and the corner of two walls.
    ///
    /// # Panics
    /// As [`Closed::new`].
    pub fn in_a_corner(profile: &Profile) -> Self {
        let along_x = "x_mm = [[0, 0.3], [0.005, -0.6], [0.015, -0.6], [0.019, 0.5]]";
        let along_y = "y_mm = [[0, 0.5], [0.005, -0.3], [0.014, -0.9], [0.019, 0.5]]";
        Closed::drawn(profile, "wall-2d", &format!("{along_x}, {along_y}"))
    }

    /// A scene's pad whose hand goes there and back.
    fn drawn(profile: &Profile, scene: &str, there_and_back: &str) -> Self {
        let there_and_back = format!("{{ timeline = {{ {there_and_back} }} }}");
        let set = [
            ("pad.0.position_mm", there_and_back.as_str()),
            ("hand.stiffness_n_per_m", "20000"),
            ("hand.damping_n_s_per_m", "30"),
            ("hand.mass_kg", "0.01"),
            ("halves.push_height_mm", "0.5"),
            ("settle_samples", "390"),
            ("window_samples", "600"),
        ];
        let set = set.map(|(key, value)| (key.to_string(), value.to_string()));
        Closed::new(profile, (scene, 0), &set, 24)
    }

    /// What is printed of the loop, and what its model did until the end.
    pub fn record(mut self) -> (Design, Trace) {
        let block = self.block.clone();
        let design = Design::print(&netlist::of_force_loop(&block), "a test");
        let trace = Trace::record(&block, design.ports.clone(), |outputs| self.next(outputs));
        (design, trace)
    }

    /// The inputs of the next clock, after these outputs; none at the end.
    fn next(&mut self, outputs: &[i64]) -> Option<Vec<i64>> {
        if let Some(write) = self.writes.pop_front() {
            return Some(flat(write, self.block.inputs()));
        }
        self.drive(outputs);
        let mut inputs = self.constants;
        if self.count == 0 {
            inputs.core.strobe = 1;
            self.begin_sample(&mut inputs)?;
        }
        let channels = self.profile.channels();
        let at = (self.sample.saturating_sub(self.profile.slot.blanking())) as usize * channels;
        let channel = port(outputs, "channel") as usize;
        inputs.core.code = match self.sample < self.profile.slot.blanking() {
            true => 0,
            false => self.codes[at + channel].into(),
        };
        self.advance();
        Some(flat(inputs, self.block.inputs()))
    }

    fn advance(&mut self) {
        self.count = (self.count + 1) % self.profile.clocks_per_sample;
        if self.count == 0 {
            self.sample = (self.sample + 1) % self.profile.slot.samples();
            self.slot += usize::from(self.sample == 0);
        }
    }

    /// A drive word moves the plant from now on.
    fn drive(&mut self, outputs: &[i64]) {
        if port(outputs, "drive_valid") == 0 {
            return;
        }
        let format: Format = self.block.outputs().drive.drive;
        let volt = self.full_scale_v * format.real(port(outputs, "drive"));
        let pad = port(outputs, "drive_pad") as usize;
        let time_s = self.time_s();
        self.maker.plant().set_drive(pad, time_s, volt).expect("in the order of time");
    }

    fn time_s(&self) -> f64 {
        let samples = self.slot as u64 * self.profile.slot.samples() + self.sample;
        let part = self.count as f64 / self.profile.clocks_per_sample as f64;
        (samples as f64 + part) / self.sample_rate_hz
    }

    /// A slot's target is written as it begins, with a tick; its window is made once its blanking is over, and
    /// so the drives of the slots before are known.
    fn begin_sample(&mut self, inputs: &mut Inputs<i64>) -> Option<()> {
        let pads = self.maker.plant().served();
        if self.sample == 0 {
            if self.slot == self.slots {
                return None;
            }
            let pad = self.slot % pads;
            let end = (self.slot + 1) as f64 * self.profile.slot.samples() as f64;
            let newtons = self.maker.plant().target_n(pad, end / self.sample_rate_hz);
            let word = self.block.inputs().target.target_word;
            (inputs.tick, inputs.target.target_write) = (1, 1);
            inputs.target.target_pad = pad as i64;
            inputs.target.target_word = word.code_saturating(newtons);
        }
        if self.sample == self.profile.slot.blanking() {
            let Signals::Samples { codes, .. } = self.maker.sample(self.slot).0 else {
                unreachable!("it was asked for samples")
            };
            self.codes = codes;
        }
        Some(())
    }
}

/// The walls' surfaces, as they are when the case begins.
fn surfaces(case: &Case, constants: Inputs<i64>, format: Format) -> Vec<Inputs<i64>> {
    let plan = case.scene.cases[case.index].control.as_ref();
    let Some(wall) = plan.and_then(|plan| plan.wall.as_ref()) else { return Vec::new() };
    let plant = case.plant().expect("a plant");
    let write = |pad: usize| {
        let mut inputs = constants;
        let surface = surface_of(wall, plant.parts_mm(), pad, 0.0);
        (inputs.wall.wall_write, inputs.wall.wall_pad) = (1, pad as i64);
        inputs.wall.wall_surface = format.code_saturating(surface.mm);
        inputs.wall.wall_right = surface.right.into();
        inputs
    };
    (0..plant.served()).map(write).collect()
}

/// The codes of the ports that are there.
fn flat(inputs: Inputs<i64>, formats: Inputs<Format>) -> Vec<i64> {
    let mut codes = Vec::with_capacity(Inputs::FIELDS.len());
    let mut push = |format: Format, code: i64| {
        if !format.is_none() {
            codes.push(code);
        }
    };
    let both = <Inputs as Bundle>::zip(formats, inputs);
    Inputs::each(both, |_, (format, code)| push(format, code));
    codes
}

fn port(outputs: &[i64], name: &str) -> i64 {
    let at = Outputs::FIELDS.iter().position(|field| field.name == name).expect("a port");
    outputs[at]
}
