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

use super::{Controller, In, Regs};
use hapticore_hdl::block::Interpretation;
use hapticore_hdl::bundle;
use hapticore_hdl::format::{BIT, Format};
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

bundle! {
    /// What keeps drives at zero, and what may.
    pub struct Watch {
        /// Frames since the host was heard.
        silent,
        latched as Faults,
    }
}

impl Watch<Format> {
    /// The registers, where so many silent frames are a fault.
    pub(in crate::blocks) fn registers(silent_frames: u64) -> Self {
        Watch { silent: Format::counter(silent_frames), latched: Faults::of(BIT) }
    }
}

impl<V: Interpretation> Watch<Signal<V>> {
    /// Whether there is a fault.
    #[inline(always)]
    pub(in crate::blocks) fn any(self) -> Signal<V> {
        let Faults { silence_fault, sensor_fault, force_fault } = self.latched;
        silence_fault | sensor_fault | force_fault
    }

    /// A clock in which the host may be heard, and may clear faults.
    #[inline(always)]
    pub(in crate::blocks) fn heard(self, alive: Signal<V>, clear_faults: Signal<V>) -> Self {
        let keep = !clear_faults;
        Watch {
            silent: alive.select(int(0), self.silent),
            latched: Faults {
                silence_fault: self.latched.silence_fault & keep,
                sensor_fault: self.latched.sensor_fault & keep,
                force_fault: self.latched.force_fault & keep,
            },
        }
    }

    /// Frames since the host was heard, with this one.
    #[inline(always)]
    pub(in crate::blocks) fn counted(self, alive: Signal<V>, silent_frames: u64) -> Signal<V> {
        let silent = self.silent;
        let more = silent + !silent.is(silent_frames);
        alive.select(int(0), more).resize(silent.format, Wrap)
    }

    /// With the faults of an estimate, and of a host that has been silent for too long.
    #[inline(always)]
    pub(in crate::blocks) fn found(
        self,
        silence: Signal<V>,
        sensor: Signal<V>,
        force: Signal<V>,
    ) -> Self {
        let Faults { silence_fault, sensor_fault, force_fault } = self.latched;
        let latched = Faults {
            silence_fault: silence_fault | silence,
            sensor_fault: sensor_fault | sensor,
            force_fault: force_fault | force,
        };
        Watch { latched, ..self }
    }
}

impl Controller {
    /// Whether drives go to zero.
    #[inline(always)]
    pub(super) fn off<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> Signal<V> {
        !i.tuning.enable | r.watch.any()
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
        watch: Watch<Signal<V>>,
        i: &In<V>,
        invalid: Signal<V>,
        now: Signal<V>,
    ) -> Watch<Signal<V>> {
        let sensor = self.invalid_count(i, invalid).is(self.invalid_frames);
        let force = !i.invalid & i.tuning.force_cap.less_than(i.measured);
        let silence = watch.silent.is(self.silent_frames);
        watch.found(now & silence, now & sensor, now & force)
    }
}
