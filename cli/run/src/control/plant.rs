// SPDX-License-Identifier: MIT OR Apache-2.0
//! The plant of a force loop: it makes a slot, then takes the drive that follows from it.
//!
//! ```text
//! slot n ─[core and controller: ForceLoop::latency after the slot's end]─ drive of its pad, until the pad's next
//! ```
//!
//! The target of slot n is what the scene asks for at its end, when its drive is made.

use anyhow::Result;
use hapticore_contract::control::Drive;
use hapticore_contract::profile::Profile;
use hapticore_host::SlotClock;
use hapticore_model::blocks::force_loop::ForceLoop;
use hapticore_scene::{EffectCost, Truth};

use crate::engine::Slot;
use crate::maker::Maker;
use crate::record::Driven;

/// A plant whose pads are driven by what its slots lead to.
pub struct LoopPlant {
    maker: Maker,
    clock: SlotClock,
    /// The drive's full scale, V rms.
    full_scale_v: f64,
    /// From a slot's end to the drive that follows from it, s.
    latency_s: f64,
}

/// A slot, and what its drive should give.
pub struct LoopSlot {
    /// What the core is given.
    pub slot: Slot,
    /// What the plant knows.
    pub truth: Truth,
    /// The largest sample, as a fraction of full scale.
    pub peak: f64,
    /// The force that the pad shall have, N.
    pub target_n: f64,
    /// The slot's end, s.
    end_s: f64,
}

impl LoopPlant {
    /// A plant before its first slot: no pad is driven. `full_scale_v` is that of drive words.
    ///
    /// # Errors
    /// A profile without a controller.
    pub fn new(
        mut maker: Maker,
        profile: &Profile,
        clock: SlotClock,
        full_scale_v: f64,
    ) -> Result<Self> {
        let clocks = ForceLoop::try_new(profile)?.latency();
        let clock_hz = profile.clocks_per_sample as f64 * clock.sample_rate_hz();
        for pad in 0..maker.plant().pad_names().len() {
            maker.plant().set_drive(pad, 0.0, 0.0)?;
        }
        Ok(LoopPlant { maker, clock, full_scale_v, latency_s: clocks as f64 / clock_hz })
    }

    /// A slot; slots are asked for in order, each after the drive of the one before.
    pub fn slot(&mut self, number: usize) -> LoopSlot {
        let truth = self.maker.plant().truth(number);
        let end_s = self.clock.seconds(number + 1);
        let target_n = self.maker.plant().target_n(truth.pad, end_s);
        let (signals, peak) = self.maker.signals(number);
        LoopSlot { slot: Slot { pad: truth.pad, signals }, truth, peak, target_n, end_s }
    }

    /// Drives the pad of a slot, from the slot's end and the latency of its drive word on.
    ///
    /// # Errors
    /// A drive that the plant does not take.
    pub fn drive(&mut self, of: &LoopSlot, drive: &Drive) -> Result<Driven> {
        let drive_v_rms = self.full_scale_v * drive.fraction;
        self.maker.plant().set_drive(drive.pad, of.end_s + self.latency_s, drive_v_rms)?;
        let (limited, fault) = (drive.low | drive.high, drive.faults.any());
        Ok(Driven { target_n: of.target_n, drive_v_rms, limited, fault })
    }

    /// Effects and what they cost.
    pub fn effects(&mut self) -> Vec<EffectCost> {
        self.maker.plant().effects()
    }
}
