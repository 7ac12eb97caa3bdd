// SPDX-License-Identifier: MIT OR Apache-2.0
//! Square roots: the nearest codes, for all radicands of small formats and for random ones of wide;
//! the clocks they take.

use super::{Inputs, Outputs, SquareRoot};
use crate::support::{
    Bench, MILLION, cases, check, check_latency, check_rest, check_restart, check_run_on, within,
};
use hapticore_hdl::format::Format;
use hapticore_reference::rounded::{Exact, round_sqrt};

#[test]
fn square_roots_are_the_nearest_codes() {
    for (seed, (radicand, frac)) in
        (0..).zip([("u52.46", 23), ("u60.52", 26), ("u11.4", 5), ("u13.-2", 3)])
    {
        let radicand = radicand.parse::<Format>().expect("a format");
        let mut bench = Bench::new(SquareRoot::new(radicand, frac));
        let (cases, root) = (cases(&bench.block, MILLION / 4, seed), bench.block.sqrt());
        check(&mut bench, cases, |i| {
            [("sqrt", round_sqrt(Exact::of(i.radicand, radicand), frac).code(root))]
        });
    }
}

fn check_root(radicand: &str, frac: i8) {
    let format: Format = radicand.parse().expect("a format");
    let mut bench = Bench::new(SquareRoot::new(format, frac));
    for radicand in 0..1 << format.width {
        let out = take_root(&mut bench, radicand);
        let reference = round_sqrt(Exact::of(radicand, format), frac).code(bench.block.sqrt());
        assert_eq!(out.sqrt, reference, "√{radicand} of {format}: got, reference");
    }
}

/// Computes a square root, and checks every register on every clock.
fn take_root(bench: &mut Bench<SquareRoot>, radicand: i64) -> Outputs<i64> {
    let mut start = 1;
    loop {
        let out = bench.clock(Inputs { start, radicand });
        if out.done == 1 && start == 0 {
            return out;
        }
        start = 0;
        bench.check_registers();
        let r = &bench.state.registers;
        assert!(
            within(r.remainder, Format::unsigned(62, 0)) && r.remainder <= 2 * r.partial,
            "√{radicand}"
        );
    }
}

#[test]
fn every_root_of_up_to_16_bits() {
    for width in 1..=if cfg!(optimised) { 16 } else { 10 } {
        check_root(&format!("u{width}.0"), 0);
    }
}

#[test]
fn every_root_with_odd_and_even_integer_bits() {
    for (radicand, frac) in [
        ("u9.8", 4),
        ("u10.8", 4),
        ("u11.7", 4),
        ("u8.3", 5),
        ("u8.-1", 2),
        ("u8.-2", 2),
        ("u7.9", 5),
    ] {
        check_root(radicand, frac);
    }
}

#[test]
fn latency_is_the_clocks_measured() {
    for width in [7, 8, 20] {
        let block = SquareRoot::new(Format::unsigned(width, 4), 5);
        check_latency(block.clone(), block.latency());
    }
}

#[test]
fn a_hurried_square_root_is_the_same_at_once() {
    let radicand = Format::unsigned(11, 4);
    let mut hurried = SquareRoot::new(radicand, 5);
    hurried.hurry();
    check_run_on([SquareRoot::new(radicand, 5), hurried], |i| i, |_, _, _| ());
}

#[test]
fn a_square_root_refuses_what_it_cannot_take() {
    let of = |radicand, frac| std::panic::catch_unwind(|| SquareRoot::new(radicand, frac)).is_ok();
    assert!(of(Format::unsigned(8, 6), 3));
    assert!(!of(Format::unsigned(8, 7), 3), "more than twice as many fractional bits");
    assert!(!of(Format::signed(8, 6), 3), "a sign");
    assert_eq!(SquareRoot::new(Format::unsigned(8, 6), 3).widest(), 10, "eight bits and a digit");
}

#[test]
fn a_square_root_is_begun_anew_in_any_clock_of_another() {
    for (radicand, frac) in [("u8.6", 3), ("u11.4", 5), ("u52.46", 23)] {
        let radicand = radicand.parse().expect("a format");
        let bench = || Bench::new(SquareRoot::new(radicand, frac));
        check_restart([bench(), bench()], |latency| 1..=latency, |i| i);
    }
}

#[test]
fn a_square_root_that_is_not_started_gives_nothing() {
    check_rest(SquareRoot::new(Format::unsigned(11, 4), 5), &["start"]);
}
