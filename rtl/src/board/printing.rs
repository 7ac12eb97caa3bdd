// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a board is made from: Verilog of its top and constraints of its pins.
//!
//! A pin is written once, on the top's signal; constraints are read off the top. Sources: the boards' schematics.

use super::drive_output::Converter;
use super::parameters::{Drive, Parameters};
use super::target::{Printed, Target};
use super::top::{DriveTop, Primitive, Top};
use super::whole::{Board, BoardError};
use crate::{component, header};
use hapticore_contract::profile::Profile;
use rust_hdl_core::prelude::{Atom, Block, Constraint, PinConstraint, Probe};
use std::fmt::Write;

/// What stands at the head of an iCEBreaker's constraints.
const ICEBREAKER_NOTE: &str = "\
# SNAP THE BREAK-OFF BOARD OFF before you connect a driver: PMOD 2 goes through its lamps and buttons. No select line is at
# a button (PMOD 2, pins 4, 9, 10), so that none is pressed closed, but lamps load pads[2], pads[3] and carrier.
";

/// Pins of either board for select lines of pads.
const MOST_PADS: u64 = 4;

/// Puts the top's ports on pins: each port's from its least significant bit, with what else is to
/// be said of each. Pins beyond a port's width are left free.
macro_rules! locate {
    ($top:ident: $($port:ident $pins:expr $(=> $also:literal)?;)*) => {
        $(for (bit, pin) in $pins.into_iter().enumerate().take(Atom::bits(&$top.$port)) {
            $top.$port.add_location(bit, pin);
            $($top.$port.add_constraint(PinConstraint { index: bit, constraint: Constraint::Custom($also.into()) });)?
        })*
    };
}

/// The ports of a ULX3S's top.
macro_rules! ulx3s {
    ($top:ident) => {
        locate!($top:
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
        )
    };
}

/// The ports of an iCEBreaker's top.
macro_rules! icebreaker {
    ($top:ident) => {
        locate!($top:
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
            pads ["32", "28", "27", "25"];
            carrier ["26"];
        )
    };
}

impl Target {
    fn primitive(self) -> Primitive {
        match self {
            Target::Ulx3s => Primitive::Oddrx1f,
            Target::Icebreaker => Primitive::SbIo,
        }
    }

    /// What the board with its own profile is made from.
    pub fn bundled(self) -> Printed {
        self.printed(&self.profile(), None).expect("bundled profiles fit their boards")
    }

    /// What the board with the core of another profile is made from; where that has a controller, with a converter for the
    /// drives of its pads and their wave.
    ///
    /// # Errors
    /// Where the board cannot serve the profile, or has too few pins for its pads or none for the converter.
    pub fn printed(self, profile: &Profile, drive: Option<Drive>) -> Result<Printed, BoardError> {
        self.printed_with(profile, &Parameters { drive, ..self.parameters() })
    }

    /// The same with a serial line of another rate, or another clock.
    ///
    /// # Errors
    /// As [`Target::printed`].
    pub fn printed_with(
        self,
        profile: &Profile,
        parameters: &Parameters,
    ) -> Result<Printed, BoardError> {
        let (board, drive) = (Board::new(profile, parameters)?, parameters.drive);
        let (channels, pads) = (profile.channels(), profile.pads);
        let pins = |port, most: u64, got: u64| {
            let error = BoardError::FewPins { board: self.name(), port, most, got };
            (got <= most).then_some(()).ok_or(error)
        };
        pins("pads", MOST_PADS, pads)?;
        // rust-hdl has widths in types: a top for each that a device may have.
        macro_rules! top_of {
            ($(($channels:literal, $pads:literal))*) => {
                match (channels, pads) {
                    $(($channels, $pads) => self.top::<$channels, $pads>(board, drive),)*
                    _ => unreachable!("{channels} ADC channels and {pads} pads were accepted"),
                }
            };
        }
        let mut printed = top_of! {
            (5, 1) (5, 2) (5, 3) (5, 4) (6, 1) (6, 2) (6, 3) (6, 4) (7, 1) (7, 2) (7, 3) (7, 4) (8, 1) (8, 2) (8, 3) (8, 4)
        }?;
        printed.verilog = self.heading(profile, parameters) + printed.verilog.trim_start();
        Ok(printed)
    }

