// SPDX-License-Identifier: MIT OR Apache-2.0
//! Small dividers and roots, over all operands: results, and the lemmas on their remainders, on every clock.

use crate::harness::{Bench, within};
use hapticore_model::blocks::divider::{self, Divider};
use hapticore_model::blocks::root::{self, Root};
use hapticore_model::format::Format;
use hapticore_reference::rounded::{Exact, round_quotient, round_root};

fn check_divider(numerator: &str, denominator: &str, quotient: &str) {
    let [n, d, q] = [numerator, denominator, quotient].map(|text| text.parse::<Format>().expect("a format"));
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

/// Divides, and looks at every register on every clock.
fn divide(bench: &mut Bench<Divider>, numerator: i64, denominator: i64, case: &str) -> divider::Outputs<i64> {
    let mut start = 1;
    loop {
        let out = bench.clock(divider::Inputs { start, numerator, denominator });
        if out.done == 1 && start == 0 {
            return out;
        }
        start = 0;
        bench.check_registers();
        let r = &bench.state.registers;
        // In the clock after the start it is looked at whether the quotient fits.
        let below = r.count == 0 || r.remainder < denominator || r.over == 1;
        assert!(below, "clock {}, {case}: the remainder {} is below the denominator", bench.clock, r.remainder);
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

fn check_root(radicand: &str, frac: i8) {
    let format: Format = radicand.parse().expect("a format");
    let mut bench = Bench::new(Root::new(format, frac));
    for radicand in 0..1 << format.width {
        let out = take_root(&mut bench, radicand);
        let reference = round_root(Exact::of(radicand, format), frac).code(bench.block.root());
        assert_eq!(out.root, reference, "√{radicand} of {format}: got, reference");
    }
}

/// Takes a root, and looks at every register on every clock.
fn take_root(bench: &mut Bench<Root>, radicand: i64) -> root::Outputs<i64> {
    let mut start = 1;
    loop {
        let out = bench.clock(root::Inputs { start, radicand });
        if out.done == 1 && start == 0 {
            return out;
        }
        start = 0;
        bench.check_registers();
        let r = &bench.state.registers;
        assert!(within(r.remainder, Format::unsigned(62, 0)) && r.remainder <= 2 * r.partial, "√{radicand}");
    }
}

#[test]
fn every_root_of_up_to_16_bits() {
    for width in 1..=16 {
        check_root(&format!("u{width}.0"), 0);
    }
}

#[test]
fn every_root_with_odd_and_even_integer_bits() {
    for (radicand, frac) in
        [("u9.8", 4), ("u10.8", 4), ("u11.7", 4), ("u8.3", 5), ("u8.-1", 2), ("u8.-2", 2), ("u7.9", 5)]
    {
        check_root(radicand, frac);
    }
}
