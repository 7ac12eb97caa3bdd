// SPDX-License-Identifier: MIT OR Apache-2.0
//! Operations on small formats: the clocked interpretation is the exact rational, rounded as named;
//! the real interpretation is the number itself; the range interpretation holds whatever happens
//! within its operands' ranges.

use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::range::{Range, take_violations, whole};
use hapticore_hdl::interpretations::real::Real;
use hapticore_hdl::signal::{Floor, HalfEven, Proved, Saturate, Signal, Value, Wrap};
use hapticore_reference::rounded::{Exact, round};
use proptest::prelude::*;

/// What a format reads from a code.
fn exact(a: Signal<i64>) -> Exact {
    Exact::of(a.value, a.format)
}

fn formats() -> impl Strategy<Value = Format> {
    (any::<bool>(), 1u8..10, -3i8..6).prop_map(|(signed, width, frac)| Format {
        signed,
        width,
        frac,
    })
}

/// A signal of some format.
fn signals() -> impl Strategy<Value = Signal<i64>> {
    formats().prop_flat_map(|format| {
        let (low, high) = (format.min_code() as i64, format.max_code() as i64);
        (low..=high).prop_map(move |value| Signal { value, format })
    })
}

/// An expression over two operands.
#[derive(Debug, Clone)]
enum Expression {
    Operand(bool),
    Add(Box<Expression>, Box<Expression>),
    Sub(Box<Expression>, Box<Expression>),
    Mul(Box<Expression>, Box<Expression>),
    Negative(Box<Expression>),
    Magnitude(Box<Expression>),
    Square(Box<Expression>),
    Larger(Box<Expression>, Box<Expression>),
    Rounded(Box<Expression>, i8),
    Held(Box<Expression>, Format),
    Wrapped(Box<Expression>, Format),
}
use Expression::*;

fn expressions() -> impl Strategy<Value = Expression> {
    any::<bool>().prop_map(Operand).prop_recursive(3, 8, 2, |inner| {
        let one = || inner.clone().prop_map(Box::new);
        prop_oneof![
            (one(), one()).prop_map(|(a, b)| Add(a, b)),
            (one(), one()).prop_map(|(a, b)| Sub(a, b)),
            (one(), one()).prop_map(|(a, b)| Mul(a, b)),
            one().prop_map(Negative),
            one().prop_map(Magnitude),
            one().prop_map(Square),
            (one(), one()).prop_map(|(a, b)| Larger(a, b)),
            (one(), -3i8..4).prop_map(|(a, frac)| Rounded(a, frac)),
            (one(), formats()).prop_map(|(a, to)| Held(a, to)),
            (one(), formats()).prop_map(|(a, to)| Wrapped(a, to)),
        ]
    })
}

/// An operation that would need words past 40 bits is left out.
fn fits(format: Format) -> bool {
    format.width <= 40
}

fn binary<V: Value>(
    a: Signal<V>,
    b: Signal<V>,
    f: fn(Signal<V>, Signal<V>) -> Signal<V>,
) -> Signal<V> {
    let aligned = a.format.join(b.format);
    let fits =
        fits(a.format.product(b.format)) && fits(Format { width: aligned.width + 1, ..aligned });
    if fits { f(a, b) } else { a }
}

/// The expression in an interpretation.
fn read<V: Value>(expression: &Expression, operands: [Signal<V>; 2]) -> Signal<V> {
    let of = |expression: &Expression| read(expression, operands);
    match expression {
        Operand(second) => operands[usize::from(*second)],
        Add(a, b) => binary(of(a), of(b), |a, b| a + b),
        Sub(a, b) => binary(of(a), of(b), |a, b| a - b),
        Mul(a, b) => binary(of(a), of(b), |a, b| a * b),
        Negative(a) => -of(a),
        Magnitude(a) => of(a).abs(),
        Square(a) => {
            let a = of(a);
            if fits(a.format.product(a.format)) { a.square() } else { a }
        }
        Larger(a, b) => binary(of(a), of(b), |a, b| a.less_than(b).select(b, a)),
        Rounded(a, frac) => {
            let a = of(a);
            let integer = a.format.integer_bits() + 2 + i16::from(a.format.signed);
            let width = integer + i16::from(*frac);
            if *frac >= a.format.frac || width < 2 {
                return a;
            }
            a.quantize(Format { width: width as u8, frac: *frac, ..a.format }, HalfEven, Proved)
        }
        Held(a, to) => of(a).quantize(*to, HalfEven, Saturate),
        Wrapped(a, to) => of(a).quantize(*to, Floor, Wrap),
    }
}

