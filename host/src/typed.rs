// SPDX-License-Identifier: MIT OR Apache-2.0
//! Words as numbers of the crate [`fixed`]: for programs that are compiled for one profile, and
//! compute without floating point.
//!
//! A profile is read at run time, a type is known at compile time. [`Word::new`] compares them
//! once, when the program starts; measurement a word after that cannot fail.

use fixed::traits::Fixed;
use hapticore_contract::format::Format;
use std::marker::PhantomData;

/// A word of a frame or of a calibration as a number of the type `F`.
///
/// ```
/// use fixed::types::{I11F5, I32F32, U3F29};
/// use hapticore_host::{Constant, Field, Flags, Frame, Profile, Word};
///
/// let profile = Profile::bundled("small")?;
/// let x_mm = Word::<I11F5>::new(Field::X.format(&profile))?;
/// let force_n = Word::<U3F29>::new(Field::Force.format(&profile))?;
///
/// let mut frame = Frame { pad: 0, codes: [0; 8], flags: Flags::default() };
/// frame.codes[Field::X as usize] = -40;
/// frame.codes[Field::Force as usize] = 1 << 12;
/// assert_eq!(x_mm.read(frame.codes[Field::X as usize]), I11F5::from_num(-1.25));
/// assert_eq!(force_n.read(frame.codes[Field::Force as usize]).to_num::<f64>(), frame.measurement(&profile).force_n);
///
/// // A type may have bits to spare; one that lacks some is refused.
/// Word::<I32F32>::new(Constant::CapacitanceGain.format(&profile))?;
/// let error = Word::<I11F5>::new(Field::Force.format(&profile)).unwrap_err();
/// assert!(error.to_string().ends_with("got s16.5"), "{error}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Word<F> {
    format: Format,
    number: PhantomData<F>,
}

/// A type that cannot represent every number of a word.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("expected a type of at most 64 bits that represents every {word}, got {got}")]
pub struct WordError {
    /// The word's format.
    pub word: Format,
    /// The format of the type that was asked for.
    pub got: Format,
}

impl<F: Fixed> Word<F>
where
    F::Bits: TryFrom<i128>,
{
    /// Words of a format, such as a field's or a constant's.
    ///
    /// # Errors
    /// A type that cannot represent every number of the format, or of more than 64 bits.
    pub fn new(format: Format) -> Result<Self, WordError> {
        let (width, frac) = (F::INT_NBITS + F::FRAC_NBITS, F::FRAC_NBITS);
        let own = Format { signed: F::IS_SIGNED, width: width as u8, frac: frac.min(127) as i8 };
        match own.width <= 64 && own.holds(format) {
            true => Ok(Word { format, number: PhantomData }),
            false => Err(WordError { word: format, got: own }),
        }
    }

    /// The number that a code stands for; one beyond the word saturates.
    pub fn read(self, code: i64) -> F {
        let code = i128::from(code).clamp(self.format.min_code(), self.format.max_code());
        let bits = code << (F::FRAC_NBITS as i32 - i32::from(self.format.frac));
        F::from_bits(
            F::Bits::try_from(bits).ok().expect("the type represents every number of the word"),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fixed::types::{I11F5, I32F32, U0F64, U16F16, U64F0};
    use proptest::prelude::*;

    /// The number of each code, its format's ends among them, is what the format says; where the
    /// type does not hold it, it is refused.
    fn check<F: Fixed>(format: Format, code: i64)
    where
        F::Bits: TryFrom<i128>,
    {
        let [low, high] = [format.min_code(), format.max_code()].map(|code| code as i64);
        match Word::<F>::new(format) {
            Ok(word) => [low, code.clamp(low, high), high].into_iter().for_each(|code| {
                assert_eq!(word.read(code).to_num::<f64>(), format.real(code), "{code} of {format}")
            }),
            Err(_) => {
                let holds = |code| {
                    F::checked_from_num(format.real(code))
                        .is_some_and(|f| f.to_num::<f64>() == format.real(code))
                };
                assert!(![low, low + 1, high].into_iter().all(holds), "{format} refused");
            }
        }
    }

    proptest! {
        #[test]
        fn words_are_the_numbers_of_their_codes(
            signed in any::<bool>(), width in 2..=48u8, frac in -16..=64i8, code in any::<i64>()
        ) {
            let format = Format { signed, width, frac };
            check::<I11F5>(format, code);
            check::<U16F16>(format, code);
            check::<I32F32>(format, code);
            check::<U0F64>(format, code);
            check::<U64F0>(format, code);
        }
    }

    #[test]
    fn codes_beyond_the_word_saturate() {
        let word = Word::<U16F16>::new(Format::unsigned(8, 4)).expect("a wide type");
        assert_eq!(
            [-1, 255, 256].map(|code| word.read(code).to_num::<f64>()),
            [0.0, 255.0 / 16.0, 255.0 / 16.0]
        );
    }
}
