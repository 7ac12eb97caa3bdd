// SPDX-License-Identifier: MIT OR Apache-2.0
//! Force loop: the core, and the force controller that its prompt estimates drive.
//!
//! ```text
//! codes ─ core ─┬─ frames
//!               └─ prompt estimate ─ controller ─ drive word of the pad
//! targets ─[of every pad]─ target ──────┘
//! ```
//!
//! A pad's target is taken once, as its estimate is given: one that is written later counts from
//! the next frame on. Writing one is a sign of life of the host. The drive word is given before the
//! next window begins, the frame perhaps within it. Latency: that of the core's prompt
//! estimate, two clocks, the controller's.

use super::controller::{self, Controller, Faults, Tuning};
use super::core::{Core, Inputs as CoreInputs, Outputs as CoreOutputs};
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::{block, bundle, call};

bundle! {
    /// Writes the target of a pad.
    pub struct TargetPort {
        /// Target: writes a pad's.
        target_write,
        /// Target: whose.
        target_pad,
        /// Target: force, N.
        target_word,
        /// The host is alive.
        alive,
        /// Clears the controller's faults.
        clear_faults,
    }
}

bundle! {
    /// A drive word, as it is given.
    pub struct DrivePort {
        /// Asserted for one cycle with each drive word.
        drive_valid,
        /// Pad of the drive word.
        drive_pad,
        /// Drive word, drive's full scale.
        drive,
        /// The drive is at zero and should be less.
        drive_low,
        /// The drive is at its rail and should be more.
        drive_high,
    }
}

block! {
    /// The core with a force controller.
    pub struct ForceLoop("hapticore_loop") {
        pad: Format,
    }
    submodules {
        /// The core.
        pub core: Core,
        /// The controller.
        pub controller: Controller,
        targets: Memory,
    }
    inputs(block) {
        core as CoreInputs: block.core.inputs(),
        target as TargetPort: block.target(),
        tuning as Tuning: block.controller.inputs().tuning,
    }
    outputs(block) {
        core as CoreOutputs: block.core.outputs(),
        drive as DrivePort: block.drive(),
        faults as Faults: Faults::of(BIT),
    }
    registers(block) {
        /// A pad's target has been asked for.
        asked: BIT,
        /// It is there.
        start: BIT,
        invalid: BIT,
        pad: block.pad,
        target: block.targets.format,
    }
}

impl ForceLoop {
    /// The force loop of a profile.
    ///
    /// # Errors
    /// A profile without a controller; a core or controller that cannot be; a drive word that
    /// would come within the next window.
    pub fn try_new(profile: &Profile) -> Result<Self, ProfileError> {
        let (core, controller) = (Core::try_new(profile)?, Controller::try_new(profile)?);
        let target = controller.inputs().target;
        let pad = controller.inputs().pad;
        let targets = Memory::new("targets", 1 << pad.width, target);
        let of = ForceLoop { core, controller, targets, pad };
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
        self.core.prompt_latency() + 2 + self.controller.latency()
    }

    fn target(&self) -> TargetPort<Format> {
        TargetPort {
            target_write: BIT,
            target_pad: self.pad,
            target_word: self.targets.format,
            alive: BIT,
            clear_faults: BIT,
        }
    }

    fn drive(&self) -> DrivePort<Format> {
        DrivePort {
            drive_valid: BIT,
            drive_pad: self.pad,
            drive: self.controller.outputs().drive,
            drive_low: BIT,
            drive_high: BIT,
        }
    }
}

impl Block for ForceLoop {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let core = call!(self.core, state, i.core);
        let prompt = core.prompt;
        let TargetPort { target_write, target_pad, target_word, alive, clear_faults } = i.target;
        let inputs = controller::Inputs {
            start: r.start,
            pad: r.pad,
            target: r.target,
            capacitance: prompt.prompt_capacitance,
            measured: prompt.prompt_force,
            force_gain: prompt.prompt_gain,
            invalid: r.invalid,
            alive: alive | target_write,
            clear_faults,
            tuning: i.tuning,
        };
        let controller = call!(self.controller, state, inputs);
        let found = self.targets.data(&mut state.submodules.targets);
        let pad = prompt.prompt.select(prompt.prompt_pad, r.pad);
        let write = Write { enable: target_write, address: target_pad, data: target_word };
        self.targets.access(&mut state.submodules.targets, pad, write);
        let next = Registers {
            asked: prompt.prompt,
            start: r.asked,
            invalid: prompt.prompt.select(prompt.prompt_invalid, r.invalid),
            pad,
            target: r.asked.select(found, r.target),
        };
        state.store(self, next);
        let drive = DrivePort {
            drive_valid: controller.done,
            drive_pad: r.pad,
            drive: controller.drive,
            drive_low: controller.low,
            drive_high: controller.high,
        };
        Outputs { core, drive, faults: controller.faults }
    }
}

#[cfg(test)]
mod tests;
