// SPDX-License-Identifier: MIT OR Apache-2.0
//! `senses = "each"` of `[halves]`: the multiplexer connects the parts of a split pad one by one,
//! each in a slot of its own.
//!
//! | `strips` | slots of a pad, in their order |
//! | --- | --- |
//! | 2 | left half, right half |
//! | 4 | left outer strip, right outer strip, the inner two together |
//! | none, with `quadrants` | top left, bottom left, bottom right, top right |
//!
//! What is measured in a slot is the part: its capacitance, its place and its haptic voltage. The
//! force stays the pad's. With `senses = "together"`, as where it is absent, a pad has one slot, in
//! which all its electrodes are connected.

use super::effect::{Effect, PadEffect};
use super::pad::Pad;
use super::sensor::HAPTIC_LEAKAGE_OF_OTHERS;
use super::sheet::ideal::ideal_split;
use super::spec::Spec;
use super::split_electrode::{SENSES, Strip, read_strips};
use crate::device::Device;
use crate::drive::Electrode;
use crate::error::SceneError;
use crate::format::Table;

/// Where the part of each slot of a pad lies, mm right of the pad's centre and above it: one, 0, of a pad
/// that is served as a whole.
pub(crate) fn centres_mm(root: &Table, device: &Device) -> Result<Vec<[f64; 2]>, SceneError> {
    match parts(root, device)? {
        None => Ok(vec![[0.0; 2]]),
        Some(parts) => Ok(parts.iter().map(|part| part.centre_mm).collect()),
    }
}

/// The parts that have slots of their own.
fn parts(root: &Table, device: &Device) -> Result<Option<Vec<Part>>, SceneError> {
    let Some(table) = root.table("halves")? else { return Ok(None) };
    if table.get(&SENSES)? != "each" {
        return Ok(None);
    }
    let sensor = root.table("sensor")?;
    let others = sensor.is_some_and(|sensor| sensor.has(&HAPTIC_LEAKAGE_OF_OTHERS));
    let of_discs = [
        ("[coupling]", root.node("coupling").is_some()),
        ("sensor.haptic_leakage_of_others", others),
    ];
    if let Some((name, _)) = of_discs.iter().find(|(_, is_on)| *is_on) {
        let expected = format!("expected \"together\" with {name}, which takes a pad for a disc");
        return Err(table.error("senses", expected));
    }
    Ok(Some(parts_of(&read_strips(table, 0.0, device)?)))
}

pub(super) fn read(root: &Table, device: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(parts) = parts(root, device)? else { return Ok(None) };
    let device = device.clone();
    Ok(Spec::new("halves.senses", "each", move |_| {
        Effect::Pad(Box::new(Parts { parts: parts.clone(), device: device.clone() }))
    }))
}

/// One part: its electrodes, and what holds for them.
#[derive(Clone, Debug)]
struct Part {
    electrodes: Vec<usize>,
    /// Where its centre lies, mm right of the pad's and above it.
    centre_mm: [f64; 2],
    electrode: Electrode,
}

fn parts_of(strips: &[Strip]) -> Vec<Part> {
    let last = strips.len() - 1;
    let side = |n: usize| Part {
        electrodes: vec![n],
        centre_mm: strips[n].centre_mm,
        electrode: strips[n].electrode,
    };
    if strips[0].centre_mm[1] != 0.0 {
        return (0..strips.len()).map(side).collect();
    }
    let inner = (1..last).collect::<Vec<_>>();
    let brake = Part { electrodes: inner, centre_mm: [0.0; 2], electrode: Electrode::WHOLE };
    [side(0), side(last)].into_iter().chain((last > 1).then_some(brake)).collect()
}

struct Parts {
    parts: Vec<Part>,
    device: Device,
}

impl PadEffect for Parts {
    fn act(&mut self, pad: &mut Pad) {
        let Some(part) = pad.part.and_then(|part| self.parts.get(part)) else { return };
        pad.force_n = Some(pad.haptic_force_n(&self.device));
        pad.capacitance_f = part.electrodes.iter().map(|n| pad.electrodes_f[*n]).sum();
        if pad.source_v_rms > 0.0 {
            pad.haptic_v_rms *= part.electrode.source_v_rms(pad.source_v_rms) / pad.source_v_rms;
        }
        pad.x_mm += part.centre_mm[0];
        pad.y_mm += part.centre_mm[1];
        pad.split = ideal_split(pad.x_mm, pad.y_mm, &self.device);
    }
}