fn real(a: Signal<i64>) -> Signal<Real> {
    Signal { value: Real(exact(a).real()), format: a.format }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: if cfg!(optimised) { 20_000 } else { 500 }, ..ProptestConfig::default() })]

    #[test]
    fn operators_are_exact(a in signals(), b in signals()) {
        prop_assert_eq!(exact(a + b), exact(a) + exact(b));
        prop_assert_eq!(exact(a - b), exact(a) - exact(b));
        prop_assert_eq!(exact(a * b), exact(a) * exact(b));
        prop_assert_eq!(exact(-a), -exact(a));
        prop_assert_eq!(exact(a.abs()), exact(a).magnitude());
        prop_assert_eq!(exact(a.square()), exact(a) * exact(a));
        prop_assert_eq!(a.less_than(b).value != 0, exact(a) < exact(b));
        prop_assert_eq!(a.equals(b).value != 0, exact(a) == exact(b));
        for result in [a + b, a - b, a * b, -a, a.abs(), a.square()] {
            prop_assert!(whole(result.format).holds(Range::point(result.value.into())), "{:?}", result);
        }
    }

    #[test]
    fn narrowings_round_and_hold_as_named(a in signals(), to in formats()) {
        let held = a.quantize(to, HalfEven, Saturate);
        let expected = round(exact(a), to);
        prop_assert_eq!(exact(held), expected.value);
        let (value, flag) = a.saturate(to, HalfEven);
        prop_assert_eq!((exact(value), flag.value != 0), (expected.value, expected.held));
        let span = 1i128 << to.width;
        let floor = exact(a).scaled(to.frac).floor();
        let wrapped = a.quantize(to, Floor, Wrap).value;
        prop_assert_eq!((i128::from(wrapped) - floor).rem_euclid(span), 0);
        prop_assert!(whole(to).holds(Range::point(wrapped.into())));
        let wide = a.format.join(to);
        prop_assert_eq!(exact(a.resize(wide, Proved)), exact(a));
    }

    #[test]
    fn bits_are_those_of_the_code(a in signals(), low in 0u8..8, width in 1u8..8, b in signals()) {
        let code = i128::from(a.value).rem_euclid(1 << 20);
        let width = width.min(a.format.width);
        let low = low.min(a.format.width - width);
        prop_assert_eq!(i128::from(a.bits(low, width).value), (code >> low) % (1 << width));
        prop_assert_eq!(i128::from(a.msb().value), (code >> (a.format.width - 1)) % 2);
        let [high, low] = [a, b].map(|x| x.bits(0, x.format.width));
        prop_assert_eq!(high.concat(low).value, high.value * (1 << low.format.width) + low.value);
    }

    #[test]
    fn the_real_interpretation_is_the_number_where_nothing_narrows(a in signals(), b in signals()) {
        let (x, y) = (real(a), real(b));
        for (got, of_codes) in [(x + y, a + b), (x - y, a - b), (x * y, a * b), (-x, -a), (x.abs(), a.abs())] {
            prop_assert_eq!(got.value.0, exact(of_codes).real());
        }
        prop_assert_eq!(x.less_than(y).value.0, a.less_than(b).value as f64);
    }

    #[test]
    fn rounding_moves_a_number_by_half_a_step_at_most(a in signals(), to in formats()) {
        let wide = Format { signed: true, width: 30, frac: to.frac };
        let rounded = exact(a.quantize(wide, HalfEven, Proved)).real();
        prop_assert!((rounded - real(a).quantize(wide, HalfEven, Proved).value.0).abs() <= to.lsb() / 2.0);
    }

    #[test]
    fn ranges_hold_what_happens(
        expression in expressions(),
        (a, other_a) in signals().prop_flat_map(|a| (Just(a), a.format.min_code() as i64..=a.format.max_code() as i64)),
        (b, other_b) in signals().prop_flat_map(|b| (Just(b), b.format.min_code() as i64..=b.format.max_code() as i64)),
    ) {
        let range = |a: Signal<i64>, other: i64| {
            let value = Range { low: a.value.min(other).into(), high: a.value.max(other).into() };
            Signal { value, format: a.format }
        };
        take_violations();
        let ranges = read(&expression, [range(a, other_a), range(b, other_b)]);
        prop_assert!(take_violations().is_empty(), "rounding leaves room for itself");
        for (a_code, b_code) in [(a.value, b.value), (other_a, b.value), (a.value, other_b), (other_a, other_b)] {
            let codes = read(&expression, [Signal { value: a_code, ..a }, Signal { value: b_code, ..b }]);
            prop_assert_eq!(codes.format, ranges.format);
            let happens = Range::point(codes.value.into());
            prop_assert!(ranges.value.holds(happens), "{:?} holds {:?}", ranges, codes);
            prop_assert!(whole(codes.format).holds(happens), "{:?} within its format", codes);
        }
    }
}
