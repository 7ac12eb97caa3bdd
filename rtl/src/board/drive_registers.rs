// SPDX-License-Identifier: MIT OR Apache-2.0
//! Drive registers: commands as the inputs of a force loop: settings, its curve, targets, walls.
//!
//! ```text
//! place ─[kind, number]─┬─ settings, kept
//! data ─────────────────┴─ curve, targets, surfaces, requests: written on
//! ```
//!
//! | signal | format | overflow |
//! | settings | those of the loop's ports | bits of a command beyond them are ignored |
//!
//! All settings are zero after a reset: the drive is off, its rail and its slew are zero. A setting counts from the next
//! frame on, as the loop takes it. Latency: a clock for settings and requests, none for the others. Source: `hapticore_protocol::drive`.

use super::bits::read_as;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::{Signal, zero};
use hapticore_hdl::{block, bundle};
use hapticore_model::blocks::controller::Tuning;
use hapticore_model::blocks::drives::TargetPort;
use hapticore_model::blocks::force_loop::ForceLoop;
use hapticore_model::blocks::split_pad::WallPort;
use hapticore_protocol::drive::{Kind, PLACE, RIGHT, Request, Setting};

bundle! {
    /// The settings that are kept, in the order of [`Setting`].
    pub struct Settings {
        enable,
        full_drive,
        proportional,
        correction,
        rail,
        slew,
        force_cap,
        stiffness,
        most,
        factory,
    }
}

block! {
    /// What commands write of a force loop.
    pub struct DriveRegisters("drive_registers") {
        tuning: Tuning<Format>,
        target: TargetPort<Format>,
        wall: WallPort<Format>,
        data: Format,
    }
    submodules {}
    inputs(block) {
        /// Asserted for one cycle with each word.
        write: BIT,
        /// Its place.
        place: PLACE,
        /// Its data.
        data: block.data,
    }
    outputs(block) {
        tuning as Tuning: block.tuning,
        target as TargetPort: block.target,
        wall as WallPort: block.wall,
    }
    registers(block) {
        settings as Settings: block.settings(),
        alive: BIT,
        clear_faults: BIT,
        restart: BIT.where_present(!block.wall.wall_restart.is_none()),
    }
}

impl DriveRegisters {
    /// The registers of a force loop, written by commands of such data.
    pub fn new(force_loop: &ForceLoop, data: Format) -> Self {
        let ports = force_loop.inputs();
        DriveRegisters { tuning: ports.tuning, target: ports.target, wall: ports.wall, data }
    }

    fn settings(&self) -> Settings<Format> {
        let (tuning, wall) = (self.tuning, self.wall);
        Settings {
            enable: tuning.enable,
            full_drive: tuning.full_drive,
            proportional: tuning.proportional,
            correction: tuning.correction,
            rail: tuning.rail,
            slew: tuning.slew,
            force_cap: tuning.force_cap,
            stiffness: wall.wall_stiffness,
            most: wall.wall_most,
            factory: wall.wall_factory,
        }
    }

    /// The low bits of the data as a word of a port, where there is one.
    #[inline(always)]
    fn word<V: Interpretation>(&self, data: Signal<V>, format: Format) -> Signal<V> {
        if format.is_none() { zero(format) } else { read_as(data, format) }
    }

    /// The settings after this clock.
    #[inline(always)]
    fn written<V: Interpretation>(
        &self,
        old: Settings<Signal<V>>,
        of_setting: Signal<V>,
        i: &In<V>,
    ) -> Settings<Signal<V>> {
        let mut number = 0;
        Settings::map(old, |old| {
            let here = of_setting & i.place.bits(0, Kind::AT).is(number);
            number += 1;
            match old.format.is_none() {
                true => old,
                false => here.select(read_as(i.data, old.format), old),
            }
        })
    }
}

impl Block for DriveRegisters {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let of = |kind: Kind| i.write & i.place.bits(Kind::AT, 2).is(kind.bits().into());
        let number = i.place.bits(0, Kind::AT);
        let request = of(Kind::Setting) & number.is(Setting::Request as u64);
        let asks = |bit: u8| request & i.data.bits(bit, 1);
        state.store(
            self,
            Registers {
                settings: self.written(r.settings, of(Kind::Setting), &i),
                alive: i.write,
                clear_faults: asks(Request::CLEAR_FAULTS),
                restart: asks(Request::RESTART_WALLS).where_present(r.restart.format),
            },
        );
        let s = r.settings;
        let (tuning, target, wall) = (self.tuning, self.target, self.wall);
        Outputs {
            tuning: Tuning {
                enable: s.enable,
                full_drive: s.full_drive,
                proportional: s.proportional,
                correction: s.correction,
                rail: s.rail,
                slew: s.slew,
                force_cap: s.force_cap,
                curve_write: of(Kind::Curve),
                curve_address: self.word(number, tuning.curve_address),
                curve_word: self.word(i.data, tuning.curve_word),
            },
            target: TargetPort {
                target_write: of(Kind::Target),
                target_pad: self.word(number, target.target_pad),
                target_word: self.word(i.data, target.target_word),
                alive: r.alive,
                clear_faults: r.clear_faults,
            },
            wall: WallPort {
                wall_write: of(Kind::Surface).where_present(wall.wall_write),
                wall_pad: self.word(number, wall.wall_pad),
                wall_surface: self.word(i.data, wall.wall_surface),
                wall_right: i.place.bits(RIGHT, 1).where_present(wall.wall_right),
                wall_stiffness: s.stiffness,
                wall_most: s.most,
                wall_factory: s.factory,
                wall_restart: r.restart,
            },
        }
    }
}
