// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whether a core can be built of a profile: its blocks are asked.
//!
//! The contract's [`Profile::check_values`] holds the ranges that a profile states of itself. Only blocks answer the
//! other two questions: whether every signal fits a word of the model
//! ([`MAX_WIDTH`](hapticore_hdl::format::MAX_WIDTH)), and whether the clocks of a slot suffice. Each block answers the
//! first as it is built.

use crate::blocks::core::Core;
use crate::blocks::demodulator::POLYPHASE_GAIN;
use crate::blocks::force_loop::ForceLoop;
use crate::blocks::position::Position;
use hapticore_contract::calibration::Layout;
use hapticore_contract::profile::{self, Profile, ProfileError};

// What the contract says of the core's behaviour, and what the blocks do.
const _: () = assert!(POLYPHASE_GAIN == profile::POLYPHASE_GAIN);
const _: () = assert!(Position::TOLERANCE_BITS == Layout::TOLERANCE_BITS);
const _: () = assert!(Position::STEP_CELLS == Layout::STEP_CELLS);

/// Reads a profile that a core can be built from: [`Profile::parse`], then [`check`].
///
/// # Errors
/// As [`Profile::parse`], and as [`check`].
pub fn parse_profile(text: &str) -> Result<Profile, ProfileError> {
    let profile = Profile::parse(text)?;
    check(&profile)?;
    Ok(profile)
}

/// Whether a core can be built of a profile: its values are in their ranges, its signals fit the
/// model's words, and its clocks suffice.
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
pub fn check(profile: &Profile) -> Result<(), ProfileError> {
    match profile.control {
        Some(_) => ForceLoop::try_new(profile).map(drop),
        None => Core::try_new(profile).map(drop),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blocks::demodulator::Demodulator;
    use hapticore_hdl::format::Format;

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
                (profile.terminals.x, profile.terminals.y) =
                    (vec![1; terminals], vec![-1; terminals]);
                let least = Demodulator::try_new(&profile).unwrap().least_clocks_per_sample();
                assert_eq!(
                    least,
                    profile.least_clocks_per_sample(),
                    "{}, {terminals} terminals",
                    profile.name
                );
            }
        }
    }

    /// What values alone do not tell: the contract accepts it, the core's blocks refuse it.
    #[test]
    fn blocks_refuse_what_values_alone_do_not_tell() {
        for (change, field) in [
            (
                (|p| (p.slot.open, p.slot.settle, p.slot.integrate) = (1, 0, 304))
                    as fn(&mut Profile),
                "slot.settle",
            ),
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
