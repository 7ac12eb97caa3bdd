// SPDX-License-Identifier: MIT OR Apache-2.0
//! How exactly a core is run: every clock, every slot to the same bits, or in floating point; and
//! what its results are expected to be off.

pub mod clock;
pub mod fixed;
pub mod force_loop;
pub mod noise;
mod plain;
mod tone;

use crate::blocks::estimator;
use hapticore_contract::frame::{Flags, Frame};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::{self, Signal, Value};

/// Refuses a pad that the core does not serve, before anything of it has changed.
///
/// # Panics
/// Where there is no such pad.
pub(crate) fn assert_pad(pad: usize, pads: usize) {
    assert!(pad < pads, "pad: expected below {pads}, got {pad}");
}

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
        let [clipped, saturated, invalid, lost, lifted] =
            [last.clipped, last.saturated, last.invalid, last.lost, last.lifted].map(set);
        Frame {
            pad: V::code(last.pad) as usize,
            codes: self.codes,
            flags: Flags { clipped, saturated, invalid, lost, lifted },
        }
    }
}
