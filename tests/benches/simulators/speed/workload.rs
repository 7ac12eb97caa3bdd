// SPDX-License-Identifier: MIT OR Apache-2.0
//! A stimulus in memory: all its codes, small enough to stay in the processor's caches.

use hapticore_contract::profile::Profile;
use hapticore_model::blocks::core::Inputs;

use hapticore_tests::stimulus::Stimulus;

/// What a core receives, over and over.
#[derive(Debug, Clone)]
pub struct Workload {
    /// Inputs that stay: the calibration's.
    pub constants: Inputs<i64>,
    /// Addresses and words of the calibration's tables, which are written before the time is taken.
    pub table: Vec<(i64, i64)>,
    /// Sets of codes, one for each strobe.
    pub samples: Vec<i32>,
    /// Codes of a set.
    pub channels: usize,
    /// Clocks of a set.
    pub clocks_per_sample: u64,
    /// How often the samples are run through.
    pub passes: usize,
}

impl Workload {
    /// A stimulus's samples, `passes` times.
    pub fn new(profile: &Profile, stimulus: Stimulus, passes: usize) -> Workload {
        let (constants, table, samples) = stimulus.into_parts();
        let code = |code: i64| i32::try_from(code).expect("an ADC's code");
        Workload {
            constants,
            table: table.collect(),
            samples: samples.flatten().map(code).collect(),
            channels: profile.channels(),
            clocks_per_sample: profile.clocks_per_sample,
            passes,
        }
    }

    /// Clocks that are timed.
    pub fn clocks(&self) -> u64 {
        (self.samples.len() / self.channels * self.passes) as u64 * self.clocks_per_sample
    }
}
