// SPDX-License-Identifier: MIT OR Apache-2.0
//! Drives: from estimates to drive words.
//!
//! ```text
//! prompt estimate ─┬────────────────────── controller ─ drive word of the pad
//!                  └ split pad ─ wall ─────────┤           (where pads are split and have walls)
//! targets ─[of every pad]─ target ─────────────┘
//! ```
//!
//! The drives take a pad's target and the settings of controller and walls once, with its estimate: what is written
//! later counts from the next frame on. The curve is an exception: it is written while no drive word is being made.
//! Writing a target is a sign of life of the host. A split pad has a drive word after the slot of its last part, by
//! whose number it is known; its target is the larger of the one written and the wall's.
//!
//! After a reset, and from the beginning of `clear` on, every pad's target is zero until one is written, `clear` or not.
//! In a clock in which `enable` is not set, drives are off, whatever was taken with the estimate. Latency: two clocks, or
//! those of the split pad, and the controller's.

use super::controller::{self, Controller, Faults, Tuning};
use super::estimator::{FramePort, PromptPort};
use super::marks;
use super::split_pad::{self, SplitPad, WallPort};
use hapticore_contract::frame::Field;
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{Signal, Wrap, bit, int, zero};
use hapticore_hdl::{block, bundle, call};

mod unseen;

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
        /// The force that it is for, N; stable until the pad's next target.
        drive_target,
        /// The user leaves the wall.
        drive_free,
    }
}

bundle! {
    /// The least and the most of all pads since they were last read.
    pub struct ExtremesPort {
        /// There has been a drive word of a valid estimate.
        extremes_valid,
        /// Least drive word.
        least_drive,
        /// Largest drive word.
        most_drive,
        /// Least haptic force, N.
        least_force,
        /// Largest haptic force, N.
        most_force,
    }
}

bundle! {
    /// Settings of the frame: those of [`Tuning`] and [`WallPort`] as its estimate was given.
    pub struct Settings {
        set_enable,
        set_full_drive,
        set_proportional,
        set_correction,
        set_rail,
        set_slew,
        set_force_cap,
        set_stiffness,
        set_most,
        set_factory,
    }
}

block! {
    /// Controller, targets and walls of all pads.
    pub struct Drives("drives") {
        pads: u64,
        estimates: PromptPort<Format>,
        position: Format,
        pad: Format,
        of_controller: controller::Inputs<Format>,
        of_drive: controller::Outputs<Format>,
    }
    submodules {
        /// The controller.
        pub controller: Controller,
        /// Split pads and their walls, where there are some.
        pub split_pad: Option<SplitPad>,
        /// Of each pad that has one: its target.
        targets: Memory,
    }
    inputs(block) {
        /// The core's slot is abandoned: every pad begins anew, without a target.
        clear: BIT,
        /// Every pad's drive begins anew, at zero: what holds it has gone to zero.
        drives_clear: BIT,
        /// Asserted for one cycle every millisecond.
        tick: BIT,
        estimate as PromptPort: block.estimates,
        /// A frame has a valid place.
        placed: BIT.where_present(block.has_walls()),
        /// Number of its pad.
        placed_pad: block.pad.where_present(block.has_walls()),
        /// Place, mm.
        place: block.position.where_present(block.has_walls()),
        target as TargetPort: block.target(),
        tuning as Tuning: block.of_controller.tuning,
        wall as WallPort: block.wall(),
        /// Extremes are read: they begin anew.
        extremes_read: BIT,
    }
    outputs(block) {
        drive as DrivePort: block.drive(),
        extremes as ExtremesPort: block.extremes(),
        faults as Faults: Faults::of(BIT),
    }
    registers(block) {
        /// A pad's target has been asked for.
        asked: BIT,
        /// It is there.
        start: BIT,
        invalid: BIT,
        lifted: BIT,
        pad: block.pad,
        /// Pads with targets.
        targeted: marks::format(block.pads),
        /// The pad has one.
        has_target: BIT,
        target: block.targets.format,
        /// `clear` of the clock before.
        cleared: BIT,
        settings as Settings: block.settings(),
        extremes as ExtremesPort: block.extremes(),
        /// A drive word has been given.
        driven: BIT.where_present(block.has_walls()),
        /// It is zero.
        rests: BIT.where_present(block.has_walls()),
    }
}

