// SPDX-License-Identifier: MIT OR Apache-2.0
//! Boards that one can buy: their profiles, clocks, pins, tops and constraints.
//!
//! | board | part | clock | profile | pins of the ADC | carrier, pads |
//! | --- | --- | --- | --- | --- | --- |
//! | ULX3S | ECP5 85F, CABGA381 | 25 MHz | standard | gp and gn 0 … 6 | gp 9, gp and gn 7 … 8 |
//! | iCEBreaker | iCE40UP5K, SG48 | 12 MHz | small | PMOD 1A and 1B | PMOD 2 |
//!
//! A pin is written once, on the top's signal; constraints are read off the top. Sources: the
//! boards' schematics.

use super::parameters::{Parameters, ParametersError};
use super::top::{Primitive, Top};
use super::whole::Board;
use crate::component;
use hapticore_contract::profile::Profile;
use rust_hdl_core::prelude::{Atom, Block, Constraint, PinConstraint, Probe};
use std::fmt::Write;
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

/// Puts the top's ports on pins: each port's from its least significant bit, with what else is to
/// be said of each.
macro_rules! locate {
    ($top:ident: $($port:ident $pins:expr $(=> $also:literal)?;)*) => {
        $(for (bit, pin) in $pins.into_iter().enumerate() {
            $top.$port.add_location(bit, pin);
            $($top.$port.add_constraint(PinConstraint { index: bit, constraint: Constraint::Custom($also.into()) });)?
        })*
    };
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
        let clock_hz = match self {
            Target::Ulx3s => 25_000_000,
            Target::Icebreaker => 12_000_000,
        };
        Parameters { clock_hz, baud: 1_000_000, sclk_latency: self.primitive().latency() }
    }

    fn primitive(self) -> Primitive {
        match self {
            Target::Ulx3s => Primitive::Oddrx1f,
            Target::Icebreaker => Primitive::SbIo,
        }
    }

    /// Its top, connected and with every port on its pins.
    pub fn top(self) -> Top {
        self.top_of(&self.profile()).expect("bundled profiles fit their boards")
    }

    /// Its top with the core of another profile.
    ///
    /// # Errors
    /// Where the board cannot serve the profile.
    pub fn top_of(self, profile: &Profile) -> Result<Top, ParametersError> {
        let board = Board::new(profile, &self.parameters())?;
        let mut top = Top::new(board, self.primitive(), self == Target::Icebreaker);
        match self {
            Target::Ulx3s => ulx3s(&mut top),
            Target::Icebreaker => icebreaker(&mut top),
        }
        top.connect_all();
        Ok(top)
    }

    /// Its Verilog: the module `top` and all within it.
    pub fn top_verilog(self) -> String {
        component::verilog(&self.top())
    }

    /// Its constraints: a file's name, and what stands in it.
    pub fn constraints(self) -> (String, String) {
        let pins = Pins::of(&self.top()).0;
        let mut text = String::new();
        match self {
            Target::Ulx3s => {
                // No FREQUENCY: the tool is told what to aim at, which is more than the board's
                // clock.
                for Pin { port, site, also } in pins {
                    let _ = writeln!(text, "LOCATE COMP \"{port}\" SITE \"{site}\";");
                    let _ = writeln!(text, "IOBUF PORT \"{port}\" IO_TYPE=LVCMOS33{also};");
                }
                (format!("{}.lpf", self.name()), text)
            }
            Target::Icebreaker => {
                for Pin { port, site, also } in pins {
                    let _ = writeln!(text, "set_io{also} {port} {site}");
                }
                (format!("{}.pcf", self.name()), text)
            }
        }
    }
}

fn ulx3s(top: &mut Top) {
    locate!(top:
        clock ["G2"];
        button ["R1"] => "PULLMODE=DOWN";
        tx ["L4"];
        rx ["M1"] => "PULLMODE=UP";
        enabled ["B2"];
        late ["C2"];
        dout ["B11", "C11", "A10", "A11", "A9", "B10", "B9", "C10"];
        convst ["A7"];
        busy ["A8"] => "PULLMODE=DOWN";
        cs_n ["C8"];
        sclk ["B8"];
        sdi ["C6"];
        adc_reset ["C7"];
        pads ["A6", "B6", "A4", "A5"];
        carrier ["A2"];
    );
}

fn icebreaker(top: &mut Top) {
    locate!(top:
        clock ["35"];
        button ["10"] => "-pullup yes";
        tx ["9"];
        rx ["6"] => "-pullup yes";
        enabled ["37"];
        late ["11"];
        dout ["4", "2", "47", "45", "3", "48", "46", "44"];
        convst ["43"];
        busy ["38"];
        cs_n ["34"];
        sclk ["31"];
        sdi ["42"];
        adc_reset ["36"];
        pads ["27", "25", "21", "19"];
        carrier ["26"];
    );
}

/// A bit of a port, and its pin.
struct Pin {
    port: String,
    site: String,
    also: String,
}

/// The pins of a top, read off its ports.
struct Pins(Vec<Pin>, usize);

impl Pins {
    fn of(top: &Top) -> Self {
        let mut pins = Pins(Vec::new(), 0);
        top.accept("top", &mut pins);
        pins
    }
}

impl Probe for Pins {
    fn visit_start_scope(&mut self, _name: &str, _node: &dyn Block) {
        self.1 += 1;
    }

    fn visit_atom(&mut self, name: &str, signal: &dyn Atom) {
        if self.1 > 1 {
            return;
        }
        for PinConstraint { index, constraint } in signal.constraints() {
            match constraint {
                Constraint::Location(site) => {
                    let port =
                        if signal.bits() == 1 { name.into() } else { format!("{name}[{index}]") };
                    self.0.push(Pin { port, site, also: String::new() });
                }
                Constraint::Custom(also) => {
                    self.0.last_mut().expect("a location comes first").also = format!(" {also}");
                }
                _ => (),
            }
        }
    }

    fn visit_end_scope(&mut self, _name: &str, _node: &dyn Block) {
        self.1 -= 1;
    }
}
