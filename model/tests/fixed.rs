// SPDX-License-Identifier: MIT OR Apache-2.0
//! An outside judge of every place that quantises: the `fixed` crate's types round half to even,
//! saturate and wrap as formats, the clocked signals and the rounded reference do.

use fixed::FixedI128;
use fixed::traits::Fixed;
use fixed::types::extra::U40;
use fixed::types::{
    I1F7, I2F14, I5F11, I8F0, I8F24, I16F0, I16F16, I24F8, U0F8, U0F32, U1F15, U8F8, U16F16, U32F0,
};
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::{HalfEven, Saturate, Signal, Wrap};
use hapticore_reference::rounded::{Exact, round, round_real};
use proptest::prelude::*;

/// Numbers in steps of a format, between which it rounds.
type Steps = FixedI128<U40>;

/// The format of a type.
fn format<T: Fixed>() -> Format {
    Format {
        signed: T::IS_SIGNED,
        width: (T::INT_NBITS + T::FRAC_NBITS) as u8,
        frac: T::FRAC_NBITS as i8,
    }
}

/// The number of a code, rounded half to even to the steps of the type: as yet in no range.
fn rounded<T: Fixed>(code: i64, source: Format) -> Steps {
    let shift = 40 + T::FRAC_NBITS as i32 - i32::from(source.frac);
    let steps = Steps::from_bits(i128::from(code) << shift).round_ties_even();
    Steps::from_bits(steps.to_bits() >> T::FRAC_NBITS)
}

fn bits<T: Fixed>(number: T) -> i64
where
    i64: TryFrom<T::Bits>,
{
    i64::try_from(number.to_bits()).ok().expect("at most 32 bits")
}

/// A code, and a format that holds it; half of them within a few steps of a power of two, where
/// full scale and ties are.
fn codes() -> impl Strategy<Value = (i64, Format)> {
    let anywhere = -(1i64 << 46)..1i64 << 46;
    let near = (0..46u32, -4i64..=4, any::<bool>())
        .prop_map(|(bit, by, minus)| if minus { by - (1 << bit) } else { by + (1 << bit) });
    (prop_oneof![anywhere, near], 0..40i8).prop_map(|(code, frac)| (code, Format::signed(48, frac)))
}

/// Reals of every size that formats have to do with, ties among them.
fn reals() -> impl Strategy<Value = f64> {
    let ties = (-(1i64 << 34)..1i64 << 34, -40i32..8)
        .prop_map(|(odd, exponent)| odd as f64 * 2f64.powi(exponent));
    prop_oneof![ties, -300.0..300.0f64, -1.5..1.5f64, -1e12..1e12f64]
}

/// What `fixed` makes of a code in the type: saturated, wrapped, and whether either was needed.
fn check_code<T: Fixed>(code: i64, source: Format)
where
    i64: TryFrom<T::Bits>,
{
    let to = format::<T>();
    // With the point of `to` a signal has 63 bits at most.
    let beyond = (to.frac - source.frac - 12).max(0);
    let (code, source) = (code >> beyond, Format::signed(source.width - beyond as u8, source.frac));
    let number = rounded::<T>(code, source);
    let case = format!("{code} of {source} in {to}");
    let (saturated, (wrapped, beyond)) = (
        bits(T::saturating_from_num(number)),
        (T::wrapping_from_num(number), T::overflowing_from_num(number).1),
    );
    let signal = Signal { value: code, format: source };
    assert_eq!(
        signal.quantize(to, HalfEven, Saturate).value,
        saturated,
        "{case}: clocked, saturated"
    );
    assert_eq!(
        signal.quantize(to, HalfEven, Wrap).value,
        bits(wrapped),
        "{case}: clocked, wrapped"
    );
    let (held, flag) = signal.saturate(to, HalfEven);
    assert_eq!(
        (held.value, flag.value != 0),
        (saturated, beyond),
        "{case}: clocked, with its flag"
    );
    let reference = round(Exact::of(code, source), to);
    assert_eq!(
        (reference.value.code(to), reference.held),
        (saturated, beyond),
        "{case}: reference"
    );
}

fn check_real<T: Fixed>(real: f64)
where
    i64: TryFrom<T::Bits>,
{
    let to = format::<T>();
    let saturated = bits(T::saturating_from_num(real));
    assert_eq!(to.code_saturating(real), saturated, "{real} in {to}");
    assert_eq!(to.code(real), T::checked_from_num(real).map(bits), "{real} in {to}");
    assert_eq!(round_real(real, to).code(to), saturated, "{real} in {to}: reference");
    assert_eq!(
        T::from_bits(T::saturating_from_num(real).to_bits()).to_num::<f64>(),
        to.real(saturated),
        "{to}"
    );
}

/// For each of these types.
macro_rules! each {
    (@ $check:ident $kind:ty, ($($argument:expr),*)) => { $check::<$kind>($($argument),*) };
    ($check:ident $arguments:tt: $($kind:ty),*) => { $(each!(@ $check $kind, $arguments);)* };
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(optimised) { 20_000 } else { 500 }))]

    #[test]
    fn codes_are_rounded_saturated_and_wrapped_as_fixed_does((code, source) in codes()) {
        each!(check_code(code, source): I8F0, I1F7, I16F0, I2F14, I5F11, I16F16, I24F8, I8F24);
        each!(check_code(code, source): U0F8, U8F8, U1F15, U16F16, U0F32, U32F0);
    }

    #[test]
    fn reals_are_rounded_and_saturated_as_fixed_does(real in reals()) {
        each!(check_real(real): I8F0, I1F7, I16F0, I2F14, I5F11, I16F16, I24F8, I8F24);
        each!(check_real(real): U0F8, U8F8, U1F15, U16F16, U0F32, U32F0);
    }
}

/// The judge can be wrong: of a value half way it does not say what rounding up would.
#[test]
fn a_tie_tells_rounding_to_even_from_rounding_up() {
    let half =
        |code: i64| bits(I8F0::saturating_from_num(rounded::<I8F0>(code, Format::signed(48, 1))));
    assert_eq!([-3, -1, 1, 3, 5].map(half), [-2, 0, 0, 2, 2]);
}