impl Drives {
    /// The drives of a profile, after estimates of these formats.
    ///
    /// # Errors
    /// A profile without a controller; a controller or a wall that cannot be.
    pub fn try_new(profile: &Profile, estimates: PromptPort<Format>) -> Result<Self, ProfileError> {
        let controller = Controller::try_new(profile)?;
        let (of_controller, of_drive) = (controller.inputs(), controller.outputs());
        let controller::Inputs { target, pad, .. } = of_controller;
        Ok(Drives {
            pads: profile.pads,
            estimates,
            position: profile.formats.position,
            pad,
            of_controller,
            of_drive,
            split_pad: profile.wall.map(|_| SplitPad::try_new(profile)).transpose()?,
            targets: Memory::new("targets", 1 << pad.width, target).in_block(),
            controller,
        })
    }

    /// Clocks from the prompt estimate to the drive word.
    pub fn latency(&self) -> u64 {
        self.split_pad.as_ref().map_or(2, SplitPad::latency) + self.controller.latency()
    }

    /// Words of the controller's curve: one more than its cells.
    pub fn words_of_curve(&self) -> usize {
        self.controller.words_of_curve()
    }

    /// As [`Controller::hurry`].
    pub(crate) fn hurry(&mut self) {
        self.controller.hurry();
    }

    /// Whether this is the number of a pad's last part.
    pub fn is_last(&self, pad: usize) -> bool {
        let parts = self.split_pad.as_ref().map_or(1, SplitPad::parts);
        (pad as u64 + 1).is_multiple_of(parts)
    }

    #[inline(always)]
    fn has_walls(&self) -> bool {
        self.split_pad.is_some()
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
            drive: self.of_drive.drive,
            drive_low: BIT,
            drive_high: BIT,
            drive_target: self.targets.format.where_present(self.has_walls()),
            drive_free: BIT.where_present(self.has_walls()),
        }
    }

    fn wall(&self) -> WallPort<Format> {
        self.split_pad.as_ref().map_or(WallPort::of(Format::NONE), SplitPad::port)
    }

    fn extremes(&self) -> ExtremesPort<Format> {
        let (drive, force) = (self.of_drive.drive, self.estimates.prompt_force);
        ExtremesPort {
            extremes_valid: BIT,
            least_drive: drive,
            most_drive: drive,
            least_force: force,
            most_force: force,
        }
    }

    fn settings(&self) -> Settings<Format> {
        let (tuning, wall) = (self.of_controller.tuning, self.wall());
        Settings {
            set_enable: tuning.enable,
            set_full_drive: tuning.full_drive,
            set_proportional: tuning.proportional,
            set_correction: tuning.correction,
            set_rail: tuning.rail,
            set_slew: tuning.slew,
            set_force_cap: tuning.force_cap,
            set_stiffness: wall.wall_stiffness,
            set_most: wall.wall_most,
            set_factory: wall.wall_factory,
        }
    }

    /// A frame's word that is a valid place of a pad's last part: whether it is, of which number, and the place. That along
    /// y is known by the number before the part's.
    #[inline(always)]
    pub fn place<V: Interpretation>(
        &self,
        frame: &FramePort<Signal<V>>,
    ) -> (Signal<V>, Signal<V>, Signal<V>) {
        if !self.has_walls() {
            let none = |format: Format| frame.valid.where_present(format);
            return (none(Format::NONE), none(Format::NONE), none(Format::NONE));
        }
        let is = |field: Field| frame.index.is(field as u64);
        let valid = frame.valid & !frame.invalid & !frame.lifted;
        let place = frame.frame.as_code(self.position);
        let of = self.split_pad.as_ref().expect("there are walls");
        let along_y = is(Field::Y);
        let placed = valid & (is(Field::X) | along_y) & of.is_last(frame.pad);
        let before = (frame.pad - int(1)).resize(self.pad, Wrap);
        (placed, along_y.select(before, frame.pad), place)
    }
}

