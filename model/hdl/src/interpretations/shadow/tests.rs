// SPDX-License-Identifier: MIT OR Apache-2.0
//! Both sides of a value: the code is that of the clocked interpretation, the number that of the
//! real one, and decisions follow the code.

use super::*;
use crate::exact::{codes, short_formats};
use crate::format::BIT;
use crate::signal::{Floor, HalfEven, Proved, Saturate, Wrap, bit, constant, is_known, is_set};

/// Codes with a number that is off them by less than a step.
fn signals(format: Format) -> Vec<Signal<Shadow>> {
    let off = [0.0, 0.3, -0.4];
    let of = |(n, value): (usize, i64)| Signal {
        value: Shadow { code: value, real: format.real(value) + off[n % 3] * format.lsb() },
        format,
    };
    codes(format).into_iter().enumerate().map(of).collect()
}

fn pairs() -> impl Iterator<Item = (Signal<Shadow>, Signal<Shadow>)> {
    let formats = ["u2.0", "s3.1", "s3.-1"].map(|text| text.parse().expect("a format"));
    let all: Vec<_> = formats.into_iter().flat_map(signals).collect();
    all.clone().into_iter().flat_map(move |a| all.clone().into_iter().map(move |b| (a, b)))
}

/// Holds that data have the code of one interpretation and the number of the other.
fn check_data(result: Signal<Shadow>, clocked: Signal<i64>, number: Signal<Real>) {
    assert_eq!((result.value.code, result.format), (clocked.value, clocked.format));
    assert_eq!((result.value.real, result.format), (number.value.0, number.format));
}

/// Holds that a decision has the code of the clocked interpretation on both sides.
fn check_control(result: Signal<Shadow>, clocked: Signal<i64>) {
    assert_eq!((result.value.code, result.format), (clocked.value, clocked.format));
    assert_eq!(result.value.real, clocked.value as f64);
}

#[test]
fn data_have_both_results() {
    for (a, b) in pairs() {
        check_data(a + b, code(a) + code(b), real(a) + real(b));
        check_data(a - b, code(a) - code(b), real(a) - real(b));
        check_data(a * b, code(a) * code(b), real(a) * real(b));
        check_data(a.abs(), code(a).abs(), real(a).abs());
        check_data(a.square(), code(a).square(), real(a).square());
        check_data(a.scaled(2), code(a).scaled(2), real(a).scaled(2));
        for chosen in [true, false] {
            let of = if chosen { a } else { b };
            let choice = bit(chosen).select(a, b);
            check_data(
                choice,
                bit(chosen).select(code(a), code(b)),
                Signal { format: choice.format, ..real(of) },
            );
        }
    }
}

#[test]
fn decisions_follow_the_code() {
    for (a, b) in pairs() {
        check_control(a.less_than(b), code(a).less_than(code(b)));
        check_control(a.equals(b), code(a).equals(code(b)));
        check_control(a.bits(0, 2), code(a).bits(0, 2));
        check_control(
            a.bits(0, 2).concat(b.bits(1, 1)),
            code(a).bits(0, 2).concat(code(b).bits(1, 1)),
        );
    }
    for (a, b) in [(false, false), (false, true), (true, false), (true, true)] {
        let [x, y] = [a, b].map(bit::<Shadow>);
        check_control(x & y, bit(a && b));
        check_control(x | y, bit(a || b));
        check_control(!x, bit(!a));
        assert_eq!((is_set(x), is_known(&x), x.can_skip()), (a, true, !a));
    }
}

