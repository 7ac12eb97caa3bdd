// SPDX-License-Identifier: MIT OR Apache-2.0
//! The steps of the wall's rule, each one clock: equations at the head of the block.

use super::{
    CHANGE, EVIDENCE, FAST, FRAMES, FRICTION, GAIN, In, Kept, LEARNT, OFFSET, Pressed, Registers,
    Regs, U, Wall, Y,
};
use hapticore_contract::profile::Release;
use hapticore_hdl::block::Interpretation;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::{
    Assumed, HalfEven, Proved, Saturate, Signal, Wrap, bit, code, int, zero,
};
use hapticore_hdl::when;

/// The code of a number of a format, to the nearest.
fn nearest(real: f64, format: Format) -> i64 {
    format.code_saturating(real)
}

/// A constant by its number.
#[inline(always)]
pub(super) fn number<V: Interpretation>(real: f64, format: Format) -> Signal<V> {
    code(nearest(real, format), format)
}

/// What intervals cannot see of a mean whose terms are taken apart.
const MEAN: &str = "a mean of old and new value lies between them";

/// The mean of an old value and a new one that has a share of 2^−shift. Shifts and a difference take
/// no multiplier.
#[inline(always)]
pub(super) fn filtered<V: Interpretation>(
    old: Signal<V>,
    new: Signal<V>,
    shift: u8,
    to: Format,
) -> Signal<V> {
    let sum = old.scaled(shift as i8) - old + new;
    sum.scaled(-(shift as i8)).quantize(to, HalfEven, Assumed(MEAN))
}

/// A signal times a constant: a sum of shifted ones, which takes no multiplier.
#[inline(always)]
fn times<V: Interpretation>(signal: Signal<V>, constant: u64, to: Format) -> Signal<V> {
    let bits = (0..u64::BITS).filter(|bit| constant >> bit & 1 == 1);
    bits.fold(zero(to), |sum, bit| (sum + signal.scaled(bit as i8)).resize(to, Proved))
}

/// One more, up to `most`.
#[inline(always)]
pub(super) fn counted<V: Interpretation>(count: Signal<V>, most: u64) -> Signal<V> {
    count.at_least(int(most)).select(int(most), count + int(1)).resize(count.format, Wrap)
}

/// The direction is noisy.
#[inline(always)]
fn rough<V: Interpretation>(k: &Kept<Signal<V>>) -> Signal<V> {
    number(0.0055 / 0.886, CHANGE).less_than(k.change)
}

impl Wall {
    /// A pad at its first frame: nothing is known but where it is.
    #[inline(always)]
    pub(super) fn anew<V: Interpretation>(&self, i: &In<V>) -> Kept<Signal<V>> {
        let formats = self.kept_formats();
        Kept {
            last: i.x,
            filtered: i.x.resize(formats.filtered, Proved),
            u: i.factory,
            inwards: i.factory.resize(LEARNT, Proved),
            outwards: i.factory.resize(LEARNT, Proved),
            along: i.along.resize(formats.along, Proved),
            anchor: i.x.resize(formats.anchor, Proved),
            anchor_along: i.along.resize(formats.anchor_along, Proved),
            extreme: i.x.resize(formats.extreme, Proved),
            since: code(self.rule.dwell_frames as i64, formats.since),
            pressed: self.unpressed(i.factory, i.x),
            ..Kept::map(formats, zero)
        }
    }

    /// x̄, v, u and the time without voltage.
    #[inline(always)]
    pub(super) fn follow<V: Interpretation>(
        &self,
        r: Regs<V>,
        i: In<V>,
        quotient: Signal<V>,
    ) -> Regs<V> {
        let kept = r.kept;
        let before = kept.u;
        let any = !(i.c_left.is(0) & i.c_right.is(0));
        let reads = any & quotient.less_than(code(1 << 12, quotient.format));
        let negative = (i.c_right - i.c_left).msb();
        let read = negative.select(-quotient, quotient).resize(U, Wrap);
        let u = reads.select(read, kept.u);
        let zeros = self.rule.zero_frames;
        let kept = Kept {
            // A pad that has had no current yet may not have a place either.
            known: kept.known | any,
            last: i.x,
            filtered: filtered(kept.filtered, i.x, 2, self.filtered()),
            speed: filtered(kept.speed, i.x - kept.last, 3, self.speed()),
            along: filtered(kept.along, i.along, 2, self.filtered()),
            u,
            zero: i.at_zero.select(counted(kept.zero, zeros), zero(kept.zero.format)),
            pressed: Pressed { slow: self.slow(kept.pressed.slow, u), ..kept.pressed },
            ..kept
        };
        let moved = (u - before).abs().resize(r.moved.format, Wrap);
        Registers { kept, any, reads, moved, ..r }
    }

