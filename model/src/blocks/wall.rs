// SPDX-License-Identifier: MIT OR Apache-2.0
//! Wall: the force of a virtual wall on a pad, and whether the user pushes into it or leaves.
//!
//! ```text
//! u = (C_R − C_L)/(C_R + C_L)                                            (paper, eq. 10 of two parts)
//! x̄ += (x − x̄)/4,   v += (Δx − v)/8                                      (mm, mm per frame)
//! y = clamp((u − off)/σ, ±4);   off, b: learnt in free air
//! PUSH: S = max(0, S + y + bf·b/σ − ½);  S > h1 or play outwards → FREE
//! FREE: E = max(0, E − y − ½ − kb·b/σ);  E > h2 or play inwards → PUSH, gain = 0
//! F = min(k_w·|x|, F_max)·gain,   gain = 0 where the pad slides along the surface   (docs/physics.md §6)
//! ```
//!
//! That is the rule `sequential`. With `quiet_frames`, as in rule B, the force of a stationary push that reads weaker
//! falls (`wall/pressed.rs`). By `never` the state stays PUSH (eq. 11, with a force that is linear in the depth), by
//! `direct` it is FREE in each frame within the wall where y > 0 (eq. 12).
//!
//! ```text
//! C_L, C_R ─(−, +)─[divider]─ u ─┐
//! x ─[follow]─ x̄, v ─[learn]─ off, b, σ ─[test]─ PUSH/FREE ─(k_w·|x|)─(× gain)─[round half even]─ force
//! x, y ─[motion since a point that follows]─ slides ─────────────────────────────┘
//! [state: 18 words of every pad, 22 where forces fall; the first has all bits] ─ loaded first, saved last
//! ```
//!
//! | signal | format | unit | overflow |
//! | u | s13.13 | – | cannot: not trusted beyond ½ |
//! | u_in, u_out | s20.19 | – | cannot: a mean |
//! | y | s11.8 | σ | saturates, meant |
//! | S, E | u14.8 | σ | saturates, meant |
//! | force | profile | N | saturates, then F_max holds it |
//!
//! Filters are powers of two, rounded half to even. A frame without current is not valid: the force
//! is 0, the safe side, for a wall that cannot be felt is better than one that holds. With a part
//! open (|u| ≥ ½) there is no evidence and play alone decides. A state word per field and pad is
//! kept in a memory; a pad that is lifted, or calibrated anew, is started anew by `restart`.
//! Latency: 2·words + divider + two products + 12 clocks from `start` to `done`, whatever the data.

use super::divider::{self, Divider};
use super::multiplier::{self, Multiplier};
use super::rests::Rests;
use crate::buildable::{fits, rounds};
use hapticore_contract::control::Walls;
use hapticore_contract::profile::{self, Profile, ProfileError};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{HalfEven, Proved, Saturate, Signal, Wrap, bit, int, zero};
use hapticore_hdl::states::States;
use hapticore_hdl::{block, bundle, call, next, states, when};

mod motion;
mod pressed;
mod rule;

use pressed::Pressed;

states! {
    /// The steps of a frame.
    pub enum Step {
        Idle, Load, Divide, Follow, Learn, Calibrate, Weigh, Test, Judge, Decide, Depth, Ramp, Save,
    }
}

bundle! {
    /// What is kept of a pad from frame to frame.
    pub struct Kept {
        /// The pad has had a frame.
        known,
        /// Last position, mm from the wall.
        last,
        /// Filtered position.
        filtered,
        /// Filtered speed, mm per frame.
        speed,
        /// Filtered place along the surface.
        along,
        /// The point that follows the filtered place at the distance of the play: across the surface and along it.
        anchor,
        anchor_along,
        /// The user left the pad's other wall in the last frame.
        other_free,
        /// The user left the pad's other wall, and the pad has not gone into this one since.
        turned,
        /// Last direction that could be read.
        u,
        /// Mean |Δu| in free air.
        change,
        /// Frames without voltage.
        zero,
        /// Direction in free air when moving inwards, and how many frames it has had.
        inwards,
        inwards_frames,
        /// The same when moving outwards.
        outwards,
        outwards_frames,
        /// FREE.
        free,
        /// S or E.
        evidence,
        /// Filtered position farthest in (PUSH) or out (FREE).
        extreme,
        /// Frames in the state.
        since,
        /// Gain of the force.
        gain,
        pressed as Pressed,
    }
}

