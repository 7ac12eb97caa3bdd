// SPDX-License-Identifier: MIT OR Apache-2.0
//! Intervals of every operation against all codes within: none is left out, and both ends are
//! reached, but where the comment says otherwise.

use super::*;
use crate::exact::{codes, format_pairs, greatest, least, short_formats};
use crate::format::BIT;
use crate::signal::{
    Assumed, Exact, Floor, HalfEven, Proved, Saturate, Wrap, bit, code, int, is_known, is_set,
};

/// Every interval of a format.
fn intervals(format: Format) -> Vec<Signal<Range>> {
    let ends = |low: i64| {
        codes(format).into_iter().filter(move |high| *high >= low).map(move |high| (low, high))
    };
    let of = |(low, high): (i64, i64)| Signal {
        value: Range { low: low.into(), high: high.into() },
        format,
    };
    codes(format).into_iter().flat_map(ends).map(of).collect()
}

/// The signals of an interval.
fn within(of: Signal<Range>) -> impl Iterator<Item = Signal<i64>> + Clone {
    (of.value.low..=of.value.high).map(move |code| Signal { value: code as i64, format: of.format })
}

/// The interval of all results.
fn hull(results: impl Iterator<Item = Signal<i64>>) -> Range {
    results
        .map(|of| Range::point(of.value.into()))
        .reduce(Range::join)
        .expect("an interval has a code")
}

fn hull_of_two(
    a: Signal<Range>,
    b: Signal<Range>,
    of: impl Fn(Signal<i64>, Signal<i64>) -> Signal<i64>,
) -> Range {
    hull(within(a).flat_map(|x| within(b).map(move |y| (x, y))).map(|(x, y)| of(x, y)))
}

fn interval_pairs() -> impl Iterator<Item = (Signal<Range>, Signal<Range>)> {
    let formats = ["u2.0", "s2.1", "s3.-1"].map(|text| text.parse().expect("a format"));
    let all: Vec<_> = formats.into_iter().flat_map(intervals).collect();
    all.clone().into_iter().flat_map(move |a| all.clone().into_iter().map(move |b| (a, b)))
}

#[test]
fn results_of_two_intervals_are_those_of_their_codes() {
    for (a, b) in interval_pairs() {
        let case = format!("{a:?}, {b:?}");
        assert_eq!((a + b).value, hull_of_two(a, b, |x, y| x + y), "{case}: sum");
        assert_eq!((a - b).value, hull_of_two(a, b, |x, y| x - y), "{case}: difference");
        assert_eq!((a * b).value, hull_of_two(a, b, |x, y| x * y), "{case}: product");
        assert_eq!(a.less_than(b).value, hull_of_two(a, b, |x, y| x.less_than(y)), "{case}: less");
        let either: Signal<Range> = Signal { value: whole(BIT), format: BIT };
        for choice in [bit(false), bit(true), either] {
            let of =
                |x: Signal<i64>, y: Signal<i64>| within(choice).map(move |bit| bit.select(x, y));
            let all = within(a).flat_map(|x| within(b).flat_map(move |y| of(x, y)));
            assert_eq!(choice.select(a, b).value, hull(all), "{case}: choice by {choice:?}");
        }
    }
}

/// Where points differ, two intervals may overlap without a common number.
#[test]
fn equality_is_known_where_it_is_sure() {
    for (a, b) in interval_pairs() {
        let (equal, of_codes) = (a.equals(b).value, hull_of_two(a, b, |x, y| x.equals(y)));
        assert!(equal.holds(of_codes), "{a:?}, {b:?}: {equal:?}");
        let ends = |of: Signal<Range>| {
            [of.value.low, of.value.high].map(|code| of.format.real(code as i64))
        };
        let ([a_low, a_high], [b_low, b_high]) = (ends(a), ends(b));
        let apart = a_high < b_low || b_high < a_low;
        let same = a_low == a_high && b_low == b_high && a_low == b_low;
        assert_eq!(equal, Range { low: same.into(), high: (!apart).into() }, "{a:?}, {b:?}");
    }
}