/// What a controller begins with.
struct Begin<V: Interpretation> {
    start: Signal<V>,
    invalid: Signal<V>,
    lifted: Signal<V>,
    capacitance: Signal<V>,
    measured: Signal<V>,
    /// Force that its wall asks for.
    of_wall: Signal<V>,
    free: Signal<V>,
}

impl Drives {
    /// Of a pad that is whole: as soon as its target is there.
    #[inline(always)]
    fn whole<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> Begin<V> {
        Begin {
            start: r.start,
            invalid: r.invalid,
            lifted: r.lifted,
            capacitance: i.estimate.prompt_capacitance,
            measured: i.estimate.prompt_force,
            of_wall: zero(Format::NONE),
            free: bit(false),
        }
    }

    /// Of a split one: once its wall is known.
    #[inline(always)]
    fn split<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        r: &Regs<V>,
        i: &In<V>,
    ) -> Begin<V> {
        let within = self.split_pad.as_ref().zip(state.submodules.split_pad.as_mut());
        let (block, within) = within.expect("there are walls");
        let inputs = split_pad::Inputs {
            estimate: i.estimate.prompt,
            pad: i.estimate.prompt_pad,
            capacitance: i.estimate.prompt_capacitance,
            measured: i.estimate.prompt_force,
            invalid: i.estimate.prompt_invalid,
            lifted: i.estimate.prompt_lifted,
            clear: i.clear | i.drives_clear,
            begins_anew: self.begins_anew(r, i),
            placed: i.placed,
            placed_pad: i.placed_pad,
            place: i.place,
            driven: r.driven,
            rests: r.rests,
            wall: WallPort {
                wall_stiffness: r.settings.set_stiffness,
                wall_most: r.settings.set_most,
                wall_factory: r.settings.set_factory,
                ..i.wall
            },
        };
        let pad = block.call("split_pad", within, inputs);
        Begin {
            start: pad.done,
            invalid: pad.invalid,
            lifted: pad.lifted,
            capacitance: pad.capacitance,
            measured: pad.measured,
            of_wall: pad.target,
            free: pad.free,
        }
    }
}

impl Drives {
    /// With the first clock of `clear` what has been written of pads goes.
    #[inline(always)]
    fn begins_anew<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> Signal<V> {
        i.clear & !r.cleared
    }

    /// Pads with targets after this clock, and whether the pad of an estimate has one.
    #[inline(always)]
    fn targeted<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> [Signal<V>; 2] {
        let marks = marks::unless(self.begins_anew(r, i), r.targeted);
        let written = (i.target.target_write, i.target.target_pad);
        let has = marks::is_marked(marks, i.estimate.prompt_pad);
        let has = i.estimate.prompt.select(has, r.has_target) & !i.clear;
        [marks::written(marks, written, bit(true)), has]
    }

    /// The settings: those of now, with an estimate.
    #[inline(always)]
    fn taken<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> Settings<Signal<V>> {
        let now = Settings {
            set_enable: i.tuning.enable,
            set_full_drive: i.tuning.full_drive,
            set_proportional: i.tuning.proportional,
            set_correction: i.tuning.correction,
            set_rail: i.tuning.rail,
            set_slew: i.tuning.slew,
            set_force_cap: i.tuning.force_cap,
            set_stiffness: i.wall.wall_stiffness,
            set_most: i.wall.wall_most,
            set_factory: i.wall.wall_factory,
        };
        let pairs = Settings::zip(now, r.settings);
        Settings::map(pairs, |(now, old)| match now.format.is_none() {
            true => old,
            false => i.estimate.prompt.select(now, old),
        })
    }

    /// The tuning that the frame goes by.
    #[inline(always)]
    fn held<V: Interpretation>(
        &self,
        settings: &Settings<Signal<V>>,
        now: Tuning<Signal<V>>,
    ) -> Tuning<Signal<V>> {
        Tuning {
            enable: settings.set_enable,
            full_drive: settings.set_full_drive,
            proportional: settings.set_proportional,
            correction: settings.set_correction,
            rail: settings.set_rail,
            slew: settings.set_slew,
            force_cap: settings.set_force_cap,
            ..now
        }
    }