    /// A board's top for an ADC of `CHANNELS` channels and for `PADS` pads, on its pins.
    fn top<const CHANNELS: usize, const PADS: usize>(
        self,
        board: Board,
        drive: Option<Drive>,
    ) -> Result<Printed, BoardError> {
        let (primitive, active_low) = (self.primitive(), self == Target::Icebreaker);
        match (self, drive) {
            (Target::Ulx3s, Some(Drive { converter: Converter::Serial(_), .. })) => {
                let mut top = DriveTop::<CHANNELS, PADS>::new(board, primitive, active_low);
                ulx3s!(top);
                locate!(top:
                    dac_sync_n ["C4"];
                    dac_sclk ["B4"];
                    dac_sdi ["F4"];
                    dac_polarity ["H18", "H17", "F17", "G18"];
                    dac_live ["B1"];
                );
                Ok(self.print(&mut top))
            }
            (Target::Ulx3s, None) => {
                let mut top = Top::<CHANNELS, PADS>::new(board, primitive, active_low);
                ulx3s!(top);
                Ok(self.print(&mut top))
            }
            (Target::Icebreaker, None) => {
                let mut top = Top::<CHANNELS, PADS>::new(board, primitive, active_low);
                icebreaker!(top);
                Ok(self.print(&mut top))
            }
            (_, Some(_)) => Err(BoardError::NoPins(self.name())),
        }
    }

    /// What stands at the head of a board's Verilog.
    fn heading(self, profile: &Profile, parameters: &Parameters) -> String {
        let Parameters { clock_hz, baud, drive, .. } = *parameters;
        let control = profile.control.as_ref().map(|control| control.law.name());
        let control = control.map_or(String::new(), |law| format!(" --control {law}"));
        let drive = if drive.is_some() { ", with a drive" } else { "" };
        let rate =
            if baud == self.parameters().baud { String::new() } else { format!(" --baud {baud}") };
        let bits = parameters.bits();
        let line = match bits.most() == bits.least() {
            true => format!("{} baud with a whole divisor", clock_hz / bits.least()),
            false => format!("bits of {} and {} clocks", bits.least(), bits.most()),
        };
        format!(
            "// SPDX-License-Identifier: MIT OR Apache-2.0\n\
             // top: board {name} for {terminals} terminals and {pads} pads{drive}.\n\
             // Generated by `hapticore hdl --board {name} --profile {profile}{control}{rate}` ({source}); do not edit.\n\
             // Clock {clock_hz} Hz; serial line {baud} baud, 8N1 ({line}).\n\n",
            name = self.name(),
            terminals = profile.terminals.x.len(),
            pads = profile.pads,
            profile = profile.name,
            source = header::source(profile),
        )
    }

    /// Verilog and constraints of a top whose ports have their pins.
    fn print(self, top: &mut impl Block) -> Printed {
        top.connect_all();
        Printed { verilog: component::verilog(top), constraints: self.constraints(top) }
    }

    /// A file's name, and what stands in it.
    fn constraints(self, top: &impl Block) -> (String, String) {
        let pins = Pins::of(top).0;
        let mut text = String::new();
        match self {
            Target::Ulx3s => {
                // No FREQUENCY: the flow passes the tool its target, which is more than the board's
                // clock.
                for Pin { port, site, also } in pins {
                    let _ = writeln!(text, "LOCATE COMP \"{port}\" SITE \"{site}\";");
                    let _ = writeln!(text, "IOBUF PORT \"{port}\" IO_TYPE=LVCMOS33{also};");
                }
                (format!("{}.lpf", self.name()), text)
            }
            Target::Icebreaker => {
                text.push_str(ICEBREAKER_NOTE);
                for Pin { port, site, also } in pins {
                    let _ = writeln!(text, "set_io{also} {port} {site}");
                }
                (format!("{}.pcf", self.name()), text)
            }
        }
    }
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
    fn of(top: &impl Block) -> Self {
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
