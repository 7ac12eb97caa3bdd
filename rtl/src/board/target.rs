// SPDX-License-Identifier: MIT OR Apache-2.0
//! Boards that one can buy: their profiles and clocks.
//!
//! | board | part | clock | profile | pins of the ADC | carrier, pads | drive |
//! | --- | --- | --- | --- | --- | --- | --- |
//! | ULX3S | ECP5 85F, CABGA381 | 25 MHz | standard | gp and gn 0 … 6 | gp 9, gp and gn 7 … 8 | gn 9 … 10, gp 10 … 11, gp and gn 18 … 19 |
//! | iCEBreaker | iCE40UP5K, SG48 | 12 MHz | small | PMOD 1A and 1B | PMOD 1B and 2 | none |
//!
//! Sources: the boards' schematics. What a board is made from is printed with the feature `boards` alone (`printing.rs`).

use super::parameters::Parameters;
use hapticore_contract::profile::Profile;
use std::str::FromStr;

/// A board that one can buy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Target {
    /// Radiona ULX3S with an ECP5 85F.
    Ulx3s,
    /// 1BitSquared iCEBreaker with an iCE40UP5K.
    Icebreaker,
}

/// A name that is no board's.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("expected a board among {known}, got \"{0}\"", known = Target::ALL.map(Target::name).join(", "))]
pub struct TargetError(String);

impl FromStr for Target {
    type Err = TargetError;

    fn from_str(text: &str) -> Result<Self, TargetError> {
        Target::ALL
            .into_iter()
            .find(|target| target.name() == text)
            .ok_or_else(|| TargetError(text.into()))
    }
}

impl Target {
    /// All supported boards.
    pub const ALL: [Target; 2] = [Target::Ulx3s, Target::Icebreaker];

    /// What it is called in commands.
    pub fn name(self) -> &'static str {
        match self {
            Target::Ulx3s => "ulx3s",
            Target::Icebreaker => "icebreaker",
        }
    }

    /// The name of the bundled profile whose core it runs.
    pub fn profile_name(self) -> &'static str {
        match self {
            Target::Ulx3s => "standard",
            Target::Icebreaker => "small",
        }
    }

    /// The profile whose core it runs.
    pub fn profile(self) -> Profile {
        Profile::bundled(self.profile_name()).expect("boards name bundled profiles")
    }

    /// The clock of its core: that of its oscillator.
    pub fn clock_hz(self) -> u64 {
        self.parameters().clock_hz
    }

    /// What it adds to the profile.
    pub fn parameters(self) -> Parameters {
        // The ECP5's ODDRX1F puts SCLK out three clocks late (its simulation model has three registers); the iCE40's SB_IO
        // takes the second half of a clock in the middle of it, without latency.
        let (clock_hz, sclk_latency) = match self {
            Target::Ulx3s => (25_000_000, 3),
            Target::Icebreaker => (12_000_000, 0),
        };
        Parameters { clock_hz, baud: 1_000_000, sclk_latency, drive: None }
    }
}

/// What a board is made from.
#[derive(Debug, Clone)]
pub struct Printed {
    /// Verilog: the module `top` and all within it.
    pub verilog: String,
    /// Constraints: a file's name, and what stands in it.
    pub constraints: (String, String),
}
