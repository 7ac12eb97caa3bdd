// SPDX-License-Identifier: MIT OR Apache-2.0
//! How exactly a core is run: every clock, every slot to the same bits, or in floating point.

pub mod clock;
pub mod fixed;
pub mod force_loop;
mod tone;

use crate::blocks::core::{Core, In, Inputs, Out};
use crate::blocks::estimator;
use crate::blocks::position::TablePort;
use hapticore_contract::calibration::Calibration;
use hapticore_contract::frame::{Flags, Frame};
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::{self, Signal, Value, constant};

/// The signals of a bundle of constants.
pub(crate) fn signals<S: Bundle, V: Value>(
    codes: S::Of<i64>,
    formats: S::Of<Format>,
) -> S::Of<Signal<V>> {
    S::map(S::zip(codes, formats), |(code, format)| signal::code(code, format))
}

/// Gathers the words of a frame as the core gives them out.
#[derive(Debug, Clone, Copy, Default)]
struct Gathered {
    codes: [i64; 8],
}

impl Gathered {
    /// Stores a valid word at its index.
    #[inline(always)]
    fn accept_word(&mut self, valid: i64, index: i64, word: i64) {
        if valid != 0 {
            self.codes[index as usize] = word;
        }
    }

    /// The frame, with the last word's flags.
    #[inline(always)]
    fn frame<V: Value>(self, last: estimator::FramePort<Signal<V>>) -> Frame {
        let set = |flag: Signal<V>| V::code(flag) != 0;
        let [clipped, saturated, invalid, lost] =
            [last.clipped, last.saturated, last.invalid, last.lost].map(set);
        Frame {
            pad: V::code(last.pad) as usize,
            codes: self.codes,
            flags: Flags { clipped, saturated, invalid, lost },
        }
    }
}

/// The state of a core with the calibration's tables written into it, through its port.
fn calibrated<V: Interpretation>(
    core: &Core,
    profile: &Profile,
    calibration: &Calibration,
) -> State<Core, V> {
    let mut state = core.reset();
    let formats = core.inputs();
    let constants = core.idle_inputs(calibration);
    let memory = core.estimator().table();
    for (address, word) in calibration.words(profile).into_iter().enumerate() {
        let codes = constants.with_table(TablePort { write: 1, address: address as i64, word: 0 });
        let mut inputs = signals::<Inputs, V>(codes, formats);
        inputs.calibration.table.word = constant(word, memory.format);
        clock(core, &mut state, inputs);
    }
    state
}

/// A clock of a core where nobody waits for it: out of line, so that all who call it share what is
/// large.
#[inline(never)]
fn clock<V: Interpretation>(core: &Core, state: &mut State<Core, V>, inputs: In<V>) -> Out<V> {
    core.clock(state, inputs)
}