#[test]
fn results_of_one_interval_are_those_of_its_codes() {
    for a in short_formats().into_iter().flat_map(intervals) {
        assert_eq!((-a).value, hull(within(a).map(|x| -x)), "-{a:?}");
        assert_eq!(a.abs().value, hull(within(a).map(Signal::abs)), "|{a:?}|");
        assert_eq!(a.square().value, hull(within(a).map(Signal::square)), "{a:?}²");
        assert_eq!((a.scaled(2).value, a.scaled(2).format), (a.value, a.format.scaled(2)));
        for (low, width) in
            (0..a.format.width).flat_map(|low| (1..=a.format.width - low).map(move |w| (low, w)))
        {
            let cut = a.bits(low, width).value;
            assert_eq!(cut, hull(within(a).map(|x| x.bits(low, width))), "{a:?}[{low}, {width}]");
        }
    }
}

#[test]
fn words_side_by_side() {
    let formats = [2, 3].map(|width| Format::unsigned(width, 0));
    for (a, b) in intervals(formats[0])
        .into_iter()
        .flat_map(|a| intervals(formats[1]).into_iter().map(move |b| (a, b)))
    {
        assert_eq!(a.concat(b).value, hull_of_two(a, b, |x, y| x.concat(y)), "{a:?}, {b:?}");
    }
}

#[test]
fn the_lesser_of_two_intervals() {
    let all = intervals(Format::signed(3, 1));
    for (a, b) in all.iter().flat_map(|a| all.iter().map(move |b| (*a, *b))) {
        assert_eq!(a.at_most(b).value, hull_of_two(a, b, |x, y| x.at_most(y)), "{a:?}, {b:?}");
    }
}

#[test]
fn bits_are_combined() {
    let bits = intervals(BIT);
    for (a, b) in bits.iter().flat_map(|a| bits.iter().map(move |b| (*a, *b))) {
        assert_eq!((a & b).value, hull_of_two(a, b, |x, y| x & y));
        assert_eq!((a | b).value, hull_of_two(a, b, |x, y| x | y));
        assert_eq!((!a).value, hull(within(a).map(|x| !x)));
    }
    let known = bits.iter().map(|of| (is_known(of), is_set(*of), of.can_skip()));
    assert_eq!(
        known.collect::<Vec<_>>(),
        [(true, false, true), (false, false, false), (true, true, false)]
    );
}

/// A word that gains fractional bits has gaps between its codes: where it wraps, the interval of
/// all codes is as good as one can say.
#[test]
fn a_narrowed_interval_is_that_of_the_narrowed_codes() {
    for from in ["s5.1", "u5.1", "s3.-1"].map(|text| text.parse::<Format>().expect("a format")) {
        for (a, to) in intervals(from)
            .into_iter()
            .flat_map(|a| short_formats().into_iter().map(move |to| (a, to)))
        {
            for (rounding, overflow) in
                [(HalfEven, Saturate), (Floor, Saturate), (HalfEven, Wrap), (Floor, Wrap)]
            {
                let (narrowed, case) = (
                    a.quantize(to, rounding, overflow).value,
                    format!("{a:?} to {to}, {rounding:?}, {overflow:?}"),
                );
                let of_codes = hull(within(a).map(|x| x.quantize(to, rounding, overflow)));
                match overflow == Wrap && to.frac > from.frac {
                    true => assert!(
                        narrowed == of_codes || narrowed == whole(to),
                        "{case}: {narrowed:?}"
                    ),
                    false => assert_eq!(narrowed, of_codes, "{case}"),
                }
                assert!(narrowed.holds(of_codes), "{case}");
            }
        }
    }
}

/// Less than a turn of a wrapped word that does not cross its end is no more than it was.
#[test]
fn a_refined_interval_within_a_turn_stays_itself() {
    let a = Signal { value: Range { low: 9, high: 11 }, format: Format::unsigned(5, 0) };
    assert_eq!(a.resize(Format::unsigned(4, 1), Wrap).value, Range { low: 2, high: 6 });
}

