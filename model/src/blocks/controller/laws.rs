// SPDX-License-Identifier: MIT OR Apache-2.0
//! The steps of each law: the operands of its products, what becomes of them, and the drive that
//! the law wants.

use super::tasks::Task;
use super::{Controller, In, Registers, Regs};
use hapticore_contract::control::Law;
use hapticore_hdl::block::Interpretation;
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::{HalfEven, Proved, Saturate, Signal, Wrap, code, int, zero};

/// What memories and blocks within give.
pub(super) struct Found<V> {
    /// Product of the last operands, an integer.
    pub product: Signal<V>,
    /// Square root that is done.
    pub root: Signal<V>,
    /// A word of the curve.
    pub curve: Signal<V>,
    /// Of the pad: it has been lifted, and its drive has not been what its law wants since.
    pub rises: Signal<V>,
    /// Of the pad: invalid estimates in a row.
    pub invalid: Signal<V>,
    /// Of the pad: its drive word, at most the rail.
    pub last: Signal<V>,
    /// Of the pad: the root of its last target.
    pub asked: Signal<V>,
    /// Of the pad: all of these, as they are in its memory, zero where it is not known.
    pub pad_word: Signal<V>,
    /// Of the pad: what corrects its curve.
    pub correction: Signal<V>,
}

impl Controller {
    /// What the square root is taken of: target or force, moved down below one, or the quotient.
    #[inline(always)]
    pub(super) fn radicand<V: Interpretation>(
        &self,
        r: &Regs<V>,
        i: &In<V>,
        quotient: Signal<V>,
    ) -> Signal<V> {
        let small = |force: Signal<V>| force.scaled(-self.shift).resize(self.radicand, Proved);
        match self.law {
            Law::Open | Law::Proportional => small(i.target),
            Law::Inverse => r.task.at(Task::InverseRoot).select(quotient, small(self.rooted(r, i))),
            Law::Integral => small(self.rooted(r, i)),
        }
    }

    /// The force whose root is taken: the target, or what is measured.
    #[inline(always)]
    fn rooted<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> Signal<V> {
        let measured = i.measured.quantize(self.measured_format(), HalfEven, Saturate);
        r.task.at(Task::ForceRoot).select(measured, i.target)
    }

    /// Operands of the next product, as integers.
    #[inline(always)]
    pub(super) fn operands<V: Interpretation>(
        &self,
        r: &Regs<V>,
        i: &In<V>,
        found: &Found<V>,
    ) -> (Signal<V>, Signal<V>) {
        let at = |task: Task| r.task.at(task);
        let (rise, part) =
            ((found.curve - r.curve_drive).integer(), r.root.bits(0, self.part_format().width));
        let (left, right) = match self.law {
            Law::Open => (rise, part),
            Law::Proportional | Law::Integral => {
                let (error, corrected) =
                    (self.error(r, i).integer(), self.corrected(r, found).integer());
                let gain = at(Task::Error).select(i.tuning.proportional, i.tuning.correction);
                let left = at(Task::Error).select(error, at(Task::Correct).select(corrected, rise));
                (left, at(Task::Interpolate).select(part, gain.integer()))
            }
            Law::Inverse => {
                let (capacitance, target) = (i.capacitance.integer(), i.target.integer());
                let choose = |first, second, third, fourth| {
                    let others = at(Task::Stiffness).select(third, fourth);
                    at(Task::Interpolate).select(first, at(Task::Square).select(second, others))
                };
                let (gain, drive) = (i.force_gain.integer(), i.tuning.full_drive.integer());
                let left = choose(rise, capacitance, r.factor, target);
                let right = choose(part, capacitance, gain, drive);
                let trim = r.correction.quantize(self.trim_format(), HalfEven, Saturate);
                let trimmed = |other, correct: Signal<V>, trim: Signal<V>| {
                    let others = at(Task::Trim).select(trim.integer(), other);
                    at(Task::Correct).select(correct.integer(), others)
                };
                (
                    trimmed(left, r.error, trim),
                    trimmed(right, i.tuning.correction, self.untrimmed(r)),
                )
            }
        };
        (left.resize(self.left, Proved), right.resize(self.right, Proved))
    }

