// SPDX-License-Identifier: MIT OR Apache-2.0
//! Number formats: how the bits of a word are read as a number.
//!
//! `s18.17` is a signed word of 18 bits, 17 of them after the binary point; `u32.32` is unsigned
//! and all fraction. The point may lie outside the word (`u18.38`), as calibrated constants need.
//! Formats are run-time values, so that a sweep over word lengths needs no recompilation.

use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;

/// The widest word a clocked signal may have: raw codes are stored in an `i64`.
pub const MAX_WIDTH: u8 = 63;

/// The format of one signal: `value = code · 2^-frac`.
///
/// ```
/// use hapticore_hdl::format::Format;
///
/// let volts: Format = "s18.8".parse()?;
/// assert_eq!(volts, Format::signed(18, 8));
/// assert_eq!((volts.min_code(), volts.max_code(), volts.lsb()), (-131072, 131071, 1.0 / 256.0));
/// assert_eq!(volts.real(-384), -1.5);
/// # Ok::<(), hapticore_hdl::format::FormatError>(())
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Format {
    /// Whether codes are two's complement.
    pub signed: bool,
    /// Bits in the word, sign included.
    pub width: u8,
    /// Bits after the binary point; negative where the least significant bit is worth more than
    /// one.
    pub frac: i8,
}

/// One bit: flags, strobes, the result of a comparison.
pub const BIT: Format = Format::unsigned(1, 0);

impl Format {
    /// No bits: an output or a register of this format is absent, which a block's configuration may
    /// decide. It is neither printed nor traced, and holds 0.
    ///
    /// Its point is to the left of every word's: joined with another format, the other's stays.
    pub const NONE: Format = Format::unsigned(0, -64);

    /// Whether there are no bits.
    #[inline(always)]
    pub const fn is_none(self) -> bool {
        self.width == 0
    }

    /// This format, or none.
    #[inline(always)]
    pub const fn where_present(self, present: bool) -> Self {
        if present { self } else { Format::NONE }
    }

    /// A signed format of `width` bits, `frac` of them after the point.
    #[inline(always)]
    pub const fn signed(width: u8, frac: i8) -> Self {
        Format { signed: true, width, frac }
    }

    /// An unsigned format of `width` bits, `frac` of them after the point.
    #[inline(always)]
    pub const fn unsigned(width: u8, frac: i8) -> Self {
        Format { signed: false, width, frac }
    }

    /// The narrowest unsigned integer format that holds `0 ..= most`.
    #[inline(always)]
    pub const fn counter(most: u64) -> Self {
        let bits = 64 - most.leading_zeros();
        Format::unsigned(if bits == 0 { 1 } else { bits as u8 }, 0)
    }

    /// The largest code.
    #[inline(always)]
    pub const fn max_code(self) -> i128 {
        (1i128 << (self.width - self.signed as u8)) - 1
    }

    /// The smallest code.
    #[inline(always)]
    pub const fn min_code(self) -> i128 {
        if self.signed { -(1i128 << (self.width - 1)) } else { 0 }
    }

    /// This unsigned integer format: [`Format::assume_frac`] for a counter.
    #[inline(always)]
    pub const fn as_uint(self) -> Self {
        debug_assert!(!self.signed && self.frac == 0);
        Format::unsigned(self.width, 0)
    }

    /// This format, whose point is known to be there: said where it is asked for at every clock,
    /// for the compiler then knows which formats have theirs at the same place, and need no
    /// aligning.
    #[inline(always)]
    pub const fn assume_frac(self, frac: i8) -> Self {
        debug_assert!(self.frac == frac);
        Format { frac, ..self }
    }

    /// The codes of this format, read as integers.
    #[inline(always)]
    pub const fn integer(self) -> Self {
        Format { frac: 0, ..self }
    }

    /// The format of the same codes with the point moved: of numbers `2^by` times as large.
    #[inline(always)]
    pub const fn scaled(self, by: i8) -> Self {
        Format { frac: self.frac - by, ..self }
    }

    /// The format of numbers of this one that are rounded to the steps of `to`, before those beyond
    /// `to` saturate.
    ///
    /// ```
    /// # use hapticore_hdl::format::Format;
    /// let (sum, word) = (Format::signed(20, 17), Format::signed(8, 7));
    /// assert_eq!(sum.rounded(word), Format::signed(11, 7), "one bit more than its own, for rounding up");
    /// assert_eq!(sum.rounding_width(word), 20);
    /// ```
    #[inline(always)]
    pub fn rounded(self, to: Format) -> Self {
        let width = self.integer_bits() + 1 + i16::from(to.frac) + i16::from(self.signed);
        Format { signed: self.signed, width: clip(width.max(i16::from(to.width))), frac: to.frac }
    }

    /// Bits of the widest word that rounding to `to` takes: the number, the half step that is added
    /// to it, the result.
    pub fn rounding_width(self, to: Format) -> u8 {
        let half_step = i16::from(self.frac) - i16::from(to.frac);
        self.rounded(to).width.max(self.width).max(clip(half_step))
    }

    /// What one code step is worth.
    #[inline(always)]
    pub fn lsb(self) -> f64 {
        // 2^-frac by its exponent alone: quicker than a power.
        f64::from_bits(((1023 - i64::from(self.frac)) as u64) << 52)
    }

    /// The number that `code` stands for.
    #[inline(always)]
    pub fn real(self, code: i64) -> f64 {
        code as f64 * self.lsb()
    }

