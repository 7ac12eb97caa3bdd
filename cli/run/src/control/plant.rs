// SPDX-License-Identifier: MIT OR Apache-2.0
//! The plant of a force loop: it makes a slot, then takes the drive that follows from it.
//!
//! ```text
//! slot n ─[core and controller: ForceLoop::latency after the slot's end]─ drive of its pad, until the pad's next
//! ```
//!
//! The target of slot n is what the scene asks for at its end, when its drive is made.

use anyhow::Result;
use hapticore_contract::control::{Drive, Surface};
use hapticore_contract::profile::{Profile, Wall};
use hapticore_host::SlotClock;
use hapticore_model::blocks::force_loop::ForceLoop;
use hapticore_scene::{EffectCost, Plant, Truth, WallPlan};

use crate::engine::Slot;
use crate::maker::Maker;
use crate::record::{Driven, WallPlace};

/// A sine on top of what a loop does, from a time on.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Excitation {
    /// The first pad's target, N.
    pub hold_n: f64,
    /// Amplitude on its target, N.
    pub target_n: f64,
    /// Amplitude on its drive, V rms.
    pub drive_v: f64,
    /// Frequency, Hz.
    pub hz: f64,
}

impl Excitation {
    /// The sine at the end of a slot.
    fn wave(&self, end_s: f64) -> f64 {
        (std::f64::consts::TAU * self.hz * end_s).sin()
    }
}

/// A plant whose pads are driven by what its slots lead to.
pub struct LoopPlant {
    maker: Maker,
    clock: SlotClock,
    /// The drive's full scale, V rms.
    full_scale_v: f64,
    /// From a slot's end to the drive that follows from it, s.
    latency_s: f64,
    wall: Option<WallPlan>,
    /// Where the wall that is known by each number has been set to begin.
    surfaces: Vec<Option<Surface>>,
    /// How each pad, or all parts of it, is driven.
    driven: Vec<Option<Driven>>,
    excitation: Option<Excitation>,
    inputs: LoopInputs,
}

/// What is set while a loop runs, in place of what the scene asks for.
#[derive(Debug, Clone, Default)]
pub(crate) struct LoopInputs {
    /// The force of each pad, N.
    pub targets_n: Vec<Option<f64>>,
    /// The walls along x and along y.
    pub walls: [WallInput; 2],
    /// The walls along x and y of each pad, where it has its own, in place of those.
    pub surfaces: Vec<Option<[Surface; 2]>>,
}

/// Where a wall begins.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) enum WallInput {
    /// Where the scene says.
    #[default]
    Scene,
    /// Here, mm from the sheet's centre.
    At(f64),
    /// Nowhere: there is no wall.
    Off,
}

/// A surface that no pad reaches, mm, where a wall is off: words saturate, at places off the sheet.
pub const FAR_MM: f64 = 1e4;

impl WallInput {
    /// The place of a surface that is in the scene at `mm`, and whose inside is right of it or not.
    fn surface_mm(self, mm: f64, right: bool) -> f64 {
        match self {
            WallInput::Scene => mm,
            WallInput::At(mm) => mm,
            WallInput::Off => FAR_MM * if right { 1.0 } else { -1.0 },
        }
    }
}

/// A slot, and what its drive should give.
pub struct LoopSlot {
    /// What the core receives.
    pub slot: Slot,
    /// What the plant knows.
    pub truth: Truth,
    /// The largest sample, as a fraction of full scale.
    pub peak: f64,
    /// The force that the pad shall have, N.
    pub target_n: f64,
    /// Where the wall that is known by the slot's number begins as the core measures it, where that
    /// is new.
    pub surface: Option<Surface>,
    /// The slot's end, s.
    pub end_s: f64,
}

/// Where the wall that is known by a number begins, as the core measures it: a pad's place is that of
/// its last part. Of quadrants the wall along y is known by the third.
pub fn surface_of(wall: &WallPlan, parts_mm: &[[f64; 2]], pad: usize, time_s: f64) -> Surface {
    surface_with(wall, parts_mm, (pad, time_s), ([WallInput::Scene; 2], None))
}

