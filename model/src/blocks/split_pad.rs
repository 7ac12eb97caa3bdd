// SPDX-License-Identifier: MIT OR Apache-2.0
//! Split pad: the estimates of a pad's parts as one of the pad, and the force of its wall.
//!
//! ```text
//! parts of a pad, slot after slot:   left | right            both sense and brake
//!                                    left | right | brake    the outer two sense
//!                                    tl | bl | br | tr       quadrants, all sense and brake
//! C = (C_left + C_right)/2,  F likewise;    those of the brake;    or the mean of all quadrants
//! C_left = (C_tl + C_bl)/2,  C_right = (C_br + C_tr)/2;    C_bottom = (C_bl + C_br)/2,  C_top = (C_tl + C_tr)/2
//! of the wall along x: depth = x − surface, along = y;   of that along y: depth = y − surface, along = x
//! ```
//!
//! ```text
//! estimate ─[left, right]─ C_left, C_right ─┐
//! frame ─[x, y of every pad]─(− surface)────┴─ sided wall ─ target  (docs/physics.md §6)
//! drive ─[zero, of every pad]───────────────┘
//! ```
//!
//! | signal  | format              | unit | overflow                              |
//! | C, F    | profile             | pF, N | cannot: a mean                       |
//! | depth   | positions', one bit more | mm | cannot                              |
//!
//! A pad is known by the number of its last part, whose place is the pad's. The wall acts from the pad's first valid
//! place on, where it has a surface. After a reset, and from the beginning of `clear` on, no pad has a surface until it
//! is written, and with every `clear` a pad needs a new place. Where the estimate of a sensing part is invalid, or the
//! part does not touch, the wall releases, the safe side. Quadrants have a wall along either axis, one after the other.
//! The wall along y is known by the number of the pad's third part; its bottom is the left of that along x, and the pad
//! takes the larger force; where the user leaves one, the other brakes only a pad that goes into it. Latency: four clocks
//! and the wall's for each axis, from the last part's estimate to `done`.

use super::marks;
use super::sided_wall::{self, SidedWall};
use hapticore_contract::profile::{self, Profile, ProfileError};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{HalfEven, Proved, Saturate, Signal, Wrap, bit, int, is_set, zero};
use hapticore_hdl::{block, bundle, call};

bundle! {
    /// Where the walls of pads are, and what they are made of.
    pub struct WallPort {
        /// Wall: writes the wall of a pad.
        wall_write,
        /// Wall: whose; a pad is known by the number of its last part.
        wall_pad,
        /// Wall: place of its surface, mm; its inside is left of it.
        wall_surface,
        /// Wall: its inside is right of it instead.
        wall_right,
        /// Wall: stiffness, N/mm.
        wall_stiffness,
        /// Wall: largest force, N.
        wall_most,
        /// Wall: what the direction of a wall on the left reads without a push.
        wall_factory,
        /// Wall: pads start anew, as when they are put on.
        wall_restart,
    }
}

