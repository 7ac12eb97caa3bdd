// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core of a profile on the bench: the model beside its Verilog.

use hapticore_contract::profile::Profile;
use hapticore_hdl::verilog::Design;
use hapticore_model::blocks::core::Core;
use hapticore_rtl::header;

use super::Trace;
use crate::stimulus::Stimulus;

/// A core and what is printed of it.
pub struct Bench {
    /// Profile of the core.
    pub profile: Profile,
    /// Configuration of the core.
    pub core: Core,
    /// Printed Verilog of the core.
    pub design: Design,
}

impl Bench {
    /// The core of a bundled profile.
    ///
    /// # Panics
    /// Where there is no such profile.
    pub fn new(profile: &str) -> Bench {
        Bench::of(Profile::bundled(profile).expect("bundled"))
    }

    /// The core of any profile that is accepted and has no force controller.
    ///
    /// # Panics
    /// Where no core can be built of it.
    pub fn of(profile: Profile) -> Bench {
        let core = Core::new(&profile);
        Bench { design: header::design(&profile), core, profile }
    }

    /// The trace that the model leaves of a stimulus.
    pub fn record(&self, mut stimulus: Stimulus) -> Trace {
        Trace::record(&self.core, self.design.ports.clone(), |outputs| stimulus.next(outputs))
    }
}
