// SPDX-License-Identifier: MIT OR Apache-2.0
//! The words of a frame: their order and formats.

use crate::profile::Profile;
use hapticore_hdl::format::Format;

/// A word of a frame.
///
/// ```
/// use hapticore_contract::{frame::Field, profile::Profile};
///
/// let profile = Profile::bundled("standard")?;
/// assert_eq!(Field::ALL[Field::Capacitance as usize], Field::Capacitance);
/// let word = Field::word(&profile);
/// assert!(Field::ALL.iter().all(|field| word.holds(field.format(&profile).integer())), "codes are integers of one width");
/// # Ok::<(), hapticore_contract::profile::ProfileError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Field {
    /// The x ratio.
    RatioX,
    /// The y ratio.
    RatioY,
    /// The position along the long edges, in mm.
    X,
    /// The position along the short edges, in mm.
    Y,
    /// The sheet's resistance, in full scales of voltage per current.
    Sheet,
    /// The capacitance, in pF.
    Capacitance,
    /// The haptic force, in N.
    Force,
    /// The mean square of the haptic voltage, in full scales squared.
    MeanSquare,
}

impl Field {
    /// All fields, in the order of a frame's words.
    pub const ALL: [Field; 8] = [
        Field::RatioX,
        Field::RatioY,
        Field::X,
        Field::Y,
        Field::Sheet,
        Field::Capacitance,
        Field::Force,
        Field::MeanSquare,
    ];

    /// The format of the field. Ratios are rounded to the width of the widest other word: frames
    /// are no wider for them.
    pub fn format(self, profile: &Profile) -> Format {
        let f = &profile.formats;
        match self {
            Field::RatioX | Field::RatioY => {
                let cut = f.ratio.width.saturating_sub(widest(&Field::ALL[2..], profile));
                Format::signed(f.ratio.width - cut, f.ratio.frac - cut as i8)
            }
            Field::X | Field::Y => f.position,
            Field::Sheet => profile.sheet(),
            Field::Capacitance => f.capacitance,
            Field::Force => f.force,
            Field::MeanSquare => f.mean_square,
        }
    }

    /// The signed integer format that holds the code of every field.
    pub fn word(profile: &Profile) -> Format {
        Format::signed(widest(&Field::ALL, profile), 0)
    }
}

/// Bits of a signed word that holds the code of each of the fields.
fn widest(fields: &[Field], profile: &Profile) -> u8 {
    let bits = |field: &Field| {
        let format = field.format(profile);
        format.width + u8::from(!format.signed)
    };
    fields.iter().map(bits).max().expect("there are fields")
}