fn surface_with(
    wall: &WallPlan,
    parts_mm: &[[f64; 2]],
    (pad, time_s): (usize, f64),
    ([x, y], own): ([WallInput; 2], Option<[Surface; 2]>),
) -> Surface {
    let [x_mm, y_mm] = parts_mm.last().copied().unwrap_or_default();
    let along_y =
        wall.along_y.as_ref().filter(|_| pad % parts_mm.len() == Wall::PART_OF_Y as usize);
    match (along_y, own) {
        (Some(_), Some([_, own])) => Surface { mm: own.mm + y_mm, ..own },
        (None, Some([own, _])) => Surface { mm: own.mm + x_mm, ..own },
        (Some(along_y), None) => {
            let mm = y.surface_mm(along_y.surface_mm(time_s), along_y.above) + y_mm;
            Surface { mm, right: along_y.above }
        }
        (None, None) => {
            let mm = x.surface_mm(wall.surface_mm(time_s), wall.right) + x_mm;
            Surface { mm, right: wall.right }
        }
    }
}

/// From a slot's end to the drive that follows from it, s.
///
/// # Errors
/// A profile without a controller.
pub fn latency_s(profile: &Profile, clock: &SlotClock) -> Result<f64> {
    let clocks = ForceLoop::try_new(profile)?.latency();
    Ok(clocks as f64 / (profile.clocks_per_sample as f64 * clock.sample_rate_hz()))
}

impl LoopPlant {
    /// A plant before its first slot: no pad is driven. `full_scale_v` is that of drive words; the
    /// walls are the scene's.
    ///
    /// # Errors
    /// A profile without a controller.
    pub fn new(
        mut maker: Maker,
        profile: &Profile,
        (clock, full_scale_v): (SlotClock, f64),
        wall: Option<WallPlan>,
    ) -> Result<Self> {
        let latency_s = latency_s(profile, &clock)?;
        let pads = maker.plant().served();
        for pad in 0..pads {
            maker.plant().set_drive(pad, 0.0, 0.0)?;
        }
        let (surfaces, driven) = (vec![None; pads], vec![None; pads]);
        let of_scene = pads / maker.device().parts();
        let (targets_n, own) = (vec![None; of_scene], vec![None; of_scene]);
        Ok(LoopPlant {
            maker,
            clock,
            full_scale_v,
            latency_s,
            wall,
            surfaces,
            driven,
            excitation: None,
            inputs: LoopInputs { targets_n, surfaces: own, ..LoopInputs::default() },
        })
    }

    /// The same with a sine on the first pad's target or drive, and its target in the scene's place.
    pub fn with_excitation(mut self, excitation: Excitation) -> Self {
        self.excitation = Some(excitation);
        self
    }

    /// A slot; slots are asked for in order, each after the drive of the one before.
    pub fn slot(&mut self, number: usize) -> LoopSlot {
        let mut truth = self.maker.plant().truth(number);
        let end_s = self.clock.seconds(number + 1);
        let set_n = self.inputs.targets_n[truth.pad / self.maker.device().parts()];
        truth.set.target_n = set_n.unwrap_or(truth.set.target_n);
        let target_n = match self.excitation.filter(|_| truth.pad == 0) {
            Some(sine) => sine.hold_n + sine.target_n * sine.wave(end_s),
            None => set_n.unwrap_or_else(|| self.maker.device().target_n(truth.pad, end_s)),
        };
        let surface = self.surface(truth.pad, end_s);
        let (signals, peak) = self.maker.signals(number);
        let slot = Slot { pad: truth.pad, signals };
        LoopSlot { slot, truth, peak, target_n, surface, end_s }
    }