/// A floor's number is that of its code; a wrapped one lies nearest to its code; rounding and
/// saturation leave the number.
#[test]
fn a_narrowing_keeps_the_number_near_the_code() {
    for (from, to) in ["s5.2", "u5.2"]
        .into_iter()
        .flat_map(|from| short_formats().into_iter().map(move |to| (from, to)))
    {
        for a in signals(from.parse().expect("a format")) {
            for overflow in [Saturate, Wrap] {
                let floored = a.quantize(to, Floor, overflow);
                let clocked = code(a).quantize(to, Floor, overflow);
                check_data(
                    floored,
                    clocked,
                    Signal { value: Real(to.real(clocked.value)), format: to },
                );
            }
            let saturated = a.quantize(to, HalfEven, Saturate);
            check_data(
                saturated,
                code(a).quantize(to, HalfEven, Saturate),
                real(a).quantize(to, HalfEven, Saturate),
            );
            let (wrapped, clocked) =
                (a.quantize(to, HalfEven, Wrap), code(a).quantize(to, HalfEven, Wrap));
            let span = f64::from(1 << to.width) * to.lsb();
            let off = wrapped.value.real - to.real(clocked.value);
            assert_eq!(wrapped.value.code, clocked.value);
            assert!(off.abs() <= 0.75 * to.lsb().max(a.format.lsb()), "{a:?} to {to}: {wrapped:?}");
            let turns = (a.value.real - wrapped.value.real) / span;
            assert!((turns - turns.round()).abs() < 1e-9, "{a:?} to {to}: {wrapped:?}");
        }
    }
}

#[test]
fn constants_have_a_number_beside_their_code() {
    let format = Format::signed(4, 1);
    assert_eq!(constant::<Shadow>(0.3, format).value, Shadow { code: 1, real: 0.3 });
    assert_eq!(crate::signal::code::<Shadow>(-3, format).value, Shadow { code: -3, real: -1.5 });
    let a = constant::<Shadow>(0.3, format);
    assert_eq!((<Shadow as Value>::code(a), Shadow::real(a), Shadow::unrounded(a)), (1, 0.5, 0.3));
    assert_eq!(<Shadow as Value>::code(crate::signal::code(-3, format)), -3);
    assert_eq!(Shadow::with_unrounded(a, 0.2), Shadow { code: 1, real: 0.2 });
    assert_eq!(a.resize(Format::signed(6, 2), Proved).value, Shadow { code: 2, real: 0.3 });
}

#[test]
fn a_golden_model_takes_the_place_of_the_number() {
    let [a, b, c] = [3.0, 5.0, 0.5].map(|real| constant::<Shadow>(real, Format::signed(8, 1)));
    let golden = a.golden(&[b, c, a], |of| of[0] / of[1] + of[2] * of.len() as f64);
    assert_eq!(golden.value, Shadow { code: 6, real: 19.0 });
}

#[test]
fn words_have_both_sides_and_addresses_follow_the_code() {
    let memory = Memory::table("table", Format::signed(4, 1), vec![0.3, 99.0, 1.0]);
    let mut words = Shadow::words(&memory);
    // A number that would address another word than its code.
    let address = |code: i64| Signal {
        value: Shadow { code, real: code as f64 + 1.0 },
        format: memory.address(),
    };
    let mut read = |word: i64, write: Option<(bool, i64)>| {
        let write = write.map(|(enable, at)| Write {
            enable: bit(enable),
            address: address(at),
            data: constant(0.7, memory.format),
        });
        Shadow::access(&memory, &mut words, address(word), write);
        let data = memory.data::<Shadow>(&mut words).value;
        (data.code, data.real)
    };
    assert_eq!([0, 1, 2].map(|word| read(word, None)), [(1, 0.3), (7, 99.0), (2, 1.0)]);
    assert_eq!(read(1, Some((false, 0))), (7, 99.0));
    assert_eq!(read(1, Some((true, 2))), (7, 99.0));
    assert_eq!((read(0, None), read(2, None)), ((1, 0.3), (1, 0.7)));
}

#[test]
fn a_bit_is_a_choice_by_its_code() {
    let [a, b] = [1.0, 2.0].map(|real| constant::<Shadow>(real, Format::signed(4, 1)));
    let bit = |code, real| Signal { value: Shadow { code, real }, format: BIT };
    assert_eq!(bit(1, 0.0).select(a, b).value.real, 1.0);
    assert_eq!(bit(0, 1.0).select(a, b).value.real, 2.0);
}
