// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whether a core can be built of a profile: its blocks are asked.
//!
//! The contract's [`Profile::check_values`] holds the ranges that a profile states of itself. Two questions are left that only
//! blocks answer: whether every signal fits a word of the model ([`MAX_WIDTH`]), and whether the clocks of a sample and of a
//! slot suffice.

use crate::blocks::core::Core;
use crate::blocks::demodulator::{Demodulator, POLYPHASE_GAIN};
use crate::blocks::estimator::Estimator;
use crate::blocks::position::Position;
use hapticore_contract::calibration::Layout;
use hapticore_contract::profile::{self, Profile, ProfileError};
use hapticore_hdl::format::{Format, MAX_WIDTH};

// What the contract says of the core's behaviour, and what the blocks do.
const _: () = assert!(POLYPHASE_GAIN == profile::POLYPHASE_GAIN);
const _: () = assert!(Position::TOLERANCE_BITS == Layout::TOLERANCE_BITS);
const _: () = assert!(Position::STEP_CELLS == Layout::STEP_CELLS);

type Check = Result<(), ProfileError>;

impl Core {
    /// The core of a profile that need not have been checked.
    ///
    /// # Errors
    /// As [`check`].
    pub fn try_new(profile: &Profile) -> Result<Core, ProfileError> {
        check(profile)?;
        Ok(Core::new(profile))
    }
}

/// Reads a profile that a core can be built from: [`Profile::parse`], then [`check`].
///
/// # Errors
/// As either.
pub fn parse_profile(text: &str) -> Result<Profile, ProfileError> {
    let profile = Profile::parse(text)?;
    check(&profile)?;
    Ok(profile)
}

/// Whether a core can be built of a profile: its values are in their ranges, its signals fit the model's words, and its clocks
/// suffice.
///
/// ```
/// use hapticore_contract::profile::Profile;
///
/// let mut profile = Profile::bundled("small")?;
/// hapticore_model::check(&profile)?;
/// profile.clocks_per_sample = 12;
/// let error = hapticore_model::check(&profile).unwrap_err();
/// assert_eq!(error.to_string(), "clocks_per_sample: expected 13 to 65536, got 12");
/// # Ok::<(), hapticore_contract::profile::ProfileError>(())
/// ```
///
/// # Errors
/// The first value that does not allow it: field, range and value.
pub fn check(profile: &Profile) -> Check {
    profile.check_values()?;
    check_widths(profile)?;
    check_clocks(profile)
}

const ROUNDED: &str = "what is rounded to it";

/// Bits of a signal with the point of the format to which it is rounded, before that saturates.
fn before(signal: Format, to: Format) -> i16 {
    signal.integer_bits() + 2 + i16::from(to.frac).max(i16::from(signal.frac))
}

/// What grows with counts, or with several formats at once, still fits a word of the model.
fn check_widths(profile: &Profile) -> Check {
    let (f, terminals) = (&profile.formats, profile.terminals.x.len() as u64);
    let amplitude = i16::from(profile.amplitude_format().width);
    let sums = amplitude + i16::from(Format::counter(terminals).width);
    let demodulator = Demodulator::new(profile);
    let sum = demodulator.sum();
    // An I/Q word with all the bits that it may be moved up by, before it is narrowed.
    let integer = sum.integer_bits() - i16::from(profile.sum_shift() - demodulator.shift());
    let moved = integer + 2 + i16::from(f.iq.frac) + i16::from(f.block_shift);
    for (field, width, of) in [
        ("formats.iq", moved, ROUNDED),
        ("slot.integrate", i16::from(sum.width), "a sum over the window"),
        ("formats.ratio", sums + i16::from(f.ratio.frac), "the dividend of a ratio"),
        ("formats.admittance", amplitude + i16::from(f.admittance.frac), "the dividend of the admittance"),
        ("formats.capacitance", before(f.admittance.product(f.capacitance_gain), f.capacitance), ROUNDED),
        ("formats.square", before(f.capacitance.product(f.capacitance), f.square), ROUNDED),
        ("formats.square", before(f.square.product(f.mean_square), f.square), ROUNDED),
        ("formats.force", before(f.square.product(f.force_gain), f.force), ROUNDED),
        ("formats.mean_square", before(sum, f.mean_square), ROUNDED),
    ] {
        let most = i16::from(MAX_WIDTH);
        if width > most {
            return Err(ProfileError::value(field, format_args!("{of} of at most {most} bits"), width));
        }
    }
    Ok(())
}

fn check_clocks(profile: &Profile) -> Check {
    // The next window begins when the last one's sums have been read out and its frame is made.
    let estimate = Demodulator::new(profile).latency() + Estimator::new(profile).latency();
    let blanking = profile.slot.blanking() * profile.clocks_per_sample;
    if blanking <= estimate {
        let expected = format_args!("more than {estimate} clocks of blanking").to_string();
        return Err(ProfileError::value("slot.settle", expected, blanking));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_core_can_be_built_of_every_bundled_profile() {
        for profile in Profile::all() {
            assert!(Core::try_new(&profile).is_ok(), "{}: {:?}", profile.name, check(&profile));
        }
    }

    #[test]
    fn the_demodulator_takes_as_many_clocks_a_sample_as_the_contract_says() {
        for mut profile in Profile::all() {
            for terminals in 3..=16 {
                (profile.terminals.x, profile.terminals.y) = (vec![1; terminals], vec![-1; terminals]);
                let least = Demodulator::new(&profile).least_clocks_per_sample();
                assert_eq!(least, profile.least_clocks_per_sample(), "{}, {terminals} terminals", profile.name);
            }
        }
    }

    /// What values alone do not tell: the contract accepts it, the core's blocks refuse it.
    #[test]
    fn blocks_refuse_what_values_alone_do_not_tell() {
        for (change, field) in [
            ((|p| p.slot.settle = 0) as fn(&mut Profile), "slot.settle"),
            (|p| p.formats.square = Format::unsigned(28, 48), "formats.square"),
        ] {
            let mut profile = Profile::bundled("standard").expect("bundled");
            change(&mut profile);
            assert_eq!(profile.check_values(), Ok(()), "{field}");
            match Core::try_new(&profile).err() {
                Some(ProfileError::Value { field: refused, .. }) => assert_eq!(refused, field),
                other => panic!("{field}: {other:?}"),
            }
        }
    }
}
