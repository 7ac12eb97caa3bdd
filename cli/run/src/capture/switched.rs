// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a recorder at the terminals of a simulated device sees while the switch is open: no current.

use anyhow::Result;
use hapticore_contract::profile::Profile;

use super::stream::Recorder;

/// A capture without current in the first samples of each slot, so that slots can be found in it.
pub struct Switched {
    within: Box<dyn Recorder + Send>,
    open: usize,
    channels: usize,
    codes: Vec<i32>,
}

impl Switched {
    /// A capture of slots of a profile.
    pub fn new(within: Box<dyn Recorder + Send>, profile: &Profile) -> Self {
        let (open, channels) = (profile.slot.open as usize, profile.channels());
        Switched { within, open, channels, codes: Vec::new() }
    }
}

impl Recorder for Switched {
    fn slot(&mut self, pad: usize, codes: &[i32]) -> Result<()> {
        self.codes.clear();
        self.codes.extend(codes);
        let terminals = self.channels - 2;
        let samples = self.codes.chunks_mut(self.channels).take(self.open);
        samples.for_each(|sample| sample[..terminals].fill(0));
        self.within.slot(pad, &self.codes)
    }

    fn keep(self: Box<Self>) -> Result<()> {
        self.within.keep()
    }
}