block! {
    /// The wall of all pads.
    pub struct Wall("wall") {
        rule: profile::Wall,
        pad: Format,
        position: Format,
        capacitance: Format,
        force: Format,
        left: Format,
        /// Words of a pad.
        words: u64,
    }
    submodules {
        divider: Divider,
        multiplier: Multiplier,
        kept: Memory,
    }
    inputs(wall) {
        /// Begins a pad's frame; all others are valid and stable until `done`.
        start: BIT,
        /// Pad of the frame.
        pad: wall.pad,
        /// The pad starts anew: lifted and put back, or calibrated.
        restart: BIT,
        /// Capacitance of the left part that senses, pF.
        c_left: wall.capacitance,
        /// Capacitance of the right part that senses, pF.
        c_right: wall.capacitance,
        /// Position from the wall's surface, mm; negative within.
        x: wall.position,
        /// Place along the wall's surface, mm.
        along: wall.position,
        /// The user leaves the pad's other wall.
        other_free: BIT,
        /// The haptic voltage was zero in the frame.
        at_zero: BIT,
        /// Stiffness of the wall, N/mm.
        stiffness: STIFFNESS,
        /// Largest force of the wall, N.
        most: wall.force,
        /// What u reads without a push as the device left the factory.
        factory: U,
    }
    outputs(wall) {
        /// Asserted for one cycle when the results are valid.
        done: BIT,
        /// Force target of the pad, N.
        target: wall.force,
        /// The user leaves the wall; else pushes into it or is outside.
        free: BIT,
        /// The direction was read from current.
        valid: BIT,
    }
    registers(wall) {
        step in Step,
        count: wall.count(),
        kept as Kept: wall.kept_formats(),
        /// There is current.
        any: BIT,
        /// The direction is to be trusted.
        reads: BIT,
        /// |Δu|.
        moved: Format::unsigned(13, 13),
        /// The way from the point that follows: into the wall, and along its surface.
        normal: wall.motion(),
        tangential: wall.motion(),
        /// The pad slides along the surface.
        slides: BIT,
        /// What the direction reads without a push.
        offset: OFFSET,
        /// Half the asymmetry that friction makes.
        friction: FRICTION,
        y: Y,
        /// The bias of the evidence.
        bias: EVIDENCE,
        /// The state is to be left.
        leaves: BIT,
        /// The pad slips inwards.
        slips: BIT.where_present(wall.fades()),
        /// The push has become weaker since it did.
        weaker: BIT.where_present(wall.fades()),
        target: wall.force,
        free: BIT,
        valid: BIT,
        done: BIT,
    }
}

const STIFFNESS: Format = Walls::STIFFNESS;
const U: Format = Walls::DIRECTION;
const LEARNT: Format = Format::signed(20, 19);
const CHANGE: Format = Format::unsigned(19, 19);
const OFFSET: Format = Format::signed(22, 20);
const FRICTION: Format = Format::unsigned(21, 20);
const Y: Format = Format::signed(11, 8);
const EVIDENCE: Format = Format::unsigned(14, 8);
const GAIN: Format = Format::unsigned(11, 10);
/// Frames that are learnt fast.
const FAST: u64 = 16;
const FRAMES: Format = Format::counter(FAST);

/// A sum one bit longer than its terms.
const fn sum(capacitance: Format) -> Format {
    Format::unsigned(capacitance.width + 1, capacitance.frac)
}

impl Wall {
    /// The wall of a profile, by rule A where the profile has none.
    ///
    /// # Errors
    /// Words that the model cannot hold.
    pub fn try_new(profile: &Profile) -> Result<Self, ProfileError> {
        let (rule, f) = (profile.wall.unwrap_or_default(), &profile.formats);
        let (position, capacitance, force) = (f.position, f.capacitance, f.force);
        let divider = Divider::new(capacitance, sum(capacitance), Format::unsigned(14, 13));
        fits("formats.capacitance", "the dividend of a direction", divider.dividend.width)?;
        let left = Format::unsigned(position.width.max(force.width), 0);
        let multiplier = Multiplier::new(left, STIFFNESS.integer(), profile.multiplier);
        let pad = Format::counter(profile.pads - 1);
        let empty = Memory::new("kept", 0, BIT);
        let mut block = Wall {
            words: 1,
            rule,
            pad,
            position,
            capacitance,
            force,
            left,
            divider,
            multiplier,
            kept: empty,
        };
        let mut width = 1;
        Kept::map(block.kept_formats(), |format| {
            width = width.max(format.width);
            block.words += u64::from(!format.is_none() && format != BIT);
        });
        fits("formats.position", "what is kept of it", width + 8)?;
        let [stiff, ramped] = block.products();
        rounds("formats.force", "the product of depth and stiffness", stiff, force)?;
        rounds("formats.force", "the product of force and gain", ramped, force)?;
        let words = 1 << (pad.width + block.index().width);
        let kept = Memory::new("kept", words, Format::unsigned(width, 0)).dont_care_on_collision();
        Ok(Wall { kept, ..block })
    }