block! {
    /// Parts of split pads, and their walls.
    pub struct SplitPad("split_pad") {
        pads: u64,
        parts: u64,
        position: Format,
        capacitance: Format,
        force: Format,
    }
    submodules {
        /// The walls.
        pub wall: SidedWall,
        /// Of each pad that has one: its place.
        places: Memory,
        /// Of each pad that has one: the wall is on the right, and its surface.
        surfaces: Memory,
    }
    inputs(block) {
        /// Every pad begins anew.
        clear: BIT,
        /// Every pad is without a wall until one is written.
        begins_anew: BIT,
        /// A part's estimate; all up to `invalid` are valid.
        estimate: BIT,
        /// Number of the part.
        pad: block.pad(),
        /// Capacitance of the part, pF.
        capacitance: block.capacitance,
        /// Haptic force, N.
        measured: block.force,
        /// The estimate is invalid.
        invalid: BIT,
        /// The part does not touch.
        lifted: BIT,
        /// A frame has a valid place.
        placed: BIT,
        /// Number of its part for x, that before it for y.
        placed_pad: block.pad(),
        /// Place along x, or along y, mm.
        place: block.position,
        /// A drive word is given.
        driven: BIT,
        /// It is zero.
        rests: BIT,
        wall as WallPort: block.port(),
    }
    outputs(block) {
        /// Asserted for one cycle when the estimate of a pad is there.
        done: BIT,
        /// Capacitance of what brakes, pF.
        capacitance: block.capacitance,
        /// Its haptic force, N.
        measured: block.force,
        /// Its estimate is invalid.
        invalid: BIT,
        /// A part of what brakes does not touch.
        lifted: BIT,
        /// Force of the wall, N.
        target: block.force,
        /// The user leaves the wall.
        free: BIT,
        /// The direction was read.
        reads: BIT,
    }
    registers(block) {
        pad: block.pad(),
        /// Of quadrants the first.
        left: block.capacitance,
        /// Of quadrants the second.
        right: block.capacitance,
        third: block.of_quadrants(block.capacitance),
        fourth: block.of_quadrants(block.capacitance),
        /// Capacitances and forces of the quadrants so far.
        sum: block.of_quadrants(four(block.capacitance)),
        force_sum: block.of_quadrants(four(block.force)),
        /// The wall along y is next, or under way.
        along_y: block.of_quadrants(BIT),
        /// What the wall along x has given.
        target: block.of_quadrants(block.force),
        free: block.of_quadrants(BIT),
        /// Pads whose user leaves the wall along y, as of their last frame.
        free_pads: block.of_quadrants(marks::format(block.pads)),
        /// The estimate of a sensing part is invalid.
        invalid: BIT,
        /// That of what brakes is.
        unknown: BIT,
        /// A sensing part does not touch.
        lifted: BIT,
        /// One of what brakes does not.
        released: BIT,
        capacitance: block.capacitance,
        measured: block.force,
        /// Of the left half.
        left_measured: block.force.where_present(block.parts == 2),
        /// The pad's place and wall are asked for, then there, then its place along the wall.
        asked: BIT,
        found: BIT,
        crossed: BIT,
        /// Their words. For the wall along y the two places, which have been read, change roles.
        place_word: block.places.format,
        surface_word: block.surfaces.format,
        along_word: block.places.format,
        start: BIT,
        /// Pads with places.
        placed_pads: marks::format(block.pads),
        /// Pads with walls.
        walled_pads: marks::format(block.pads),
        /// Pads whose last drive word is zero.
        resting_pads: marks::format(block.pads),
        /// The pad has a place and a wall.
        met: BIT,
        placed: BIT,
        /// Place less surface.
        depth: block.wall.inputs().depth,
        mirrored: BIT,
        rests: BIT,
    }
}

impl SplitPad {
    /// The split pads of a profile.
    ///
    /// # Errors
    /// A profile without walls, words that the model cannot hold.
    pub fn try_new(profile: &Profile) -> Result<Self, ProfileError> {
        let Some(rule) = &profile.wall else {
            return Err(ProfileError::value("wall", "a table", "none"));
        };
        let (wall, f) = (SidedWall::try_new(profile)?, &profile.formats);
        let words = 1 << Format::counter(profile.pads - 1).width;
        let memory = |name, format| Memory::new(name, words, format).dont_care_on_collision();
        let place = Format::unsigned(f.position.width, 0);
        let surface = Format::unsigned(f.position.width + 1, 0);
        Ok(SplitPad {
            pads: profile.pads,
            parts: rule.parts,
            position: f.position,
            capacitance: f.capacitance,
            force: f.force,
            wall,
            places: memory("places", place).in_block(),
            // Written at any time: what is read then is the word before.
            surfaces: Memory::new("surfaces", words, surface).in_block(),
        })
    }

    /// Slots of each pad.
    pub fn parts(&self) -> u64 {
        self.parts
    }

    #[inline(always)]
    fn pad(&self) -> Format {
        Format::counter(self.pads - 1)
    }

    /// The formats of the walls' port.
    #[inline(always)]
    pub fn port(&self) -> WallPort<Format> {
        let wall = self.wall.inputs();
        WallPort {
            wall_write: BIT,
            wall_pad: self.pad(),
            wall_surface: self.position,
            wall_right: BIT,
            wall_stiffness: wall.stiffness,
            wall_most: wall.most,
            wall_factory: wall.factory,
            wall_restart: BIT,
        }
    }

