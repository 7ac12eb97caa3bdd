// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[release]`: friction lets go of a pad later than the attraction does.
//!
//!   Ȧ = −(A − F_e)/τ while A > F_e,   else A = F_e                    (A is what friction feels of F_e)
//!
//! What falls in a step has the attraction of its end: a voltage that steps is followed exactly, a
//! gap that opens half a step late. Haptic force and friction are of A. The default is that of an
//! electroadhesive clutch at 300 V (Rauf and Follmer, 2025; docs/physics.md §7).

use super::effect::{Effect, PadEffect};
use super::pad::Pad;
use super::spec::{Setting, Spec};
use super::tick::Tick;
use crate::device::Device;
use crate::drive::PadDrive;
use crate::error::SceneError;
use crate::format::{Key, Limits, Table, keys};

keys! { KEYS:
    /// How slowly friction lets go.
    TIME_CONSTANT_MS: f64 = Key::number("time_constant_ms", Limits::within(1e-6, 1e6)).or(0.15);
    /// Time step.
    STEP_US: f64 = Key::number("step_us", Limits::within(1.0, 1000.0)).or(100.0);
}

pub(super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("release")? else { return Ok(None) };
    if root.table("friction")?.is_none() {
        return Err(table.error("", "expected [friction] too, which is what lets go late"));
    }
    let time_ms = table.get(&TIME_CONSTANT_MS)?;
    let step_s = 1e-6 * table.get(&STEP_US)?;
    let build = move |_: &Setting| {
        Effect::Pad(Box::new(Release { time_s: 1e-3 * time_ms, step_s, pads: Vec::new() }))
    };
    Ok(Spec::new("release", format!("{time_ms} ms"), build))
}

struct Release {
    /// τ, s.
    time_s: f64,
    step_s: f64,
    pads: Vec<Option<Held>>,
}

/// The attraction that friction feels at a time, N.
#[derive(Clone, Copy, Debug, Default)]
struct Held {
    tick: Tick,
    attraction_n: f64,
}

impl Release {
    /// What is kept of a pad: at the start of the case nothing.
    fn kept(&self, index: usize) -> Held {
        self.pads.get(index).copied().flatten().unwrap_or_default()
    }

    /// A step later, at whose end the attraction is this.
    fn after(&self, held_n: f64, attraction_n: f64, step_s: f64) -> f64 {
        let left = (held_n - attraction_n).max(0.0);
        attraction_n + left * (-step_s / self.time_s).exp()
    }
}

impl PadEffect for Release {
    /// A resting pad: friction has followed every fall of the attraction.
    fn act(&mut self, _: &mut Pad) {}

    fn due(&self, pad: &Pad, drive: &PadDrive) -> Option<Tick> {
        let from = self.kept(pad.index).tick;
        from.next(self.step_s, pad.time_s, |after_s| drive.next_event_s(after_s, self.step_s))
    }

    fn keep(&mut self, pad: &Pad, tick: Tick, _: &PadDrive) {
        if self.pads.len() <= pad.index {
            self.pads.resize(pad.index + 1, None);
        }
        let from = self.kept(pad.index);
        let step_s = tick.time_s - from.tick.time_s;
        let attraction_n = self.after(from.attraction_n, pad.attraction_n, step_s);
        self.pads[pad.index] = Some(Held { tick, attraction_n });
    }

    fn follow(&mut self, pad: &mut Pad, _: &PadDrive) {
        let from = self.kept(pad.index);
        let ahead_s = from.tick.ahead_s(self.step_s, pad.time_s).unwrap_or(0.0);
        pad.attraction_n = self.after(from.attraction_n, pad.attraction_n, ahead_s);
    }
}