    /// Depth times stiffness, and force times gain.
    fn products(&self) -> [Format; 2] {
        [depth(self.position).product(STIFFNESS), self.force.product(GAIN)]
    }

    /// The filtered position: four fractional bits more than the position.
    #[inline(always)]
    fn filtered(&self) -> Format {
        Format::signed(self.position.width + 4, self.position.frac + 4)
    }

    #[inline(always)]
    fn speed(&self) -> Format {
        Format::signed(self.position.width + 7, self.position.frac + 6)
    }

    /// A difference of filtered places.
    #[inline(always)]
    fn motion(&self) -> Format {
        Format::signed(self.position.width + 5, self.position.frac + 4)
    }

    #[inline(always)]
    fn kept_formats(&self) -> Kept<Format> {
        Kept {
            known: BIT,
            last: self.position,
            filtered: self.filtered(),
            speed: self.speed(),
            along: self.filtered(),
            anchor: self.filtered(),
            anchor_along: self.filtered(),
            other_free: BIT,
            turned: BIT,
            u: U,
            change: CHANGE,
            zero: Format::counter(self.rule.zero_frames),
            inwards: LEARNT,
            inwards_frames: FRAMES,
            outwards: LEARNT,
            outwards_frames: FRAMES,
            free: BIT,
            evidence: EVIDENCE,
            extreme: self.filtered(),
            since: Format::counter(self.rule.dwell_frames.max(1)),
            gain: GAIN,
            pressed: self.pressed_formats(),
        }
    }

    /// The number of a word.
    #[inline(always)]
    fn index(&self) -> Format {
        Format::counter(self.words - 1)
    }

    /// The number of the last clock of a step.
    #[inline(always)]
    fn last(&self, step: Step) -> u64 {
        match step {
            Step::Load => self.words,
            Step::Divide => self.divider.latency(),
            Step::Depth | Step::Ramp => self.multiplier.latency(),
            Step::Save => self.words - 1,
            _ => 0,
        }
    }

    #[inline(always)]
    fn count(&self) -> Format {
        Format::counter(self.words.max(self.divider.latency()))
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        Step::ALL[1..].iter().map(|step| self.last(*step) + 1).sum::<u64>() + 1
    }

