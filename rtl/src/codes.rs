// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core's ports and the words of a calibration: which port takes which word of [`hapticore_protocol`].

use hapticore_model::blocks::core::Inputs;
use hapticore_model::bundle::Bundle;
use hapticore_model::format::Format;
use hapticore_protocol::{Constant, WordFormats};

pub use hapticore_protocol::{CalibrationWords, ConstantWord};

/// The formats of a calibration's words, of a core with these inputs.
///
/// # Panics
/// If the core has no port for a constant.
pub fn word_formats(core: &Inputs<Format>) -> WordFormats {
    WordFormats { constants: Constant::ALL.map(|constant| port(core, constant)), table: core.word }
}

fn port(core: &Inputs<Format>, constant: Constant) -> Format {
    let mut found = None;
    Inputs::each(*core, |name, format| found = found.or((name == constant.name()).then_some(format)));
    found.expect("a port for each constant")
}

#[cfg(test)]
mod tests {
    use super::*;
    use hapticore_model::block::Block;
    use hapticore_model::blocks::core::Core;
    use hapticore_model::profile::Profile;

    /// The core's inputs that are no constants: samples, and the port of the position table.
    const MOVING: [&str; 6] = ["strobe", "clear", "code", "write", "address", "word"];

    #[test]
    fn the_words_of_a_calibration_are_the_ports_of_the_core() {
        for profile in Profile::all() {
            let core = Core::new(&profile).inputs();
            assert_eq!(word_formats(&core), WordFormats::new(&profile), "{}", profile.name);
        }
        let mut ports: Vec<_> = Inputs::NAMES.to_vec();
        ports.retain(|name| !MOVING.contains(name));
        assert_eq!(ports, Constant::ALL.map(Constant::name), "in their order");
    }
}
