// SPDX-License-Identifier: MIT OR Apache-2.0
//! Quotients: the nearest codes, for all operands of small dividers and for random ones of wide;
//! the clocks they take.

use super::{Divider, Inputs, Outputs};
use crate::support::{
    Bench, MILLION, cases, check, check_latency, check_rest, check_restart, check_run_on,
};
use hapticore_hdl::format::Format;
use hapticore_reference::rounded::{Exact, round_quotient};

#[test]
fn quotients_are_the_nearest_codes() {
    let formats = [
        ("u29.23", "u28.23", "u21.20"),
        ("u27.23", "u28.23", "u24.22"),
        ("u30.26", "u31.26", "u28.26"),
        ("u12.4", "u9.7", "u7.3"),
    ];
    for (seed, (numerator, denominator, quotient)) in (0..).zip(formats) {
        let [n, d, q] = [numerator, denominator, quotient]
            .map(|text| text.parse::<Format>().expect("a format"));
        let mut bench = Bench::new(Divider::new(n, d, q));
        let cases = cases(&bench.block, MILLION / 4, seed);
        check(&mut bench, cases, |i| {
            let quotient =
                round_quotient(Exact::of(i.numerator, n), Exact::of(i.denominator, d), q);
            [("quotient", quotient.value.code(q)), ("saturated", quotient.held.into())]
        });
    }
}

fn check_divider(numerator: &str, denominator: &str, quotient: &str) {
    let [n, d, q] =
        [numerator, denominator, quotient].map(|text| text.parse::<Format>().expect("a format"));
    let mut bench = Bench::new(Divider::new(n, d, q));
    let pairs = (0..1 << n.width).flat_map(|n| (0..1 << d.width).map(move |d| (n, d)));
    for (numerator, denominator) in pairs {
        let case = format!("{numerator} / {denominator} in {n} / {d} = {q}");
        let out = divide(&mut bench, numerator, denominator, &case);
        let expected = round_quotient(Exact::of(numerator, n), Exact::of(denominator, d), q);
        let reference = (expected.value.code(q), i64::from(expected.held));
        assert_eq!((out.quotient, out.saturated), reference, "{case}: got, reference");
    }
}

/// Divides, and checks every register on every clock.
fn divide(
    bench: &mut Bench<Divider>,
    numerator: i64,
    denominator: i64,
    case: &str,
) -> Outputs<i64> {
    let mut start = 1;
    loop {
        let out = bench.clock(Inputs { start, numerator, denominator });
        if out.done == 1 && start == 0 {
            return out;
        }
        start = 0;
        bench.check_registers();
        let r = &bench.state.registers;
        // In the clock after the start the divider determines whether the quotient fits.
        let below = r.count == 0 || r.remainder < denominator || r.over == 1;
        assert!(
            below,
            "clock {}, {case}: the remainder {} is below the denominator",
            bench.clock, r.remainder
        );
    }
}

#[test]
fn every_quotient_of_8_by_4_bits() {
    check_divider("u8.0", "u4.0", "u8.0");
    check_divider("u8.0", "u4.0", "u4.0");
    check_divider("u8.4", "u4.2", "u7.5");
    check_divider("u8.6", "u4.4", "u3.2");
}

#[test]
fn every_quotient_of_5_by_5_bits() {
    check_divider("u5.0", "u5.0", "u5.0");
    check_divider("u5.2", "u5.4", "u9.6");
    check_divider("u5.5", "u5.5", "u6.5");
    check_divider("u5.0", "u5.0", "u1.0");
}

#[test]
fn every_quotient_of_4_by_8_bits() {
    check_divider("u4.4", "u8.3", "u5.5");
    check_divider("u4.0", "u8.0", "u9.8");
}

#[test]
fn latency_is_the_clocks_measured() {
    let [n, d] = [Format::unsigned(9, 4), Format::unsigned(7, 3)];
    for width in [3, 8, 20] {
        let block = Divider::new(n, d, Format::unsigned(width, 5));
        check_latency(block.clone(), block.latency());
    }
}

#[test]
fn a_hurried_divider_has_the_same_quotients_at_once() {
    let [n, d, q] = ["u12.4", "u9.7", "u7.3"].map(|text| text.parse().expect("a format"));
    let mut hurried = Divider::new(n, d, q);
    hurried.hurry();
    check_run_on([Divider::new(n, d, q), hurried], |i| i, |_, _, _| ());
}

#[test]
fn a_divider_refuses_what_it_cannot_divide() {
    let of = |texts: [&str; 3]| {
        let [n, d, q] = texts.map(|text| text.parse().expect("a format"));
        std::panic::catch_unwind(|| Divider::new(n, d, q)).is_ok()
    };
    assert!(of(["u8.4", "u4.2", "u7.2"]));
    assert!(
        !of(["u8.4", "u4.2", "u7.1"]),
        "fewer fractional bits than numerator and denominator leave"
    );
    for signed in [["s8.4", "u4.2", "u7.5"], ["u8.4", "s4.2", "u7.5"], ["u8.4", "u4.2", "s7.5"]] {
        assert!(!of(signed), "{signed:?}");
    }
}

/// Narrow and wide operands: of the narrow ones many quotients saturate.
const RESTARTED: [[&str; 3]; 3] =
    [["u8.6", "u4.4", "u3.2"], ["u12.4", "u9.7", "u7.3"], ["u27.23", "u28.23", "u24.22"]];

#[test]
fn a_quotient_is_begun_anew_in_any_clock_of_another() {
    for texts in RESTARTED {
        let [n, d, q] = texts.map(|text| text.parse().expect("a format"));
        let bench = || Bench::new(Divider::new(n, d, q));
        for _ in 0..8 {
            check_restart([bench(), bench()], |latency| 1..=latency, |i| i);
        }
    }
}

#[test]
fn a_divider_that_is_not_started_gives_nothing() {
    for texts in RESTARTED {
        let [n, d, q] = texts.map(|text| text.parse().expect("a format"));
        check_rest(Divider::new(n, d, q), &["start"]);
    }
}
