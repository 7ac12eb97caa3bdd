// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core's ports and the words of a calibration: which port takes which word of
//! [`hapticore_protocol`].

use hapticore_hdl::bundle::{Bundle, Field};
use hapticore_hdl::format::Format;
use hapticore_model::blocks::estimator::Calibration;
use hapticore_protocol::{Constant, WordFormats};

pub use hapticore_protocol::{CalibrationWords, ConstantWord, DriveWord, Setting};

/// The formats of a calibration's words, of a core with these ports and no drive.
///
/// # Panics
/// If the core has no port for a constant.
pub fn word_formats(ports: &Calibration<Format>) -> WordFormats {
    WordFormats {
        constants: Constant::ALL.map(|constant| port(ports, constant)),
        table: ports.table.word,
        drive_bits: 0,
    }
}

fn port(ports: &Calibration<Format>, constant: Constant) -> Format {
    let mut found = None;
    Calibration::each(*ports, |&Field { name, .. }, format| {
        found = found.or((name == constant.name()).then_some(format))
    });
    found.expect("a port for each constant")
}

#[cfg(test)]
mod tests {
    use super::*;
    use hapticore_contract::profile::Profile;
    use hapticore_model::blocks::core::Core;

    /// The port of the position table.
    const TABLE: [&str; 3] = ["write", "address", "word"];

    #[test]
    fn the_words_of_a_calibration_are_the_ports_of_the_core() {
        for profile in Profile::all() {
            let ports = Core::new(&profile).inputs().calibration;
            assert_eq!(word_formats(&ports), WordFormats::new(&profile), "{}", profile.name);
        }
        let mut ports: Vec<_> = Calibration::FIELDS.iter().map(|field| field.name).collect();
        ports.retain(|name| !TABLE.contains(name));
        assert_eq!(ports, Constant::ALL.map(Constant::name), "in their order");
    }
}
