// SPDX-License-Identifier: MIT OR Apache-2.0
//! Codes: what makes a calibration's sensor of a core: the constants at its ports, and the words of its position table.
//!
//! The one list of them: start-up of a board, vectors for users of the Verilog and `hapticore codes` all take it.

use hapticore_contract::calibration::Calibration;
use hapticore_contract::profile::Profile;
use hapticore_hdl::bundle::{Bundle, Field};
use hapticore_hdl::format::Format;
use hapticore_model::blocks::core::{Core, Inputs};

/// The core's inputs that are no constants: samples, and the port of the position table.
const MOVING: [&str; 6] = ["strobe", "clear", "code", "write", "address", "word"];

/// The codes of a calibration for a core.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Codes {
    /// The core's inputs: constants as they are to be, all others zero.
    pub inputs: Inputs<i64>,
    /// Their formats.
    pub formats: Inputs<Format>,
    /// The words of the position table, by address, in the format of [`Inputs::word`].
    pub table: Vec<i64>,
}

/// A constant at a port of the core.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Constant {
    /// The name of the port, and of a board's register.
    pub name: &'static str,
    /// What the model says of it.
    pub about: &'static str,
    /// The code.
    pub code: i64,
    /// Its format.
    pub format: Format,
}

impl Codes {
    /// The codes of a calibration for a core of a profile.
    pub fn new(profile: &Profile, calibration: &Calibration) -> Self {
        let core = Core::new(profile);
        let (inputs, formats) = (core.idle_inputs(calibration), core.inputs());
        let word = formats.calibration.table.word;
        let table = calibration.position.words.iter().map(|&real| word.code_saturating(real)).collect();
        Codes { inputs, formats, table }
    }

    /// The constants, in the order of the core's ports.
    pub fn constants(&self) -> Vec<Constant> {
        let mut constants = Vec::new();
        Inputs::each(Inputs::zip(self.inputs, self.formats), |&Field { name, doc, .. }, (code, format)| {
            constants.push(Constant { name, about: doc.trim(), code, format });
        });
        constants.retain(|constant| !MOVING.contains(&constant.name));
        constants
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_input_of_the_core_is_a_constant_or_moves() {
        let profile = Profile::bundled("small").expect("bundled");
        let formats = Core::new(&profile).inputs();
        let codes = Codes { inputs: Inputs::map(formats, |_| 1), formats, table: Vec::new() };
        let constants = codes.constants();
        assert_eq!(constants.len() + MOVING.len(), Inputs::FIELDS.len());
        let gain = constants.iter().find(|constant| constant.name == "capacitance_gain").expect("a constant");
        assert_eq!(
            (gain.format, gain.about),
            (formats.calibration.capacitance_gain, "Calibration: picofarads at an admittance of one.")
        );
    }
}
