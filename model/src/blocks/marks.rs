// SPDX-License-Identifier: MIT OR Apache-2.0
//! Marks: a bit per pad, in a register.
//!
//! A memory has no reset. A word of it that can reach a drive counts only where its pad is marked: after a reset, and
//! where the marks are taken off, it counts as zero until it is written again.

use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::Interpretation;
use hapticore_hdl::format::{Format, MAX_WIDTH};
use hapticore_hdl::signal::{Signal, zero};

/// The marks of `pads` pads.
pub(super) const fn format(pads: u64) -> Format {
    Format::unsigned(pads as u8, 0)
}

/// Whether there is a bit for each pad of a profile that drives them.
///
/// # Errors
/// More pads than a word has bits.
pub(super) fn check(profile: &Profile) -> Result<(), ProfileError> {
    if profile.pads <= MAX_WIDTH.into() {
        return Ok(());
    }
    let expected = format_args!("at most {MAX_WIDTH} with a force controller");
    Err(ProfileError::value("pads", expected, profile.pads))
}

/// Whether a pad is marked.
#[inline(always)]
pub(super) fn is_marked<V: Interpretation>(marks: Signal<V>, pad: Signal<V>) -> Signal<V> {
    let of = |n: u8| marks.bits(n, 1) & pad.is(n.into());
    (1..marks.format.width).fold(of(0), |any, n| any | of(n))
}

/// The marks, with that of a pad as `to` where it is written.
#[inline(always)]
pub(super) fn written<V: Interpretation>(
    marks: Signal<V>,
    (write, pad): (Signal<V>, Signal<V>),
    to: Signal<V>,
) -> Signal<V> {
    let of = |n: u8| (write & pad.is(n.into())).select(to, marks.bits(n, 1));
    (1..marks.format.width).fold(of(0), |low, n| of(n).concat(low))
}

/// No marks where they are taken off, else these.
#[inline(always)]
pub(super) fn unless<V: Interpretation>(off: Signal<V>, marks: Signal<V>) -> Signal<V> {
    off.select(zero(marks.format), marks)
}

#[cfg(test)]
mod tests {
    use super::{is_marked, written};
    use hapticore_hdl::format::Format;
    use hapticore_hdl::signal::{Clocked, Signal, bit, code};

    #[test]
    fn a_mark_is_that_of_its_pad_alone() {
        let (marks, pads) = (Format::unsigned(5, 0), Format::counter(4));
        for (word, pad) in (0..32).flat_map(|word| (0..5).map(move |pad| (word, pad))) {
            let [of, pad_word]: [Signal<Clocked>; 2] = [code(word, marks), code(pad, pads)];
            assert_eq!(is_marked(of, pad_word).value, word >> pad & 1);
            for (write, to) in [(false, true), (true, false), (true, true)] {
                let set = if to { word | 1 << pad } else { word & !(1 << pad) };
                let got = written(of, (bit(write), pad_word), bit(to));
                assert_eq!((got.value, got.format), (if write { set } else { word }, marks));
            }
        }
    }
}