    /// What the direction reads in free air.
    #[inline(always)]
    pub(super) fn learn<V: Interpretation>(&self, r: Regs<V>) -> Regs<V> {
        let k = r.kept;
        let clear = number(1e-3 * self.rule.clear_um as f64, self.filtered());
        let speed = |sign: f64| number(sign * 1e-3 * self.rule.learn_um as f64, self.speed());
        let learns = r.reads & clear.less_than(k.filtered) & k.zero.is(self.rule.zero_frames);
        let inwards = learns & k.speed.less_than(speed(-1.0));
        let outwards = learns & speed(1.0).less_than(k.speed);
        // It moves one way at most, so that one filter serves both: by a quarter at first, then by 1/64.
        let of = inwards.select(k.inwards, k.outwards);
        let frames = inwards.select(k.inwards_frames, k.outwards_frames);
        let slow = frames.is(FAST);
        let share = |of: Signal<V>| slow.select(of, of.scaled(4));
        let sum = of.scaled(6) - share(of) + share(k.u);
        let next = sum.scaled(-6).quantize(LEARNT, HalfEven, Assumed(MEAN));
        let counted = counted(frames, FAST);
        let side = |learns: Signal<V>, of: Signal<V>, frames: Signal<V>| {
            (learns.select(next, of), learns.select(counted, frames))
        };
        let (in_u, inwards_frames) = side(inwards, k.inwards, k.inwards_frames);
        let (out_u, outwards_frames) = side(outwards, k.outwards, k.outwards_frames);
        let change = learns.select(filtered(k.change, r.moved, 6, CHANGE), k.change);
        let kept = Kept {
            change,
            inwards: in_u,
            inwards_frames: inwards_frames.resize(FRAMES, Proved),
            outwards: out_u,
            outwards_frames: outwards_frames.resize(FRAMES, Proved),
            ..k
        };
        Registers { kept, ..r }
    }

    /// off and b.
    #[inline(always)]
    pub(super) fn calibrate<V: Interpretation>(&self, r: Regs<V>, i: In<V>) -> Regs<V> {
        let k = r.kept;
        let [into, out] = [k.inwards_frames, k.outwards_frames].map(|frames| frames.is(FAST));
        let first = number(0.006, FRICTION);
        let least = number(0.0015, FRICTION);
        let learnt = (k.outwards - k.inwards).scaled(-1).resize(FRICTION, Saturate);
        let learnt = learnt.less_than(least).select(least, learnt);
        let middle = (k.inwards + k.outwards).scaled(-1);
        let of_one = into.select(k.inwards, k.outwards) + into.select(first, -first);
        let offset = (into & out).select(middle, (into | out).select(of_one, i.factory));
        Registers {
            offset: offset.resize(OFFSET, Proved),
            friction: (into & out).select(learnt, first),
            ..r
        }
    }

    /// y and the bias in standard deviations; time goes on.
    #[inline(always)]
    pub(super) fn weigh<V: Interpretation>(&self, r: Regs<V>) -> Regs<V> {
        let k = r.kept;
        let rough = rough(&k);
        let off = k.u - r.offset;
        let in_deviations = |of: Signal<V>, to: Format| {
            rough.select(of.scaled(7), of.scaled(8)).quantize(to, HalfEven, Saturate)
        };
        let most = r.friction.format.product(Format::unsigned(8, 4));
        let [delay, advance] = [self.rule.delay_16, self.rule.advance_16]
            .map(|sixteenths| times(r.friction.scaled(-4), sixteenths, most));
        let one = number(1.0, GAIN);
        let gain = match self.fades() {
            true => k.gain,
            false => {
                let gain = k.gain + self.gain_step();
                one.less_than(gain).select(one, gain).resize(GAIN, Wrap)
            }
        };
        let since = counted(k.since, self.rule.dwell_frames.max(1));
        Registers {
            y: r.reads.select(in_deviations(off, Y), zero(Y)),
            bias: in_deviations(k.free.select(delay, advance), EVIDENCE),
            kept: Kept { since, gain, ..k },
            ..r
        }
    }

