// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registers: what commands write, beside the words of the position table.

use crate::calibration::{Constant, WordFormats};
use hapticore_hdl::format::Format;
use std::fmt;

/// A register that commands write: the constants of the calibration, in their order, then control
/// and the ADC.
///
/// ```
/// # use hapticore_protocol::{Constant, Register};
/// assert_eq!(Register::Constant(Constant::ForceGain).place(), 0x8001);
/// assert_eq!(Register::ALL.map(|register| register.number()), [0, 1, 2, 3, 4]);
/// assert_eq!(Register::Adc.to_string(), "adc");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Register {
    /// A constant of the calibration.
    Constant(Constant),
    /// What the board does: the bits of [`Control`].
    Control,
    /// A register of the ADC: address and data.
    Adc,
}

/// The format of a register's number.
pub const PLACE: Format = Format::unsigned(3, 0);

/// Number of the heartbeat's word that holds the code read by a test of the ADC's lines, from the beginning of the test
/// until the next word is sent to the ADC. The code is zero where there is none yet, or where it was not the same each
/// time.
pub const LINES: usize = Register::Adc.number();

/// The format of what the ADC takes.
const ADC: Format = Format::unsigned(16, 0);

impl Register {
    /// All registers, in the order of their numbers.
    pub const ALL: [Register; Constant::ALL.len() + 2] = {
        let mut all = [Register::Control; Constant::ALL.len() + 2];
        let mut number = 0;
        while number < Constant::ALL.len() {
            all[number] = Register::Constant(Constant::ALL[number]);
            number += 1;
        }
        all[number + 1] = Register::Adc;
        all
    };

    /// The constant that is written last: a board that has it counts as calibrated.
    pub const LAST_CONSTANT: Register = Register::Constant(Constant::ALL[Constant::ALL.len() - 1]);

    /// Set in the place of a register, clear in that of a word of the position table.
    pub const SELECT: u16 = 0x8000;

    /// Its number, and its word in a heartbeat.
    #[inline]
    pub const fn number(self) -> usize {
        match self {
            Register::Constant(constant) => constant as usize,
            Register::Control => Constant::ALL.len(),
            Register::Adc => Constant::ALL.len() + 1,
        }
    }

    /// The place that commands name.
    pub const fn place(self) -> u16 {
        Register::SELECT | self.number() as u16
    }

    /// The register at a place, whose other bits are ignored; none where there is no register.
    ///
    /// ```
    /// # use hapticore_protocol::Register;
    /// assert!(Register::ALL.iter().all(|register| Register::of_place(register.place()) == Some(*register)));
    /// assert_eq!(Register::of_place(3), None, "a word of the position table");
    /// ```
    pub fn of_place(place: u16) -> Option<Self> {
        let number = place & ((1 << PLACE.width) - 1);
        let is_register = place & Register::SELECT != 0;
        Register::ALL.get(usize::from(number)).copied().filter(|_| is_register)
    }

    /// The format of its code.
    pub fn format(self, formats: &WordFormats) -> Format {
        match self {
            Register::Constant(constant) => formats.constants[constant as usize],
            Register::Control => Control::FORMAT,
            Register::Adc => ADC,
        }
    }
}

impl fmt::Display for Register {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Register::Constant(constant) => constant.name(),
            Register::Control => "control",
            Register::Adc => "adc",
        })
    }
}

/// The bits of the control register.
#[derive(Debug, Clone, Copy)]
pub struct Control;

impl Control {
    /// The board converts and measures. Setting it begins the first pad's slot.
    pub const ENABLE: u8 = 0;
    /// The ADC is held in reset.
    pub const ADC_RESET: u8 = 1;
    /// The ADC converts, and the board compares what one of its lines brings; nothing is measured or driven. Not beside
    /// [`Control::ENABLE`], which takes precedence.
    pub const LINE_TEST: u8 = 2;
    /// The first of three bits: the line of a test.
    pub const LINE: u8 = 3;
    /// The format of the register.
    pub const FORMAT: Format = Format::unsigned(6, 0);
}