    /// Clocks from the estimate of a pad's last part to `done`.
    pub fn latency(&self) -> u64 {
        let axes = if self.has_quadrants() { 2 } else { 1 };
        axes * (4 + self.wall.latency())
    }

    /// Whether a pad is being asked for, or its wall is busy: else, given nothing, a clock changes nothing.
    pub(super) fn is_busy<V: Interpretation>(&self, state: &State<Self, V>) -> bool {
        is_set(self.under_way(&state.load(self))) || self.wall.is_busy(&state.submodules.wall)
    }

    #[inline(always)]
    fn under_way<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        r.asked | r.found | r.crossed | r.start
    }

    /// Whether pads have walls along both axes.
    fn has_quadrants(&self) -> bool {
        self.parts == profile::Wall::QUADRANTS.parts
    }

    #[inline(always)]
    fn of_quadrants(&self, format: Format) -> Format {
        format.where_present(self.has_quadrants())
    }

    /// The part is the last of its pad.
    #[inline(always)]
    pub fn is_last<V: Interpretation>(&self, pad: Signal<V>) -> Signal<V> {
        self.is_part(pad, self.parts - 1)
    }

    /// The part is this one of its pad.
    #[inline(always)]
    fn is_part<V: Interpretation>(&self, pad: Signal<V>, part: u64) -> Signal<V> {
        (part..self.pads)
            .step_by(self.parts as usize)
            .fold(bit(false), |any, number| any | pad.is(number))
    }

    /// The registers after a part's estimate.
    #[inline(always)]
    fn gathered<V: Interpretation>(&self, r: Regs<V>, i: &In<V>) -> Regs<V> {
        if self.has_quadrants() {
            return self.gathered_quadrants(r, i);
        }
        let [first, second] = [0, 1].map(|part| i.estimate & self.is_part(i.pad, part));
        let last = i.estimate & self.is_part(i.pad, self.parts - 1);
        let (capacitance, measured) = match self.parts {
            2 => (mean(r.left, i.capacitance), mean(r.left_measured, i.measured)),
            _ => (i.capacitance, i.measured),
        };
        let [invalid, lifted] = [(r.invalid, i.invalid), (r.lifted, i.lifted)]
            .map(|(before, now)| (!first & before) | now);
        let of_brake = |all: Signal<V>, own: Signal<V>| if self.parts == 2 { all } else { own };
        Registers {
            pad: i.estimate.select(i.pad, r.pad),
            left: first.select(i.capacitance, r.left),
            right: second.select(i.capacitance, r.right),
            invalid: (first | second).select(invalid, r.invalid),
            unknown: last.select(of_brake(invalid, i.invalid), r.unknown),
            lifted: (first | second).select(lifted, r.lifted),
            released: last.select(of_brake(lifted, i.lifted), r.released),
            capacitance: last.select(capacitance, r.capacitance),
            measured: last.select(measured, r.measured),
            left_measured: match self.parts {
                2 => first.select(i.measured, r.left_measured),
                _ => r.left_measured,
            },
            asked: last,
            ..r
        }
    }

    /// The registers after a quadrant's estimate; after the wall along x that along y is asked for.
    #[inline(always)]
    fn gathered_quadrants<V: Interpretation>(&self, r: Regs<V>, i: &In<V>) -> Regs<V> {
        let [first, second, third, last] =
            [0, 1, 2, 3].map(|part| i.estimate & self.is_part(i.pad, part));
        let sum = |of: Signal<V>, more: Signal<V>| {
            let before = first.select(zero(of.format), of);
            i.estimate.select((before + more).resize(of.format, Wrap), of)
        };
        let (sum, force_sum) = (sum(r.sum, i.capacitance), sum(r.force_sum, i.measured));
        // Saturated where a pad's first quadrants have not been seen.
        let quarter = |of: Signal<V>, to: Format| of.scaled(-2).quantize(to, HalfEven, Saturate);
        let [invalid, lifted] = [(r.invalid, i.invalid), (r.lifted, i.lifted)]
            .map(|(before, now)| i.estimate.select((!first & before) | now, before));
        Registers {
            pad: i.estimate.select(i.pad, r.pad),
            left: first.select(i.capacitance, r.left),
            right: second.select(i.capacitance, r.right),
            third: third.select(i.capacitance, r.third),
            fourth: last.select(i.capacitance, r.fourth),
            sum,
            force_sum,
            along_y: !i.estimate & r.along_y,
            invalid,
            unknown: last.select(invalid, r.unknown),
            lifted,
            released: last.select(lifted, r.released),
            capacitance: last.select(quarter(sum, self.capacitance), r.capacitance),
            measured: last.select(quarter(force_sum, self.force), r.measured),
            asked: last,
            ..r
        }
    }

    /// What memories say of the pad that was asked for: the place from its wall, and whether it is
    /// driven.
    #[inline(always)]
    fn located<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        i: &In<V>,
        r: &Regs<V>,
        next: Regs<V>,
    ) -> Regs<V> {
        let within = &mut state.submodules;
        let [place, surface] =
            [self.places.data(&mut within.places), self.surfaces.data(&mut within.surfaces)];
        let write = Write {
            enable: i.placed,
            address: i.placed_pad,
            data: i.place.bits(0, self.position.width),
        };
        let number = self.number(r);
        let place_number = r.found.select(self.before(r.pad), r.pad);
        self.places.access(&mut within.places, place_number, write);
        let write = Write {
            enable: i.wall.wall_write,
            address: i.wall.wall_pad,
            data: i.wall.wall_right.concat(i.wall.wall_surface.bits(0, self.position.width)),
        };
        self.surfaces.access(&mut within.surfaces, number, write);
        let turned = if self.has_quadrants() { r.along_y } else { bit(false) };
        let along_word = (r.crossed & !turned).select(place, r.along_word);
        let next = Registers {
            place_word: r.found.select(turned.select(r.along_word, place), r.place_word),
            surface_word: r.found.select(surface, r.surface_word),
            along_word: (r.found & turned).select(r.place_word, along_word),
            ..next
        };
        let surface = r.surface_word.bits(0, self.position.width).as_code(self.position);
        Registers {
            found: r.asked,
            crossed: r.found,
            start: r.crossed,
            placed: r.crossed.select(r.met, r.placed),
            depth: r.crossed.select(r.place_word.as_code(self.position) - surface, r.depth),
            mirrored: r.crossed.select(r.surface_word.bits(self.position.width, 1), r.mirrored),
            rests: r.found.select(marks::is_marked(r.resting_pads, r.pad), r.rests),
            ..self.marked(r, i, number, next)
        }
    }
}

