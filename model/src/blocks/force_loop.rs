// SPDX-License-Identifier: MIT OR Apache-2.0
//! Force loop: the core, and the drives that its prompt estimates lead to.
//!
//! ```text
//! codes ─ core ─┬─ frames ───────────────┐
//!               └─ prompt estimate ─ drives ─ drive word of the pad
//! targets, walls ───────────────────────┘
//! ```
//!
//! The drive word comes before the next window begins, the frame perhaps within it. Latency: that
//! of the core's prompt estimate, and the drives'.

use super::controller::{Faults, Tuning};
use super::core::{self, Core, Inputs as CoreInputs, Observer, Outputs as CoreOutputs};
use super::drives::{self, DrivePort, Drives, ExtremesPort, TargetPort};
use super::split_pad::WallPort;
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::BIT;
use hapticore_hdl::signal::Clocked;
use hapticore_hdl::{block, call};

block! {
    /// The core with a force controller.
    pub struct ForceLoop("hapticore_loop") {}
    submodules {
        /// The core.
        pub core: Core,
        /// Controller and walls.
        pub drives: Drives,
    }
    inputs(block) {
        core as CoreInputs: block.core.inputs(),
        target as TargetPort: block.drives.inputs().target,
        tuning as Tuning: block.drives.inputs().tuning,
        wall as WallPort: block.drives.inputs().wall,
        /// Every pad's drive begins anew, at zero: what holds it has gone to zero.
        drives_clear: BIT,
        /// Asserted for one cycle every millisecond: without ticks nothing is driven.
        tick: BIT,
        /// Extremes are read: they begin anew.
        extremes_read: BIT,
    }
    outputs(block) {
        core as CoreOutputs: block.core.outputs(),
        drive as DrivePort: block.drives.outputs().drive,
        extremes as ExtremesPort: block.drives.outputs().extremes,
        faults as Faults: Faults::of(BIT),
    }
    registers(block) {}
}

impl ForceLoop {
    /// The force loop of a profile.
    ///
    /// # Errors
    /// A profile without a controller; a core or controller that cannot be; a drive word that
    /// would come within the next window.
    pub fn try_new(profile: &Profile) -> Result<Self, ProfileError> {
        let core = Core::try_new(profile)?;
        let drives = Drives::try_new(profile, core.outputs().prompt)?;
        let of = ForceLoop { core, drives };
        of.check_blanking(profile)?;
        Ok(of)
    }

    /// No window depends on the drive word of the slot before it from its middle on: a plant makes
    /// whole windows.
    fn check_blanking(&self, profile: &Profile) -> Result<(), ProfileError> {
        let blanking = profile.slot.blanking() * profile.clocks_per_sample;
        // The last sample's own clocks are part of it.
        let least = self.latency() - profile.clocks_per_sample.min(self.latency());
        if blanking > least {
            return Ok(());
        }
        let expected = format!("more than {least} clocks of blanking for a drive word");
        Err(ProfileError::value("slot.settle", expected, blanking))
    }

    /// Clocks from the strobe of a window's last sample to the drive word.
    pub fn latency(&self) -> u64 {
        self.core.prompt_latency() + self.drives.latency()
    }
}

impl ForceLoop {
    /// The inputs of the drives in a clock.
    #[inline(always)]
    fn to_drives<V: Interpretation>(&self, core: &core::Out<V>, i: &In<V>) -> drives::In<V> {
        let (placed, placed_pad, place) = self.drives.place(&core.frames);
        drives::Inputs {
            clear: i.core.clear,
            drives_clear: i.drives_clear,
            tick: i.tick,
            estimate: core.prompt,
            placed,
            placed_pad,
            place,
            target: i.target,
            tuning: i.tuning,
            wall: i.wall,
            extremes_read: i.extremes_read,
        }
    }

    /// [`Core::samples`] for a caller that uses frames and drive words as they come. In each clock `look` receives the
    /// core's outputs where they may have a frame's word, and the drives' outputs unless these are idle.
    #[inline(always)]
    pub(crate) fn samples(
        &self,
        state: &mut State<Self, Clocked>,
        i: &In<Clocked>,
        codes: &[i32],
        channel: &mut usize,
        look: &mut impl FnMut(Option<&core::Out<Clocked>>, Option<drives::Out<Clocked>>),
    ) {
        let within = &mut state.submodules;
        let mut driven = Driven { block: self, drives: &mut within.drives, i, rest: false, look };
        self.core.samples(&mut within.core, &i.core, codes, channel, &mut driven);
    }
}

/// Drives that follow a core.
struct Driven<'a, L> {
    block: &'a ForceLoop,
    drives: &'a mut State<Drives, Clocked>,
    i: &'a In<Clocked>,
    /// The drives are idle until the core gives them something.
    rest: bool,
    look: &'a mut L,
}

impl<L> Driven<'_, L> {
    #[inline(always)]
    fn drive(&mut self, outputs: &core::Out<Clocked>) -> Option<drives::Out<Clocked>> {
        let to_drives = self.block.to_drives(outputs, self.i);
        let drives = self.block.drives.clock_unseen(self.drives, to_drives);
        self.rest = drives.is_none();
        drives
    }
}

impl<L> Observer for Driven<'_, L>
where
    L: FnMut(Option<&core::Out<Clocked>>, Option<drives::Out<Clocked>>),
{
    #[inline(always)]
    fn outputs(&mut self, outputs: core::Out<Clocked>) {
        let drives = self.drive(&outputs);
        (self.look)(Some(&outputs), drives);
    }

    #[inline(always)]
    fn without_results(&mut self, outputs: core::Out<Clocked>) {
        let drives = if self.rest { None } else { self.drive(&outputs) };
        (self.look)(None, drives);
    }
}

impl Block for ForceLoop {
    #[inline(never)]
    fn step(&self, state: &mut State<Self, Clocked>, i: In<Clocked>) -> Out<Clocked> {
        self.clock(state, i)
    }

    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let core = call!(self.core, state, i.core);
        let drives = call!(self.drives, state, self.to_drives(&core, &i));
        let drives::Outputs { drive, extremes, faults } = drives;
        Outputs { core, drive, extremes, faults }
    }
}

#[cfg(test)]
mod tests;