#[test]
fn what_fits_is_no_violation_and_stays_as_it_is() {
    let _ = (take_violations(), take_assumptions());
    for (to, wide) in short_formats().into_iter().map(|to| (to, Format::signed(8, to.frac))) {
        let all = Signal { value: whole(to), format: wide };
        assert_eq!(all.resize(to, Proved).value, whole(to));
        assert_eq!(all.resize(to, Assumed("it fits")).value, whole(to));
        assert_eq!(take_violations(), []);
        assert_eq!((take_assumptions(), take_assumptions()), (vec!["it fits"], vec![]));
    }
}

#[test]
fn what_does_not_fit_is_a_violation_and_goes_on_limited() {
    let _ = (take_violations(), take_assumptions());
    for to in short_formats() {
        for (below, above) in [(1, 0), (0, 1)] {
            let range = Range { low: least(to) - below, high: greatest(to) + above };
            let all = Signal { value: range, format: Format::signed(8, to.frac) };
            assert_eq!(all.resize(to, Assumed("it fits")).value, whole(to));
            assert_eq!(take_violations(), []);
            assert_eq!(all.resize(to, Proved).value, whole(to));
            let [violation] = &take_violations()[..] else { panic!("one narrowing") };
            assert_eq!((violation.range, violation.format, violation.memory), (range, to, None));
            assert!(violation.line.file().ends_with("tests.rs") && violation.instance.is_empty());
        }
    }
    assert_eq!(take_assumptions(), ["it fits"]);
    for name in ["one", "two", "one"] {
        let _ = int::<Range>(2).resize(BIT, Assumed(name));
    }
    assert_eq!(take_assumptions(), ["one", "two"], "each once");
}

/// The bits that a word would need beyond those that it has, by trying formats.
#[test]
fn lacking_bits_are_those_of_the_next_format_that_fits() {
    for (format, (low, high)) in short_formats()
        .into_iter()
        .flat_map(|to| (-9..9).flat_map(move |low| (low..9).map(move |high| (to, (low, high)))))
    {
        let range = Range { low, high };
        let line = Location::caller();
        let violation = Violation { instance: String::new(), memory: None, line, range, format };
        let wider = |signed| {
            (0..9).find(|more| {
                whole(Format { signed, width: format.width + more, ..format }).holds(range)
            })
        };
        // An unsigned word that gets a sign keeps its bits beside it.
        let expected = match wider(format.signed) {
            Some(more) => more,
            None => wider(true).expect("a signed format").max(1),
        };
        assert_eq!(violation.lacking(), expected, "{low} … {high} in {format}");
    }
}

#[test]
fn violations_are_told_in_a_line() {
    let line = Location::caller();
    let place = format!("{}:{}", line.file(), line.line());
    let of = |instance: &str, memory, high| {
        let range = Range { low: 0, high };
        Violation { instance: instance.into(), memory, line, range, format: Format::unsigned(3, 0) }
            .to_string()
    };
    assert_eq!(of("a.b", None, 8), format!("a.b, {place}: 0 … 8 lacks 1 bit in u3.0"));
    assert_eq!(of("", None, 16), format!("{place}: 0 … 16 lacks 2 bits in u3.0"));
    assert_eq!(of("", Some("words"), 6), format!("{place}: address 0 … 6 leaves the memory words"));
}

#[test]
fn constants_are_points() {
    let format = Format::signed(4, 1);
    assert_eq!(crate::signal::constant::<Range>(0.75, format).value, Range::point(2));
    assert_eq!(code::<Range>(-3, format).value, Range::point(-3));
    let a = Signal { value: Range { low: -3, high: 2 }, format };
    assert_eq!(<Range as Value>::code(a), -3);
    assert_eq!(a.quantize(Format::signed(6, 2), Exact, Proved).value, Range { low: -6, high: 4 });
    assert!(!crate::signal::decides(&a));
}

#[test]
fn a_range_holds_what_is_within() {
    for (a, b) in format_pairs().map(|(a, b)| (whole(a), whole(b))) {
        assert_eq!(a.holds(b), (b.low..=b.high).all(|code| (a.low..=a.high).contains(&code)));
        assert!(a.join(b).holds(a) && a.join(b).holds(b));
    }
}
