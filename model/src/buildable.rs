// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a block asks of a profile before it is built: whether its words are words of the model.

use hapticore_contract::profile::ProfileError;
use hapticore_hdl::format::{Format, MAX_WIDTH};

/// Whether a word of a block is one of the model's; a field of the profile makes it as wide as it
/// is.
pub(crate) fn fits(field: &str, word: &str, width: u8) -> Result<(), ProfileError> {
    if width <= MAX_WIDTH {
        return Ok(());
    }
    let expected = format_args!("{word} of at most {MAX_WIDTH} bits");
    let lacking = width - MAX_WIDTH;
    let s = if lacking == 1 { "" } else { "s" };
    Err(ProfileError::value(
        field,
        expected,
        format_args!("{width}: a word lacks {lacking} bit{s}"),
    ))
}

/// Whether words of the model suffice to round a signal to the format of a field.
pub(crate) fn rounds(
    field: &str,
    name: &str,
    signal: Format,
    to: Format,
) -> Result<(), ProfileError> {
    fits(field, &format!("{name} with room to round it,"), signal.rounding_width(to))
}
