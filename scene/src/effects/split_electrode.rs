// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[halves]`: a pad of two electrodes side by side along x, which reads the direction of the push.
//!
//!   F₁,₂ = W/2·(1 ∓ e/x_c),   Δx = Σa_i·x_i/Σa_i − Σx_i/2,   x_i = ∓x_c,   a_i ∝ C_i      (CoP and eq. 10)
//!
//! A push off the centre, a pad's `eccentricity_mm`, presses one electrode more than the other; its
//! gap closes further, and eq. 10 reads a part of e. `mismatch_percent` is by how much the left
//! electrode is larger than the right one: it reads as a constant offset. The centres lie a quarter
//! of the pad's diameter off its own. Each electrode has gaps of its own, at the level of `[gap]`.
//! The truth's direction is Δx over half the sheet's width, as the ratios of eq. 10 are. Source:
//! docs/physics.md §4.

use super::effect::{Effect, PadEffect};
use super::gap;
use super::pad::Pad;
use super::spec::{Level, Setting, Spec};
use super::tick::Tick;
use crate::device::Device;
use crate::drive::PadDrive;
use crate::error::SceneError;
use crate::format::{Limits, Table};

pub(super) fn read(root: &Table, device: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("halves")? else { return Ok(None) };
    let Some(gap) = gap::read(root, device)? else {
        return Err(table.error("", "expected [gap] too, which the push closes on one side"));
    };
    let mismatch = 0.01 * table.number_or("mismatch_percent", Limits::within(-50.0, 50.0), 0.0)?;
    let build = move |setting: &Setting| {
        let electrodes = [gap.build(setting), gap.build(setting)];
        let (centre_mm, half_width_mm) =
            (setting.device.electrode_offset_mm(), 0.5 * setting.device.width_mm);
        Effect::Pad(Box::new(SplitElectrode {
            gaps: electrodes,
            mismatch,
            centre_mm,
            half_width_mm,
        }))
    };
    Spec::with_levels("halves", Some(table), vec![Level::new("gaps", 1e3, build)], "gaps")
}

struct SplitElectrode {
    /// The gap effect of the left and of the right electrode.
    gaps: [Effect; 2],
    mismatch: f64,
    centre_mm: f64,
    half_width_mm: f64,
}

impl SplitElectrode {
    /// Lets `act` see the gap of each electrode, the electrode, and by what share of itself its
    /// load is more for each millimetre of eccentricity.
    fn for_both(&mut self, pad: &mut Pad, act: impl Fn(&mut dyn PadEffect, &mut Pad, f64)) {
        let leans_per_mm = self.leans_per_mm();
        let mut electrodes = leans_per_mm.map(|lean_per_mm| {
            let load_g = pad.load_g * (1.0 + lean_per_mm * pad.eccentricity_mm);
            Pad { load_g, ..pad.clone() }
        });
        for ((gap, electrode), lean) in self.gaps.iter_mut().zip(&mut electrodes).zip(leans_per_mm)
        {
            if let Effect::Pad(gap) = gap {
                act(gap.as_mut(), electrode, lean);
            }
        }
        self.combine(pad, &electrodes);
    }

    fn leans_per_mm(&self) -> [f64; 2] {
        [-1.0, 1.0].map(|side| side / self.centre_mm)
    }

    fn combine(&self, pad: &mut Pad, [left, right]: &[Pad; 2]) {
        let areas = [0.5 + 0.25 * self.mismatch, 0.5 - 0.25 * self.mismatch];
        let [a, b] = [areas[0] * left.capacitance_f, areas[1] * right.capacitance_f];
        pad.capacitance_f = a + b;
        pad.haptic_v_rms = pad.haptic_v_at(a + b);
        pad.attraction_n = areas[0] * left.attraction_n + areas[1] * right.attraction_n;
        pad.direction = self.centre_mm * (b - a) / (a + b) / self.half_width_mm;
    }
}

impl PadEffect for SplitElectrode {
    fn act(&mut self, pad: &mut Pad) {
        self.for_both(pad, |gap, electrode, _| gap.act(electrode));
    }

    fn follow(&mut self, pad: &mut Pad, drive: &PadDrive) {
        self.for_both(pad, |gap, electrode, lean_per_mm| {
            gap.follow(electrode, &drive.leaning(lean_per_mm));
        });
    }

    /// Both gaps keep their states at the same times.
    fn due(&self, pad: &Pad, drive: &PadDrive) -> Option<Tick> {
        match &self.gaps[0] {
            Effect::Pad(gap) => gap.due(pad, drive),
            _ => None,
        }
    }

    fn keep(&mut self, pad: &Pad, tick: Tick, drive: &PadDrive) {
        let leans_per_mm = self.leans_per_mm();
        for (gap, lean_per_mm) in self.gaps.iter_mut().zip(leans_per_mm) {
            if let Effect::Pad(gap) = gap {
                gap.keep(pad, tick, &drive.leaning(lean_per_mm));
            }
        }
    }
}
