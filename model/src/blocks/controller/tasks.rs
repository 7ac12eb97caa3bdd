// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tasks of a drive word, in the order of the law, and the clocks that each takes.
//!
//! ```text
//! product   count 0: operands are loaded;  1 …: multiplied;  then the product is narrowed
//! curve     count 0: the cell's lower word is asked for;  1: the upper one, while the lower is kept
//! √, ÷      until it is done
//! ```

use super::{Controller, Regs};
use hapticore_contract::control::Law;
use hapticore_hdl::block::Interpretation;
use hapticore_hdl::signal::{Signal, bit};
use hapticore_hdl::states;
use hapticore_hdl::states::States;

states! {
    /// The tasks of a drive word.
    pub enum Task {
        Idle, Root, Curve, Interpolate, Square, Stiffness, Target, Divide, InverseRoot, ForceRoot, Error,
        Correct, Trim, Combine, Limit,
    }
}

impl Task {
    /// The tasks of a law, in their order.
    pub(super) fn of(law: Law) -> &'static [Task] {
        use Task::*;
        match law {
            Law::Open => &[Root, Curve, Interpolate, Combine, Limit],
            Law::Proportional => &[Root, Curve, Interpolate, Error, Correct, Combine, Limit],
            Law::Integral => &[Root, Curve, Interpolate, ForceRoot, Error, Correct, Combine, Limit],
            Law::Inverse => &[
                Root,
                Curve,
                Interpolate,
                ForceRoot,
                Square,
                Stiffness,
                Target,
                Divide,
                InverseRoot,
                Correct,
                Trim,
                Combine,
                Limit,
            ],
        }
    }

    /// Whether it takes a product.
    fn multiplies(self) -> bool {
        use Task::*;
        matches!(self, Interpolate | Square | Stiffness | Target | Error | Correct | Trim)
    }

    /// Whether it takes a square root.
    pub(super) fn roots(self) -> bool {
        matches!(self, Task::Root | Task::InverseRoot | Task::ForceRoot)
    }
}

impl Controller {
    /// Whether the law has this task, and it is in progress.
    #[inline(always)]
    pub(super) fn at<V: Interpretation>(&self, r: &Regs<V>, task: Task) -> Signal<V> {
        if Task::of(self.law).contains(&task) { r.task.at(task) } else { bit(false) }
    }

    /// Whether one of the law's tasks for which `which` holds is in progress.
    #[inline(always)]
    fn any<V: Interpretation>(&self, r: &Regs<V>, which: impl Fn(Task) -> bool) -> Signal<V> {
        let tasks = Task::of(self.law).iter().filter(|task| which(**task));
        tasks.fold(bit(false), |any, task| any | r.task.at(*task))
    }

    /// Whether a product is being taken.
    #[inline(always)]
    pub(super) fn multiplies<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        self.any(r, Task::multiplies)
    }

    /// Whether the task ends with this clock.
    #[inline(always)]
    pub(super) fn ends<V: Interpretation>(
        &self,
        r: &Regs<V>,
        rooted: Signal<V>,
        divided: Signal<V>,
    ) -> Signal<V> {
        let multiplied = r.count.is(self.multiplier.latency() + 1);
        (self.any(r, Task::roots) & rooted)
            | (self.at(r, Task::Divide) & divided)
            | (self.at(r, Task::Curve) & r.count.is(1))
            | (self.multiplies(r) & multiplied)
            | self.at(r, Task::Combine)
            | self.at(r, Task::Limit)
    }

    /// The task after this one.
    #[inline(always)]
    pub(super) fn following<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        let pairs = Task::of(self.law).windows(2);
        pairs.fold(Task::Idle.signal(), |next, pair| {
            r.task.at(pair[0]).select(pair[1].signal(), next)
        })
    }

    /// Whether the task after this one takes a square root.
    #[inline(always)]
    pub(super) fn root_follows<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        let pairs = Task::of(self.law).windows(2).filter(|pair| pair[1].roots());
        pairs.fold(bit(false), |any, pair| any | r.task.at(pair[0]))
    }
}