    /// The step by which a gain comes back.
    #[inline(always)]
    pub(super) fn gain_step<V: Interpretation>(&self) -> Signal<V> {
        number((1.0f64 / self.rule.ramp_frames as f64).min(1.0), GAIN)
    }

    /// Evidence, and how far in or out the pad has been.
    #[inline(always)]
    pub(super) fn test<V: Interpretation>(&self, r: Regs<V>) -> Regs<V> {
        let k = r.kept;
        let half = number(0.5, EVIDENCE);
        let inside = k.filtered - k.extreme;
        let farther = k.free.select(int(0).less_than(inside), inside.less_than(int(0)));
        // S + y + b − ½, or E − y − b − ½.
        let push = self.heard(&k, r.y) + r.bias;
        let evidence = k.evidence - half + k.free.select(-push, push);
        let kept = Kept {
            extreme: farther.select(k.filtered, k.extreme),
            evidence: evidence.resize(EVIDENCE, Saturate),
            ..k
        };
        Registers { kept, ..r }
    }

    /// Whether evidence or play ends the state. A clock of its own, as sum and comparison in one clock would be the
    /// longest path of a force loop.
    #[inline(always)]
    pub(super) fn judge<V: Interpretation>(&self, r: Regs<V>) -> Regs<V> {
        let k = r.kept;
        let fast = |sign: f64| number(sign * 1e-3 * self.rule.fast_um as f64, self.speed());
        let play = number(1e-3 * self.rule.play_um as f64, self.filtered());
        let [h1, h2] = [self.rule.release, self.rule.engage].map(|h| number(h as f64, EVIDENCE));
        // How far inside of the extreme it is: of either state by the one difference.
        let inside = k.filtered - k.extreme;
        let back = k.free.select(inside.less_than(-play), play.less_than(inside));
        let evidence = k.evidence;
        let releases = h1.less_than(evidence);
        let [inwards, outwards] = [k.speed.less_than(fast(-1.0)), fast(1.0).less_than(k.speed)];
        let engages = h2.less_than(evidence) & !outwards;
        let decided = k.free.select(engages, releases & !inwards) | back;
        let held = !k.free & inwards & releases;
        let over = match self.rule.dwell_frames {
            0 => bit(true),
            dwell => k.since.is(dwell),
        };
        let kept = Kept { evidence: held.select(h1, evidence), ..k };
        self.doubted(Registers { kept, leaves: decided & over, ..r }, rough(&k))
    }

    /// The state of the next frames.
    #[inline(always)]
    pub(super) fn decide<V: Interpretation>(&self, r: Regs<V>, i: In<V>) -> Regs<V> {
        let outside = !i.x.less_than(int(0));
        match self.rule.rule {
            Release::Sequential => self.decide_by_test(r, outside),
            Release::Never => self.decided(r, bit(false)),
            // The push leads out where it reads more than without one.
            Release::Direct => self.decided(r, !outside & int(0).less_than(r.y)),
        }
    }

    /// The state of rules that keep none.
    #[inline(always)]
    fn decided<V: Interpretation>(&self, r: Regs<V>, free: Signal<V>) -> Regs<V> {
        let kept = Kept { free, gain: number(1.0, GAIN), ..r.kept };
        Registers { kept, ..r }
    }

    #[inline(always)]
    fn decide_by_test<V: Interpretation>(&self, r: Regs<V>, outside: Signal<V>) -> Regs<V> {
        let k = r.kept;
        let enters = outside | r.leaves;
        let dwell = code(self.rule.dwell_frames as i64, k.since.format);
        // By a rule that lets forces fall a dwell goes on outside.
        let outside_since = if self.fades() { k.since } else { dwell };
        let since = outside.select(outside_since, r.leaves.select(zero(k.since.format), k.since));
        let restarts = r.leaves & k.free;
        // Of what is free neither gain nor push counts: both begin anew when it engages.
        let goes_on = if self.fades() { self.pressed(&r) } else { k };
        let gain = outside.select(number(1.0, GAIN), restarts.select(zero(GAIN), goes_on.gain));
        let gain = r.slides.select(zero(GAIN), gain);
        let free = !outside & (r.leaves.select(!k.free, k.free));
        let kept = Kept {
            free,
            pressed: when!(enters => self.begun(&k), else goes_on.pressed),
            evidence: enters.select(zero(EVIDENCE), k.evidence),
            extreme: enters.select(k.filtered, k.extreme),
            since,
            gain,
            ..k
        };
        Registers { kept, ..r }
    }
}
