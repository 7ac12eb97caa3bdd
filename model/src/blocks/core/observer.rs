// SPDX-License-Identifier: MIT OR Apache-2.0
//! The observer of a core that is clocked in whole samples.

use super::Outputs;
use hapticore_hdl::signal::{Clocked, Signal};

/// Receives the outputs of a core, clock by clock.
pub trait Observer {
    /// The outputs of a clock.
    fn outputs(&mut self, outputs: Outputs<Signal<Clocked>>);

    /// The outputs of a clock that gives neither a word of a frame nor a prompt estimate.
    #[inline(always)]
    fn without_results(&mut self, outputs: Outputs<Signal<Clocked>>) {
        self.outputs(outputs);
    }
}