    /// The clock is the last of its step.
    #[inline(always)]
    fn ends<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        let ends = |step: Step| r.step.at(step) & r.count.is(self.last(step));
        Step::ALL[1..].iter().fold(bit(false), |any, step| any | ends(*step))
    }

    /// What is kept of the pad, with the word that has been read last, while it is loaded. The first
    /// word has all bits, and says whether the pad is known; a pad that is not, or starts anew, has words of its own.
    #[inline(always)]
    fn loaded<V: Interpretation>(
        &self,
        r: &Regs<V>,
        i: &In<V>,
        word: Signal<V>,
    ) -> Kept<Signal<V>> {
        let anew = self.anew(i);
        let of_pad = r.kept.known.select(word, self.word(r, anew, 1));
        let is_first = r.count.is(1);
        let known = word.bits(0, 1) & !i.restart;
        let (mut index, mut place) = (1, 0);
        Kept::map(Kept::zip(r.kept, anew), |(old, first)| {
            if old.format.is_none() {
                return old;
            }
            if old.format == BIT {
                place += 1;
                return is_first.select(known.select(word.bits(place - 1, 1), first), old);
            }
            index += 1;
            let word = of_pad.bits(0, old.format.width).as_code(old.format);
            r.count.is(index).select(word, old)
        })
    }

    /// The word of this clock, where the first one is that of count `from`.
    #[inline(always)]
    fn word<V: Interpretation>(&self, r: &Regs<V>, kept: Kept<Signal<V>>, from: u64) -> Signal<V> {
        let (mut index, mut word, mut bits) = (from, zero(self.kept.format), None::<Signal<V>>);
        Kept::map(kept, |of| {
            if of.format.is_none() {
                return;
            }
            if of.format == BIT {
                bits = Some(bits.map_or(of, |low| of.concat(low)));
                return;
            }
            index += 1;
            let code = of.bits(0, of.format.width).resize(self.kept.format, Proved);
            word = r.count.is(index).select(code, word);
        });
        let bits = bits.expect("a pad is known, or is not").resize(self.kept.format, Proved);
        r.count.is(from).select(bits, word)
    }

    /// The registers after a step's last clock.
    #[inline(always)]
    fn step<V: Interpretation>(
        &self,
        r: Regs<V>,
        i: In<V>,
        quotient: Signal<V>,
        product: Signal<V>,
    ) -> Regs<V> {
        use Step::*;
        let at = |step: Step| r.step.at(step);
        let step = at(Save).select(Idle.signal(), r.step + int(1)).resize(r.step.format, Wrap);
        let r = Registers { step, count: int(0), done: at(Save), ..r };
        when!(
            at(Follow) => self.follow(r, i, quotient),
            at(Learn) => self.learn(self.moved(r, i)),
            at(Calibrate) => self.calibrate(self.led(r, i), i),
            at(Weigh) => self.weigh(self.judged(r, i)),
            at(Test) => self.test(r),
            at(Judge) => self.judge(r),
            at(Decide) => self.decide(r, i),
            at(Depth) => Registers { target: self.limited(i, product), ..r },
            at(Ramp) => self.ramped(r, product),
            else r
        )
    }

    /// min(k_w·|x|, F_max).
    #[inline(always)]
    fn limited<V: Interpretation>(&self, i: In<V>, product: Signal<V>) -> Signal<V> {
        let (force, _) = product.as_code(self.products()[0]).saturate(self.force, HalfEven);
        force.at_most(i.most)
    }

    /// The force with its gain, where the user pushes and there is current.
    #[inline(always)]
    fn ramped<V: Interpretation>(&self, r: Regs<V>, product: Signal<V>) -> Regs<V> {
        let force = product.as_code(self.products()[1]).quantize(self.force, HalfEven, Saturate);
        let acts = r.any & !r.kept.free;
        Registers {
            target: acts.select(force, zero(self.force)),
            free: r.kept.free,
            valid: r.any,
            ..r
        }
    }

    /// The multiplier's operands: depth and stiffness, then force and gain.
    #[inline(always)]
    fn operands<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> multiplier::In<V> {
        let within = i.x.less_than(int(0));
        let depth = within.select(i.x.abs(), zero(depth(self.position))).integer();
        let ramps = r.step.at(Step::Ramp);
        multiplier::Inputs {
            enable: ramps | r.step.at(Step::Depth),
            left: ramps.select(r.target.integer(), depth).resize(self.left, Proved),
            right: ramps
                .select(r.kept.gain.integer(), i.stiffness.integer())
                .resize(STIFFNESS.integer(), Proved),
        }
    }
}

/// The format of a distance into the wall.
#[inline(always)]
const fn depth(position: Format) -> Format {
    Format::unsigned(position.width, position.frac)
}

impl Rests for Wall {
    #[inline(always)]
    fn under_way<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        !r.step.at(Step::Idle) | r.done
    }
}

impl Block for Wall {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let Registers { done, target, free, valid, .. } = r;
        let outputs = Outputs { done, target, free, valid };
        if (i.start | self.under_way(&r)).can_skip() {
            return outputs;
        }
        let numerator = (i.c_right - i.c_left).abs().resize(self.capacitance, Proved);
        let denominator = i.c_left + i.c_right;
        let divides = r.step.at(Step::Divide) & r.count.is(0);
        let inputs = divider::Inputs { start: divides, numerator, denominator };
        let quotient = call!(self.divider, state, inputs).quotient;
        let product = call!(self.multiplier, state, self.operands(&r, &i)).product;
        let word = self.kept.data(&mut state.submodules.kept);
        let address = i.pad.concat(r.count.bits(0, self.index().width));
        let kept = self.with_force(r.kept, r.target);
        let write = Write { enable: r.step.at(Step::Save), address, data: self.word(&r, kept, 0) };
        self.kept.access(&mut state.submodules.kept, address, write);
        let idle = Registers { done: bit(false), ..r };
        let ends = self.ends(&r);
        let goes_on = Registers { count: r.count.increment(), ..idle };
        next!(self, state,
            i.start => Registers { step: Step::Load.signal(), count: int(0), ..idle },
            r.step.at(Step::Idle) => idle,
            r.step.at(Step::Load) => Registers {
                step: ends.select(Step::Divide.signal(), r.step),
                count: ends.select(int(0), goes_on.count),
                kept: self.loaded(&r, &i, word),
                ..idle
            },
            ends => self.step(idle, i, quotient, product),
            else goes_on
        );
        outputs
    }
}

#[cfg(test)]
pub(super) mod tests;
