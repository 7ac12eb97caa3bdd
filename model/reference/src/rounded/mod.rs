// SPDX-License-Identifier: MIT OR Apache-2.0
//! The rounded reference: each block's result as "the exact value, rounded so", and a slot's frame
//! from all of them.
//!
//! One function a block, taking and giving [`Exact`] numbers; equality with the clocked model is to
//! the bit.

mod capacitance;
mod controller;
mod currents;
mod demodulator;
mod force;
mod force_table;
mod frames;
mod number;
mod oscillator;
mod position;
mod ratio;
mod split_pad;
mod wall;

pub use capacitance::{Capacitance, capacitance};
pub use controller::{Controller, Drive, Request};
pub use currents::{Currents, currents};
pub use demodulator::{Sums, demodulate};
pub use force::{Force, Squares, force, mean_square};
pub use force_table::ForceTable;
pub use frames::Frames;
pub use number::{Exact, Rounded, floor_quotient, round, round_quotient, round_real, round_sqrt};
pub use oscillator::{Oscillator, Sample, windowed_lo};
pub use position::{Place, Position};
pub use ratio::{Ratio, ratio};
pub use split_pad::{Estimate, SplitPads, WholePad};
pub use wall::{Wall, WallFrame, WallResult};

use hapticore_contract::calibration::Calibration;
use hapticore_contract::frame::{Flags, Frame};
use hapticore_contract::profile::{ForceLaw, Profile};

/// A core, slot by slot, rounded as the blocks round.
pub struct Slots {
    profile: Profile,
    carrier: Vec<Sample>,
    position: Position,
    capacitance_gain: Exact,
    force_gain: Exact,
    contact_capacitance: Exact,
    force_table: Option<ForceTable>,
    squares: Squares,
    /// The sheet's resistance at each pad's last place.
    sheets: Vec<Exact>,
    frames: Frames,
}

/// The estimate of a slot that comes before its frame: with the sheet's resistance at the pad's
/// last place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prompt {
    /// Capacitance, pF.
    pub capacitance: Exact,
    /// Haptic force, N.
    pub force: Exact,
    /// Gain of that force.
    pub force_gain: Exact,
    /// No capacitance has these currents, or a code or a word is at its limit.
    pub invalid: bool,
    /// The pad does not touch.
    pub lifted: bool,
}

impl Slots {
    /// A core of a profile, calibrated, just before its first slot.
    pub fn new(profile: &Profile, calibration: &Calibration) -> Self {
        let f = &profile.formats;
        let oscillator = Oscillator::new(profile);
        let blanking = profile.slot.blanking();
        let words: Vec<Exact> =
            calibration.position.words.iter().map(|&word| round_real(word, f.table)).collect();
        Slots {
            carrier: (0..profile.slot.integrate)
                .map(|m| oscillator.sample(blanking + m, m))
                .collect(),
            position: Position::new(profile, &words),
            capacitance_gain: round_real(calibration.capacitance_gain, f.capacitance_gain),
            force_gain: round_real(calibration.force_gain, f.force_gain),
            contact_capacitance: round_real(calibration.contact_capacitance, f.capacitance),
            force_table: (profile.force.law == ForceLaw::Table)
                .then(|| ForceTable::new(profile, &calibration.force_table)),
            squares: Squares::new(profile),
            sheets: vec![Exact::ZERO; profile.pads as usize],
            frames: Frames::new(profile),
            profile: profile.clone(),
        }
    }

    /// The frame of a slot: `codes` are those of its window, a sample after the other.
    pub fn slot(&mut self, pad: usize, codes: &[i32]) -> Frame {
        let sums = demodulate(&self.profile, &self.carrier, codes);
        self.frame(pad, &sums)
    }

    /// The frame of a window's sums.
    pub fn frame(&mut self, pad: usize, sums: &Sums) -> Frame {
        self.frame_and_prompt(pad, sums).0
    }

    /// The frame of a window's sums, and the estimate that came before it.
    pub fn frame_and_prompt(&mut self, pad: usize, sums: &Sums) -> (Frame, Prompt) {
        let p = &self.profile;
        let currents = currents(p, &sums.phases);
        let mean_square = self.squares.mean(p, pad, mean_square(p, sums.square));
        let prompt = {
            let gain = self.capacitance_gain;
            let early = capacitance(p, currents.total, currents.sense, self.sheets[pad], gain);
            let numbers = [early.capacitance, mean_square.value, self.force_gain];
            let force = match &mut self.force_table {
                None => force(p, numbers),
                Some(table) => table.prompt(p, pad, numbers),
            };
            let saturated =
                currents.saturated | early.saturated | mean_square.held | force.saturated;
            Prompt {
                capacitance: early.capacitance,
                force: force.force,
                force_gain: force.gain,
                invalid: early.invalid | saturated | sums.clipped,
                lifted: early.capacitance <= self.contact_capacitance,
            }
        };
        let ratio = ratio(p, &currents);
        let place = self.position.place([ratio.r_x, ratio.r_y]);
        let lost = self.position.any_open(ratio.share);
        let sheet = place.sheet;
        let capacitance =
            capacitance(p, currents.total, currents.sense, sheet, self.capacitance_gain);
        if !(ratio.invalid | place.invalid | prompt.lifted) {
            self.sheets[pad] = sheet;
        }
        let numbers = [capacitance.capacitance, mean_square.value, self.force_gain];
        let force = match &mut self.force_table {
            None => force(p, numbers),
            Some(table) => table.force(p, pad, numbers),
        };
        let saturated = currents.saturated
            | place.saturated
            | capacitance.saturated
            | mean_square.held
            | force.saturated;
        let invalid = ratio.invalid | place.invalid | capacitance.invalid;
        let values = [
            ratio.r_x,
            ratio.r_y,
            place.x,
            place.y,
            sheet,
            capacitance.capacitance,
            force.force,
            mean_square.value,
        ];
        let lifted = capacitance.capacitance <= self.contact_capacitance;
        let codes = self.frames.words(pad, values, [invalid, lifted]);
        let flags = Flags { clipped: sums.clipped, saturated, invalid, lost, lifted };
        (Frame { pad, codes, flags }, prompt)
    }
}