    /// The code nearest to `real`, ties to even; `None` where the format cannot represent it.
    ///
    /// ```
    /// # use hapticore_hdl::format::Format;
    /// let halves = Format::signed(4, 1); // -4 to 3.5 in steps of a half
    /// assert_eq!([0.25, 0.75, 3.5].map(|real| halves.code(real)), [Some(0), Some(2), Some(7)]);
    /// assert_eq!(halves.code(3.75), None, "it rounds to 4");
    /// assert_eq!([3.75, -9.0, f64::NAN].map(|real| halves.code_saturating(real)), [7, -8, 0]);
    /// ```
    #[inline(always)]
    pub fn code(self, real: f64) -> Option<i64> {
        let code = (real / self.lsb()).round_ties_even();
        let holds = code >= self.min_code() as f64 && code <= self.max_code() as f64;
        holds.then_some(code as i64)
    }

    /// The code nearest to `real`, saturated to the format; zero for NaN.
    #[inline(always)]
    pub fn code_saturating(self, real: f64) -> i64 {
        let code = (real / self.lsb()).round_ties_even();
        code.clamp(self.min_code() as f64, self.max_code() as f64) as i64
    }

    /// Bits before the binary point, without the sign.
    #[inline(always)]
    pub const fn integer_bits(self) -> i16 {
        self.width as i16 - self.signed as i16 - self.frac as i16
    }

    /// Whether every number of `other` is a number of this format.
    ///
    /// ```
    /// # use hapticore_hdl::format::Format;
    /// let word = Format::signed(18, 17);
    /// assert!(word.holds(Format::unsigned(17, 17)) && !word.holds(Format::unsigned(18, 17)));
    /// assert_eq!(word.join(Format::unsigned(18, 17)), Format::signed(19, 17));
    /// ```
    #[inline(always)]
    pub const fn holds(self, other: Format) -> bool {
        let sign = self.signed || !other.signed;
        sign && self.integer_bits() >= other.integer_bits() && self.frac >= other.frac
    }

    /// The narrowest format that holds every number of both.
    #[inline(always)]
    pub fn join(self, other: Format) -> Format {
        let signed = self.signed || other.signed;
        let frac = self.frac.max(other.frac);
        let width = match (self.is_none(), other.is_none()) {
            (true, _) => other.width,
            (_, true) => self.width,
            _ => {
                let integer = self.integer_bits().max(other.integer_bits());
                clip(integer + i16::from(frac) + i16::from(signed))
            }
        };
        Format { signed, width, frac }
    }

    /// The exact format of a sum.
    #[inline(always)]
    pub fn sum(self, other: Format) -> Format {
        let join = self.join(other);
        Format { width: clip(i16::from(join.width) + 1), ..join }
    }

    /// The exact format of a difference.
    #[inline(always)]
    pub fn difference(self, other: Format) -> Format {
        let join = self.join(other);
        Format { signed: true, width: clip(i16::from(join.width) + 1), frac: join.frac }
    }

    /// The exact format of a product.
    ///
    /// ```
    /// # use hapticore_hdl::format::Format;
    /// let (x, w) = (Format::signed(16, 15), Format::unsigned(16, 16));
    /// assert_eq!(x.product(w), Format::signed(32, 31));
    /// assert_eq!(x.sum(x), Format::signed(17, 15));
    /// assert_eq!(w.difference(w), Format::signed(17, 16));
    /// ```
    #[inline(always)]
    pub fn product(self, other: Format) -> Format {
        Format {
            signed: self.signed || other.signed,
            width: clip(i16::from(self.width) + i16::from(other.width)),
            frac: self.frac + other.frac,
        }
    }
}

/// A width as stored; a width past 255 is a broken invariant long past [`MAX_WIDTH`].
#[inline(always)]
fn clip(width: i16) -> u8 {
    width.clamp(1, 255) as u8
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}.{}", if self.signed { 's' } else { 'u' }, self.width, self.frac)
    }
}

impl fmt::Debug for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// A text that is not a format.
///
/// ```
/// # use hapticore_hdl::format::Format;
/// let message = "s64.0".parse::<Format>().unwrap_err().to_string();
/// assert_eq!(message, r#"expected a format such as "s18.17" or "u32.32" (at most 63 bits), got "s64.0""#);
/// ```
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected a format such as \"s18.17\" or \"u32.32\" (at most {MAX_WIDTH} bits), got \"{0}\""
)]
pub struct FormatError(String);

impl FromStr for Format {
    type Err = FormatError;

    fn from_str(text: &str) -> Result<Self, FormatError> {
        parse(text).ok_or_else(|| FormatError(text.into()))
    }
}

fn parse(text: &str) -> Option<Format> {
    let signed = match text.chars().next()? {
        's' => true,
        'u' => false,
        _ => return None,
    };
    let (width, frac) = text[1..].split_once('.')?;
    let format = Format { signed, width: width.parse().ok()?, frac: frac.parse().ok()? };
    (1..=MAX_WIDTH).contains(&format.width).then_some(format)
}

impl serde::Serialize for Format {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> serde::Deserialize<'de> for Format {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        text.parse().map_err(serde::de::Error::custom)
    }
}

/// A text such as `s18.17`.
impl schemars::JsonSchema for Format {
    fn schema_name() -> Cow<'static, str> {
        "WordFormat".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "type": "string",
            "title": "format, such as `s18.17`",
            "pattern": "^[su][0-9]+\\.-?[0-9]+$",
        })
    }
}

#[cfg(test)]
mod tests;