    fn surface(&mut self, pad: usize, time_s: f64) -> Option<Surface> {
        let parts_mm = self.maker.device().parts_mm();
        let set = (self.inputs.walls, self.inputs.surfaces[pad / parts_mm.len()]);
        let surface = surface_with(self.wall.as_ref()?, parts_mm, (pad, time_s), set);
        let before = self.surfaces[pad].replace(surface);
        (before != Some(surface)).then_some(surface)
    }

    /// Drives the pad of a slot, from the slot's end and the latency of its drive word on; without
    /// a drive word it stays as it was driven last.
    ///
    /// # Errors
    /// A drive that the plant does not take.
    pub fn drive(&mut self, of: &LoopSlot, drive: Option<Drive>) -> Result<Option<Driven>> {
        let pad = of.slot.pad / self.maker.plant().parts();
        if let Some(drive) = drive {
            self.driven[pad] = Some(self.driven(of, &drive)?);
        }
        let wall = self.wall_at(of);
        Ok(self.driven[pad].map(|driven| Driven { wall, ..driven }))
    }

    /// The wall that is known by the part of a slot. It is met by the pad's last part, also along y.
    fn wall_at(&self, of: &LoopSlot) -> Option<WallPlace> {
        let (part, parts_mm) = (of.truth.part, self.maker.device().parts_mm());
        let along_y = self.wall.as_ref()?.along_y.is_some() && part == Wall::PART_OF_Y as usize;
        let known = along_y || part + 1 == parts_mm.len();
        let surface =
            self.surfaces[of.slot.pad].filter(|at| known && at.mm.abs() < FAR_MM / 2.0)?;
        let axis = usize::from(along_y);
        let last_mm = parts_mm.last()?[axis] - parts_mm.get(part)?[axis];
        let mm = [of.truth.x_mm, of.truth.y_mm][axis] + last_mm;
        let depth_mm = if surface.right { mm - surface.mm } else { surface.mm - mm };
        Some(WallPlace { surface_mm: surface.mm, depth_mm })
    }

    fn driven(&mut self, of: &LoopSlot, drive: &Drive) -> Result<Driven> {
        let drive_v_rms = self.full_scale_v * drive.fraction;
        let sine = self.excitation.filter(|_| drive.pad == 0);
        let added_v = sine.map_or(0.0, |sine| sine.drive_v * sine.wave(of.end_s));
        let given_v = (drive_v_rms + added_v).max(0.0);
        self.maker.plant().set_drive(drive.pad, of.end_s + self.latency_s, given_v)?;
        let (limited, fault) = (drive.low | drive.high, drive.faults.any());
        let target_n = drive.walled.map_or(of.target_n, |walled| walled.target_n);
        let free = drive.walled.map(|walled| walled.free);
        Ok(Driven { target_n, drive_v_rms, limited, fault, free, ..Driven::default() })
    }

    /// What makes the slots.
    pub(crate) fn maker(&mut self) -> &mut Maker {
        &mut self.maker
    }

    /// The plant, to be asked what its evaluations do not change.
    pub(crate) fn device(&self) -> &Plant {
        self.maker.device()
    }

    /// What is set in place of what the scene asks for, from the next slot on.
    pub(crate) fn inputs(&mut self) -> &mut LoopInputs {
        &mut self.inputs
    }

    /// Where the walls along x and y begin at a time, mm from the sheet's centre; none where there is
    /// no such wall, or none any more.
    pub(crate) fn walls_mm(&self, time_s: f64) -> [Option<f64>; 2] {
        let place = |input: WallInput, scene_mm: Option<f64>| match input {
            WallInput::Scene => scene_mm,
            WallInput::At(mm) => scene_mm.and(Some(mm)),
            WallInput::Off => None,
        };
        let Some(wall) = &self.wall else { return [None; 2] };
        let y_mm = wall.along_y.as_ref().map(|along_y| along_y.surface_mm(time_s));
        let [x, y] = self.inputs.walls;
        [place(x, Some(wall.surface_mm(time_s))), place(y, y_mm)]
    }

    /// Effects and what they cost.
    pub fn effects(&mut self) -> Vec<EffectCost> {
        self.maker.plant().effects()
    }
}