impl SplitPad {
    /// What is marked of pads after this clock, and whether the pad that is asked for has a place and a wall.
    #[inline(always)]
    fn marked<V: Interpretation>(
        &self,
        r: &Regs<V>,
        i: &In<V>,
        number: Signal<V>,
        next: Regs<V>,
    ) -> Regs<V> {
        let placed = marks::unless(i.clear, r.placed_pads);
        let walled = marks::unless(i.begins_anew, r.walled_pads);
        let resting = marks::unless(i.clear, r.resting_pads);
        let has_place =
            marks::is_marked(placed, r.pad) & marks::is_marked(placed, self.before(r.pad));
        let met = has_place & marks::is_marked(walled, number);
        let write = (i.placed & !i.clear, i.placed_pad);
        let wall_write = (i.wall.wall_write, i.wall.wall_pad);
        Registers {
            placed_pads: marks::written(placed, write, bit(true)),
            walled_pads: marks::written(walled, wall_write, bit(true)),
            resting_pads: marks::written(resting, (i.driven & !i.clear, r.pad), i.rests),
            met: r.asked.select(met, r.met),
            ..next
        }
    }
}

/// The mean of two.
#[inline(always)]
fn mean<V: Interpretation>(a: Signal<V>, b: Signal<V>) -> Signal<V> {
    (a + b).scaled(-1).quantize(a.format, HalfEven, Proved)
}

/// A sum of four.
#[inline(always)]
const fn four(of: Format) -> Format {
    Format { width: of.width + 2, ..of }
}

