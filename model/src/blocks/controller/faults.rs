// SPDX-License-Identifier: MIT OR Apache-2.0
//! Faults of the force controller: each takes every pad's drive to zero immediately, and stays until it is cleared.
//!
//! | fault   | when                                                                           |
//! | silence | no sign of life from the host for N ticks, of a millisecond each               |
//! | sensor  | N estimates of a pad in a row were invalid; until then its drive is held       |
//! | force   | a valid estimate was beyond the cap                                            |
//!
//! What causes a fault and still holds when it is cleared causes it again. Ticks are counted whether or not drive words
//! are made. Until the first tick after a reset drives are off, too: without ticks a silent host would go unnoticed.

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
        /// Ticks since the host was heard.
        silent,
        /// There has been a tick.
        ticks,
        latched as Faults,
    }
}

impl Watch<Format> {
    /// The registers, where `silent_ticks` silent ticks are a fault.
    pub(super) fn registers(silent_ticks: u64) -> Self {
        Watch { silent: Format::counter(silent_ticks), ticks: BIT, latched: Faults::of(BIT) }
    }
}

impl<V: Interpretation> Watch<Signal<V>> {
    /// Whether there is a fault, or silence could not be one.
    #[inline(always)]
    pub(super) fn stops(self) -> Signal<V> {
        let Faults { silence_fault, sensor_fault, force_fault } = self.latched;
        silence_fault | sensor_fault | force_fault | !self.ticks
    }

    /// A clock in which the host may be heard, may clear faults, and time may pass.
    #[inline(always)]
    pub(super) fn heard(self, i: &In<V>, silent_ticks: u64) -> Self {
        let more = (self.silent + !self.silent.is(silent_ticks)).resize(self.silent.format, Wrap);
        let passed = i.tick.select(more, self.silent);
        let silent = i.alive.select(int(0), passed).resize(self.silent.format, Wrap);
        let keep = !i.clear_faults;
        Watch {
            silent,
            ticks: self.ticks | i.tick,
            latched: Faults {
                silence_fault: (self.latched.silence_fault & keep) | silent.is(silent_ticks),
                sensor_fault: self.latched.sensor_fault & keep,
                force_fault: self.latched.force_fault & keep,
            },
        }
    }

    /// With the faults of an estimate.
    #[inline(always)]
    fn found(self, sensor: Signal<V>, force: Signal<V>) -> Self {
        let latched = Faults {
            sensor_fault: self.latched.sensor_fault | sensor,
            force_fault: self.latched.force_fault | force,
            ..self.latched
        };
        Watch { latched, ..self }
    }
}

impl Controller {
    /// Whether drives are zero, and begin anew.
    #[inline(always)]
    pub(super) fn off<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> Signal<V> {
        let complete = r.curve_words.is(self.points.words as u64);
        i.clear | !i.tuning.enable | r.watch.stops() | !complete
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
        watch.found(now & sensor, now & force)
    }
}
