// SPDX-License-Identifier: MIT OR Apache-2.0
//! How exactly a core is run: every clock, every slot to the same bits, or in floating point.

pub mod clock;
pub mod fixed;
mod tone;

use crate::block::{Block, Cell};
use crate::blocks::core::{Core, Inputs, Outputs};
use crate::bundle::Bundle;
use crate::calibration::Calibration;
use crate::format::Format;
use crate::frame::{Flags, Frame};
use crate::signal::{self, Signal, Value, constant};

/// The signals of a bundle of constants.
pub(crate) fn signals<S: Bundle, V: Value>(codes: S::Of<i64>, formats: S::Of<Format>) -> S::Of<Signal<V>> {
    S::map(S::zip(codes, formats), |(code, format)| signal::code(code, format))
}

/// The core's inputs that never change while it runs, as codes; the others are zero.
pub fn constants(calibration: &Calibration, formats: Inputs<Format>) -> Inputs<i64> {
    Inputs {
        strobe: 0,
        clear: 0,
        code: 0,
        capacitance_gain: formats.capacitance_gain.code_saturating(calibration.capacitance_gain),
        force_gain: formats.force_gain.code_saturating(calibration.force_gain),
        write: 0,
        address: 0,
        word: 0,
    }
}

/// Gathers the words of a frame as the core gives them out.
#[derive(Debug, Clone, Copy, Default)]
struct Gathered {
    codes: [i64; 8],
}

impl Gathered {
    #[inline(always)]
    fn take(&mut self, valid: i64, index: i64, word: i64) {
        if valid != 0 {
            self.codes[index as usize] = word;
        }
    }

    fn frame(self, pad: i64, clipped: i64, saturated: i64, invalid: i64, lost: i64) -> Frame {
        let [clipped, saturated, invalid, lost] = [clipped, saturated, invalid, lost].map(|flag| flag != 0);
        Frame { pad: pad as usize, codes: self.codes, flags: Flags { clipped, saturated, invalid, lost } }
    }
}

/// A cell of a core with the calibration's tables written into it, through its port.
fn calibrated<V: Value>(core: &Core, calibration: &Calibration) -> Cell<Core, V> {
    let mut cell = core.cell();
    let formats = core.inputs();
    let constants = constants(calibration, formats);
    let memory = core.estimator().position().table();
    for (address, &word) in calibration.position.words.iter().enumerate() {
        let codes = Inputs { write: 1, address: address as i64, ..constants };
        let mut inputs = signals::<Inputs, V>(codes, formats);
        inputs.word = constant(word, memory.format);
        clock(core, &mut cell, inputs);
    }
    cell
}

/// A clock of a core where nobody waits for it: out of line, so that all who call it share what is large.
#[inline(never)]
fn clock<V: Value>(core: &Core, cell: &mut Cell<Core, V>, inputs: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
    core.clock(cell, inputs)
}