impl SplitPad {
    /// The number by which the wall is known whose turn it is.
    #[inline(always)]
    fn number<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        if !self.has_quadrants() {
            return r.pad;
        }
        r.along_y.select(self.before(r.pad), r.pad)
    }

    /// The number before that of a pad's last part, by which its place along y is known.
    #[inline(always)]
    fn before<V: Interpretation>(&self, pad: Signal<V>) -> Signal<V> {
        (pad - int(1)).resize(self.pad(), Wrap)
    }

    /// Capacitances on the left and on the right, or at the bottom and at the top.
    #[inline(always)]
    fn sides<V: Interpretation>(&self, r: &Regs<V>) -> [Signal<V>; 2] {
        if !self.has_quadrants() {
            return [r.left, r.right];
        }
        let [top_left, bottom_left, bottom_right, top_right] = [r.left, r.right, r.third, r.fourth];
        let y = r.along_y;
        [
            mean(y.select(bottom_right, top_left), bottom_left),
            mean(y.select(top_left, bottom_right), top_right),
        ]
    }

    /// The wall's inputs.
    #[inline(always)]
    fn to_wall<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> sided_wall::In<V> {
        let [left, right] = self.sides(r);
        let factory = match self.has_quadrants() {
            true => r.along_y.select(zero(i.wall.wall_factory.format), i.wall.wall_factory),
            false => i.wall.wall_factory,
        };
        let other_free = match self.has_quadrants() {
            true => r.along_y.select(r.free, marks::is_marked(r.free_pads, r.pad)),
            false => bit(false),
        };
        sided_wall::Inputs {
            start: r.start,
            pad: self.number(r),
            restart: i.wall.wall_restart | !r.placed,
            left,
            right,
            trusted: r.placed & !r.invalid & !r.lifted,
            depth: r.depth,
            along: r.along_word.as_code(self.position),
            other_free,
            mirrored: r.mirrored,
            at_zero: r.rests,
            stiffness: i.wall.wall_stiffness,
            most: i.wall.wall_most,
            factory,
        }
    }
}

impl Block for SplitPad {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let walled = call!(self.wall, state, self.to_wall(&r, &i));
        let outputs = Outputs {
            done: walled.done,
            capacitance: r.capacitance,
            measured: r.measured,
            invalid: r.unknown,
            lifted: r.released,
            target: walled.target,
            free: walled.free,
            reads: walled.valid,
        };
        let outputs = if self.has_quadrants() { of_both(outputs, &r) } else { outputs };
        let written = i.placed | i.driven | i.wall.wall_write | i.clear | i.begins_anew;
        let turns = if self.has_quadrants() { walled.done } else { bit(false) };
        if (i.estimate | self.under_way(&r) | written | turns).can_skip() {
            return outputs;
        }
        let gathered = self.gathered(r, &i);
        let gathered =
            if self.has_quadrants() { turned(gathered, &r, walled, i.clear) } else { gathered };
        let next = self.located(state, &i, &r, gathered);
        state.store(self, next);
        outputs
    }
}

/// What both walls of a pad give: the larger force, and whether the user leaves either.
#[inline(always)]
fn of_both<V: Interpretation>(along: Out<V>, r: &Regs<V>) -> Out<V> {
    Outputs {
        done: along.done & r.along_y,
        target: along.target.less_than(r.target).select(r.target, along.target),
        free: along.free | r.free,
        ..along
    }
}

/// The registers where the wall along x is done: that along y is asked for.
#[inline(always)]
fn turned<V: Interpretation>(
    next: Regs<V>,
    r: &Regs<V>,
    walled: sided_wall::Out<V>,
    clear: Signal<V>,
) -> Regs<V> {
    let turns = walled.done & !r.along_y;
    let free_pads = marks::unless(clear, r.free_pads);
    Registers {
        asked: next.asked | turns,
        along_y: next.along_y | turns,
        target: turns.select(walled.target, r.target),
        free: turns.select(walled.free, r.free),
        free_pads: marks::written(free_pads, (walled.done & r.along_y, r.pad), walled.free),
        ..next
    }
}

#[cfg(test)]
mod tests;
