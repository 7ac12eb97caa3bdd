// SPDX-License-Identifier: MIT OR Apache-2.0
//! Force loop: the core, and the drives that its prompt estimates lead to.
//!
//! ```text
//! codes ─ core ─┬─ frames ───────────────┐
//!               └─ prompt estimate ─ drives ─ drive word of the pad
//! targets, walls ───────────────────────┘
//! ```
//!
//! The drive word is given before the next window begins, the frame perhaps within it. Latency:
//! that of the core's prompt estimate, and the drives'.

use super::controller::{Faults, Tuning};
use super::core::{self, Core, Inputs as CoreInputs, Outputs as CoreOutputs};
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
    /// What the drives are given in a clock.
    #[inline(always)]
    fn to_drives<V: Interpretation>(&self, core: &core::Out<V>, i: &In<V>) -> drives::In<V> {
        let (placed, placed_pad, place) = self.drives.place(&core.frames);
        drives::Inputs {
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

    /// A clock for whoever looks at the core's outputs and at drive words as they are given: see
    /// [`Drives::clock_unseen`].
    #[inline(always)]
    pub(crate) fn clock_unseen<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        i: In<V>,
    ) -> (core::Out<V>, Option<drives::Out<V>>) {
        let core = self.core.clock(&mut state.submodules.core, i.core);
        let to_drives = self.to_drives(&core, &i);
        (core, self.drives.clock_unseen(&mut state.submodules.drives, to_drives))
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