    /// The inverse law's drive without its trim.
    #[inline(always)]
    fn untrimmed<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        r.root.at_most(r.curve_drive)
    }

    /// F_t − F, or √F_t − √F.
    #[inline(always)]
    fn error<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> Signal<V> {
        if self.law == Law::Integral {
            return r.error;
        }
        (i.target - i.measured).quantize(self.error_format(), HalfEven, Saturate)
    }

    /// What the correction's gain takes: the filter's difference, or the error.
    #[inline(always)]
    fn corrected<V: Interpretation>(&self, r: &Regs<V>, found: &Found<V>) -> Signal<V> {
        if self.law == Law::Integral {
            return r.error;
        }
        (r.proportional - found.correction).quantize(self.correction_format(), HalfEven, Saturate)
    }

    /// Takes what a task that ends has found.
    #[inline(always)]
    pub(super) fn take<V: Interpretation>(
        &self,
        r: Regs<V>,
        found: &Found<V>,
        ends: Signal<V>,
    ) -> Regs<V> {
        let at = |task: Task| ends & self.at(&r, task);
        let root = found.root.resize(self.fine, Saturate);
        let signed = self.correction_format();
        let rise = self.narrow(found, (signed, self.part_format()), signed);
        let curve = (r.curve_drive + rise).resize(self.fine, Saturate);
        let lower = found.curve.resize(self.fine, Proved);
        let next = Registers {
            root: (at(Task::Root) | at(Task::InverseRoot)).select(root, r.root),
            curve_drive: at(Task::Curve)
                .select(lower, at(Task::Interpolate).select(curve, r.curve_drive)),
            ..r
        };
        match self.law {
            Law::Open => next,
            Law::Proportional | Law::Integral => self.take_feedback(next, found, root, at),
            Law::Inverse => self.take_inverse(next, found, root, at),
        }
    }

    /// A product of a word of what is corrected, or of a rise, narrowed.
    #[inline(always)]
    fn narrow<V: Interpretation>(
        &self,
        found: &Found<V>,
        (left, right): (Format, Format),
        to: Format,
    ) -> Signal<V> {
        found.product.as_code(left.product(right)).quantize(to, HalfEven, Saturate)
    }

    #[inline(always)]
    fn take_feedback<V: Interpretation>(
        &self,
        r: Regs<V>,
        found: &Found<V>,
        root: Signal<V>,
        at: impl Fn(Task) -> Signal<V>,
    ) -> Regs<V> {
        let of = (self.error_format(), self.gain);
        let scaled = self.narrow(found, of, self.correction_format());
        let next = Registers {
            proportional: at(Task::Error).select(scaled, r.proportional),
            correction: at(Task::Correct).select(self.stepped(found), r.correction),
            ..r
        };
        if self.law == Law::Proportional {
            return next;
        }
        let error = (r.root - root).resize(self.error_format(), Proved);
        Registers { error: at(Task::ForceRoot).select(error, r.error), ..next }
    }

    /// The correction that the pad has kept, and this frame's step.
    #[inline(always)]
    fn stepped<V: Interpretation>(&self, found: &Found<V>) -> Signal<V> {
        let of = (self.corrected_format(), self.gain);
        let step = self.narrow(found, of, self.kept_format());
        (found.correction + step).resize(self.kept_format(), Saturate)
    }

    /// A trim's error is that of the drive before, which the force is of. It is limited, so that a pad that is pulled in
    /// moves it little. A target of zero, which any trim of the drive gives, has none.
    #[inline(always)]
    fn take_inverse<V: Interpretation>(
        &self,
        r: Regs<V>,
        found: &Found<V>,
        root: Signal<V>,
        at: impl Fn(Task) -> Signal<V>,
    ) -> Regs<V> {
        let square = self.narrow(found, (self.capacitance, self.capacitance), self.square);
        let of = (self.square, self.force_gain);
        let stiffness = self.narrow(found, of, self.stiffness_format());
        let numerator = self.narrow(found, (self.target, self.gain), self.numerator_format());
        let kept = at(Task::Stiffness).select(stiffness.integer(), r.factor);
        let error = (found.asked - root).resize(self.error_format(), Saturate);
        let error = found.asked.is(0).select(zero(self.error_format()), error);
        let of = (self.trim_format(), self.drive);
        let trim = self.narrow(found, of, self.correction_format());
        Registers {
            asked: at(Task::ForceRoot).select(r.root, r.asked),
            error: at(Task::ForceRoot).select(error, r.error),
            correction: at(Task::Correct).select(self.stepped(found), r.correction),
            proportional: at(Task::Trim).select(trim, r.proportional),
            factor: at(Task::Square).select(square.integer(), kept),
            numerator: at(Task::Target).select(numerator, r.numerator),
            ..r
        }
    }

    /// What the correction comes on top of: the curve, and what is proportional to the error.
    #[inline(always)]
    fn base<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        match self.law {
            Law::Integral => r.curve_drive + r.proportional,
            _ => r.curve_drive,
        }
    }

    /// The drive within 0 and the rail, and whether it should be below or beyond.
    #[inline(always)]
    pub(super) fn wanted<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> [Signal<V>; 3] {
        let base = self.base(r);
        let wanted = match self.law {
            Law::Open => base,
            Law::Inverse => self.untrimmed(r) + r.proportional,
            Law::Proportional | Law::Integral => base + r.correction,
        };
        let touches = !i.lifted;
        let low = touches & wanted.less_than(int(0));
        let high = touches & i.tuning.rail.less_than(wanted);
        // Where it wraps, it is low or high.
        let rounded = wanted.quantize(self.drive, HalfEven, Wrap);
        let within = high.select(i.tuning.rail, rounded);
        [low.select(zero(self.drive), within), low, high]
    }

    /// The correction that the pad keeps. Where a limit holds the drive and the step goes further against
    /// it, it goes as far as the limit lets it, but never back: nothing winds up.
    #[inline(always)]
    pub(super) fn kept_correction<V: Interpretation>(
        &self,
        r: &Regs<V>,
        drive: Signal<V>,
        before: Signal<V>,
    ) -> Signal<V> {
        let held_below = r.high | drive.less_than(r.wanted);
        let held_above = r.low | r.wanted.less_than(drive);
        let falls = r.correction.less_than(before);
        let against = falls.select(held_above, held_below);
        // A trim is no drive.
        if self.law == Law::Inverse {
            return against.select(before, r.correction);
        }
        let limit = (drive - self.base(r)).resize(self.kept_format(), Saturate);
        let lets = falls.select(limit.less_than(before), before.less_than(limit));
        against.select(lets.select(limit, before), r.correction)
    }

    /// The drive word: as wanted where the estimate is valid, but no further from the last than the slew limit;
    /// zero where it is void or the pad is lifted.
    #[inline(always)]
    pub(super) fn limited<V: Interpretation>(
        &self,
        r: &Regs<V>,
        i: &In<V>,
        last: Signal<V>,
    ) -> Signal<V> {
        let to = i.invalid.select(last, r.wanted);
        let up = r.most.less_than(to).select(r.most, to);
        let down = to.less_than(r.least).select(r.least, to);
        let slewed = last.less_than(to).select(up, down);
        (r.void | i.lifted).select(zero(self.drive), slewed)
    }

    /// The least and the largest drive word that the slew limit allows after the last. While the pad
    /// rises after contact it is at most that of a contact, whatever the host's is.
    #[inline(always)]
    pub(super) fn slewed<V: Interpretation>(&self, i: &In<V>, found: &Found<V>) -> [Signal<V>; 2] {
        let (last, slew) = (found.last, i.tuning.slew);
        let up = found.rises.select(slew.at_most(code(self.contact_slew, self.drive)), slew);
        let least = (last - slew).resize(self.drive, Saturate);
        [least, (last + up).resize(self.drive, Saturate)]
    }

    /// Whether the pad rises still: from contact until its drive is what its law wants.
    #[inline(always)]
    pub(super) fn rises<V: Interpretation>(
        &self,
        r: &Regs<V>,
        i: &In<V>,
        before: Signal<V>,
        drive: Signal<V>,
    ) -> Signal<V> {
        i.lifted | (before & (i.invalid | drive.less_than(r.wanted)))
    }
}
