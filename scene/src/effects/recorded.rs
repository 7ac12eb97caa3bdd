// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the mechanics of a case do to its pads, recorded in one run and played back in another that
//! differs only in what comes after. A gap that moves is integrated once, however many levels of
//! the sheet are compared over it.

use std::sync::{Arc, Mutex};

use super::effect::{Effect, PadEffect, PadsEffect};
use super::pad::{Charge, Pad};
use super::sheet::ideal::ideal_split;
use super::spec::Spec;
use crate::device::Device;

/// What a mechanical effect may set of a pad.
#[derive(Clone, Copy, Debug)]
struct State {
    time_s: f64,
    at_mm: [f64; 2],
    haptic_v_rms: f64,
    capacitance_f: f64,
    attraction_n: f64,
    uneven: bool,
    charge: Option<Charge>,
    force_n: Option<f64>,
    direction: f64,
    friction_n: f64,
    over_edge: bool,
}

/// The states of each pad, in the order of time.
#[derive(Clone, Debug, Default)]
pub(crate) struct Recording(Vec<Vec<State>>);

/// A recording that a plant writes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tape(Arc<Mutex<Recording>>);

impl Tape {
    /// The effects that record, behind the mechanics; the other pads of a slot too, where `all`.
    pub fn recorders(&self, all: bool) -> Vec<Spec> {
        let tape = self.clone();
        let recorder =
            Spec::new("recorder", "", move |_| Effect::Pad(Box::new(Recorder(tape.clone()))));
        let witness = Spec::new("witness", "", |_| Effect::Pads(Box::new(Witness)));
        recorder.into_iter().chain(witness.filter(|_| all)).collect()
    }

    /// What has been recorded; the tape is empty afterwards.
    pub fn take(&self) -> Recording {
        std::mem::take(&mut self.0.lock().expect("no plant panics while it records"))
    }
}

struct Recorder(Tape);

impl PadEffect for Recorder {
    fn act(&mut self, pad: &mut Pad) {
        let mut recording = self.0.0.lock().expect("no plant panics while it records");
        if recording.0.len() <= pad.index {
            recording.0.resize_with(pad.index + 1, Vec::new);
        }
        recording.0[pad.index].push(State {
            time_s: pad.time_s,
            at_mm: [pad.x_mm, pad.y_mm],
            haptic_v_rms: pad.haptic_v_rms,
            capacitance_f: pad.capacitance_f,
            attraction_n: pad.attraction_n,
            uneven: pad.uneven,
            charge: pad.charge,
            force_n: pad.force_n,
            direction: pad.direction,
            friction_n: pad.friction_n,
            over_edge: pad.over_edge,
        });
    }
}

/// Has a plant look at every pad in every slot, as one with coupled pads does.
struct Witness;

impl PadsEffect for Witness {
    fn act(&mut self, _: &mut Pad, _: &[Pad]) {}
}

impl Recording {
    /// The effect that plays it back, in place of the mechanics.
    pub fn player(self: &Arc<Self>) -> Option<Spec> {
        let recording = self.clone();
        Spec::new("recorded", "", move |setting| {
            let device = setting.device.clone();
            Effect::Pad(Box::new(Player { recording: recording.clone(), device }))
        })
    }

    /// The last state of a pad up to a time.
    fn at(&self, pad: usize, time_s: f64) -> Option<&State> {
        let states = self.0.get(pad)?;
        let until = states.partition_point(|state| state.time_s <= time_s);
        states.get(until.saturating_sub(1))
    }
}

struct Player {
    recording: Arc<Recording>,
    device: Device,
}

impl PadEffect for Player {
    fn act(&mut self, pad: &mut Pad) {
        let Some(state) = self.recording.at(pad.index, pad.time_s) else { return };
        [pad.x_mm, pad.y_mm] = state.at_mm;
        pad.split = ideal_split(pad.x_mm, pad.y_mm, &self.device);
        pad.haptic_v_rms = state.haptic_v_rms;
        pad.capacitance_f = state.capacitance_f;
        pad.attraction_n = state.attraction_n;
        pad.uneven = state.uneven;
        pad.charge = state.charge;
        pad.force_n = state.force_n;
        pad.direction = state.direction;
        pad.friction_n = state.friction_n;
        pad.over_edge = state.over_edge;
    }

    /// A calibration is of a resting pad where it is asked for.
    fn settle(&mut self, _: &mut Pad) {}
}
