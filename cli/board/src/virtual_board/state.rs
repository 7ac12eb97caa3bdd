// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a reset of a virtual board clears.

use hapticore_contract::profile::Profile;
use hapticore_host::Register;
use hapticore_host::ad7606c::Part;
use hapticore_protocol::Control;

use super::PAUSE_CLOCKS;
use super::core::Core;
use super::words::{DriveWords, SensorWords};

/// The ID of an AD7606C-18.
const ADC_ID: u8 = 0x31;

/// What a reset clears.
pub(super) struct State {
    pub sensor: SensorWords,
    pub drive: Option<DriveWords>,
    pub part: Part,
    pub control: i64,
    pub commands: u8,
    pub calibrated: bool,
    pub refused: bool,
    pub overrun: bool,
    pub sequence: u16,
    /// Words of heartbeats that were written.
    pub told: [Option<u64>; Register::ALL.len()],
    /// What the ADC put out during the last word that was sent to it, and that word; none during a test of a line.
    pub answer: Option<(u16, u16)>,
    /// When the test of a line is over, and the line.
    pub test: Option<(f64, usize)>,
    pub core: Option<Core>,
    /// Words were written since it was made.
    pub is_core_old: bool,
    /// Frames until drives may follow again after one with an open terminal.
    pub open: usize,
    /// When the packet on the line ends.
    pub busy_until_s: f64,
    pub next_heartbeat_s: f64,
}

impl State {
    pub fn new(profile: &Profile, words: usize, clock_hz: f64) -> Self {
        let pads = profile.pads as usize;
        State {
            sensor: SensorWords::new(words),
            drive: profile.control.as_ref().map(|control| DriveWords::new(control, pads)),
            part: Part::new(ADC_ID),
            control: 0,
            commands: 0,
            calibrated: false,
            refused: false,
            overrun: false,
            sequence: 0,
            told: [None; Register::ALL.len()],
            answer: None,
            test: None,
            core: None,
            is_core_old: true,
            open: 0,
            busy_until_s: 0.0,
            next_heartbeat_s: PAUSE_CLOCKS / clock_hz,
        }
    }

    pub fn is_enabled(&self) -> bool {
        self.control >> Control::ENABLE & 1 != 0
    }

    pub fn is_test(&self) -> bool {
        self.control >> Control::LINE_TEST & 1 != 0 && !self.is_enabled()
    }
}
