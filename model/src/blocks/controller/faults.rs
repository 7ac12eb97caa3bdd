// SPDX-License-Identifier: MIT OR Apache-2.0
//! Faults of the force controller: each takes every pad's drive to zero, at the slew limit, and
//! stays until it is cleared.
//!
//! | fault   | when                                                                           |
//! | silence | no sign of life from the host for so many frames                               |
//! | sensor  | so many estimates of a pad in a row were invalid; until then its drive is held |
//! | force   | a valid estimate was beyond the cap                                            |
//!
//! What causes a fault and still holds when it is cleared causes it again.

use super::{Controller, In, Registers, Regs};
use hapticore_hdl::block::Interpretation;
use hapticore_hdl::bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::{Signal, Wrap, int};

bundle! {
    /// Faults, latched.
    pub struct Faults {
        /// The host was silent for too long.
        silence_fault,
        /// Estimates of a pad were invalid for too long.
        sensor_fault,
        /// A force was beyond its cap.
        force_fault,
    }
}

impl Controller {
    /// Whether drives go to zero.
    #[inline(always)]
    pub(super) fn off<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> Signal<V> {
        !i.tuning.enable | r.silence_fault | r.sensor_fault | r.force_fault
    }

    /// A clock in which the host may be heard, and may clear faults.
    #[inline(always)]
    pub(super) fn heard<V: Interpretation>(&self, r: Regs<V>, i: &In<V>) -> Regs<V> {
        let keep = !i.clear_faults;
        Registers {
            silence_fault: r.silence_fault & keep,
            sensor_fault: r.sensor_fault & keep,
            force_fault: r.force_fault & keep,
            silent: i.alive.select(int(0), r.silent),
            ..r
        }
    }

    /// Frames since the host was heard, with this one.
    #[inline(always)]
    pub(super) fn silence<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> Signal<V> {
        let more = r.silent.is(self.silent_frames).select(r.silent, r.silent + int(1));
        i.alive.select(int(0), more).resize(r.silent.format, Wrap)
    }

    /// Invalid estimates of the pad in a row, with this one.
    #[inline(always)]
    pub(super) fn invalid_count<V: Interpretation>(
        &self,
        i: &In<V>,
        before: Signal<V>,
    ) -> Signal<V> {
        let counter = Format::counter(self.invalid_frames);
        let more = before.at_least(int(self.invalid_frames)).select(before, before + int(1));
        i.invalid.select(more, int(0)).resize(counter, Wrap)
    }

    /// With the faults that this estimate causes, where it is `now` that they are looked for.
    #[inline(always)]
    pub(super) fn faults_found<V: Interpretation>(
        &self,
        r: Regs<V>,
        i: &In<V>,
        invalid: Signal<V>,
        now: Signal<V>,
    ) -> Regs<V> {
        let sensor = self.invalid_count(i, invalid).is(self.invalid_frames);
        let force = !i.invalid & i.tuning.force_cap.less_than(i.measured);
        Registers {
            silence_fault: r.silence_fault | (now & r.silent.is(self.silent_frames)),
            sensor_fault: r.sensor_fault | (now & sensor),
            force_fault: r.force_fault | (now & force),
            ..r
        }
    }
}