    /// Extremes with the drive word of this clock; the first after a reading counts alone.
    #[inline(always)]
    fn extremes_with<V: Interpretation>(
        &self,
        r: &Regs<V>,
        i: &In<V>,
        controller: &controller::Out<V>,
        begin: &Begin<V>,
    ) -> ExtremesPort<Signal<V>> {
        let old = r.extremes;
        let known = old.extremes_valid & !i.extremes_read;
        let counts = controller.done & !begin.invalid;
        let least = |old: Signal<V>, now: Signal<V>| {
            let lesser = known.select(old.less_than(now).select(old, now), now);
            counts.select(lesser, old)
        };
        let most = |old: Signal<V>, now: Signal<V>| {
            // `now` is subtracted in both: its bits are inverted once.
            let greater = known.select(old.less_than(now).select(now, old), now);
            counts.select(greater, old)
        };
        ExtremesPort {
            extremes_valid: counts | known,
            least_drive: least(old.least_drive, controller.drive),
            most_drive: most(old.most_drive, controller.drive),
            least_force: least(old.least_force, begin.measured),
            most_force: most(old.most_force, begin.measured),
        }
    }
}

impl Block for Drives {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let begin = match self.has_walls() {
            true => self.split(state, &r, &i),
            false => self.whole(&r, &i),
        };
        let TargetPort { target_write, target_pad, target_word, alive, clear_faults } = i.target;
        let inputs = controller::Inputs {
            start: begin.start,
            pad: r.pad,
            target: r.target,
            of_wall: begin.of_wall,
            capacitance: begin.capacitance,
            measured: begin.measured,
            force_gain: i.estimate.prompt_gain,
            invalid: begin.invalid,
            lifted: begin.lifted,
            clear: i.clear | i.drives_clear | !i.tuning.enable,
            tick: i.tick,
            alive: alive | target_write,
            clear_faults,
            tuning: self.held(&r.settings, i.tuning),
        };
        let controller = call!(self.controller, state, inputs);
        let formats = self.drive();
        let drive = DrivePort {
            drive_valid: controller.done,
            drive_pad: r.pad,
            drive: controller.drive,
            drive_low: controller.low,
            drive_high: controller.high,
            drive_target: controller.target,
            drive_free: begin.free.where_present(formats.drive_free),
        };
        let outputs = Outputs { drive, extremes: r.extremes, faults: controller.faults };
        let rests = controller.drive.is(0).where_present(r.rests.format);
        let steps = i.estimate.prompt | r.asked | r.start | controller.done;
        let of_walls = match self.has_walls() {
            true => r.driven | rests.select(!r.rests, r.rests),
            false => bit(false),
        };
        let clears = r.cleared.select(!i.clear, i.clear);
        if (steps | target_write | i.extremes_read | of_walls | clears).can_skip() {
            return outputs;
        }
        let found = self.targets.data(&mut state.submodules.targets);
        let prompt = i.estimate.prompt;
        let pad = prompt.select(i.estimate.prompt_pad, r.pad);
        let write = Write { enable: target_write, address: target_pad, data: target_word };
        self.targets.access(&mut state.submodules.targets, pad, write);
        let [targeted, has_target] = self.targeted(&r, &i);
        let wanted = r.has_target.select(found, zero(r.target.format));
        let target = r.asked.select(wanted, r.target);
        let next = Registers {
            asked: prompt,
            start: r.asked,
            invalid: prompt.select(i.estimate.prompt_invalid, r.invalid),
            lifted: prompt.select(i.estimate.prompt_lifted, r.lifted),
            pad,
            targeted,
            has_target,
            target: i.clear.select(zero(target.format), target),
            cleared: i.clear,
            settings: self.taken(&r, &i),
            extremes: self.extremes_with(&r, &i, &controller, &begin),
            driven: controller.done.where_present(r.driven.format),
            rests,
        };
        state.store(self, next);
        outputs
    }
}

#[cfg(test)]
mod tests;
